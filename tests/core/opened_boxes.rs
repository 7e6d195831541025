//! The record of a walk: it holds the boxes and primitives that were tested, in order.

use glam::Vec3;
use hitscope_core::bvh::BoxContents;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::mesh::Runs;
use hitscope_core::mesh::shapes::{Placement, torus};
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use hitscope_core::scene::{SceneOptions, scene};
use hitscope_core::shape::Sphere;
use hitscope_core::{Ray, Scene};

/// A torus, and spheres on a circle around it.
fn torus_and_spheres() -> Scene {
    let mut scene = scene(torus(40, 24, Placement::UNIT));
    let sphere = |k: u8| {
        let (y, x) = f32::from(k).sin_cos();
        Sphere {
            centre: 2.0 * Vec3::new(x, y, 0.0),
            radius: 0.3,
        }
    };
    let spheres: Vec<Sphere> = (0..40).map(sphere).collect();
    let options = SceneOptions::default();
    let added = scene.add_group(spheres, Runs::default(), options, &Progress::default());
    added.expect("nobody cancels");
    scene
}

#[test]
fn the_record_has_the_tests_that_the_cost_counts_and_the_primitive_that_is_hit() {
    let scene = torus_and_spheres();
    let mut random = Random::new(11);
    let mut hits = 0;
    for kernel in TRIANGLE_KERNELS.iter() {
        let intersector = scene.intersector(kernel);
        for _ in 0..100 {
            let origin = 4.0 * random.direction().as_vec3();
            let dir = random.in_cube_f32() - origin;
            let ray = Ray::new(origin, dir).expect("finite");
            let (hit, cost) = intersector.closest_hit_with_cost(&ray);
            let opened = intersector.opened_boxes(&ray);
            let boxes: u32 = opened.iter().map(|opened| opened.box_count()).sum();
            let primitives: u32 = opened.iter().map(|opened| opened.primitive_count()).sum();
            assert_eq!((boxes, primitives), (cost.boxes, cost.primitives));
            for opened in &opened {
                assert!(!opened.bounds.is_empty());
                if let BoxContents::Primitives(primitives) = &opened.contents {
                    for &primitive in primitives {
                        let bounds = scene.subset(&[primitive]).bounds();
                        assert_eq!(opened.bounds.union(bounds), opened.bounds);
                    }
                }
            }
            if let Some(hit) = hit {
                hits += 1;
                let holds = |contents: &BoxContents| match contents {
                    BoxContents::Boxes(_) => false,
                    BoxContents::Primitives(primitives) => primitives.contains(&hit.primitive),
                };
                assert!(opened.iter().any(|opened| holds(&opened.contents)));
            }
        }
    }
    assert!(hits > 100, "{hits}");
}
