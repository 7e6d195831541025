//! What a surface looks like at a hit: its material with textures and vertex colours.

use crate::brightness::MAX_BRIGHTNESS;
use crate::bsdf::{Black, Bsdf, Scatter};
use crate::interaction::{SurfaceInteraction, texture_coordinates, texture_frame, vertex_colour};
use crate::mesh::{Material, Property, Relief, Side, TextureMap, Tilt};
use crate::ray::{Hit, Ray};
use crate::scene::Scene;
use crate::srgb::{from_display, luminance};
use crate::statements::{self, CLAY, Values};
use glam::{Vec2, Vec3};
use std::borrow::Cow;
use std::cell::OnceCell;

/// A material at a hit.
pub(crate) struct Appearance<'a> {
    scene: &'a Scene,
    material: Option<&'a Material>,
    position: Vec3,
    hit: Hit,
    /// Texture coordinates, computed on first use.
    uv: OnceCell<Option<Vec2>>,
}

impl<'a> Appearance<'a> {
    pub fn new(
        scene: &'a Scene,
        material: Option<&'a Material>,
        position: Vec3,
        hit: &Hit,
    ) -> Self {
        Self {
            scene,
            material,
            position,
            hit: *hit,
            uv: OnceCell::new(),
        }
    }

    /// Texture coordinates. A face without them shows no texture.
    fn uv(&self) -> Option<Vec2> {
        let found = || texture_coordinates(self.scene, self.position, &self.hit);
        *self.uv.get_or_init(found)
    }

    /// The value of a property's texture, from 0 to 1; 1 without one.
    fn value(&self, material: &Material, property: Property) -> Vec3 {
        let map = material.further_map(property);
        self.of_texture(map).unwrap_or(Vec3::ONE)
    }

    /// The value of a texture, at most 1: no surface reflects more light than arrives.
    fn of_texture(&self, map: Option<&TextureMap>) -> Option<Vec3> {
        self.unclamped(map).map(|value| value.min(Vec3::ONE))
    }

    /// The value of a texture, which may exceed 1 in linear pictures.
    fn unclamped(&self, map: Option<&TextureMap>) -> Option<Vec3> {
        let textures = &self.scene.mesh().attributes().textures;
        Some(map?.value(textures, self.uv()?))
    }

    /// The product of the colours of texture and vertices, if there are any.
    fn tint(&self) -> Option<Vec3> {
        let map = self
            .material
            .and_then(|material| material.diffuse_map.as_ref());
        let of_vertices = vertex_colour(self.scene, &self.hit).map(from_display);
        let colours = [self.of_texture(map), of_vertices].into_iter().flatten();
        colours.reduce(|a, b| a * b)
    }

    /// The product of the colours of material, texture and vertices; clay if there are none.
    pub fn diffuse(&self) -> Vec3 {
        let of_material = match self.material.and_then(|m| m.sides.as_deref()) {
            Some(sides) if !sides.front.maps.is_empty() => {
                Some(self.textured(&sides.front).colour())
            }
            _ => self.material.and_then(|material| material.diffuse),
        };
        let colours = [of_material, self.tint()].into_iter().flatten();
        colours.reduce(|a, b| a * b).unwrap_or(CLAY)
    }

    /// The specular reflectance.
    pub fn specular(&self) -> Vec3 {
        let specular = |m: &Material| m.specular * self.value(m, Property::Specular);
        self.material.map_or(Vec3::ZERO, specular)
    }

    /// The light that is emitted by either side, at most [`MAX_BRIGHTNESS`].
    pub fn emission(&self) -> Vec3 {
        match self.material {
            Some(material) if material.emission != Vec3::ZERO => {
                let value = self.unclamped(material.further_map(Property::Emission));
                let light = material.emission * value.unwrap_or(Vec3::ONE);
                light.min(Vec3::splat(MAX_BRIGHTNESS))
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
            let brightness = || luminance(self.value(material, Property::Opacity));
            opacity *= alpha(Some(map)).unwrap_or_else(brightness);
        }
        opacity
    }

    /// How the front or the back scatters light. Borrowed from a scene file's material where nothing changes it: copies are
    /// large.
    pub fn bsdf(&self, is_front: bool) -> Cow<'a, Bsdf> {
        let Some(material) = self.material else {
            return Cow::Owned(self.of_statements(&Material::default()));
        };
        if material.sides.is_none() {
            let bsdf = self.of_statements(material);
            let is_visible = is_front || material.is_two_sided || bsdf.model().transmits;
            return Cow::Owned(if is_visible { bsdf } else { Bsdf::Black(Black) });
        }
        let Some(side) = self.side(is_front) else {
            return Cow::Owned(Bsdf::Black(Black));
        };
        let bsdf = self.textured(side);
        match vertex_colour(self.scene, &self.hit) {
            Some(colour) => Cow::Owned(bsdf.tinted(from_display(colour))),
            None => bsdf,
        }
    }

    /// The side of a material of a scene file; `None` for others, and for a back that is black.
    fn side(&self, is_front: bool) -> Option<&'a Side> {
        let sides = self.material?.sides.as_deref()?;
        if is_front || sides.front.bsdf.model().transmits {
            return Some(&sides.front);
        }
        sides.back.as_ref()
    }

    /// The model of a side with the values of its textures.
    fn textured<'s>(&self, side: &'s Side) -> Cow<'s, Bsdf> {
        if side.maps.is_empty() {
            return Cow::Borrowed(&side.bsdf);
        }
        let value = |map| self.of_texture(Some(map));
        let values = side.maps.iter();
        let values = values.filter_map(|(slot, map)| Some((*slot, value(map)?)));
        Cow::Owned(values.fold(side.bsdf, |bsdf, (slot, value)| bsdf.with(slot, value)))
    }

    /// The texture that tilts the shading normal.
    fn relief(&self, is_front: bool) -> Option<&'a Relief> {
        let material = self.material?;
        match material.sides {
            Some(_) => self.side(is_front)?.relief.as_ref(),
            None => material.relief.as_ref(),
        }
    }

    /// How a texture tilts the front's shading normal, on either side.
    pub fn tilt(&self, normal: Vec3, is_front: bool) -> Option<Tilt> {
        let relief = self.relief(is_front)?;
        let frame = texture_frame(self.scene, self.position, &self.hit)?;
        relief.tilt(normal, &frame, &self.scene.mesh().attributes().textures)
    }

    /// The shading normal, tilted by a texture, on the side that the ray comes from.
    pub fn facing_normal(&self, surface: &SurfaceInteraction, ray: &Ray) -> Vec3 {
        let is_front = surface.geometric_normal.dot(ray.dir) <= 0.0;
        let normal = surface.facing_normal(ray);
        match self.tilt(surface.shading_normal, is_front) {
            Some(tilt) => tilt.applied_to(normal, (-ray.dir).normalize_or(normal)),
            None => normal,
        }
    }

    /// What the statements of a material library say.
    fn of_statements(&self, material: &Material) -> Bsdf {
        let values = Values {
            diffuse: self.diffuse(),
            specular: self.specular(),
            metalness: self.value(material, Property::Metalness).x,
            roughness: self.value(material, Property::Roughness).x,
        };
        statements::bsdf(material, values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bsdf::{Dielectric, Plastic, Slot};
    use crate::mesh::{
        Assigned, Attributes, Bitangent, CornerValues, Encoding, Illumination, ReliefKind, Runs,
        Sides, Texture, shapes::soup,
    };
    use crate::scene::Shading;
    use glam::UVec2;

    const HIT: Hit = Hit {
        t: 1.0,
        u: 0.25,
        v: 0.25,
        primitive: 0,
    };

    /// A triangle in the plane z = 0 with a material and a texture.
    fn triangle(material: Material, coordinates: CornerValues<Vec2>, texture: Texture) -> Scene {
        crate::scene::scene(
            soup(&[[Vec3::ZERO, Vec3::X, Vec3::Y]]).with_attributes(Attributes {
                materials: Assigned::new(vec![material], Runs::default()),
                texture_coordinates: coordinates,
                textures: vec![texture],
                ..Attributes::default()
            }),
        )
    }

    /// What `f` says of a triangle with a material and a texture, half red and transparent to 0.2, half white and opaque,
    /// where it is red.
    fn seen<T>(material: Material, f: impl FnOnce(&Appearance) -> T) -> T {
        let texels = [[255, 0, 0], [255; 3]];
        let texture = Texture::new("t", UVec2::new(2, 1), texels.as_flattened().to_vec());
        let texture = texture.expect("two texels").with_alpha(vec![51, 255]);
        let coordinates = CornerValues::new(vec![Vec2::new(0.25, 0.5)], [[0; 3]]);
        let scene = triangle(material, coordinates, texture);
        let material = scene.mesh().attributes().materials.get(0);
        f(&Appearance::new(&scene, material, Vec3::splat(0.25), &HIT))
    }

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
            diffuse_map: Some(TextureMap::of(0)),
            further_maps: all.map(|property| (property, TextureMap::of(0))).to_vec(),
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
    fn a_normal_map_leans_the_normal_that_faces_the_viewer_along_the_texture() {
        let texture = Texture::new("t", UVec2::ONE, vec![255, 128, 191]).expect("a texel");
        let coordinates = vec![Vec2::ZERO, Vec2::X, Vec2::Y];
        let kind = ReliefKind::Normals {
            strength: 1.0,
            bitangent: Bitangent::AlongTexture,
        };
        let map = TextureMap::of(0).encoded(Encoding::Linear);
        let material = Material {
            relief: Some(Relief { map, kind }),
            ..Material::default()
        };
        let coordinates = CornerValues::new(coordinates, [[0, 1, 2]]);
        let scene = triangle(material.clone(), coordinates, texture);
        for side in [Vec3::Z, Vec3::NEG_Z] {
            let ray = Ray::new(Vec3::new(0.25, 0.25, 0.0) + side, -side).expect("a ray");
            let appearance = Appearance::new(&scene, Some(&material), Vec3::ZERO, &HIT);
            let surface = SurfaceInteraction::new(&scene, &ray, HIT, Shading::Flat);
            let normal = appearance.facing_normal(&surface, &ray);
            // The texel stands for (1, 0.004, 0.498).
            let expected = Vec3::new(1.0, 0.004, 0.0) + 0.498 * side;
            assert!((normal - expected.normalize()).length() < 1e-3, "{normal}");
        }
    }

    #[test]
    fn a_scene_files_sides_replace_the_statements_and_light_passes_through_both_sides_of_glass() {
        let plastic = Plastic::new(Vec3::ONE, Vec3::ONE, 1.5, false);
        let mapped = |bsdf: Bsdf| Side {
            maps: vec![(Slot::Diffuse, TextureMap::of(0))],
            ..bsdf.into()
        };
        let sides = |front, back: Option<Bsdf>| Material {
            sides: Some(Box::new(Sides {
                front: mapped(front),
                back: back.map(Side::from),
            })),
            ..Material::default()
        };
        let two = sides(Bsdf::Plastic(plastic), Some(Bsdf::Black(Black)));
        seen(two, |appearance| {
            assert_eq!(appearance.bsdf(true).colour(), Vec3::X);
            assert_eq!(*appearance.bsdf(false), Bsdf::Black(Black));
            assert_eq!(appearance.diffuse(), Vec3::X);
        });
        let glass = Bsdf::Dielectric(Dielectric {
            eta: 1.5,
            reflectance: Vec3::ONE,
            transmittance: Vec3::ONE,
        });
        seen(sides(glass, None), |appearance| {
            assert_eq!(*appearance.bsdf(false), glass);
        });
    }
}
