//! Changes to the list of picks by the user, and the background tasks that trace their rays.

use super::pick_list::{Basis, DetailBasis, SideBasis};
use crate::app::App;
use crate::comparison::Side;
use crate::panels::picks::{PickRow, PicksChange, PicksView, WalkView};
use crate::picks::{PickedPixel, PickedPoint, Snapping, to_csv, to_json};
use crate::task::{Task, TaskPanicked};
use hitscope_core::film::ShownPixel;
use hitscope_core::obj::shown;
use hitscope_lab::commands::Output;
use std::path::Path;
use std::sync::Arc;

impl App {
    /// Picks a pixel of a side's picture, and inspects it. The camera is in the coordinates of the open scene.
    pub(in crate::app) fn pick_pixel(
        &mut self,
        side: Side,
        shown: ShownPixel,
        keeps_others: bool,
        ctx: &egui::Context,
    ) {
        let ShownPixel { camera, pixel } = shown;
        let picks = &mut self.picked.inspecting.picks;
        picks.add(side, camera, pixel, keeps_others);
        self.inspect(side, camera, pixel, ctx);
    }

    /// Traces the rays of the picks if they or what their hits depend on have changed, and ends the export.
    pub(in crate::app) fn poll_picks(&mut self, ctx: &egui::Context) {
        let broken = [self.poll_hits(ctx).err(), self.poll_detail(ctx).err()];
        if let Some(broken) = broken.into_iter().flatten().next() {
            self.error(broken);
        }
        self.poll_export();
    }

    /// The scene of a side, and how its rays are traced; `None` if it isn't traced.
    fn side_basis(&self, side: Side) -> Option<SideBasis> {
        let document = self.traced_document_of(side)?;
        Some(SideBasis {
            scene: Arc::clone(&document.loaded.scene),
            intersector: Arc::clone(document.intersector()),
            shading: self.shading_of(side),
            offset: document.origin() - self.open.document.origin(),
        })
    }

    fn basis(&self) -> Basis {
        let picks = &self.picked.inspecting.picks;
        let has_picks = |side: Side| picks.list.iter().any(|pick| pick.side == side);
        let of_side = |side: Side| self.side_basis(side).filter(|_| has_picks(side));
        let place = |pick: &PickedPixel| (pick.number, pick.side, pick.camera, pick.pixel);
        Basis {
            sides: [Side::A, Side::B].map(of_side),
            snapping: picks.snapping,
            picks: picks.list.iter().map(place).collect(),
        }
    }

    fn poll_hits(&mut self, ctx: &egui::Context) -> Result<(), TaskPanicked> {
        let basis = self.basis();
        let picks = &mut self.picked.inspecting.picks;
        let is_known = |(known, _): &(Basis, _)| *known == basis;
        if picks.found.as_ref().is_some_and(is_known) {
            return Ok(());
        }
        let wanted = basis.clone();
        let start = || Task::spawn("picks", ctx, move || wanted.hits());
        if let Some(mut found) = picks.task.get(basis.clone(), start)? {
            for ((_, hit), (_, side, ..)) in found.iter_mut().zip(&basis.picks) {
                if let (Some(hit), Some(document)) = (hit, self.file_of(*side)) {
                    hit.find_line(&document.loaded.report.face_lines);
                }
            }
            self.picked.inspecting.picks.found = Some((basis, found));
        }
        Ok(())
    }

    /// The inputs that determine the details of the selected pick; `None` if no details are wanted.
    fn detail_basis(&self) -> Option<DetailBasis> {
        let picks = &self.picked.inspecting.picks;
        let wants = [picks.measures_thickness, picks.shows_walk];
        let pick = picks.selected().filter(|_| wants.contains(&true))?;
        Some(DetailBasis {
            side: self.side_basis(pick.side)?,
            has_last_tree: self.document_of(pick.side).has_last_tree(),
            place: (pick.camera, pick.pixel),
            wants,
        })
    }

    fn poll_detail(&mut self, ctx: &egui::Context) -> Result<(), TaskPanicked> {
        let basis = self.detail_basis();
        let picks = &mut self.picked.inspecting.picks;
        let Some(basis) = basis else {
            picks.detail = None;
            return Ok(());
        };
        let is_known = |(known, _): &(DetailBasis, _)| *known == basis;
        if picks.detail.as_ref().is_some_and(is_known) {
            return Ok(());
        }
        let wanted = basis.clone();
        let start = || Task::spawn("pick detail", ctx, move || wanted.detail());
        if let Some(detail) = picks.detail_task.get(basis.clone(), start)? {
            picks.detail = Some((basis, detail));
        }
        Ok(())
    }

    /// The picks and their measurements, for the panel.
    pub(in crate::app) fn picks_view(&self) -> PicksView {
        let picks = &self.picked.inspecting.picks;
        let row = |(pick, hit): (&PickedPixel, Option<&PickedPoint>)| PickRow {
            number: pick.number,
            name: pick.name.clone(),
            is_pinned: pick.is_pinned,
            is_on_b: pick.side == Side::B,
            is_selected: picks.selected == Some(pick.number),
            hit: match hit {
                Some(hit) => format!("{} {}, {}", hit.shape, hit.primitive, hit.snapped_to),
                None if self.traced_document_of(pick.side).is_none() => {
                    "side B isn't traced".to_owned()
                }
                None if !picks.is_traced(pick.number) => "tracing…".to_owned(),
                None => "no hit".to_owned(),
            },
        };
        let walk = picks.walk();
        let step = picks.step.min(walk.len().saturating_sub(1));
        PicksView {
            picks: picks.with_hits().into_iter().map(row).collect(),
            measurements: picks.measurements().rows,
            walk: WalkView::of(walk, step),
        }
    }

    /// Makes a change that the user made in the panel.
    pub(in crate::app) fn change_picks(&mut self, change: PicksChange, ctx: &egui::Context) {
        let picks = &mut self.picked.inspecting.picks;
        let found = |number: u32| move |pick: &&mut PickedPixel| pick.number == number;
        match change {
            PicksChange::Rename(number, name) => {
                if let Some(pick) = picks.list.iter_mut().find(found(number)) {
                    pick.name = name;
                }
            }
            PicksChange::Pin(number) => {
                if let Some(pick) = picks.list.iter_mut().find(found(number)) {
                    pick.is_pinned ^= true;
                }
            }
            PicksChange::Remove(number) => {
                picks.list.retain(|pick| pick.number != number);
                if picks.selected == Some(number) {
                    self.picked.clear_pick();
                }
            }
            PicksChange::Select(number) => {
                picks.selected = Some(number);
                picks.step = 0;
                if let Some(pick) = picks.selected() {
                    let (side, camera, pixel) = (pick.side, pick.camera, pick.pixel);
                    self.inspect(side, camera, pixel, ctx);
                }
            }
            PicksChange::Walk(step) => picks.step = step,
        }
    }

    /// Removes all picks.
    pub(crate) fn remove_picks(&mut self) {
        self.picked.inspecting.picks.clear();
        self.picked.clear_pick();
    }

    /// Why nothing can be done with the list of picks; `None` if there are some.
    pub(crate) fn lacks_picks(&self) -> Option<&'static str> {
        let is_empty = self.picked.inspecting.picks.list.is_empty();
        is_empty.then_some("No pixel is picked: click one")
    }

    /// Why no measurement can be copied; `None` if there is one.
    pub(crate) fn lacks_measurements(&self) -> Option<&'static str> {
        let is_empty = self.picked.inspecting.picks.measurements().rows.is_empty();
        is_empty.then_some("Nothing is measured: Ctrl+click a second point")
    }

    /// Copies the measurements as lines of a name and a value.
    pub(crate) fn copy_measurements(&self, ctx: &egui::Context) {
        ctx.copy_text(self.picked.inspecting.picks.measurements().to_text());
    }

    /// The picks as JSON.
    pub fn picks_as_json(&self) -> String {
        to_json(
            &self.open.document.name(),
            &self.picked.inspecting.picks.with_hits(),
        )
    }

    /// The picks as comma-separated values.
    pub fn picks_as_csv(&self) -> String {
        to_csv(
            &self.open.document.name(),
            &self.picked.inspecting.picks.with_hits(),
        )
    }

    /// The mode of snapping.
    pub fn snapping(&self) -> Snapping {
        self.picked.inspecting.picks.snapping
    }

    /// Snaps all picks in this mode.
    pub(crate) fn snap_picks(&mut self, snapping: Snapping) {
        self.picked.inspecting.picks.snapping = snapping;
    }

    /// Whether wall thickness and clearance are measured.
    pub fn measures_thickness(&self) -> bool {
        self.picked.inspecting.picks.measures_thickness
    }

    /// Turns the measurement of wall thickness and clearance on or off.
    pub(crate) fn toggle_thickness(&mut self) {
        self.picked.inspecting.picks.measures_thickness ^= true;
    }

    /// Whether the picked ray's walk is shown.
    pub fn shows_walk(&self) -> bool {
        self.picked.inspecting.picks.shows_walk
    }

    /// Shows the picked ray's walk, or hides it.
    pub(crate) fn toggle_walk(&mut self) {
        self.picked.inspecting.picks.shows_walk ^= true;
    }

    /// Writes the picks to a JSON or CSV file; the extension selects the format.
    pub(in crate::app) fn export_picks(&mut self, path: &Path, ctx: &egui::Context) {
        let extension = path.extension().unwrap_or_default();
        let text = match extension.to_ascii_lowercase().to_str() {
            Some("csv") => self.picks_as_csv(),
            Some("json") => self.picks_as_json(),
            _ => {
                let name = shown(path);
                return self.error(format!("{name}: the extension must be .json or .csv"));
            }
        };
        let file = path.to_owned();
        let write = move || {
            let written = Output::create(&file)
                .and_then(|output| output.write(|out| out.write_all(text.as_bytes())));
            written.map_err(|error| error.to_string())
        };
        let task = Task::spawn("export", ctx, write);
        self.picked.inspecting.picks.writing = Some((path.to_owned(), task));
    }

    fn poll_export(&mut self) {
        let Some((path, task)) = &self.picked.inspecting.picks.writing else {
            return;
        };
        let result = match task.poll() {
            Ok(None) => return,
            Ok(Some(result)) => result,
            Err(broken @ TaskPanicked) => Err(broken.to_string()),
        };
        let text = shown(path);
        self.picked.inspecting.picks.writing = None;
        match result {
            Ok(()) => self.tell(format!("Saved {text}")),
            Err(error) => self.error(error),
        }
    }
}
