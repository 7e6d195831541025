//! Commands: the table of everything that a key, a button or a menu entry does.
//!
//! | file | contents |
//! |---|---|
//! | this file | the type of a row, and the list of all rows |
//! | `file`, `edit`, `view`, `camera`, `pick`, `window`, `help` | the rows, one file per menu |
//! | `clip`, `colours`, `part`, `compare` | further rows of the menus *View* and *Pick* |
//! | `place` | menus, and the places of commands in them |
//! | `entry` | the commands of a frame: rows of the table, and rows made from other tables |
//! | [`keys`] | the keys of commands |
//! | `widget` | buttons and check boxes of commands |
//! | [`menu_bar`], [`tool_bar`] | the menu bar and the tool bar |
//! | [`palette`], `search` | the command palette |
//! | [`help_sheet`] | the list of all keys |
//!
//! A new command is a row in the file of its menu. It then has its keys, its menu entry, its place in the palette and
//! its line in the help sheet. [`tool_bar`] and the panels name the commands that they also show.

mod camera;
mod clip;
mod colours;
mod compare;
mod edit;
mod entry;
mod file;
mod help;
pub mod help_sheet;
pub mod keys;
pub mod menu_bar;
pub mod palette;
mod part;
mod pick;
mod place;
mod search;
pub mod tool_bar;
mod view;
mod widget;
mod window;

pub use compare::COMPARE_MODES;
pub use entry::{Commands, Entry};
pub use pick::SNAPPING;
pub use place::{Menu, Place};
pub use view::{QUALITIES, VIEWS};
pub use window::{TABS, THEMES};

use crate::app::App;
use egui::KeyboardShortcut;

/// A command: a row of the table.
pub struct Command {
    /// The name by which the tool bar and the panels refer to the command.
    pub name: &'static str,
    /// Alternative keys.
    pub keys: &'static [KeyboardShortcut],
    /// The title on buttons, in menus and in the palette.
    pub title: &'static str,
    /// The effect, in a sentence without a full stop. Tooltips append the keys.
    pub tooltip: &'static str,
    /// The place in the menu bar.
    pub place: Place,
    /// Whether the command is on, for one that turns something on and off.
    pub is_on: Option<fn(&App) -> bool>,
    /// Why the command can't be run now; `None` if it can.
    pub obstacle: fn(&App) -> Option<&'static str>,
    /// Runs the command.
    pub run: fn(&mut App, &egui::Context, &eframe::Frame),
}

/// All commands, in the order of the menus.
pub static COMMANDS: &[&[Command]] = &[
    file::ROWS,
    edit::ROWS,
    view::ROWS,
    clip::ROWS,
    colours::ROWS,
    part::ROWS,
    view::MAGNIFIER_ROWS,
    compare::ROWS,
    camera::ROWS,
    pick::ROWS,
    clip::PICK_ROWS,
    part::PICK_ROWS,
    window::ROWS,
    help::ROWS,
];

/// Tables other than [`COMMANDS`] whose rows are commands, too.
static OTHER_TABLES: &[fn(&App) -> Vec<Entry>] = &[
    file::recent_files,
    view::views,
    view::overlays,
    view::kernels,
    part::groupings,
    compare::modes,
    compare::sources,
    view::qualities,
    camera::presets,
    pick::snapping,
    window::tabs,
    window::themes,
];

/// All rows of [`COMMANDS`].
pub fn all() -> impl Iterator<Item = &'static Command> {
    COMMANDS.iter().copied().flatten()
}

/// The obstacle of a command that can always be run.
fn none(_: &App) -> Option<&'static str> {
    None
}

/// The obstacle of a command that needs a file.
fn lacks_file(app: &App) -> Option<&'static str> {
    let document = app.document();
    match document.path {
        Some(_) => None,
        None if document.is_blank => Some("No file is open"),
        None => Some("The built-in scene isn't in a file"),
    }
}

/// The obstacle of a command that needs a scene.
fn lacks_scene(app: &App) -> Option<&'static str> {
    app.document().is_blank.then_some("No file is open")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn names_and_titles_are_unique() {
        let mut names = HashSet::new();
        let mut titles = HashSet::new();
        for command in all() {
            assert!(names.insert(command.name), "{}", command.name);
            assert!(titles.insert(command.title), "{}", command.title);
        }
    }

    #[test]
    fn titles_and_tooltips_are_texts_to_which_a_key_can_be_appended() {
        for command in all() {
            let Command {
                name,
                title,
                tooltip,
                ..
            } = command;
            for text in [title, tooltip] {
                assert!(
                    text.starts_with(|c: char| c.is_ascii_uppercase()),
                    "{name}: {text}"
                );
                assert!(!text.ends_with(['.', ' ', ')']), "{name}: {text}");
            }
            assert_ne!(title, tooltip, "{name}");
        }
    }

    #[test]
    fn every_menu_has_a_command_and_lists_its_sections_in_order() {
        for menu in Menu::ALL {
            let sections: Vec<u8> = all()
                .filter(|command| command.place.menu == menu)
                .map(|command| command.place.section)
                .collect();
            assert!(!sections.is_empty(), "{menu:?}");
            assert!(sections.is_sorted(), "{menu:?}: {sections:?}");
        }
    }
}
