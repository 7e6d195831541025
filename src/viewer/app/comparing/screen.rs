//! Drawing side B and the difference.

use super::Compared;
use crate::app::App;
use crate::app::canvas::Canvas;
use crate::comparison::{Mode, RasterizedPicture, Side, Source, difference_picture};
use crate::gpu::GpuError;
use crate::gpu::picture::Picture;
use crate::look::Look;
use egui::{Align2, Color32, FontId, Pos2, Rect, Sense, Shape};
use glam::UVec2;
use hitscope_core::tone::Display;
use std::sync::Arc;

/// Distance of the sides' names from the divider and from the edge of the picture, in points.
const MARGIN: f32 = 8.0;

/// The GPU pictures of side B, the difference and the distance map.
#[derive(Default)]
pub(super) struct Screen {
    /// Side A, if it is rasterized.
    a: Option<Picture>,
    other: Option<Picture>,
    difference: Option<Picture>,
    map: Option<Picture>,
    /// The number of changes of side A and of side B.
    pub changes: [u64; 2],
    /// The changes and the gain that the difference shows.
    difference_of: Option<([u64; 2], f32)>,
    /// The rasterized picture of side A that is drawn.
    rasterized_a: Option<Arc<RasterizedPicture>>,
    /// The rasterized picture of side B that is drawn.
    rasterized: Option<Arc<RasterizedPicture>>,
}

impl Screen {
    pub fn has_picture(&self) -> bool {
        self.other.is_some()
    }

    /// The rasterized picture of side A that is drawn.
    pub fn rasterized_a(&self) -> Option<&Arc<RasterizedPicture>> {
        self.rasterized_a.as_ref()
    }

    /// Uploads a rasterized picture of side A. Returns whether it is a new one.
    pub fn upload_a(
        &mut self,
        render_state: &eframe::egui_wgpu::RenderState,
        newest: &Arc<RasterizedPicture>,
    ) -> Result<bool, GpuError> {
        upload_rasterized(render_state, newest, &mut self.a, &mut self.rasterized_a)
    }

    /// Drops the rasterized picture of side A.
    pub fn clear_a(&mut self) {
        (self.a, self.rasterized_a) = (None, None);
    }

    /// Uploads a distance map.
    pub fn upload_map(
        &mut self,
        render_state: &eframe::egui_wgpu::RenderState,
        size: UVec2,
        pixels: &[[u8; 4]],
    ) -> Result<(), GpuError> {
        let picture = self.map.get_or_insert_with(|| Picture::new(render_state));
        picture.upload_whole(size, pixels)
    }
}

/// A picture of the differences.
struct Difference {
    /// The number of changes of each side, and the gain.
    of: ([u64; 2], f32),
    /// Width and height, and the pixels; `None` while the sizes of the sides differ.
    picture: Option<(UVec2, Vec<[u8; 4]>)>,
}

/// Uploads a rasterized picture of a side that draws `shown`. Returns whether it is a new one.
fn upload_rasterized(
    render_state: &eframe::egui_wgpu::RenderState,
    newest: &Arc<RasterizedPicture>,
    picture: &mut Option<Picture>,
    shown: &mut Option<Arc<RasterizedPicture>>,
) -> Result<bool, GpuError> {
    if shown
        .as_ref()
        .is_some_and(|known| Arc::ptr_eq(known, newest))
    {
        return Ok(false);
    }
    let picture = picture.get_or_insert_with(|| Picture::new(render_state));
    picture.upload_whole(newest.size(), &newest.pixels)?;
    *shown = Some(Arc::clone(newest));
    Ok(true)
}

impl Compared {
    /// Uploads what has changed of side B. Returns whether anything has.
    fn upload(
        &mut self,
        look: Look,
        display: Display,
        ctx: &egui::Context,
    ) -> Result<bool, GpuError> {
        let (screen, render_state) = (&mut self.screen, &self.render_state);
        let other = &mut screen.other;
        let picture = || Picture::new(render_state);
        match self.source {
            Source::Traced | Source::Mesh | Source::Earlier => {
                let Some(side) = &mut self.traced else {
                    return Ok(false);
                };
                let other = other.get_or_insert_with(picture);
                side.update(look, |size, pixels, changed, block_px| {
                    other.upload(size, pixels, changed, block_px)
                })
            }
            Source::Rasterized => {
                let newest = self.rasterized.picture();
                newest.map_or(Ok(false), |newest| {
                    upload_rasterized(render_state, newest, other, &mut screen.rasterized)
                })
            }
            Source::Picture => {
                // A panic has been printed to the terminal, and the old pixels stay.
                let is_new = self.reference.develop(display, ctx).unwrap_or(false);
                let size = self.reference.picture().map(|picture| picture.size);
                let pixels = size.zip(self.reference.pixels());
                if let (true, Some((size, pixels))) = (is_new, pixels) {
                    let other = other.get_or_insert_with(picture);
                    other.upload_whole(size, pixels)?;
                }
                Ok(is_new)
            }
        }
    }

    /// The rasterized picture of side B that is drawn.
    pub(super) fn rasterized_picture_of_b(&self) -> Option<&Arc<RasterizedPicture>> {
        let is_rasterized = self.source == Source::Rasterized;
        self.screen.rasterized.as_ref().filter(|_| is_rasterized)
    }

    /// Width and height of side B, and its pixels as they were uploaded; `None` before the first ones.
    pub(super) fn pixels(&self) -> Option<(UVec2, &[[u8; 4]])> {
        self.screen.other.as_ref()?;
        match self.source {
            Source::Traced | Source::Mesh | Source::Earlier => {
                let side = self.traced.as_ref()?;
                Some((side.tracer.film().size(), side.pixels()))
            }
            Source::Rasterized => {
                let picture = self.screen.rasterized.as_ref()?;
                Some((picture.size(), &picture.pixels))
            }
            Source::Picture => {
                let size = self.reference.picture()?.size;
                Some((size, self.reference.pixels()?))
            }
        }
    }

    /// Uploads the difference, if it has changed. There is none while the sizes differ.
    fn upload_difference(&mut self, difference: Option<Difference>) -> Result<(), GpuError> {
        let Some(Difference { of, picture }) = difference else {
            return Ok(());
        };
        let Some((size, pixels)) = picture else {
            self.screen.difference = None;
            return Ok(());
        };
        let render_state = &self.render_state;
        let picture = (self.screen.difference).get_or_insert_with(|| Picture::new(render_state));
        picture.upload_whole(size, &pixels)?;
        self.screen.difference_of = Some(of);
        Ok(())
    }
}

impl App {
    /// The difference, if a side or the gain has changed.
    fn changed_difference(&self) -> Option<Difference> {
        let (screen, gain) = (&self.compared.screen, self.seen.comparison.gain);
        let of = (screen.changes, gain);
        if screen.difference_of == Some(of) {
            return None;
        }
        let sides = self.pixels_of_a().zip(self.compared.pixels());
        let sides = sides.filter(|((size, _), (other, _))| size == other);
        let picture = sides.map(|((size, a), (_, b))| (size, difference_picture(a, b, gain)));
        Some(Difference { of, picture })
    }

    /// Whether a comparison is shown in this mode.
    pub(in crate::app) fn shows(&self, mode: Mode) -> bool {
        self.is_comparing() && self.seen.comparison.mode == mode
    }

    /// The place of the picture in the window. With a reference picture, it has the reference's size.
    pub(in crate::app) fn place_picture(&self, available: Rect, pixels_per_point: f32) -> Canvas {
        let is_picture = self.is_comparing() && self.compared.source == Source::Picture;
        match self.compared.reference.picture() {
            Some(picture) if is_picture => {
                Canvas::of_picture(available, pixels_per_point, picture.size)
            }
            _ => Canvas::new(available, pixels_per_point),
        }
    }

    /// Counts a change of the traced side A on the screen.
    pub(in crate::app) fn note_change_of_a(&mut self, ctx: &egui::Context) {
        if self.rasterizes_a() {
            return;
        }
        self.compared.screen.changes[0] += 1;
        self.ask_for_figures(ctx);
    }

    /// Draws side B, the difference or the distance map over side A, as the mode says.
    pub(in crate::app) fn paint_other(
        &mut self,
        ui: &egui::Ui,
        canvas: Canvas,
        overlay: Option<&wgpu::Texture>,
    ) {
        if !self.is_comparing() {
            return;
        }
        let settings = self.other_settings();
        let traced = self.compared.traced.as_ref();
        let look = traced.map_or_else(Look::plain, |side| Look::of(&settings, &side.tracer));
        let display = if self.traced.tracer.shows_lit() {
            self.seen.settings.display()
        } else {
            Display::default()
        };
        if let Err(error) = self.update_rasterized_a(ui.ctx()) {
            return self.end_comparison(&error);
        }
        match self.compared.upload(look, display, ui.ctx()) {
            Ok(false) => {}
            Ok(true) => {
                self.compared.screen.changes[1] += 1;
                self.ask_for_figures(ui.ctx());
            }
            Err(error) => return self.end_comparison(&error),
        }
        if self.shows(Mode::Difference) {
            let difference = self.changed_difference();
            if let Err(error) = self.compared.upload_difference(difference) {
                return self.end_comparison(&error);
            }
        }
        ui.painter_at(canvas.rect)
            .extend(self.shape_of_a(canvas, overlay));
        let shape = self.shape_of_other(canvas, overlay);
        let mut rect = canvas.rect;
        if self.shows(Mode::Wipe) {
            rect.min.x = self.divider_x(canvas);
        }
        let painter = ui.painter_at(rect);
        painter.extend(shape);
        let shows_a = self.shows(Mode::A) || self.shows(Mode::Distance);
        if let Some(reason) = self.lacks_b().filter(|_| !shows_a) {
            empty_ui(ui, &painter, rect, reason);
        }
        self.names_ui(ui, canvas);
    }

    /// Ends the comparison because of an error, such as a lack of memory for side B.
    pub(super) fn end_comparison(&mut self, error: &GpuError) {
        self.seen.comparison.is_on = false;
        self.error(error);
    }

    /// The shape of a rasterized side A, which replaces the traced picture; `None` until it is drawn, and if the mode
    /// doesn't show side A.
    fn shape_of_a(&mut self, canvas: Canvas, overlay: Option<&wgpu::Texture>) -> Option<Shape> {
        let is_shown = self.rasterizes_a() && (self.shows(Mode::A) || self.shows(Mode::Wipe));
        let picture = self.compared.screen.a.as_mut().filter(|_| is_shown)?;
        picture.shape(canvas.rect, canvas.part, overlay)
    }

    /// The shape that the mode shows instead of side A; `None` for side A itself, and until there is a picture.
    fn shape_of_other(&mut self, canvas: Canvas, overlay: Option<&wgpu::Texture>) -> Option<Shape> {
        let comparison = &self.seen.comparison;
        // The lines are those of the open scene.
        let overlay = overlay.filter(|_| !self.compared.source.is_other_scene());
        match comparison.mode {
            Mode::A => None,
            Mode::B | Mode::Wipe => {
                let other = self.compared.screen.other.as_mut()?;
                other.shape(canvas.rect, canvas.part, overlay)
            }
            Mode::Difference => {
                let difference = self.compared.screen.difference.as_mut()?;
                difference.shape(canvas.rect, canvas.part, None)
            }
            Mode::Distance => {
                let is_shown = self.is_map_shown();
                let map = self.compared.screen.map.as_mut().filter(|_| is_shown)?;
                map.shape(canvas.rect, canvas.part, None)
            }
        }
    }

    /// Draws the names of the sides at the top of their pictures.
    fn names_ui(&self, ui: &egui::Ui, canvas: Canvas) {
        let rect = canvas.rect;
        let painter = ui.painter_at(rect);
        let [a, b] = [Side::A, Side::B].map(|side| self.name_of(side));
        let name = |x: f32, align: Align2, text: String| {
            let at = Pos2::new(x, rect.top() + MARGIN);
            let (font, colour) = (FontId::proportional(12.0), Color32::WHITE);
            let galley = painter.layout_no_wrap(text, font, colour);
            let place = align.anchor_size(at, galley.size());
            painter.rect_filled(place.expand(3.0), 3.0, Color32::from_black_alpha(160));
            painter.galley(place.min, galley, colour);
        };
        let middle = rect.center().x;
        match self.seen.comparison.mode {
            Mode::Wipe => {
                let x = self.divider_x(canvas);
                name(x - MARGIN, Align2::RIGHT_TOP, a);
                name(x + MARGIN, Align2::LEFT_TOP, b);
            }
            Mode::A => name(middle, Align2::CENTER_TOP, a),
            Mode::B => name(middle, Align2::CENTER_TOP, b),
            Mode::Difference => name(middle, Align2::CENTER_TOP, "|A − B|".to_owned()),
            Mode::Distance => {
                let text = self.map_status().unwrap_or("Distance from A to B");
                name(middle, Align2::CENTER_TOP, text.to_owned());
            }
        }
    }
}

/// Covers a part of the picture and says why it is empty.
fn empty_ui(ui: &egui::Ui, painter: &egui::Painter, rect: Rect, reason: &'static str) {
    painter.rect_filled(rect, 0.0, ui.visuals().panel_fill);
    let (font, colour) = (FontId::proportional(14.0), ui.visuals().text_color());
    let room = (rect.width() - 2.0 * MARGIN).max(1.0);
    let galley = painter.layout(reason.to_owned(), font, colour, room);
    let place = Rect::from_center_size(rect.center(), galley.size());
    painter.galley(place.min, galley, colour);
    let id = ui.scope_id().with("empty side");
    let response = ui.interact(place, id, Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, reason));
}
