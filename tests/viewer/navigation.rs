//! Tests of navigation: animated views, flying, presets, the trackpad and the gizmo.

use crate::commands::open_menu;
use crate::harness::{Window, app, bare, in_picture, pointer, press};
use crate::pointer::{on_the_knot, on_the_mesh};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton};
use egui_kittest::kittest::Queryable as _;
use glam::DVec2;
use hitscope_core::camera::{StandardView, Turntable};

/// Chooses an entry of the menu *Camera*.
fn choose(window: &mut Window, title: &str) {
    open_menu(window, "Camera");
    let entry = window.get_by_role_and_label(Role::MenuItemCheckBox, title);
    entry.click();
    window.run_steps(4);
}

/// Chooses a set of pointer bindings by the palette.
fn choose_mouse(window: &mut Window, query: &str) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::P);
    window.run_steps(4);
    window.get_by_label("Find a command").type_text(query);
    window.run_steps(3);
    press(window, Key::Enter);
}

fn turntable(window: &Window) -> Turntable {
    *window.state().turntable()
}

/// Drags by (60, 30) points.
fn drag(window: &mut Window, from: egui::Pos2, button: PointerButton, modifiers: Modifiers) {
    window.event(Event::PointerMoved(from));
    pointer(window, from, button, true, modifiers);
    window.step();
    for part in [0.3, 0.6, 1.0] {
        let to = from + part * egui::vec2(60.0, 30.0);
        window.event_modifiers(Event::PointerMoved(to), modifiers);
        window.step();
    }
    let to = from + egui::vec2(60.0, 30.0);
    pointer(window, to, button, false, modifiers);
    window.run_steps(2);
}

#[test]
fn digits_orbit_by_15_degrees_and_look_from_a_corner() {
    let Some(mut window) = bare() else { return };
    press(&mut window, Key::Num1);
    let degrees = |window: &Window| {
        let turntable = turntable(window);
        [turntable.yaw_radians, turntable.pitch_radians].map(|x| x.to_degrees().round())
    };
    for (key, expected) in [
        (Key::Num6, [15.0, 0.0]),
        (Key::Num8, [15.0, 15.0]),
        (Key::Num4, [0.0, 15.0]),
        (Key::Num2, [0.0, 0.0]),
        (Key::Num9, [45.0, 35.0]),
    ] {
        press(&mut window, key);
        assert_eq!(degrees(&window), expected, "{key:?}");
    }
    for _ in 0..9 {
        press(&mut window, Key::Num8);
    }
    assert_eq!(degrees(&window), [45.0, 90.0]);
}

#[test]
fn a_view_is_reached_in_a_quarter_of_a_second_and_input_ends_the_way() {
    let Some(mut window) = bare() else { return };
    choose(&mut window, "Reduced motion");
    assert!(!window.state().preferences().navigation.reduces_motion);
    let start = turntable(&window);
    let mut top = start;
    top.look_from(StandardView::Top);
    window.key_press(Key::Num7);
    window.run_steps(8);
    let middle = turntable(&window);
    assert!(middle.pitch_radians > start.pitch_radians);
    assert!(middle.pitch_radians < top.pitch_radians);
    // A step takes 1/60 s.
    window.run_steps(20);
    assert_eq!(turntable(&window), top);

    window.key_press(Key::Num1);
    window.run_steps(5);
    let middle = in_picture(&window, 0.5, 0.5);
    drag(&mut window, middle, PointerButton::Primary, Modifiers::NONE);
    let dragged = turntable(&window);
    assert_ne!(dragged.pitch_radians, 0.0);
    window.run_steps(20);
    assert_eq!(turntable(&window), dragged);
}

#[test]
fn the_ends_of_the_gizmo_look_along_the_axes_and_can_be_hidden() {
    let Some(mut window) = bare() else { return };
    assert!(window.query_by_label("Look from X").is_none());
    choose(&mut window, "Axis gizmo");
    for (label, view) in [
        ("Look from X", StandardView::Right),
        ("Look from −Z", StandardView::Back),
        ("Look from Y", StandardView::Top),
    ] {
        let mut expected = turntable(&window);
        expected.look_from(view);
        window.get_by_role_and_label(Role::Button, label).click();
        window.run_steps(3);
        assert_eq!(turntable(&window), expected, "{label}");
        // Away from the view, so that no end is behind another one.
        let middle = in_picture(&window, 0.5, 0.5);
        drag(&mut window, middle, PointerButton::Primary, Modifiers::NONE);
    }
    choose(&mut window, "Axis gizmo");
    assert!(window.query_by_label("Look from X").is_none());
}

#[test]
fn the_right_button_with_keys_flies_and_the_keys_are_commands_again_afterwards() {
    let Some(mut window) = bare() else { return };
    let size = window.state().film().size();
    let before = turntable(&window).camera(size);
    let at = in_picture(&window, 0.5, 0.5);
    window.event(Event::PointerMoved(at));
    window.step();
    pointer(&window, at, PointerButton::Secondary, true, Modifiers::NONE);
    window.run_steps(2);
    window.key_down(Key::W);
    window.run_steps(10);
    window.key_up(Key::W);
    window.run_steps(2);
    let flown = turntable(&window).camera(size);
    let moved = flown.exact_eye() - before.exact_eye();
    assert!(moved.dot(-before.back()) > 0.9 * moved.length() && moved.length() > 0.0);
    pointer(
        &window,
        at,
        PointerButton::Secondary,
        false,
        Modifiers::NONE,
    );
    window.run_steps(2);
    let wireframe = |window: &Window| {
        let overlays = &window.state().settings().overlays;
        overlays.is_on(&hitscope::overlay::wireframe::WIREFRAME)
    };
    assert!(!wireframe(&window));
    press(&mut window, Key::W);
    assert!(wireframe(&window));
}

#[test]
fn presets_change_what_drags_do_and_what_the_help_says() {
    let Some(mut window) = bare() else { return };
    choose_mouse(&mut window, "as in blender");
    let at = in_picture(&window, 0.5, 0.5);
    let start = turntable(&window);
    drag(&mut window, at, PointerButton::Middle, Modifiers::NONE);
    let orbited = turntable(&window);
    assert_eq!(orbited.pivot, start.pivot);
    assert_ne!(orbited.yaw_radians, start.yaw_radians);
    let ctrl = Modifiers::CTRL | Modifiers::COMMAND;
    drag(&mut window, at, PointerButton::Middle, ctrl);
    let zoomed = turntable(&window);
    assert!(zoomed.distance > orbited.distance);
    assert_eq!(zoomed.yaw_radians, orbited.yaw_radians);
    press(&mut window, Key::H);
    window.get_by_label("Middle drag, drag");
}

#[test]
fn two_fingers_orbit_on_a_trackpad_and_pan_with_shift() {
    let Some(mut window) = bare() else { return };
    choose(&mut window, "Trackpad");
    let at = in_picture(&window, 0.5, 0.5);
    window.event(Event::PointerMoved(at));
    window.step();
    let scroll = |window: &mut Window, modifiers| {
        let event = Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            source: egui::MouseWheelSource::Unknown,
            delta: egui::vec2(30.0, 12.0),
            phase: egui::TouchPhase::Move,
            modifiers,
        };
        window.event_modifiers(event, modifiers);
        window.run_steps(10);
    };
    let start = turntable(&window);
    scroll(&mut window, Modifiers::NONE);
    let orbited = turntable(&window);
    assert_ne!(orbited.yaw_radians, start.yaw_radians);
    assert_eq!(
        (orbited.pivot, orbited.distance),
        (start.pivot, start.distance)
    );
    scroll(&mut window, Modifiers::SHIFT);
    let panned = turntable(&window);
    assert_ne!(panned.pivot, orbited.pivot);
    assert_eq!(panned.yaw_radians, orbited.yaw_radians);
}

#[test]
fn orbiting_about_the_cursor_keeps_the_surface_under_it() {
    let Some(mut window) = bare() else { return };
    choose(&mut window, "Orbit about the cursor");
    let (x, y) = on_the_mesh(&window);
    let size = window.state().film().size();
    let camera = turntable(&window).camera(size);
    let pixel = size.as_dvec2() * DVec2::new(x.into(), y.into());
    let document = window.state().document();
    let ray = camera.ray_through(pixel);
    let hit = document.intersector().closest_hit(&ray).expect("the mesh");
    let point = ray.origin.as_dvec3() + f64::from(hit.t) * ray.dir.as_dvec3();
    let at = in_picture(&window, x, y);
    drag(&mut window, at, PointerButton::Primary, Modifiers::NONE);
    let after = turntable(&window).camera(size);
    assert_ne!(after.back(), camera.back());
    let moved = (after.pixel_of(point).expect("in front") - pixel).length();
    // The harness rounds the place to 1/32 of a point; the surface there may be steep.
    assert!(moved < 2.0, "{moved}");
}

#[test]
fn a_trackball_tilts_the_horizon_and_the_turntable_levels_it() {
    let Some(mut window) = bare() else { return };
    choose(&mut window, "Trackball");
    let at = in_picture(&window, 0.5, 0.5);
    for _ in 0..3 {
        drag(&mut window, at, PointerButton::Primary, Modifiers::NONE);
    }
    assert_ne!(turntable(&window).roll_radians, 0.0);
    choose(&mut window, "Trackball");
    assert_eq!(turntable(&window).roll_radians, 0.0);
}

#[test]
fn the_wheel_passes_through_the_mesh_and_home_comes_back() {
    let Some(mut window) = bare() else { return };
    let start = turntable(&window);
    let (x, y) = on_the_mesh(&window);
    window.event(Event::PointerMoved(in_picture(&window, x, y)));
    window.step();
    let size = window.state().film().size();
    let eye = |window: &Window| turntable(window).camera(size).exact_eye();
    let centre = start.pivot;
    let before = (eye(&window) - centre).length();
    let forward = -start.camera(size).back();
    for _ in 0..600 {
        window.event(Event::Zoom(1.5));
        window.step();
    }
    let passed = (eye(&window) - centre).dot(forward);
    assert!(passed > 0.0, "{passed} of {before}");
    press(&mut window, Key::Home);
    assert_eq!(turntable(&window).pivot, start.pivot);
}

#[test]
fn the_group_of_the_pick_can_be_framed() {
    let Some(mut window) = app(None) else { return };
    // Not on the floor, whose triangles are almost as large as the group.
    let (x, y) = on_the_knot(&window);
    let at = in_picture(&window, x, y);
    crate::harness::click(&mut window, at);
    crate::harness::wait(&mut window, "the pick", |app| app.inspection().is_some());
    press(&mut window, Key::Period);
    let triangle = turntable(&window).distance;
    window.key_press_modifiers(Modifiers::SHIFT, Key::Period);
    crate::harness::wait(&mut window, "the group", |app| {
        app.turntable().distance > triangle
    });
}
