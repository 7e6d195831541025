//! The divider between the sides of a wipe.

use crate::app::App;
use crate::app::canvas::Canvas;
use crate::comparison::Mode;
use crate::theme;
use egui::{Color32, Pos2, Rect, Sense, vec2};

/// Width in points of the strip in which the divider can be dragged.
const GRIP: f32 = 9.0;

impl App {
    /// The divider's x coordinate on the screen, between two pixels.
    pub(super) fn divider_x(&self, canvas: Canvas) -> f32 {
        let (left, right) = (canvas.rect.left(), canvas.rect.right());
        let x = left + self.seen.comparison.divider * (right - left);
        (x * canvas.pixels_per_point).round() / canvas.pixels_per_point
    }

    /// The first column of side B in a picture of this width that isn't magnified.
    pub(super) fn divider_column(&self, width: u32) -> u32 {
        let column = (self.seen.comparison.divider * width as f32).round();
        (column as u32).min(width)
    }

    /// Shows the divider, which can be dragged.
    pub(in crate::app) fn divider_ui(&mut self, ui: &egui::Ui, canvas: Canvas) {
        if !self.shows(Mode::Wipe) {
            return;
        }
        let x = self.divider_x(canvas);
        let grip = Rect::from_center_size(
            Pos2::new(x, canvas.rect.center().y),
            vec2(GRIP, canvas.rect.height()),
        );
        let id = ui.scope_id().with("divider");
        let response = ui
            .interact(grip, id, Sense::drag())
            .on_hover_and_drag_cursor(egui::CursorIcon::ResizeHorizontal);
        if let (true, Some(pos)) = (response.dragged(), response.interact_pointer_pos()) {
            let part = (pos.x - canvas.rect.left()) / canvas.rect.width();
            self.seen.comparison.divider = part.clamp(0.0, 1.0);
        }
        let divider = f64::from(self.seen.comparison.divider);
        response.widget_info(|| egui::WidgetInfo::slider(true, divider, "Divider in the picture"));
        let painter = ui.painter_at(canvas.rect);
        let is_held = response.hovered() || response.dragged() || response.has_focus();
        for (width, colour) in [(3.0, Color32::BLACK), (1.0, theme::PICK)] {
            let width = if is_held { width + 1.0 } else { width };
            let stroke = egui::Stroke::new(width, colour);
            painter.vline(self.divider_x(canvas), canvas.rect.y_range(), stroke);
        }
    }
}
