//! Measures the open scene in the background.

use crate::task::Task;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::{Camera, Scene};
use hitscope_lab::measure::scene::{SceneRow, SceneSizes, measure};
use std::sync::{Arc, Mutex, PoisonError};

/// What the plot's vertical axis shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axis {
    /// Ulps that 99 of a hundred t don't exceed.
    #[default]
    ErrorOfT,
    /// Wrong decisions a million.
    Wrong,
}

impl Axis {
    /// Of a kernel.
    pub fn value(self, row: &SceneRow) -> f64 {
        match self {
            Self::ErrorOfT => row.t_ulps.map_or(0.0, |t| t.p99),
            Self::Wrong => row.wrong_per_million,
        }
    }

    /// What stands for zero, which has no logarithm: below all that can be measured.
    pub fn floor(self) -> f64 {
        match self {
            Self::ErrorOfT => 0.01,
            Self::Wrong => 1.0,
        }
    }
}

/// Where a measurement stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TradeState {
    /// Kernel after kernel.
    Measuring,
    /// All of them.
    Done,
    /// Its thread broke off.
    Failed,
}

/// A measurement of one scene.
pub struct Trade {
    /// Replaced by a longer list with every kernel, so that the window only takes a pointer.
    rows: Arc<Mutex<Arc<[SceneRow]>>>,
    progress: Progress,
    task: Task<Result<(), Cancelled>>,
    state: TradeState,
    /// What the plot shows.
    pub axis: Axis,
}

impl Trade {
    /// Begins to measure a scene as a camera sees it.
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
            axis,
        }
    }

    /// What is there so far, in the table's order.
    pub fn rows(&self) -> Arc<[SceneRow]> {
        Arc::clone(&self.rows.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// How many rows there will be.
    pub fn kernel_count(&self) -> usize {
        TRIANGLE_KERNELS.len()
    }

    /// Looks whether the thread has ended.
    pub fn poll(&mut self) {
        if self.state == TradeState::Measuring {
            self.state = match self.task.poll() {
                Ok(None) => TradeState::Measuring,
                Ok(Some(_)) => TradeState::Done,
                Err(_) => TradeState::Failed,
            };
        }
    }

    /// Where it stands, as of the last [`poll`](Self::poll).
    pub fn state(&self) -> TradeState {
        self.state
    }
}

impl Drop for Trade {
    fn drop(&mut self) {
        self.progress.cancel();
    }
}
