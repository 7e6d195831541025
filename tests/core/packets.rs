//! A ray in a packet gets the same bits as a single ray.

use crate::simd::bits;
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::intersector::Intersector;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::mesh::shapes::{Placement, cube, soup, torus};
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::simd::SimdLevel;

/// Rays per packet.
const TOGETHER: usize = 16;

/// Sixteen rays inside a cube from 0 to `cells`. Some run in planes between the cells, so that 1/d is
/// infinite and the distance to a plane 0; the others deviate by slopes down to 1e-42. Their origins are
/// equal or differ.
fn along_planes(cells: usize, random: &mut Random) -> [Ray; TOGETHER] {
    let mut lattice = || 0.5 * (1 + random.index(2 * cells - 1)) as f32;
    let start = Vec3::new(lattice(), lattice(), lattice());
    let on_border = random.index(4);
    let down = [random.index(2) == 1, random.index(2) == 1];
    let is_apart = random.index(2) == 1;
    [(); TOGETHER].map(|()| {
        let (mut origin, mut dir) = (start, Vec3::Z);
        for axis in 0..2 {
            if axis == on_border {
                origin[axis] = if down[axis] { 0.0 } else { cells as f32 };
            } else if is_apart && random.index(2) == 1 {
                origin[axis] = random.index(cells + 1) as f32;
            }
            let slope = [0.0, 0.0, 1e-42, 0.03, 0.25][random.index(5)];
            dir[axis] = if down[axis] { -slope } else { slope };
        }
        Ray::new(origin, dir).expect("a ray")
    })
}

/// The number of hits, after checking that packets have those of single rays, bit for bit.
fn hits_alone_and_together(intersector: &dyn Intersector, rays: &[Ray]) -> usize {
    let name = intersector.kernel().name;
    let (mut alone, mut together) = (vec![None; rays.len()], vec![None; rays.len()]);
    intersector.closest_hits(rays, &mut alone);
    intersector.coherent_hits(rays, &mut together);
    for (ray, (alone, together)) in rays.iter().zip(alone.iter().zip(&together)) {
        assert_eq!(bits(alone), bits(together), "{name} {ray:?}");
    }
    let mut any = vec![false; rays.len()];
    intersector.coherent_any_hits(rays, &mut any);
    for (ray, (hit, any)) in rays.iter().zip(alone.iter().zip(&any)) {
        assert_eq!(hit.is_some(), *any, "{name} any {ray:?}");
    }
    alone.iter().flatten().count()
}

#[test]
fn packets_along_box_planes_give_the_same_hits_as_single_rays() {
    const CELLS: usize = 6;
    let place = Placement {
        scale: 1.0,
        offset: DVec3::ZERO,
    };
    let scene = scene(cube(CELLS as u32, place));
    for kernel in TRIANGLE_KERNELS.iter() {
        let intersector = scene.intersector(kernel);
        if intersector.rays_together() != TOGETHER {
            continue;
        }
        let mut random = Random::new(5);
        let mut hits = 0;
        for _ in 0..3000 {
            let rays = along_planes(CELLS, &mut random);
            hits += hits_alone_and_together(&*intersector, &rays);
        }
        assert!(hits > 20_000, "{hits}");
    }
}

#[test]
fn parallel_rays_from_all_over_the_scene_hit_what_single_rays_hit() {
    let scene = scene(torus(200, 100, Placement::UNIT));
    let dir = Vec3::new(0.2, 0.3, -1.0);
    let mut random = Random::new(31);
    let rays: Vec<Ray> = (0..4096)
        .map(|_| Ray::new(1.5 * random.in_cube_f32() - 4.0 * dir, dir).expect("a ray"))
        .collect();
    for kernel in TRIANGLE_KERNELS.iter() {
        let intersector = scene.intersector(kernel);
        if intersector.rays_together() == TOGETHER {
            let hits = hits_alone_and_together(&*intersector, &rays);
            assert!(hits > 500, "{}: {hits}", kernel.info.name);
        }
    }
}

/// Meshes in which many hits are close to each other or to an edge: random triangles, copies of a triangle and pieces
/// of it, triangles in one plane, slivers and triangles of zero area.
fn hard_meshes(random: &mut Random) -> Vec<Vec<[Vec3; 3]>> {
    let triangle = |random: &mut Random| [(); 3].map(|()| random.in_cube_f32());
    let apart: Vec<_> = (0..200).map(|_| triangle(random)).collect();
    let mut copies = Vec::new();
    for _ in 0..20 {
        let [a, b, c] = triangle(random);
        let middle = 0.5 * (a + b);
        copies.extend([
            [a, b, c],
            [b, c, a],
            [a, middle, c],
            [middle, b, c],
            [a, c, b],
        ]);
    }
    let in_plane = |random: &mut Random| {
        let p = random.in_cube_f32();
        Vec3::new(p.x, p.y, 0.25 * p.x + 0.5 * p.y)
    };
    let layers: Vec<_> = (0..60)
        .map(|_| [(); 3].map(|()| in_plane(random)))
        .collect();
    let sliver = |random: &mut Random| {
        let [a, b, c] = triangle(random);
        [a, b, a.lerp(b, 0.3) + 1e-6 * c]
    };
    let mut thin: Vec<_> = (0..100).map(|_| sliver(random)).collect();
    for _ in 0..20 {
        let [a, b, c] = triangle(random);
        thin.extend([[a, a, b], [a, b, a.lerp(b, 0.5)], [a, b, c]]);
    }
    vec![apart, copies, layers, thin]
}

/// Sixteen rays from nearly one point, or from nearly one line, to points near a triangle's edge or corner.
fn beam(corners: &[[Vec3; 3]], size: f32, random: &mut Random) -> [Ray; TOGETHER] {
    let [a, b, _] = corners[random.index(corners.len())];
    let target = [a, b, a.lerp(b, random.unit() as f32)][random.index(3)];
    let toward = random.in_cube_f32().signum() * Vec3::new(0.3, 0.7, 1.1);
    let distance = size * [0.1, 1.0, 3.0, 1e4][random.index(4)];
    let spread = size * [0.0, 1e-7, 1e-4, 1e-2][random.index(4)];
    let (start, shift) = (target - distance * toward, random.index(2) as f32);
    let ends = [f32::INFINITY, f32::INFINITY, distance, 2.0 * distance];
    [(); TOGETHER].map(|()| {
        let near = target + spread * random.in_cube_f32();
        let origin = start + shift * (near - target);
        let t_min = [0.0, 0.0, 0.5 * distance][random.index(3)];
        let t_max = ends[random.index(4)];
        let dir = (near - origin) / distance;
        Ray::with_interval(origin, dir, t_min, t_max).expect("a ray")
    })
}

#[test]
fn packets_hit_near_far_tiny_thin_and_overlapping_triangles_as_single_rays_do() {
    let mut random = Random::new(23);
    for (m, unit) in hard_meshes(&mut random).iter().enumerate() {
        for (scale, offset) in [
            (1.0, 0.0),
            (1.0, 1e4),
            (1e-6, 0.0),
            (1e-18, 0.0),
            (1e12, 0.0),
        ] {
            let placed = |p: Vec3| scale * (p + offset);
            let corners: Vec<_> = unit.iter().map(|corners| corners.map(placed)).collect();
            let scene = scene(soup(&corners));
            let mut beams = Vec::new();
            for _ in 0..250 {
                beams.extend(beam(&corners, scale, &mut random));
            }
            for kernel in TRIANGLE_KERNELS.iter() {
                let mut of_levels = Vec::new();
                for level in SimdLevel::available() {
                    let intersector = scene.intersector_at(kernel, level);
                    if intersector.rays_together() == TOGETHER {
                        of_levels.push(hits_alone_and_together(&*intersector, &beams));
                    }
                }
                let place = format!(
                    "{} mesh {m} scale {scale} offset {offset}",
                    kernel.info.name
                );
                assert!(
                    of_levels.iter().all(|hits| *hits == of_levels[0]),
                    "{place}"
                );
                // Kernels that promise to be watertight hit at any scale.
                if kernel.info.promises.is_watertight && !of_levels.is_empty() {
                    assert!(of_levels[0] > 400, "{place}: {of_levels:?}");
                }
            }
        }
    }
}
