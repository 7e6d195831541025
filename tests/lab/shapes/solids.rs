//! Combined solids of random shapes and operations: the exact kernel against points between crossings.
//!
//! `HITSCOPE_SOLID_RAYS=1000000` tests that many rays. By default it is 4000.

use super::frame::{Frame, triple};
use super::sum_over;
use glam::{DVec3, Vec3};
use hitscope_core::group::{CsgOperation, LineIntervals, SolidNode, kernel_named};
use hitscope_core::kernel::Tier;
use hitscope_core::random::Random;
use hitscope_core::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Plane, Quadric, Sphere, Torus,
};
use hitscope_core::{Intersector, Ray, Scene};
use hitscope_lab::measure::shapes::SampledSolid;
use hitscope_lab::oracle::{Division, EnclosingShape, ExactT, OracleSolid};
use std::cmp::Ordering;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Rays per solid, because packing takes longer than tracing.
const RAYS_PER_SOLID: u64 = 8;

fn solid_count() -> u64 {
    let count = std::env::var("HITSCOPE_SOLID_RAYS").ok();
    let count: Option<u64> = count.and_then(|count| count.parse().ok());
    count.unwrap_or(4_000).div_ceil(RAYS_PER_SOLID)
}

/// A solid in a scene of its own, packed for the exact kernel.
struct Checked<'a> {
    solid: &'a OracleSolid,
    operands: Vec<Arc<dyn EnclosingShape>>,
    scene: Scene,
    intersector: Box<dyn Intersector>,
}

impl<'a> Checked<'a> {
    fn new(solid: &'a OracleSolid) -> Self {
        let scene = solid.scene();
        let exact = kernel_named(Tier::Exact.name()).expect("a tier");
        Self {
            operands: solid.operands(),
            solid,
            intersector: scene.intersector(exact),
            scene,
        }
    }

    /// Compares all crossings, the first hit, the operands and the intervals. Returns the number of crossings, or `None` if
    /// the oracle doesn't decide.
    fn check(&self, ray: &Ray) -> Option<usize> {
        let mut division = self.solid.division(ray)?;
        // Solids disregard crossings with surfaces beyond 1e30.
        let reach = 1e30 / f64::from(ray.dir.abs().max_element());
        let mut expected = division.crossings();
        expected.retain(|&k| division.ends[k].to_f64() < reach.min(f32::MAX.into()));
        let t_of = |k: &usize| division.ends[*k].clone().to_f32();
        let expected_t: Vec<f32> = expected.iter().map(t_of).collect();
        let found = self.intersector.all_hits(ray);
        let found_t: Vec<f32> = found.iter().map(|crossing| crossing.hit.t).collect();
        assert_eq!(found_t, expected_t, "{:?} {ray:?}", self.solid);
        let first = self.intersector.closest_hit(ray);
        assert_eq!(first, found.first().map(|crossing| crossing.hit));
        assert_eq!(self.intersector.any_hit(ray), first.is_some());
        for (&k, crossing) in expected.iter().zip(&found) {
            self.check_operand(ray, &division, k, crossing.hit.v as usize);
        }
        self.check_intervals(ray, &mut division);
        Some(expected.len())
    }

    /// The operand of a crossing is entered or left there, and its surface faces the ray if that of the solid does.
    fn check_operand(&self, ray: &Ray, division: &Division, end: usize, operand: usize) {
        let (group, _) = self.scene.group_of(0);
        let is_subtracted = group.solid(0).expect("a solid").operands()[operand].is_subtracted;
        let shape = &self.operands[operand];
        let [before, after] = [end, end + 1].map(|k| shape.side(ray, division.middles[k]));
        assert_ne!(before, after, "{operand} of {:?} {ray:?}", self.solid);
        let is_entered = (after == Ordering::Less) != is_subtracted;
        assert_eq!(is_entered, division.inside[end + 1], "{operand} {ray:?}");
    }

    /// The intervals of every part contain the points that are inside that part.
    fn check_intervals(&self, ray: &Ray, division: &mut Division) {
        let (group, _) = self.scene.group_of(0);
        let solid = group.solid(0).expect("a solid");
        let intervals = solid.intervals(ray);
        for &t in &division.middles {
            let mut rest = intervals.iter();
            self.check_part(ray, t, self.solid, solid.root(), &mut rest);
            assert!(rest.next().is_none());
        }
        let ends = intervals[0].ends.iter().filter(|t| **t > 0.0);
        let expected = division.crossings();
        let t_of = |k: &usize| division.ends[*k].to_f64();
        let expected: Vec<f64> = expected.iter().map(t_of).collect();
        let ends: Vec<f64> = ends.copied().collect();
        assert_eq!(ends, expected, "{:?} {ray:?}", self.solid);
    }

    fn check_part(
        &self,
        ray: &Ray,
        t: f64,
        part: &OracleSolid,
        node: &SolidNode,
        rest: &mut std::slice::Iter<'_, LineIntervals>,
    ) {
        let own = rest.next().expect("intervals of each part").list();
        let is_inside = own.iter().any(|&[start, end]| start < t && t < end);
        assert_eq!(
            Some(is_inside),
            part.is_inside(ray, t),
            "{part:?} {ray:?} {t}"
        );
        match (part, node) {
            (OracleSolid::Combined(_, parts), SolidNode::Operation(_, nodes)) => {
                for (part, node) in parts.iter().zip(nodes) {
                    self.check_part(ray, t, part, node, rest);
                }
            }
            // A quadric and its box: two operands.
            (OracleSolid::Shape(_), SolidNode::Operation(_, nodes)) => {
                nodes.iter().for_each(|_| _ = rest.next());
            }
            _ => {}
        }
    }
}

/// Checks solids, and prints the numbers of rays and crossings. At most this part of the rays may lie in surfaces.
fn check_all(
    in_surfaces: f64,
    case: impl Fn(&mut Random) -> (OracleSolid, Vec<Ray>) + Send + Sync,
) {
    let (rays, skipped) = (AtomicU64::new(0), AtomicU64::new(0));
    let crossings = sum_over(solid_count(), |number| {
        let (solid, cases) = case(&mut Random::new(number));
        let checked = Checked::new(&solid);
        let mut count = 0;
        for ray in cases {
            rays.fetch_add(1, Relaxed);
            match checked.check(&ray) {
                Some(crossings) => count += crossings as u64,
                None => _ = skipped.fetch_add(1, Relaxed),
            }
        }
        count
    });
    let (rays, skipped) = (rays.into_inner(), skipped.into_inner());
    eprintln!("{rays} rays, {crossings} crossings, 0 wrong; {skipped} rays in surfaces");
    assert!(crossings > rays / 10, "{crossings} of {rays}");
    assert!(
        skipped as f64 <= in_surfaces * rays as f64,
        "{skipped} of {rays}"
    );
}

/// A ray at a place near a solid's shapes or at one of their edges, also along an axis or from inside.
fn ray_at(random: &mut Random, points: &[DVec3], near: DVec3, size: f64) -> Ray {
    let distance = [0.0, 3.0, 3.0, 1e3][random.index(4)];
    let is_at_edge = !points.is_empty() && random.index(2) == 0;
    let target = if is_at_edge {
        points[random.index(points.len())]
    } else {
        near + size * random.in_cube()
    };
    let along = if random.index(6) == 0 {
        DVec3::AXES[random.index(3)]
    } else {
        random.direction()
    };
    let origin = target - (distance + 0.5 * random.unit()) * size * along;
    let is_along_axis = along.abs().max_element() == 1.0;
    let dir = if is_along_axis {
        along.as_vec3()
    } else {
        (target - origin.as_vec3().as_dvec3()).as_vec3()
    };
    let dir = if dir == Vec3::ZERO { Vec3::X } else { dir };
    Ray::new(origin.as_vec3(), dir).expect("a ray")
}

#[test]
fn crossings_of_random_solids_are_where_points_change_from_outside_to_inside() {
    // Rays along an axis at an edge may lie in a face that is parallel to it.
    check_all(0.1, |random| {
        let size = 2f64.powf(4.0 * random.signed());
        let near = 4.0 * size * random.in_cube();
        let SampledSolid { solid, points, .. } = SampledSolid::random(random, near, size, 3);
        let ray = |_| ray_at(random, &points, near, size);
        (solid, (0..RAYS_PER_SOLID).map(ray).collect())
    });
}

/// A number from −`most` to `most`.
fn small(random: &mut Random, most: i32) -> i32 {
    random.index(2 * most as usize + 1) as i32 - most
}

fn positive(random: &mut Random) -> i32 {
    1 + random.index(3) as i32
}

/// A vector along an axis.
fn whole_axis(random: &mut Random, frame: &Frame) -> Vec3 {
    let mut axis = [0; 3];
    axis[random.index(3)] = [-2, -1, 1, 2][random.index(4)];
    frame.vector(axis)
}

/// A shape with flat surfaces in small integers, so that surfaces of several coincide and touch.
fn whole_flat(random: &mut Random, frame: &Frame) -> OracleSolid {
    let place = [(); 3].map(|()| small(random, 2));
    let centre = frame.point(place);
    match random.index(4) {
        0 => OracleSolid::of(Plane {
            point: centre,
            // Not 0: one coordinate is 4 at least.
            normal: whole_axis(random, frame) + frame.vector([2, 6, 0]),
        }),
        1 => {
            let axis = random.index(3);
            OracleSolid::of(AxisPlane {
                axis: axis as u8,
                coordinate: centre[axis],
                is_along_axis: random.index(2) == 0,
            })
        }
        2 => {
            let [a, b, _] = triple(random);
            OracleSolid::of(Cuboid {
                centre,
                axes: [[a, b, 0], [-b, a, 0], [0, 0, 8]].map(|v| 0.125 * frame.vector(v)),
            })
        }
        _ => {
            let half = [(); 3].map(|()| positive(random));
            let corner = |sign: i32| std::array::from_fn(|k| place[k] + sign * half[k]);
            // The frame permutes the axes, but doesn't mirror them.
            let [min, max] = [-1, 1].map(|sign| frame.point(corner(sign)));
            OracleSolid::of(AxisBox { min, max })
        }
    }
}

/// The same with curved surfaces.
fn whole_round(random: &mut Random, frame: &Frame) -> OracleSolid {
    let centre = frame.point([(); 3].map(|()| small(random, 2)));
    let axis = whole_axis(random, frame);
    let [radius, other] = [(); 2].map(|()| frame.length(positive(random)));
    let (p0, p1, is_capped) = (centre, centre + axis, true);
    match random.index(5) {
        0 => OracleSolid::of(Sphere { centre, radius }),
        1 => OracleSolid::of(Cylinder {
            p0,
            p1,
            radius,
            is_capped,
        }),
        2 => OracleSolid::of(Cone {
            p0,
            p1,
            radius,
            is_capped,
        }),
        3 => OracleSolid::of(Torus {
            centre,
            axis,
            major: radius,
            minor: other,
        }),
        _ => {
            let mut coefficients = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
            coefficients[random.index(3)] = [-1.0, 0.0, 1.0][random.index(3)];
            coefficients[9] = [-1.0, 0.0][random.index(2)] * radius * radius;
            OracleSolid::of(Quadric {
                coefficients,
                centre,
                half: Vec3::splat(other),
            })
        }
    }
}

fn whole_solid(random: &mut Random, frame: &Frame, depth: u32) -> OracleSolid {
    if depth == 0 || random.index(4) == 0 {
        return match random.index(2) {
            0 => whole_flat(random, frame),
            _ => whole_round(random, frame),
        };
    }
    let operation = CsgOperation::ALL[random.index(3)];
    let parts = [(); 2].map(|()| whole_solid(random, frame, depth - 1));
    OracleSolid::Combined(operation, parts.into())
}

#[test]
fn crossings_of_solids_whose_surfaces_coincide_and_touch_are_exact() {
    // Coordinates are among few integers, so many rays lie in a face.
    check_all(0.75, |random| {
        let frame = Frame::random(random);
        let solid = whole_solid(random, &frame, 3);
        let ray = |_| {
            let through = [(); 3].map(|()| small(random, 3));
            let mut dir = [(); 3].map(|()| small(random, 2));
            if dir == [0; 3] {
                dir = [0, 0, 1];
            }
            frame.ray(through, dir, random.index(7) as i32)
        };
        (solid, (0..RAYS_PER_SOLID).map(ray).collect())
    });
}

#[test]
fn the_oracle_finds_crossings_in_order() {
    let mut random = Random::new(1);
    let mut crossings = 0;
    for _ in 0..200 {
        let sampled = SampledSolid::random(&mut random, DVec3::ZERO, 1.0, 2);
        let SampledSolid { solid, points, .. } = sampled;
        let ray = ray_at(&mut random, &points, DVec3::ZERO, 1.0);
        let Some(mut division) = solid.division(&ray) else {
            continue;
        };
        let ends: Vec<f64> = division.ends.iter_mut().map(ExactT::to_f64).collect();
        assert_eq!(division.middles.len(), ends.len() + 1);
        for (k, t) in ends.iter().enumerate() {
            assert!(division.middles[k] < *t && *t < division.middles[k + 1]);
        }
        crossings += division.crossings().len();
    }
    assert!(crossings > 20, "{crossings}");
}
