//! The picture, what lies over it, and the pointer on it.

use super::{App, Pick};
use crate::overlay::Options;
use crate::overlay::wireframe::WireframeEdges;
use crate::settings::Tab;
use crate::task::Task;
use crate::tracer::Request;
use egui::{Color32, PointerButton, Pos2, Rect, Response, Sense};
use glam::{DVec2, DVec3, UVec2, Vec3};
use hitscope_core::Camera;
use hitscope_core::camera::Turntable;
use hitscope_core::integrator::Context;
use hitscope_core::srgb::from_display;
use hitscope_lab::commands::DARK_BACKGROUND;
use hitscope_lab::inspection::Inspection;
use std::sync::Arc;

/// Where the picture is: whole physical pixels, so that each of its pixels is one of the screen's.
#[derive(Clone, Copy)]
struct Canvas {
    rect: Rect,
    resolution: UVec2,
    pixels_per_point: f32,
}

impl Canvas {
    fn new(available: Rect, pixels_per_point: f32) -> Self {
        let min = (available.min.to_vec2() * pixels_per_point).ceil();
        let max = (available.max.to_vec2() * pixels_per_point).floor();
        let size = (max - min).max(egui::Vec2::splat(1.0));
        Self {
            rect: Rect::from_min_size((min / pixels_per_point).to_pos2(), size / pixels_per_point),
            resolution: UVec2::new(size.x as u32, size.y as u32),
            pixels_per_point,
        }
    }

    /// The strips beside whole pixels; what the picture covers needn't be filled first.
    fn rest_of(&self, available: Rect) -> [Rect; 4] {
        let (min, max) = (self.rect.min, self.rect.max);
        [
            Rect {
                max: Pos2::new(min.x, available.max.y),
                ..available
            },
            Rect {
                max: Pos2::new(available.max.x, min.y),
                ..available
            },
            Rect {
                min: Pos2::new(max.x, available.min.y),
                ..available
            },
            Rect {
                min: Pos2::new(available.min.x, max.y),
                ..available
            },
        ]
    }

    /// In physical pixels from the picture's top left corner.
    fn pixel_of(&self, pos: Pos2) -> DVec2 {
        let offset = (pos - self.rect.min) * self.pixels_per_point;
        DVec2::new(offset.x.into(), offset.y.into())
    }

    fn pos_of(&self, pixel: DVec2) -> Pos2 {
        let offset = egui::vec2(pixel.x as f32, pixel.y as f32) / self.pixels_per_point;
        self.rect.min + offset
    }
}

impl App {
    pub(super) fn canvas_ui(&mut self, ui: &mut egui::Ui) {
        egui::CentralPanel::no_frame().show(ui, |ui| {
            let available = ui.available_rect_before_wrap();
            let canvas = Canvas::new(available, ui.ctx().pixels_per_point());
            for rest in canvas.rest_of(available) {
                ui.painter().rect_filled(rest, 0.0, ui.visuals().panel_fill);
            }
            let response = ui.allocate_rect(canvas.rect, Sense::click_and_drag());
            response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Image, true, "Rendered picture")
            });
            self.resolution = canvas.resolution;
            self.canvas_rect = canvas.rect;
            self.turntable.up_axis = self.settings.up_axis();
            if std::mem::take(&mut self.is_unframed) {
                let bounds = self.document.loaded.scene.bounds();
                self.turntable.frame(bounds, canvas.resolution);
            }
            self.pointer(ui, &response, canvas);
            self.turn(ui);
            self.paint(ui, canvas, response.dragged());
            self.tracer
                .request(self.wanted(ui.ctx(), canvas.resolution));
        });
    }

    /// Moves the camera on its way round the mesh.
    fn turn(&mut self, ui: &egui::Ui) {
        /// Once round in twelve seconds, however long a frame takes, unless that is very long.
        const RADIANS_PER_S: f64 = std::f64::consts::TAU / 12.0;
        const LONGEST_S: f64 = 0.2;
        if self.is_turning {
            let secs = f64::from(ui.input(|input| input.unstable_dt)).min(LONGEST_S);
            self.turntable.turn(secs * RADIANS_PER_S);
            ui.ctx().request_repaint();
        }
    }

    /// What is to be traced for the window as it is.
    fn wanted(&self, ctx: &egui::Context, resolution: UVec2) -> Request {
        let background = match ctx.theme() {
            egui::Theme::Dark => DARK_BACKGROUND,
            egui::Theme::Light => Vec3::new(0.90, 0.91, 0.92),
        };
        Request {
            context: Context {
                scene: Arc::clone(&self.document.loaded.scene),
                intersector: Arc::clone(self.document.intersector()),
                second: Arc::clone(self.document.second()),
                camera: self.turntable.camera(resolution),
                shading: self.settings.shading(),
                background: from_display(background),
            },
            integrator: self.settings.integrator(),
            samples: self.settings.samples,
            shows_last_tree: self.shows_last_tree(),
        }
    }

    /// Drags, wheel and clicks.
    fn pointer(&mut self, ui: &egui::Ui, response: &Response, canvas: Canvas) {
        let drag = response.drag_delta() * canvas.pixels_per_point;
        let drag = DVec2::new(drag.x.into(), drag.y.into());
        let is_shift = ui.input(|input| input.modifiers.shift);
        if response.dragged_by(PointerButton::Primary) && !is_shift {
            self.turntable.orbit(drag, canvas.resolution);
        } else if response.dragged() {
            self.turntable.pan(drag, canvas.resolution);
        }

        if let Some(pos) = response.hover_pos() {
            /// A notch of a wheel, some 50 points, zooms by a fifth.
            const POINTS_PER_E: f32 = 220.0;
            let (scroll, pinch) =
                ui.input(|input| (input.smooth_scroll_delta(), input.zoom_delta()));
            let factor = (-(scroll.y + scroll.x) / POINTS_PER_E).exp() / pinch;
            if factor != 1.0 {
                let at = canvas.pixel_of(pos);
                let anchor = self
                    .surface_at(at)
                    .unwrap_or_else(|| self.turntable.on_pivot_plane(at, canvas.resolution));
                self.turntable.zoom(factor.into(), anchor);
            }
        }

        let Some(pos) = response.interact_pointer_pos() else {
            return;
        };
        if response.double_clicked() {
            if let Some(point) = self.surface_at(canvas.pixel_of(pos)) {
                self.turntable.set_pivot(point);
            }
        } else if response.clicked() {
            self.inspect(canvas.pixel_of(pos), ui.ctx());
        }
    }

    /// The place on the mesh under a pixel, in the scene's coordinates.
    fn surface_at(&self, at_px: DVec2) -> Option<DVec3> {
        let ray = self.turntable.camera(self.resolution).ray_through(at_px);
        let hit = self.document.intersector().closest_hit(&ray)?;
        Some(ray.origin.as_dvec3() + f64::from(hit.t) * ray.dir.as_dvec3())
    }

    fn inspect(&mut self, at_px: DVec2, ctx: &egui::Context) {
        let pixel = at_px.max(DVec2::ZERO).as_uvec2().min(self.resolution - 1);
        self.start_picking(self.turntable, self.resolution, pixel, ctx);
        self.settings.tab = Tab::Inspect;
    }

    /// Asks what a picked pixel's ray meets now.
    pub(super) fn inspect_again(&mut self, pick: &Pick, ctx: &egui::Context) {
        let pixel = UVec2::from_array(pick.inspection.pixel);
        self.start_picking(pick.turntable, pick.resolution, pixel, ctx);
    }

    fn start_picking(
        &mut self,
        turntable: Turntable,
        resolution: UVec2,
        pixel: UVec2,
        ctx: &egui::Context,
    ) {
        let scene = Arc::clone(&self.document.loaded.scene);
        let intersector = Arc::clone(self.document.intersector());
        let shading = self.settings.shading();
        // Every kernel on every triangle that the ray comes near: a hostile mesh has a million of them.
        let inspect = move || {
            let camera = turntable.camera(resolution);
            let inspection = Inspection::of_pixel(&scene, &*intersector, shading, &camera, pixel);
            let origin = scene.mesh().origin;
            let hit = inspection.hit.as_ref();
            let point = hit.map(|hit| DVec3::from_array(hit.position) - origin);
            Pick {
                inspection,
                turntable,
                resolution,
                point,
            }
        };
        self.picking = Some(Task::spawn("inspect", ctx, inspect));
    }

    /// Takes over what is known of the pixel that was clicked last.
    pub(super) fn poll_picking(&mut self) {
        let result = match self.picking.as_ref().map(Task::poll) {
            None | Some(Ok(None)) => return,
            Some(Ok(Some(pick))) => Ok(pick),
            Some(Err(broken)) => Err(broken),
        };
        self.picking = None;
        match result {
            Ok(pick) => self.pick = Some(pick),
            Err(broken) => self.error(broken),
        }
    }

    /// Traced picture, overlay, marker.
    fn paint(&mut self, ui: &egui::Ui, canvas: Canvas, is_dragging: bool) {
        if let Some((film, changed)) = self.tracer.take_changes() {
            self.picture.upload(film, changed);
        }
        // Everything over the picture is for the scene and the camera that it was taken with.
        let Some((scene, camera)) = self.tracer.shown().cloned() else {
            return;
        };
        let mut options = self.overlay_options(canvas.pixels_per_point);
        if !Arc::ptr_eq(&scene, &self.document.loaded.scene) {
            (options.picked, options.flaw) = (None, None);
        }
        let findings = self.document.known_findings();
        let health = findings.as_ref().map(|findings| &findings.health);
        let is_moving = is_dragging || self.tracer.is_moving();
        if is_moving && self.overlay.rests_while_moving() {
            options = Options::NOTHING;
        }
        let (overlay, error) = match self
            .overlay
            .draw(&scene, health, &camera, &options, ui.ctx())
        {
            Ok(texture) => (texture, None),
            Err(error) => (None, Some(error)),
        };
        let painter = ui.painter_at(canvas.rect);
        painter.extend(self.picture.shape(canvas.rect, overlay));
        if let Some(error) = error {
            self.settings.shows_wireframe = false;
            self.settings.shows_normals = false;
            self.error(error);
        }
        self.marker(&painter, &camera, canvas);
    }

    fn overlay_options(&self, pixels_per_point: f32) -> Options {
        let settings = &self.settings;
        let edges = if settings.shows_diagonals {
            WireframeEdges::Triangles
        } else {
            WireframeEdges::Polygons
        };
        let hit = self
            .pick
            .as_ref()
            .and_then(|pick| pick.inspection.hit.as_ref());
        Options {
            wireframe: settings.shows_wireframe.then_some(edges),
            wire_colour: settings.wire_colour,
            normals: settings.shows_normals.then_some(settings.shading()),
            normal_length: settings.normal_length,
            elements: self.document.loaded.scene.mesh().has_elements(),
            flaw: self.flaw,
            picked: hit.map(|hit| hit.triangle),
            line_width_px: pixels_per_point.max(1.0),
        }
    }

    /// A cross hair that stays at the picked point while the camera moves.
    fn marker(&self, painter: &egui::Painter, camera: &Camera, canvas: Canvas) {
        let point = self.pick.as_ref().and_then(|pick| pick.point);
        let Some(pixel) = point.and_then(|point| camera.pixel_of(point)) else {
            return;
        };
        let at = canvas.pos_of(pixel);
        for (colour, width) in [(Color32::BLACK, 3.0), (Color32::WHITE, 1.3)] {
            let stroke = egui::Stroke::new(width, colour);
            painter.circle_stroke(at, 7.0, stroke);
            for dir in [egui::Vec2::X, egui::Vec2::Y, -egui::Vec2::X, -egui::Vec2::Y] {
                painter.line_segment([at + 4.0 * dir, at + 11.0 * dir], stroke);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_canvas_lies_on_whole_pixels_at_any_scale() {
        let available = Rect::from_min_max(Pos2::new(0.0, 31.3), Pos2::new(901.7, 640.2));
        for scale in [1.0, 1.25, 1.5, 2.0] {
            let canvas = Canvas::new(available, scale);
            let corner = canvas.rect.max.to_vec2() * scale;
            assert!((corner - corner.round()).length() < 1e-3, "{scale}");
            assert!(available.expand(1e-3).contains_rect(canvas.rect));
            let middle = DVec2::new(10.5, 20.5);
            assert!((canvas.pixel_of(canvas.pos_of(middle)) - middle).length() < 1e-3);
        }
    }

    #[test]
    fn a_window_too_small_for_a_picture_has_one_pixel() {
        let canvas = Canvas::new(Rect::from_min_size(Pos2::ZERO, egui::Vec2::splat(0.3)), 1.0);
        assert_eq!(canvas.resolution, UVec2::ONE);
    }
}
