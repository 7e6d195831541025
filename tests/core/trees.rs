//! Tree construction and packing don't affect results: every tree and packing gives bit-identical hits,
//! however a kernel rounds.
//!
//! The reference is a tree in which every box holds the whole mesh, so that every ray is tested against every
//! triangle.

use crate::simd::bits;
use glam::Vec3;
use hitscope_core::bvh::Bvh;
use hitscope_core::intersector::{Intersector, Packing, mesh_intersector};
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::mesh::TriangleMesh;
use hitscope_core::mesh::shapes::{Placement, soup, torus};
use hitscope_core::random::Random;
use hitscope_core::shape::{Shape as _, Triangle, bounds_in};
use hitscope_core::simd::SimdLevel;
use hitscope_core::{Aabb, Ray};
use std::sync::Arc;

/// Intersecting needles at all angles and of all sizes: the worst case for f32 kernels.
fn needles(random: &mut Random) -> TriangleMesh {
    let needle = |random: &mut Random| {
        let size = 10f64.powf(3.0 * random.unit() - 3.0);
        let a = random.in_cube();
        let b = a + size * random.direction();
        let thin = size * 10f64.powf(-6.0 * random.unit());
        [a, b, b.lerp(a, random.unit()) + thin * random.direction()].map(|p| p.as_vec3())
    };
    let corners: Vec<[Vec3; 3]> = (0..600).map(|_| needle(random)).collect();
    soup(&corners)
}

/// Overlapping triangles in one plane: many hits at nearly the same t.
fn layers(random: &mut Random) -> TriangleMesh {
    let corner = |random: &mut Random| {
        let p = random.in_cube_f32();
        Vec3::new(p.x, p.y, 0.25 * p.x + 0.5 * p.y)
    };
    let corners: Vec<[Vec3; 3]> = (0..300)
        .map(|_| [corner(random), corner(random), corner(random)])
        .collect();
    soup(&corners)
}

/// Rays towards points on edges, in groups of nearly parallel ones. Some start in a triangle's plane, some
/// have intervals with negative t.
fn rays(mesh: &TriangleMesh, random: &mut Random) -> Vec<Ray> {
    let corner_list = mesh.corner_list();
    let aimed = (0..500).flat_map(|k| {
        let triangle = random.index(corner_list.len()) as u32;
        let [a, b, c] = corner_list[triangle as usize];
        let on_edge = a.lerp(b, random.unit() as f32);
        // Every second group grazes the triangle.
        let beside = on_edge + 3.0 * (c - a) + 2.0 * (b - a);
        let origin = if k % 2 == 0 {
            beside + 1e-4 * random.in_cube_f32()
        } else {
            on_edge + 2.0 * random.in_cube_f32()
        };
        let near = (0..16).map(|_| on_edge + 1e-6 * random.in_cube_f32());
        let targets: Vec<Vec3> = near.collect();
        let t_min = if k % 8 < 2 { -2.0 } else { 0.0 };
        targets.into_iter().map(move |target| {
            // One group in eight ends near its target, and one excludes a triangle.
            let t_max = if k % 8 == 3 { 1.0 } else { f32::INFINITY };
            let ray = Ray::with_interval(origin, target - origin, t_min, t_max).ok()?;
            let exclude = (k % 8 == 5).then_some(triangle);
            Some(Ray { exclude, ..ray })
        })
    });
    aimed.flatten().collect()
}

/// A tree's results: the closest hits, equal for single rays and packets, and the any-hit results.
fn answers(tree: &dyn Intersector, rays: &[Ray]) -> Vec<(Option<[u32; 4]>, bool)> {
    let (mut hits, mut together) = (vec![None; rays.len()], vec![None; rays.len()]);
    let mut any = vec![false; rays.len()];
    tree.closest_hits(rays, &mut hits);
    tree.coherent_hits(rays, &mut together);
    tree.any_hits(rays, &mut any);
    assert!(hits.iter().map(bits).eq(together.iter().map(bits)));
    for (ray, hit) in rays.iter().zip(&hits).step_by(7) {
        assert_eq!(bits(&tree.closest_hit_with_cost(ray).0), bits(hit));
    }
    assert!(hits.iter().map(Option::is_some).eq(any.iter().copied()));
    let mut any_together = vec![false; rays.len()];
    tree.coherent_any_hits(rays, &mut any_together);
    assert_eq!(any, any_together);
    hits.iter().map(bits).zip(any).collect()
}

#[test]
fn every_tree_and_packing_gives_bit_identical_hits_for_every_kernel() {
    let mut random = Random::new(11);
    let far_ring = torus(24, 12, Placement::new(1.0, 1e4));
    let meshes = [needles(&mut random), layers(&mut random), far_ring];
    for (m, mesh) in meshes.iter().enumerate() {
        let rays = rays(mesh, &mut random);
        let count = mesh.triangles().len();
        let all = (0..count as u32).map(bounds_in(mesh));
        let everything = all.fold(Aabb::EMPTY, Aabb::union);
        let built = [
            Bvh::build(count, &|_| everything, &|| Ok(())),
            Bvh::build(count, &bounds_in(mesh), &|| Ok(())),
            Bvh::build_quickly(count, &bounds_in(mesh), &|| Ok(())),
        ];
        let trees = built.map(|tree| Arc::new(tree.expect("not cancelled")));
        for kernel in TRIANGLE_KERNELS.iter() {
            let of_tree = |tree: &Arc<Bvh>, packing| {
                mesh_intersector(
                    kernel,
                    mesh,
                    Arc::clone(tree),
                    SimdLevel::current(),
                    packing,
                )
            };
            let expected = answers(&*of_tree(&trees[0], Packing::Full), &rays);
            assert!(expected.iter().filter(|(hit, _)| hit.is_some()).count() > 100);
            for (tree, packing) in [
                (&trees[1], Packing::Full),
                (&trees[2], Packing::Full),
                (&trees[1], Packing::Compact),
            ] {
                let found = answers(&*of_tree(tree, packing), &rays);
                let differ = |i: &usize| found[*i] != expected[*i];
                let first = (0..rays.len()).find(differ);
                assert_eq!(first, None, "{}, mesh {m}, {packing:?}", kernel.info.name);
            }
        }
    }
}

#[test]
fn a_corner_recomputed_from_an_edge_lies_in_the_triangles_box() {
    let mut random = Random::new(3);
    let mut beside = 0;
    for _ in 0..10_000 {
        let [a, b, c] = [1.0, 1e3, 1e-3].map(|scale| scale * random.in_cube_f32());
        let bounds = Triangle([a, b, c]).bounds();
        for p in [a, b, c, a + (b - a), a + (c - a)] {
            assert!(bounds.min.cmple(p).all() && p.cmple(bounds.max).all());
        }
        beside += usize::from(bounds != Aabb::around([a, b, c]));
    }
    assert!(beside > 100, "rounding moved {beside} corners out");
}
