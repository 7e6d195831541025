//! The axis gizmo in a corner of the picture: the ends of the file's axes, which can be clicked to look from there.

use super::App;
use super::canvas::Canvas;
use egui::accesskit::Role;
use egui::{Align2, Color32, FontId, Id, Pos2, Rect, Sense, Stroke, Vec2, WidgetInfo};
use glam::DVec3;
use hitscope_core::camera::StandardView;

/// Length of an axis in points.
const LENGTH: f32 = 30.0;
/// Radius of the disc at an end.
const END: f32 = 8.0;
/// Distance of the centre from the edges of the picture.
const INSET: f32 = 50.0;
/// The smallest side of a picture that has a gizmo.
const SMALLEST_PICTURE: f32 = 200.0;

const NAMES: [[&str; 2]; 3] = [["X", "−X"], ["Y", "−Y"], ["Z", "−Z"]];
const COLOURS: [Color32; 3] = [
    Color32::from_rgb(235, 90, 90),
    Color32::from_rgb(110, 200, 90),
    Color32::from_rgb(95, 145, 245),
];

/// An end of an axis.
struct End {
    axis: usize,
    is_positive: bool,
    at: Pos2,
    /// Its distance towards the viewer.
    height: f64,
}

impl App {
    /// Shows the gizmo if it is on and the picture has room for it. It is hidden while the picture is magnified, because it
    /// would cover pixel values.
    pub(super) fn gizmo_ui(&mut self, ui: &egui::Ui, canvas: Canvas) {
        let rect = canvas.rect;
        let is_small = rect.size().min_elem() < SMALLEST_PICTURE;
        let is_hidden = !self.preferences.navigation.shows_gizmo
            || self.screenshot.is_some()
            || self.shown.magnifier.is_on();
        if is_hidden || is_small || self.document().is_blank {
            return;
        }
        let centre = Pos2::new(rect.max.x - INSET, rect.min.y + INSET);
        let mut clicked = None;
        for end in self.gizmo_ends(centre, canvas) {
            if end_ui(ui, centre, &end) {
                clicked = Some(end);
            }
        }
        if let Some(end) = clicked {
            let up_axis = self.seen.turntable.up_axis;
            let view = StandardView::from_end(end.axis, end.is_positive, up_axis);
            self.look_from(view, ui.ctx());
        }
    }

    /// The ends of the axes, farthest first.
    fn gizmo_ends(&self, centre: Pos2, canvas: Canvas) -> Vec<End> {
        let camera = self.seen.turntable.camera(canvas.resolution);
        let mut ends: Vec<End> = (0..6)
            .map(|k| {
                let (axis, is_positive) = (k / 2, k % 2 == 0);
                let sign = if is_positive { 1.0 } else { -1.0 };
                let direction = sign * DVec3::AXES[axis];
                let [x, y] = [camera.right(), -camera.up()].map(|of| direction.dot(of) as f32);
                End {
                    axis,
                    is_positive,
                    at: centre + LENGTH * Vec2::new(x, y),
                    height: direction.dot(camera.back()),
                }
            })
            .collect();
        ends.sort_by(|a, b| a.height.total_cmp(&b.height));
        ends
    }
}

/// Shows an end. Returns whether it is clicked.
fn end_ui(ui: &egui::Ui, centre: Pos2, end: &End) -> bool {
    let name = NAMES[end.axis][usize::from(!end.is_positive)];
    let rect = Rect::from_center_size(end.at, Vec2::splat(2.0 * END));
    let id = Id::unique("gizmo").with((end.axis, end.is_positive));
    let label = format!("Look from {name}");
    let response = ui.interact(rect, id, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
    let colour = COLOURS[end.axis];
    let painter = ui.painter();
    if end.is_positive {
        painter.line_segment([centre, end.at], Stroke::new(2.0, colour));
    }
    let is_marked = response.hovered() || response.has_focus();
    let fill = match end.is_positive || is_marked {
        true => colour,
        false => colour.gamma_multiply(0.35),
    };
    painter.circle_filled(end.at, END, fill);
    if is_marked {
        painter.circle_stroke(end.at, END + 1.0, Stroke::new(1.5, Color32::WHITE));
    }
    if end.is_positive || is_marked {
        let font = FontId::proportional(11.0);
        painter.text(end.at, Align2::CENTER_CENTER, name, font, Color32::BLACK);
    }
    let is_clicked = response.clicked();
    response.on_hover_text(label);
    is_clicked
}
