//! Opening files: the loading thread.

use crate::document::Document;
use crate::panels::progress::progress_ui;
use crate::task::{Task, TaskPanicked};
use hitscope_core::kernel::KernelChoice;
use hitscope_core::obj::{LoadError, LoadOptions, shown};
use hitscope_core::progress::Progress;
use hitscope_core::scene::SceneOptions;
use std::path::{Path, PathBuf};

/// A file that is being loaded.
pub struct Loading {
    /// The file.
    pub path: PathBuf,
    progress: Progress,
    task: Task<Result<Document, LoadError>>,
}

impl Loading {
    /// Starts the loading thread, which packs the scene for a kernel and adds an offset to its coordinates.
    pub fn start(
        path: PathBuf,
        load_options: LoadOptions,
        kernel: KernelChoice,
        options: SceneOptions,
        offset: f64,
        ctx: &egui::Context,
    ) -> Self {
        let progress = Progress::default();
        let (shared, file) = (progress.clone(), path.clone());
        let load = move || {
            let mut document = Document::load(&file, kernel, load_options, options, &shared)?;
            document.move_by(offset);
            Ok(document)
        };
        Self {
            path,
            progress,
            task: Task::spawn("load", ctx, load),
        }
    }

    /// The document or the load error, once loading has finished.
    ///
    /// # Errors
    /// [`TaskPanicked`] if the thread panicked.
    pub fn poll(&self) -> Result<Option<Result<Document, LoadError>>, TaskPanicked> {
        self.task.poll()
    }

    /// The file's name for messages.
    pub fn name(&self) -> String {
        shown(Path::new(self.path.file_name().unwrap_or_default()))
    }

    /// Signals the thread to stop.
    pub fn cancel(&self) {
        self.progress.cancel();
    }

    /// Shows the phase, the bytes read and a cancel button. Returns whether it was clicked.
    #[must_use]
    pub fn progress_ui(&self, ui: &mut egui::Ui) -> bool {
        let row = ui.horizontal_wrapped(|ui| {
            progress_ui(ui, &self.progress);
            ui.button("Cancel").clicked()
        });
        row.inner
    }
}
