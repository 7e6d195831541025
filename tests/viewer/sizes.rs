//! Windows of all sizes and scales: resizing while rays are traced never panics, and every control can be reached.

use crate::comparing::settled;
use crate::harness::{
    Window, app, app_on, click, gpu, in_picture, press, run_command, shared_setup, wait,
};
use egui::{Rect, Vec2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::UVec2;
use hitscope::app::App;
use hitscope::tab::Tab;
use hitscope_core::random::Random;

const SCALES: [f32; 5] = [1.0, 1.25, 1.5, 2.0, 3.0];

/// The picture's size in physical pixels.
fn pixels(window: &Window) -> UVec2 {
    let size =
        window.get_by_label("Rendered picture").rect().size() * window.ctx.pixels_per_point();
    UVec2::new(size.x.round() as u32, size.y.round() as u32)
}

#[test]
fn many_sizes_and_scales_while_rays_are_traced_end_with_the_right_picture() {
    let Some(mut window) = app(None) else { return };
    press(&mut window, egui::Key::W);
    let mut random = Random::new(5);
    for k in 0..150 {
        let side = |random: &mut Random| match random.index(6) {
            0 => 1.0 + 3.0 * random.unit() as f32,
            _ => 1.0 + 1400.0 * random.unit() as f32,
        };
        window.set_size(vec2(side(&mut random), side(&mut random)));
        if k % 5 == 0 {
            window.set_pixels_per_point(SCALES[random.index(SCALES.len())]);
        }
        window.step();
        if k % 10 == 0 {
            window.render().expect("drawn");
        }
    }
    window.set_pixels_per_point(1.0);
    window.set_size(vec2(800.0, 600.0));
    window.run_steps(5);
    wait(&mut window, "the picture", App::is_settled);
    assert_eq!(window.state().graphics_errors(), 0);
    assert_eq!(window.state().notice(), None);
    assert_eq!(window.state().film().size(), pixels(&window));
}

#[test]
fn a_camera_that_frames_the_scene_frames_it_in_a_narrower_picture_and_another_one_stays() {
    let Some(mut window) = app(None) else { return };
    press(&mut window, egui::Key::Home);
    let wide = *window.state().turntable();
    let narrow = |window: &mut Window, width: f32| {
        window.set_size(vec2(width, 600.0));
        window.run_steps(5);
        *window.state().turntable()
    };
    let framed = narrow(&mut window, 500.0);
    assert!(framed.distance > 1.2 * wide.distance);
    let mut expected = framed;
    let app = window.state();
    let bounds = app.document().loaded.scene.bounds_with_elements();
    expected.frame(bounds, app.film().size());
    assert_eq!(framed, expected);
    assert_eq!(narrow(&mut window, 800.0), wide);
    press(&mut window, egui::Key::Num8);
    let moved = *window.state().turntable();
    assert_eq!(narrow(&mut window, 500.0), moved);
}

#[test]
fn a_minimised_window_keeps_running_and_shows_its_picture_afterwards() {
    let Some(mut window) = app(None) else { return };
    // As winit reports a minimised window on Windows.
    window.set_size(Vec2::ZERO);
    window.run_steps(20);
    window.set_size(vec2(800.0, 600.0));
    window.run_steps(3);
    wait(&mut window, "the picture", App::is_settled);
    assert_eq!(window.state().film().size(), pixels(&window));
    assert_eq!(window.state().graphics_errors(), 0);
}

#[test]
fn the_side_panel_has_its_width_again_after_narrow_windows() {
    let Some(mut window) = app(None) else { return };
    window.run_steps(20);
    let width = |window: &Window| window.get_by_label("Rendered picture").rect().width();
    let before = width(&window);
    for narrow in [500.0, 300.0, 100.0, 20.0, 450.0, 600.0] {
        window.set_size(vec2(narrow, 600.0));
        window.run_steps(3);
    }
    window.set_size(vec2(800.0, 600.0));
    window.run_steps(3);
    assert_eq!(width(&window), before);
    // A window of 1280 × 800 pixels at 200 %.
    window.set_size(vec2(640.0, 400.0));
    window.run_steps(3);
    assert!(width(&window) >= 0.45 * 640.0, "{}", width(&window));
}

#[test]
fn the_picture_has_a_ray_per_physical_pixel_at_each_scale() {
    let Some(mut window) = app(None) else { return };
    for scale in SCALES.into_iter().chain(SCALES) {
        window.set_pixels_per_point(scale);
        window.set_size(vec2(800.0, 600.0) / scale);
        window.run_steps(3);
        wait(&mut window, "samples", |app| app.film().samples() > 0);
        window.run_steps(2);
        assert_eq!(window.state().film().size(), pixels(&window), "{scale}");
        window.render().expect("drawn");
    }
    assert_eq!(window.state().graphics_errors(), 0);
}

/// Requires that each control of the window can be brought into sight.
fn all_reachable(window: &mut Window, moment: &str) {
    let screen = window.ctx.content_rect().expand(0.5);
    let controls = |window: &Window| -> Vec<(String, Rect)> {
        let nodes = window.root().children_recursive().filter_map(|node| {
            node.accesskit_node().raw_bounds()?;
            let rect = node.rect();
            let node = node.accesskit_node();
            let is_control = node.data().supports_action(egui::accesskit::Action::Focus);
            is_control.then(|| {
                let name = node.label().or(node.value()).unwrap_or_default();
                (format!("{:?} “{name}”", node.role()), rect)
            })
        });
        nodes.collect()
    };
    let hidden: Vec<(String, Rect)> = controls(window)
        .into_iter()
        .filter(|(_, rect)| !screen.contains(rect.center()))
        .collect();
    for (name, rect) in hidden {
        let node = window
            .root()
            .children_recursive()
            .find(|node| node.accesskit_node().raw_bounds().is_some() && node.rect() == rect);
        let Some(node) = node else { continue };
        node.scroll_to_me();
        window.run_steps(12);
        let is_seen = controls(window)
            .iter()
            .any(|(other, rect)| *other == name && screen.contains(rect.center()));
        assert!(
            is_seen,
            "{moment}: {name} stays at {rect:?} outside {screen:?}"
        );
    }
}

#[test]
fn every_control_can_be_reached_at_300_percent_and_in_a_window_of_800_by_600_pixels() {
    for (size, scale) in [
        (vec2(1280.0, 800.0), 3.0),
        (vec2(800.0, 600.0), 3.0),
        (vec2(800.0, 600.0), 2.0),
        (vec2(800.0, 600.0), 1.0),
        (vec2(1200.0, 700.0), 1.5),
    ] {
        let Some(gpu) = gpu() else { return };
        let points = size / scale;
        let mut window = app_on(shared_setup(gpu), None, points, scale);
        let at = in_picture(&window, 0.5, 0.5);
        click(&mut window, at);
        wait(&mut window, "the pick", |app| app.inspection().is_some());
        for tab in Tab::ALL {
            let title = format!("{} of {size} at {scale}", tab.title());
            run_command(&mut window, &format!("Tab: {}", tab.title()));
            // What is still computed may change a panel's height while it is scrolled.
            settled(&mut window);
            all_reachable(&mut window, &title);
        }
    }
}
