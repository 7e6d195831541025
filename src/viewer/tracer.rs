//! Tracing of the window's picture: posts jobs to the threads and collects their tiles.
//!
//! While the camera moves, each new request waits for the first pass of the previous request, which is coarse
//! enough to be fast.

use crate::times::Times;
use glam::{UVec2, Vec3};
use hitscope_core::integrator::{Context, Integrator};
use hitscope_core::plan::PixelRect;
use hitscope_core::plan::{Plan, STEPS};
use hitscope_core::render::{Job, Message, RenderPanic, Renderer, TileResult};
use hitscope_core::{Camera, Film, Scene};
use std::ops::{Range, RangeInclusive};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Target time of a frame while the camera moves. Less than 33 ms, as a late frame takes twice the interval.
const FRAME: Range<Duration> = Duration::from_millis(24)..Duration::from_millis(30);
/// Time of the first pass within a frame. Drawing the window takes almost no time with a GPU, and half of the frame
/// without one.
const FIRST_PASS: RangeInclusive<Duration> = Duration::from_millis(4)..=Duration::from_millis(20);
/// Time limit for collecting tiles in one frame.
const COLLECTING: Duration = Duration::from_millis(6);
/// A picture that stays longer than this ends a movement.
const LOOK: Duration = Duration::from_millis(250);
/// Refinement begins when nothing has changed for this long. Until then the CPU is free to draw the window, which
/// takes most of its time without a GPU.
const REST: Duration = Duration::from_millis(80);
/// Rays per second per thread, until they are measured.
const ASSUMED_SPEED: f64 = 1e6;

/// A request for a picture.
#[derive(Clone)]
pub struct Request {
    /// Scene, camera and kernels.
    pub context: Context,
    /// The view.
    pub integrator: &'static Integrator,
    /// Samples per pixel of the finished picture.
    pub samples: u32,
    /// Whether the view shows the cost of rays in the final tree.
    pub shows_last_tree: bool,
}

impl PartialEq for Request {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&self.context, &other.context);
        Arc::ptr_eq(&a.scene, &b.scene)
            && Arc::ptr_eq(&a.intersector, &b.intersector)
            && Arc::ptr_eq(&a.second, &b.second)
            && (a.camera, a.shading, a.background) == (b.camera, b.shading, b.background)
            && (self.integrator.name, self.samples) == (other.integrator.name, other.samples)
            && self.shows_last_tree == other.shows_last_tree
    }
}

/// The request that the threads are working on.
struct PostedRequest {
    request: Request,
    at: Instant,
    /// Time from posting to the newest tile.
    lasted: Duration,
}

/// Figures for the status line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Status {
    /// Number of samples that every pixel has; 0 while the picture consists of coarse blocks.
    pub samples: u32,
    /// Passes done.
    pub passes: usize,
    /// Total number of passes.
    pub pass_count: usize,
    /// Rays per second of all threads together, while they are tracing.
    pub rays_per_s: f64,
    /// Time from the last change to the newest tile.
    pub lasted: Duration,
    /// Time between the pictures of the last movement: median and 99th percentile.
    pub frame_interval: Option<[Duration; 2]>,
}

/// Traces the newest request.
pub struct Tracer {
    renderer: Renderer,
    film: Film,
    posted: Option<PostedRequest>,
    /// Scene and camera of the newest picture whose first pass is done.
    shown: Option<(Arc<Scene>, Camera)>,
    shown_at: Option<Instant>,
    /// Times between the pictures of a movement.
    frame_intervals: Times,
    /// Time of the first pass, adapted so that frames meet their target.
    first_pass: Duration,
    changed: Option<PixelRect>,
    /// Rays traced and the seconds that threads spent on them, with an exponential decay.
    rays: f64,
    busy_secs: f64,
    /// Paused by the user.
    is_paused: bool,
    /// Whether refinement waits until nothing has changed for a while.
    is_held: bool,
    /// Whether the last picture stayed long enough before the next request to end a movement.
    has_rested: bool,
    /// Whether tiles are shown before the first pass is complete.
    shows_parts: bool,
    non_finite: u64,
    /// Number of the picture's rays that hit the scene.
    hits: u64,
}

impl Tracer {
    /// Starts the threads.
    pub fn new(threads: usize, ctx: &egui::Context) -> Self {
        let ctx = ctx.clone();
        Self {
            renderer: Renderer::new(threads, move || ctx.request_repaint()),
            film: Film::new(Plan::new(UVec2::ONE, 1, 1), Vec3::ZERO),
            posted: None,
            shown: None,
            shown_at: None,
            frame_intervals: Times::default(),
            first_pass: Duration::from_millis(12),
            changed: None,
            rays: 0.0,
            busy_secs: 0.0,
            is_paused: false,
            is_held: false,
            has_rested: true,
            shows_parts: false,
            non_finite: 0,
            hits: 0,
        }
    }

    /// Collects the tiles that the threads have sent. Returns panics.
    pub fn collect(&mut self, ctx: &egui::Context) -> Vec<RenderPanic> {
        let start = Instant::now();
        let mut panics = Vec::new();
        while let Some(message) = self.renderer.try_next() {
            match message {
                Message::Tile(tile) => self.add(&tile),
                Message::Panicked(unit, panic) => {
                    self.film.skip(unit);
                    panics.push(panic);
                }
            }
            if start.elapsed() > COLLECTING {
                // The remaining tiles are collected in the next frame.
                ctx.request_repaint();
                break;
            }
        }
        self.end_hold(ctx);
        if self.film.passes_done() > 0
            && let Some(posted) = &self.posted
            && !self.is_shown(&posted.request.context)
        {
            let Context { scene, camera, .. } = &posted.request.context;
            self.shown = Some((Arc::clone(scene), *camera));
            self.count_frame();
        }
        panics
    }

    /// Records the time since the previous picture.
    fn count_frame(&mut self) {
        let now = Instant::now();
        let interval = self.shown_at.map(|last| now - last);
        self.shown_at = Some(now);
        match interval {
            Some(interval) if !self.has_rested => {
                self.frame_intervals.push(interval);
                self.adapt(interval);
            }
            // A new movement begins after a rest.
            _ => self.frame_intervals.clear(),
        }
    }

    /// Adjusts the time of the first pass to the time that the last frame took.
    fn adapt(&mut self, interval: Duration) {
        let factor = if interval > FRAME.end {
            0.9
        } else if interval < FRAME.start {
            1.05
        } else {
            return;
        };
        let wanted = self.first_pass.mul_f64(factor);
        self.first_pass = wanted.clamp(*FIRST_PASS.start(), *FIRST_PASS.end());
    }

    /// Starts refinement once nothing has changed for a while.
    fn end_hold(&mut self, ctx: &egui::Context) {
        if !self.is_held {
            return;
        }
        let since = self
            .posted
            .as_ref()
            .map_or(REST, |posted| posted.at.elapsed());
        if since < REST {
            ctx.request_repaint_after(REST - since);
        } else {
            self.is_held = false;
            self.apply_pause();
        }
    }

    fn add(&mut self, tile: &TileResult) {
        /// Half-life of the measurements, in seconds of one thread.
        const MEMORY_SECS: f64 = 0.5;
        let rect = self.film.add(&tile.samples);
        self.changed = Some(self.changed.map_or(rect, |changed| changed.union(rect)));
        self.non_finite += u64::from(tile.non_finite);
        self.hits += u64::from(tile.hits);
        let busy = tile.busy.as_secs_f64();
        let fade = (-busy / MEMORY_SECS).exp2();
        self.rays = self.rays * fade + f64::from(tile.rays);
        self.busy_secs = self.busy_secs * fade + busy;
        if let Some(posted) = &mut self.posted {
            posted.lasted = posted.at.elapsed();
        }
    }

    /// Traces a request, now or after the first pass of the previous request.
    pub fn request(&mut self, request: Request) {
        let is_news = self
            .posted
            .as_ref()
            .is_none_or(|posted| posted.request != request);
        // A request for another scene doesn't wait: the old picture is useless.
        let is_same_scene = self.is_shown_scene(&request.context.scene);
        let is_waiting = self.posted.is_some() && self.film.passes_done() == 0 && is_same_scene;
        if !is_news || is_waiting {
            return;
        }
        let size = request.context.camera.resolution();
        let plan = Plan::new(size, self.first_step(size), request.samples);
        let background = request.context.background;
        // A picture of the same scene stays until the first pass of the new picture is done.
        if self.film.size() == size && is_same_scene {
            self.film.restart(plan.clone(), background);
        } else {
            self.film = Film::new(plan.clone(), background);
            self.changed = None;
        }
        if !is_same_scene {
            self.changed = Some(PixelRect {
                min: UVec2::ZERO,
                max: size,
            });
            self.shown = Some((Arc::clone(&request.context.scene), request.context.camera));
            self.shows_parts = true;
        }
        self.non_finite = 0;
        self.hits = 0;
        // A slow first pass is a slow frame, not a rest.
        self.has_rested = self.shown_at.is_none_or(|at| at.elapsed() > LOOK);
        self.is_held = true;
        self.apply_pause();
        self.renderer.post(Job {
            context: request.context.clone(),
            integrator: request.integrator,
            plan,
        });
        self.posted = Some(PostedRequest {
            request,
            at: Instant::now(),
            lasted: Duration::ZERO,
        });
    }

    /// The smallest block size with which the first pass is fast enough.
    fn first_step(&self, size: UVec2) -> u32 {
        let affordable = self.rays_per_s() * self.first_pass.as_secs_f64();
        let pixels = f64::from(size.x) * f64::from(size.y);
        let is_affordable = |step: &u32| pixels / f64::from(step * step) <= affordable;
        let coarsest = STEPS[STEPS.len() - 1];
        STEPS.into_iter().find(is_affordable).unwrap_or(coarsest)
    }

    fn rays_per_s(&self) -> f64 {
        let speed = if self.busy_secs > 0.0 {
            self.rays / self.busy_secs
        } else {
            ASSUMED_SPEED
        };
        speed * self.renderer.thread_count() as f64
    }

    /// The picture and the rectangle that has changed since the last call; `None` until the first pass is done,
    /// except for the first picture of a scene.
    pub fn take_changes(&mut self) -> Option<(&Film, PixelRect)> {
        if self.film.passes_done() == 0 && !self.shows_parts {
            return None;
        }
        self.shows_parts &= self.film.passes_done() == 0;
        let changed = self.changed.take()?;
        Some((&self.film, changed))
    }

    fn is_shown(&self, context: &Context) -> bool {
        let is_same = |(scene, camera): &(Arc<Scene>, Camera)| {
            Arc::ptr_eq(scene, &context.scene) && *camera == context.camera
        };
        self.shown.as_ref().is_some_and(is_same)
    }

    fn is_shown_scene(&self, scene: &Arc<Scene>) -> bool {
        self.shown
            .as_ref()
            .is_some_and(|(shown, _)| Arc::ptr_eq(shown, scene))
    }

    /// Whether the picture changed so recently that the camera may be moving.
    pub fn is_moving(&self) -> bool {
        self.is_held
    }

    /// Scene and camera of the picture that is shown; `None` before the first one.
    pub fn shown(&self) -> Option<&(Arc<Scene>, Camera)> {
        self.shown.as_ref()
    }

    /// The request that is being traced.
    pub fn posted(&self) -> Option<&Request> {
        self.posted.as_ref().map(|posted| &posted.request)
    }

    /// Whether the picture shows part of a surface; `None` until a ray has hit or every pixel has its own ray.
    pub fn shows_surface(&self) -> Option<bool> {
        let is_shown = self.hits > 0;
        (is_shown || self.film.samples() > 0).then_some(is_shown)
    }

    /// The picture so far.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// Number of samples of this picture with a non-finite colour.
    pub fn non_finite(&self) -> u64 {
        self.non_finite
    }

    /// Figures for the status line.
    pub fn status(&self) -> Status {
        Status {
            samples: self.film.samples(),
            passes: self.film.passes_done(),
            pass_count: self.film.plan().pass_count(),
            rays_per_s: if self.busy_secs > 0.0 {
                self.rays_per_s()
            } else {
                0.0
            },
            lasted: self
                .posted
                .as_ref()
                .map_or(Duration::ZERO, |posted| posted.lasted),
            frame_interval: self.frame_intervals.median_and_99th(),
        }
    }

    /// Cancels the work on the current picture.
    pub fn stop(&mut self) {
        self.renderer.cancel();
    }

    /// Whether the user has paused refinement.
    pub fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Pauses or resumes refinement.
    pub fn toggle_pause(&mut self) {
        self.is_paused = !self.is_paused;
        self.apply_pause();
    }

    fn apply_pause(&mut self) {
        if self.is_paused || self.is_held {
            self.renderer.pause();
        } else {
            self.renderer.resume();
        }
    }
}

#[cfg(test)]
mod tests;
