//! The menu *Pick*: the picked pixel and its ray.

use super::keys::{ctrl, key};
use super::{Command, Entry, Menu, Place, none};
use crate::app::{App, Purpose};
use crate::picks::Snapping;
use egui::Key;

const CROSSINGS: Place = Place::new(Menu::Pick, 0);
const COPY: Place = Place::new(Menu::Pick, 1);
const LIST: Place = Place::new(Menu::Pick, 2);
const MEASURE: Place = Place::new(Menu::Pick, 3);
/// What picks snap to.
pub const SNAPPING: Place = Place::submenu(Menu::Pick, 3, "Snap to");

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
    Command {
        name: "copy-picks-json",
        keys: &[],
        title: "Copy picks as JSON",
        tooltip: "Copies the list of picks with their hits as JSON; triangles and faces count from 0",
        place: LIST,
        is_on: None,
        obstacle: App::lacks_picks,
        run: |app, ctx, _| ctx.copy_text(app.picks_as_json()),
    },
    Command {
        name: "copy-picks-csv",
        keys: &[],
        title: "Copy picks as CSV",
        tooltip: "Copies the list of picks with their hits as a table of comma-separated values",
        place: LIST,
        is_on: None,
        obstacle: App::lacks_picks,
        run: |app, ctx, _| ctx.copy_text(app.picks_as_csv()),
    },
    Command {
        name: "export-picks",
        keys: &[ctrl(Key::E)],
        title: "Export picks…",
        tooltip: "Writes the list of picks to a JSON or CSV file; the extension selects the format",
        place: LIST,
        is_on: None,
        obstacle: App::lacks_picks,
        run: |app, ctx, frame| app.show_dialog(Purpose::Picks, ctx, frame),
    },
    Command {
        name: "remove-picks",
        keys: &[key(Key::Delete)],
        title: "Remove all picks",
        tooltip: "Empties the list of picks, pinned ones included",
        place: LIST,
        is_on: None,
        obstacle: App::lacks_picks,
        run: |app, _, _| app.remove_picks(),
    },
    Command {
        name: "thickness",
        keys: &[],
        title: "Wall thickness",
        tooltip: "Measures the wall behind the inspected pick and the clearance in front of it along the normal, with an exact ray each way",
        place: MEASURE,
        is_on: Some(App::measures_thickness),
        obstacle: none,
        run: |app, _, _| app.toggle_thickness(),
    },
    Command {
        name: "copy-measurements",
        keys: &[],
        title: "Copy measurements",
        tooltip: "Copies the measurements as lines of a name and a value, separated by a tab",
        place: MEASURE,
        is_on: None,
        obstacle: App::lacks_measurements,
        run: |app, ctx, _| app.copy_measurements(ctx),
    },
    Command {
        name: "walk",
        keys: &[],
        title: "Walk of the ray",
        tooltip: "Shows the boxes of the tree that the inspected ray opens, one after the other",
        place: MEASURE,
        is_on: Some(App::shows_walk),
        obstacle: none,
        run: |app, _, _| app.toggle_walk(),
    },
    Command {
        name: "read-out",
        keys: &[],
        title: "Read-out under the pointer",
        tooltip: "Shows t, the element and the number of the view where the pointer rests",
        place: MEASURE,
        is_on: Some(App::reads_out),
        obstacle: none,
        run: |app, _, _| app.toggle_read_out(),
    },
];

/// The modes of snapping.
pub(super) fn snapping(app: &App) -> Vec<Entry> {
    let current = app.snapping();
    let entry = |&(mode, title, about): &(Snapping, &'static str, &'static str)| {
        let choose = move |app: &mut App, _: &egui::Context| app.snap_picks(mode);
        Entry::choice(SNAPPING, title, about, mode == current, choose)
    };
    Snapping::ALL.iter().map(entry).collect()
}
