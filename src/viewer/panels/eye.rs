//! An eye button: an open eye for what is shown, a crossed-out one for what is hidden.

use egui::{Response, Role, Sense, Shape, Stroke, Vec2, WidgetInfo, vec2};

/// The number of line segments of a lid.
const SEGMENTS: i8 = 12;

/// Shows the button; `is_shown` is `None` for what is partly shown. The caller handles clicks.
pub fn eye_ui(ui: &mut egui::Ui, is_shown: Option<bool>, name: &str) -> Response {
    let size = Vec2::splat(ui.spacing().interact_size.y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| match is_shown {
        Some(is_shown) => WidgetInfo::selected(Role::CheckBox, ui.is_enabled(), is_shown, name),
        None => WidgetInfo::labeled(Role::CheckBox, ui.is_enabled(), name),
    });
    if !ui.is_rect_visible(rect) {
        return response;
    }
    let visuals = ui.style().interact(&response);
    let painter = ui.painter();
    if response.hovered() || response.has_focus() {
        painter.rect_filled(rect, visuals.corner_radius, visuals.bg_fill);
    }
    let colour = match is_shown {
        Some(false) => ui.visuals().weak_text_color(),
        _ => visuals.text_color(),
    };
    let (stroke, centre) = (Stroke::new(1.3, colour), rect.center());
    let half = 0.4 * rect.width();
    // Two parabolas that meet in the corners of the eye.
    let lid = |height: f32| {
        let point = move |k: i8| {
            let x = f32::from(k) / f32::from(SEGMENTS) * 2.0 - 1.0;
            centre + half * vec2(x, height * (1.0 - x * x))
        };
        Shape::line((0..=SEGMENTS).map(point).collect(), stroke)
    };
    painter.add(lid(0.6));
    match is_shown {
        Some(false) => {
            painter.line_segment(
                [
                    centre + half * vec2(-0.8, 0.8),
                    centre + half * vec2(0.8, -0.8),
                ],
                stroke,
            );
        }
        Some(true) => {
            painter.circle_filled(centre, 0.35 * half, colour);
        }
        None => {
            painter.circle_stroke(centre, 0.35 * half, stroke);
        }
    }
    painter.add(lid(-0.6));
    response
}
