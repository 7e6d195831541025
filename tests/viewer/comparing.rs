//! Tests of comparisons with another view, kernel, mesh or picture in the window.

use crate::app::drop_file;
use crate::harness::{Window, app, click, in_picture, pointer, press, say, settle, wait, write};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2};
use egui_kittest::kittest::Queryable as _;
use glam::UVec2;
use hitscope::app::App;
use hitscope::comparison::{Mode, Source};
use hitscope_lab::commands::Output;
use std::path::Path;
use tempfile::TempDir;

/// A square that covers the middle of the first picture.
pub const SQUARE: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
/// The same square, moved 0.25 back.
const FARTHER: &str = "v -1 -1 -0.25\nv 1 -1 -0.25\nv 1 1 -0.25\nv -1 1 -0.25\nf 1 2 3 4\n";

/// The window with a mesh, once its picture is complete; `None` if the test is skipped.
pub fn opened(text: &str) -> Option<(Window, TempDir)> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(&folder, "mesh.obj", text);
    let mut window = app(Some(path))?;
    settle(&mut window, "mesh.obj");
    Some((window, folder))
}

/// Draws frames until both sides and their figures are there.
pub fn settled(window: &mut Window) {
    window.run_steps(4);
    wait(window, "both sides", App::is_settled);
    window.run_steps(4);
    wait(window, "both sides", App::is_settled);
}

/// Starts a comparison, which opens its tab.
pub fn compare(window: &mut Window) {
    press(window, Key::C);
    settled(window);
    assert!(window.state().is_comparing());
}

pub fn button(window: &mut Window, label: &str) {
    window.get_by_label(label).click();
    settled(window);
}

/// Chooses an entry of the combo box of this name.
pub fn choose(window: &mut Window, combo: &str, entry: &str) {
    window.get_by_role_and_label(Role::ComboBox, combo).click();
    window.run_steps(4);
    let entries = window.get_all_by_label(entry);
    entries.last().expect("in the menu").click();
    settled(window);
}

/// Enters a path where the machine has no file dialog; `None` if it has one.
fn enter_path(window: &mut Window, button: &str, path: &Path) -> Option<()> {
    window.get_by_label(button).click();
    for _ in 0..400 {
        window.step();
        if window.query_by_label("Path").is_some() {
            let field = window.get_all_by_role(Role::TextInput).last();
            field
                .expect("in the dialog")
                .type_text(path.to_str().expect("UTF-8"));
            window.step();
            window.get_by_label("Load").click();
            settled(window);
            return Some(());
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    say("SKIPPED: this machine has a file dialog");
    None
}

/// Compares with a file where the machine has no file dialog; `None` if it has one.
fn compare_with_file(window: &mut Window, path: &Path) -> Option<()> {
    choose(window, "Source", Source::Mesh.title());
    enter_path(window, "Compare with a file…", path)
}

/// The colour on the screen at a point of the picture.
pub fn colour(window: &mut Window, x: f32, y: f32) -> [u8; 3] {
    let at = in_picture(window, x, y);
    let shown = window.render().expect("an image");
    let [r, g, b, _] = shown.get_pixel(at.x as u32, at.y as u32).0;
    [r, g, b]
}

fn drag(window: &mut Window, from: Pos2, to: Pos2) {
    window.event(Event::PointerMoved(from));
    window.run_steps(2);
    pointer(window, from, PointerButton::Primary, true, Modifiers::NONE);
    window.step();
    for part in [0.3, 0.6, 1.0] {
        window.event(Event::PointerMoved(from.lerp(to, part)));
        window.step();
    }
    pointer(window, to, PointerButton::Primary, false, Modifiers::NONE);
    window.run_steps(3);
}

#[test]
fn a_wipe_shows_the_other_view_right_of_the_divider_which_can_be_dragged() {
    let Some((mut window, _folder)) = opened(SQUARE) else {
        return;
    };
    let before = colour(&mut window, 0.55, 0.5);
    compare(&mut window);
    choose(&mut window, "View of B", "Normal");
    let [left, right] = [0.45, 0.55].map(|x| colour(&mut window, x, 0.5));
    assert_eq!(left, before, "one square has one colour");
    assert_ne!(right, left);
    let turntable = *window.state().turntable();
    let [from, to] = [0.5, 0.6].map(|x| in_picture(&window, x, 0.5));
    drag(&mut window, from, to);
    settled(&mut window);
    let divider = window.state().comparison().divider;
    assert!((divider - 0.6).abs() < 0.01, "{divider}");
    assert_eq!(colour(&mut window, 0.55, 0.5), left);
    assert_eq!(*window.state().turntable(), turntable, "nothing turned");
    // The keys move it in steps.
    for (key, expected) in [(Key::ArrowLeft, divider - 0.05), (Key::ArrowRight, divider)] {
        window.key_press_modifiers(Modifiers::SHIFT, key);
        window.run_steps(2);
        let found = window.state().comparison().divider;
        assert!((found - expected).abs() < 1e-6, "{found}");
    }
    press(&mut window, Key::C);
    assert!(!window.state().is_comparing());
    window.run_steps(3);
    assert_eq!(colour(&mut window, 0.65, 0.5), before);
}

#[test]
fn a_saved_picture_has_both_sides_of_a_wipe() {
    let Some((mut window, folder)) = opened(SQUARE) else {
        return;
    };
    compare(&mut window);
    choose(&mut window, "View of B", "Normal");
    let places = [0.45, 0.55];
    let shown = places.map(|x| colour(&mut window, x, 0.5));
    assert_ne!(shown[0], shown[1]);
    press(&mut window, Key::F12);
    wait(&mut window, "the file", |app| !app.toasts().is_empty());
    let saved = image::open(folder.path().join("mesh-1.png")).expect("saved");
    let saved = saved.to_rgb8();
    let of_file = places.map(|x| {
        let x = (x * saved.width() as f32) as u32;
        saved.get_pixel(x, saved.height() / 2).0
    });
    assert_eq!(of_file, shown);
}

/// The square, nine times as large.
const LARGE: &str = "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nf 1 2 3 4\n";

#[test]
fn home_frames_both_sides() {
    let Some((mut window, folder)) = opened(SQUARE) else {
        return;
    };
    let large = write(&folder, "large.obj", LARGE);
    compare(&mut window);
    press(&mut window, Key::Home);
    let near = window.state().turntable().distance;
    let Some(()) = compare_with_file(&mut window, &large) else {
        return;
    };
    assert_eq!(window.state().turntable().distance, near);
    press(&mut window, Key::Home);
    settled(&mut window);
    let far = window.state().turntable().distance;
    // Bounds and distance are rounded to f32 at most.
    assert!((far / near - 9.0).abs() < 1e-5, "{near} {far}");
}

#[test]
fn a_key_switches_the_sides_and_undo_brings_the_last_one_back() {
    let Some((mut window, _folder)) = opened(SQUARE) else {
        return;
    };
    let a = colour(&mut window, 0.5, 0.5);
    compare(&mut window);
    choose(&mut window, "View of B", "Depth");
    press(&mut window, Key::X);
    settled(&mut window);
    assert_eq!(window.state().comparison().mode, Mode::B);
    let b = colour(&mut window, 0.5, 0.5);
    assert_ne!(a, b);
    press(&mut window, Key::X);
    settled(&mut window);
    assert_eq!(colour(&mut window, 0.5, 0.5), a);
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settled(&mut window);
    assert_eq!(window.state().comparison().mode, Mode::B);
    assert_eq!(colour(&mut window, 0.5, 0.5), b);
    // The tab also has a control for the view of side A.
    choose(&mut window, "View of A", "Triangle");
    assert_eq!(window.state().settings().view().name, "triangle");
    choose(&mut window, "View of A", "Shaded");
    // Swapped, side B is what side A was.
    window.key_press_modifiers(Modifiers::SHIFT, Key::X);
    settled(&mut window);
    assert_eq!(window.state().settings().view().name, "depth");
    assert_eq!(colour(&mut window, 0.5, 0.5), a);
}

#[test]
fn the_pixels_in_which_kernels_or_views_differ_are_counted_and_shown() {
    let Some((mut window, _folder)) = opened(SQUARE) else {
        return;
    };
    compare(&mut window);
    let figures = window.state().figures().expect("counted").clone();
    assert_eq!(figures.picture.pixels_over_tolerance, 0);
    assert_eq!(figures.picture.psnr_db, None);
    button(&mut window, "Difference");
    assert_eq!(colour(&mut window, 0.5, 0.5), [0; 3]);
    choose(&mut window, "Kernel of B", "exact – Exact, adaptive");
    assert_eq!(window.state().comparison().kernel.as_deref(), Some("exact"));
    choose(&mut window, "View of B", "Normal");
    let found = window.state().figures().expect("counted").picture.clone();
    let all = window.state().film().size().element_product() as usize;
    assert!(found.pixels_over_tolerance > all / 10, "{found:?}");
    assert!(found.pixels_over_tolerance < all, "{found:?}");
    assert!(found.psnr_db.is_some());
    window.get_by_label("PSNR");
    assert_ne!(colour(&mut window, 0.5, 0.5), [0; 3]);
}

#[test]
fn another_file_is_shown_measured_and_inspected_beside_the_first() {
    let Some((mut window, folder)) = opened(SQUARE) else {
        return;
    };
    let other = write(&folder, "farther.obj", FARTHER);
    compare(&mut window);
    let Some(()) = compare_with_file(&mut window, &other) else {
        return;
    };
    assert_eq!(window.state().notice(), None);
    wait(&mut window, "the distances", |app| {
        app.mesh_distances().is_some()
    });
    let distances = window.state().mesh_distances().expect("measured");
    let distances = distances.as_ref().expect("meshes").clone();
    // The mean adds rounded numbers.
    for figure in [
        distances.there.mean,
        distances.back.mean,
        distances.there.max,
    ] {
        assert!((figure - 0.25).abs() < 1e-9, "{distances:?}");
    }
    for (x, depth) in [(0.45, 0.0), (0.55, -0.25)] {
        let at = in_picture(&window, x, 0.5);
        click(&mut window, at);
        // Rays hit within some ulps of the surface.
        wait(&mut window, "the pick", |app| {
            let hit = app.inspection().and_then(|found| found.hit.as_ref());
            hit.is_some_and(|hit| (hit.position[2] - depth).abs() < 1e-5)
        });
    }
    button(&mut window, "Compare");
    button(&mut window, "Distance map");
    assert_eq!(window.state().map_status(), None);
    // Every point has the largest distance, and so the last colour of the scale.
    let legend = window.state().legend().expect("of distances");
    assert_eq!(legend.title(), "Distance");
    let [r, g, b] = colour(&mut window, 0.5, 0.5);
    let last = legend.colour(distances.there.max);
    assert!(last.x > 0.0 && [r, g, b] != [0; 3], "{last} {r} {g} {b}");
}

#[test]
fn a_file_that_is_loaded_again_is_compared_with_its_earlier_version() {
    let Some((mut window, folder)) = opened(SQUARE) else {
        return;
    };
    compare(&mut window);
    choose(&mut window, "Source", Source::Earlier.title());
    window.get_by_label("There is no earlier version: the file hasn't been reloaded.");
    let smaller = SQUARE.replace("v 1 1 0", "v 0.25 0.25 0");
    write(&folder, "mesh.obj", &smaller);
    let path = folder.path().join("mesh.obj");
    press(&mut window, Key::F5);
    wait(&mut window, "the new version", |app| {
        let mesh = app.document().loaded.scene.mesh();
        app.document().path.as_ref() == Some(&path)
            && mesh.positions().iter().all(|p| p.x + p.y < 1.0)
    });
    settled(&mut window);
    wait(&mut window, "the distances", |app| {
        app.mesh_distances().is_some()
    });
    let distances = window.state().mesh_distances().expect("measured");
    let distances = distances.as_ref().expect("meshes");
    assert!(distances.there.max < 1e-9, "a part of the earlier version");
    assert!(distances.back.max > 0.5, "{distances:?}");
    let found = window.state().figures().expect("counted").picture.clone();
    assert!(found.pixels_over_tolerance > 100, "{found:?}");
}

#[test]
fn a_reference_picture_sets_the_size_and_has_figures() {
    let Some((mut window, folder)) = opened(SQUARE) else {
        return;
    };
    // A reference in a size that the window doesn't have, but for one pixel what the window shows.
    let size = UVec2::new(160, 120);
    let blank = vec![[0, 0, 0, 255]; 160 * 120];
    let path = folder.path().join("reference.png");
    let save = |pixels: &[[u8; 4]], path: &Path| {
        let output = Output::create(path).expect("created");
        output.write_png(size, pixels).expect("written");
    };
    save(&blank, &path);
    drop_file(&mut window, path);
    settled(&mut window);
    wait(&mut window, "the size", |app| app.film().size() == size);
    settled(&mut window);
    let mut pixels = window.state().film().pixels().to_vec();
    let changed = 60 * 160 + 80;
    pixels[changed] = pixels[changed].map(|x| x.saturating_sub(51).max(1));
    pixels[changed][3] = 255;
    let path = folder.path().join("better.png");
    save(&pixels, &path);
    drop_file(&mut window, path);
    window.run_steps(3);
    settled(&mut window);
    wait(&mut window, "the figures", |app| {
        let figures = app.figures();
        figures.is_some_and(|figures| figures.picture.pixels_over_tolerance == 1)
    });
    let found = window.state().figures().expect("counted").picture.clone();
    assert!(!found.is_linear);
    assert_eq!(found.worst.expect("a difference").pixel, [80, 60]);
    assert!(found.psnr_db.expect("a difference") > 40.0);
    window.get_by_label("RMSE");
    // Another kind of side B, and the picture fills the window again.
    choose(&mut window, "Source", Source::Traced.title());
    assert_ne!(window.state().film().size(), size);
}

#[test]
fn a_reference_that_cannot_be_read_gives_an_error_and_changes_nothing() {
    let Some((mut window, folder)) = opened(SQUARE) else {
        return;
    };
    let size = window.state().film().size();
    drop_file(&mut window, write(&folder, "text.png", "no picture"));
    wait(&mut window, "the error", |app| app.notice().is_some());
    let notice = window.state().notice().expect("an error");
    assert!(notice.contains("text.png"), "{notice}");
    settled(&mut window);
    assert_eq!(window.state().film().size(), size);
}
