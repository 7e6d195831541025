//! Watertight kernels: no ray leaves a closed mesh, not even one aimed at an edge or a corner.
//!
//! More than a million rays per kernel, of which none may leave; 0 of n means a rate below 3/n at 95 %
//! confidence.

use glam::{DVec3, Vec3, Vec3Swizzles};
use hitscope_core::kernel::{TRIANGLE_KERNELS, TriangleKernel};
use hitscope_core::mesh::corridors::{Corridor, FOOTPRINTS, Footprint};
use hitscope_core::mesh::shapes::{Placement, cube, flat_grid, in_torus, sphere, torus};
use hitscope_core::mesh::{Flaw, Health};
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::{Intersector, Ray, TriangleMesh};
use std::thread;

fn watertight_kernels() -> impl Iterator<Item = &'static TriangleKernel> {
    TRIANGLE_KERNELS
        .iter()
        .filter(|kernel| kernel.info.promises.is_watertight)
}

/// A closed mesh, and how to choose origins inside it. Rays are aimed at the mesh's edges and corners.
struct Case {
    name: String,
    mesh: TriangleMesh,
    place: Placement,
    /// A random point inside the mesh, before placement.
    inside: fn(&mut Random) -> DVec3,
    rays: usize,
}

/// A point within half the tube's radius of its centre line.
fn inside_torus(random: &mut Random) -> DVec3 {
    in_torus(random.unit(), random.unit(), 0.5 * random.unit())
}

/// Stretch factor along x.
const STRETCH: f64 = 1e5;

fn inside_sphere(random: &mut Random) -> DVec3 {
    0.4 * random.in_cube()
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for scale in [1e-18, 1e-12, 1e-6, 1.0, 1e6, 1e12, 1e17] {
        for offset in [0.0, 1e3, 1.5e5, 1e6] {
            let place = Placement::new(scale, offset);
            // Farther from the origin, f32 can distinguish fewer triangles.
            let around = if offset > 1e3 { 12 } else { 32 };
            cases.push(Case {
                name: format!("torus of scale {scale:e} offset by {offset:e} times that"),
                mesh: torus(around, around / 2, place),
                place,
                inside: inside_torus,
                rays: 60_000,
            });
        }
        let place = Placement::new(scale, 7.0);
        cases.push(Case {
            name: format!("sphere of scale {scale:e}"),
            mesh: sphere(8, place),
            place,
            inside: inside_sphere,
            rays: 40_000,
        });
    }
    // A torus stretched to needles; many of the rays are nearly parallel to them.
    let stretch = Vec3::new(STRETCH as f32, 1.0, 1.0);
    let stretched = torus(32, 16, Placement::UNIT).map_positions(|p| p * stretch);
    cases.push(Case {
        name: "torus stretched to needles".to_owned(),
        mesh: stretched,
        place: Placement::UNIT,
        inside: |random| DVec3::new(STRETCH, 1.0, 1.0) * inside_torus(random),
        rays: 60_000,
    });
    // A position where fixed epsilons are known to fail.
    let place = Placement {
        scale: 2.0,
        offset: DVec3::new(148_376.0, 1234.0, -223_423.0),
    };
    cases.push(Case {
        name: "sphere far out".to_owned(),
        mesh: sphere(6, place),
        place,
        inside: inside_sphere,
        rays: 60_000,
    });
    cases
}

/// A ray from the inside to a corner, or to a point on an edge, aimed as exactly as f32 allows.
fn aimed_ray(case: &Case, random: &mut Random) -> Ray {
    let origin = case.place.of((case.inside)(random));
    let corners = case
        .mesh
        .corners(random.index(case.mesh.triangles().len()) as u32);
    let start = random.index(3);
    let (a, b) = (corners[start], corners[(start + 1) % 3]);
    let along = [0.0, 0.5, random.unit()][random.index(3)];
    let target = a.as_dvec3().lerp(b.as_dvec3(), along);
    let dir = (target - origin.as_dvec3()).as_vec3();
    Ray::new(origin, dir).expect("the origin isn't on the surface")
}

/// Number of rays that leave the mesh, and the first of them.
fn leaks(case: &Case, intersector: &dyn Intersector, seed: u64) -> (usize, Option<Ray>) {
    let mut random = Random::new(seed);
    let rays = (0..case.rays).map(|_| aimed_ray(case, &mut random));
    let mut leaking = rays.filter(|ray| intersector.closest_hit(ray).is_none());
    let first = leaking.next();
    (usize::from(first.is_some()) + leaking.count(), first)
}

#[test]
fn no_ray_leaves_a_closed_mesh_through_an_edge_or_a_corner() {
    let cases = cases();
    assert!(cases.iter().map(|case| case.rays).sum::<usize>() >= 1_000_000);
    for kernel in watertight_kernels() {
        let check = |(k, case): (usize, &Case)| {
            assert_eq!(
                Health::of(&case.mesh).places(Flaw::OpenEdge).count(),
                Some(0),
                "{}",
                case.name
            );
            let intersector = scene(case.mesh.clone()).intersector(kernel);
            let (count, first) = leaks(case, &*intersector, k as u64);
            (count > 0).then(|| {
                format!(
                    "{count} of {} rays leave the {}, such as {first:?}",
                    case.rays, case.name
                )
            })
        };
        let (cases, check) = (&cases, &check);
        let found: Vec<String> = thread::scope(|scope| {
            let half = |start: usize| {
                scope.spawn(move || {
                    let mine = cases.iter().enumerate().skip(start).step_by(2);
                    mine.filter_map(check).collect::<Vec<_>>()
                })
            };
            let halves = [half(0), half(1)];
            let joined = halves.into_iter().map(|half| half.join().expect("checked"));
            joined.flatten().collect()
        });
        assert!(
            found.is_empty(),
            "{}:\n{}",
            kernel.info.name,
            found.join("\n")
        );
    }
}

/// Rays per corridor and kernel; `HITSCOPE_LEAK_RAYS` overrides the default.
fn rays_per_corridor() -> usize {
    let asked = std::env::var("HITSCOPE_LEAK_RAYS").ok();
    asked.map_or(1_500, |n| n.parse().expect("a number of rays"))
}

#[test]
fn no_ray_leaves_a_long_box_prism_or_corridor() {
    let lengths = [1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6];
    let cases = FOOTPRINTS.iter().flat_map(|&footprint| {
        let lengths = lengths.iter();
        lengths.flat_map(move |&l| [(footprint, l, false), (footprint, l, true)])
    });
    let mut leaks = Vec::new();
    for (footprint, length, is_turned) in cases {
        let corridor = Corridor::new(footprint, length, is_turned);
        let scene = scene(corridor.mesh.clone());
        for kernel in watertight_kernels() {
            let intersector = scene.intersector(kernel);
            let mut random = Random::new(17);
            let rays: Vec<Ray> = (0..rays_per_corridor())
                .map(|_| corridor.ray(&mut random))
                .collect();
            let (mut alone, mut together) = (vec![None; rays.len()], vec![None; rays.len()]);
            let (mut any, mut any_together) = (vec![false; rays.len()], vec![false; rays.len()]);
            intersector.closest_hits(&rays, &mut alone);
            intersector.coherent_hits(&rays, &mut together);
            intersector.any_hits(&rays, &mut any);
            intersector.coherent_any_hits(&rays, &mut any_together);
            let is_lost = |i: &usize| {
                alone[*i].is_none() || together[*i].is_none() || !any[*i] || !any_together[*i]
            };
            let lost: Vec<usize> = (0..rays.len()).filter(is_lost).collect();
            if let Some(first) = lost.first() {
                leaks.push(format!(
                    "{}: {} leave the {footprint:?} of {length:e}, turned {is_turned}: {:?}",
                    kernel.info.name,
                    lost.len(),
                    rays[*first]
                ));
            }
        }
    }
    assert!(leaks.is_empty(), "{}", leaks.join("\n"));
}

/// Rays that left the mesh before edges and t were decided exactly.
#[test]
fn rays_that_once_left_a_box_hit_its_wall() {
    let cube = Corridor::new(Footprint::Square, 1.0, false).mesh;
    let long = Corridor::new(Footprint::Square, 30.0, false).mesh;
    // Along x, as when the ray was found.
    let long = long.map_positions(|p| p.zxy());
    for (mesh, origin, dir, t) in [
        (
            cube,
            Vec3::new(0.1, 0.95, 0.99),
            Vec3::new(0.06, 0.050_000_1, 0.01),
            1_677_722.0 / 1_677_725.0,
        ),
        (
            long,
            Vec3::new(0.5, 0.2, 0.3),
            Vec3::new(1.0, 0.8, 0.700_002),
            11_744_051.0 / 11_744_085.0,
        ),
    ] {
        let scene = scene(mesh);
        for kernel in watertight_kernels() {
            let ray = Ray::new(origin, dir).expect("a ray");
            let hit = scene.intersector(kernel).closest_hit(&ray);
            let found = f64::from(hit.unwrap_or_else(|| panic!("{}", kernel.info.name)).t);
            // Error bound of t: 513u.
            let most = 513.0 * t / f64::from(1 << 24);
            assert!((found - t).abs() <= most, "{} {found}", kernel.info.name);
        }
    }
}

#[test]
fn no_ray_between_lattice_points_leaves_a_cube_on_the_lattice() {
    // All numbers are exact: the rays pass exactly through edges and corners, not only near them.
    const CELLS: u32 = 8;
    let mut random = Random::new(11);
    for kernel in watertight_kernels() {
        for offset in [0.0, 1024.0, -131_072.0] {
            let place = Placement {
                scale: 1.0,
                offset: DVec3::splat(offset),
            };
            let intersector = scene(cube(CELLS, place)).intersector(kernel);
            for _ in 0..40_000 {
                let mut lattice =
                    |from: usize, to: usize| (from + random.index(to - from)) as f64 * 0.5;
                let origin = DVec3::new(lattice(1, 16), lattice(1, 16), lattice(1, 16));
                let mut target = DVec3::new(lattice(0, 17), lattice(0, 17), lattice(0, 17));
                let (axis, is_upper) = (random.index(3), random.index(2) == 1);
                target[axis] = if is_upper { f64::from(CELLS) } else { 0.0 };
                let ray = Ray::new(place.of(origin), (target - origin).as_vec3()).expect("a ray");
                let hit = intersector.closest_hit(&ray);
                let t = hit
                    .unwrap_or_else(|| panic!("{} {ray:?}", kernel.info.name))
                    .t;
                // t is 1 and all coordinates are exact. Roundings: two in each edge function, which count
                // once because they are normalised; two in det; a product, two sums and 1/d_z in the depth,
                // and its product; the quotient: 8 half-ulps are 4ε.
                assert!(
                    (t - 1.0).abs() <= 4.0 * f32::EPSILON,
                    "{} {t} {ray:?}",
                    kernel.info.name
                );
            }
        }
    }
}

#[test]
fn an_axis_aligned_ray_hits_the_border_edges_and_corners_of_a_flat_grid() {
    const CELLS: u32 = 8;
    for kernel in watertight_kernels() {
        for place in [
            Placement::UNIT,
            Placement::new(1.0, 4096.0),
            Placement::new(0.001, 0.5),
        ] {
            let mesh = flat_grid(CELLS, place);
            let points: Vec<Vec3> = (0..=2 * CELLS)
                .flat_map(|y| (0..=2 * CELLS).map(move |x| (x, y)))
                .map(|(x, y)| place.of(DVec3::new(f64::from(x) / 2.0, f64::from(y) / 2.0, 0.0)))
                .collect();
            for axis in 0..3 {
                // The grid rotated, so that the ray is parallel to each axis in turn.
                let turned = |p: Vec3| [p.yzx(), p.zxy(), p][axis];
                let intersector = scene(mesh.map_positions(turned)).intersector(kernel);
                for (dir, &point) in
                    directions().flat_map(|dir| points.iter().map(move |p| (dir, p)))
                {
                    let ray = Ray::new(turned(point - dir), turned(dir)).expect("a ray");
                    let t = intersector.closest_hit(&ray).map(|hit| hit.t);
                    assert_eq!(t, Some(1.0), "{} {ray:?}", kernel.info.name);
                    assert!(intersector.any_hit(&ray), "{} {ray:?}", kernel.info.name);
                }
            }
        }
    }
}

#[test]
fn a_direction_whose_reciprocal_overflows_still_hits_the_border_of_a_flat_grid() {
    // 1e-42 is so small that its reciprocal is infinite; the ray hits the border exactly.
    let tiny = 1e-42f32;
    for kernel in watertight_kernels() {
        let intersector = scene(flat_grid(4, Placement::UNIT)).intersector(kernel);
        for (x, slope) in [(-tiny, tiny), (0.0, tiny), (0.0, -0.0), (tiny, -tiny)] {
            let ray = Ray::new(Vec3::new(x, 1.25, -1.0), Vec3::new(slope, 0.0, 1.0));
            let t = intersector
                .closest_hit(&ray.expect("a ray"))
                .map(|hit| hit.t);
            assert_eq!(t, Some(1.0), "{} from {x} by {slope}", kernel.info.name);
        }
    }
}

/// Up and down along z; the other two components are zeros of either sign. The length is a power of two, so
/// that the origin is exact.
fn directions() -> impl Iterator<Item = Vec3> {
    [1.0f32, -1.0].into_iter().flat_map(|z| {
        let zeros = [(0.0, 0.0), (0.0, -0.0), (-0.0, 0.0), (-0.0, -0.0)];
        zeros.map(|(x, y)| Vec3::new(x, y, 64.0 * z))
    })
}
