//! Random primitives with flat surfaces.

use super::samples::{Sampled, end, length, quarter_or_turn};
use crate::measure::lecture::{AsPrinted, TRIANGLE_AS_PRINTED};
use glam::{DVec2, DVec3, Vec3};
use hitscope_core::Hit;
use hitscope_core::random::Random;
use hitscope_core::shape::{Cuboid, Disk, Plane, Rectangle, Span, Triangle};

impl Sampled for Triangle {
    const HAS_EDGES: bool = true;
    const IS_CONVEX: bool = true;

    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        Self([(); 3].map(|()| (near + size * random.in_cube()).as_vec3()))
    }

    fn edge_point(&self, random: &mut Random) -> Option<DVec3> {
        let first = random.index(3);
        let [a, b] = [first, (first + 1) % 3].map(|k| self.0[k].as_dvec3());
        Some(a.lerp(b, corner_or_unit(random)))
    }

    fn axis(&self) -> Vec3 {
        self.unit_normal().as_vec3()
    }

    fn corners(&self) -> Option<[Vec3; 3]> {
        Some(self.0)
    }

    fn as_printed() -> &'static [AsPrinted<Self>] {
        TRIANGLE_AS_PRINTED
    }
}

impl Sampled for Plane {
    const HAS_EDGES: bool = false;
    const IS_CONVEX: bool = true;

    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        Self {
            point: (near + size * random.in_cube()).as_vec3(),
            normal: random.direction().as_vec3(),
        }
    }

    fn edge_point(&self, _: &mut Random) -> Option<DVec3> {
        Some(self.point.as_dvec3())
    }

    fn axis(&self) -> Vec3 {
        self.normal
    }

    fn size(&self) -> f64 {
        1.0
    }
}

impl Sampled for Disk {
    const HAS_EDGES: bool = true;
    const IS_CONVEX: bool = true;

    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        Self(span(random, near, size))
    }

    fn edge_point(&self, random: &mut Random) -> Option<DVec3> {
        let rim = DVec2::from_angle(quarter_or_turn(random));
        Some(in_span(&self.0, rim))
    }

    fn axis(&self) -> Vec3 {
        self.0.u.cross(self.0.v)
    }
}

impl Sampled for Rectangle {
    const HAS_EDGES: bool = true;
    const IS_CONVEX: bool = true;

    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        Self(span(random, near, size))
    }

    fn edge_point(&self, random: &mut Random) -> Option<DVec3> {
        let mut p = DVec2::new(end_or_between(random), end_or_between(random));
        p[random.index(2)] = end(random);
        Some(in_span(&self.0, p))
    }

    fn axis(&self) -> Vec3 {
        self.0.u.cross(self.0.v)
    }
}

impl Sampled for Cuboid {
    const HAS_EDGES: bool = true;
    const IS_CONVEX: bool = true;

    /// Half of the boxes are parallel to the coordinate axes.
    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        let centre = (near + 0.2 * size * random.in_cube()).as_vec3();
        let lengths = [(); 3].map(|()| length(random, 0.6 * size));
        let [x, y, z] = if random.index(2) == 0 {
            [Vec3::X, Vec3::Y, Vec3::Z]
        } else {
            let x = random.direction().as_vec3();
            let (y, z) = x.any_orthonormal_pair();
            [x, y, z]
        };
        let [a, b, c] = lengths;
        Self {
            centre,
            axes: [a * x, b * y, c * z],
        }
    }

    fn edge_point(&self, random: &mut Random) -> Option<DVec3> {
        let mut at = [(); 3].map(|()| end(random));
        at[random.index(3)] = end_or_between(random);
        let terms = self
            .axes
            .iter()
            .zip(at)
            .map(|(axis, x)| x * axis.as_dvec3());
        Some(self.centre.as_dvec3() + terms.sum::<DVec3>())
    }

    fn axis(&self) -> Vec3 {
        self.axes[0]
    }

    fn part(hit: &Hit) -> u32 {
        hit.u as u32
    }
}

/// A parallelogram that isn't narrow.
fn span(random: &mut Random, near: DVec3, size: f64) -> Span {
    let u = random.direction().as_vec3();
    let side = u.any_orthonormal_vector() + 0.3 * u;
    let (a, b) = (length(random, 0.7 * size), length(random, 0.7 * size));
    Span {
        centre: (near + 0.2 * size * random.in_cube()).as_vec3(),
        u: a * u,
        v: b * side,
    }
}

fn in_span(span: &Span, p: DVec2) -> DVec3 {
    span.centre.as_dvec3() + p.x * span.u.as_dvec3() + p.y * span.v.as_dvec3()
}

/// −1 or 1 once in four times, else a number between.
pub(super) fn end_or_between(random: &mut Random) -> f64 {
    if random.index(4) == 0 {
        end(random)
    } else {
        random.signed()
    }
}

fn corner_or_unit(random: &mut Random) -> f64 {
    if random.index(4) == 0 {
        0.0
    } else {
        random.unit()
    }
}
