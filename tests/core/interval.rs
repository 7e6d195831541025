//! For every kernel and tree, a hit counts if its t is a finite f32 inside the ray's interval, at either end.

use glam::Vec3;
use hitscope_core::kernel::{TRIANGLE_KERNELS, TriangleKernel, triangle_kernel};
use hitscope_core::mesh::TriangleMesh;
use hitscope_core::mesh::shapes::soup;
use hitscope_core::scene::scene;
use hitscope_core::{Hit, Ray};

/// Each kernel's hit, after checking that the kernel alone and every query through a tree agree.
fn hits(mesh: &TriangleMesh, ray: &Ray) -> Vec<Option<Hit>> {
    let scene = scene(mesh.clone());
    let answer = |kernel: &'static TriangleKernel| {
        let intersector = scene.intersector(kernel);
        let hit = intersector.closest_hit(ray);
        let name = kernel.info.name;
        assert_eq!(kernel.intersect(ray, mesh.corners(0)), hit, "{name}");
        assert_eq!(intersector.closest_hit_with_cost(ray).0, hit, "{name}");
        assert_eq!(intersector.any_hit(ray), hit.is_some(), "{name}");
        assert_eq!(
            intersector.all_hits(ray).is_empty(),
            hit.is_none(),
            "{name}"
        );
        hit
    };
    TRIANGLE_KERNELS.iter().map(answer).collect()
}

#[test]
fn a_hit_beyond_the_largest_f32_is_a_miss_in_either_direction() {
    let corners = [[-1.0, -1.0], [2.0, -1.0], [-1.0, 2.0]];
    for z in [1e36, -1e36] {
        let mesh = soup(&[corners.map(|[x, y]| Vec3::new(1e36 * x, 1e36 * y, z))]);
        let ray = |dir_z: f32| {
            let dir = Vec3::new(0.0, 0.0, dir_z);
            let ray = Ray::with_interval(Vec3::ZERO, dir, f32::NEG_INFINITY, f32::INFINITY);
            ray.expect("a ray")
        };
        // At |t| = 10⁴⁰ and at 10³⁸.
        assert!(hits(&mesh, &ray(-1e-4)).iter().all(Option::is_none));
        for (kernel, hit) in TRIANGLE_KERNELS.iter().zip(hits(&mesh, &ray(-1e-2))) {
            // Other kernels multiply lengths of 10³⁶ in f32, or square them in f64.
            if kernel.info.promises.is_watertight {
                let t = hit.expect("a hit").t;
                assert!(
                    (t / -z / 100.0 - 1.0).abs() < 1e-5,
                    "{} {t}",
                    kernel.info.name
                );
            }
        }
    }
}

#[test]
fn whether_t_exceeds_the_largest_f32_depends_on_the_direction_as_given() {
    let at = |z: f32| {
        soup(&[[
            Vec3::new(-1.0, -1.0, z),
            Vec3::new(2.0, -1.0, z),
            Vec3::new(-1.0, 2.0, z),
        ]])
    };
    // t is 10⁴²·z.
    for (z, is_hit) in [
        (-1.0, false),
        (-1e-3, false),
        (-1e-5, true),
        (1.0, false),
        (1e-5, true),
    ] {
        let dir = Vec3::new(0.0, 0.0, -1e-42);
        let ray = Ray::with_interval(Vec3::ZERO, dir, f32::NEG_INFINITY, f32::INFINITY);
        for hit in hits(&at(z), &ray.expect("a ray")) {
            assert_eq!(hit.is_some(), is_hit, "{z}");
        }
    }
}

#[test]
fn a_hit_stays_inside_the_interval_even_if_t_rounds_to_an_end() {
    // t is exactly 1 − 2⁻²⁵, which f32 rounds to 1.
    let z = 1.0 - 1.0 / f64::from(1 << 25);
    let kernel = triangle_kernel("watertight").expect("in the table");
    let half = (z / 2.0) as f32;
    let corners = [[-1.0, -1.0], [2.0, -1.0], [-1.0, 2.0]].map(|[x, y]| Vec3::new(x, y, half));
    let origin = Vec3::new(0.0, 0.0, (f64::from(half) - z) as f32);
    let hit = |t_min, t_max| {
        let ray = Ray::with_interval(origin, Vec3::Z, t_min, t_max).expect("a ray");
        kernel.intersect(&ray, corners).map(|hit| hit.t)
    };
    assert_eq!(hit(0.0, 1.0), Some(1.0f32.next_down()));
    assert_eq!(hit(1.0, 2.0), None);
}
