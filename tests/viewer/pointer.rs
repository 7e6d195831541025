//! Tests of the pointer on the real app's picture.

use crate::harness::{
    Window, app, app_scaled, bare, choose_kernel, click, in_picture, pointer, press, wait,
};
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton};
use egui_kittest::kittest::Queryable as _;
use glam::{Vec2, Vec3};
use hitscope::app::App;

/// Drags by (60, 30) points from the middle of the picture.
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

/// A place in the picture where the mesh is visible, as fractions of its size.
pub fn on_the_mesh(window: &Window) -> (f32, f32) {
    on(window, |_| true)
}

/// A place in the picture where smooth shading changes the normal.
pub fn on_the_knot(window: &Window) -> (f32, f32) {
    on(window, |material| material == "knot")
}

/// A place in the picture whose material satisfies a condition.
fn on(window: &Window, is_wanted: impl Fn(&str) -> bool) -> (f32, f32) {
    let app = window.state();
    let size = app.film().size();
    let camera = app.turntable().camera(size);
    let is_hit = |&(x, y): &(f32, f32)| {
        let ray = camera.ray_through(size.as_dvec2() * Vec2::new(x, y).as_dvec2());
        let document = app.document();
        let hit = document.intersector().closest_hit(&ray);
        let mesh = document.loaded.scene.mesh();
        let material = hit.and_then(|hit| mesh.attributes().materials.of(hit.primitive));
        material.is_some_and(|material| is_wanted(&material.name))
    };
    let places = (1..20).flat_map(|i| (1..20).map(move |k| (i as f32 / 20.0, k as f32 / 20.0)));
    // A place well inside, so that a pixel more or less doesn't matter.
    let hits: Vec<(f32, f32)> = places.filter(is_hit).collect();
    hits[hits.len() / 2]
}

#[test]
fn a_click_inspects_at_any_scale_and_a_double_click_sets_the_pivot() {
    for scale in [1.0, 1.5, 2.0] {
        let Some(mut window) = app_scaled(None, scale) else {
            return;
        };
        // A coarse picture shows the pixels of others.
        wait(&mut window, "a sample in each pixel", |app| {
            app.film().samples() > 0
        });
        window.step();
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
        // egui rounds the rectangle of a widget in the harness to 1/32 point, so a place near the edge of a pixel
        // may fall into its neighbour.
        assert!(
            off.max_element() <= 1,
            "pixel {:?} of {film} at {scale}",
            found.pixel
        );
        let hit = found.hit.expect("a place on the mesh");
        // The inspection agrees with the current kernel and with exact arithmetic.
        let exact = found.exact.expect("it is hit");
        assert_eq!(hit.primitive, exact.primitive);
        let row = found.kernels.iter().find(|row| row.name == found.kernel);
        let row = row.expect("a row of the current kernel");
        assert_eq!((row.t, row.triangle), (Some(hit.t), Some(hit.primitive)));
        // The promise of the default kernel.
        assert!(row.t_error_ulps.expect("the same triangle") <= 0.51);
        window.get_by_label("Copy as JSON");
        window.get_by_label("Kernels compared with exact arithmetic");

        let camera = window.state().turntable().camera(film);
        click(&mut window, place);
        click(&mut window, place);
        let pivot = window.state().turntable().pivot;
        let clicked = camera.pixel_of(pivot).expect("in front");
        let expected = pixel.as_dvec2() + 0.5;
        // The ray's rounding to f32 is some 1e-4 of a pixel.
        let tolerance = 1e-3;
        let off = (clicked - expected).abs().max_element();
        assert!(off < tolerance, "{clicked}, {expected} at {scale}");
    }
}

/// Waits until a click can no longer become a double click.
pub fn rest(window: &mut Window) {
    // A step takes 1/60 s; egui's double clicks take at most 0.3 s.
    window.run_steps(30);
}

#[test]
fn a_double_click_sets_the_pivot_without_picking_or_changing_the_tab_or_sizes() {
    let Some(mut window) = app(None) else { return };
    let tab = window.state().preferences().tab;
    let (x, y) = on_the_mesh(&window);
    let place = in_picture(&window, x, y);
    let before = *window.state().turntable();
    click(&mut window, place);
    click(&mut window, place);
    rest(&mut window);
    let app = window.state();
    assert!(app.inspection().is_none());
    assert_eq!(app.preferences().tab, tab);
    let after = *app.turntable();
    assert_ne!(after.pivot, before.pivot);
    let size = app.film().size();
    let cameras = [before, after].map(|turntable| turntable.camera(size));
    // Every corner of the scene keeps its size in pixels.
    let bounds = app.document().loaded.scene.bounds();
    for corner in [bounds.min, bounds.max] {
        let [old, new] =
            cameras.map(|camera| camera.pixel_size_at(camera.depth_of(corner.as_dvec3())));
        // The eye's coordinates are rounded to f32, by 2⁻²⁴ of a few times the depth.
        assert!((new / old - 1.0).abs() < 1e-6, "{corner}: {old}, {new}");
    }
}

#[test]
fn a_double_click_within_one_slow_frame_or_with_a_slow_second_click_sets_the_pivot() {
    for is_one_frame in [true, false] {
        let Some(mut window) = app(None) else { return };
        let (x, y) = on_the_mesh(&window);
        let place = in_picture(&window, x, y);
        let before = window.state().turntable().pivot;
        window.event(Event::PointerMoved(place));
        window.step();
        let click = [true, false].map(|pressed| Event::PointerButton {
            pos: place,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        let events = &mut window.input_mut().events;
        if is_one_frame {
            events.extend([click.clone(), click].concat());
        } else {
            let [press, release] = click;
            events.extend([press.clone(), release.clone(), press]);
            window.step();
            rest(&mut window);
            window.input_mut().events.push(release);
        }
        window.step();
        rest(&mut window);
        assert!(window.state().inspection().is_none(), "{is_one_frame}");
        assert_ne!(window.state().turntable().pivot, before, "{is_one_frame}");
    }
}

#[test]
fn a_pick_is_inspected_again_when_kernel_or_shading_change() {
    let Some(mut window) = app(None) else { return };
    let (x, y) = on_the_knot(&window);
    let place = in_picture(&window, x, y);
    click(&mut window, place);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    window.run_steps(2);
    window.get_by_label("Hit (exact)");
    let normal = |app: &App| {
        app.inspection()
            .and_then(|i| Some(i.hit.as_ref()?.shading_normal))
    };
    let flat = normal(window.state()).expect("a hit");
    press(&mut window, Key::S);
    wait(&mut window, "the smooth normal", |app| {
        normal(app).is_some_and(|n| n != flat)
    });
    window.get_by_label("Display").click();
    window.run_steps(2);
    choose_kernel(&mut window, "exact – Exact, adaptive");
    wait(&mut window, "the exact kernel's answer", |app| {
        app.inspection()
            .is_some_and(|inspection| inspection.kernel == "exact")
    });
    window.get_by_label("Inspect").click();
    window.run_steps(2);
    window.get_by_label("Hit (exact)");
}

#[test]
fn rows_of_a_pick_do_not_overlap_in_any_frame() {
    let Some(mut window) = app(None) else { return };
    let (x, y) = on_the_mesh(&window);
    let place = in_picture(&window, x, y);
    click(&mut window, place);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    for frame in 0..5 {
        let panel = in_picture(&window, 1.0, 0.0).x;
        let labels: Vec<(String, egui::Rect)> = window
            .query_all_by_role(egui::accesskit::Role::Label)
            .map(|label| (format!("{label:?}"), label.rect()))
            .filter(|(_, rect)| rect.min.x > panel && rect.area() > 0.0)
            .collect();
        assert!(labels.len() > 10, "{} rows", labels.len());
        for (i, (name, a)) in labels.iter().enumerate() {
            for (other, b) in &labels[i + 1..] {
                // Adjacent rectangles may overlap by a rounding error.
                let overlap = a.intersect(*b).size();
                let is_apart = overlap.x < 0.5 || overlap.y < 0.5;
                assert!(is_apart, "frame {frame}: {name} {a:?} and {other} {b:?}");
            }
        }
        window.step();
    }
}

#[test]
fn the_face_of_a_pick_is_read_from_the_file() {
    let Some(mut window) = app(None) else { return };
    let (x, y) = on_the_mesh(&window);
    let place = in_picture(&window, x, y);
    click(&mut window, place);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    for _ in 0..400 {
        window.step();
        if window.query_by_label_contains("A = v ").is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    window.get_by_label_contains("A = v ");
    window.get_by_label("line");
    let found = window.state().inspection().expect("a pick");
    let normal = found.hit.as_ref().expect("a hit").geometric_normal;
    let is_behind = Vec3::from_array(normal).dot(Vec3::from_array(found.ray.direction)) > 0.0;
    window.get_by_label(if is_behind { "back" } else { "front" });
}

#[test]
fn a_miss_can_be_inspected_and_escape_clears_it() {
    let Some(mut window) = app(None) else { return };
    let corner = in_picture(&window, 0.01, 0.01);
    click(&mut window, corner);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    let found = window.state().inspection().expect("a pick");
    assert!(found.hit.is_none() && found.exact.is_none());
    press(&mut window, Key::Escape);
    assert!(window.state().inspection().is_none());
}
