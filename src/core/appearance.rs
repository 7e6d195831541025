//! What a surface looks like at a hit: its material with textures and vertex colours.

use crate::bsdf::{Black, Bsdf, Dielectric, Diffuse, Gain, MetalRough, Phong, Polished, Scatter};
use crate::interaction::{texture_coordinates, vertex_colour};
use crate::mesh::{Illumination, Material, Property, TextureMap};
use crate::ray::Hit;
use crate::scene::Scene;
use crate::srgb::{from_display, luminance};
use glam::{Vec2, Vec3};

/// Reflectance of faces without a material.
const CLAY: Vec3 = Vec3::new(0.68, 0.66, 0.63);

/// A material at a hit.
pub(crate) struct Appearance<'a> {
    scene: &'a Scene,
    material: Option<&'a Material>,
    hit: &'a Hit,
}

impl<'a> Appearance<'a> {
    pub fn new(scene: &'a Scene, material: Option<&'a Material>, hit: &'a Hit) -> Self {
        Self {
            scene,
            material,
            hit,
        }
    }

    /// Texture coordinates. A face without them shows no texture.
    fn uv(&self) -> Option<Vec2> {
        texture_coordinates(self.scene, self.hit)
    }

    /// The values of a texture, without conversion from sRGB; 1 without a texture.
    fn values(&self, material: &Material, property: Property) -> Vec3 {
        let map = material.further_map(property).zip(self.uv());
        let textures = &self.scene.mesh().attributes().textures;
        map.map_or(Vec3::ONE, |(map, uv)| map.values(textures, uv))
    }

    /// The colour of a texture; white without one.
    fn colour(&self, material: &Material, property: Property) -> Vec3 {
        let map = material.further_map(property);
        self.of_texture(map).unwrap_or(Vec3::ONE)
    }

    fn of_texture(&self, map: Option<&TextureMap>) -> Option<Vec3> {
        let textures = &self.scene.mesh().attributes().textures;
        map.zip(self.uv()).map(|(map, uv)| map.colour(textures, uv))
    }

    /// The product of the colours of texture and vertices, if there are any.
    fn tint(&self) -> Option<Vec3> {
        let map = self
            .material
            .and_then(|material| material.diffuse_map.as_ref());
        let of_vertices = vertex_colour(self.scene, self.hit).map(from_display);
        let colours = [self.of_texture(map), of_vertices].into_iter().flatten();
        colours.reduce(|a, b| a * b)
    }

    /// The product of the colours of material, texture and vertices; clay if there are none.
    pub fn diffuse(&self) -> Vec3 {
        let of_material = self.material.and_then(|material| material.diffuse);
        let colours = [of_material, self.tint()].into_iter().flatten();
        colours.reduce(|a, b| a * b).unwrap_or(CLAY)
    }

    /// The specular reflectance.
    pub fn specular(&self) -> Vec3 {
        let specular = |m: &Material| m.specular * self.colour(m, Property::Specular);
        self.material.map_or(Vec3::ZERO, specular)
    }

    /// The light that is emitted, by either side.
    pub fn emission(&self) -> Vec3 {
        match self.material {
            Some(material) if material.emission != Vec3::ZERO => {
                material.emission * self.colour(material, Property::Emission)
            }
            _ => Vec3::ZERO,
        }
    }

    /// The light that the front or the back emits.
    pub fn emission_of_side(&self, is_front: bool) -> Vec3 {
        if is_front || self.material.is_none_or(|material| material.emits_on_back) {
            self.emission()
        } else {
            Vec3::ZERO
        }
    }

    /// The part of the surface that is there; light passes through the rest.
    pub fn opacity(&self) -> f32 {
        let Some(material) = self.material else {
            return 1.0;
        };
        let textures = &self.scene.mesh().attributes().textures;
        let alpha = |map: Option<&TextureMap>| map?.alpha(textures, self.uv()?);
        let mut opacity = material.opacity * alpha(material.diffuse_map.as_ref()).unwrap_or(1.0);
        if let Some(map) = material.further_map(Property::Opacity) {
            let brightness = || luminance(self.values(material, Property::Opacity));
            opacity *= alpha(Some(map)).unwrap_or_else(brightness);
        }
        opacity
    }

    /// How the front or the back scatters light.
    pub fn bsdf(&self, is_front: bool) -> Bsdf {
        let Some(material) = self.material else {
            return self.of_statements(&Material::default());
        };
        let Some(sides) = &material.sides else {
            let bsdf = self.of_statements(material);
            let is_visible = is_front || material.is_two_sided || bsdf.model().transmits;
            return if is_visible { bsdf } else { Bsdf::Black(Black) };
        };
        let side = if is_front || sides.front.model().transmits {
            sides.front
        } else {
            sides.back.unwrap_or(Bsdf::Black(Black))
        };
        self.tint().map_or(side, |tint| side.tinted(tint))
    }

    /// What the statements of a material library say.
    fn of_statements(&self, material: &Material) -> Bsdf {
        if material.is_glass() {
            return Bsdf::Dielectric(Dielectric {
                eta: material.refraction,
                reflectance: Vec3::ONE,
                transmittance: material.filter.unwrap_or(Vec3::ONE),
            });
        }
        let colour = self.diffuse();
        let has = |property| material.further_map(property).is_some();
        let [has_roughness, has_metalness] = [
            material.roughness.is_some() || has(Property::Roughness),
            material.metalness.is_some() || has(Property::Metalness),
        ];
        if has_roughness || has_metalness {
            // A texture alone gives the whole value. Without a statement, nothing is a metal, and all is rough.
            let of_texture = |property| self.values(material, property).x;
            let metalness = material
                .metalness
                .unwrap_or(if has_metalness { 1.0 } else { 0.0 });
            return Bsdf::MetalRough(MetalRough::new(
                colour,
                metalness * of_texture(Property::Metalness),
                material.roughness.unwrap_or(1.0) * of_texture(Property::Roughness),
            ));
        }
        let specular = self.specular();
        let illumination = material.illumination;
        if !illumination.has_highlights() || specular == Vec3::ZERO {
            return Bsdf::Diffuse(Diffuse {
                reflectance: colour,
            });
        }
        match illumination {
            Illumination::Mirror => Bsdf::Polished(Polished::new(colour, specular, Gain::Constant)),
            Illumination::FresnelMirror => {
                Bsdf::Polished(Polished::new(colour, specular, Gain::Fresnel))
            }
            // Programs write an exponent of 0 for matt materials.
            _ if material.shininess == 0.0 => Bsdf::Diffuse(Diffuse {
                reflectance: colour,
            }),
            _ => Bsdf::Phong(Phong::new(colour, specular, material.shininess)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::Plastic;
    use crate::mesh::{Assigned, Attributes, CornerValues, Runs, Sides, Texture, shapes::soup};
    use glam::UVec2;

    /// What `f` says of a triangle with a material and a texture, half red and transparent to 0.2, half white and opaque,
    /// where it is red.
    fn seen<T>(material: Material, f: impl FnOnce(&Appearance) -> T) -> T {
        let texels = [[255, 0, 0], [255; 3]];
        let texture = Texture::new("t", UVec2::new(2, 1), texels.as_flattened().to_vec());
        let texture = texture.expect("two texels").with_alpha(vec![51, 255]);
        let mesh = soup(&[[Vec3::ZERO, Vec3::X, Vec3::Y]]).with_attributes(Attributes {
            materials: Assigned::new(vec![material], Runs::default()),
            texture_coordinates: CornerValues::new(vec![Vec2::new(0.25, 0.5)], [[0; 3]]),
            textures: vec![texture],
            ..Attributes::default()
        });
        let scene = crate::scene::scene(mesh);
        let hit = Hit {
            t: 1.0,
            u: 0.25,
            v: 0.25,
            primitive: 0,
        };
        let material = scene.mesh().attributes().materials.get(0);
        f(&Appearance::new(&scene, material, &hit))
    }

    const MAP: TextureMap = TextureMap {
        texture: 0,
        scale: Vec2::ONE,
        offset: Vec2::ZERO,
    };

    fn statements(illumination: Illumination) -> Material {
        Material {
            diffuse: Some(Vec3::splat(0.5)),
            specular: Vec3::splat(0.25),
            refraction: 1.5,
            illumination,
            ..Material::default()
        }
    }

    #[test]
    fn each_illumination_model_of_the_mtl_format_has_its_bsdf() {
        let model = |material: Material| seen(material, |a| a.bsdf(true).model().name);
        for (illumination, expected) in [
            (Illumination::Constant, "diffuse"),
            (Illumination::Diffuse, "diffuse"),
            (Illumination::Highlights, "phong"),
            (Illumination::Mirror, "polished"),
            (Illumination::FresnelMirror, "polished"),
            (Illumination::Glass, "dielectric"),
        ] {
            assert_eq!(model(statements(illumination)), expected);
        }
        let rough = Material {
            roughness: Some(0.5),
            ..statements(Illumination::Highlights)
        };
        assert_eq!(model(rough), "metal-rough");
        // What programs write for materials that aren't glass.
        let same_index = Material {
            refraction: 1.0,
            ..statements(Illumination::Glass)
        };
        assert_eq!(model(same_index), "phong");
        let coverage = Material {
            opacity: 0.5,
            ..statements(Illumination::Glass)
        };
        assert_eq!(model(coverage), "phong");
    }

    #[test]
    fn textures_multiply_their_properties_and_alpha_the_opacity() {
        let all = [Property::Specular, Property::Emission, Property::Opacity];
        let material = Material {
            emission: Vec3::splat(2.0),
            opacity: 0.5,
            diffuse_map: Some(MAP),
            further_maps: all.map(|property| (property, MAP)).to_vec(),
            ..statements(Illumination::Highlights)
        };
        seen(material, |appearance| {
            assert_eq!(appearance.diffuse(), 0.5 * Vec3::X);
            assert_eq!(appearance.specular(), 0.25 * Vec3::X);
            assert_eq!(appearance.emission(), 2.0 * Vec3::X);
            // The file's opacity, and the alpha of both textures.
            let expected = 0.5 * 0.2 * 0.2;
            assert!((appearance.opacity() - expected).abs() < 1e-6);
        });
    }

    #[test]
    fn a_scene_files_sides_replace_the_statements_and_light_passes_through_both_sides_of_glass() {
        let plastic = Plastic::new(Vec3::ONE, Vec3::ONE, 1.5, false);
        let sides = |front, back| Material {
            sides: Some(Box::new(Sides { front, back })),
            diffuse_map: Some(MAP),
            ..Material::default()
        };
        let two = sides(Bsdf::Plastic(plastic), Some(Bsdf::Black(Black)));
        seen(two, |appearance| {
            assert_eq!(appearance.bsdf(true).colour(), Vec3::X);
            assert_eq!(appearance.bsdf(false), Bsdf::Black(Black));
        });
        let glass = Bsdf::Dielectric(Dielectric {
            eta: 1.5,
            reflectance: Vec3::ONE,
            transmittance: Vec3::ONE,
        });
        seen(sides(glass, None), |appearance| {
            assert_eq!(appearance.bsdf(false), glass);
        });
    }
}
