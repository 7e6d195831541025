//! Kernels that round t past the triangle's box, with an interval that starts between the box and that t.

use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::kernel::{TRIANGLE_KERNELS, exact_answer};
use hitscope_core::mesh::shapes::soup;
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::shape::Triangle;

/// Half an ulp of 1 in f32.
const U: f64 = 1.0 / (1 << 24) as f64;

/// A triangle about ten times as long as high in the plane z = 0, whose box is flat, and a ray to its
/// interior.
fn flat_sliver(random: &mut Random) -> ([Vec3; 3], Ray) {
    let mut flat = || Vec3::new(random.signed() as f32, random.signed() as f32, 0.0);
    let (a, long, across) = (flat(), flat(), flat());
    let corners = [a, a + long, a + 0.5 * long + 0.05 * across];
    let inside = (corners[0] + corners[1] + corners[2]) / 3.0;
    let origin = inside + random.in_cube_f32() + 1.5 * Vec3::Z;
    (corners, Ray::new(origin, inside - origin).expect("apart"))
}

#[test]
fn a_hit_rounded_past_its_box_is_found_if_the_interval_starts_in_between() {
    // Boxes are padded by 12u; from an error of 16u on, t certainly lies behind the box. Boxes up to 24 ulp
    // (48u) before the interval are visited.
    let mut random = Random::new(4);
    let mut found = 0;
    for _ in 0..3000 {
        let (corners, ray) = flat_sliver(&mut random);
        let Some([exact, ..]) = exact_answer(&ray, &Triangle(corners)) else {
            continue;
        };
        let scene = scene(soup(&[corners]));
        for kernel in TRIANGLE_KERNELS.iter() {
            let Some(hit) = kernel.intersect(&ray, corners) else {
                continue;
            };
            let error = (f64::from(hit.t) / exact - 1.0) / U;
            if !(16.0..44.0).contains(&error) {
                continue;
            }
            let t_min = hit.t.next_down();
            let ray = Ray::with_interval(ray.origin, ray.dir, t_min, ray.t_max).expect("a ray");
            if kernel.intersect(&ray, corners).is_none() {
                // The kernel excludes the hit because it compares a more accurate t.
                continue;
            }
            let intersector = scene.intersector(kernel);
            let name = kernel.info.name;
            assert_eq!(intersector.closest_hit(&ray), Some(hit), "{name} {error}");
            assert!(intersector.any_hit(&ray), "{name} {error}");
            found += 1;
        }
    }
    assert!(found > 50, "{found}");
}
