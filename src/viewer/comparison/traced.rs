//! A side B that is traced: its tracer and its developed film.

use crate::gpu::GpuError;
use crate::look::{Development, Look};
use crate::tracer::Tracer;
use glam::UVec2;
use hitscope_core::film::ShownPixels;
use hitscope_core::plan::PixelRect;
use hitscope_core::{Camera, Scene};
use std::sync::Arc;

/// A side that is traced.
pub struct TracedSide {
    /// Traces the newest request.
    pub tracer: Tracer,
    development: Development,
    /// What each pixel of the picture on the screen shows.
    pub shown: ShownPixels,
    /// Scene and camera of the picture on the screen.
    pub on_screen: Option<(Arc<Scene>, Camera)>,
}

impl TracedSide {
    /// Starts the threads.
    pub fn new(threads: usize, ctx: &egui::Context) -> Self {
        Self {
            tracer: Tracer::new(threads, ctx),
            development: Development::default(),
            shown: ShownPixels::default(),
            on_screen: None,
        }
    }

    /// Passes changes of the picture to `upload`: its size, all pixels, the rectangle that changed, and the size of its
    /// blocks. Returns whether there were any.
    ///
    /// # Errors
    /// Those of `upload`.
    pub fn update(
        &mut self,
        look: Look,
        upload: impl FnOnce(UVec2, &[[u8; 4]], PixelRect, u32) -> Result<(), GpuError>,
    ) -> Result<bool, GpuError> {
        let changed = self.tracer.take_changes().map(|(_, changed)| changed);
        let film = self.tracer.film();
        let is_new = match self.development.update(film, changed, look) {
            Some((pixels, changed)) => {
                upload(film.size(), pixels, changed, film.block_px())?;
                self.shown.update(film, changed);
                true
            }
            None => false,
        };
        self.on_screen = self.tracer.shown().cloned();
        Ok(is_new)
    }

    /// All pixels, as they were last shown.
    pub fn pixels(&self) -> &[[u8; 4]] {
        self.development.pixels(self.tracer.film())
    }
}
