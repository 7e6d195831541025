//! Parameters of models that textures can give.

use super::{Bsdf, Conductor, Dielectric, Diffuse, Plastic, RoughConductor, RoughDielectric};
use super::{RoughPlastic, ThinDielectric};
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
    /// The model with another value of a parameter; the same model if it has no such parameter. A value that isn't from 0
    /// to 1 is clamped, NaN counts as 0. Roughness is the brightness of the value.
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

    fn colour_of(&mut self, slot: Slot) -> Option<&mut Vec3> {
        match (slot, self) {
            (
                Slot::Diffuse,
                Self::Diffuse(Diffuse {
                    reflectance: colour,
                })
                | Self::Plastic(Plastic {
                    diffuse: colour, ..
                })
                | Self::RoughPlastic(RoughPlastic {
                    diffuse: colour, ..
                }),
            )
            | (
                Slot::Specular,
                Self::Conductor(Conductor {
                    reflectance: colour,
                    ..
                })
                | Self::RoughConductor(RoughConductor {
                    metal:
                        Conductor {
                            reflectance: colour,
                            ..
                        },
                    ..
                })
                | Self::Dielectric(Dielectric {
                    reflectance: colour,
                    ..
                })
                | Self::RoughDielectric(RoughDielectric {
                    media:
                        Dielectric {
                            reflectance: colour,
                            ..
                        },
                    ..
                })
                | Self::ThinDielectric(ThinDielectric {
                    reflectance: colour,
                    ..
                })
                | Self::Plastic(Plastic {
                    specular: colour, ..
                })
                | Self::RoughPlastic(RoughPlastic {
                    specular: colour, ..
                }),
            )
            | (
                Slot::Transmittance,
                Self::Dielectric(Dielectric {
                    transmittance: colour,
                    ..
                })
                | Self::RoughDielectric(RoughDielectric {
                    media:
                        Dielectric {
                            transmittance: colour,
                            ..
                        },
                    ..
                })
                | Self::ThinDielectric(ThinDielectric {
                    transmittance: colour,
                    ..
                }),
            ) => Some(colour),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Law, MODELS, Microfacets, Scatter};
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
