//! Comparing the window's picture, side A, with another picture, side B.
//!
//! | file | part |
//! |---|---|
//! | this file | [`Compared`], the owner of side B |
//! | `sides` | the documents of side B; tracing and rasterizing them |
//! | `screen`, `divider` | drawing side B and the difference; the divider |
//! | `shown` | the picture on the screen as pixels |
//! | `rasterized_side` | side A when it is rasterized |
//! | `measured` | figures of the differences, distances, the distance map |
//! | `inspected` | inspection of side B |
//! | `chosen` | the commands, and the tab *Compare* |

mod chosen;
mod divider;
mod inspected;
mod measured;
mod rasterized_side;
mod screen;
mod shown;
mod sides;

use super::App;
use super::scene_lights::SceneLights;
use crate::comparison::{Rasterized, Reference, Source, TracedSide};
use crate::document::Document;
use crate::opening::Loading;
use crate::retired::Retired;
use crate::settings::Settings;
use eframe::egui_wgpu::RenderState;
use measured::Measured;
use screen::Screen;
use std::time::Duration;

/// Side B of a comparison, and measurements between both sides.
pub(crate) struct Compared {
    render_state: RenderState,
    /// The source that the other fields are for.
    source: Source,
    /// The open scene, packed for side B.
    sibling: Option<Document>,
    /// The document of another file.
    mesh: Option<Document>,
    /// The open file before it was last reloaded.
    earlier: Option<Document>,
    /// Dropped documents, which a background task frees.
    retired: Retired,
    loading: Option<Loading>,
    lights: SceneLights,
    traced: Option<TracedSide>,
    rasterized: Rasterized,
    /// Side A, if it is rasterized.
    rasterized_a: Rasterized,
    reference: Reference,
    screen: Screen,
    measured: Measured,
}

impl Compared {
    pub fn new(render_state: &RenderState) -> Self {
        Self {
            source: Source::default(),
            sibling: None,
            mesh: None,
            earlier: None,
            retired: Retired::default(),
            loading: None,
            lights: SceneLights::default(),
            traced: None,
            rasterized: Rasterized::new(&render_state.device, &render_state.queue),
            rasterized_a: Rasterized::new(&render_state.device, &render_state.queue),
            reference: Reference::default(),
            screen: Screen::default(),
            measured: Measured::default(),
            render_state: render_state.clone(),
        }
    }

    /// The document of side B; `None` for a reference picture, and until the document is loaded.
    fn document(&self) -> Option<&Document> {
        match self.source {
            Source::Traced | Source::Rasterized => self.sibling.as_ref(),
            Source::Mesh => self.mesh.as_ref(),
            Source::Earlier => self.earlier.as_ref(),
            Source::Picture => None,
        }
    }

    fn document_mut(&mut self) -> Option<&mut Document> {
        match self.source {
            Source::Traced | Source::Rasterized => self.sibling.as_mut(),
            Source::Mesh => self.mesh.as_mut(),
            Source::Earlier => self.earlier.as_mut(),
            Source::Picture => None,
        }
    }

    /// Drops the rasterized picture of side A.
    fn clear_a(&mut self) {
        self.rasterized_a = Rasterized::new(&self.render_state.device, &self.render_state.queue);
        self.screen.clear_a();
    }

    /// Drops side B, except for an earlier version, which couldn't be loaded again.
    fn clear(&mut self) {
        if let Some(loading) = self.loading.take() {
            loading.cancel();
        }
        self.drop_mesh();
        if let Some(sibling) = self.sibling.take() {
            self.retired.add(sibling);
        }
        self.lights = SceneLights::default();
        if let Some(mut side) = self.traced.take() {
            side.tracer.stop();
            // Dropping waits until the last rays are traced, so another thread does it, if one can be started.
            let end = std::thread::Builder::new().name("end of side B".to_owned());
            _ = end.spawn(move || drop(side));
        }
        self.rasterized = Rasterized::new(&self.render_state.device, &self.render_state.queue);
        self.retired.add(std::mem::take(&mut self.reference));
        (self.screen, self.measured) = (Screen::default(), Measured::default());
    }

    /// Whether [`clear`](Self::clear) has nothing to drop.
    fn is_idle(&self) -> bool {
        let has_document = self.sibling.is_some() || self.mesh.is_some();
        let has_picture = self.traced.is_some() || self.screen.has_picture();
        let has_reference = self.reference.picture().is_some();
        let has_a = !self.rasterized_a.is_unused();
        !has_document && !has_picture && !has_reference && !has_a && self.loading.is_none()
    }

    /// Keeps the document that a reload replaced. Returns the document that is no longer needed: the previous version,
    /// or `old` itself if another file was opened.
    pub fn keep_earlier(&mut self, old: Document, is_same_file: bool) -> Option<Document> {
        old.stop_improving();
        let before = self.earlier.take();
        if is_same_file && old.path.is_some() {
            self.earlier = Some(old);
            return before;
        }
        before
            .into_iter()
            .for_each(|before| self.retired.add(before));
        Some(old)
    }

    /// Drops the mesh of another file that was side B.
    fn drop_mesh(&mut self) {
        if let Some(mesh) = self.mesh.take() {
            self.retired.add(mesh);
        }
    }

    /// Time since packing of side B for its kernel began; `None` if it isn't running.
    pub fn packing_elapsed(&self) -> Option<Duration> {
        self.document()?.packing_elapsed()
    }

    /// Time since measuring of distances began, for figures or a map; `None` if none are being measured.
    pub fn measuring_elapsed(&self) -> Option<Duration> {
        self.measured.elapsed()
    }

    /// Cancels all work.
    pub fn stop(&mut self) {
        if let Some(loading) = self.loading.take() {
            loading.cancel();
        }
        if let Some(side) = &mut self.traced {
            side.tracer.stop();
        }
    }
}

impl App {
    /// Whether two sides are compared.
    pub fn is_comparing(&self) -> bool {
        self.seen.comparison.is_on && !self.open.document.is_blank
    }

    /// Whether side A is rasterized.
    pub(crate) fn rasterizes_a(&self) -> bool {
        self.is_comparing() && self.seen.comparison.is_a_rasterized
    }

    /// The settings of side B; those of side A while nothing is compared.
    pub(super) fn other_settings(&self) -> Settings {
        let settings = &self.seen.settings;
        if self.is_comparing() {
            self.seen.comparison.settings(settings)
        } else {
            settings.clone()
        }
    }

    /// Collects results of background work.
    pub(super) fn poll_comparison(&mut self, ctx: &egui::Context) {
        self.compared.retired.poll(ctx);
        if !self.is_comparing() {
            if !self.compared.is_idle() {
                self.compared.clear();
                self.compared.clear_a();
            }
            return;
        }
        self.poll_sides(ctx);
        self.poll_measured(ctx);
    }

    /// Whether side B is complete, and the figures and the map are up to date if they are shown.
    pub(super) fn is_comparison_settled(&self) -> bool {
        !self.is_comparing() || (self.are_sides_settled() && self.are_figures_settled())
    }
}
