//! The texts of overlays over the picture.

use super::canvas::Canvas;
use crate::overlay::{Label, Place};
use crate::panels::labels::{around, place};
use egui::{Color32, FontId, Pos2, Rect, Sense, Stroke, Vec2};
use hitscope_core::Camera;

/// Size of the font in points.
const FONT_SIZE: f32 = 12.0;
/// Space around a text, and between texts, in points.
const GAP: f32 = 4.0;
/// Distance from the edges of the picture in points.
const MARGIN: f32 = 10.0;

/// Draws labels over the picture of a camera. Each is a widget, so that assistive technology reads it.
pub(super) fn labels_ui(ui: &egui::Ui, canvas: Canvas, camera: &Camera, labels: &[Label]) {
    // From below, so that later labels are below earlier ones.
    let mut corner = canvas.rect.left_bottom() + Vec2::new(MARGIN, -MARGIN);
    let (mut obstacles, mut texts, mut points) = (Vec::new(), Vec::new(), Vec::new());
    for (index, label) in labels.iter().enumerate().rev() {
        let text = Text::new(ui, canvas, index, &label.text);
        match label.place {
            Place::Point(point) => {
                let at = camera
                    .pixel_of(point)
                    .map(|pixel| canvas.pos_of(pixel, camera));
                if let Some(at) = at.filter(|at| canvas.rect.contains(*at)) {
                    points.push(at);
                    texts.push(text);
                }
            }
            Place::Corner { bar_px } => {
                let width = bar_px.map(|px| px as f32 / canvas.pixels_per_point);
                let height = text.size().y;
                corner.y -= height;
                let indent = width.map_or(0.0, |width| width + 2.0 * GAP);
                obstacles.extend(text.draw(corner + Vec2::new(indent, 0.0)));
                if let Some(width) = width {
                    let middle = corner + Vec2::new(0.0, 0.5 * height);
                    bar(&text.painter, middle, width);
                }
                corner.y -= GAP;
            }
        }
    }
    obstacles.extend(points.iter().map(around));
    let sizes: Vec<_> = texts.iter().map(Text::size).collect();
    let places = place(&points, &sizes, &obstacles, canvas.rect);
    for (text, plate) in texts.iter().zip(places) {
        text.draw(plate.min);
    }
}

/// A text to draw.
struct Text<'a> {
    ui: &'a egui::Ui,
    painter: egui::Painter,
    index: usize,
    galley: std::sync::Arc<egui::Galley>,
}

impl<'a> Text<'a> {
    fn new(ui: &'a egui::Ui, canvas: Canvas, index: usize, text: &str) -> Self {
        let painter = ui.painter_at(canvas.rect);
        let font = FontId::proportional(FONT_SIZE);
        let colour = ui.visuals().strong_text_color();
        Self {
            galley: painter.layout_no_wrap(text.to_owned(), font, colour),
            ui,
            painter,
            index,
        }
    }

    /// The size with the space around the text.
    fn size(&self) -> Vec2 {
        self.galley.size() + Vec2::splat(2.0 * GAP)
    }

    /// Draws the text on a plate with its upper left corner here, or at the nearest place inside the picture. Returns the
    /// plate; a picture that is too small has no text.
    fn draw(&self, corner: Pos2) -> Option<Rect> {
        let picture = self.painter.clip_rect();
        let room = picture.size() - self.size();
        if room.min_elem() < 0.0 {
            return None;
        }
        let corner = corner.clamp(picture.min, picture.min + room);
        let plate = Rect::from_min_size(corner, self.size());
        let visuals = self.ui.visuals();
        let fill = visuals.panel_fill.gamma_multiply(0.75);
        self.painter.rect_filled(plate, 3.0, fill);
        let text_at = corner + Vec2::splat(GAP);
        let colour = visuals.strong_text_color();
        self.painter
            .galley(text_at, std::sync::Arc::clone(&self.galley), colour);
        let id = self.ui.scope_id().with(("overlay label", self.index));
        let response = self.ui.interact(plate, id, Sense::hover());
        response
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, self.galley.text()));
        Some(plate)
    }
}

/// Draws a scale bar that starts here.
fn bar(painter: &egui::Painter, start: Pos2, width: f32) {
    let end = start + Vec2::new(width, 0.0);
    let tick = Vec2::new(0.0, 5.0);
    for (colour, thickness) in [(Color32::BLACK, 4.0), (Color32::WHITE, 1.5)] {
        let stroke = Stroke::new(thickness, colour);
        painter.line_segment([start, end], stroke);
        painter.line_segment([start - tick, start + tick], stroke);
        painter.line_segment([end - tick, end + tick], stroke);
    }
}
