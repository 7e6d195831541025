//! The menu *Help*: finding commands, and facts about the program.

use super::keys::{ctrl, ctrl_shift, key};
use super::{Command, Menu, Place, none};
use crate::app::Sheet;
use egui::Key;

const FIND: Place = Place::new(Menu::Help, 0);
const ABOUT: Place = Place::new(Menu::Help, 1);

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "palette",
        keys: &[ctrl_shift(Key::P), ctrl(Key::P)],
        title: "Command palette",
        tooltip: "Finds a command by a part of its title",
        place: FIND,
        is_on: None,
        obstacle: none,
        run: |app, ctx, _| {
            egui::Popup::close_all(ctx);
            app.shown.palette.open();
        },
    },
    Command {
        name: "help",
        keys: &[key(Key::H), key(Key::Questionmark)],
        title: "Keyboard and mouse",
        tooltip: "Lists all keys and the uses of the mouse",
        place: FIND,
        is_on: None,
        obstacle: none,
        run: |app, _, _| app.toggle_sheet(Sheet::Help),
    },
    Command {
        name: "about",
        keys: &[],
        title: "About hitscope",
        tooltip: "Shows the version, the graphics adapter and what else a report of an error needs",
        place: ABOUT,
        is_on: None,
        obstacle: none,
        run: |app, _, _| app.toggle_sheet(Sheet::About),
    },
];
