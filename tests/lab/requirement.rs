//! Test of the distance above which a scene requires more than `fast`.

use glam::{UVec2, Vec3};
use hitscope_core::Scene;
use hitscope_core::camera::Turntable;
use hitscope_core::mesh::Health;
use hitscope_core::mesh::shapes::soup;
use hitscope_core::scene::scene;
use hitscope_lab::requirement::required_tier;

/// A scene of two triangles of a given size, 1 apart, and the distance of its starting view, in lengths of their
/// longest edge.
fn dust(size: f32) -> (Scene, f64) {
    let dust = |p: Vec3| [p, p + size * Vec3::X, p + size * Vec3::Y];
    let scene = scene(soup(&[dust(Vec3::ZERO), dust(Vec3::X)]));
    let view = Turntable::framing(scene.bounds(), UVec2::new(1280, 720));
    (scene, view.distance / f64::from(size) / 2f64.sqrt())
}

#[test]
fn a_starting_view_at_ten_thousand_triangle_sizes_is_a_reason() {
    let mut size = 1e-4f32;
    for (times, expected) in [(9_500.0, false), (10_500.0, true)] {
        // The distance hardly depends on the size, so one step is enough.
        size *= (dust(size).1 / times) as f32;
        let (scene, found) = dust(size);
        assert!((found / times - 1.0).abs() < 0.01, "{found}");
        let reasons = required_tier(&scene, &Health::of(scene.mesh())).reasons;
        let is_reason = reasons.iter().any(|r| r.contains("starting view"));
        assert_eq!(is_reason, expected, "{found} {reasons:?}");
    }
}
