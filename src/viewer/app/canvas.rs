//! The picture with its overlay and marks.

use super::App;
use super::labels::labels_ui;
use super::pick::Pick;
use crate::comparison::Mode;
use crate::gpu::GpuError;
use crate::look::Development;
use crate::overlay::{self, Marks, OverlayInput};
use crate::theme;
use egui::{Color32, Pos2, Rect, Sense};
use glam::{DVec2, UVec2};
use hitscope_core::{Camera, Scene};
use std::sync::Arc;
use std::time::Duration;

/// Place of the picture in the window. It covers whole physical pixels, so that each pixel of the picture is one
/// pixel of the screen.
#[derive(Clone, Copy)]
pub(super) struct Canvas {
    pub rect: Rect,
    pub resolution: UVec2,
    pub pixels_per_point: f32,
    /// The part of the picture that is shown, from (0, 0) at the top left to (1, 1) at the bottom right.
    pub part: Rect,
}

impl Canvas {
    pub(super) fn new(available: Rect, pixels_per_point: f32) -> Self {
        let min = (available.min.to_vec2() * pixels_per_point).ceil();
        let max = (available.max.to_vec2() * pixels_per_point).floor();
        let size = (max - min).max(egui::Vec2::splat(1.0));
        Self {
            rect: Rect::from_min_size((min / pixels_per_point).to_pos2(), size / pixels_per_point),
            resolution: UVec2::new(size.x as u32, size.y as u32),
            pixels_per_point,
            part: Rect::from_min_max(Pos2::ZERO, Pos2::new(1.0, 1.0)),
        }
    }

    /// The place of a picture of another size: centred, as large as possible. Pixels are enlarged by whole factors
    /// only.
    pub(super) fn of_picture(available: Rect, pixels_per_point: f32, size: UVec2) -> Self {
        let whole = Self::new(available, pixels_per_point);
        let factors = whole.resolution.as_vec2() / size.as_vec2();
        let factor = factors.min_element();
        let factor = if factor > 1.0 { factor.floor() } else { factor };
        let covered = (size.as_vec2() * factor).floor().max(glam::Vec2::ONE);
        let margin = ((whole.resolution.as_vec2() - covered) / 2.0).floor();
        let to_points = |v: glam::Vec2| egui::vec2(v.x, v.y) / pixels_per_point;
        let min = whole.rect.min + to_points(margin);
        Self {
            rect: Rect::from_min_size(min, to_points(covered)),
            resolution: size,
            ..whole
        }
    }

    /// Converts a position on the screen to pixels of a camera's picture, from its top left corner. A picture of
    /// another size is stretched over the canvas.
    pub fn pixel_of(&self, pos: Pos2, camera: &Camera) -> DVec2 {
        let part = self.part_at(pos);
        DVec2::new(part.x.into(), part.y.into()) * camera.resolution().as_dvec2()
    }

    /// Converts a position on the screen to a position in the picture, from (0, 0) to (1, 1).
    pub fn part_at(&self, pos: Pos2) -> Pos2 {
        self.part
            .lerp_inside((pos - self.rect.min) / self.rect.size())
    }

    /// Converts a pixel of a camera's picture to a position on the screen.
    pub fn pos_of(&self, pixel: DVec2, camera: &Camera) -> Pos2 {
        let part = pixel / camera.resolution().as_dvec2();
        let part = Pos2::new(part.x as f32, part.y as f32);
        self.rect
            .lerp_inside((part - self.part.min) / self.part.size())
    }
}

impl App {
    pub(super) fn canvas_ui(&mut self, ui: &mut egui::Ui) {
        egui::CentralPanel::no_frame().show(ui, |ui| {
            let available = ui.available_rect_before_wrap();
            let mut canvas = self.place_picture(available, ui.ctx().pixels_per_point());
            canvas.part = self.shown.magnifier.part();
            let response = ui.allocate_rect(canvas.rect, Sense::click_and_drag());
            response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::Role::Image, true, "Rendered picture")
            });
            self.shown.canvas_rect = canvas.rect;
            self.use_resolution(canvas.resolution);
            self.pointer(ui, &response, canvas);
            canvas.part = self.shown.magnifier.part();
            self.rotate(ui);
            self.step_transition(ui.ctx());
            self.request_picture(ui.ctx(), canvas.resolution);
            self.show_changes(ui.ctx());
            self.hover(&response, canvas);
            self.paint(ui, canvas, response.dragged());
            self.divider_ui(ui, canvas);
            self.gizmo_ui(ui, canvas);
            self.request_other(ui.ctx());
        });
    }

    /// Requests the picture that the camera and the settings want. After an input it is shown in the same frame if its
    /// first pass is quick; a camera that rotates by itself shows more frames if it doesn't wait.
    fn request_picture(&mut self, ctx: &egui::Context, resolution: UVec2) {
        let wanted = self.wanted(ctx, resolution);
        let block = self.seen.settings.moving.block();
        self.traced.tracer.set_first_step(block);
        self.traced.tracer.request(wanted);
        if !self.seen.is_rotating
            && let Some(panic) = self.traced.tracer.await_first_pass(ctx).first()
        {
            self.error(panic);
        }
    }

    /// Auto-rotates the camera about the mesh.
    fn rotate(&mut self, ui: &egui::Ui) {
        /// One turn per twelve seconds; a frame longer than [`LONGEST_S`] counts as that long.
        const RADIANS_PER_S: f64 = std::f64::consts::TAU / 12.0;
        const LONGEST_S: f64 = 0.2;
        if self.seen.is_rotating && !self.navigation.is_changing_view() {
            let secs = f64::from(ui.input(|input| input.unstable_dt)).min(LONGEST_S);
            self.seen.turntable.turn(secs * RADIANS_PER_S);
            ui.ctx().request_repaint();
        }
    }

    /// Uploads the changes of the traced picture.
    fn show_changes(&mut self, ctx: &egui::Context) {
        let changed = self
            .traced
            .tracer
            .take_changes()
            .map(|(_, changed)| changed);
        let (look, film) = (self.look(), self.traced.tracer.film());
        let mut failure = None;
        if let Some((pixels, changed)) = self.traced.development.update(film, changed, look) {
            let uploaded =
                (self.traced.picture).upload(film.size(), pixels, changed, film.block_px());
            self.traced.shown.update(film, changed);
            failure = uploaded.err();
            self.note_change_of_a(ctx);
        }
        if let Some(error) = failure {
            self.retry_without_lines(&error, ctx);
        }
        self.traced.on_screen = self.traced.tracer.shown().cloned();
    }

    /// Draws the traced picture, the overlay and the marks.
    fn paint(&mut self, ui: &egui::Ui, canvas: Canvas, is_dragging: bool) {
        // Overlay and marks match the scene and the camera of the picture on the screen.
        let Some((scene, camera)) = self.traced.on_screen.clone() else {
            return;
        };
        let input = self.overlay_input(&scene, camera, canvas.pixels_per_point);
        let is_moving = is_dragging || self.traced.tracer.is_moving();
        let overlays = &self.seen.settings.overlays;
        // A difference and a distance map have no overlay.
        let is_of_sides = self.shows(Mode::Difference) || self.shows(Mode::Distance);
        let mut labels = if is_of_sides {
            Vec::new()
        } else {
            overlay::labels(&input, overlays)
        };
        // Above the others in its corner, which stay in place.
        labels.splice(0..0, self.picked.inspecting.hover.label());
        let drawn = if is_moving {
            self.traced.overlay.draw_moving(&input, overlays, ui.ctx())
        } else {
            self.traced.overlay.draw(&input, overlays, ui.ctx())
        };
        let (texture, error) = match drawn {
            Ok(texture) => (texture, None),
            Err(error) => (None, Some(error)),
        };
        let painter = ui.painter_at(canvas.rect);
        painter.extend(
            self.traced
                .picture
                .shape(canvas.rect, canvas.part, texture.as_ref()),
        );
        self.paint_other(ui, canvas, texture.as_ref());
        let document = &self.open.document;
        // The scene may have another tree by now.
        let is_current = std::ptr::eq(scene.mesh(), document.loaded.scene.mesh());
        if is_current && !document.is_blank {
            self.shown.first_picture.draw(ui.ctx());
        }
        if let Some(error) = error {
            self.seen.settings.overlays.turn_off_added();
            self.error(error);
        }
        self.pixel_values_ui(ui, canvas, &camera);
        labels_ui(ui, canvas, &camera, &labels);
        self.scale_legend_ui(ui, canvas);
        if !is_of_sides {
            self.marks_ui(&painter, canvas, &input);
        }
    }

    /// Draws rings around the picks, and crosshairs at the marked points.
    fn marks_ui(&self, painter: &egui::Painter, canvas: Canvas, input: &OverlayInput) {
        let camera = &input.camera;
        let marks = [
            (self.marked_point(), theme::PICK),
            (
                self.picked.flaw.as_ref().map(|place| place.point),
                theme::FLAW,
            ),
        ];
        for (point, _) in &input.marks.picks {
            if let Some(pixel) = camera.pixel_of(*point) {
                ring(painter, canvas.pos_of(pixel, camera));
            }
        }
        for (point, colour) in marks {
            if let Some(pixel) = point.and_then(|point| camera.pixel_of(point)) {
                cross_hair(painter, canvas.pos_of(pixel, camera), colour);
            }
        }
    }

    /// Frees the memory of the lines if there is none for the picture, and uploads the picture again after a pause.
    fn retry_without_lines(&mut self, error: &GpuError, ctx: &egui::Context) {
        const PAUSE: Duration = Duration::from_secs(1);
        self.traced.overlay.release();
        self.seen.settings.overlays.turn_off_added();
        self.traced.development = Development::default();
        if self.notice() != Some(error.to_string().as_str()) {
            self.error(error);
        }
        ctx.request_repaint_after(PAUSE);
    }

    pub(super) fn overlay_input(
        &self,
        scene: &Arc<Scene>,
        camera: Camera,
        pixels_per_point: f32,
    ) -> OverlayInput {
        let is_current = std::ptr::eq(scene.mesh(), self.open.document.loaded.scene.mesh());
        let flaw = self.picked.flaw.as_ref().map(|place| place.flaw);
        let findings = self.open.document.known_findings();
        let marks = Marks {
            flaw: flaw.zip(findings.map(|findings| Arc::clone(&findings.health))),
            picked: self.picked.pick.as_ref().and_then(Pick::marked_primitive),
            path: self
                .picked
                .path
                .followed()
                .map(|path| Arc::clone(&path.record)),
            picks: self.picked.inspecting.picks.points(),
            measurements: self.picked.inspecting.picks.measurements(),
            opened: self.picked.inspecting.picks.opened(),
        };
        OverlayInput {
            scene: Arc::clone(scene),
            camera,
            lines_camera: camera,
            up_axis: self.seen.settings.up_axis(),
            pivot: self.seen.turntable.pivot,
            marks: if is_current { marks } else { Marks::default() },
            scale: pixels_per_point.max(1.0),
        }
    }
}

/// Draws a ring around a picked point.
fn ring(painter: &egui::Painter, at: Pos2) {
    for (colour, width) in [(Color32::BLACK, 3.0), (theme::PICK, 1.3)] {
        painter.circle_stroke(at, 3.5, egui::Stroke::new(width, colour));
    }
}

/// Draws a cross hair at a point on the screen.
fn cross_hair(painter: &egui::Painter, at: Pos2, colour: Color32) {
    for (colour, width) in [(Color32::BLACK, 3.0), (colour, 1.3)] {
        let stroke = egui::Stroke::new(width, colour);
        painter.circle_stroke(at, 7.0, stroke);
        for dir in [egui::Vec2::X, egui::Vec2::Y, -egui::Vec2::X, -egui::Vec2::Y] {
            painter.line_segment([at + 4.0 * dir, at + 11.0 * dir], stroke);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::Aabb;
    use hitscope_core::camera::Turntable;

    #[test]
    fn the_canvas_covers_whole_pixels_at_any_scale() {
        let available = Rect::from_min_max(Pos2::new(0.0, 31.3), Pos2::new(901.7, 640.2));
        for scale in [1.0, 1.25, 1.5, 2.0] {
            let canvas = Canvas::new(available, scale);
            let corner = canvas.rect.max.to_vec2() * scale;
            assert!((corner - corner.round()).length() < 1e-3, "{scale}");
            assert!(available.expand(1e-3).contains_rect(canvas.rect));
            let camera =
                Turntable::framing(Aabb::EMPTY, canvas.resolution).camera(canvas.resolution);
            let middle = DVec2::new(10.5, 20.5);
            let pos = canvas.pos_of(middle, &camera);
            assert!((canvas.pixel_of(pos, &camera) - middle).length() < 1e-3);
        }
    }

    #[test]
    fn a_picture_of_another_size_is_shown_whole_and_centred() {
        let available = Rect::from_min_max(Pos2::new(0.0, 31.3), Pos2::new(901.7, 640.2));
        for scale in [1.0, 1.5, 2.0] {
            for size in [
                UVec2::new(64, 48),
                UVec2::new(3000, 100),
                UVec2::new(5, 4000),
            ] {
                let canvas = Canvas::of_picture(available, scale, size);
                assert_eq!(canvas.resolution, size);
                assert!(available.expand(1e-3).contains_rect(canvas.rect), "{size}");
                let off = canvas.rect.center() - available.center();
                // Rounding to pixels moves each side by up to two of them.
                assert!(off.length() * scale < 4.0, "{size}: {off}");
                let factor = canvas.rect.width() * scale / size.x as f32;
                let is_whole = (factor - factor.round()).abs() < 1e-3;
                assert!(factor <= 1.001 || is_whole, "{size}: {factor}");
            }
        }
    }

    #[test]
    fn positions_in_a_magnified_picture_are_those_of_its_part() {
        let available = Rect::from_min_size(Pos2::ZERO, egui::vec2(800.0, 600.0));
        let mut canvas = Canvas::new(available, 1.0);
        canvas.part = Rect::from_min_size(Pos2::new(0.5, 0.25), egui::Vec2::splat(1.0 / 64.0));
        let camera = Turntable::framing(Aabb::EMPTY, canvas.resolution).camera(canvas.resolution);
        let corner = canvas.pixel_of(Pos2::ZERO, &camera);
        assert_eq!(corner, DVec2::new(400.0, 150.0));
        let pos = canvas.pos_of(DVec2::new(401.5, 151.5), &camera);
        assert!(pos.distance(Pos2::new(96.0, 96.0)) < 0.01, "{pos}");
    }

    #[test]
    fn a_window_too_small_for_a_picture_has_one_pixel() {
        let canvas = Canvas::new(Rect::from_min_size(Pos2::ZERO, egui::Vec2::splat(0.3)), 1.0);
        assert_eq!(canvas.resolution, UVec2::ONE);
    }
}
