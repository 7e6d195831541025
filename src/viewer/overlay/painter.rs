//! The overlay's painter: draws in the background on a software GPU, and shows the last drawing until the next one
//! is done.

use super::OverlayError;
use crate::gpu::GpuError;
use crate::gpu::drawing::{Canvas, Drawing, DrawingState, Overlay, Paces, Targets};
use crate::task::{Task, TaskPanicked};
use std::cell::Cell;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Interval at which the window shows the progress of a slow drawing.
const PROGRESS: Duration = Duration::from_millis(100);

/// A drawing in progress.
struct Running {
    drawing: Drawing,
    canvas: Canvas,
    state: Arc<DrawingState>,
    /// Returns whether the drawing was finished, and the adapted slice sizes.
    task: Task<(bool, Paces)>,
}

/// The drawn overlay.
pub struct Painter {
    overlay: Arc<Overlay>,
    /// Whether drawings are made in slices, in the background.
    is_sliced: bool,
    paces: Paces,
    targets: Option<Arc<Targets>>,
    /// The last complete drawing and the index of its texture.
    shown: Option<(Drawing, usize)>,
    /// The drawing whose depth the depth texture holds.
    depth_of: Option<Drawing>,
    running: Option<Running>,
}

impl Painter {
    /// A painter with these pipelines; draws in slices if `is_sliced`.
    pub fn new(overlay: Arc<Overlay>, is_sliced: bool) -> Self {
        Self {
            overlay,
            is_sliced,
            paces: Paces::default(),
            targets: None,
            shown: None,
            depth_of: None,
            running: None,
        }
    }

    /// The texture of a drawing. While the drawing is in progress: the last drawing of the same view; or the incomplete
    /// new one, if its lines are mostly new; or `None`.
    ///
    /// # Errors
    /// See [`OverlayError`]; the next call starts again.
    pub fn draw(
        &mut self,
        drawing: &Drawing,
        ctx: &egui::Context,
    ) -> Result<Option<&wgpu::Texture>, OverlayError> {
        self.finish()?;
        if self.is_shown(drawing) {
            self.cancel();
        } else {
            match &self.running {
                Some(running) if running.drawing == *drawing => {}
                // The textures are in use until it has ended.
                Some(_) => self.cancel(),
                None => self.start(drawing, ctx)?,
            }
        }
        Ok(self.texture(drawing))
    }

    /// Whether the texture shows exactly this drawing.
    pub fn is_shown(&self, drawing: &Drawing) -> bool {
        self.shown
            .as_ref()
            .is_some_and(|(shown, _)| shown == drawing)
    }

    /// Cancels the drawing in progress.
    pub fn cancel(&self) {
        if let Some(running) = &self.running {
            running.state.is_cancelled.store(true, Ordering::Relaxed);
        }
    }

    /// Takes the thread's result, if it has finished.
    fn finish(&mut self) -> Result<(), TaskPanicked> {
        let result = match &self.running {
            Some(running) => running.task.poll(),
            None => return Ok(()),
        };
        if matches!(result, Ok(None)) {
            return Ok(());
        }
        let Some(running) = self.running.take() else {
            return Ok(());
        };
        let Some((is_whole, paces)) = result? else {
            return Ok(());
        };
        self.paces = paces;
        if running.state.has_lines.load(Ordering::Relaxed) {
            self.depth_of = Some(running.drawing.clone());
        }
        if is_whole {
            self.shown = Some((running.drawing, running.canvas.colour));
        }
        Ok(())
    }

    fn start(&mut self, drawing: &Drawing, ctx: &egui::Context) -> Result<(), GpuError> {
        let canvas = self.canvas(drawing)?;
        self.depth_of = None;
        let state = Arc::new(DrawingState::default());
        if !self.is_sliced {
            let mut paces = Paces::UNLIMITED;
            self.overlay
                .draw(drawing, &canvas, &mut paces, &state, || ());
            self.depth_of = Some(drawing.clone());
            self.shown = Some((drawing.clone(), canvas.colour));
            return Ok(());
        }
        let (overlay, mut paces) = (Arc::clone(&self.overlay), self.paces);
        let (then, canvas_then, state_then) = (drawing.clone(), canvas.clone(), Arc::clone(&state));
        let repaint = ctx.clone();
        let work = move || {
            let last = Cell::new(Instant::now());
            let progress = || {
                if last.get().elapsed() > PROGRESS {
                    last.set(Instant::now());
                    repaint.request_repaint();
                }
            };
            let is_whole = overlay.draw(&then, &canvas_then, &mut paces, &state_then, progress);
            (is_whole, paces)
        };
        self.running = Some(Running {
            drawing: drawing.clone(),
            canvas,
            state,
            task: Task::spawn("overlay", ctx, work),
        });
        Ok(())
    }

    /// The texture that isn't shown, of the drawing's size.
    fn canvas(&mut self, drawing: &Drawing) -> Result<Canvas, GpuError> {
        let size = drawing.view.size();
        let is_right = |targets: &&Arc<Targets>| targets.size() == size;
        let targets = match self.targets.as_ref().filter(is_right) {
            Some(targets) => Arc::clone(targets),
            None => {
                // The old textures make room for the new ones.
                (self.shown, self.depth_of, self.targets) = (None, None, None);
                Arc::new(Targets::new(self.overlay.gpu().0, size)?)
            }
        };
        self.targets = Some(Arc::clone(&targets));
        let has_depth = self.depth_of.as_ref();
        Ok(Canvas {
            targets,
            colour: self.shown.as_ref().map_or(0, |(_, number)| 1 - number),
            has_depth: has_depth.is_some_and(|of| of.has_depth_of(drawing)),
        })
    }

    fn texture(&self, drawing: &Drawing) -> Option<&wgpu::Texture> {
        let shown = self
            .shown
            .as_ref()
            .filter(|(shown, _)| shown.has_depth_of(drawing));
        let running = self.running.as_ref().filter(|running| {
            running.drawing == *drawing && running.state.has_lines.load(Ordering::Relaxed)
        });
        let number = match (shown, running) {
            (Some((shown, _)), Some(running)) if drawing.is_mostly_new_to(shown) => {
                running.canvas.colour
            }
            (Some((_, number)), _) => *number,
            (None, Some(running)) => running.canvas.colour,
            (None, None) => return None,
        };
        Some(self.targets.as_ref()?.colour(number))
    }
}
