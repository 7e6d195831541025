//! Ray–plane test from the Hesse form, n·x = D with a unit normal.
//!
//! Source: Lensch, Basic Geometry, lecture, 2022: t = (D − o·n)/(d·n).
//! Differs from it: nothing.
//! Promises: nothing beyond the measured figures.
//! Doesn't promise: an accurate t far from (0, 0, 0), where D and o·n nearly cancel.

use crate::kernel::crossings::Nearest;
use crate::kernel::{Kernel, KernelInfo, LaneHit, Precision, Promises, RayLanes, Tier};
use crate::lane::{Lane, Number, Values, dot};
use crate::shape::Plane;
use glam::DVec3;

/// See the [module](self).
pub(super) struct Hesse;

impl Kernel for Hesse {
    type Shape = Plane;
    const IN_F32: KernelInfo = KernelInfo {
        name: "plane-hesse",
        title: "Hesse form",
        tier: Some(Tier::Fast),
        precision: Precision::F32,
        source: "Lensch, Basic Geometry, lecture, 2022",
        summary: "Least arithmetic; inaccurate far from (0, 0, 0).",
        promises: Promises::PLAIN,
    };
    const IN_F64: KernelInfo = KernelInfo {
        name: "plane-hesse-f64",
        title: "Hesse form, f64",
        tier: None,
        precision: Precision::F64,
        summary: "Least arithmetic.",
        ..Self::IN_F32
    };
    const VALUES: usize = 4;
    type Stored<N: Number> = N;
    type Prepared<L: Lane> = RayLanes<L>;

    fn pack<N: Number>(plane: &Plane, values: &mut [N]) {
        let normal = plane.normal.as_dvec3().normalize_or(DVec3::NAN);
        let distance = normal.dot(plane.point.as_dvec3());
        let [x, y, z] = normal.to_array();
        values.copy_from_slice(&[x, y, z, distance].map(N::of_f64));
    }

    #[inline(always)]
    fn intersect<L: Lane>(
        ray: &RayLanes<L>,
        shapes: &impl Values<L>,
        t_min: L,
        t_max: L,
    ) -> Option<LaneHit<L>> {
        let (normal, distance) = (shapes.three(0), shapes.value(3));
        let slope = dot(&normal, &ray.dir);
        let t = (distance - dot(&normal, &ray.origin)) / slope;
        let mut nearest = Nearest::new(t_min, t_max);
        nearest.offer(t.le(t), t, 0);
        nearest.hit()
    }
}
