//! Reflection and refraction at smooth interfaces.

use glam::Vec3;

/// The direction of reflection by a mirror whose normal is the z axis.
pub(super) fn mirrored(outgoing: Vec3) -> Vec3 {
    Vec3::new(-outgoing.x, -outgoing.y, outgoing.z)
}

/// The direction of reflection by a mirror with this unit normal.
pub(super) fn reflected(outgoing: Vec3, normal: Vec3) -> Vec3 {
    2.0 * outgoing.dot(normal) * normal - outgoing
}

/// The direction of refraction by a facet with this unit normal on the side of `outgoing`; `interface` is
/// [`Interface::at`] their cosine and `eta`.
pub(super) fn refracted(outgoing: Vec3, normal: Vec3, interface: Interface, eta: f32) -> Vec3 {
    (outgoing.dot(normal) / eta - interface.cos_beyond) * normal - outgoing / eta
}

/// What happens at the interface of two transparent media.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interface {
    /// The part of light that is reflected.
    pub reflectance: f32,
    /// The cosine between the refracted ray and the normal; 0 in total reflection.
    pub cos_beyond: f32,
}

impl Interface {
    /// Light that meets the interface at an angle with this cosine, from 0 to 1. `eta` is the index of refraction beyond
    /// the interface, relative to that on the side of the light.
    ///
    /// Source: Fresnel's equations and Snell's law; Born, Wolf, "Principles of Optics", 7th edition, 1999, 1.5.
    pub fn at(cos: f32, eta: f32) -> Self {
        let squared_sin = ((1.0 - cos) * (1.0 + cos)).max(0.0) / (eta * eta);
        if squared_sin >= 1.0 {
            return Self {
                reflectance: 1.0,
                cos_beyond: 0.0,
            };
        }
        let cos_beyond = (1.0 - squared_sin).sqrt();
        let parallel = (eta * cos - cos_beyond) / (eta * cos + cos_beyond);
        let perpendicular = (cos - eta * cos_beyond) / (cos + eta * cos_beyond);
        Self {
            reflectance: 0.5 * (parallel * parallel + perpendicular * perpendicular),
            cos_beyond,
        }
    }
}

/// The part of diffuse light that the interface to a medium reflects; `eta` as in [`Interface::at`].
///
/// Source: Duntley, "The Optical Properties of Diffusing Materials", JOSA 32(2), 1942, for light from the thinner medium.
/// What enters the denser one is what leaves it, per solid angle and squared index; that gives the other case.
pub(super) fn diffuse_reflectance(eta: f32) -> f32 {
    let n = f64::from(eta);
    if n < 1.0 {
        return (1.0 - n * n * (1.0 - duntley(1.0 / n))) as f32;
    }
    duntley(n) as f32
}

fn duntley(n: f64) -> f64 {
    // Near 1, the terms cancel; the reflectance is small.
    if n < 1.0 + 1e-4 {
        return 0.0;
    }
    let n2 = n * n;
    let n4 = n2 * n2;
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0).powi(2))
        + n2 * (n2 - 1.0).powi(2) / (n2 + 1.0).powi(3) * libm::log((n - 1.0) / (n + 1.0))
        - 2.0 * n2 * n * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0).powi(2)) * libm::log(n)
}

/// The reflectance of a metal with a complex index of refraction `eta` + i`k`, relative to the medium around it. With
/// `eta` 0 it is 1.
///
/// Source: Born, Wolf, "Principles of Optics", 7th edition, 1999, 14.2.
pub(super) fn of_metal(cos: f32, eta: Vec3, k: Vec3) -> Vec3 {
    let of_channel = |eta: f32, k: f32| {
        let squared_cos = cos * cos;
        let squared_sin = 1.0 - squared_cos;
        let difference = eta * eta - k * k - squared_sin;
        let length = (difference * difference + 4.0 * eta * eta * k * k).sqrt();
        let a = (0.5 * (length + difference)).max(0.0).sqrt();
        let perpendicular =
            (length + squared_cos - 2.0 * a * cos) / (length + squared_cos + 2.0 * a * cos);
        let (sum, mixed) = (
            squared_cos * length + squared_sin * squared_sin,
            2.0 * a * cos * squared_sin,
        );
        let ratio = if sum + mixed > 0.0 {
            (sum - mixed) / (sum + mixed)
        } else {
            1.0
        };
        (0.5 * perpendicular * (1.0 + ratio)).clamp(0.0, 1.0)
    };
    Vec3::new(
        of_channel(eta.x, k.x),
        of_channel(eta.y, k.y),
        of_channel(eta.z, k.z),
    )
}

/// An approximation to the reflectance of a surface that reflects `normal` of the light along its normal.
///
/// Source: Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Eurographics 1994.
pub(super) fn schlick(cos: f32, normal: Vec3) -> Vec3 {
    let x = (1.0 - cos).clamp(0.0, 1.0);
    normal + (Vec3::ONE - normal) * (x * x * x * x * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fresnel_reflects_a_known_part_along_the_normal_all_at_grazing_incidence_and_none_at_brewsters_angle()
     {
        for eta in [1.5, 1.0 / 1.5, 2.4, 1.01] {
            let normal = Interface::at(1.0, eta);
            let expected = ((eta - 1.0) / (eta + 1.0f32)).powi(2);
            // Each of a few operations rounds by at most 2⁻²⁴ of numbers of size 1.
            assert!((normal.reflectance - expected).abs() < 1e-6, "{eta}");
            assert_eq!(normal.cos_beyond, 1.0);
            assert_eq!(Interface::at(0.0, eta).reflectance, 1.0);
            // At Brewster's angle, tan θ = eta, only perpendicular light is reflected: ((1 − eta²)/(1 + eta²))² of it.
            let brewster = Interface::at(1.0 / (1.0 + eta * eta).sqrt(), eta).reflectance;
            let half = 0.5 * ((1.0 - eta * eta) / (1.0 + eta * eta)).powi(2);
            assert!((brewster - half).abs() < 1e-6, "{eta}: {brewster} {half}");
        }
    }

    #[test]
    fn light_inside_a_dense_medium_is_totally_reflected_beyond_the_critical_angle() {
        let eta = 1.0 / 1.5f32;
        let critical = (1.0 - eta * eta).sqrt();
        assert_eq!(Interface::at(0.99 * critical, eta).reflectance, 1.0);
        let inside = Interface::at(1.01 * critical, eta);
        assert!(inside.reflectance < 1.0 && inside.cos_beyond > 0.0);
    }

    #[test]
    fn the_diffuse_reflectance_is_the_mean_over_all_directions() {
        for eta in [1.1, 1.5, 2.4, 1.0 / 1.1, 1.0 / 1.5, 1.0 / 2.4] {
            const N: u32 = 20_000;
            let cos = |k: u32| (k as f32 + 0.5) / N as f32;
            let part = |k: u32| f64::from(2.0 * cos(k) * Interface::at(cos(k), eta).reflectance);
            let mean = (0..N).map(part).sum::<f64>() / f64::from(N);
            let found = f64::from(diffuse_reflectance(eta));
            // The sum's error is largest at the kink of total reflection, where it is below a step, 1/N.
            assert!((found - mean).abs() < 1e-4, "{eta}: {found} {mean}");
        }
    }

    #[test]
    fn metals_reflect_as_the_closed_form_along_the_normal_says_and_mirrors_all() {
        let (eta, k) = (Vec3::new(0.2, 0.92, 1.1), Vec3::new(3.91, 2.45, 2.14));
        let found = of_metal(1.0, eta, k);
        let squared = |x: Vec3| (x * x) + k * k;
        let expected = squared(eta - 1.0) / squared(eta + 1.0);
        // A few roundings of numbers of size 1.
        assert!(
            (found - expected).abs().max_element() < 1e-5,
            "{found} {expected}"
        );
        for cos in [0.0, 0.1, 0.5, 1.0] {
            assert_eq!(of_metal(cos, Vec3::ZERO, Vec3::ONE), Vec3::ONE);
        }
        assert!((of_metal(0.0, eta, k) - 1.0).abs().max_element() < 1e-6);
    }
}
