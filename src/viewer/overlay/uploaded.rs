//! Meshes and lines that are gathered and uploaded in the background.

use super::OverlayError;
use crate::gpu::drawing::Overlay;
use crate::task::{KeyedTask, Task};
use hitscope_core::progress::Progress;
use std::sync::Arc;

/// A GPU resource of one of several kinds, created in the background on first use.
pub struct Uploaded<K, T> {
    /// The kind and its resource, or `None` if creating it failed, which isn't retried.
    made: Option<(K, Option<Arc<T>>)>,
    making: KeyedTask<K, Result<T, OverlayError>>,
}

impl<K, T> Default for Uploaded<K, T> {
    fn default() -> Self {
        Self {
            made: None,
            making: KeyedTask::default(),
        }
    }
}

/// The state of a resource.
pub enum Readiness<T> {
    /// Ready.
    Ready(Arc<T>),
    /// Being created; a repaint is requested when it is ready. Until then, the last one of another kind, if there is any.
    Pending(Option<Arc<T>>),
    /// Creating it failed; the error was returned.
    Failed,
}

impl<K: Clone + PartialEq + Send + 'static, T: Send + 'static> Uploaded<K, T> {
    /// The resource of this kind. Starts to create it unless that is in progress.
    ///
    /// # Errors
    /// See [`OverlayError`]; returned once, later calls return [`Readiness::Failed`].
    pub fn get(
        &mut self,
        kind: K,
        overlay: &Arc<Overlay>,
        ctx: &egui::Context,
        make: impl FnOnce(&wgpu::Device, &wgpu::Queue, &Progress) -> Result<T, OverlayError>
        + Send
        + 'static,
    ) -> Result<Readiness<T>, OverlayError> {
        match &self.made {
            Some((made, Some(it))) if *made == kind => return Ok(Readiness::Ready(Arc::clone(it))),
            Some((made, None)) if *made == kind => return Ok(Readiness::Failed),
            _ => {}
        }
        let overlay = Arc::clone(overlay);
        let start = || {
            Task::cancellable("overlay upload", ctx, move |progress| {
                let (device, queue) = overlay.gpu();
                make(device, queue, progress)
            })
        };
        let made: Result<T, OverlayError> = match self.making.get(kind.clone(), start) {
            Ok(None) => {
                let last = self.made.as_ref().and_then(|(_, last)| last.clone());
                return Ok(Readiness::Pending(last));
            }
            Ok(Some(made)) => made,
            Err(panicked) => Err(panicked.into()),
        };
        let made = made.map(Arc::new);
        self.made = Some((kind, made.as_ref().ok().map(Arc::clone)));
        made.map(Readiness::Ready)
    }

    /// Allows a retry after a failure.
    pub fn forget_failure(&mut self) {
        if matches!(self.made, Some((_, None))) {
            self.made = None;
        }
    }
}
