//! Exact intersections with tori.
//!
//! With p = o + t·d − c, the axis w and the radii R and r, a point of the torus is at the distance r from the circle:
//! (ρ − R)² + h² = r², where h = p·w/|w| and ρ² = p² − h². Without the root, and times w²:
//!
//! ```text
//! w²·(p² − R² − r²)² + 4R²·(p·w)² − 4R²r²·w² = 0
//! ```
//!
//! The kernels have R² − r² and the distance from the axis instead. The left side has degree 4 in t. See `isolated`
//! for its roots; the kernels use intervals, bisection and Sturm sequences.

use super::exact_t::ExactT;
use super::isolated::IsolatedRoot;
use super::shapes::{IntegerRay, Oracle};
use super::triangle::{dot, integers};
use dashu_int::IBig;
use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::shape::Torus;

impl Oracle for Torus {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let can_be_hit = self.major > 0.0 && self.minor > 0.0 && self.axis != Vec3::ZERO;
        let crossings = || {
            let radii = Vec3::new(self.major, self.minor, 0.0);
            let all = IntegerRay::new(ray, &[self.centre, radii])?;
            let (axes, _) = integers(&[self.axis])?;
            let polynomial = polynomial(&all, &axes[0]);
            let roots = IsolatedRoot::positive_roots(&polynomial).into_iter();
            Some(roots.map(|root| root.scaled(all.exponent).into()).collect())
        };
        can_be_hit.then(crossings).flatten().unwrap_or_default()
    }
}

/// The left side's coefficients, that of 1 first.
fn polynomial(all: &IntegerRay, w: &[IBig; 3]) -> [IBig; 5] {
    let (f, d, [major, minor, _]) = (all.from(0), &all.dir, &all.places[1]);
    let axis = dot(w, w);
    let (major, minor) = (major * major, minor * minor);
    // p² − R² − r² = a + 2bt + ct², and p·w = g + ht.
    let a = dot(&f, &f) - &major - &minor;
    let (b, c) = (dot(&f, d), dot(d, d));
    let (g, h) = (dot(&f, w), dot(d, w));
    let four_major = major << 2;
    [
        &axis * (&a * &a - &four_major * minor) + &four_major * (&g * &g),
        ((&axis * &a * &b) << 2) + ((&four_major * &g * &h) << 1),
        &axis * (((&a * &c) << 1) + ((&b * &b) << 2)) + &four_major * (&h * &h),
        (&axis * &b * &c) << 2,
        &axis * &c * &c,
    ]
}

#[cfg(test)]
mod tests {
    use super::super::shapes::crossings_in_f64;
    use super::*;

    #[test]
    fn rays_cross_a_torus_up_to_four_times_and_tangents_touch_it() {
        let torus = Torus {
            centre: Vec3::ZERO,
            axis: Vec3::Z * 3.0,
            major: 4.0,
            minor: 1.0,
        };
        let at = |origin: [f32; 3], dir: [f32; 3]| {
            let ray = Ray::new(origin.into(), dir.into()).expect("a ray");
            crossings_in_f64(&ray, &torus)
        };
        let through = at([-10.0, 0.0, 0.0], [2.0, 0.0, 0.0]);
        assert_eq!(through, [2.5, 3.5, 6.5, 7.5]);
        assert!(at([0.0, 0.0, -10.0], [0.0, 0.0, 1.0]).is_empty());
        // The inner and the outer equator, and the circle on top, where the ray touches twice.
        assert_eq!(at([3.0, -10.0, 0.0], [0.0, 1.0, 0.0])[1], 10.0);
        assert_eq!(at([3.0, 0.0, -10.0], [0.0, 0.0, 1.0]), [10.0]);
        assert_eq!(at([5.0, -10.0, 0.0], [0.0, 1.0, 0.0]), [10.0]);
        assert!(at([5f32.next_up(), -10.0, 0.0], [0.0, 1.0, 0.0]).is_empty());
        assert_eq!(at([-10.0, 0.0, 1.0], [1.0, 0.0, 0.0]), [6.0, 14.0]);
        // x² = 16 − y² at the height 1: 10 ∓ √15 = 6.12701665379258311482… and 13.87298334620741688518…
        let touched = at([-10.0, 1.0, 1.0], [1.0, 0.0, 0.0]);
        assert_eq!(touched, [6.127016653792583, 13.872983346207417]);
    }
}
