//! Errors and loss of the graphics device, which wgpu reports on any thread.

use hitscope_lab::commands::print_line;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The errors of a device and the reason for its loss, shared with wgpu's callbacks.
#[derive(Clone, Default)]
pub struct Faults(Arc<Shared>);

#[derive(Default)]
struct Shared {
    /// Errors that haven't been taken yet.
    errors: Mutex<Vec<String>>,
    count: AtomicUsize,
    /// Why the device was lost.
    loss: OnceLock<String>,
}

impl Faults {
    /// Installs handlers that collect the faults of a device. Without them, wgpu panics on errors. Each fault requests a
    /// repaint.
    pub fn watch(device: &wgpu::Device, ctx: &egui::Context) -> Self {
        let faults = Self::default();
        let (shared, repaint) = (faults.clone(), ctx.clone());
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            shared.add(error.to_string());
            repaint.request_repaint();
        }));
        let (shared, repaint) = (faults.clone(), ctx.clone());
        // Closing the window also loses the device; the reason is unused then.
        device.set_device_lost_callback(move |reason, message| {
            let message = match message.as_str() {
                "" => format!("{reason:?}").to_lowercase(),
                message => message.to_owned(),
            };
            _ = shared.0.loss.set(message);
            repaint.request_repaint();
        });
        faults
    }

    fn add(&self, message: String) {
        print_line(format_args!("hitscope: graphics: {message}"));
        self.0.count.fetch_add(1, Ordering::Relaxed);
        self.errors().push(message);
    }

    /// The errors. A poisoned lock still holds them.
    fn errors(&self) -> std::sync::MutexGuard<'_, Vec<String>> {
        self.0.errors.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The first error since the last call.
    pub fn take(&self) -> Option<String> {
        self.errors().drain(..).next()
    }

    /// The number of errors so far.
    pub fn count(&self) -> usize {
        self.0.count.load(Ordering::Relaxed)
    }

    /// Why the device was lost; `None` if it works.
    pub fn loss(&self) -> Option<&str> {
        self.0.loss.get().map(String::as_str)
    }
}
