//! Tests of the pointer while the camera moves: a click inspects the ray whose colour the pixel shows.

use crate::harness::{Window, app_started, bare, bare_with, press, wait};
use crate::inspecting::{corner, middle};
use crate::pointer::{on_the_mesh, rest};
use egui::{Event, Key, Modifiers, PointerButton};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::{DVec2, DVec3, UVec2, Vec2};
use hitscope::app::{App, StartOptions};
use hitscope::preferences::Preferences;
use hitscope::quality::MovingResolution;
use hitscope::settings::Settings;
use hitscope::theme;
use hitscope_core::film::ShownPixel;
use hitscope_core::integrator::palette::id_colour;
use hitscope_core::random::Random;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Arc;

/// Presses or releases the button with one event, which takes one frame.
fn button(window: &Window, pos: egui::Pos2, pressed: bool) {
    window.event(Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    });
}

/// What a pixel of the screen shows, which isn't the newest camera's picture.
fn shown(window: &Window, pixel: UVec2) -> ShownPixel {
    let app = window.state();
    let shown = app.shown_pixel(pixel).expect("a picture");
    let newest = app.turntable().camera(app.film().size());
    assert_ne!(shown.camera, newest, "the camera keeps moving");
    shown
}

/// The point that a pixel of the screen shows.
fn surface(window: &Window, pixel: UVec2) -> Option<DVec3> {
    let ray = shown(window, pixel).ray();
    let hit = window.state().document().intersector().closest_hit(&ray)?;
    Some(ray.origin.as_dvec3() + f64::from(hit.t) * ray.dir.as_dvec3())
}

/// Waits until a pixel of the screen shows a surface, and returns the point.
fn wait_for_surface(window: &mut Window, pixel: UVec2) -> DVec3 {
    for _ in 0..600 {
        if let Some(point) = surface(window, pixel) {
            return point;
        }
        window.step();
    }
    panic!("nothing turns through {pixel}");
}

#[test]
fn clicks_and_the_wheel_refer_to_the_picture_on_the_screen_while_the_camera_moves() {
    let Some(mut window) = bare() else { return };
    let (x, y) = on_the_mesh(&window);
    let pixel = (window.state().film().size().as_vec2() * Vec2::new(x, y)).as_uvec2();
    let place = middle(&window, pixel);
    press(&mut window, Key::T);
    window.event(Event::PointerMoved(place));
    window.run_steps(10);

    // A single click.
    button(&window, place, true);
    window.step();
    let clicked = shown(&window, pixel);
    button(&window, place, false);
    window.step();
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    let found = window.state().inspection().expect("a pick").clone();
    assert_eq!(found.pixel, clicked.pixel.to_array());
    assert_eq!(found.ray.direction, clicked.ray().dir.to_array());

    // A pinch, which zooms at once instead of over several frames.
    rest(&mut window);
    let anchor = wait_for_surface(&mut window, pixel);
    let before = *window.state().turntable();
    window.event(Event::Zoom(1.5));
    window.step();
    let after = *window.state().turntable();
    let scale = after.distance / before.distance;
    assert!((scale - 1.0 / 1.5).abs() < 1e-6, "{scale}");
    let found = (after.pivot - before.pivot * scale) / (1.0 - scale);
    // Roundings of numbers of the distance's size.
    let tolerance = 1e-6 * before.distance;
    assert!((found - anchor).length() < tolerance, "{found}, {anchor}");

    // A double click.
    wait_for_surface(&mut window, pixel);
    for is_last in [false, true] {
        button(&window, place, true);
        window.step();
        let point = surface(&window, pixel);
        button(&window, place, false);
        window.step();
        if let (true, Some(point)) = (is_last, point) {
            let pivot = window.state().turntable().pivot;
            assert!((pivot - point).length() < tolerance, "{pivot}, {point}");
        }
    }
}

/// The window without its side panel in the view of triangles, with one sample per pixel: means of several are colours of
/// no triangle. Clicks needn't wait for a second one.
pub fn window_of_triangles(file: Option<PathBuf>) -> Option<Window> {
    let mut settings = Settings::default();
    settings.keep_view("triangle");
    settings.samples = 1;
    let mut window = app_started(StartOptions {
        file,
        settings,
        preferences: Preferences {
            shows_panel: false,
            ..Preferences::default()
        },
        ..StartOptions::default()
    })?;
    wait(&mut window, "the picture", App::is_settled);
    window
        .ctx
        .options_mut(|options| options.input_options.max_double_click_delay = 0.0);
    Some(window)
}

/// A pixel of the picture, not in its upper and lower quarter, which messages and the read-out cover.
fn any_pixel(random: &mut Random, size: UVec2) -> UVec2 {
    let part = |extent: u32, random: &mut Random| (random.unit() * f64::from(extent)) as u32;
    let quarter = size.y / 4;
    UVec2::new(part(size.x, random), quarter + part(2 * quarter, random))
}

/// The colour of the background.
fn background(window: &Window) -> [u8; 4] {
    let (app, theme) = (window.state(), window.ctx.theme());
    let settings = app.settings();
    let linear = theme::background(settings.view(), settings.colours.background, theme);
    app.film().display().encode(linear)
}

/// The text of the read-out under the pointer.
fn read_out(window: &Window) -> Option<String> {
    let mut labels = window
        .query_all_by_label_contains("t ")
        .filter_map(|label| label.accesskit_node().label())
        .filter(|label| label.contains("  ·  triangle "));
    labels.next()
}

/// What a pixel of the window's picture shows, also while a picture of another size is stretched over it.
fn shown_on_screen(window: &Window, pixel: UVec2) -> Option<ShownPixel> {
    let app = window.state();
    let size = app.shown_camera()?.resolution().as_dvec2();
    let canvas = window.get_by_label("Rendered picture").rect().size();
    let part = (pixel.as_dvec2() + 0.5) / DVec2::new(canvas.x.into(), canvas.y.into());
    app.shown_pixel((part * size).as_uvec2())
}

/// Whether the mark of a pick may cover what a pixel shows.
fn is_near_the_mark(window: &Window, shown: &ShownPixel) -> bool {
    let mark = window.state().marked_point();
    let mark = mark.and_then(|point| shown.camera.pixel_of(point));
    mark.is_some_and(|mark| mark.distance(shown.pixel.as_dvec2()) < 30.0)
}

/// Clicks a pixel and compares the inspected triangle with the pixel's colour on the screen, and with the read-out. Returns
/// whether it is a triangle; `None` if there is nothing to compare: a new document has just been opened, or a mark covers
/// the pixel.
fn click_shows_its_triangle(window: &mut Window, pixel: UVec2) -> Option<bool> {
    let at = middle(window, pixel);
    window.event(Event::PointerMoved(at));
    button(window, at, true);
    window.step();
    let screen = window.render().expect("an image");
    let UVec2 { x, y } = corner(window) + pixel;
    let colour = screen.get_pixel(x, y).0;
    let text = read_out(window);
    let shown = shown_on_screen(window, pixel).filter(|shown| !is_near_the_mark(window, shown));
    let document = Arc::clone(&window.state().document().loaded.scene);
    button(window, at, false);
    window.step();
    let is_same = Arc::ptr_eq(&document, &window.state().document().loaded.scene);
    let ray = shown.filter(|_| is_same)?.ray();
    wait(window, "the pick", |app| {
        let found = app.inspection();
        found.is_some_and(|found| found.ray.direction == ray.dir.to_array())
    });
    let hit = window.state().inspection().expect("a pick").hit.clone();
    let expected = hit.as_ref().map_or(background(window), |hit| {
        let film = window.state().film();
        film.display().encode(id_colour(hit.primitive))
    });
    assert_eq!(colour, expected, "{hit:?}");
    // While a file is loaded, there is none.
    if let Some(text) = text {
        let triangle = hit
            .as_ref()
            .map(|hit| format!("triangle {}", hit.primitive));
        assert_eq!(text.split("  ·  ").nth(1), triangle.as_deref(), "{text}");
    }
    Some(hit.is_some())
}

/// Clears messages, then the pick.
fn clear(window: &mut Window) {
    for _ in 0..4 {
        if window.state().inspection().is_some() {
            press(window, Key::Escape);
        }
    }
    assert!(window.state().inspection().is_none());
}

#[test]
fn a_click_inspects_the_triangle_that_the_screen_shows_while_the_camera_turns() {
    const CLICKS: usize = 1000;
    let Some(mut window) = window_of_triangles(None) else {
        return;
    };
    press(&mut window, Key::T);
    let mut random = Random::new(18);
    let mut hits = 0;
    for number in 0..CLICKS {
        let pixel = any_pixel(&mut random, window.state().film().size());
        let hit = click_shows_its_triangle(&mut window, pixel);
        hits += usize::from(hit.unwrap_or_else(|| panic!("click {number} at {pixel}")));
        clear(&mut window);
    }
    assert!(hits > CLICKS / 10, "{hits} hits");
}

#[test]
fn clicks_right_after_undo_redo_and_a_new_size_inspect_what_the_screen_shows() {
    let Some(mut window) = window_of_triangles(None) else {
        return;
    };
    press(&mut window, Key::T);
    let mut random = Random::new(19);
    // Odd sizes of the picture: when a picture of one size is stretched to another, no pixel's centre lies between two pixels.
    let is_odd = window.state().film().size() % 2;
    let size = UVec2::new(800, 600) + (UVec2::ONE - is_odd);
    let sizes = [size, size - UVec2::new(158, 122), size + UVec2::new(46, 60)];
    let mut hits = 0;
    for number in 0..60 {
        let command = Modifiers::COMMAND | Modifiers::CTRL;
        match number % 6 {
            1 => window.key_press_modifiers(command, Key::Z),
            3 => window.key_press_modifiers(command, Key::Y),
            5 => {
                let size = sizes[number / 6 % sizes.len()].as_vec2();
                window.set_size(egui::vec2(size.x, size.y));
            }
            _ => {}
        }
        window.step();
        // In the smallest picture.
        let least = window.state().film().size().min(UVec2::new(600, 380));
        let pixel = any_pixel(&mut random, least);
        hits += usize::from(click_shows_its_triangle(&mut window, pixel) == Some(true));
        clear(&mut window);
    }
    assert!(hits > 6, "{hits} hits");
}

/// An OBJ file of a hilly surface of `side` × `side` squares.
pub fn hilly_square(side: usize) -> String {
    let mut obj = String::new();
    let places = (0..=side).flat_map(|y| (0..=side).map(move |x| (x, y)));
    for (x, y) in places {
        _ = writeln!(obj, "v {x} {y} {}", (x * x + 3 * y) % 4);
    }
    let row = side + 1;
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        let corner = y * row + x + 1;
        let corners = [corner, corner + 1, corner + row + 1, corner + row];
        _ = writeln!(obj, "f {}", corners.map(|v| v.to_string()).join(" "));
    }
    obj
}

#[test]
fn clicks_while_the_file_is_loaded_again_inspect_what_the_screen_shows() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hills.obj");
    std::fs::write(&path, hilly_square(60)).expect("written");
    let Some(mut window) = window_of_triangles(Some(path)) else {
        return;
    };
    press(&mut window, Key::T);
    let mut random = Random::new(20);
    let scene = |window: &Window| Arc::as_ptr(&window.state().document().loaded.scene);
    let mut hits = 0;
    let mut click = |window: &mut Window| {
        let pixel = any_pixel(&mut random, window.state().film().size());
        hits += usize::from(click_shows_its_triangle(window, pixel) == Some(true));
    };
    for _ in 0..10 {
        let before = scene(&window);
        window.key_press(Key::F5);
        window.step();
        click(&mut window);
        wait(&mut window, "the file", |app| {
            Arc::as_ptr(&app.document().loaded.scene) != before
        });
        // Escape would have cancelled the loading.
        clear(&mut window);
        for _ in 0..3 {
            click(&mut window);
            clear(&mut window);
        }
    }
    assert!(hits > 6, "{hits} hits");
}

/// The pixels of the picture as they are drawn.
fn drawn(window: &mut Window) -> Vec<[u8; 4]> {
    let image = window.render().expect("drawn");
    let corner = window.get_by_label("Rendered picture").rect().min;
    let size = window.state().film().size();
    let [x, y] = [corner.x, corner.y].map(|x| x as u32);
    let cropped = image::imageops::crop_imm(&image, x, y, size.x, size.y);
    cropped.to_image().pixels().map(|pixel| pixel.0).collect()
}

#[test]
fn a_picture_of_blocks_is_drawn_as_the_film_has_it() {
    for (moving, block_px) in [(MovingResolution::Half, 2), (MovingResolution::Quarter, 4)] {
        let settings = Settings {
            moving,
            ..Settings::default()
        };
        let Some(mut window) = bare_with(settings) else {
            return;
        };
        press(&mut window, Key::P);
        // Blocks at the right and lower borders are whole or cut: both sizes change.
        for width in 800..804 {
            window.set_size(egui::vec2(width as f32, 1397.0 - width as f32));
            window.run_steps(5);
            let is_begun =
                |app: &App| app.film().passes_done() == 1 && app.film().size().x == width;
            wait(&mut window, "the first pass", is_begun);
            window.run_steps(3);
            assert_eq!(window.state().film().block_px(), block_px);
            let drawn = drawn(&mut window);
            assert!(drawn == window.state().film().pixels(), "blocks, {width}");
        }
        press(&mut window, Key::P);
        wait(&mut window, "all samples", App::is_settled);
        window.run_steps(3);
        assert_eq!(window.state().film().block_px(), 1);
        let drawn = drawn(&mut window);
        assert!(drawn == window.state().film().pixels(), "pixels");
    }
}
