//! Sessions, and undo and redo, as a user meets them.

use crate::app::drop_file;
use crate::harness::{
    Window, app, bare, click, in_picture, pointer, press, run_command, say, settle, wait, write,
};
use egui::{Event, Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable as _;
use hitscope::app::App;
use hitscope::overlay::wireframe::WIREFRAME;
use hitscope::session::{Session, Sight};
use hitscope_lab::commands::CameraArgs;
use std::path::Path;
use tempfile::TempDir;

/// A triangle that covers the middle of the first picture.
const MESH: &str = "v -1 -1 0\nv 1 -1 0\nv 0 1 0.25\nf 1 2 3\n";

/// The window with a mesh, once its picture is complete; `None` if the test is skipped.
fn opened() -> Option<(Window, TempDir)> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(&folder, "mesh.obj", MESH);
    let mut window = app(Some(path))?;
    settle(&mut window, "mesh.obj");
    Some((window, folder))
}

fn ctrl(window: &mut Window, key: Key) {
    window.key_press_modifiers(Modifiers::COMMAND, key);
    window.run_steps(3);
}

/// Drags with the primary button.
fn drag(window: &mut Window) {
    let from = in_picture(window, 0.4, 0.5);
    window.event(Event::PointerMoved(from));
    window.step();
    pointer(window, from, PointerButton::Primary, true, Modifiers::NONE);
    window.step();
    for step in 1..=5 {
        let at = from + egui::vec2(12.0 * step as f32, 5.0 * step as f32);
        window.event(Event::PointerMoved(at));
        window.step();
    }
    let end = from + egui::vec2(60.0, 25.0);
    pointer(window, end, PointerButton::Primary, false, Modifiers::NONE);
    window.run_steps(3);
}

/// Picks a pixel in the middle of the picture.
fn pick(window: &mut Window) {
    let at = in_picture(window, 0.5, 0.5);
    click(window, at);
    wait(window, "the pick", |app| app.inspection().is_some());
    window.run_steps(2);
}

/// Saves the session under the suggested name; `None` if this machine has a file dialog.
fn save(window: &mut Window, path: &Path) -> Option<()> {
    ctrl(window, Key::S);
    for _ in 0..400 {
        window.step();
        if window.query_by_label("Path").is_some() {
            let button = window.get_all_by_label("Save").last();
            button.expect("in the dialog").click();
            let text = path.to_str().expect("UTF-8").to_owned();
            wait(window, "the file", |app| {
                app.toasts().iter().any(|toast| toast.contains(&text))
            });
            return Some(());
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    say("SKIPPED: this machine has a file dialog");
    None
}

/// Changes the camera, the view, an overlay and the pick.
fn change_everything(window: &mut Window) {
    press(window, Key::Num7);
    press(window, Key::Num5);
    press(window, Key::W);
    press(window, Key::S);
    press(window, Key::Escape);
    assert!(window.state().inspection().is_none());
}

#[test]
fn a_saved_session_brings_everything_back_to_the_last_bit() {
    let Some((mut window, folder)) = opened() else {
        return;
    };
    drag(&mut window);
    press(&mut window, Key::W);
    pick(&mut window);
    settle(&mut window, "mesh.obj");
    let before = window.state().sight();
    let turntable = *window.state().turntable();
    let inspection = window.state().inspection().map(|found| found.to_json());
    let path = folder.path().join("mesh.hitscope");
    let Some(()) = save(&mut window, &path) else {
        return;
    };
    let text = std::fs::read_to_string(&path).expect("a session");
    assert!(text.contains("\"file\": \"mesh.obj\""), "{text}");
    change_everything(&mut window);
    assert_ne!(window.state().sight(), before);
    // With the file open, and from another file.
    let other = write(&folder, "other.obj", "v 5 0 0\nv 9 0 0\nv 5 3 0\nf 1 2 3\n");
    for is_away in [false, true] {
        if is_away {
            drop_file(&mut window, other.clone());
            settle(&mut window, "other.obj");
            press(&mut window, Key::W);
        }
        drop_file(&mut window, path.clone());
        wait(&mut window, "the session", |app| {
            app.document().name() == "mesh.obj" && app.inspection().is_some()
        });
        settle(&mut window, "mesh.obj");
        let app = window.state();
        assert_eq!(app.notice(), None);
        assert_eq!(*app.turntable(), turntable);
        let mut sight = app.sight();
        // The session keeps the view and the kernel by name.
        sight.settings.session_kernel = None;
        assert_eq!(sight, before);
        // Inspected again when the final tree is there.
        wait(&mut window, "the same inspection", |app| {
            app.inspection().map(|found| found.to_json()) == inspection
        });
    }
}

#[test]
fn a_session_opens_with_the_window_and_names_a_file_that_is_missing() {
    let Some((mut window, folder)) = opened() else {
        return;
    };
    drag(&mut window);
    let turntable = *window.state().turntable();
    let path = folder.path().join("mesh.hitscope");
    let Some(()) = save(&mut window, &path) else {
        return;
    };
    drop(window);
    let Some(mut window) = app(Some(path.clone())) else {
        return;
    };
    settle(&mut window, "mesh.obj");
    assert_eq!(*window.state().turntable(), turntable);
    let before = window.state().sight();
    let text = std::fs::read_to_string(&path).expect("a session");
    std::fs::write(&path, text.replace("mesh.obj", "gone.obj")).expect("written");
    drop_file(&mut window, path);
    wait(&mut window, "the error", |app| app.notice().is_some());
    let notice = window.state().notice().expect("an error");
    assert!(notice.contains("gone.obj"), "{notice}");
    assert_eq!(window.state().sight(), before);
}

#[test]
fn a_broken_session_gives_one_error_with_its_line_and_changes_nothing() {
    let Some((mut window, folder)) = opened() else {
        return;
    };
    pick(&mut window);
    let before = window.state().sight();
    let path = write(
        &folder,
        "bad.hitscope",
        "{\n\"hitscope\": 1,\n\"sight\": 3\n}",
    );
    drop_file(&mut window, path);
    wait(&mut window, "the error", |app| app.notice().is_some());
    let notice = window.state().notice().expect("an error");
    assert!(notice.contains("bad.hitscope"), "{notice}");
    assert!(notice.contains("line 3"), "{notice}");
    window.run_steps(5);
    assert_eq!(window.state().sight(), before);
    assert_eq!(window.state().document().name(), "mesh.obj");
    assert!(window.state().inspection().is_some());
}

#[test]
fn undo_and_redo_bring_back_orbit_view_overlay_and_pick() {
    let Some(mut window) = bare() else { return };
    ctrl(&mut window, Key::Z);
    assert_eq!(window.state().notice(), Some("Nothing to undo"));
    press(&mut window, Key::Escape);
    let mut states: Vec<Sight> = vec![window.state().sight()];
    let changes: [fn(&mut Window); 5] = [
        drag,
        |window| press(window, Key::Num3),
        |window| press(window, Key::W),
        drag,
        pick,
    ];
    for change in changes {
        change(&mut window);
        // Longer than a double click.
        window.run_steps(40);
        states.push(window.state().sight());
    }
    assert!(states.windows(2).all(|pair| pair[0] != pair[1]));
    assert!(window.state().settings().overlays.is_on(&WIREFRAME));
    for expected in states.iter().rev().skip(1) {
        ctrl(&mut window, Key::Z);
        assert_eq!(window.state().sight(), *expected);
    }
    assert!(window.state().inspection().is_none());
    for expected in &states[1..] {
        ctrl(&mut window, Key::Y);
        assert_eq!(window.state().sight(), *expected);
    }
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    ctrl(&mut window, Key::Z);
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    window.run_steps(3);
    assert_eq!(Some(&window.state().sight()), states.last());
    ctrl(&mut window, Key::Y);
    assert_eq!(window.state().notice(), Some("Nothing to redo"));
}

#[test]
fn a_view_that_is_reached_by_a_movement_is_one_step() {
    let Some(mut window) = bare() else { return };
    run_command(&mut window, "Reduced motion");
    assert!(!window.state().preferences().navigation.reduces_motion);
    let mut states: Vec<Sight> = vec![window.state().sight()];
    for key in [Key::Num9, Key::Num3, Key::Num7] {
        press(&mut window, key);
        // The movement takes 15 steps.
        window.run_steps(30);
        states.push(window.state().sight());
    }
    for expected in states.iter().rev().skip(1) {
        ctrl(&mut window, Key::Z);
        assert_eq!(window.state().sight(), *expected);
    }
    assert_eq!(window.state().notice(), None);
}

#[test]
fn another_file_clears_the_steps_and_a_reload_keeps_them() {
    let Some((mut window, folder)) = opened() else {
        return;
    };
    let first = window.state().sight();
    press(&mut window, Key::Num3);
    press(&mut window, Key::F5);
    settle(&mut window, "mesh.obj");
    ctrl(&mut window, Key::Z);
    assert_eq!(window.state().sight(), first);
    let other = write(&folder, "other.obj", MESH);
    drop_file(&mut window, other);
    wait(&mut window, "the file", |app| {
        app.document().name() == "other.obj" && App::is_settled(app)
    });
    window.run_steps(2);
    ctrl(&mut window, Key::Z);
    assert_eq!(window.state().notice(), Some("Nothing to undo"));
}

#[test]
fn a_session_that_cannot_be_opened_is_named_with_a_way_out() {
    let Some((mut window, folder)) = opened() else {
        return;
    };
    let session = Session::new(
        Some(folder.path().join("gone.obj")),
        window.state().sight(),
        true,
        window.state().preferences().tab,
    );
    let path = folder.path().join("a.hitscope");
    let text = session.text_at(&path).expect("UTF-8");
    write(&folder, "a.hitscope", &text);
    write(&folder, "empty.hitscope", "");
    for (name, way_out) in [
        ("a.hitscope", "put it back"),
        ("empty.hitscope", "save the session again"),
    ] {
        drop_file(&mut window, folder.path().join(name));
        let is_told = |app: &App| app.notice().is_some_and(|notice| notice.contains(name));
        wait(&mut window, name, is_told);
        let notice = window.state().notice().expect("an error");
        assert!(notice.contains(way_out), "{notice}");
        assert_eq!(window.state().document().name(), "mesh.obj");
    }
}

#[test]
fn the_command_line_takes_the_camera_of_a_session_to_the_last_bit() {
    let Some((mut window, folder)) = opened() else {
        return;
    };
    drag(&mut window);
    let path = folder.path().join("mesh.hitscope");
    let app = window.state();
    let file = Some(folder.path().join("mesh.obj"));
    let session = Session::new(file, app.sight(), true, app.preferences().tab);
    let text = session.text_at(&path).expect("UTF-8");
    std::fs::write(&path, text).expect("written");
    let size = glam::UVec2::new(160, 90);
    let args = CameraArgs {
        size: Some(size),
        session: Some(path),
        ..CameraArgs::default()
    };
    args.check().expect("a session");
    let scene = &app.document().loaded.scene;
    let camera = args.camera(scene, None).expect("a camera");
    assert_eq!(camera, app.turntable().camera(size));
    let args = CameraArgs {
        session: Some(folder.path().join("mesh.obj")),
        ..CameraArgs::default()
    };
    let error = args.check().expect_err("not a session").to_string();
    assert!(error.contains("not a readable session"), "{error}");
}
