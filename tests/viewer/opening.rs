//! Tests of the window before, during and after opening a file.

use crate::harness::{Window, bare, choose_view, gpu, press, shared_setup, wait, write};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use hitscope::app::{App, StartOptions};
use hitscope_core::camera::UpAxis;
use std::path::PathBuf;
use std::time::Duration;

/// A triangle in the plane x = 0.
const FLAT: &str = "v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n";

fn open(window: &mut Window, path: PathBuf, name: &str) {
    crate::app::drop_file(window, path);
    wait(window, name, |app| {
        app.document().name() == name && app.is_settled()
    });
    window.run_steps(2);
}

#[test]
fn a_window_opened_with_a_file_never_shows_the_built_in_scene() {
    let Some(gpu) = gpu() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    for (file, is_good) in [("flat.obj", true), ("none.obj", false)] {
        if is_good {
            write(&folder, file, FLAT);
        }
        let start = StartOptions {
            file: Some(folder.path().join(file)),
            ..StartOptions::default()
        };
        let mut window: Window = egui_kittest::Harness::builder()
            .with_size(egui::vec2(800.0, 600.0))
            .wgpu_setup(shared_setup(gpu))
            .build_eframe(move |cc| App::new(cc, start).expect("the harness has wgpu"));
        for _ in 0..10_000 {
            let app = window.state();
            assert_ne!(app.document().name(), "Built-in scene");
            if app.notice().is_some() || app.document().name() == file {
                break;
            }
            std::thread::sleep(Duration::from_millis(2));
            window.step();
        }
        assert_eq!(window.state().document().is_blank, !is_good, "{file}");
        if !is_good {
            window.run_steps(2);
            window.get_by_label("No file is open. Drop a file here or press Ctrl+O.");
        }
    }
}

#[test]
fn the_old_picture_disappears_as_soon_as_another_file_is_open() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some(mut window) = bare() else { return };
    wait(&mut window, "the built-in scene", App::is_settled);
    // Nothing moves, so that only the new file can request a repaint.
    window.run_steps(60);
    crate::app::drop_file(&mut window, write(&folder, "flat.obj", FLAT));
    wait(&mut window, "the file", |app| {
        app.document().name() == "flat.obj"
    });
    assert!(window.ctx.has_requested_repaint());
    window.step();
    let traced = window.state().traced_scene().expect("a scene is traced");
    assert_eq!(traced.mesh().triangles().len(), 1);
}

#[test]
fn another_file_resets_the_direction_and_reloading_keeps_the_camera() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some(mut window) = bare() else { return };
    let default = *window.state().turntable();
    press(&mut window, Key::Num5);
    press(&mut window, Key::Num3);
    let path = write(&folder, "flat.obj", FLAT);
    open(&mut window, path.clone(), "flat.obj");
    let direction = |window: &Window| {
        let turntable = window.state().turntable();
        (turntable.yaw_radians, turntable.pitch_radians)
    };
    assert_eq!(
        direction(&window),
        (default.yaw_radians, default.pitch_radians)
    );
    assert!(
        window.state().turntable().is_orthographic,
        "independent of the file"
    );
    assert_eq!(window.state().turntable().up_axis, UpAxis::Y);

    press(&mut window, Key::Num7);
    let from_above = direction(&window);
    assert_ne!(from_above, (default.yaw_radians, default.pitch_radians));
    std::fs::write(&path, FLAT.replace("v 0 1 0", "v 0 2 0")).expect("written");
    let old = window.state().document().began;
    press(&mut window, Key::F5);
    wait(&mut window, "the reloaded file", |app| {
        app.document().began > old
    });
    window.run_steps(2);
    assert_eq!(direction(&window), from_above);
}

#[test]
fn a_hint_appears_if_the_mesh_is_not_visible_and_home_frames_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some(mut window) = bare() else { return };
    open(&mut window, write(&folder, "flat.obj", FLAT), "flat.obj");
    assert!(!window.state().shows_nothing());
    // Edge-on: orthographic rays in the triangle's plane.
    press(&mut window, Key::Num5);
    press(&mut window, Key::Num1);
    wait(&mut window, "an empty picture", App::shows_nothing);
    window.run_steps(2);
    window.get_by_label("The mesh isn't visible.");
    press(&mut window, Key::Home);
    wait(&mut window, "the mesh", |app| !app.shows_nothing());
    window.run_steps(2);
    assert!(window.query_by_label("The mesh isn't visible.").is_none());
    // Also in a view whose background isn't plain.
    choose_view(&mut window, "Cost");
    press(&mut window, Key::Num1);
    wait(&mut window, "a view that no ray hits", App::shows_nothing);
}

#[test]
fn the_path_field_appears_even_in_a_slow_window() {
    let Some(mut window) = bare() else { return };
    window.key_press_modifiers(Modifiers::COMMAND, Key::O);
    window.run_steps(2);
    // The window's thread is busy for longer than it takes to find out that there is no dialog.
    std::thread::sleep(Duration::from_millis(600));
    for _ in 0..1000 {
        if window.query_by_label("Path").is_some() {
            return;
        }
        std::thread::sleep(Duration::from_millis(5));
        window.step();
    }
    // If there is a dialog, it stays open, and the second press shows the field.
    window.key_press_modifiers(Modifiers::COMMAND, Key::O);
    window.run_steps(2);
    window.get_by_label("Path");
}
