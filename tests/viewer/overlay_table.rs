//! Tests of every row of the overlay table: in the window, without one, in the panel, and seen from anywhere.

use crate::harness::{Window, app, press, wait};
use crate::overlay::{drawn, input, layer, marked_scene, none, only};
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::Queryable as _;
use glam::{DVec3, UVec2, Vec3};
use hitscope::app::App;
use hitscope::measuring::Measurements;
use hitscope::offscreen;
use hitscope::overlay::axes::AXES;
use hitscope::overlay::bounding_box::BOUNDING_BOX;
use hitscope::overlay::grid::GRID;
use hitscope::overlay::wireframe::WIREFRAME;
use hitscope::overlay::{
    Contents, Marks, OVERLAYS, OverlaySpec, Overlays, Place, labels, overlay, switches,
};
use hitscope_core::camera::{Camera, Projection, Turntable, UpAxis};
use hitscope_core::integrator::{PathEnd, PathRecord};
use hitscope_core::mesh::{Flaw, Health};
use hitscope_core::scene::{Scene, scene};
use hitscope_core::{Aabb, TriangleMesh};
use std::sync::Arc;

/// Everything that can be marked in the scene.
fn marks(scene: &Scene) -> Marks {
    let path = PathRecord {
        origin: Vec3::new(0.5, 0.5, 2.0),
        vertices: Vec::new(),
        last_dir: Vec3::NEG_X,
        from_afar: Vec3::ZERO,
        end: PathEnd::Left,
        radiance: Vec3::ZERO,
    };
    Marks {
        flaw: Some((Flaw::OpenEdge, Arc::new(Health::of(scene.mesh())))),
        picked: Some(0),
        path: Some(Arc::new(path)),
        picks: Vec::new(),
        measurements: Measurements {
            lines: vec![[DVec3::NEG_ONE, DVec3::ONE]],
            ..Measurements::default()
        },
        opened: Some(scene.bounds()),
    }
}

/// The selection that a row marks; nothing for a row with a switch.
fn marks_of(overlay: &OverlaySpec, scene: &Scene) -> Marks {
    let all = marks(scene);
    Marks {
        flaw: all.flaw.filter(|_| overlay.name == "flaws"),
        picked: all.picked.filter(|_| overlay.name == "picked"),
        path: all.path.filter(|_| overlay.name == "path"),
        picks: Vec::new(),
        measurements: if overlay.name == "measure" {
            all.measurements
        } else {
            Measurements::default()
        },
        opened: all.opened.filter(|_| overlay.name == "walk"),
    }
}

#[test]
fn each_overlay_has_the_same_pixels_in_the_window_and_without_one() {
    let Some((mut layer, gpu)) = layer() else {
        return;
    };
    let scene = marked_scene();
    let size = UVec2::new(200, 200);
    let eye = DVec3::new(2.0, 2.5, 5.0);
    for projection in [
        Projection::Perspective { fov_y_radians: 0.7 },
        Projection::Orthographic { height: 4.0 },
    ] {
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, size);
        let mut input = input(&scene, camera.expect("a camera"));
        for overlay in OVERLAYS {
            input.marks = marks_of(overlay, &scene);
            let overlays = only(overlay, |_| ());
            let in_window = drawn(&mut layer, gpu, &input, &overlays);
            let without = offscreen::drawn(gpu, &input, &overlays).expect("drawn");
            let name = overlay.name;
            assert!(in_window.iter().any(|pixel| pixel[3] > 0), "{name}");
            assert!(in_window == without, "{name}");
        }
    }
}

/// A triangle of this size at this place of its file.
fn scene_of(size: f32, origin: DVec3) -> Arc<Scene> {
    let corners = vec![Vec3::ZERO, size * Vec3::X, size * Vec3::Y];
    Arc::new(scene(
        TriangleMesh::new(corners, vec![[0, 1, 2]]).with_origin(origin),
    ))
}

/// Views of a scene from inside, from its surface, and from the farthest places that the window reaches and beyond.
fn views(scene: &Scene) -> Vec<(Camera, DVec3)> {
    let size = UVec2::new(320, 200);
    let bounds = scene.bounds_with_elements();
    let mut views = Vec::new();
    for factor in [1e-12, 1e-7, 1e-3, 1.0, 1e4, 1e12] {
        for is_orthographic in [false, true] {
            for pitch_radians in [-1.5, 0.0, 0.7, std::f64::consts::FRAC_PI_2] {
                let mut turntable = Turntable::framing(bounds, size);
                turntable.distance *= factor;
                turntable.pitch_radians = pitch_radians;
                turntable.is_orthographic = is_orthographic;
                views.push((turntable.camera(size), turntable.pivot));
            }
        }
    }
    // A camera at the pivot, and one that has passed it.
    let (camera, pivot) = views[0];
    views.push((camera, camera.eye().as_dvec3()));
    views.push((camera, pivot + 1e6 * bounds.radius() * camera.back()));
    views
}

fn assert_is_finite(input: &hitscope::overlay::OverlayInput, overlays: &Overlays, what: &str) {
    for wanted in Contents::of(input, overlays).lines {
        let name = wanted.overlay.name;
        let bounds = wanted.gather.bounds();
        let is_bounded =
            bounds == Aabb::EMPTY || (bounds.min.is_finite() && bounds.max.is_finite());
        assert!(is_bounded, "{name} {what}: {bounds:?}");
        for line in wanted.gather.lines(&input.scene) {
            assert!(line.is_finite(), "{name} {what}: {line:?}");
        }
    }
    for label in labels(input, overlays) {
        let is_finite = match label.place {
            Place::Point(point) => point.is_finite(),
            Place::Corner { bar_px } => bar_px.is_none_or(|px| (0.0..1e4).contains(&px)),
        };
        assert!(is_finite, "{what}: {label:?}");
        assert!(!label.text.contains("NaN") && !label.text.contains("inf"));
    }
}

#[test]
fn no_overlay_has_a_line_that_is_not_finite_wherever_the_camera_is() {
    let mut overlays = none();
    switches().for_each(|overlay| overlays.set_on(overlay, true));
    let far = DVec3::new(5e5, 5.6e6, -3e3);
    for scene in [
        scene_of(1.0, DVec3::ZERO),
        scene_of(1.0, far),
        scene_of(1e-30, DVec3::ZERO),
        scene_of(1e30, DVec3::ZERO),
        scene_of(1e37, DVec3::splat(1e300)),
        Arc::new(scene(TriangleMesh::default())),
    ] {
        let size = scene.bounds().radius();
        for (camera, pivot) in views(&scene) {
            let mut input = input(&scene, camera);
            input.pivot = pivot;
            if scene.primitive_count() > 0 {
                input.marks = marks(&scene);
            }
            for up_axis in [UpAxis::Y, UpAxis::Z] {
                input.up_axis = up_axis;
                let eye = camera.eye();
                assert_is_finite(&input, &overlays, &format!("size {size:e}, eye {eye}"));
            }
        }
    }
}

#[test]
fn the_ground_behind_the_scene_is_in_an_orthographic_picture_too() {
    let Some((_, gpu)) = layer() else { return };
    let scene = scene_of(1.0, DVec3::ZERO);
    let size = UVec2::new(160, 160);
    // From above, so that the upper edge shows ground far behind the scene.
    let (eye, height) = (DVec3::new(0.0, 30.0, 30.0), 20.0);
    let projection = Projection::Orthographic { height };
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, size).expect("a camera");
    let input = input(&scene, camera);
    let pixels = offscreen::drawn(gpu, &input, &only(&GRID, |_| ())).expect("drawn");
    let has_lines = |rows: &[[u8; 4]]| rows.iter().any(|pixel| pixel[3] > 0);
    for quarter in pixels.chunks(pixels.len() / 4) {
        assert!(has_lines(quarter));
    }
}

/// The check box of an overlay in the Display tab.
fn click_switch(window: &mut Window, overlay: &OverlaySpec) {
    let switch = window.get_by_role_and_label(Role::CheckBox, overlay.title);
    switch.click_accesskit();
    window.run_steps(2);
}

#[test]
fn the_panel_has_a_switch_and_named_controls_for_each_overlay() {
    let Some(mut window) = app(None) else { return };
    for overlay in switches() {
        let is_on = |window: &Window| window.state().settings().overlays.is_on(overlay);
        let before = is_on(&window);
        click_switch(&mut window, overlay);
        assert_ne!(is_on(&window), before, "{}", overlay.name);
        click_switch(&mut window, overlay);
        assert_eq!(is_on(&window), before, "{}", overlay.name);
        let colour = if overlay.has_colour() {
            "colour and opacity"
        } else {
            "opacity"
        };
        window.get_by_label(&format!("{}: {colour}", overlay.title));
        window.get_by_label(&format!("{}: width", overlay.title));
        for option in overlay.options {
            let name = match option.name {
                "diagonals" => option.title.to_owned(),
                _ => format!("{}: {}", overlay.title, option.title),
            };
            window.get_by_label(&name);
        }
    }
    assert!(overlay("picked").is_some_and(|picked| !picked.is_switch()));
    assert!(window.query_by_label("Picked primitive").is_none());
}

#[test]
fn all_overlays_are_drawn_together_in_the_window() {
    let Some(mut window) = app(None) else { return };
    let is_on = |app: &App, overlay| app.settings().overlays.is_on(overlay);
    for overlay in switches() {
        if !is_on(window.state(), overlay) {
            click_switch(&mut window, overlay);
        }
    }
    wait(&mut window, "all lines", App::is_settled);
    assert_eq!(window.state().notice(), None);
    assert!(switches().all(|overlay| is_on(window.state(), overlay)));
    // W turns off the wireframe alone.
    press(&mut window, Key::W);
    assert!(!is_on(window.state(), &WIREFRAME) && is_on(window.state(), &GRID));
}

#[test]
fn the_window_shows_the_texts_of_overlays_that_are_on() {
    let Some(mut window) = app(None) else { return };
    let grid = |window: &Window| window.query_by_label_contains("Grid: ").is_some();
    let bar = |window: &Window| window.query_by_label_contains(" at the pivot").is_some();
    assert!(!grid(&window) && !bar(&window));
    click_switch(&mut window, &GRID);
    wait(&mut window, "the grid", App::is_settled);
    assert!(grid(&window) && bar(&window));
    press(&mut window, Key::Num5);
    wait(&mut window, "the other projection", App::is_settled);
    assert!(grid(&window) && !bar(&window));
    click_switch(&mut window, &GRID);
    assert!(!grid(&window));
    click_switch(&mut window, &AXES);
    click_switch(&mut window, &BOUNDING_BOX);
    wait(&mut window, "axes and box", App::is_settled);
    let scene = &window.state().document().loaded.scene;
    let height = scene.bounds_with_elements().extent().y;
    let height = hitscope::numbers::significant(height, 4);
    assert!(window.get_all_by_label(&height).count() > 0);
}
