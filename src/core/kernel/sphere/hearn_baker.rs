//! Ray–sphere test that avoids both cancellations of the quadratic equation.
//!
//! Sources: Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems,
//!   2019, which combines the discriminant of Hearn, Baker, Computer Graphics with OpenGL, 2004, with the roots of
//!   Press et al., Numerical Recipes, 1986.
//! Differs from them: nothing.
//! Promises: nothing beyond the measured figures. In f32 the decision errs by a few ulps of the distance from origin
//!   to centre, measured at the sphere.
//! Doesn't promise: right decisions about rays that pass the surface more closely than that.
//!
//! With f = o − c, a = d·d and b = −f·d, the point of the ray nearest to the centre is l = f + (b/a)·d away from it.
//! The discriminant r² − l·l is a difference of numbers of the sphere's size, however far away the origin is. With
//! q = b + sign(b)·√(aΔ), which adds numbers of equal sign, the roots are (f·f − r²)/q and q/a.

use crate::kernel::crossings::Roots;
use crate::kernel::ray_lanes::SquaredRay;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, Tier};
use crate::lane::{Lane, Number, Values, minus};
use crate::shape::Sphere;

/// See the [module](self).
pub(super) struct HearnBaker;

impl Kernel for HearnBaker {
    type Shape = Sphere;
    const IN_F32: KernelInfo = KernelInfo {
        name: "sphere-hearn-baker",
        title: "Hearn–Baker, Press",
        tier: Some(Tier::Watertight),
        precision: Precision::F32,
        source: "Haines, Günther, Akenine-Möller, Precision Improvements for Ray/Sphere Intersection, 2019",
        summary: "No cancellation: accurate for small, distant and huge spheres.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "sphere-hearn-baker-f64",
        title: "Hearn–Baker, Press, f64",
        tier: Some(Tier::Precise),
        precision: Precision::F64,
        summary: "No cancellation; t correct to the last place of f32 but for grazing rays.",
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
        let f = minus(&ray.origin, &spheres.three(0));
        let roots = Roots::at_distance(&f, &ray.dir, ray.dir_squared, r * r);
        roots.nearest(t_min, t_max)
    }
}
