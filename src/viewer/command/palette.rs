//! The command palette: a box that finds commands by their titles.

use super::search::rank;
use super::{Commands, Entry};
use crate::text_field::text_field;
use egui::{Align, Align2, Key, Layout, Modal, Modifiers, ScrollArea, vec2};

/// Width of the box in points, in a window that is wide enough.
const WIDTH: f32 = 440.0;
/// Height of the list in points, in a window that is high enough.
const HEIGHT: f32 = 320.0;
/// Distance of the box from the top of the window, in points.
const TOP: f32 = 50.0;

/// The palette's state.
#[derive(Default)]
pub struct Palette {
    is_open: bool,
    query: String,
    /// The row that Enter runs, counted from 0.
    selected: usize,
}

impl Palette {
    /// Opens the palette with an empty query.
    pub fn open(&mut self) {
        *self = Self {
            is_open: true,
            ..Self::default()
        };
    }

    /// Closes the palette. Returns whether it was open.
    pub fn dismiss(&mut self) -> bool {
        std::mem::take(&mut self.is_open)
    }

    /// Shows the palette if it is open.
    pub fn palette_ui(&mut self, ctx: &egui::Context, commands: &Commands) {
        if !self.is_open {
            return;
        }
        // Before the text field sees them.
        let steps = [(Key::ArrowDown, 1), (Key::ArrowUp, -1)];
        let step: isize = ctx.input_mut(|input| {
            let pressed =
                |(key, step)| step * input.count_and_consume_key(Modifiers::NONE, key) as isize;
            steps.map(pressed).iter().sum()
        });
        let is_entered = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
        let id = egui::Id::unique("palette");
        let area = Modal::default_area(id)
            .anchor(Align2::CENTER_TOP, vec2(0.0, TOP))
            .accessible_name("Command palette");
        let modal = Modal::new(id).area(area).show(ctx, |ui| {
            ui.set_width((ui.ctx().content_rect().width() - 40.0).clamp(1.0, WIDTH));
            let field = self.field_ui(ui);
            let found = found(commands.entries(), &self.query);
            self.select(step, found.len());
            let is_clicked = self.list_ui(ui, &found, commands, step != 0);
            let entered = found.get(self.selected).filter(|_| is_entered);
            let entered = entered.filter(|entry| entry.is_enabled());
            if let Some(entry) = entered {
                commands.choose(entry);
            }
            let is_done = is_clicked || entered.is_some();
            if is_done {
                // The next key is for the window.
                field.surrender_focus();
            }
            is_done
        });
        if modal.inner || modal.backdrop_response.clicked() {
            self.is_open = false;
        }
    }

    fn field_ui(&mut self, ui: &mut egui::Ui) -> egui::Response {
        let label = ui.label("Find a command");
        let field = text_field(&mut self.query)
            .hint_text("View, kernel, file…")
            .desired_width(f32::INFINITY);
        let field = ui.add(field).labelled_by(label.id);
        if ui.memory(|memory| memory.focused().is_none()) {
            field.request_focus();
        }
        if field.changed() {
            self.selected = 0;
        }
        field
    }

    /// Selects the row so many further down, from the last to the first row and back.
    fn select(&mut self, step: isize, count: usize) {
        let selected = self.selected.min(count.saturating_sub(1)) as isize;
        self.selected = (selected + step).rem_euclid(count.max(1) as isize) as usize;
    }

    /// Shows the commands that were found. Returns whether one was clicked.
    fn list_ui(
        &self,
        ui: &mut egui::Ui,
        found: &[&Entry],
        commands: &Commands,
        scrolls: bool,
    ) -> bool {
        let room = ui.ctx().content_rect().height() - TOP - 110.0;
        let height = HEIGHT.min(room.max(40.0));
        let mut is_clicked = false;
        ui.add_space(4.0);
        ScrollArea::vertical()
            .max_height(height)
            // The box opens with the height of the last list. Without this, a longer list couldn't make it higher.
            .min_scrolled_height(height)
            .auto_shrink([false, true])
            .show(ui, |ui| {
                if found.is_empty() {
                    ui.label("No command has such a title.");
                }
                ui.with_layout(Layout::top_down_justified(Align::Min), |ui| {
                    for (index, entry) in found.iter().enumerate() {
                        let is_selected = index == self.selected;
                        let response = commands.palette_row_ui(ui, entry, is_selected);
                        is_clicked |= response.clicked();
                        if scrolls && is_selected {
                            response.scroll_to_me(None);
                        }
                    }
                });
            });
        is_clicked
    }
}

/// The commands whose titles match, best first.
fn found<'e>(entries: &'e [Entry], query: &str) -> Vec<&'e Entry> {
    let ranked = |entry: &'e Entry| Some((rank(query, &entry.full_title())?, entry));
    let mut found: Vec<(u32, &Entry)> = entries.iter().filter_map(ranked).collect();
    // Commands of the same rank stay in the order of the menus.
    found.sort_by_key(|(rank, _)| *rank);
    found.into_iter().map(|(_, entry)| entry).collect()
}
