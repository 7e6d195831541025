//! The menu *Pick*: the picked pixel and its ray.

use super::keys::key;
use super::{Command, Menu, Place};
use crate::app::App;
use egui::Key;

const CROSSINGS: Place = Place::new(Menu::Pick, 0);
const COPY: Place = Place::new(Menu::Pick, 1);

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "next-crossing",
        keys: &[key(Key::CloseBracket)],
        title: "Next crossing",
        tooltip: "Marks the next crossing of the picked ray with a surface",
        place: CROSSINGS,
        is_on: None,
        obstacle: App::lacks_crossing,
        run: |app, _, _| app.step_crossing(1),
    },
    Command {
        name: "previous-crossing",
        keys: &[key(Key::OpenBracket)],
        title: "Previous crossing",
        tooltip: "Marks the previous crossing of the picked ray with a surface",
        place: CROSSINGS,
        is_on: None,
        obstacle: App::lacks_crossing,
        run: |app, _, _| app.step_crossing(-1),
    },
    Command {
        name: "copy-pick",
        keys: &[],
        title: "Copy as JSON",
        tooltip: "Copies the inspection of the picked pixel as hitscope inspect --json prints it; indices start at 0",
        place: COPY,
        is_on: None,
        obstacle: App::lacks_pick,
        run: |app, ctx, _| app.copy_pick(ctx),
    },
];
