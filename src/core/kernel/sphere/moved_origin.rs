//! Ray–sphere test from an origin moved next to the sphere.
//!
//! Source: Wald, "Improving Numerical Precision in Intersection Programs", Ray Tracing Gems II, 2021.
//! Differs from it: the origin is moved to the point nearest to the centre, where the equation has no linear term.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: an accurate near hit from an origin close to the surface of a large sphere: the distance to the
//!   middle of the chord and half the chord nearly cancel.
//!
//! At the nearest point l the equation is a·s² = r² − l·l, and t is the moved distance ± s. The remainder of l along d,
//! which is 0 but for rounding, is subtracted once more.

use crate::kernel::crossings::Roots;
use crate::kernel::ray_lanes::SquaredRay;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises};
use crate::lane::{Lane, Number, Values, dot, minus, plus, times};
use crate::shape::Sphere;

/// See the [module](self).
pub(super) struct MovedOrigin;

impl Kernel for MovedOrigin {
    type Shape = Sphere;
    const IN_F32: KernelInfo = KernelInfo {
        name: "sphere-moved-origin",
        title: "Moved origin",
        tier: None,
        precision: Precision::F32,
        source: "Wald, Improving Numerical Precision in Intersection Programs, 2021",
        summary: "Accurate for small and distant spheres, not close to large ones.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "sphere-moved-origin-f64",
        title: "Moved origin, f64",
        precision: Precision::F64,
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = SquaredRay<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &SquaredRay<L>,
        spheres: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let r = spheres.value(3);
        let a = ray.dir_squared;
        let f = minus(&ray.origin, &spheres.three(0));
        let moved = -dot(&f, &ray.dir) / a;
        let l = plus(&f, &times(moved, &ray.dir));
        let rest = -dot(&l, &ray.dir) / a;
        let l = plus(&l, &times(rest, &ray.dir));
        let discriminant = r * r - dot(&l, &l);
        let s = (discriminant / a).sqrt();
        let roots = Roots {
            exist: L::of(t_min.token(), 0.0).le(discriminant),
            near: moved + (rest - s),
            far: moved + (rest + s),
        };
        roots.nearest(t_min, t_max)
    }
}
