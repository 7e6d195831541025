//! A ray in a packet gets the same bits as a single ray.

use crate::simd::bits;
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::mesh::shapes::{Placement, cube};
use hitscope_core::random::Random;
use hitscope_core::scene::scene;

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
            let (mut alone, mut together) = ([None; TOGETHER], [None; TOGETHER]);
            intersector.closest_hits(&rays, &mut alone);
            intersector.coherent_hits(&rays, &mut together);
            for (ray, (alone, together)) in rays.iter().zip(alone.iter().zip(&together)) {
                assert_eq!(bits(alone), bits(together), "{} {ray:?}", kernel.info.name);
                hits += usize::from(alone.is_some());
            }
        }
        assert!(hits > 20_000, "{hits}");
    }
}
