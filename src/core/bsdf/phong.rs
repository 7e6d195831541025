//! Diffuse surfaces with a glossy highlight: the MTL format's `Kd`, `Ks` and `Ns`.
//!
//! Source: Lafortune, Willems, "Using the Modified Phong Reflectance Model for Physically Based Rendering", Report CW197,
//! Leuven, 1994.

use super::coat::probability;
use super::diffuse::{cosine_density, cosine_direction};
use super::optics::mirrored;
use super::{Bsdf, Frame, Model, Scatter, Scattered};
use glam::{Vec2, Vec3};
use std::f32::consts::TAU;

/// A diffuse part, and a highlight about the direction of reflection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    diffuse: Vec3,
    specular: Vec3,
    /// The highlight falls off with this power of the cosine to the direction of reflection.
    exponent: f32,
}

impl Phong {
    /// Both reflectances are scaled down if they reflect more light than arrives. The exponent is at least 0.
    pub fn new(diffuse: Vec3, specular: Vec3, exponent: f32) -> Self {
        let scale = (diffuse + specular).max_element().max(1.0);
        Self {
            diffuse: diffuse / scale,
            specular: specular / scale,
            exponent: exponent.max(0.0),
        }
    }

    /// The density of directions about the direction of reflection.
    fn highlight(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        let cos = mirrored(outgoing).dot(incoming).clamp(0.0, 1.0);
        (self.exponent + 1.0) / TAU * libm::powf(cos, self.exponent)
    }

    fn highlight_probability(&self) -> f32 {
        probability(self.specular, self.diffuse)
    }
}

pub(super) static PHONG: Model = Model {
    name: "phong",
    source: "Lafortune, Willems, Using the Modified Phong Reflectance Model for Physically Based Rendering, 1994",
    transmits: false,
    is_specular: false,
    is_reciprocal: true,
    uses_point: true,
    uses_choice: true,
    examples: || {
        let of = |kd, ks, exponent| {
            Bsdf::Phong(Phong::new(
                Vec3::splat(kd),
                Vec3::new(ks, 0.5 * ks, 0.1),
                exponent,
            ))
        };
        vec![of(0.5, 0.3, 20.0), of(0.0, 1.0, 100.0), of(1.0, 1.0, 3.0)]
    },
};

impl Scatter for Phong {
    fn model(&self) -> &'static Model {
        &PHONG
    }

    fn colour(&self) -> Vec3 {
        self.diffuse + self.specular
    }

    fn evaluate(&self, outgoing: Vec3, incoming: Vec3) -> Vec3 {
        if outgoing.z <= 0.0 || incoming.z <= 0.0 {
            return Vec3::ZERO;
        }
        // The highlight reflects at most `specular`, along the normal: (n + 2)/2π times the cosine's power.
        let scale = (self.exponent + 2.0) / (self.exponent + 1.0);
        let highlight = scale * self.highlight(outgoing, incoming) * incoming.z;
        self.diffuse * cosine_density(outgoing, incoming) + self.specular * highlight
    }

    fn sample(&self, outgoing: Vec3, at: Vec2, choice: f32) -> Option<Scattered> {
        let incoming = if choice < self.highlight_probability() {
            let z = libm::powf(1.0 - at.x, 1.0 / (self.exponent + 1.0));
            let radius = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
            let (sin, cos) = libm::sincosf(TAU * at.y);
            let about = Frame::about(mirrored(outgoing));
            about.to_world(Vec3::new(radius * cos, radius * sin, z))
        } else {
            cosine_direction(at)
        };
        Scattered::by_density(self, outgoing, incoming)
    }

    fn density(&self, outgoing: Vec3, incoming: Vec3) -> f32 {
        if outgoing.z <= 0.0 || incoming.z <= 0.0 {
            return 0.0;
        }
        let highlight = self.highlight_probability();
        highlight * self.highlight(outgoing, incoming)
            + (1.0 - highlight) * cosine_density(outgoing, incoming)
    }
}
