//! Pictures of any size, rendered from the dialog.

use crate::alone::{alone, memory_below, memory_mb};
use crate::harness::{Window, app_started, press, wait, write};
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use hitscope::app::{App, StartOptions};
use std::cell::Cell;
use std::path::Path;

/// A tilted square in front of the background.
const MESH: &str = "v -1 -1 0\nv 1 -1 0.5\nv 1 1 0\nv -1 1 0.25\nf 1 2 3 4\n";

/// The window with a mesh, the wireframe on and the dialog open; `None` if the test is skipped.
fn with_dialog(file: &Path, strip_bytes: Option<u64>) -> Option<Window> {
    let default = StartOptions::default();
    let mut window = app_started(StartOptions {
        file: Some(file.to_owned()),
        strip_bytes: strip_bytes.unwrap_or(default.strip_bytes),
        ..default
    })?;
    window.get_by_label("Draft").click();
    window.run_steps(2);
    press(&mut window, Key::W);
    wait(&mut window, "the picture", App::is_settled);
    window.key_press_modifiers(Modifiers::COMMAND, Key::F12);
    window.run_steps(4);
    Some(window)
}

fn click(window: &mut Window, label: &str) {
    window.get_by_label(label).click();
    window.run_steps(3);
}

/// Renders the picture and reads the file.
fn rendered(window: &mut Window, path: &Path) -> Vec<u8> {
    click(window, "Render");
    let text = format!("Saved {}", path.display());
    wait(window, "the file", |app| {
        app.toasts().contains(&text.as_str())
    });
    window.run_steps(2);
    std::fs::read(path).expect("saved")
}

#[test]
fn a_picture_in_strips_is_the_picture_rendered_whole() {
    let pictures = [None, Some(0)].map(|strip_bytes| {
        let folder = tempfile::tempdir().expect("a folder");
        let mesh = write(&folder, "mesh.obj", MESH);
        let mut window = with_dialog(&mesh, strip_bytes)?;
        click(&mut window, "Size of the window's picture");
        let opaque = rendered(&mut window, &folder.path().join("mesh-1.png"));
        click(&mut window, "Transparent background");
        let transparent = rendered(&mut window, &folder.path().join("mesh-2.png"));
        assert!(opaque != transparent);
        Some([opaque, transparent])
    });
    let [Some(whole), Some(strips)] = pictures else {
        return;
    };
    assert!(strips == whole);
}

/// Sets a number in the dialog.
fn enter(window: &mut Window, label: &str, number: u32) {
    let fields = window.get_all_by_role_and_label(Role::SpinButton, label);
    let field = fields.last().expect("in the dialog");
    field.set_value_accesskit(number.into());
    window.run_steps(3);
}

#[test]
fn the_largest_picture_needs_little_memory_which_cancel_frees() {
    let name = "picture_dialog::the_largest_picture_needs_little_memory_which_cancel_frees";
    alone(name, |folder| {
        let mesh = folder.join("mesh.obj");
        std::fs::write(&mesh, MESH).expect("written");
        let Some(mut window) = with_dialog(&mesh, None) else {
            return;
        };
        for label in ["Width", "Height"] {
            enter(&mut window, label, 16384);
        }
        // A picture that is rendered whole exceeds the limit.
        click(&mut window, "EXR");
        click(&mut window, "Render");
        let notice = window.state().notice().expect("refused").to_owned();
        let expected = "a picture of 16384x16384 pixels takes 26880 MB; the limit is 8192 MB";
        assert!(notice.contains(expected), "{notice}");
        assert_eq!(window.state().rendered_part(), None);
        // Closes the dialog and the message.
        press(&mut window, Key::Escape);
        press(&mut window, Key::Escape);
        assert_eq!(window.state().notice(), None);
        window.key_press_modifiers(Modifiers::COMMAND, Key::F12);
        window.run_steps(4);
        enter(&mut window, "Samples", 1);
        click(&mut window, "PNG");
        click(&mut window, "Include overlay");

        let before = memory_mb().unwrap_or(0.0);
        click(&mut window, "Render");
        let most = Cell::new(before);
        wait(&mut window, "two strips", |app| {
            most.set(most.get().max(memory_mb().unwrap_or(0.0)));
            app.rendered_part().is_some_and(|part| part > 0.02)
        });
        let most = most.get();
        assert!(most - before < 600.0, "{before} MB before, {most} MB");
        // After the dialog is closed, the window shows the progress and, after a second, a Cancel button.
        press(&mut window, Key::Escape);
        while window.query_by_label("Cancel").is_none() {
            std::thread::sleep(std::time::Duration::from_millis(20));
            window.step();
        }
        let threads = thread_count();
        window.get_by_label_contains("Rendering a picture");
        click(&mut window, "Cancel");
        assert_eq!(window.state().rendered_part(), None);
        let after = memory_below(before + 100.0);
        assert!(after < before + 100.0, "{before} MB before, {after} MB");
        wait(&mut window, "the end of the threads", |_| {
            thread_count().is_none() || thread_count() < threads
        });
        assert!(!folder.join("mesh-1.png").exists());
    });
}

/// The number of threads of this process; `None` where the system doesn't tell.
fn thread_count() -> Option<usize> {
    Some(std::fs::read_dir("/proc/self/task").ok()?.count())
}
