//! The pointer on the picture of the real app.

use crate::harness::{Window, app, app_scaled, bare, click, in_picture, pointer, press, wait};
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton};
use egui_kittest::kittest::Queryable as _;
use glam::Vec2;

/// Drags from the picture's middle by (60, 30) points.
fn drag(window: &mut Window, button: PointerButton, modifiers: Modifiers) {
    let from = in_picture(window, 0.5, 0.5);
    window.event(Event::PointerMoved(from));
    pointer(window, from, button, true, modifiers);
    window.step();
    for part in [0.3, 0.6, 1.0] {
        window.event_modifiers(
            Event::PointerMoved(from + part * egui::vec2(60.0, 30.0)),
            modifiers,
        );
        window.step();
    }
    pointer(
        window,
        from + egui::vec2(60.0, 30.0),
        button,
        false,
        modifiers,
    );
    window.run_steps(2);
}

#[test]
fn drags_orbit_and_pan_and_the_wheel_zooms() {
    let Some(mut window) = bare() else { return };
    let start = *window.state().turntable();
    drag(&mut window, PointerButton::Primary, Modifiers::NONE);
    let orbited = *window.state().turntable();
    assert_ne!(orbited.yaw_radians, start.yaw_radians);
    assert!(
        orbited.pitch_radians > start.pitch_radians,
        "dragging down looks from higher up"
    );
    assert_eq!(orbited.pivot, start.pivot);
    for (button, modifiers) in [
        (PointerButton::Primary, Modifiers::SHIFT),
        (PointerButton::Middle, Modifiers::NONE),
        (PointerButton::Secondary, Modifiers::NONE),
    ] {
        let before = *window.state().turntable();
        drag(&mut window, button, modifiers);
        let after = window.state().turntable();
        assert_ne!(after.pivot, before.pivot, "{button:?}");
        assert_eq!(after.yaw_radians, before.yaw_radians, "{button:?}");
    }
    let before = *window.state().turntable();
    let at = in_picture(&window, 0.3, 0.6);
    window.event(Event::PointerMoved(at));
    window.event(Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        source: egui::MouseWheelSource::Unknown,
        delta: egui::vec2(0.0, 2.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    window.run_steps(30);
    assert!(window.state().turntable().distance < before.distance);
    press(&mut window, Key::Home);
    assert_eq!(window.state().turntable().pivot, start.pivot);
}

/// A place of the picture where the mesh is.
fn on_the_mesh(window: &Window) -> (f32, f32) {
    let app = window.state();
    let size = app.film().size();
    let camera = app.turntable().camera(size);
    let is_hit = |&(x, y): &(f32, f32)| {
        let ray = camera.ray_through(size.as_dvec2() * Vec2::new(x, y).as_dvec2());
        app.document().intersector().any_hit(&ray)
    };
    let places = (1..20).flat_map(|i| (1..20).map(move |k| (i as f32 / 20.0, k as f32 / 20.0)));
    // One well inside, so that a pixel more or less doesn't matter.
    let hits: Vec<(f32, f32)> = places.filter(is_hit).collect();
    hits[hits.len() / 2]
}

#[test]
fn a_click_inspects_at_any_scale_and_a_double_click_sets_the_pivot() {
    for scale in [1.0, 1.5, 2.0] {
        let Some(mut window) = app_scaled(None, scale) else {
            return;
        };
        let (x, y) = on_the_mesh(&window);
        let place = in_picture(&window, x, y);
        click(&mut window, place);
        wait(&mut window, "the pick", |app| app.inspection().is_some());
        window.run_steps(2);
        let film = window.state().film().size();
        let found = window.state().inspection().expect("a pick").clone();
        let expected = (film.as_vec2() * Vec2::new(x, y)).as_uvec2();
        let pixel = glam::UVec2::from_array(found.pixel);
        let off = pixel.max(expected) - pixel.min(expected);
        assert!(
            off.max_element() <= 1,
            "pixel {:?} of {film} at {scale}",
            found.pixel
        );
        let hit = found.hit.expect("a ray was tried there");
        // What the panel says is what the kernels say, and exact arithmetic agrees.
        let exact = found.exact.expect("it is hit");
        assert_eq!(hit.triangle, exact.triangle);
        assert!((f64::from(hit.t) - exact.t).abs() < 1e-5 * exact.t);
        window.get_by_label("Copy as JSON");
        window.get_by_label("Kernels against exact arithmetic");

        let camera = window.state().turntable().camera(film);
        click(&mut window, place);
        click(&mut window, place);
        let pivot = window.state().turntable().pivot;
        let clicked = camera.pixel_of(pivot).expect("in front");
        let off = clicked - pixel.as_dvec2() - 0.5;
        assert!(off.length() < 1.0, "{clicked} at {scale}");
    }
}

#[test]
fn a_miss_is_inspected_too_and_escape_clears_it() {
    let Some(mut window) = app(None) else { return };
    let corner = in_picture(&window, 0.01, 0.01);
    click(&mut window, corner);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    let found = window.state().inspection().expect("a pick");
    assert!(found.hit.is_none() && found.exact.is_none());
    press(&mut window, Key::Escape);
    assert!(window.state().inspection().is_none());
}
