//! The answers of kernels, compared with the exact one.

use super::weights;
use crate::oracle::{self, ExactHit, Fraction};
use hitscope_core::kernel::KernelChoice;
use hitscope_core::ray::ulp_at;
use hitscope_core::{Hit, Ray, Scene};
use serde::Serialize;

/// The answer of one kernel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KernelRow {
    /// The kernel.
    pub name: &'static str,
    /// Whether it found a hit.
    pub hit: bool,
    /// The triangle, counted from 0.
    pub triangle: Option<u32>,
    /// Distance in units of the direction's length.
    pub t: Option<f32>,
    /// Barycentric coordinates for the three corners.
    pub barycentric: Option<[f32; 3]>,
    /// |t − exact t| in ulps of f32, relative to the exact answer for the same triangle; `None` if the ray misses it
    /// in exact arithmetic.
    pub t_error_ulps: Option<f64>,
    /// The largest error of a barycentric coordinate, likewise.
    pub barycentric_error: Option<f64>,
}

/// The kernels of the shape that is hit exactly, or else by the chosen kernel; those of triangles if nothing is hit.
pub(super) fn kernels_of(scene: &Scene, exact: Option<u32>, hit: Option<Hit>) -> Vec<KernelChoice> {
    let primitive = exact.or(hit.map(|hit| hit.primitive));
    let infos = match primitive {
        Some(primitive) => scene.group_of(primitive).0.kernels(),
        None => scene.groups()[0].kernels(),
    };
    infos
        .into_iter()
        .map(|info| KernelChoice { info })
        .collect()
}

impl KernelRow {
    /// Traces the ray with a kernel through the candidates, which are the primitives of `subset`.
    pub(super) fn new(kernel: KernelChoice, subset: &Scene, ray: &Ray, candidates: &[u32]) -> Self {
        let nearest = subset.intersector(kernel).closest_hit(ray);
        let of_triangle = nearest.filter(|hit| subset.is_triangle(hit.primitive));
        let corners = |hit: Hit| subset.mesh().corners(hit.primitive);
        let exact = of_triangle.and_then(|hit| oracle::intersect(ray, corners(hit)));
        let errors = of_triangle
            .zip(exact)
            .map(|(hit, exact)| errors(&hit, &exact));
        let t_error = |hit: Hit| {
            let [t, ..] = subset.exact_answer(ray, hit.primitive)?;
            Some((f64::from(hit.t) - t).abs() / ulp_at(t))
        };
        let t_error_ulps = match (of_triangle, nearest) {
            (Some(_), _) => errors.map(|(t, _)| t),
            (None, hit) => hit.and_then(t_error),
        };
        Self {
            name: kernel.info.name,
            hit: nearest.is_some(),
            triangle: nearest.map(|hit| candidates[hit.primitive as usize]),
            t: nearest.map(|hit| hit.t),
            barycentric: of_triangle.map(|hit| weights(&hit)),
            t_error_ulps,
            barycentric_error: errors.map(|(_, barycentric)| barycentric),
        }
    }
}

/// The error of t in ulps of f32, and the largest error of a barycentric coordinate.
fn errors(hit: &Hit, exact: &ExactHit) -> (f64, f64) {
    let t = Fraction::from_f64(hit.t.into()).expect("a hit is finite");
    let error = t.minus(&exact.t).to_f64().abs();
    let weights = exact.barycentric.each_ref().map(Fraction::to_f64);
    (error / ulp_at(exact.t.to_f64()), hit.weight_error(weights))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn errors_are_in_ulps_of_the_exact_value() {
        let corners = [
            Vec3::ZERO,
            Vec3::new(4.0, 0.0, 0.0),
            Vec3::new(0.0, 4.0, 0.0),
        ];
        let ray = Ray::new(Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z).expect("a ray");
        let exact = oracle::intersect(&ray, corners).expect("inside");
        let hit = |t: f32, u: f32| Hit {
            t,
            u,
            v: 0.5,
            primitive: 0,
        };
        assert_eq!(errors(&hit(3.0, 0.25), &exact), (0.0, 0.0));
        let off = errors(&hit(3.0f32.next_up().next_up(), 0.25), &exact);
        assert_eq!(off, (2.0, 0.0));
        // An error of u makes the opposite error of the first coordinate.
        let (t, weights) = errors(&hit(3.0, 0.25 + 0.03125), &exact);
        assert_eq!((t, weights), (0.0, 0.03125));
    }
}
