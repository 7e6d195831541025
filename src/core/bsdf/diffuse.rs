//! Perfectly diffuse surfaces: they look equally bright from everywhere.
//!
//! Source: J. H. Lambert, "Photometria", 1760.

use super::{Bsdf, Model, Scatter, Scattered};
use crate::shape::in_disk;
use glam::{Vec2, Vec3};
use std::f32::consts::FRAC_1_PI;

/// A surface that reflects a part of the light equally to all directions on its front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse {
    /// The part that is reflected, in linear RGB; at most 1.
    pub reflectance: Vec3,
}

pub(super) static DIFFUSE: Model = Model {
    name: "diffuse",
    source: "Lambert, Photometria, 1760",
    transmits: false,
    is_specular: false,
    is_reciprocal: true,
    uses_point: true,
    uses_choice: false,
    examples: || {
        let grey = |x| {
            Bsdf::Diffuse(Diffuse {
                reflectance: Vec3::splat(x),
            })
        };
        vec![grey(0.5), grey(1.0)]
    },
};

/// A direction about the z axis with a density of cos θ / π.
///
/// Source: Malley's method; Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, 2023, A.5.3.
#[inline]
pub(crate) fn cosine_direction(at: Vec2) -> Vec3 {
    let (disk, radius) = in_disk(at);
    disk.extend(((1.0 - radius) * (1.0 + radius)).sqrt())
}

/// The density of [`cosine_direction`] for light that comes from `incoming`; 0 unless both directions are on the front.
#[inline]
pub(super) fn cosine_density(outgoing: Vec3, incoming: Vec3) -> f32 {
    if outgoing.z > 0.0 && incoming.z > 0.0 {
        FRAC_1_PI * incoming.z
    } else {
        0.0
    }
}

impl Scatter for Diffuse {
    fn model(&self) -> &'static Model {
        &DIFFUSE
    }

    fn colour(&self) -> Vec3 {
        self.reflectance
    }

    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3 {
        self.reflectance * cosine_density(outgoing, incoming)
    }

    fn sample(&self, outgoing: Vec3, at: Vec2, _: f32) -> Option<Scattered> {
        let incoming = cosine_direction(at);
        let density = cosine_density(outgoing, incoming);
        (density > 0.0).then(|| Scattered::reflected(incoming, self.reflectance, Some(density)))
    }

    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        cosine_density(outgoing, incoming)
    }
}
