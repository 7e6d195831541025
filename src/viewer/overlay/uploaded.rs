//! Meshes and lines that threads gather and upload.

use super::OverlayError;
use crate::gpu::GpuError;
use crate::gpu::drawing::Overlay;
use crate::task::{KeyedTask, Task};
use std::sync::Arc;

/// Something on the GPU, of one of several kinds, made in the background when it is first asked for.
pub struct Uploaded<K, T> {
    /// `None` if making it failed, which isn't tried again.
    made: Option<(K, Option<Arc<T>>)>,
    making: KeyedTask<K, Result<T, GpuError>>,
}

impl<K, T> Default for Uploaded<K, T> {
    fn default() -> Self {
        Self {
            made: None,
            making: KeyedTask::default(),
        }
    }
}

/// Whether something is there.
pub enum Readiness<T> {
    /// It is.
    Ready(Arc<T>),
    /// Not yet; a repaint comes when it is.
    Pending,
    /// It will never be; the error was returned.
    Failed,
}

impl<K: Copy + PartialEq + Send + 'static, T: Send + 'static> Uploaded<K, T> {
    /// The thing of this kind. Starts making it unless that is under way.
    ///
    /// # Errors
    /// See [`OverlayError`]; once, then it is [`Readiness::Failed`].
    pub fn get(
        &mut self,
        kind: K,
        overlay: &Arc<Overlay>,
        ctx: &egui::Context,
        make: impl FnOnce(&wgpu::Device, &wgpu::Queue) -> Result<T, GpuError> + Send + 'static,
    ) -> Result<Readiness<T>, OverlayError> {
        match &self.made {
            Some((made, Some(it))) if *made == kind => return Ok(Readiness::Ready(Arc::clone(it))),
            Some((made, None)) if *made == kind => return Ok(Readiness::Failed),
            _ => {}
        }
        let overlay = Arc::clone(overlay);
        let start = || {
            Task::spawn("overlay upload", ctx, move || {
                let (device, queue) = overlay.gpu();
                make(device, queue)
            })
        };
        let made: Result<T, OverlayError> = match self.making.get(kind, start) {
            Ok(None) => return Ok(Readiness::Pending),
            Ok(Some(made)) => made.map_err(OverlayError::from),
            Err(panicked) => Err(panicked.into()),
        };
        let made = made.map(Arc::new);
        self.made = Some((kind, made.as_ref().ok().map(Arc::clone)));
        made.map(Readiness::Ready)
    }

    /// Lets something that failed be tried again.
    pub fn forget_failure(&mut self) {
        if matches!(self.made, Some((_, None))) {
            self.made = None;
        }
    }
}
