//! Parameters of models that textures and vertex colours change.

use super::{Bsdf, RoughConductor, RoughDielectric};
use crate::srgb::luminance;
use glam::Vec3;

/// A parameter that a texture can give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slot {
    /// The reflectance of a diffuse surface or of the base of plastic.
    Diffuse,
    /// The factor of light that is reflected as by a mirror or by facets.
    Specular,
    /// The factor of light that passes.
    Transmittance,
    /// The roughness of facets.
    Roughness,
}

impl Bsdf {
    /// The model with another value of a parameter; the same model if it has no such parameter. The value is clamped to
    /// 0…1; NaN counts as 0. Roughness is the brightness of the value.
    #[must_use]
    pub fn with(mut self, slot: Slot, value: Vec3) -> Self {
        let value = value.max(Vec3::ZERO).min(Vec3::ONE);
        match slot {
            Slot::Roughness => {
                if let Self::RoughConductor(RoughConductor { facets, .. })
                | Self::RoughDielectric(RoughDielectric { facets, .. }) = &mut self
                {
                    *facets = facets.with_roughness(luminance(value));
                }
            }
            _ => {
                if let Some(colour) = self.colour_of(slot) {
                    *colour = value;
                }
            }
        }
        self
    }

    /// The model with its diffuse reflectance multiplied by a colour; the same model if it has none.
    #[must_use]
    pub fn tinted(mut self, colour: Vec3) -> Self {
        if let Some(diffuse) = self.colour_of(Slot::Diffuse) {
            *diffuse *= colour;
        }
        self
    }

    fn colour_of(&mut self, slot: Slot) -> Option<&mut Vec3> {
        Some(match (slot, self) {
            (Slot::Diffuse, Self::Diffuse(model)) => &mut model.reflectance,
            (Slot::Diffuse, Self::Plastic(model)) => &mut model.diffuse,
            (Slot::Diffuse, Self::RoughPlastic(model)) => &mut model.diffuse,
            (Slot::Specular, Self::Conductor(model)) => &mut model.reflectance,
            (Slot::Specular, Self::RoughConductor(model)) => &mut model.metal.reflectance,
            (Slot::Specular, Self::Dielectric(model)) => &mut model.reflectance,
            (Slot::Specular, Self::RoughDielectric(model)) => &mut model.media.reflectance,
            (Slot::Specular, Self::ThinDielectric(model)) => &mut model.reflectance,
            (Slot::Specular, Self::Plastic(model)) => &mut model.specular,
            (Slot::Specular, Self::RoughPlastic(model)) => &mut model.specular,
            (Slot::Transmittance, Self::Dielectric(model)) => &mut model.transmittance,
            (Slot::Transmittance, Self::RoughDielectric(model)) => &mut model.media.transmittance,
            (Slot::Transmittance, Self::ThinDielectric(model)) => &mut model.transmittance,
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Conductor, Diffuse, Law, MODELS, Microfacets, Scatter};
    use super::*;

    #[test]
    fn a_texture_replaces_only_the_parameter_of_its_slot() {
        let grey = Bsdf::Diffuse(Diffuse {
            reflectance: Vec3::splat(0.5),
        });
        assert_eq!(grey.with(Slot::Diffuse, Vec3::X).colour(), Vec3::X);
        assert_eq!(grey.with(Slot::Specular, Vec3::X), grey);
        assert_eq!(grey.with(Slot::Diffuse, Vec3::NAN).colour(), Vec3::ZERO);
        let metal = |alpha| {
            Bsdf::RoughConductor(RoughConductor {
                metal: Conductor {
                    eta: Vec3::ZERO,
                    k: Vec3::ONE,
                    reflectance: Vec3::ONE,
                },
                facets: Microfacets::new(Law::Ggx, alpha),
            })
        };
        let rough = metal(0.1).with(Slot::Roughness, Vec3::ONE);
        // The weights of red, green and blue sum to 1 up to rounding.
        let expected = metal(luminance(Vec3::ONE));
        assert_eq!(rough, expected);
    }

    #[test]
    fn no_value_of_a_texture_breaks_a_model() {
        let slots = [
            Slot::Diffuse,
            Slot::Specular,
            Slot::Transmittance,
            Slot::Roughness,
        ];
        let up = Vec3::new(0.6, 0.0, 0.8);
        for bsdf in MODELS.iter().flat_map(|model| (model.examples)()) {
            for slot in slots {
                for value in [Vec3::ZERO, Vec3::ONE, Vec3::splat(9.0), Vec3::NAN] {
                    let changed = bsdf.with(slot, value);
                    assert!(changed.evaluate(up, Vec3::Z).is_finite(), "{changed:?}");
                }
            }
        }
    }
}
