//! Does a ray meet a box? Never a false no, as long as distances and inverses are normal numbers.
//!
//! The slab test: the ray is inside a box while it is between the two planes of all three axes at
//! once. Of `(plane − origin)·(1/d)` each of the three operations rounds, so that a far plane may
//! come out too near by three half-ulps against a near plane that came out too far by as many.
//!
//! Sources: Kay, Kajiya, "Ray Tracing Complex Scenes", SIGGRAPH 1986; Ize, "Robust BVH Ray
//! Traversal", JCGT 2(2), 2013. Differs from the latter: the padding is in the inverse direction of
//! the far planes, where it costs nothing a box, and is wider, as hits mustn't be missed that a kernel
//! accepts beside the box; far planes behind the origin are padded, too, for rays whose interval
//! begins there.

use crate::aabb::Aabb;
use crate::ray::Ray;

/// 1 + 12u with u = 2⁻²⁴: what a far distance ahead is lengthened by. Three roundings each on the near
/// and the far side are 6u; the watertight kernel may find a corner some 4u of its distance away
/// from where it is (one rounding of the difference, three of the shear); 1u is for rounding the
/// product with this.
const AHEAD: f32 = 1.0 + 6.0 * f32::EPSILON;
/// 1 − 12u: a far distance behind the origin is negative, and made nearer to it.
const BEHIND: f32 = 1.0 - 6.0 * f32::EPSILON;

/// A ray made ready for many boxes.
#[derive(Clone, Copy)]
pub(super) struct SlabRay {
    origin: [f32; 3],
    inv_near: [f32; 3],
    inv_far: [f32; 3],
    inv_far_behind: [f32; 3],
    is_negative: [bool; 3],
    t_min: f32,
}

impl SlabRay {
    /// Boxes are met from `t_min` on, which may be a little before `ray.t_min`.
    pub(super) fn new(ray: &Ray, t_min: f32) -> Self {
        let inverse = ray.dir.to_array().map(finite_inverse);
        Self {
            origin: ray.origin.to_array(),
            inv_near: inverse,
            inv_far: inverse.map(|x| x * AHEAD),
            inv_far_behind: inverse.map(|x| x * BEHIND),
            is_negative: inverse.map(f32::is_sign_negative),
            t_min,
        }
    }

    /// The distance at which the ray enters the box, if it does so before `t_max`.
    ///
    /// 0·∞ is a NaN where the origin lies in a plane that the ray runs along; such a plane doesn't
    /// constrain the ray, which is why each comparison keeps the old bound on NaN.
    #[inline(always)]
    pub(super) fn enter(&self, bounds: &Aabb, t_max: f32) -> Option<f32> {
        let (lower, upper) = (bounds.min.to_array(), bounds.max.to_array());
        let (mut near, mut far) = (self.t_min, t_max);
        for axis in 0..3 {
            let (first, last) = if self.is_negative[axis] {
                (upper[axis], lower[axis])
            } else {
                (lower[axis], upper[axis])
            };
            let enter = (first - self.origin[axis]) * self.inv_near[axis];
            let rest = last - self.origin[axis];
            // To skip the second product where t_min ≥ 0 gained nothing (bunny, 1e6 random rays, five
            // alternating runs, 2026-11).
            let (ahead, behind) = (rest * self.inv_far[axis], rest * self.inv_far_behind[axis]);
            let leave = if behind > ahead { behind } else { ahead };
            near = if enter > near { enter } else { near };
            far = if leave < far { leave } else { far };
        }
        (near <= far).then_some(near)
    }
}

/// 1/d, the largest finite number instead of an infinity: a zero distance to a plane then stays 0.
fn finite_inverse(d: f32) -> f32 {
    let inverse = 1.0 / d;
    if inverse.is_infinite() {
        f32::MAX.copysign(inverse)
    } else {
        inverse
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn enters(origin: Vec3, dir: Vec3, bounds: Aabb) -> bool {
        let ray = Ray::new(origin, dir).expect("a ray");
        SlabRay::new(&ray, 0.0)
            .enter(&bounds, f32::INFINITY)
            .is_some()
    }

    #[test]
    fn an_axis_aligned_ray_meets_all_that_it_touches_with_either_sign_of_zero() {
        let flat = Aabb::around([Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 1.0, 1.0)]);
        for zero in [0.0, -0.0] {
            let dir = Vec3::new(zero, zero, 1.0);
            for x in [0.0, 0.5, 1.0] {
                for y in [0.0, 0.5, 1.0] {
                    assert!(enters(Vec3::new(x, y, 0.0), dir, flat), "{x} {y} {zero}");
                }
            }
            assert!(!enters(Vec3::new(1.5, 0.5, 0.0), dir, flat));
        }
    }

    #[test]
    fn a_ray_in_the_plane_of_a_flat_box_meets_it() {
        let flat = Aabb::around([Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)]);
        for zero in [0.0, -0.0] {
            assert!(enters(
                Vec3::new(-1.0, 0.5, 0.0),
                Vec3::new(1.0, zero, zero),
                flat
            ));
            assert!(enters(
                Vec3::new(2.0, 1.0, 0.0),
                Vec3::new(-1.0, zero, zero),
                flat
            ));
        }
    }

    #[test]
    fn a_point_of_the_box_that_a_ray_is_aimed_at_is_never_missed() {
        // Exactly representable on both sides: the ray goes through the corner, no rounding asked.
        let origin = Vec3::new(-3.0, 5.0, 7.0);
        for scale in [1e-30f32, 1e-6, 1.0, 1e6, 1e18] {
            for offset in [0.0f32, 1e5] {
                let corner = Vec3::new(1.0, 2.0, 3.0) * scale + offset;
                let bounds = Aabb::around([corner, corner + scale]);
                let from = origin * scale + offset;
                let dir = corner - from;
                if from + dir == corner && dir != Vec3::ZERO {
                    assert!(enters(from, dir, bounds), "scale {scale} offset {offset}");
                }
            }
        }
    }

    #[test]
    fn a_box_behind_the_ray_or_beyond_its_end_is_not_met() {
        let bounds = Aabb::around([Vec3::splat(1.0), Vec3::splat(2.0)]);
        assert!(!enters(Vec3::splat(3.0), Vec3::ONE, bounds));
        let ray = Ray::new(Vec3::ZERO, Vec3::ONE).expect("a ray");
        let slabs = SlabRay::new(&ray, 0.0);
        assert_eq!(slabs.enter(&bounds, 0.5), None);
        assert_eq!(slabs.enter(&bounds, 5.0), Some(1.0));
    }
}
