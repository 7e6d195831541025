//! Measures the open scene in the background.

use crate::panels::trade::Axis;
use crate::task::Task;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::{Camera, Scene};
use hitscope_lab::measure::scene::{SceneRow, SceneSizes, measure};
use std::sync::{Arc, Mutex, PoisonError};

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
    scene: Arc<Scene>,
    rows: Arc<Mutex<Vec<SceneRow>>>,
    progress: Arc<Progress>,
    task: Task<Result<(), Cancelled>>,
    state: TradeState,
    /// What the plot shows.
    pub axis: Axis,
}

impl Trade {
    /// Begins to measure a scene as a camera sees it.
    pub fn start(scene: &Arc<Scene>, camera: Camera, axis: Axis, ctx: &egui::Context) -> Self {
        let rows: Arc<Mutex<Vec<SceneRow>>> = Arc::default();
        let progress: Arc<Progress> = Arc::default();
        let work = {
            let (scene, rows, progress) =
                (Arc::clone(scene), Arc::clone(&rows), Arc::clone(&progress));
            let ctx = ctx.clone();
            move || {
                measure(&scene, &camera, SceneSizes::PANEL, &progress, |row| {
                    rows.lock()
                        .unwrap_or_else(PoisonError::into_inner)
                        .push(row);
                    ctx.request_repaint();
                })
            }
        };
        Self {
            scene: Arc::clone(scene),
            rows,
            progress,
            task: Task::spawn("trade", ctx, work),
            state: TradeState::Measuring,
            axis,
        }
    }

    /// Whether it is of this scene.
    pub fn is_of(&self, scene: &Arc<Scene>) -> bool {
        Arc::ptr_eq(&self.scene, scene)
    }

    /// What is there so far, in the table's order.
    pub fn rows(&self) -> Vec<SceneRow> {
        let rows = self.rows.lock().unwrap_or_else(PoisonError::into_inner);
        rows.clone()
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
