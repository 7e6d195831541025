//! Scenes of spheres, and of spheres and triangles: trees and groups don't change answers.

use super::{Sample, ray_near};
use glam::Vec3;
use hitscope_core::group::Grouped;
use hitscope_core::intersector::Packing;
use hitscope_core::kernel::{KernelChoice, KernelTable, TRIANGLE_KERNELS, Tier, exact_answer};
use hitscope_core::mesh::shapes::{Placement, soup, sphere};
use hitscope_core::mesh::{Runs, TriangleMesh};
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use hitscope_core::scene::SceneOptions;
use hitscope_core::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Disk, Plane, Quadric, Rectangle, Sphere, Torus,
};
use hitscope_core::{Hit, Ray, Scene};

fn scene_of<S: Grouped>(mesh: TriangleMesh, shapes: Vec<S>, packing: Packing) -> Scene {
    let options = SceneOptions {
        packing,
        ..SceneOptions::default()
    };
    let progress = Progress::default();
    let mut scene = Scene::with_options(mesh, options, &progress).expect("nobody cancels");
    let added = scene.add_group(shapes, Runs::default(), options, &progress);
    added.expect("nobody cancels");
    scene
}

fn samples<S: Sample>(random: &mut Random, count: usize) -> Vec<S> {
    let near = |random: &mut Random| random.in_cube().as_vec3();
    (0..count)
        .map(|_| {
            let at = near(random);
            S::sample(random, at, 0.1)
        })
        .collect()
}

/// The nearest of the hits of all primitives, tested one by one.
fn nearest<S: KernelTable>(kernel: KernelChoice, shapes: &[S], ray: &Ray) -> Option<Hit> {
    let row = kernel.row::<S>();
    let hit = |(primitive, shape): (usize, &S)| {
        let hit = row.intersect(ray, shape.clone())?;
        Some(Hit {
            primitive: primitive as u32,
            ..hit
        })
    };
    let hits = shapes.iter().enumerate().filter_map(hit);
    hits.min_by(|a, b| a.t.total_cmp(&b.t))
}

fn answers_match_one_by_one<S: Sample>(seed: u64) {
    let mut random = Random::new(seed);
    let shapes: Vec<S> = samples(&mut random, 300);
    for packing in [Packing::Full, Packing::Compact] {
        let scene = scene_of(TriangleMesh::default(), shapes.clone(), packing);
        assert_eq!(scene.groups().len(), 1);
        for row in S::kernels() {
            let (kernel, name) = (KernelChoice::from(row), row.info.name);
            let intersector = scene.intersector(kernel);
            let rays: Vec<Ray> = (0..256)
                .map(|_| ray_near(&mut random, Vec3::ZERO, 1.0, 3.0))
                .collect();
            let mut hits = vec![None; rays.len()];
            intersector.closest_hits(&rays, &mut hits);
            let mut are_hits = vec![false; rays.len()];
            intersector.any_hits(&rays, &mut are_hits);
            for ((ray, hit), is_hit) in rays.iter().zip(&hits).zip(are_hits) {
                // A false hit may lie outside the primitive's box, where it doesn't count.
                let is_right = |shape: &S| {
                    row.intersect(ray, shape.clone()).is_some()
                        == exact_answer(ray, shape).is_some()
                };
                if !shapes.iter().all(is_right) {
                    continue;
                }
                assert_eq!(*hit, nearest(kernel, &shapes, ray), "{name} {ray:?}");
                assert_eq!(hit.is_some(), is_hit, "{name}");
                assert_eq!(intersector.closest_hit_with_cost(ray).0, *hit, "{name}");
                let all = intersector.all_hits(ray);
                assert_eq!(all.first().map(|first| first.hit), *hit, "{name}");
                assert!(all.is_sorted_by(|a, b| a.hit.t <= b.hit.t), "{name}");
            }
            assert!(hits.iter().flatten().count() > 50, "{name}");
        }
    }
}

#[test]
fn primitives_in_a_tree_give_the_answers_of_primitives_tested_one_by_one() {
    answers_match_one_by_one::<Sphere>(1);
    answers_match_one_by_one::<Plane>(2);
    answers_match_one_by_one::<Disk>(3);
    answers_match_one_by_one::<Rectangle>(4);
    answers_match_one_by_one::<Cuboid>(5);
    answers_match_one_by_one::<Cylinder>(6);
    answers_match_one_by_one::<Cone>(7);
    answers_match_one_by_one::<Quadric>(8);
    answers_match_one_by_one::<Torus>(9);
    answers_match_one_by_one::<AxisBox>(10);
    answers_match_one_by_one::<AxisPlane>(11);
}

#[test]
fn packets_of_coherent_rays_hit_spheres_as_single_rays_do() {
    let mut random = Random::new(2);
    let shapes: Vec<Sphere> = samples(&mut random, 300);
    let scene = scene_of(TriangleMesh::default(), shapes, Packing::Full);
    let intersector = scene.intersector(Sphere::kernel_of(Tier::Watertight));
    assert!(intersector.rays_together() > 1);
    let rays: Vec<Ray> = (0..4096)
        .map(|k| {
            let target = Vec3::new(
                (k % 64) as f32 / 32.0 - 1.0,
                (k / 64) as f32 / 32.0 - 1.0,
                0.0,
            );
            let origin = Vec3::new(0.0, 0.0, -4.0);
            Ray::new(origin, target - origin).expect("a ray")
        })
        .collect();
    let (mut alone, mut together) = (vec![None; rays.len()], vec![None; rays.len()]);
    intersector.closest_hits(&rays, &mut alone);
    intersector.coherent_hits(&rays, &mut together);
    assert_eq!(alone, together);
    assert!(alone.iter().flatten().count() > 1000);
}

#[test]
fn every_crossing_of_a_sphere_is_listed() {
    let shapes = vec![
        Sphere {
            centre: Vec3::ZERO,
            radius: 1.0,
        },
        Sphere {
            centre: Vec3::ZERO,
            radius: 0.5,
        },
    ];
    let scene = scene_of(TriangleMesh::default(), shapes, Packing::Full);
    let ray = Ray::new(Vec3::NEG_Z * 3.0, Vec3::Z).expect("a ray");
    for row in Sphere::kernels() {
        let crossings = scene.intersector(row).all_hits(&ray);
        let found: Vec<_> = crossings
            .iter()
            .map(|c| (c.hit.t, c.hit.primitive))
            .collect();
        let expected = [(2.0, 0), (2.5, 1), (3.5, 1), (4.0, 0)];
        assert_eq!(found, expected, "{}", row.info.name);
    }
}

#[test]
fn the_nearest_hit_of_several_groups_counts() {
    let mut random = Random::new(3);
    let shapes: Vec<Sphere> = samples(&mut random, 100);
    let mesh = sphere(8, Placement::UNIT);
    let triangles = mesh.triangles().len() as u32;
    let both = scene_of(mesh.clone(), shapes.clone(), Packing::Full);
    let alone = scene_of(TriangleMesh::default(), shapes, Packing::Full);
    let mesh = hitscope_core::scene::scene(mesh);
    assert_eq!(both.primitive_count(), triangles as usize + 100);
    for row in TRIANGLE_KERNELS.iter() {
        let name = row.info.name;
        let [both, alone, mesh] = [&both, &alone, &mesh].map(|scene| scene.intersector(row));
        let rays: Vec<Ray> = (0..512)
            .map(|_| ray_near(&mut random, Vec3::ZERO, 1.0, 3.0))
            .collect();
        let mut of_groups = [0, 0];
        let mut hits = vec![None; rays.len()];
        both.coherent_hits(&rays, &mut hits);
        let mut any = vec![false; rays.len()];
        both.coherent_any_hits(&rays, &mut any);
        assert!(hits.iter().map(Option::is_some).eq(any), "{name}");
        for (ray, hit) in rays.iter().zip(hits) {
            let of_mesh = mesh.closest_hit(ray);
            let of_spheres = alone.closest_hit(ray).map(|hit| Hit {
                primitive: triangles + hit.primitive,
                ..hit
            });
            // The triangle counts if t is equal.
            let expected = match (of_mesh, of_spheres) {
                (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
                (a, b) => a.or(b),
            };
            assert_eq!(hit, expected, "{name}");
            assert_eq!(both.closest_hit(ray), hit, "{name}");
            assert_eq!(both.any_hit(ray), hit.is_some(), "{name}");
            let count = mesh.all_hits(ray).len() + alone.all_hits(ray).len();
            assert!(both.all_hits(ray).len() <= count, "{name}");
            if let Some(hit) = hit {
                of_groups[usize::from(hit.primitive >= triangles)] += 1;
            }
        }
        assert!(
            of_groups[0] > 100 && of_groups[1] > 10,
            "{name} {of_groups:?}"
        );
    }
}

#[test]
fn groups_behind_the_nearest_hit_so_far_cost_no_tests_of_primitives() {
    let mesh = soup(&[[[-2.0, -2.0], [2.0, -2.0], [0.0, 3.0]].map(|[x, y]| Vec3::new(x, y, -2.0))]);
    let mut shapes: Vec<Sphere> = samples(&mut Random::new(4), 100);
    shapes.push(Sphere {
        centre: Vec3::ZERO,
        radius: 0.5,
    });
    let behind = scene_of(mesh.clone(), shapes.clone(), Packing::Full);
    let alone = scene_of(TriangleMesh::default(), shapes, Packing::Full);
    let mesh = hitscope_core::scene::scene(mesh);
    let ray = Ray::new(Vec3::NEG_Z * 3.0, Vec3::Z).expect("a ray");
    for row in TRIANGLE_KERNELS.iter() {
        let cost = |scene: &Scene| scene.intersector(row).closest_hit_with_cost(&ray).1;
        let [behind, alone, mesh] = [&behind, &alone, &mesh].map(cost);
        assert!(alone.primitives > 0, "{}", row.info.name);
        assert_eq!(behind.primitives, mesh.primitives, "{}", row.info.name);
    }
}

#[test]
fn a_triangle_that_touches_a_sphere_at_the_hit_counts_as_one_crossing_of_the_exact_kernel() {
    // The plane z = −1 touches the unit sphere at its pole, where the ray comes down.
    let corners = [[-2.0, -2.0], [2.0, -2.0], [0.0, 3.0]];
    let mesh = soup(&[corners.map(|[x, y]| Vec3::new(x, y, -1.0))]);
    let unit = Sphere {
        centre: Vec3::ZERO,
        radius: 1.0,
    };
    let scene = scene_of(mesh, vec![unit], Packing::Full);
    let exact = scene.intersector(Sphere::kernel_of(Tier::Exact));
    let at_pole = Ray::new(Vec3::NEG_Z * 3.0, Vec3::Z).expect("a ray");
    let crossings = exact.all_hits(&at_pole);
    assert_eq!(
        (crossings[0].hit.primitive, &crossings[0].also[..]),
        (0, &[1][..])
    );
    // Beside the pole the triangle is nearer, by 2⁻⁴¹.
    let beside = Ray::new(Vec3::new(2f32.powi(-20), 0.0, -3.0), Vec3::Z).expect("a ray");
    let crossings = exact.all_hits(&beside);
    let order: Vec<u32> = crossings.iter().map(|c| c.hit.primitive).collect();
    assert_eq!(order, [0, 1, 1]);
    assert_eq!(crossings[0].hit.t, crossings[1].hit.t);
    // From inside the sphere is nearer.
    let inside = Ray::new(Vec3::new(2f32.powi(-20), 0.0, 0.0), Vec3::NEG_Z).expect("a ray");
    assert_eq!(exact.closest_hit(&inside).map(|hit| hit.primitive), Some(1));
}
