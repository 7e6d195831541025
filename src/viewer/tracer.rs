//! Tracing of the window's picture: posts jobs to the threads and collects their tiles.
//!
//! While the camera moves, each new request waits for the first pass of the previous request, which is coarse enough to
//! be fast. A view that needs lights is slower: while the camera moves, its preview is traced instead, which is the
//! first view of the table. The view follows once nothing has changed for a while, and replaces the preview when its
//! own first pass is done.

mod collecting;
mod limits;
mod noise;
mod pacing;
mod pausing;
mod request;
mod speed;
mod status;
mod stopwatch;

pub use limits::{LEAST_SAMPLES, Limits, StopReason};
pub use request::Request;
pub use status::Status;

use crate::times::Times;
use glam::{UVec2, Vec3};
use hitscope_core::integrator::{Context, INTEGRATORS};
use hitscope_core::plan::{Pass, PixelRect, Plan};
use hitscope_core::render::{Job, Renderer, TileResult};
use hitscope_core::{Camera, Film, Scene};
use noise::TileNoise;
use pacing::LOOK;
use request::PostedRequest;
use speed::Speed;
use std::sync::Arc;
use std::time::{Duration, Instant};
use stopwatch::Stopwatch;

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
    /// The block size that the user chose for the first pass.
    chosen_step: Option<u32>,
    changed: Option<PixelRect>,
    /// Pixels of the preview that changed and weren't taken before the view began.
    changed_before: Option<PixelRect>,
    /// Speeds of views that don't need lights, previews among them, and of those that do.
    speeds: [Speed; 2],
    noise: TileNoise,
    /// The number of passes done, and the mean luminance then, if it is known.
    luminance: (usize, Option<f64>),
    limits: Limits,
    /// The limit that is reached.
    stopped: Option<StopReason>,
    /// Paused by the user.
    is_paused: bool,
    /// Whether refinement waits until nothing has changed for a while.
    is_held: bool,
    /// Whether the last picture stayed long enough before the next request to end a movement.
    has_rested: bool,
    /// Whether the picture on the screen is that of a view that needs lights, not of its preview.
    shows_lit: bool,
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
            chosen_step: None,
            changed: None,
            changed_before: None,
            speeds: [Speed::default(); 2],
            noise: TileNoise::default(),
            luminance: (0, None),
            limits: Limits::default(),
            stopped: None,
            is_paused: false,
            is_held: false,
            has_rested: true,
            shows_lit: false,
            shows_parts: false,
            non_finite: 0,
            hits: 0,
        }
    }

    /// Traces the view whose preview is shown, with the preview's block size. The preview stays until the view's first
    /// pass is done.
    fn begin_view(&mut self) {
        let of_preview = self.film.plan().first_step();
        let step = match self.chosen_step {
            // The user chose the preview's blocks, but the view itself is slower.
            Some(_) => self
                .affordable_step(self.film.size(), false)
                .max(of_preview),
            None => of_preview,
        };
        let Some(posted) = &mut self.posted else {
            return;
        };
        posted.is_preview = false;
        let plan = Plan::new(self.film.size(), step, posted.request.samples);
        self.film.restart(plan, posted.request.context.background);
        self.changed_before = self.changed.take();
        self.post();
    }

    /// Updates the luminance to which noise is relative, once per pass.
    fn note_luminance(&mut self) {
        let passes = self.film.passes_done();
        if self.luminance.0 != passes {
            let noise = self.noise.total();
            self.luminance = (passes, noise.map(|noise| noise.luminance));
        }
    }

    /// The mean luminance at the end of the last pass, to which the noise of pixels is shown relative; `None` while
    /// noise isn't known or all is black.
    pub fn luminance(&self) -> Option<f64> {
        self.luminance.1.filter(|&luminance| luminance > 0.0)
    }

    fn add(&mut self, tile: TileResult) {
        let unit = tile.samples.unit;
        let rect = self.film.add(tile.samples);
        self.changed = Some(self.changed.map_or(rect, |changed| changed.union(rect)));
        self.non_finite += u64::from(tile.non_finite);
        self.hits += u64::from(tile.hits);
        let is_lit = self.is_lit();
        self.speeds[usize::from(is_lit)].add(tile.rays, tile.busy);
        if let Some(posted) = &mut self.posted {
            posted.lasted = posted.at.elapsed();
        }
        if is_lit && matches!(self.film.plan().pass(unit.pass), Pass::Samples { .. }) {
            self.noise.update(&self.film, unit.tile);
        }
    }

    /// Traces a request, now or after the first pass of the previous request.
    pub fn request(&mut self, request: Request) {
        let is_news = self
            .posted
            .as_ref()
            .is_none_or(|posted| posted.request != request);
        // A request for another mesh doesn't wait: the old picture is useless.
        let is_same_scene = self.is_shown_scene(&request.context.scene);
        // A view that needs lights is previewed, unless its camera's picture is already on the screen.
        let is_preview = request.is_lit() && !self.is_shown(&request.context);
        let is_lit = request.is_lit() && !is_preview;
        // A view that needs lights takes longer, so that only another such view waits for it.
        let is_slower = self.is_lit() && !is_lit;
        let is_waiting =
            self.posted.is_some() && self.film.passes_done() == 0 && is_same_scene && !is_slower;
        if !is_news || is_waiting {
            return;
        }
        let size = request.context.camera.resolution();
        let samples = if is_preview { 1 } else { request.samples };
        let plan = Plan::new(size, self.first_step(size, is_lit), samples);
        let background = request.context.background;
        // A picture of the same mesh stays until the first pass of the new picture is done.
        if self.film.size() == size && is_same_scene {
            self.film.restart(plan, background);
        } else {
            self.film = Film::new(plan, background);
            (self.changed, self.changed_before) = (None, None);
        }
        self.film.set_camera(request.context.camera);
        if !is_same_scene {
            self.changed = Some(PixelRect::whole(size));
            self.shown = Some((Arc::clone(&request.context.scene), request.context.camera));
            (self.shows_parts, self.shows_lit) = (true, false);
        }
        // A slow first pass is a slow frame, not a rest.
        self.has_rested = self.shown_at.is_none_or(|at| at.elapsed() > LOOK);
        self.is_held = true;
        self.posted = Some(PostedRequest {
            request,
            at: Instant::now(),
            lasted: Duration::ZERO,
            is_preview,
            refined: Stopwatch::default(),
        });
        self.post();
    }

    /// Passes the request and the film's plan to the threads.
    fn post(&mut self) {
        let Some(posted) = &mut self.posted else {
            return;
        };
        posted.refined = Stopwatch::default();
        let plan = self.film.plan().clone();
        self.noise = TileNoise::new(plan.tile_count());
        let job = Job {
            context: posted.request.context.clone(),
            integrator: if posted.is_preview {
                INTEGRATORS[0]
            } else {
                posted.request.integrator
            },
            plan,
        };
        (self.non_finite, self.hits, self.stopped) = (0, 0, None);
        self.luminance = (0, None);
        self.apply_pause();
        self.renderer.post(job);
    }

    /// The picture and the rectangle that has changed since the last call; `None` until the first pass is done,
    /// except for the first picture of a scene.
    pub fn take_changes(&mut self) -> Option<(&Film, PixelRect)> {
        let is_first_pass = self.film.passes_done() == 0;
        let changed = if is_first_pass && !self.shows_parts {
            None
        } else {
            self.shows_parts &= is_first_pass;
            self.changed.take()
        };
        let before = self.changed_before.take();
        let changed = match (before, changed) {
            (Some(before), Some(changed)) => before.union(changed),
            (before, changed) => before.or(changed)?,
        };
        Some((&self.film, changed))
    }

    /// Reports the whole picture as changed.
    pub fn show_again(&mut self) {
        self.changed_before = Some(PixelRect::whole(self.film.size()));
    }

    fn is_shown(&self, context: &Context) -> bool {
        let is_same = |(scene, camera): &(Arc<Scene>, Camera)| {
            Arc::ptr_eq(scene, &context.scene) && *camera == context.camera
        };
        self.shown.as_ref().is_some_and(is_same)
    }

    /// Whether the picture that is shown is of the same mesh, perhaps with another clip or other hidden parts.
    fn is_shown_scene(&self, scene: &Arc<Scene>) -> bool {
        self.shown
            .as_ref()
            .is_some_and(|(shown, _)| std::ptr::eq(shown.mesh(), scene.mesh()))
    }

    /// Whether the picture changed so recently that the camera may be moving.
    pub fn is_moving(&self) -> bool {
        self.is_held
    }

    /// Scene and camera of the picture that is shown; `None` before the first one.
    pub fn shown(&self) -> Option<&(Arc<Scene>, Camera)> {
        self.shown.as_ref()
    }

    /// Whether a view that needs lights is being traced, not its preview.
    fn is_lit(&self) -> bool {
        self.posted.as_ref().is_some_and(PostedRequest::is_lit)
    }

    /// Whether the picture to be shown is that of a view that needs lights, not of its preview.
    pub fn shows_lit(&self) -> bool {
        self.shows_lit
    }

    /// Whether nothing is left to trace for the request: the view has all samples, or a limit is reached.
    pub fn is_finished(&self) -> bool {
        let is_preview = self.posted.as_ref().is_none_or(|posted| posted.is_preview);
        !is_preview && (self.film.is_complete() || self.stopped.is_some())
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

    /// Cancels the work on the current picture.
    pub fn stop(&mut self) {
        self.renderer.cancel();
    }
}

#[cfg(test)]
mod tests;
