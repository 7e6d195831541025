//! The list of picks in undo and in sessions.

use crate::app::drop_file;
use crate::harness::{Window, press, wait};
use crate::inspecting::{add_pick, has, pick, pixels_on_triangles, ready, wait_for_label};
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable as _;
use glam::UVec2;
use hitscope::picks::Snapping;
use hitscope::session::Session;

fn undo(window: &mut Window) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(4);
}

fn click(window: &mut Window, label: &str) {
    window.get_by_label(label).scroll_to_me();
    window.run_steps(20);
    window.get_by_label(label).click();
    window.run_steps(4);
}

/// Types a name for the second pick, letter by letter.
fn name_second(window: &mut Window, name: &str) {
    click(window, "Name of pick 2");
    for letter in name.chars() {
        let field = window.get_by_label("Name of pick 2");
        field.type_text(&letter.to_string());
        window.run_steps(2);
    }
}

/// Three picks: the first one pinned, the second one named and inspected. Returns the second one's pixel.
fn with_picks(window: &mut Window) -> UVec2 {
    let pixels = pixels_on_triangles(window, 3);
    pick(window, pixels[0]);
    add_pick(window, pixels[1]);
    add_pick(window, pixels[2]);
    name_second(window, "tip");
    click(window, "Pin 1");
    click(window, "Pick 2");
    wait_for_pick(window, pixels[1]);
    pixels[1]
}

fn wait_for_pick(window: &mut Window, pixel: UVec2) {
    wait(window, "the pick", |app| {
        let found = app.inspection();
        found.is_some_and(|found| found.pixel == pixel.to_array())
    });
    window.run_steps(4);
}

/// Waits until the three picks are traced and measured.
fn wait_for_all(window: &mut Window, table: &str) {
    wait(window, "the hits", |app| app.picks_as_csv() == table);
    window.run_steps(4);
    for label in ["#1", "#2 tip", "#3", "distance 1 to 2", "circle 1, 2, 3"] {
        wait_for_label(window, label);
    }
    assert!(has(window, "Pick 1") && has(window, "Pick 2") && has(window, "Pick 3"));
}

#[test]
fn undo_brings_back_removed_picks_with_names_pins_and_measurements() {
    let Some(mut window) = ready() else { return };
    let pixel = with_picks(&mut window);
    let (before, table) = (window.state().sight(), window.state().picks_as_csv());
    assert!(table.contains(",2,tip,"), "{table}");
    wait_for_all(&mut window, &table);

    press(&mut window, Key::Delete);
    assert!(window.state().inspection().is_none() && !has(&window, "Pick 1"));
    undo(&mut window);
    assert_eq!(window.state().sight(), before);
    wait_for_pick(&mut window, pixel);
    wait_for_all(&mut window, &table);

    // Esc keeps pinned picks.
    press(&mut window, Key::Escape);
    assert_eq!(window.state().sight().picks.len(), 1);
    undo(&mut window);
    assert_eq!(window.state().sight(), before);
    wait_for_pick(&mut window, pixel);
    wait_for_all(&mut window, &table);

    click(&mut window, "Remove 3");
    assert!(!has(&window, "Pick 3"));
    undo(&mut window);
    assert_eq!(window.state().sight(), before);
    assert!(window.state().inspection().is_some(), "still inspected");
    wait_for_all(&mut window, &table);
    press(&mut window, Key::Delete);
    assert_eq!(window.state().notice(), None);
}

#[test]
fn selecting_pinning_and_a_whole_name_are_a_step_each() {
    let Some(mut window) = ready() else { return };
    with_picks(&mut window);
    let state = |window: &Window| {
        let picks = window.state().sight().picks;
        let selected = picks.iter().find(|pick| pick.is_selected);
        let named = picks.iter().filter(|pick| !pick.name.is_empty()).count();
        let pinned = picks.iter().filter(|pick| pick.is_pinned).count();
        (picks.len(), selected.map(|pick| pick.number), named, pinned)
    };
    assert_eq!(state(&window), (3, Some(2), 1, 1));
    for expected in [
        (3, Some(3), 1, 1),
        (3, Some(3), 1, 0),
        (3, Some(3), 0, 0),
        (2, Some(2), 0, 0),
        (1, Some(1), 0, 0),
        (0, None, 0, 0),
    ] {
        undo(&mut window);
        assert_eq!(state(&window), expected);
    }
}

#[test]
fn a_session_holds_all_picks_and_traces_them_again() {
    let Some(mut window) = ready() else { return };
    let pixel = with_picks(&mut window);
    click(&mut window, "Vertex");
    assert_eq!(window.state().snapping(), Snapping::Vertex);
    wait(&mut window, "snapped points", |app| {
        app.picks_as_csv().matches(",vertex,").count() == 3
    });
    let app = window.state();
    let (before, table) = (app.sight(), app.picks_as_csv());
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picks.hitscope");
    let session = Session::new(None, before.clone(), true, app.preferences().tab);
    let text = session.text_at(&path).expect("UTF-8");
    std::fs::write(&path, text).expect("written");

    click(&mut window, "Edge");
    press(&mut window, Key::Delete);
    assert!(window.state().inspection().is_none());
    drop_file(&mut window, path);
    wait_for_pick(&mut window, pixel);
    assert_eq!(window.state().notice(), None);
    assert_eq!(window.state().sight().picks, before.picks);
    assert_eq!(window.state().snapping(), Snapping::Vertex);
    wait_for_all(&mut window, &table);
}
