//! Random primitives of every shape. Those with flat surfaces are in [`flat`](super::flat).

use crate::measure::lecture::AsPrinted;
use crate::oracle::Oracle;
use glam::{DVec3, Vec3};
use hitscope_core::Hit;
use hitscope_core::group::Grouped;
use hitscope_core::random::Random;
use hitscope_core::shape::{Cone, Cylinder, Quadric, Sphere, Torus};

/// A shape that is measured.
pub trait Sampled: Grouped + Oracle {
    /// Whether it has edges, rims or corners.
    const HAS_EDGES: bool;
    /// Whether a ray that leaves the primitive on the side of the outer normal can't hit it again.
    const IS_CONVEX: bool;

    /// A primitive of about this size near a point.
    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self;

    /// A point on an edge or a rim, or a corner or an apex. A shape without any has some point of its surface or `None`.
    fn edge_point(&self, random: &mut Random) -> Option<DVec3>;

    /// The direction of an axis, or of a normal.
    fn axis(&self) -> Vec3;

    /// The size, in which errors are measured: half the longest edge of the box, a sphere's radius, the radius of a
    /// tube. 1 for planes.
    fn size(&self) -> f64 {
        0.5 * self.bounds().extent().max_element()
    }

    /// Whether a point lies beyond an apex.
    fn is_beyond_apex(&self, _: DVec3) -> bool {
        false
    }

    /// The corners of a triangle.
    fn corners(&self) -> Option<[Vec3; 3]> {
        None
    }

    /// The lecture's programs for this shape.
    fn as_printed() -> &'static [AsPrinted<Self>] {
        &[]
    }

    /// The part of the surface that a hit is on, for shapes with several.
    fn part(_: &Hit) -> u32 {
        0
    }
}

impl Sampled for Sphere {
    const HAS_EDGES: bool = false;
    const IS_CONVEX: bool = true;

    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        Self {
            centre: (near + 0.2 * size * random.in_cube()).as_vec3(),
            radius: length(random, size),
        }
    }

    fn edge_point(&self, random: &mut Random) -> Option<DVec3> {
        Some(self.centre.as_dvec3() + f64::from(self.radius) * random.direction())
    }

    fn axis(&self) -> Vec3 {
        Vec3::Z
    }

    fn size(&self) -> f64 {
        self.radius.into()
    }
}

impl Sampled for Cylinder {
    const HAS_EDGES: bool = true;
    const IS_CONVEX: bool = true;

    /// Half of the cylinders are parallel to a coordinate axis.
    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        let along = if random.index(2) == 0 {
            DVec3::AXES[random.index(3)]
        } else {
            random.direction()
        };
        let middle = near + 0.2 * size * random.in_cube();
        let half = (0.1 + 0.6 * random.unit()) * size;
        Self {
            p0: (middle - half * along).as_vec3(),
            p1: (middle + half * along).as_vec3(),
            radius: length(random, 0.7 * size),
            is_capped: random.index(2) == 0,
        }
    }

    fn edge_point(&self, random: &mut Random) -> Option<DVec3> {
        let centre = [self.p0, self.p1][random.index(2)];
        Some(rim_point(random, centre, self.axis(), self.radius))
    }

    fn axis(&self) -> Vec3 {
        self.p1 - self.p0
    }

    fn part(hit: &Hit) -> u32 {
        hit.u as u32
    }
}

impl Sampled for Cone {
    const HAS_EDGES: bool = true;
    const IS_CONVEX: bool = true;

    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        let Cylinder {
            p0,
            p1,
            radius,
            is_capped,
        } = Cylinder::sample(random, near, size);
        Self {
            p0,
            p1,
            radius,
            is_capped,
        }
    }

    fn is_beyond_apex(&self, point: DVec3) -> bool {
        let [p0, apex] = [self.p0, self.p1].map(Vec3::as_dvec3);
        (point - apex).dot(apex - p0) > 0.0
    }

    fn edge_point(&self, random: &mut Random) -> Option<DVec3> {
        if random.index(4) == 0 {
            return Some(self.p1.as_dvec3());
        }
        Some(rim_point(random, self.p0, self.axis(), self.radius))
    }

    fn axis(&self) -> Vec3 {
        self.p1 - self.p0
    }

    fn part(hit: &Hit) -> u32 {
        hit.u as u32
    }
}

impl Sampled for Torus {
    const HAS_EDGES: bool = false;
    const IS_CONVEX: bool = false;

    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        let major = length(random, 0.7 * size);
        Self {
            centre: (near + 0.2 * size * random.in_cube()).as_vec3(),
            axis: random.direction().as_vec3(),
            major,
            minor: major * (0.01 + 0.6 * random.unit() as f32),
        }
    }

    fn edge_point(&self, random: &mut Random) -> Option<DVec3> {
        // A point of the circle: within the tube.
        Some(rim_point(random, self.centre, self.axis, self.major))
    }

    fn axis(&self) -> Vec3 {
        self.axis
    }

    fn size(&self) -> f64 {
        self.minor.into()
    }
}

impl Sampled for Quadric {
    const HAS_EDGES: bool = true;
    const IS_CONVEX: bool = false;

    /// The terms of each degree have about the same size at the edge of the box.
    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        let coefficients = std::array::from_fn(|k| {
            let degree = [2, 2, 2, 2, 2, 2, 1, 1, 1, 0][k];
            let scale = if degree == 0 { 0.5 } else { 1.0 };
            (scale * random.signed() * size.powi(-degree)) as f32
        });
        Self {
            coefficients,
            centre: (near + 0.2 * size * random.in_cube()).as_vec3(),
            half: (size * (DVec3::splat(0.3) + 0.3 * random.in_cube().abs())).as_vec3(),
        }
    }

    /// Where a line in a face of the box meets the surface.
    fn edge_point(&self, random: &mut Random) -> Option<DVec3> {
        let [a, b, c, d, e, f, g, h, i, j] = self.coefficients.map(f64::from);
        let half = self.half.as_dvec3();
        let value = |p: DVec3| {
            let DVec3 { x, y, z } = p;
            a * x * x
                + b * y * y
                + c * z * z
                + j
                + 2.0 * (d * x * y + e * y * z + f * x * z + g * x + h * y + i * z)
        };
        (0..32).find_map(|_| {
            let axis = random.index(3);
            let mut from = half * random.in_cube();
            from[axis] = half[axis] * end(random);
            let mut to = half * random.in_cube();
            to[axis] = from[axis];
            let [low, middle, high] = [0.0, 0.5, 1.0].map(|at| value(from.lerp(to, at)));
            // k₂s² + k₁s + low.
            let (k2, k1) = (
                2.0 * (low + high) - 4.0 * middle,
                4.0 * middle - 3.0 * low - high,
            );
            let s = (-k1 + (k1 * k1 - 4.0 * k2 * low).sqrt()) / (2.0 * k2);
            let is_between = (0.0..=1.0).contains(&s);
            is_between.then(|| self.centre.as_dvec3() + from.lerp(to, s))
        })
    }

    fn axis(&self) -> Vec3 {
        Vec3::Y
    }
}

/// A tenth to one of a size.
pub(super) fn length(random: &mut Random, size: f64) -> f32 {
    (size * (0.1 + 0.9 * random.unit())) as f32
}

fn rim_point(random: &mut Random, centre: Vec3, axis: Vec3, radius: f32) -> DVec3 {
    let (x, y) = axis.as_dvec3().normalize().any_orthonormal_pair();
    let (sin, cos) = quarter_or_turn(random).sin_cos();
    centre.as_dvec3() + f64::from(radius) * (cos * x + sin * y)
}

pub(super) fn end(random: &mut Random) -> f64 {
    [-1.0, 1.0][random.index(2)]
}

/// An angle: a multiple of a quarter once in four times.
pub(super) fn quarter_or_turn(random: &mut Random) -> f64 {
    let turns = if random.index(4) == 0 {
        0.25 * random.index(4) as f64
    } else {
        random.unit()
    };
    std::f64::consts::TAU * turns
}
