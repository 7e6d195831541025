//! Descriptions of how surfaces scatter light.

use glam::DVec3;

/// A model with its parameters. Colours are linear RGB from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bsdf {
    /// `diffuse`.
    Diffuse {
        /// The reflectance.
        reflectance: DVec3,
    },
    /// `conductor` and `roughconductor`.
    Conductor {
        /// The real part of the index of refraction.
        eta: DVec3,
        /// The imaginary part.
        k: DVec3,
        /// Multiplies reflected light.
        specular_reflectance: DVec3,
        /// `None` if it is smooth.
        roughness: Option<Roughness>,
    },
    /// `dielectric`, `thindielectric` and `roughdielectric`.
    Dielectric {
        /// The index of refraction behind the surface, or of the pane, relative to that in front.
        eta: f64,
        /// Multiplies reflected light.
        specular_reflectance: DVec3,
        /// Multiplies light that passes.
        specular_transmittance: DVec3,
        /// How the surface is formed.
        form: Form,
    },
    /// `plastic` and `roughplastic`.
    Plastic {
        /// The index of refraction of the coat, relative to that in front.
        eta: f64,
        /// The reflectance of the base.
        diffuse_reflectance: DVec3,
        /// Multiplies the light that the coat reflects.
        specular_reflectance: DVec3,
        /// Whether light gains colour each time that the base reflects it.
        is_nonlinear: bool,
        /// `None` if it is smooth.
        roughness: Option<Roughness>,
    },
}

/// The form of the surface of a transparent medium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// Smooth.
    Smooth,
    /// Smooth, on both sides of a thin pane.
    Thin,
    /// Rough.
    Rough(Roughness),
}

/// The distribution of microfacets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// Whether it is `ggx` instead of `beckmann`.
    pub is_ggx: bool,
    /// The roughness.
    pub alpha: f64,
}

impl Bsdf {
    /// A diffuse reflectance of 0.5, which is Mitsuba's default.
    pub const GREY: Self = Self::Diffuse {
        reflectance: DVec3::splat(0.5),
    };

    /// Whether light passes through.
    pub fn transmits(&self) -> bool {
        matches!(self, Self::Dielectric { .. })
    }
}
