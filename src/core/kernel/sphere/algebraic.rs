//! Ray–sphere test by the quadratic equation as textbooks write it.
//!
//! Source: Goldstein, Nagel, "3-D Visual Simulation", Simulation 16(1), 1971; Lensch, Basic Geometry, lecture, 2022.
//! Differs from it: any centre and radius.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions for small or distant spheres: b² and 4ac nearly cancel; an accurate near hit of a
//!   large sphere, where −b and the root nearly cancel.

use crate::kernel::crossings::Roots;
use crate::kernel::ray_lanes::SquaredRay;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises};
use crate::lane::{Lane, Number, Values, dot, minus};
use crate::shape::Sphere;

/// See the [module](self).
pub(super) struct Algebraic;

impl Kernel for Algebraic {
    type Shape = Sphere;
    const IN_F32: KernelInfo = KernelInfo {
        name: "sphere-algebraic",
        title: "Quadratic equation",
        tier: None,
        precision: Precision::F32,
        source: "Goldstein, Nagel, 3-D Visual Simulation, 1971",
        summary: "The textbook formula; wrong for small and distant spheres.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "sphere-algebraic-f64",
        title: "Quadratic equation, f64",
        precision: Precision::F64,
        summary: "The textbook formula; good to distances of a million radii.",
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
        let constant = |x: f32| L::of(t_min.token(), x);
        let r = spheres.value(3);
        let f = minus(&ray.origin, &spheres.three(0));
        let a = ray.dir_squared;
        let b = constant(2.0) * dot(&f, &ray.dir);
        let c = dot(&f, &f) - r * r;
        let discriminant = b * b - constant(4.0) * a * c;
        let root = discriminant.sqrt();
        let doubled = constant(2.0) * a;
        let roots = Roots {
            exist: constant(0.0).le(discriminant),
            near: (-b - root) / doubled,
            far: (-b + root) / doubled,
        };
        roots.nearest(t_min, t_max)
    }
}
