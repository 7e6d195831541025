//! Tests of the list of parts: hidden parts across a reload, custom colours, undo and sessions.

use crate::harness::{Window, app_started, click, in_picture, press, settle, wait, write};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable as _;
use hitscope::app::{App, StartOptions};
use hitscope::preferences::Preferences;
use hitscope::settings::Settings;
use hitscope::tab::Tab;

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no left\nf 1 2 3\no right\nf 1 3 4\n";

fn window(file: Option<std::path::PathBuf>) -> Option<Window> {
    app_started(StartOptions {
        file,
        settings: Settings {
            samples: 1,
            ..Settings::default()
        },
        preferences: Preferences {
            tab: Tab::Parts,
            ..Preferences::default()
        },
        ..StartOptions::default()
    })
}

/// Clicks a widget and waits for the picture.
fn click_on(window: &mut Window, label: &str) {
    window.get_by_label(label).click();
    window.run_steps(3);
    wait(window, "the picture", App::is_settled);
}

fn undo(window: &mut Window) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(3);
    wait(window, "the picture", App::is_settled);
}

/// For each primitive whether it is shown; `None` if all are.
fn shown(window: &Window) -> Option<Vec<bool>> {
    let scene = &window.state().document().loaded.scene;
    scene.shown().map(|flags| flags.to_vec())
}

#[test]
fn a_part_shown_alone_stays_alone_after_a_reload_and_undo_shows_the_others() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(&folder, "mesh.obj", MESH);
    let Some(mut window) = window(Some(path)) else {
        return;
    };
    settle(&mut window, "mesh.obj");
    click_on(&mut window, "Show only right");
    assert_eq!(shown(&window), Some(vec![false, true]));
    // The parts change their places, and there is a new one.
    let text =
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no right\nf 1 3 4\no new\nf 1 2 4\no left\nf 1 2 3\n";
    write(&folder, "mesh.obj", text);
    let began = window.state().document().began;
    press(&mut window, Key::F5);
    wait(&mut window, "the reloaded file", |app| {
        app.document().began > began
    });
    settle(&mut window, "mesh.obj");
    assert_eq!(shown(&window), Some(vec![true, false, false]));
    undo(&mut window);
    assert_eq!(shown(&window), None);
    click_on(&mut window, "Show new");
    assert_eq!(shown(&window), Some(vec![true, false, true]));
}

#[test]
fn a_custom_colour_changes_the_pixels_of_its_part_and_undo_removes_it() {
    let Some(mut window) = window(None) else {
        return;
    };
    wait(&mut window, "the picture", App::is_settled);
    let pixels = |window: &Window| window.state().film().pixels().to_vec();
    let before = pixels(&window);
    // The panel of colours has a symbol of egui's that comes from the system's fonts.
    window
        .ctx
        .set_missing_glyph_policy(egui::MissingGlyphPolicy::Tofu);
    window.get_by_label("Colour of knot").click();
    window.run_steps(3);
    let red = window.get_all_by_role(Role::SpinButton).next();
    let red = red.expect("the red of the colour").rect().center();
    let button = |window: &mut Window, at, pressed| {
        let button = PointerButton::Primary;
        crate::harness::pointer(window, at, button, pressed, Modifiers::NONE);
        window.step();
    };
    window.event(Event::PointerMoved(red));
    window.step();
    button(&mut window, red, true);
    for step in 1..=6 {
        window.event(Event::PointerMoved(
            red + egui::vec2(10.0 * step as f32, 0.0),
        ));
        window.step();
    }
    button(&mut window, red + egui::vec2(60.0, 0.0), false);
    press(&mut window, Key::Escape);
    wait(&mut window, "the picture", App::is_settled);
    let own = |window: &Window| window.state().parts().own_colour(1);
    let [r, g, b] = own(&window).expect("a custom colour");
    assert!(r > g && r > b, "{r} {g} {b}");
    assert!(pixels(&window) != before);
    undo(&mut window);
    assert_eq!(own(&window), None);
    assert!(pixels(&window) == before);
}

#[test]
fn hidden_parts_and_custom_colours_are_saved_in_the_session() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(&folder, "mesh.obj", MESH);
    let Some(mut window) = window(Some(path)) else {
        return;
    };
    settle(&mut window, "mesh.obj");
    click_on(&mut window, "Show left");
    let sight = window.state().sight();
    let text = serde_json::to_string(&sight).expect("plain data");
    let read: hitscope::session::Sight = serde_json::from_str(&text).expect("what was written");
    assert_eq!(read, sight);
    assert!(!read.parts.shows_all());
}

#[test]
fn a_click_on_the_picture_leaves_the_list_of_parts_open() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(&folder, "mesh.obj", MESH);
    let Some(mut window) = window(Some(path)) else {
        return;
    };
    settle(&mut window, "mesh.obj");
    let at = in_picture(&window, 0.5, 0.5);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    assert_eq!(window.state().preferences().tab, Tab::Parts);
    window.get_by_label("Search for a part");
}
