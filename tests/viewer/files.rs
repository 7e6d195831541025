//! Tests of recent files, and of the files beside the open one.

use crate::app::drop_file;
use crate::commands::open_menu;
use crate::harness::{Window, app, wait, write};
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn wait_for(window: &mut Window, name: &str) {
    wait(window, name, |app| app.document().name() == name);
    window.run_steps(2);
}

/// Clicks on a file in File > Open recent.
fn open_recent(window: &mut Window, name: &str) {
    open_menu(window, "File");
    window
        .get_by_role_and_label(Role::Button, "Open recent")
        .click();
    window.run_steps(4);
    window.get_by_role_and_label(Role::MenuItem, name).click();
    window.run_steps(4);
}

#[test]
fn recent_files_open_again_and_a_missing_one_is_removed_with_a_message() {
    let folder = tempfile::tempdir().expect("a folder");
    let [one, two] = ["one.obj", "two.obj"].map(|name| write(&folder, name, TRIANGLE));
    let Some(mut window) = app(Some(one.clone())) else {
        return;
    };
    wait_for(&mut window, "one.obj");
    drop_file(&mut window, two.clone());
    wait_for(&mut window, "two.obj");
    let recent = |window: &Window| window.state().preferences().recent.paths().to_vec();
    assert_eq!(recent(&window), [two.clone(), one.clone()]);
    open_recent(&mut window, "one.obj");
    wait_for(&mut window, "one.obj");
    assert_eq!(recent(&window), [one.clone(), two.clone()]);
    std::fs::remove_file(&two).expect("removed");
    open_recent(&mut window, "two.obj");
    wait(&mut window, "the message", |app| app.notice().is_some());
    let notice = window.state().notice().expect("a message");
    assert!(notice.contains("two.obj: "), "{notice}");
    assert!(notice.contains("no longer listed"), "{notice}");
    assert_eq!(recent(&window), [one]);
    assert_eq!(window.state().document().name(), "one.obj");
}

#[test]
fn ctrl_right_and_ctrl_left_open_the_files_of_the_folder_in_natural_order() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = write(&folder, "m2.obj", TRIANGLE);
    write(&folder, "m10.obj", TRIANGLE);
    std::fs::write(folder.path().join("m9.txt"), "").expect("written");
    let scene = r#"<scene version="3.0.0"><shape type="sphere"/></scene>"#;
    std::fs::write(folder.path().join("m3.xml"), scene).expect("written");
    let Some(mut window) = app(Some(first)) else {
        return;
    };
    wait_for(&mut window, "m2.obj");
    // One that can't be loaded is left behind.
    let bad = folder.path().join("m2a.obj");
    std::fs::write(&bad, "v 0 0 0\nf 1 2 9\n").expect("written");
    window.key_press_modifiers(Modifiers::COMMAND, Key::ArrowRight);
    wait(&mut window, "the error", |app| app.notice().is_some());
    assert_eq!(window.state().document().name(), "m2.obj");
    window.key_press_modifiers(Modifiers::COMMAND, Key::ArrowRight);
    wait_for(&mut window, "m3.xml");
    std::fs::remove_file(&bad).expect("removed");
    window.key_press_modifiers(Modifiers::COMMAND, Key::ArrowLeft);
    wait_for(&mut window, "m2.obj");
    for (key, name) in [
        (Key::ArrowRight, "m3.xml"),
        (Key::ArrowRight, "m10.obj"),
        (Key::ArrowRight, "m2.obj"),
        (Key::ArrowLeft, "m10.obj"),
        (Key::ArrowLeft, "m3.xml"),
    ] {
        window.key_press_modifiers(Modifiers::COMMAND, key);
        wait_for(&mut window, name);
    }
}

#[test]
fn a_file_alone_in_its_folder_gives_a_message() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some(mut window) = app(Some(write(&folder, "one.obj", TRIANGLE))) else {
        return;
    };
    wait_for(&mut window, "one.obj");
    window.key_press_modifiers(Modifiers::COMMAND, Key::ArrowRight);
    wait(&mut window, "the message", |app| !app.toasts().is_empty());
    let toasts = window.state().toasts();
    assert!(toasts[0].contains("no other mesh"), "{toasts:?}");
    assert_eq!(window.state().document().name(), "one.obj");
}
