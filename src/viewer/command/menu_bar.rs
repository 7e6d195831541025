//! The menu bar: every command, with its key at the right.

use super::{Commands, Entry, Menu, Place};
use crate::theme::panel_frame;
use egui::scroll_area::ScrollBarVisibility;
use egui::{Margin, MenuBar, Panel, ScrollArea, TextWrapMode};

/// Width of the narrowest menu in points.
const MIN_WIDTH: f32 = 150.0;
/// Height in points of the window that a menu leaves free: the menu bar, and the menu's margins.
const RESERVED_HEIGHT: f32 = 60.0;
/// Height of the lowest menu in points; a higher one scrolls.
const MIN_HEIGHT: f32 = 80.0;

/// Shows the menu bar.
pub fn menu_bar_ui(ui: &mut egui::Ui, commands: &Commands) {
    let frame = panel_frame(ui.style()).inner_margin(Margin::symmetric(6, 1));
    Panel::top("menu bar").frame(frame).show(ui, |ui| {
        // A narrow window scrolls the menu bar; a scroll bar would cover it.
        ScrollArea::horizontal()
            .scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden)
            .show(ui, |ui| {
                MenuBar::new().ui(ui, |ui| {
                    for menu in Menu::ALL {
                        ui.menu_button(menu.title(), |ui| menu_ui(ui, menu, commands));
                    }
                });
            });
    });
}

/// Shows the commands of a menu by section, with lines between the sections.
fn menu_ui(ui: &mut egui::Ui, menu: Menu, commands: &Commands) {
    let mut entries: Vec<&Entry> = commands.of_menu(menu).collect();
    entries.sort_by_key(|entry| entry.place.section);
    list_ui(ui, |ui| {
        let mut last = None;
        for entry in entries {
            let place = entry.place;
            if last.is_some_and(|last: Place| last.section != place.section) {
                ui.separator();
            }
            match place.submenu {
                None => commands.menu_row_ui(ui, entry),
                // The submenu is shown once, for the first of its entries.
                Some(_) if last == Some(place) => {}
                Some(title) => _ = ui.menu_button(title, |ui| submenu_ui(ui, place, commands)),
            }
            last = Some(place);
        }
    });
}

fn submenu_ui(ui: &mut egui::Ui, place: Place, commands: &Commands) {
    list_ui(ui, |ui| {
        for entry in commands.at(place) {
            commands.menu_row_ui(ui, entry);
        }
    });
}

/// Shows the rows of a menu, which scroll in a low window.
fn list_ui(ui: &mut egui::Ui, rows: impl FnOnce(&mut egui::Ui)) {
    let height = (ui.ctx().content_rect().height() - RESERVED_HEIGHT).max(MIN_HEIGHT);
    ui.set_min_width(MIN_WIDTH);
    ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
    ScrollArea::vertical()
        .max_height(height)
        // Else a popup offers less than the window has.
        .min_scrolled_height(height)
        .show(ui, rows);
}
