//! Commands of the scene's parts, in the menus *View* and *Pick*.

use super::{Command, Entry, Menu, Place, lacks_scene};
use crate::app::App;
use crate::parts::Grouping;

const PARTS: Place = Place::submenu(Menu::View, 7, "Parts");
const PICKED: Place = Place::new(Menu::Pick, 5);

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "show-all-parts",
        keys: &[],
        title: "Show all parts",
        tooltip: "Shows the hidden parts again",
        place: PARTS,
        is_on: None,
        obstacle: App::lacks_hidden_part,
        run: |app, _, _| app.show_all_parts(),
    },
    Command {
        name: "show-everything",
        keys: &[],
        title: "Show everything",
        tooltip: "Turns the clip off and shows all parts",
        place: PARTS,
        is_on: None,
        obstacle: App::lacks_hidden_surface,
        run: |app, _, _| app.show_everything(),
    },
    Command {
        name: "invert-parts",
        keys: &[],
        title: "Invert shown parts",
        tooltip: "Shows the hidden parts and hides the others",
        place: PARTS,
        is_on: None,
        obstacle: lacks_scene,
        run: |app, _, _| app.invert_parts(),
    },
];

pub(super) const PICK_ROWS: &[Command] = &[
    Command {
        name: "hide-part",
        keys: &[],
        title: "Hide the picked part",
        tooltip: "Hides the group, material or shape of the picked primitive",
        place: PICKED,
        is_on: None,
        obstacle: App::lacks_hit,
        run: |app, _, _| app.hide_picked_part(),
    },
    Command {
        name: "only-part",
        keys: &[],
        title: "Show only the picked part",
        tooltip: "Hides all but the group, material or shape of the picked primitive",
        place: PICKED,
        is_on: None,
        obstacle: App::lacks_hit,
        run: |app, _, _| app.show_only_picked_part(),
    },
];

/// What makes a part.
pub(super) fn groupings(app: &App) -> Vec<Entry> {
    let entry = |grouping: Grouping| {
        let is_chosen = app.parts().grouping == grouping;
        let choose = move |app: &mut App, _: &egui::Context| app.group_parts_by(grouping);
        let title = match grouping {
            Grouping::Groups => "By group",
            Grouping::Materials => "By material",
            Grouping::Shapes => "By shape",
        };
        let tooltip = "What the list of parts contains";
        Entry::choice(PARTS, title, tooltip, is_chosen, choose)
    };
    Grouping::ALL.into_iter().map(entry).collect()
}
