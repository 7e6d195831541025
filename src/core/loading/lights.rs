//! Lights of a scene file's emitters, and materials that emit light.

use super::refusal::Refusal;
use super::textures::Textures;
use crate::light::{
    DirectionalLight, Environment, EnvironmentMap, Light, MapPlacement, PlacedMap, PointLight,
};
use crate::mesh::{Illumination, Material, Property};
use crate::obj::LoadError;
use crate::scene_file::{EmitterKind, SceneFile, Texture};
use glam::{DMat3, DVec3, Vec3};
use std::collections::HashMap;
use std::sync::Arc;

/// The lights of emitters that aren't attached to a shape, in coordinates about an origin. `map` is the picture of the
/// file's `envmap`.
pub(super) fn lights(
    file: &SceneFile,
    origin: DVec3,
    map: Option<&Arc<EnvironmentMap>>,
) -> Vec<Light> {
    let light = |kind: &EmitterKind| match kind {
        EmitterKind::Constant { radiance } => {
            let radiance = radiance.as_vec3();
            Some(Light::Environment(Environment::Constant(radiance)))
        }
        EmitterKind::Point {
            position,
            intensity,
        } => Some(Light::Point(PointLight {
            position: (position - origin).as_vec3(),
            intensity: intensity.as_vec3(),
        })),
        EmitterKind::Directional {
            direction,
            irradiance,
        } => Some(Light::Directional(DirectionalLight {
            to_light: unit(-direction),
            irradiance: irradiance.as_vec3(),
        })),
        EmitterKind::Envmap {
            scale, to_world, ..
        } => map.map(|map| {
            let placement = MapPlacement {
                orientation: orthonormal(DMat3::from_mat4(*to_world)).as_mat3(),
                scale: *scale as f32,
                ..MapPlacement::default()
            };
            Light::Environment(Environment::Map(PlacedMap::new(Arc::clone(map), placement)))
        }),
        EmitterKind::Area { .. } | EmitterKind::Other(_) => None,
    };
    let emitters = file.emitters.iter();
    emitters
        .filter_map(|emitter| light(&emitter.kind))
        .collect()
}

/// Checks that the positions of lights are finite in f32.
///
/// # Errors
/// The first light in the file whose position isn't.
pub(super) fn require_near(file: &SceneFile, origin: DVec3) -> Result<(), LoadError> {
    for emitter in &file.emitters {
        if let EmitterKind::Point { position, .. } = emitter.kind
            && !(position - origin).as_vec3().is_finite()
        {
            let message =
                "the light is too far from the shapes for 32-bit numbers, which end at 3.4e38";
            return Err(Refusal::new(emitter.place, message).in_file(file));
        }
    }
    Ok(())
}

/// A vector other than 0 at length 1.
fn unit(vector: DVec3) -> Vec3 {
    // Scaled first, so that no square overflows or vanishes.
    (vector / vector.abs().max_element()).normalize().as_vec3()
}

/// The orthonormal matrix near a matrix that is nearly orthonormal.
fn orthonormal(matrix: DMat3) -> DMat3 {
    let x = matrix.x_axis.normalize();
    let y = matrix.y_axis.reject_from_normalized(x).normalize();
    let z = matrix.z_axis.reject_from_normalized(x);
    DMat3::from_cols(x, y, z.reject_from_normalized(y).normalize())
}

/// A copied material that emits light.
struct Copied {
    /// The index of the material, or `None` for a black one.
    material: Option<u32>,
    radiance: DVec3,
    /// In place of the radiance.
    texture: Option<Texture>,
}

/// Copies of materials that emit light on their front.
#[derive(Default)]
pub(super) struct EmittingMaterials {
    copies: Vec<Copied>,
    /// The indices of copies without texture.
    indices: HashMap<(Option<u32>, [u64; 3]), u32>,
}

impl EmittingMaterials {
    /// The index among the copies of a material that emits this radiance.
    pub fn index(
        &mut self,
        material: Option<u32>,
        radiance: DVec3,
        texture: Option<&Texture>,
    ) -> u32 {
        let next = self.copies.len() as u32;
        let bits = radiance.to_array().map(f64::to_bits);
        let index = match texture {
            None => *self.indices.entry((material, bits)).or_insert(next),
            Some(_) => next,
        };
        if index == next {
            self.copies.push(Copied {
                material,
                radiance,
                texture: texture.cloned(),
            });
        }
        index
    }

    /// Appends the copies to the list of materials.
    pub fn append_to(&self, materials: &mut Vec<Material>, textures: &Textures) {
        for copy in &self.copies {
            let copied = copy
                .material
                .and_then(|index| materials.get(index as usize));
            // What Mitsuba uses for an emitting shape without a bsdf.
            let black = || Material {
                diffuse: Some(Vec3::ZERO),
                illumination: Illumination::Diffuse,
                ..Material::default()
            };
            let mut material = Material {
                emission: copy.radiance.as_vec3(),
                emits_on_back: false,
                ..copied.cloned().unwrap_or_else(black)
            };
            let map = copy
                .texture
                .as_ref()
                .and_then(|texture| textures.map(texture));
            let map = map.map(|map| (Property::Emission, map));
            material.further_maps.extend(map);
            materials.push(material);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn emitting_shapes_share_copies_of_their_materials() {
        let red = Material {
            diffuse: Some(Vec3::X),
            ..Material::named("red")
        };
        let mut materials = vec![Material::default(), red.clone()];
        let mut emitting = EmittingMaterials::default();
        let asked = [(Some(1), 2.0), (None, 2.0), (Some(1), 3.0), (Some(1), 2.0)];
        let indices = asked.map(|(index, all)| emitting.index(index, DVec3::splat(all), None));
        assert_eq!(indices, [0, 1, 2, 0]);
        emitting.append_to(&mut materials, &Textures::default());
        assert_eq!(materials.len(), 5);
        assert_eq!(materials[1], red, "the original emits nothing");
        let copy = Material {
            emission: Vec3::splat(2.0),
            emits_on_back: false,
            ..red
        };
        assert_eq!(materials[2], copy);
        assert_eq!(materials[3].diffuse, Some(Vec3::ZERO));
    }

    #[test]
    fn a_rotation_with_few_digits_becomes_orthonormal() {
        let typed = DMat3::from_cols(
            DVec3::new(0.866, 0.0, -0.5),
            DVec3::Y,
            DVec3::new(0.5, 0.0, 0.866),
        );
        let exact = orthonormal(typed);
        assert!(exact.abs_diff_eq(typed, 1e-4));
        let product = exact.transpose() * exact;
        assert!(product.abs_diff_eq(DMat3::IDENTITY, 1e-15), "{product}");
        let mirrored = DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0));
        assert_eq!(orthonormal(mirrored), mirrored);
    }

    #[test]
    fn directions_of_any_length_become_unit_vectors() {
        for length in [1e-320, 1e-200, 1.0, 1e300] {
            let along = unit(DVec3::new(0.0, 3.0 * length, -4.0 * length));
            assert!(
                (along - Vec3::new(0.0, 0.6, -0.8)).length() < 1e-3,
                "{length}"
            );
        }
    }
}
