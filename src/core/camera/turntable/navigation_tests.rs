//! Tests of zooming past surfaces, free rotation, flying and transitions.

use super::tests::{SIZE, pixel_of, scenes, tolerance};
use super::*;
use crate::random::Random;

#[test]
fn zooming_in_moves_on_past_a_surface_and_through_empty_space() {
    // Not the scene far from the origin, whose coordinates f32 doesn't resolve.
    for scene in &scenes()[..3] {
        let mut turntable = Turntable::framing(*scene, SIZE);
        let radius = turntable.radius;
        let centre = turntable.centre;
        let eye = |turntable: &Turntable| turntable.camera(SIZE).exact_eye();
        let axis = (turntable.pivot - eye(&turntable)).normalize();
        let along = |turntable: &Turntable| (eye(turntable) - centre).dot(axis) / radius;
        // A surface through the centre that faces the camera, then nothing.
        for _ in 0..400 {
            let before = along(&turntable);
            let anchor = if before < 0.0 {
                centre
            } else {
                turntable.pivot
            };
            turntable.zoom(0.8, anchor);
            assert!(along(&turntable) > before);
        }
        assert!(along(&turntable) > 1.0, "{}", along(&turntable));
    }
}

#[test]
fn no_input_leads_out_of_reach_of_home() {
    /// A number of either sign and any size, which sometimes isn't finite.
    fn any(random: &mut Random) -> f64 {
        match random.index(20) {
            0 => f64::NAN,
            1 => f64::INFINITY,
            _ => random.signed() * 10f64.powf(12.0 * random.unit() - 4.0),
        }
    }
    let mut random = Random::new(7);
    for scene in scenes() {
        let mut turntable = Turntable::framing(scene, SIZE);
        for step in 0..20_000 {
            let mut any = || any(&mut random);
            let drag = DVec2::new(any(), any());
            let point = DVec3::new(any(), any(), any()) * turntable.radius + turntable.centre;
            let factor = any().exp();
            match random.index(9) {
                0 => turntable.orbit(drag, SIZE),
                1 => turntable.orbit_freely(drag, SIZE),
                2 => turntable.pan(drag, SIZE),
                3 | 4 => turntable.zoom(factor, point),
                5 => turntable.centre_on(point),
                6 => turntable.turn_about(point, |turntable| turntable.orbit(drag, SIZE)),
                7 => turntable.fly(point),
                _ => turntable.is_orthographic ^= true,
            }
            let camera = turntable.camera(SIZE);
            let again = Camera::look_at(
                camera.exact_eye(),
                camera.exact_eye() - turntable.radius * camera.back(),
                camera.up(),
                camera.projection(),
                SIZE,
            );
            assert!(again.is_ok(), "{scene:?}, step {step}: {turntable:?}");
            let ray = camera.ray_through(DVec2::ZERO);
            assert!(
                ray.origin.is_finite() && ray.dir.is_finite(),
                "{turntable:?}"
            );
            let mut home = turntable;
            home.frame(scene, SIZE);
            let inside = |p: DVec3| {
                let pixel = home.camera(SIZE).pixel_of(p);
                pixel.is_some_and(|p| p.cmpge(DVec2::ZERO).all() && p.cmple(SIZE.as_dvec2()).all())
            };
            assert!(corners(scene).into_iter().all(inside), "{home:?}");
        }
    }
}

#[test]
fn rotating_about_a_point_keeps_its_place_in_the_picture() {
    for scene in scenes() {
        for point in corners(scene) {
            let mut turntable = Turntable::framing(scene, SIZE);
            let before = pixel_of(&turntable, point);
            turntable.turn_about(point, |turntable| {
                turntable.orbit(DVec2::new(70.0, -40.0), SIZE);
                turntable.orbit_freely(DVec2::new(-20.0, 90.0), SIZE);
            });
            let off = (pixel_of(&turntable, point) - before).length();
            assert!(off < 2.0 * tolerance(&turntable), "{scene:?}: {off}");
        }
    }
}

#[test]
fn free_rotation_follows_the_drag_over_the_pole_and_may_tilt_the_horizon() {
    for up_axis in [UpAxis::Y, UpAxis::Z] {
        let mut turntable = Turntable::framing(scenes()[1], SIZE);
        turntable.up_axis = up_axis;
        for _ in 0..1000 {
            let before = turntable.camera(SIZE);
            let drag = DVec2::new(0.7, 1.3);
            turntable.orbit_freely(drag, SIZE);
            let after = turntable.camera(SIZE);
            let moved = (after.back() - before.back()).normalize();
            // Against the drag to the right, and up for a drag down.
            let expected = (before.up() * drag.y - before.right() * drag.x).normalize();
            assert!(moved.dot(expected) > 0.999, "{moved} {expected}");
            assert!((after.right().cross(before.right())).length() < 0.02);
        }
        assert!(turntable.roll_radians.abs() > 0.01);
    }
}

#[test]
fn looking_around_keeps_the_eye_and_flying_keeps_the_direction() {
    for scene in &scenes()[..3] {
        let mut turntable = Turntable::framing(*scene, SIZE);
        let before = turntable.camera(SIZE);
        turntable.look_around(DVec2::new(50.0, 20.0), SIZE);
        let turned = turntable.camera(SIZE);
        let tolerance = 1e-12 * turntable.radius;
        assert!((turned.exact_eye() - before.exact_eye()).length() < 10.0 * tolerance);
        assert_ne!(turned.back(), before.back());
        let by = DVec3::new(0.1, 0.2, -0.3) * turntable.radius;
        turntable.fly(by);
        let flown = turntable.camera(SIZE);
        assert_eq!(flown.back(), turned.back());
        let moved = flown.exact_eye() - turned.exact_eye();
        let axes = [turned.right(), turned.up(), turned.back()];
        let expected: DVec3 = axes[0] * by.x + axes[1] * by.y + axes[2] * by.z;
        assert!((moved - expected).length() < 10.0 * tolerance);
    }
}

#[test]
fn a_transition_starts_and_ends_at_its_ends_and_takes_the_shorter_way() {
    let from = Turntable::framing(scenes()[1], SIZE);
    let mut to = from;
    to.yaw_radians = TAU - 0.1;
    to.distance *= 4.0;
    to.pivot += DVec3::ONE;
    assert_eq!(from.towards(&to, 1.0), to);
    let start = from.towards(&to, 0.0);
    assert!((start.yaw_radians - from.yaw_radians).abs() < 1e-12);
    assert_eq!(start.pivot, from.pivot);
    let middle = from.towards(&to, 0.5);
    let expected = 0.5 * (from.yaw_radians - 0.1);
    assert!((middle.yaw_radians - expected).abs() < 1e-12);
    assert!((middle.distance / from.distance - 2.0).abs() < 1e-12);
    // The same view about another axis.
    let (y_up, z_up) = (from, from.about_axis(UpAxis::Z));
    let [a, b] = [y_up, z_up].map(|turntable| turntable.camera(SIZE));
    assert!((a.right() - b.right()).length() < 1e-12 && (a.back() - b.back()).length() < 1e-12);
}

#[test]
fn the_end_of_an_axis_is_seen_from_its_side() {
    for up_axis in [UpAxis::Y, UpAxis::Z] {
        for axis in 0..3 {
            for sign in [1.0, -1.0] {
                let mut turntable = Turntable::framing(scenes()[1], SIZE);
                turntable.up_axis = up_axis;
                turntable.look_from(StandardView::from_end(axis, sign > 0.0, up_axis));
                let back = turntable.camera(SIZE).back();
                assert!(
                    (sign * back[axis] - 1.0).abs() < 1e-12,
                    "{up_axis:?} {axis} {sign}"
                );
            }
        }
    }
}
