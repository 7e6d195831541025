//! Commands of the picture's colours, in the menu *View*.

use super::keys::key;
use super::{Command, Menu, Place, none};
use crate::app::App;
use egui::Key;
use hitscope_core::integrator::Setting;

const COLOURS: Place = Place::submenu(Menu::View, 6, "Colours");

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "legend",
        keys: &[],
        title: "Legend in the picture",
        tooltip: "Shows the scale of views of numbers and of noise in the picture",
        place: COLOURS,
        is_on: Some(|app| app.seen.settings.colours.shows_legend),
        obstacle: none,
        run: |app, _, _| app.seen.settings.colours.shows_legend ^= true,
    },
    Command {
        name: "fit-range",
        keys: &[],
        title: "Fit range",
        tooltip: "Makes the scale's range that of the numbers in the picture",
        place: COLOURS,
        is_on: None,
        obstacle: App::lacks_scale,
        run: |app, ctx, _| app.fit_range(ctx),
    },
    Command {
        name: "tint-back-faces",
        keys: &[key(Key::B)],
        title: "Tint back faces",
        tooltip: "Mixes a colour into the back faces of the view Shaded",
        place: COLOURS,
        is_on: Some(|app| app.seen.settings.colours.tints_back_faces),
        obstacle: |app| {
            let tints = app.seen.settings.view().needs.uses(Setting::BackFaces);
            (!tints).then_some("The view doesn't tint back faces")
        },
        run: |app, _, _| app.seen.settings.colours.tints_back_faces ^= true,
    },
];
