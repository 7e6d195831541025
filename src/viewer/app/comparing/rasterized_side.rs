//! Side A when it is rasterized. Its picture replaces the traced one, and both have the same request.

use super::Compared;
use crate::app::App;
use crate::comparison::{RasterizedPicture, Visibility};
use crate::gpu::GpuError;
use glam::UVec2;
use std::sync::Arc;

impl Compared {
    /// The rasterized picture of side A that is drawn.
    fn picture_of_a(&self) -> Option<&Arc<RasterizedPicture>> {
        self.screen.rasterized_a()
    }

    /// Uploads a new picture of side A. Returns whether there is one.
    fn upload_a(&mut self) -> Result<bool, GpuError> {
        let (screen, newest) = (&mut self.screen, self.rasterized_a.picture());
        newest.map_or(Ok(false), |newest| {
            screen.upload_a(&self.render_state, newest)
        })
    }
}

impl App {
    /// Rasterizes the request that is being traced, if side A is rasterized.
    pub(super) fn request_rasterized_a(&mut self, ctx: &egui::Context) {
        if !self.rasterizes_a() {
            if !self.compared.rasterized_a.is_unused() {
                self.compared.clear_a();
                self.compared.screen.changes[0] += 1;
            }
            return;
        }
        if let Some(request) = self.traced.tracer.posted().cloned() {
            let compared = &mut self.compared;
            let scene = Arc::clone(&request.context.scene);
            compared
                .rasterized_a
                .share_mesh(&compared.rasterized, &scene);
            compared
                .rasterized
                .share_mesh(&compared.rasterized_a, &scene);
            compared.rasterized_a.request(request, ctx);
        }
    }

    /// Whether the rasterized picture of side A is that of the newest request.
    pub(super) fn is_rasterized_a_finished(&self) -> bool {
        let side = &self.compared.rasterized_a;
        !side.is_unused() && side.is_finished()
    }

    /// Uploads a new picture of side A, if it is rasterized.
    pub(super) fn update_rasterized_a(&mut self, ctx: &egui::Context) -> Result<(), GpuError> {
        if self.rasterizes_a() && self.compared.upload_a()? {
            self.compared.screen.changes[0] += 1;
            self.ask_for_figures(ctx);
        }
        Ok(())
    }

    /// Width and height of side A, and its pixels as they are shown; `None` before there are pixels.
    pub(super) fn pixels_of_a(&self) -> Option<(UVec2, &[[u8; 4]])> {
        if self.rasterizes_a() {
            let picture = self.compared.picture_of_a()?;
            return Some((picture.size(), &picture.pixels));
        }
        let film = self.traced.tracer.film();
        let has_pixels = film.passes_done() > 0;
        has_pixels.then(|| (film.size(), self.traced.development.pixels(film)))
    }

    /// How the visible triangles of both sides are compared; `None` if neither is rasterized, or their scenes differ.
    pub(super) fn visibility(&self) -> Option<Visibility> {
        let a = self.compared.picture_of_a().filter(|_| self.rasterizes_a());
        let b = self.compared.rasterized_picture_of_b();
        match (a, b) {
            (Some(a), Some(b)) => Some(Visibility::Rasterized([a, b].map(Arc::clone))),
            (Some(picture), None) => {
                let intersector = self.request_on_b()?.context.intersector;
                let is_same_scene = !self.compared.source.is_other_scene();
                is_same_scene
                    .then(|| Visibility::TracedAndRasterized(intersector, Arc::clone(picture)))
            }
            (None, picture) => {
                let picture = picture?;
                let intersector = Arc::clone(&picture.request.context.intersector);
                Some(Visibility::TracedAndRasterized(
                    intersector,
                    Arc::clone(picture),
                ))
            }
        }
    }
}
