//! Tests of the real app, driven by labels and keys.

use crate::harness::{
    Window, app, bare, choose_kernel, choose_view, click, in_picture, press, say, wait, write,
};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::DVec3;
use hitscope::app::App;
use hitscope_core::camera::UpAxis;
use hitscope_core::integrator::INTEGRATORS;
use std::path::PathBuf;
use std::time::Instant;

#[test]
fn a_file_opens_and_stays_if_the_next_one_is_bad() {
    let folder = tempfile::tempdir().expect("a folder");
    let good = write(&folder, "good.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let bad = write(&folder, "bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    let Some(mut window) = app(Some(good)) else {
        return;
    };
    wait(&mut window, "the file", |app| {
        app.document().name() == "good.obj"
    });
    assert_eq!(
        window
            .state()
            .document()
            .loaded
            .scene
            .mesh()
            .triangles()
            .len(),
        1
    );
    for (path, message) in [
        (
            bad,
            "bad.obj:4: no faces left: 1 with an index that is out of range",
        ),
        (folder.path().join("none.obj"), "none.obj: "),
        (folder.path().to_owned(), "this is a directory"),
        (
            write(&folder, "empty.obj", ""),
            "empty.obj: the file is empty",
        ),
        (
            write(&folder, "page.obj", "<html></html>"),
            "page.obj: this is an HTML page",
        ),
        (
            write(&folder, "dots.obj", "v 0 0 0\n"),
            "dots.obj: no faces, only 1 vertex",
        ),
    ] {
        drop_file(&mut window, path);
        wait(&mut window, message, |app| {
            app.notice().is_some_and(|n| n.contains(message))
        });
        assert_eq!(window.state().document().name(), "good.obj");
        press(&mut window, Key::Escape);
        assert_eq!(window.state().notice(), None);
    }
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &std::path::Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

/// Drops a file on the window.
pub fn drop_file(window: &mut Window, path: PathBuf) {
    window
        .input_mut()
        .dropped_files
        .push(std::sync::Arc::new(Dropped(path)));
    window.step();
    window.input_mut().dropped_files.clear();
}

#[test]
fn without_a_file_dialog_a_path_can_be_typed() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = write(&folder, "typed.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let Some(mut window) = bare() else { return };
    window.key_press_modifiers(Modifiers::COMMAND, Key::O);
    // A machine with a portal shows its own dialog, which this test can't answer.
    for _ in 0..200 {
        window.step();
        if window.query_by_label("Path").is_some() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    if window.query_by_label("Path").is_none() {
        say("SKIPPED: this machine has a file dialog");
        return;
    }
    let path = file.to_str().expect("UTF-8").to_owned();
    window
        .get_by_role(egui::accesskit::Role::TextInput)
        .type_text(&path);
    window.step();
    window.get_by_label("Load").click();
    wait(&mut window, "the file", |app| {
        app.document().name() == "typed.obj"
    });
}

#[test]
fn every_view_changes_the_picture() {
    let Some(mut window) = bare() else { return };
    let mut seen: Vec<Vec<[u8; 4]>> = Vec::new();
    for view in INTEGRATORS {
        choose_view(&mut window, view.title);
        wait(&mut window, view.name, |app| {
            app.settings().view == view.name && app.film().samples() >= 1
        });
        let pixels = window.state().film().pixels().to_vec();
        assert!(
            !seen.contains(&pixels),
            "{} looks like another view",
            view.name
        );
        seen.push(pixels);
    }
}

#[test]
fn number_keys_look_along_the_axes() {
    let Some(mut window) = bare() else { return };
    assert_eq!(window.state().turntable().up_axis, UpAxis::Y);
    for (key, modifiers, back) in [
        (Key::Num1, Modifiers::NONE, DVec3::Z),
        (Key::Num1, Modifiers::COMMAND, DVec3::NEG_Z),
        (Key::Num3, Modifiers::NONE, DVec3::X),
        (Key::Num3, Modifiers::COMMAND, DVec3::NEG_X),
        (Key::Num7, Modifiers::NONE, DVec3::Y),
        (Key::Num7, Modifiers::COMMAND, DVec3::NEG_Y),
    ] {
        window.key_press_modifiers(modifiers, key);
        window.run_steps(2);
        let camera = window.state().turntable().camera(glam::UVec2::new(8, 8));
        assert!(
            (camera.back() - back).length() < 1e-12,
            "{key:?} {modifiers:?}"
        );
    }
}

#[test]
fn every_tab_can_be_opened() {
    let Some(mut window) = app(None) else { return };
    for (tab, sign) in [
        ("Mesh", "Flaws"),
        ("Inspect", "Click a pixel to inspect its ray."),
        ("Display", "Theme"),
    ] {
        window.get_by_label(tab).click();
        window.run_steps(3);
        window.get_by_label(sign);
    }
    window.get_by_label("Light").scroll_to_me();
    window.run_steps(10);
    window.get_by_label("Light").click();
    window.run_steps(3);
    assert_eq!(
        window.state().preferences().theme,
        egui::ThemePreference::Light
    );
}

#[test]
fn a_selected_kernel_is_used_once_it_is_packed() {
    let Some(mut window) = app(None) else { return };
    assert_eq!(
        window.state().document().intersector().kernel().name,
        "exact"
    );
    choose_kernel(&mut window, "fast – Möller–Trumbore");
    wait(&mut window, "the other kernel", |app| {
        app.document().intersector().kernel().name == "moller-trumbore"
    });
}

#[test]
fn the_picture_converges_unless_paused() {
    let Some(mut window) = bare() else { return };
    press(&mut window, Key::P);
    wait(&mut window, "the pause", App::is_paused);
    // Tiles begun before the pause still arrive.
    let (mut held, mut unchanged) = (Vec::new(), 0);
    while unchanged < 3 {
        std::thread::sleep(std::time::Duration::from_millis(300));
        window.run_steps(5);
        let pixels = window.state().film().pixels();
        unchanged = if pixels == held { unchanged + 1 } else { 0 };
        held = pixels.to_vec();
    }
    assert!(!window.state().is_settled());
    press(&mut window, Key::P);
    wait(&mut window, "all samples", App::is_settled);
    assert_eq!(
        window.state().film().samples(),
        window.state().settings().samples
    );
}

#[test]
fn t_toggles_auto_rotation() {
    let Some(mut window) = bare() else { return };
    let before = *window.state().turntable();
    press(&mut window, Key::T);
    window.run_steps(5);
    let turned = *window.state().turntable();
    assert_ne!(turned, before);
    assert_eq!(
        (turned.pivot, turned.distance),
        (before.pivot, before.distance)
    );
    press(&mut window, Key::T);
    window.run_steps(2);
    let stopped = *window.state().turntable();
    window.run_steps(5);
    assert_eq!(*window.state().turntable(), stopped);
}

#[test]
fn a_window_can_shrink_to_one_pixel_and_the_old_size_restores_the_picture() {
    // Without the side panel, which would stay narrow.
    let Some(mut window) = bare() else { return };
    wait(&mut window, "all samples", App::is_settled);
    let before = window.state().film().clone();
    window.set_size(egui::vec2(1.0, 1.0));
    wait(&mut window, "the smallest picture", |app| {
        app.film().size() == glam::UVec2::ONE && app.is_settled()
    });
    window.set_size(egui::vec2(800.0, 600.0));
    wait(&mut window, "the picture", |app| {
        app.film().size() == before.size() && app.is_settled()
    });
    assert!(window.state().film().pixels() == before.pixels());
}

#[test]
fn the_window_shows_the_exact_pixels_of_the_traced_picture() {
    let Some(mut window) = app(None) else { return };
    wait(&mut window, "all samples", App::is_settled);
    window.step();
    let shown = window.render().expect("an image");
    let film = window.state().film();
    let corner = window.get_by_label("Rendered picture").rect().min;
    let (left, top) = (corner.x as u32, corner.y as u32);
    for (i, &expected) in film.pixels().iter().enumerate() {
        let (x, y) = (i as u32 % film.size().x, i as u32 / film.size().x);
        let found = shown.get_pixel(left + x, top + y).0;
        assert_eq!(found, expected, "pixel {x}, {y}");
    }
}

#[test]
fn escape_closes_an_open_menu_before_it_clears_the_pick() {
    let Some(mut window) = app(None) else { return };
    let corner = in_picture(&window, 0.01, 0.01);
    click(&mut window, corner);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    let menu = |window: &Window| window.query_by_label("Cost").is_some();
    assert!(!menu(&window));
    window.get_by_role(egui::accesskit::Role::ComboBox).click();
    window.run_steps(3);
    assert!(menu(&window));
    press(&mut window, Key::Escape);
    window.run_steps(3);
    assert!(!menu(&window));
    assert!(window.state().inspection().is_some());
    press(&mut window, Key::Escape);
    assert!(window.state().inspection().is_none());
}

#[test]
fn framing_includes_lines_and_points_and_the_status_line_counts_one_triangle() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 40\nv -30 0 0\nf 1 2 3\nl 1 4\np 5\n";
    let file = write(&folder, "lines.obj", text);
    let Some(mut window) = app(Some(file)) else {
        return;
    };
    wait(&mut window, "the file", |app| {
        app.document().name() == "lines.obj"
    });
    wait(&mut window, "the picture", App::is_settled);
    for moment in ["as loaded", "after Home"] {
        let app = window.state();
        let size = app.film().size();
        let camera = app.turntable().camera(size);
        for end in [DVec3::new(0.0, 0.0, 40.0), DVec3::new(-30.0, 0.0, 0.0)] {
            let pixel = camera.pixel_of(end).expect("in front of the camera");
            let is_inside =
                pixel.cmpge(glam::DVec2::ZERO).all() && pixel.cmple(size.as_dvec2()).all();
            assert!(is_inside, "{end} {moment}: {pixel} of {size}");
        }
        press(&mut window, Key::Home);
    }
    window.get_by_label_contains("1 triangle ·");
}

#[test]
fn the_status_line_tells_the_time_to_the_first_picture() {
    let began = Instant::now();
    let Some(mut window) = app(None) else { return };
    wait(&mut window, "the time", |app| app.first_picture().is_some());
    window.run_steps(2);
    let after = window.state().first_picture();
    assert!(after <= Some(began.elapsed()), "{after:?}");
    let times = |window: &Window| {
        let labels = window.query_all_by_label_contains("first picture after");
        labels.map(|label| label.rect()).collect::<Vec<_>>()
    };
    let line = times(&window);
    assert_eq!(line.len(), 1);
    // The line is cut off here, so that a tooltip shows all of it.
    window.event(egui::Event::PointerMoved(line[0].center()));
    window.run_steps(60);
    assert_eq!(times(&window).len(), 2);
    assert_eq!(window.state().first_picture(), after);
}
