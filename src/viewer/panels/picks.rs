//! The sections of the *Inspect* tab about the list of picks: the list, the measurements and the walk.

use super::table::table_ui;
use super::{row_ui, rows_ui};
use crate::command::{Commands, SNAPPING};
use crate::number_field::number_slider;
use crate::text_field::text_field;
use egui::RichText;
use hitscope_core::bvh::{BoxContents, OpenedBox};
use hitscope_core::counts::counted_as;

/// The contents of the sections.
pub struct PicksView {
    /// The picks.
    pub picks: Vec<PickRow>,
    /// Names and values of the measurements.
    pub measurements: Vec<[String; 2]>,
    /// The walk, if it is shown and known.
    pub walk: Option<WalkView>,
}

/// A pick in the list.
pub struct PickRow {
    /// Its number.
    pub number: u32,
    /// The name that the user gave it.
    pub name: String,
    /// Whether it stays when another pixel is picked.
    pub is_pinned: bool,
    /// Whether it is on side B of a comparison.
    pub is_on_b: bool,
    /// Whether it is the one that is inspected.
    pub is_selected: bool,
    /// The hit of its ray, or why there is none.
    pub hit: String,
}

/// The walk of the selected pick.
pub struct WalkView {
    /// The selected box, counted from 0.
    pub step: usize,
    /// The number of boxes that were opened.
    pub count: usize,
    /// What was tested in the selected box.
    pub contents: String,
    /// The boxes and primitives that were tested so far.
    pub so_far: String,
    /// The boxes and primitives that were tested in all.
    pub in_all: String,
}

impl WalkView {
    /// The walk with a selected box; `None` if it opened none.
    pub fn of(walk: &[OpenedBox], step: usize) -> Option<Self> {
        let contents = match &walk.get(step)?.contents {
            BoxContents::Boxes(count) => counted_as(*count as usize, "box", "boxes"),
            BoxContents::Primitives(primitives) => {
                let count = counted_as(primitives.len(), "primitive", "primitives");
                let list: Vec<String> = primitives.iter().map(u32::to_string).collect();
                format!("{count}: {}", list.join(", "))
            }
        };
        Some(Self {
            step,
            count: walk.len(),
            contents,
            so_far: tested(&walk[..=step]),
            in_all: tested(walk),
        })
    }
}

/// The numbers of tests in some boxes.
fn tested(opened: &[OpenedBox]) -> String {
    let boxes: u32 = opened.iter().map(OpenedBox::box_count).sum();
    let primitives: u32 = opened.iter().map(OpenedBox::primitive_count).sum();
    let boxes = counted_as(boxes as usize, "box", "boxes");
    let primitives = counted_as(primitives as usize, "primitive", "primitives");
    format!("{boxes}, {primitives}")
}

/// What the user changes in the sections.
pub enum PicksChange {
    /// Gives the pick of this number a name.
    Rename(u32, String),
    /// Pins the pick of this number, or unpins it.
    Pin(u32),
    /// Removes the pick of this number.
    Remove(u32),
    /// Inspects the pick of this number.
    Select(u32),
    /// Selects a box of the walk.
    Walk(usize),
}

/// Shows the list of picks, the measurements between them and the walk. Returns what the user changes. The section
/// opens by itself when there is a second pick or a walk.
pub fn picks_ui(ui: &mut egui::Ui, view: &PicksView, commands: &Commands) -> Option<PicksChange> {
    let is_wanted = view.picks.len() > 1 || view.walk.is_some();
    let section = egui::CollapsingHeader::new("Picks and measurements")
        .id_salt(("picks", is_wanted))
        .default_open(is_wanted)
        .show_unindented(ui, |ui| sections_ui(ui, view, commands));
    ui.add_space(4.0);
    section.body_returned.flatten()
}

fn sections_ui(ui: &mut egui::Ui, view: &PicksView, commands: &Commands) -> Option<PicksChange> {
    let mut change = None;
    ui.label(RichText::new("Ctrl+click adds a pick; a click keeps only pinned ones.").weak());
    for pick in &view.picks {
        change = pick_ui(ui, pick).or(change);
    }
    ui.horizontal_wrapped(|ui| {
        for name in [
            "copy-picks-json",
            "copy-picks-csv",
            "export-picks",
            "remove-picks",
        ] {
            commands.small_button_ui(ui, name);
        }
    });
    ui.add_space(4.0);
    measurements_ui(ui, view, commands);
    commands.check_box_ui(ui, "walk");
    if let Some(walk) = &view.walk {
        change = walk_ui(ui, walk).or(change);
    }
    ui.separator();
    change
}

fn pick_ui(ui: &mut egui::Ui, pick: &PickRow) -> Option<PicksChange> {
    let mut change = None;
    let number = pick.number;
    ui.push_id(("pick", number), |ui| {
        ui.horizontal(|ui| {
            let title = if pick.is_on_b {
                format!("Pick {number} on B")
            } else {
                format!("Pick {number}")
            };
            let select = ui.selectable_label(pick.is_selected, title);
            if select.on_hover_text("Inspect this pick").clicked() {
                change = Some(PicksChange::Select(number));
            }
            let mut name = pick.name.clone();
            let field = text_field(&mut name).hint_text("name").desired_width(90.0);
            let field = ui.add(field);
            field.widget_info(|| {
                let mut info = egui::WidgetInfo::text_edit(true, &pick.name, &name, "name");
                info.label = Some(format!("Name of pick {number}"));
                info
            });
            if field.changed() {
                change = Some(PicksChange::Rename(number, name));
            }
            let mut is_pinned = pick.is_pinned;
            let pin = ui.checkbox(&mut is_pinned, format!("Pin {number}"));
            if pin
                .on_hover_text("A pinned pick stays when you click another pixel")
                .changed()
            {
                change = Some(PicksChange::Pin(number));
            }
            if ui.small_button(format!("Remove {number}")).clicked() {
                change = Some(PicksChange::Remove(number));
            }
        });
        ui.label(RichText::new(&pick.hit).weak());
    });
    change
}

fn measurements_ui(ui: &mut egui::Ui, view: &PicksView, commands: &Commands) {
    ui.label(RichText::new("Measurements").strong())
        .on_hover_text("Between the picks in their order, in the units of the file");
    ui.horizontal_wrapped(|ui| {
        ui.label("Snap to");
        for mode in commands.at(SNAPPING) {
            commands.choice_ui(ui, mode);
        }
    });
    commands.check_box_ui(ui, "thickness");
    if view.measurements.is_empty() {
        ui.label(RichText::new("Distances need two picks that hit a surface.").weak());
    } else {
        // One coordinate per line: the panel is narrower than three.
        let rows = view.measurements.iter().flat_map(|[name, value]| {
            let names = std::iter::once(name.clone()).chain(std::iter::repeat(String::new()));
            let coordinates = value.split(", ").map(str::to_owned);
            names.zip(coordinates).map(|(name, value)| [name, value])
        });
        egui::ScrollArea::horizontal()
            .id_salt("measurements")
            .show(ui, |ui| {
                table_ui(ui, ["in the file's units", "value"], rows);
            });
        commands.small_button_ui(ui, "copy-measurements");
    }
    ui.add_space(4.0);
}

fn walk_ui(ui: &mut egui::Ui, walk: &WalkView) -> Option<PicksChange> {
    let mut step = walk.step;
    ui.horizontal(|ui| {
        let name = ui.label("Opened box");
        let slider = number_slider(&mut step, 0..=walk.count - 1).show_value(false);
        ui.add(slider).labelled_by(name.id);
    });
    rows_ui(ui, |ui| {
        let number = format!("{} of {}", walk.step + 1, walk.count);
        row_ui(ui, "number in order", number);
        row_ui(ui, "tested in it", &walk.contents);
        row_ui(ui, "tested so far", &walk.so_far);
        row_ui(ui, "tested in all", &walk.in_all);
    });
    (step != walk.step).then_some(PicksChange::Walk(step))
}
