//! Tests of the table, and the view that tests of rows share.

use super::*;
use glam::{DVec3, UVec2};
use hitscope_core::camera::{Camera, Projection, UpAxis};
use hitscope_core::scene::Scene;
use std::collections::HashSet;
use std::sync::Arc;

/// A view of a scene from ten radii away, or from ten units if it has no radius.
pub(crate) fn input(scene: &Arc<Scene>) -> OverlayInput {
    let bounds = scene.bounds_with_elements();
    let (centre, radius) = if bounds.is_empty() {
        (DVec3::ZERO, 1.0)
    } else {
        (bounds.centre().as_dvec3(), bounds.radius())
    };
    let eye = centre + 10.0 * radius * DVec3::new(0.3, 0.4, 0.86);
    let projection = Projection::Perspective { fov_y_radians: 0.5 };
    let camera = Camera::look_at(eye, centre, DVec3::Y, projection, UVec2::new(640, 480));
    let camera = camera.expect("a camera");
    OverlayInput {
        scene: Arc::clone(scene),
        camera,
        lines_camera: camera,
        up_axis: UpAxis::Y,
        pivot: centre,
        marks: Marks::default(),
        scale: 1.0,
    }
}

/// The state of an overlay at first.
pub(crate) fn state_of(overlay: &OverlaySpec) -> OverlayState {
    Overlays::default().state(overlay).clone()
}

#[test]
fn names_and_titles_are_unique_and_names_fit_the_command_line() {
    let mut seen = HashSet::new();
    for overlay in OVERLAYS {
        let is_name = |c: char| c.is_ascii_lowercase() || c == '-';
        assert!(overlay.name.chars().all(is_name), "{}", overlay.name);
        assert!(seen.insert(overlay.name), "{}", overlay.name);
        assert!(seen.insert(overlay.title), "{}", overlay.title);
        assert!(!overlay.about.is_empty(), "{}", overlay.name);
        for option in overlay.options {
            assert_eq!(option.usable(option.default), option.default);
        }
    }
}
