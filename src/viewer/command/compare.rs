//! Commands of the menu *View* for comparisons.

use super::keys::{key, shift};
use super::{Command, Entry, Menu, Place, lacks_scene};
use crate::app::{App, Purpose};
use crate::comparison::{Mode, Source};
use egui::Key;

const COMPARE: Place = Place::submenu(Menu::View, 9, "Compare");
/// The modes of a comparison.
pub const COMPARE_MODES: Place = Place::submenu(Menu::View, 9, "Comparison mode");
const SOURCES: Place = Place::submenu(Menu::View, 9, "Compare with");

/// The step of the divider's keys, as a part of the picture's width.
const STEP: f32 = 0.05;

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "compare",
        keys: &[key(Key::C)],
        title: "Comparison",
        tooltip: "Compares the picture with another view, kernel, mesh or picture, for the same camera",
        place: COMPARE,
        is_on: Some(App::is_comparing),
        obstacle: lacks_scene,
        run: |app, _, _| app.toggle_comparison(),
    },
    Command {
        name: "compare-switch",
        keys: &[key(Key::X)],
        title: "Show the other side",
        tooltip: "Alternates between side A and side B",
        place: COMPARE,
        is_on: None,
        obstacle: App::lacks_comparison,
        run: |app, _, _| app.seen.comparison.switch(),
    },
    Command {
        name: "compare-swap",
        keys: &[shift(Key::X)],
        title: "Swap sides",
        tooltip: "Exchanges view, kernel and shading of both sides, and whether they are rasterized",
        place: COMPARE,
        is_on: None,
        obstacle: App::lacks_swap,
        run: |app, _, _| app.swap_sides(),
    },
    Command {
        name: "compare-rasterize-a",
        keys: &[key(Key::R)],
        title: "Rasterize side A",
        tooltip: "Side A is what the GPU's rasterizer finds, instead of rays",
        place: COMPARE,
        is_on: Some(App::rasterizes_a),
        obstacle: lacks_scene,
        run: |app, _, _| app.toggle_rasterized_a(),
    },
    Command {
        name: "divider-left",
        keys: &[shift(Key::ArrowLeft)],
        title: "Move divider left",
        tooltip: "Moves the divider to show more of side B",
        place: COMPARE,
        is_on: None,
        obstacle: App::lacks_comparison,
        run: |app, _, _| app.seen.comparison.move_divider(-STEP),
    },
    Command {
        name: "divider-right",
        keys: &[shift(Key::ArrowRight)],
        title: "Move divider right",
        tooltip: "Moves the divider to show more of side A",
        place: COMPARE,
        is_on: None,
        obstacle: App::lacks_comparison,
        run: |app, _, _| app.seen.comparison.move_divider(STEP),
    },
    Command {
        name: "compare-mesh",
        keys: &[],
        title: "Compare with a file…",
        tooltip: "Chooses a mesh or scene as side B",
        place: COMPARE,
        is_on: None,
        obstacle: lacks_scene,
        run: |app, ctx, frame| app.show_dialog(Purpose::CompareMesh, ctx, frame),
    },
    Command {
        name: "compare-picture",
        keys: &[],
        title: "Compare with a picture…",
        tooltip: "Chooses a PNG, EXR or HDR picture as side B",
        place: COMPARE,
        is_on: None,
        obstacle: lacks_scene,
        run: |app, ctx, frame| app.show_dialog(Purpose::ComparePicture, ctx, frame),
    },
];

/// The modes as entries.
pub(super) fn modes(app: &App) -> Vec<Entry> {
    let entry = |mode: Mode| {
        let is_chosen = app.is_comparing() && app.comparison().mode == mode;
        let choose = move |app: &mut App, _: &egui::Context| app.compare_in(mode);
        Entry::choice(COMPARE_MODES, mode.title(), mode.about(), is_chosen, choose)
    };
    Mode::ALL.into_iter().map(entry).collect()
}

/// The sources of side B as entries.
pub(super) fn sources(app: &App) -> Vec<Entry> {
    let entry = |source: Source| {
        let is_chosen = app.is_comparing() && app.comparison().source == source;
        let choose = move |app: &mut App, _: &egui::Context| app.compare_with(source);
        Entry::choice(SOURCES, source.title(), source.about(), is_chosen, choose)
    };
    Source::ALL.into_iter().map(entry).collect()
}
