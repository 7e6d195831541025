//! Background measurement of the kernels' speed and accuracy in the open scene.

use crate::task::Task;
use hitscope_core::group::ShapeKernels;
use hitscope_core::kernel::KernelChoice;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::{Camera, Scene};
use hitscope_lab::measure::scene::{SceneRow, SceneSizes, measure};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// The vertical axis of the plot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axis {
    /// 99th percentile of the error of t, in ulps.
    #[default]
    ErrorOfT,
    /// Wrong decisions per million rays.
    Wrong,
}

impl Axis {
    /// The value of a kernel on this axis.
    pub fn value(self, row: &SceneRow) -> f64 {
        match self {
            Self::ErrorOfT => row.t_ulps.map_or(0.0, |t| t.p99),
            Self::Wrong => row.wrong_per_million,
        }
    }

    /// The value that stands for zero on the logarithmic axis; it is below every measurable value.
    pub fn floor(self) -> f64 {
        match self {
            Self::ErrorOfT => 0.01,
            Self::Wrong => 1.0,
        }
    }
}

/// The state of a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TradeState {
    /// In progress.
    Measuring,
    /// All kernels have been measured.
    Done,
    /// The user cancelled the measurement.
    Cancelled,
    /// The thread panicked.
    Failed,
}

/// A measurement of one scene.
pub struct Trade {
    /// The rows so far. A longer list replaces it after each kernel, so that the window only copies a pointer.
    rows: Arc<Mutex<Arc<[SceneRow]>>>,
    progress: Progress,
    task: Task<Result<(), Cancelled>>,
    state: TradeState,
    /// The scene's shapes with their kernels.
    shapes: Vec<ShapeKernels>,
    /// The vertical axis of the plot.
    pub axis: Axis,
}

impl Trade {
    /// Starts the measurement of a scene with rays from a camera.
    pub fn start(scene: &Arc<Scene>, camera: Camera, axis: Axis, ctx: &egui::Context) -> Self {
        let rows: Arc<Mutex<Arc<[SceneRow]>>> = Arc::default();
        let progress = Progress::default();
        let work = {
            let (scene, rows, progress) = (Arc::clone(scene), Arc::clone(&rows), progress.clone());
            let ctx = ctx.clone();
            move || {
                measure(&scene, &camera, SceneSizes::PANEL, &progress, |row| {
                    let mut rows = rows.lock().unwrap_or_else(PoisonError::into_inner);
                    *rows = rows.iter().cloned().chain([row]).collect();
                    drop(rows);
                    ctx.request_repaint();
                })
            }
        };
        Self {
            rows,
            progress,
            task: Task::spawn("trade", ctx, work),
            state: TradeState::Measuring,
            shapes: scene.kernels(),
            axis,
        }
    }

    /// The rows so far: shape by shape, in the order of the kernel tables.
    pub fn rows(&self) -> Arc<[SceneRow]> {
        Arc::clone(&self.rows.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// The final number of rows.
    pub fn kernel_count(&self) -> usize {
        self.shapes.iter().map(|shape| shape.kernels.len()).sum()
    }

    /// The scene's shapes with their kernels.
    pub fn shapes(&self) -> &[ShapeKernels] {
        &self.shapes
    }

    /// Whether a choice uses a row's kernel for the row's shape.
    pub fn is_used(&self, choice: KernelChoice, row: &SceneRow) -> bool {
        let mut shapes = self.shapes.iter();
        let shape = shapes.find(|shape| shape.shape.name == row.shape);
        let used = shape.and_then(|shape| choice.among(&shape.kernels));
        used.is_some_and(|used| used.name == row.kernel)
    }

    /// Updates the state from the thread.
    pub fn poll(&mut self) {
        if self.state == TradeState::Measuring {
            self.state = match self.task.poll() {
                Ok(None) => TradeState::Measuring,
                Ok(Some(Ok(()))) => TradeState::Done,
                Ok(Some(Err(Cancelled))) => TradeState::Cancelled,
                Err(_) => TradeState::Failed,
            };
        }
    }

    /// The time since the start.
    pub fn elapsed(&self) -> Duration {
        self.task.elapsed()
    }

    /// Cancels the measurement; the rows so far stay.
    pub fn cancel(&self) {
        self.progress.cancel();
    }

    /// The state at the last [`poll`](Self::poll).
    pub fn state(&self) -> TradeState {
        self.state
    }
}

impl Drop for Trade {
    fn drop(&mut self) {
        self.cancel();
    }
}
