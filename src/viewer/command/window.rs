//! The menu *Window*: its parts, colours and size of text.

use super::keys::{ctrl, ctrl_shift, key};
use super::{Command, Entry, Menu, Place, none};
use crate::app::{App, Sheet};
use crate::tab::Tab;
use egui::{Key, ThemePreference, gui_zoom};

const PANEL: Place = Place::new(Menu::Window, 0);
/// The tabs of the side panel.
pub const TABS: Place = Place::submenu(Menu::Window, 0, "Tab");
/// The themes.
pub const THEMES: Place = Place::submenu(Menu::Window, 1, "Theme");
const SCALE: Place = Place::new(Menu::Window, 2);

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "panel",
        keys: &[key(Key::I)],
        title: "Side panel",
        tooltip: "Shows the panel with the inspected pixel, the display options and the mesh",
        place: PANEL,
        is_on: Some(|app| app.preferences.shows_panel),
        obstacle: none,
        run: |app, _, _| app.preferences.shows_panel ^= true,
    },
    Command {
        name: "log",
        keys: &[ctrl_shift(Key::L)],
        title: "Log",
        tooltip: "Lists all messages since the start",
        place: PANEL,
        is_on: None,
        obstacle: none,
        run: |app, _, _| app.toggle_sheet(Sheet::Log),
    },
    Command {
        name: "larger",
        keys: &[ctrl(Key::Plus), ctrl(Key::Equals)],
        title: "Larger text",
        tooltip: "Enlarges the user interface, but not the picture",
        place: SCALE,
        is_on: None,
        obstacle: none,
        run: |_, ctx, _| gui_zoom::zoom_in(ctx),
    },
    Command {
        name: "smaller",
        keys: &[ctrl(Key::Minus)],
        title: "Smaller text",
        tooltip: "Shrinks the user interface, but not the picture",
        place: SCALE,
        is_on: None,
        obstacle: none,
        run: |_, ctx, _| gui_zoom::zoom_out(ctx),
    },
    Command {
        name: "usual-size",
        keys: &[ctrl(Key::Num0)],
        title: "Usual size",
        tooltip: "Shows the user interface in its usual size",
        place: SCALE,
        is_on: None,
        obstacle: none,
        run: |_, ctx, _| ctx.set_zoom_factor(1.0),
    },
];

/// The tabs of the side panel.
pub(super) fn tabs(app: &App) -> Vec<Entry> {
    let entry = |tab: Tab| {
        let is_chosen = app.preferences.tab == tab;
        let choose = move |app: &mut App, _: &egui::Context| {
            app.preferences.tab = tab;
            app.preferences.shows_panel = true;
        };
        Entry::choice(TABS, tab.title(), tab.about(), is_chosen, choose)
    };
    Tab::ALL.into_iter().map(entry).collect()
}

/// The themes.
pub(super) fn themes(app: &App) -> Vec<Entry> {
    let entry = |(theme, title, tooltip): (ThemePreference, &'static str, &'static str)| {
        let is_chosen = app.preferences.theme == theme;
        let choose = move |app: &mut App, ctx: &egui::Context| {
            app.preferences.theme = theme;
            ctx.set_theme(theme);
        };
        Entry::choice(THEMES, title, tooltip, is_chosen, choose)
    };
    let themes = [
        (ThemePreference::Dark, "Dark", "Light text on dark panels"),
        (ThemePreference::Light, "Light", "Dark text on light panels"),
        (
            ThemePreference::System,
            "System",
            "The theme of the desktop",
        ),
    ];
    themes.into_iter().map(entry).collect()
}
