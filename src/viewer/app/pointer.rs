//! Pointer input on the picture: clicks, and the surface under the pointer. Drags and scrolling are in `navigation`.
//!
//! The point under the pointer is the one that the pixel there shows. While the camera moves, the picture on the screen
//! lags behind the newest camera, and its pixels may come from several cameras.

use super::App;
use super::canvas::Canvas;
use crate::comparison::Side;
use egui::{Event, PointerButton, Pos2, Response};
use glam::{DVec2, DVec3, UVec2};
use hitscope_core::film::ShownPixel;
use hitscope_core::{Camera, Ray};

/// Recognizes single and double clicks. egui's own click count covers a longer time than a double click takes.
#[derive(Default)]
pub(crate) struct Clicks {
    /// A click that may still become a double click.
    pub pending: Option<PendingClick>,
    /// Time of the last double click, by egui's clock.
    last_double_secs: Option<f64>,
}

impl Clicks {
    /// Moves the camera of the pending click with a scene whose origin has moved.
    pub fn shift(&mut self, by: DVec3) {
        if let Some(click) = &mut self.pending {
            click.shown.camera = click.shown.camera.moved(by);
        }
    }
}

/// A click that may still become a double click.
pub(crate) struct PendingClick {
    side: Side,
    shown: ShownPixel,
    pos: Pos2,
    /// Time when it becomes a single click, by egui's clock.
    due_secs: f64,
}

impl App {
    /// Handles drags, wheel and clicks.
    pub(super) fn pointer(&mut self, ui: &egui::Ui, response: &Response, canvas: Canvas) {
        if !self.magnify(ui, response, canvas) {
            self.navigate(ui, response, canvas);
        }
        if let Some(pos) = response.interact_pointer_pos() {
            self.click(ui, response, pos, canvas);
        }
        self.end_click(ui.ctx());
    }

    /// Sets the pivot on a double click; holds back a single click until it can't become a double click. At a low
    /// frame rate, both clicks of a double click may arrive in one frame.
    fn click(&mut self, ui: &egui::Ui, response: &Response, pos: Pos2, canvas: Canvas) {
        if !response.clicked() {
            return;
        }
        let side = self.side_at(pos, canvas);
        let Some(shown) = self.shown_on(side, pos, canvas) else {
            return;
        };
        let (delay, distance) = ui.ctx().options(|options| {
            let input = &options.input_options;
            (input.max_double_click_delay, input.max_click_dist)
        });
        let is_release = |event: &&Event| {
            let button = PointerButton::Primary;
            matches!(event, Event::PointerButton { button: b, pressed: false, .. } if *b == button)
        };
        let (now, clicks) = ui.input(|input| {
            let releases = input.events.iter().filter(is_release);
            (input.time, releases.count())
        });
        if ui.input(|input| input.modifiers.command) {
            self.pick_pixel(side, shown, true, ui.ctx());
            return;
        }
        let first = self.picked.clicks.pending.take();
        let is_second = first.is_some_and(|first| first.pos.distance(pos) <= distance);
        if is_second || clicks > 1 {
            self.picked.clicks.last_double_secs = Some(now);
            if let Some(point) = self.surface_on(side, &shown) {
                self.seen.turntable.centre_on(point);
            }
        } else if self
            .picked
            .clicks
            .last_double_secs
            .is_none_or(|last| now - last > delay)
        {
            // The third click of three is ignored.
            self.picked.clicks.pending = Some(PendingClick {
                side,
                shown,
                pos,
                due_secs: now + delay,
            });
        }
    }

    /// Inspects the pixel of a click that can no longer become a double click.
    fn end_click(&mut self, ctx: &egui::Context) {
        let Some(click) = &self.picked.clicks.pending else {
            return;
        };
        // At a low frame rate, the second click may still be in progress.
        let (now, is_down) = ctx.input(|input| (input.time, input.pointer.primary_down()));
        let left_secs = click.due_secs - now;
        if is_down {
            return;
        }
        if left_secs > 0.0 {
            ctx.request_repaint_after(std::time::Duration::from_secs_f64(left_secs));
            return;
        }
        let (side, shown) = (click.side, click.shown);
        self.picked.clicks.pending = None;
        self.pick_pixel(side, shown, false, ctx);
    }

    /// The camera of the picture on the screen; `None` while the screen shows another mesh or nothing.
    pub fn shown_camera(&self) -> Option<Camera> {
        let (scene, camera) = self.traced.on_screen.as_ref()?;
        let is_current = std::ptr::eq(scene.mesh(), self.open.document.loaded.scene.mesh());
        is_current.then_some(*camera)
    }

    /// What a pixel of the picture on the screen shows; `None` if it hasn't been traced yet, and while the screen shows
    /// another mesh.
    pub fn shown_pixel(&self, pixel: UVec2) -> Option<ShownPixel> {
        self.shown_camera()?;
        self.traced.shown.at(pixel)
    }

    /// What the pixel at a position on the screen shows.
    pub(super) fn shown_at(&self, pos: Pos2, canvas: Canvas) -> Option<ShownPixel> {
        let camera = self.shown_camera()?;
        let at = canvas.pixel_of(pos, &camera).max(DVec2::ZERO);
        self.shown_pixel(at.as_uvec2().min(camera.resolution() - 1))
    }

    /// The first point of the scene along a ray, in the scene's coordinates.
    pub(super) fn surface_along(&self, ray: &Ray) -> Option<DVec3> {
        let hit = self.open.document.intersector().closest_hit(ray)?;
        Some(ray.origin.as_dvec3() + f64::from(hit.t) * ray.dir.as_dvec3())
    }
}
