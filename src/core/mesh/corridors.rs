//! Procedural corridors: long closed meshes of long triangles, and rays from inside them, for tests and measurements.
//!
//! A corridor is a footprint in the xy plane, extruded along z and optionally rotated:
//!
//! ```text
//!   box       prism       strips          L-shaped, extruded by 2
//!   ┌──┐        ╱╲       ┌┬┬┬┬┐      ┌┐  length
//!   │  │       ╱  ╲      ├    ┤      │└─────────┐
//!   └──┘      ╱────╲     └┴┴┴┴┘      └──────────┘
//! ```

use super::TriangleMesh;
use crate::random::Random;
use crate::ray::Ray;
use glam::{DQuat, DVec2, DVec3, Vec3};

/// The footprint of a corridor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Footprint {
    /// A square of 2 × 2.
    Square,
    /// A triangle.
    Triangle,
    /// The square, with each side divided into many strips.
    Strips,
    /// The square, with two arms of the corridor's length.
    L,
}

/// Every footprint.
pub const FOOTPRINTS: [Footprint; 4] = [
    Footprint::Square,
    Footprint::Triangle,
    Footprint::Strips,
    Footprint::L,
];

impl Footprint {
    /// The name in mesh names and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Square => "box",
            Self::Triangle => "prism",
            Self::Strips => "strips",
            Self::L => "L-corridor",
        }
    }

    /// The footprint's corners, counterclockwise. Every corner is visible from (0, 0).
    fn outline(self, length: f64) -> Vec<DVec2> {
        let p = DVec2::new;
        let square = [p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)];
        match self {
            Self::Square => square.to_vec(),
            Self::Triangle => vec![p(-1.0, -1.0), p(1.0, -1.0), p(0.25, 1.0)],
            Self::Strips => {
                let side =
                    |k: usize| (0..STRIPS).map(move |i| (k, f64::from(i) / f64::from(STRIPS)));
                let points = (0..4).flat_map(side);
                points
                    .map(|(k, part)| square[k].lerp(square[(k + 1) % 4], part))
                    .collect()
            }
            Self::L => vec![
                p(-1.0, -1.0),
                p(1.0 + length, -1.0),
                p(1.0 + length, 1.0),
                p(1.0, 1.0),
                p(1.0, 1.0 + length),
                p(-1.0, 1.0 + length),
            ],
        }
    }
}

/// Strips per side. A power of two, so that the corners are exact.
const STRIPS: u32 = 16;

/// A long closed mesh, with the geometry for drawing random rays inside it.
pub struct Corridor {
    /// The mesh; its normals point outwards.
    pub mesh: TriangleMesh,
    outline: Vec<DVec2>,
    /// The footprint is extruded from z = −`half_height` to z = `half_height`.
    half_height: f64,
    turn: DQuat,
    /// Minimum distance of ray origins from the walls, so that rounding can't move them out of the mesh.
    margin: f64,
}

impl Corridor {
    /// Creates a corridor of length 2·`length`, or for an [L](Footprint::L), of height 2 with arms of length `length`.
    /// `is_turned` rotates the mesh away from the coordinate axes.
    pub fn new(footprint: Footprint, length: f64, is_turned: bool) -> Self {
        let outline = footprint.outline(length);
        let half_height = match footprint {
            Footprint::L => 1.0,
            _ => length,
        };
        let turn = if is_turned {
            DQuat::from_xyzw(0.15, 0.35, -0.25, 0.9).normalize()
        } else {
            DQuat::IDENTITY
        };
        // Rounding moves the mesh's corners and the origin by at most √3·2⁻²⁴ of the largest coordinate each.
        let largest = if is_turned { 2.0 * length } else { 1.0 };
        let ends = [-half_height, half_height];
        let at = |p: DVec2, z: f64| (turn * p.extend(z)).as_vec3();
        let rim = outline.iter().flat_map(|p| ends.map(|z| at(*p, z)));
        let points = rim.chain(ends.map(|z| at(DVec2::ZERO, z))).collect();
        Self {
            mesh: TriangleMesh::new(points, triangles(outline.len() as u32)),
            outline,
            half_height,
            turn,
            margin: 4.0 * largest / f64::from(1 << 24),
        }
    }

    /// A random ray from inside the mesh. Half of the origins are near walls, edges or corners. Half of the directions
    /// point at edges and corners or just beside them.
    pub fn ray(&self, random: &mut Random) -> Ray {
        loop {
            let origin = self.origin(random);
            let dir = self.dir(origin, random);
            if self.is_inside(origin)
                && let Ok(ray) = Ray::new(origin, dir)
            {
                return ray;
            }
        }
    }

    fn origin(&self, random: &mut Random) -> Vec3 {
        let start = random.index(self.outline.len());
        let (p, q) = (
            self.outline[start],
            self.outline[(start + 1) % self.outline.len()],
        );
        let (to_middle, along, end) = (near_zero(random), near_zero(random), near_zero(random));
        let side = if random.index(2) == 0 { 1.0 } else { -1.0 };
        let point = p.lerp(q, along) * (1.0 - to_middle);
        let z = side * self.half_height * (1.0 - 2.0 * end);
        (self.turn * point.extend(z)).as_vec3()
    }

    fn is_inside(&self, origin: Vec3) -> bool {
        let point = self.turn.inverse() * origin.as_dvec3();
        let p = point.truncate();
        let next = self.outline.iter().skip(1).chain(&self.outline[..1]);
        let mut edges = self.outline.iter().zip(next);
        // The origin is at least the margin away from walls and ends.
        self.half_height - point.z.abs() >= self.margin
            && edges.all(|(a, b)| {
                let part = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                (p - a.lerp(*b, part)).length() >= self.margin
            })
    }

    fn dir(&self, origin: Vec3, random: &mut Random) -> Vec3 {
        let origin = origin.as_dvec3();
        match random.index(4) {
            0 => random.direction().as_vec3(),
            // Along the corridor.
            1 => {
                let along = random.in_cube() * DVec3::new(1.0, 1.0, self.half_height);
                (self.turn * along).as_vec3()
            }
            kind => {
                let triangle = random.index(self.mesh.triangles.len()) as u32;
                let corners = self.mesh.corners(triangle).map(Vec3::as_dvec3);
                let start = random.index(3);
                let (a, b) = (corners[start], corners[(start + 1) % 3]);
                // Three kinds of target: near the foot of the perpendicular from the origin, so that much of the edge
                // lies behind the origin; anywhere along the edge; a corner.
                let foot = (origin - a).dot(b - a) / (b - a).length_squared();
                let away = random.signed() * near_zero(random);
                let along = [foot + away, random.unit(), 0.0][random.index(3)];
                let spread = if kind == 2 {
                    0.0
                } else {
                    1e-5 * near_zero(random)
                };
                let target = a.lerp(b, along.clamp(0.0, 1.0)) + spread * random.in_cube();
                (target - origin).as_vec3()
            }
        }
    }
}

/// A random number between 0 and 1. Half of the numbers are scaled towards 0, by factors down to 2⁻²³ ≈ 10⁻⁷.
fn near_zero(random: &mut Random) -> f64 {
    if random.index(2) == 0 {
        random.unit()
    } else {
        // A power of 2 is exact; other powers may round differently on different machines.
        random.unit() * 2f64.powi(-(random.index(24) as i32))
    }
}

/// Triangles of an extrusion. The vertices are `count` pairs of a low and a high corner, then the low and high centres.
fn triangles(count: u32) -> Vec<[u32; 3]> {
    let (low_middle, high_middle) = (2 * count, 2 * count + 1);
    let side = |i: u32| {
        let (a, b) = (2 * i, 2 * ((i + 1) % count));
        [
            [a, b, b + 1],
            [a, b + 1, a + 1],
            [low_middle, b, a],
            [high_middle, a + 1, b + 1],
        ]
    };
    (0..count).flat_map(side).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Flaw, Health};

    #[test]
    fn corridors_are_closed_and_their_rays_start_inside() {
        for footprint in FOOTPRINTS {
            for is_turned in [false, true] {
                let corridor = Corridor::new(footprint, 100.0, is_turned);
                let health = Health::of(&corridor.mesh);
                assert!(health.is_closed(), "{footprint:?}");
                assert_eq!(health.places(Flaw::FlippedEdge).count(), Some(0));
                let mut random = Random::new(1);
                for _ in 0..1000 {
                    let ray = corridor.ray(&mut random);
                    let p = corridor.turn.inverse() * ray.origin.as_dvec3();
                    let is_in_arm = |x: f64, y: f64| x < 101.0 && y < 1.0;
                    assert!(p.z.abs() < corridor.half_height && p.x > -1.0 && p.y > -1.0);
                    assert!(is_in_arm(p.x, p.y) || is_in_arm(p.y, p.x));
                }
            }
        }
    }
}
