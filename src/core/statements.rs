//! The BSDF that the statements of a material library describe.

use crate::bsdf::{Bsdf, Dielectric, Diffuse, Gain, MetalRough, Phong, Polished};
use crate::mesh::{Illumination, Material, Property};
use glam::Vec3;

/// Reflectance of faces without a material.
pub(crate) const CLAY: Vec3 = Vec3::new(0.68, 0.66, 0.63);

/// What textures and vertex colours make of a material's properties at a point.
pub(crate) struct Values {
    /// The diffuse reflectance.
    pub diffuse: Vec3,
    /// The specular reflectance.
    pub specular: Vec3,
    /// The factor of the metalness.
    pub metalness: f32,
    /// The factor of the roughness.
    pub roughness: f32,
}

/// The BSDF of a material without sides of their own.
pub(crate) fn bsdf(material: &Material, values: Values) -> Bsdf {
    if material.is_glass() {
        return Bsdf::Dielectric(Dielectric {
            eta: material.refraction,
            reflectance: Vec3::ONE,
            transmittance: material.filter.unwrap_or(Vec3::ONE),
        });
    }
    let Values {
        diffuse, specular, ..
    } = values;
    let has = |property| material.further_map(property).is_some();
    let [has_roughness, has_metalness] = [
        material.roughness.is_some() || has(Property::Roughness),
        material.metalness.is_some() || has(Property::Metalness),
    ];
    if has_roughness || has_metalness {
        // A texture alone gives the whole value. Without a statement, nothing is a metal, and all is rough.
        let metalness = material
            .metalness
            .unwrap_or(if has_metalness { 1.0 } else { 0.0 });
        return Bsdf::MetalRough(MetalRough::new(
            diffuse,
            metalness * values.metalness,
            material.roughness.unwrap_or(1.0) * values.roughness,
        ));
    }
    let matt = Bsdf::Diffuse(Diffuse {
        reflectance: diffuse,
    });
    let illumination = material.illumination;
    if !illumination.has_highlights() || specular == Vec3::ZERO {
        return matt;
    }
    match illumination {
        Illumination::Mirror => Bsdf::Polished(Polished::new(diffuse, specular, Gain::Constant)),
        Illumination::FresnelMirror => {
            Bsdf::Polished(Polished::new(diffuse, specular, Gain::Fresnel))
        }
        // Programs write an exponent of 0 for matt materials.
        _ if material.shininess == 0.0 => matt,
        _ => Bsdf::Phong(Phong::new(diffuse, specular, material.shininess)),
    }
}

impl Material {
    /// How the front scatters light, without textures and vertex colours.
    pub fn bsdf(&self) -> Bsdf {
        if let Some(sides) = &self.sides {
            return sides.front.bsdf;
        }
        let values = Values {
            diffuse: self.diffuse.unwrap_or(CLAY),
            specular: self.specular,
            metalness: 1.0,
            roughness: 1.0,
        };
        bsdf(self, values)
    }
}
