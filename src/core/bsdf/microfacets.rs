//! Distributions of the normals of microfacets, the mirrors that rough surfaces consist of.
//!
//! Sources: Walter et al., "Microfacet Models for Refraction through Rough Surfaces", EGSR 2007; visible normals: Heitz,
//! d'Eon, "Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals", EGSR 2014; Heitz,
//! "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018.

use crate::shape::in_disk;
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_1_PI, PI};

/// The law of the distribution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// That of Trowbridge and Reitz, with long tails.
    Ggx,
    /// That of a surface whose slopes are normally distributed.
    Beckmann,
}

/// A distribution of normals that is the same in all directions about the z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microfacets {
    law: Law,
    /// Roughness.
    alpha: f32,
}

/// Less roughness can't be told from a mirror in f32.
const LEAST_ALPHA: f32 = 1e-4;

impl Microfacets {
    /// The distribution of a roughness from 0 to 1; for Beckmann's law, √½ of it is the standard deviation of slopes.
    pub fn new(law: Law, alpha: f32) -> Self {
        Self {
            law,
            alpha: alpha.max(LEAST_ALPHA),
        }
    }

    /// The same law with another roughness.
    pub(super) fn with_roughness(self, alpha: f32) -> Self {
        Self::new(self.law, alpha)
    }

    /// The area of facets with normal `m` per area of the surface and solid angle.
    pub(super) fn area(&self, m: Vec3) -> f32 {
        if m.z <= 0.0 {
            return 0.0;
        }
        let (squared_alpha, squared_cos) = (self.alpha * self.alpha, m.z * m.z);
        let x = (m.x * m.x + m.y * m.y) / squared_alpha;
        match self.law {
            Law::Ggx => {
                let sum = x + squared_cos;
                FRAC_1_PI / (squared_alpha * sum * sum)
            }
            Law::Beckmann => {
                let scale = PI * squared_alpha * squared_cos * squared_cos;
                libm::expf(-x / squared_cos) / scale
            }
        }
    }

    /// The part of the facets with normal `m` that is visible from `v`, by Smith.
    pub(super) fn visible_part(&self, v: Vec3, m: Vec3) -> f32 {
        if v.dot(m) * v.z <= 0.0 {
            return 0.0;
        }
        let squared_tan = (v.x * v.x + v.y * v.y) / (v.z * v.z);
        let slope = self.alpha * self.alpha * squared_tan;
        match self.law {
            Law::Ggx => 2.0 / (1.0 + (1.0 + slope).sqrt()),
            Law::Beckmann => {
                let a = 1.0 / slope.sqrt();
                // Beyond, the rest is less than f32 can add to 2.
                if a > 4.0 {
                    return 1.0;
                }
                let tail = libm::expf(-a * a) * slope.sqrt() / PI.sqrt();
                2.0 / (1.0 + libm::erff(a) + tail)
            }
        }
    }

    /// The density of the normals that are visible from `v`, which is on the front.
    pub(super) fn visible_density(&self, v: Vec3, m: Vec3) -> f32 {
        self.area(m) * self.visible_part(v, m) * v.dot(m).abs() / v.z.abs()
    }

    /// The mean of a function of the normal over the facets that are visible from `v`, which is on the front, in the
    /// plane y = 0. The function doesn't depend on the sign of y.
    ///
    /// The sum over normals at angles whose tangents are alpha·r/(1 − r), for which the area varies slowly. The mean of 1
    /// is 1 to 5e-4.
    pub(super) fn visible_mean(&self, v: Vec3, f: impl Fn(Vec3) -> f32) -> f32 {
        const RINGS: usize = 64;
        const STEPS: usize = 24;
        let mut sum = 0.0;
        for i in 0..RINGS {
            let r = (i as f32 + 0.5) / RINGS as f32;
            let tan = self.alpha * r / (1.0 - r);
            let z = 1.0 / (1.0 + tan * tan).sqrt();
            // dω = sin θ dθ dφ, dθ = cos² θ d tan θ.
            let width = self.alpha / ((1.0 - r) * (1.0 - r) * RINGS as f32);
            let solid_angle = tan * z * z * z * width * (2.0 * PI / STEPS as f32);
            for j in 0..STEPS {
                let (sin, cos) = libm::sincosf((j as f32 + 0.5) / STEPS as f32 * PI);
                let m = Vec3::new(tan * z * cos, tan * z * sin, z);
                if v.dot(m) > 0.0 {
                    let part = solid_angle * self.visible_density(v, m);
                    sum += f64::from(part * f(m));
                }
            }
        }
        sum as f32
    }

    /// A normal with the density [`visible_density`](Self::visible_density).
    pub(super) fn sample_visible(&self, v: Vec3, at: Vec2) -> Vec3 {
        let stretched = Vec3::new(self.alpha * v.x, self.alpha * v.y, v.z).normalize();
        let m = match self.law {
            Law::Ggx => ggx_normal(stretched, at),
            Law::Beckmann => beckmann_normal(stretched, at),
        };
        Vec3::new(self.alpha * m.x, self.alpha * m.y, m.z.max(0.0)).normalize_or(Vec3::Z)
    }
}

/// A visible normal for roughness 1: a point of the projected hemisphere, half of which is seen at an angle.
fn ggx_normal(v: Vec3, at: Vec2) -> Vec3 {
    let squared = v.x * v.x + v.y * v.y;
    let x = if squared > 0.0 {
        Vec3::new(-v.y, v.x, 0.0) / squared.sqrt()
    } else {
        Vec3::X
    };
    let y = v.cross(x);
    let (disk, _) = in_disk(at);
    let s = 0.5 * (1.0 + v.z);
    let rest = (1.0 - disk.x * disk.x).max(0.0);
    let height = (1.0 - s) * rest.sqrt() + s * disk.y;
    disk.x * x + height * y + (rest - height * height).max(0.0).sqrt() * v
}

/// A visible normal for roughness 1: a slope towards `v` that is visible, and any slope across.
fn beckmann_normal(v: Vec3, at: Vec2) -> Vec3 {
    let squared = v.x * v.x + v.y * v.y;
    let along = if squared > 0.0 {
        Vec2::new(v.x, v.y) / squared.sqrt()
    } else {
        Vec2::X
    };
    let tan = squared.sqrt() / v.z;
    let (slope, across) = (visible_slope(tan, at.x), inverse_erf(2.0 * at.y - 1.0));
    let slopes = slope * along + across * along.perp();
    Vec3::new(-slopes.x, -slopes.y, 1.0)
}

/// The slope below which the part `part` of the facets is that are visible at an angle with this tangent.
fn visible_slope(tan: f32, part: f32) -> f32 {
    // A slope of −x is seen under 1 + x·tan; its distribution function is the integral with the normal distribution.
    let (tan, root_pi) = (f64::from(tan), std::f64::consts::PI.sqrt());
    let below = |x: f64| 0.5 * (1.0 + libm::erf(x)) + tan / (2.0 * root_pi) * libm::exp(-x * x);
    // Slopes beyond 1/tan are turned away. Those beyond 6 occur less than once in 10¹⁶ facets.
    let (mut low, mut high) = (-6.0, (1.0 / tan).min(6.0));
    let wanted = f64::from(part) * below(high);
    let mut x = (0.5 * (low + high)).clamp(low, high);
    // Newton's method, which bisection keeps between the bounds.
    for _ in 0..60 {
        let error = below(x) - wanted;
        if error < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let slope = (1.0 - x * tan) * libm::exp(-x * x) / root_pi;
        let mut next = x - error / slope;
        if !(next > low && next < high) {
            next = 0.5 * (low + high);
        }
        // A thousandth of what f32 tells apart among slopes.
        if (next - x).abs() < 1e-10 {
            break;
        }
        x = next;
    }
    x as f32
}

/// The inverse of the error function, to 4e-7 of its value; ±4 for ±1.
///
/// Source: Giles, "Approximating the erfinv Function", GPU Computing Gems, 2011.
fn inverse_erf(y: f32) -> f32 {
    let w = -libm::logf(((1.0 - y) * (1.0 + y)).max(1e-8));
    let (at, coefficients) = if w < 5.0 {
        let coefficients = [
            2.810_226_4e-8,
            3.432_739_4e-7,
            -3.523_387_7e-6,
            -4.391_506_5e-6,
            0.000_218_580_87,
            -0.001_253_725,
            -0.004_177_681_6,
            0.246_640_73,
            1.501_409_4,
        ];
        (w - 2.5, coefficients)
    } else {
        let coefficients = [
            -0.000_200_214_26,
            0.000_100_950_56,
            0.001_349_343_2,
            -0.003_673_428_4,
            0.005_739_507_7,
            -0.007_622_461_3,
            0.009_438_870_5,
            1.001_674,
            2.832_976_8,
        ];
        (w.sqrt() - 3.0, coefficients)
    };
    y * coefficients.into_iter().fold(0.0, |sum, c| sum * at + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_error_function_inverts_it() {
        for k in -999..=999 {
            let y = k as f32 / 1000.0;
            let back = libm::erf(f64::from(inverse_erf(y)));
            // The stated relative error, times the derivative's largest product with the argument, 0.5.
            assert!((back - f64::from(y)).abs() < 4e-7, "{y}: {back}");
        }
    }

    #[test]
    fn facets_cover_the_surface_once_as_seen_from_anywhere() {
        // The area that is visible, projected, is that of the surface: ∫ area · visible_part · max(v·m, 0) dm = v.z.
        for law in [Law::Ggx, Law::Beckmann] {
            for alpha in [0.05, 0.3, 1.0] {
                let facets = Microfacets::new(law, alpha);
                for z in [1.0, 0.5, 0.1f32] {
                    let v = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
                    let found = facets.visible_mean(v, |_| 1.0);
                    // The error that is stated there.
                    assert!((found - 1.0).abs() < 5e-4, "{law:?} {alpha} {z}: {found}");
                }
            }
        }
    }
}
