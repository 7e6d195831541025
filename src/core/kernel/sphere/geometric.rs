//! Ray–sphere test by construction in the plane of ray and centre.
//!
//! Source: Haines, "Essential Ray Tracing Algorithms", in Glassner (ed.), An Introduction to Ray Tracing, 1989.
//! Differs from it: the direction needn't have unit length; no early exits, which SIMD lanes can't take.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: right decisions for small or distant spheres: the squares of the distances to the centre and along
//!   the ray nearly cancel.
//!
//! ```text
//!           _____
//!         /       \         l = c − o: from the origin to the centre
//!        |    c    |        s: along the ray to the point nearest to the centre
//! o ─────┼────┴────┼──▶     m² = l² − s²: the square of the distance of centre and ray
//!         \_______/         q² = r² − m²: the square of half the chord
//!   ◀──── s ──▶◀q─▶
//! ```

use crate::kernel::crossings::Roots;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, dot, minus};
use crate::shape::Sphere;

/// See the [module](self).
pub(super) struct Geometric;

/// A ray prepared for many tests.
#[derive(Clone, Copy)]
pub(super) struct PreparedRay<L> {
    origin: [L; 3],
    /// Unit length.
    dir: [L; 3],
    /// 1/|d|: t per unit of distance.
    t_per_length: L,
}

impl<L: Lane> From<RayLanes<L>> for PreparedRay<L> {
    #[inline(always)]
    fn from(rays: RayLanes<L>) -> Self {
        let t_per_length = L::of(rays.dir[0].token(), 1.0) / dot(&rays.dir, &rays.dir).sqrt();
        let [x, y, z] = rays.dir;
        Self {
            origin: rays.origin,
            dir: [x * t_per_length, y * t_per_length, z * t_per_length],
            t_per_length,
        }
    }
}

impl Kernel for Geometric {
    type Shape = Sphere;
    const IN_F32: KernelInfo = KernelInfo {
        name: "sphere-geometric",
        title: "Geometric construction",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Haines, Essential Ray Tracing Algorithms, 1989",
        summary: "Least arithmetic; wrong for small and distant spheres.",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "sphere-geometric-f64",
        title: "Geometric construction, f64",
        tier: None,
        precision: Precision::F64,
        summary: "Least arithmetic; good to distances of a million radii.",
        ..Self::IN_F32
    };
    type Stored<N: Number> = f32;
    type Prepared<L: Lane> = PreparedRay<L>;

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &PreparedRay<L>,
        spheres: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let r = spheres.value(3);
        let l = minus(&spheres.three(0), &ray.origin);
        let s = dot(&l, &ray.dir);
        let q_squared = r * r - (dot(&l, &l) - s * s);
        let q = q_squared.sqrt();
        let roots = Roots {
            exist: L::of(t_min.token(), 0.0).le(q_squared),
            near: (s - q) * ray.t_per_length,
            far: (s + q) * ray.t_per_length,
        };
        roots.nearest(t_min, t_max)
    }
}
