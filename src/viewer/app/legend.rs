//! The legend in the picture: the scale of a view of numbers, or of noise; and the search for the range of the numbers.

use super::App;
use super::canvas::Canvas;
use crate::comparison::Mode;
use crate::look::{Look, noise_scale};
use crate::task::Task;
use egui::{Align2, Color32, FontId, Rect, Sense, Vec2, pos2, vec2};
use hitscope_core::colour::{ColourScale, ScaleError};
use hitscope_core::tone::Display;

/// Distance from the edges of the picture in points.
const MARGIN: f32 = 10.0;
/// Space around the parts of the legend in points.
const GAP: f32 = 6.0;
/// Width and height of the bar in points.
const BAR: Vec2 = vec2(200.0, 12.0);
/// Height of a line of text in points.
const LINE: f32 = 15.0;
/// Size of the font in points.
const FONT_SIZE: f32 = 12.0;
/// The most numbers at the bar.
const MOST_TICKS: usize = 5;

/// The search for the range of the numbers in the picture, and the view that it is for.
#[derive(Default)]
pub(crate) struct RangeFit(Option<(String, Task<Option<[f64; 2]>>)>);

impl App {
    /// The scale of the picture; `None` if it shows no numbers.
    pub(crate) fn colour_scale(&self) -> Option<Result<ColourScale, ScaleError>> {
        if matches!(self.look(), Look::Noise(_)) && !self.rasterizes_a() {
            return Some(Ok(noise_scale()));
        }
        let posted = self.traced.tracer.posted()?;
        posted.integrator.scale(&posted.context).transpose()
    }

    /// The scale whose legend is in the picture.
    pub fn legend(&self) -> Option<ColourScale> {
        let is_shown = self.seen.settings.colours.shows_legend && !self.open.document.is_blank;
        if !is_shown || self.shows(Mode::Difference) {
            return None;
        }
        if self.shows(Mode::Distance) {
            return self.distance_scale();
        }
        if self.shows(Mode::B) {
            return self.scale_of_b();
        }
        self.colour_scale().and_then(Result::ok)
    }

    /// Draws the legend in the lower right corner of the picture. It is a widget, so that assistive technology reads
    /// it. A picture that is too small has none.
    pub(super) fn scale_legend_ui(&self, ui: &egui::Ui, canvas: Canvas) {
        let Some(scale) = self.legend() else { return };
        let size = BAR + vec2(4.0 * GAP, 2.0 * LINE + 3.0 * GAP);
        let room = canvas.rect.size() - size - Vec2::splat(2.0 * MARGIN);
        if room.min_elem() < 0.0 {
            return;
        }
        let corner = canvas.rect.right_bottom() - Vec2::splat(MARGIN) - size;
        let plate = Rect::from_min_size(corner, size);
        draw(ui, plate, &scale);
        let id = ui.scope_id().with("legend");
        let response = ui.interact(plate, id, Sense::hover());
        let text = format!("Legend: {scale}");
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
    }

    /// Why the range can't be fitted; `None` if it can.
    pub(crate) fn lacks_scale(&self) -> Option<&'static str> {
        let posted = self.traced.tracer.posted();
        let shows_numbers =
            posted.is_some_and(|posted| posted.integrator.scale(&posted.context) != Ok(None));
        (!shows_numbers).then_some("The view shows no numbers")
    }

    /// Makes the range of the scale that of the numbers in the picture, once they are known.
    pub(crate) fn fit_range(&mut self, ctx: &egui::Context) {
        if let Some(posted) = self.traced.tracer.posted().cloned() {
            let name = posted.integrator.name.to_owned();
            let measure = move || posted.integrator.measured_range(&posted.context);
            self.traced.range_fit = RangeFit(Some((name, Task::spawn("range", ctx, measure))));
        }
    }

    pub(super) fn poll_range_fit(&mut self) {
        let Some((name, task)) = &self.traced.range_fit.0 else {
            return;
        };
        let (name, result) = match task.poll() {
            Ok(None) => return,
            Ok(Some(range)) => (name.clone(), Ok(range)),
            Err(panicked) => (name.clone(), Err(panicked)),
        };
        self.traced.range_fit = RangeFit::default();
        match result {
            Ok(Some(range)) => {
                let scale = self.seen.settings.colours.scales.entry(name).or_default();
                scale.range = Some(range);
            }
            Ok(None) => self.refuse("The picture shows no number"),
            Err(panicked) => self.error(panicked),
        }
    }
}

/// Draws title, bar and numbers on a plate.
fn draw(ui: &egui::Ui, plate: Rect, scale: &ColourScale) {
    let (painter, visuals) = (ui.painter_at(plate), ui.visuals());
    painter.rect_filled(plate, 3.0, visuals.panel_fill.gamma_multiply(0.85));
    let (font, colour) = (FontId::proportional(FONT_SIZE), visuals.strong_text_color());
    let bar = Rect::from_min_size(plate.min + vec2(2.0 * GAP, GAP + LINE), BAR);
    let title = match (scale.title(), scale.unit()) {
        (title, "") => title.to_owned(),
        (title, unit) => format!("{title} ({unit})"),
    };
    let at = pos2(bar.left(), plate.top() + 0.5 * GAP);
    painter.text(at, Align2::LEFT_TOP, title, font.clone(), colour);
    for step in 0..BAR.x as u32 {
        let left = bar.left() + step as f32;
        let part = (step as f32 + 0.5) / BAR.x;
        let [r, g, b, _] = Display::default().encode(scale.map().colour(part));
        let strip = Rect::from_min_size(pos2(left, bar.top()), vec2(1.5, BAR.y));
        painter.rect_filled(strip, 0.0, Color32::from_rgb(r, g, b));
    }
    let stroke = egui::Stroke::new(1.0, colour);
    let mut free_from = plate.left();
    let mut ticks = scale.ticks(MOST_TICKS);
    ticks.sort_by(|a, b| a.part.total_cmp(&b.part));
    for tick in ticks {
        let x = bar.left() + tick.part * BAR.x;
        painter.vline(x, bar.bottom() - 3.0..=bar.bottom() + 3.0, stroke);
        let text = painter.layout_no_wrap(tick.label, font.clone(), colour);
        let half = 0.5 * text.size().x;
        let left = (x - half).clamp(plate.left() + 2.0, plate.right() - 2.0 - 2.0 * half);
        // A number that would lie over the last one is left out.
        if left >= free_from {
            free_from = left + 2.0 * half + GAP;
            painter.galley(pos2(left, bar.bottom() + 3.0), text, colour);
        }
    }
}
