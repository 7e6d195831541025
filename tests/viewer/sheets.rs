//! Tests of the sizes and places of the tool bar, the palette, the help sheet and dialogs.

use crate::harness::{Window, bare, press, run_command};
use egui::accesskit::Role;
use egui::{Event, Id, Key, Modifiers, Rect};
use egui_kittest::kittest::Queryable as _;

/// The height of the palette.
fn palette_height(window: &Window) -> f32 {
    let rect: Option<Rect> = window
        .ctx
        .memory(|memory| memory.area_rect(Id::unique("palette")));
    rect.expect("it was open").height()
}

#[test]
fn the_palette_is_as_high_as_before_after_a_search_with_few_results() {
    let Some(mut window) = bare() else { return };
    let open = |window: &mut Window| {
        window.key_press_modifiers(Modifiers::COMMAND, Key::P);
        window.run_steps(5);
    };
    open(&mut window);
    let full = palette_height(&window);
    assert!(full > 300.0, "{full}");
    window.event(Event::Text("compare with a file".to_owned()));
    window.run_steps(5);
    let few = palette_height(&window);
    assert!(few < 0.6 * full, "{few} {full}");
    press(&mut window, Key::Escape);
    window.run_steps(4);
    open(&mut window);
    let again = palette_height(&window);
    assert!((again - full).abs() < 2.0, "{again} {full}");
}

#[test]
fn the_tool_bar_has_one_row_in_a_window_of_800_points() {
    let Some(window) = bare() else { return };
    let row = |title: &str| window.get_by_role_and_label(Role::Button, title).rect();
    let (first, last) = (row("Open…"), row("Side panel"));
    assert!((first.center().y - last.center().y).abs() < 2.0, "{last}");
    assert!(last.right() <= 800.0, "{last}");
}

#[test]
fn long_lines_of_the_help_sheet_wrap() {
    let Some(mut window) = bare() else { return };
    press(&mut window, Key::H);
    window.run_steps(6);
    let (mouse, keys) = (
        "Fly: ahead, left",
        "Rotate the environment, if it is a picture",
    );
    for text in [mouse, keys] {
        let rect = window.get_by_label_contains(text).rect();
        assert!(rect.left() > 0.0 && rect.right() < 800.0, "{text}: {rect}");
    }
}

#[test]
fn the_dialog_of_pictures_opens_over_the_middle_of_the_window() {
    let Some(mut window) = bare() else { return };
    window.key_press_modifiers(Modifiers::COMMAND, Key::F12);
    window.run_steps(6);
    let rect = window.get_by_role_and_label(Role::Button, "Render").rect();
    let title = window.query_all_by_label("Render a picture").next();
    let title = title.expect("the dialog").rect();
    let middle = window.ctx.content_rect().center();
    assert!((title.center().x - middle.x).abs() < 60.0, "{title}");
    let height = 0.5 * (title.top() + rect.bottom());
    assert!((height - middle.y).abs() < 40.0, "{title} {rect}");
}

#[test]
fn going_to_an_element_again_replaces_the_last_text() {
    let Some(mut window) = bare() else { return };
    let open = |window: &mut Window| {
        window.key_press_modifiers(Modifiers::COMMAND, Key::G);
        window.run_steps(4);
    };
    open(&mut window);
    window.event(Event::Text("nothing".to_owned()));
    window.run_steps(3);
    press(&mut window, Key::Escape);
    open(&mut window);
    window.event(Event::Text("zzz".to_owned()));
    window.run_steps(3);
    press(&mut window, Key::Enter);
    window.run_steps(3);
    let refused = window.query_by_label_contains("“zzz” is no element");
    assert!(refused.is_some(), "the old text was kept");
}

#[test]
fn the_status_line_tells_the_magnification_so_that_no_pixel_is_covered() {
    let Some(mut window) = bare() else { return };
    run_command(&mut window, "magnify");
    window.run_steps(3);
    assert!(window.state().magnification() > 1.0);
    let text = window.get_by_label_contains("Esc shows the whole picture");
    let picture = window.get_by_label("Rendered picture").rect();
    assert!(text.rect().top() >= picture.bottom() - 1.0);
}
