//! Values in the pixels of the magnified picture, in decimal or as exact hexadecimal floats.
//!
//! A view of numbers has the number of the ray through the centre of each pixel. The view *Triangle* has the index of the
//! primitive. The other views have the pixel's radiance in red, green and blue.

use super::App;
use super::canvas::Canvas;
use crate::numbers::{hexadecimal, significant};
use crate::task::{KeyedTask, Task, TaskPanicked};
use crate::tracer::Request;
use egui::{Color32, FontId, Pos2, Rect, Role, Sense, WidgetInfo};
use glam::{DVec2, UVec2};
use hitscope_core::Camera;
use hitscope_core::plan::PixelRect;
use hitscope_core::sampler::Sampler;
use hitscope_core::srgb::{from_texel, luminance};
use std::sync::Arc;

/// The side of the smallest pixel with a value, in points.
const LEAST_SIDE: f32 = 48.0;
/// The sizes of the font in points.
const FONT_SIZES: [f32; 2] = [5.0, 14.0];
/// An upper bound of the width of a digit in egui's proportional font, relative to the font's size.
const DIGIT_WIDTH: f32 = 0.6;
/// Significant digits of decimal numbers.
const DIGITS: usize = 5;

/// The values in large pixels.
pub(crate) struct PixelValues {
    pub is_on: bool,
    /// Whether numbers are shown as hexadecimal floats.
    pub is_exact: bool,
    task: KeyedTask<Key, Vec<Value>>,
    found: Option<(Key, Vec<Value>)>,
}

impl Default for PixelValues {
    fn default() -> Self {
        Self {
            is_on: true,
            is_exact: false,
            task: KeyedTask::default(),
            found: None,
        }
    }
}

/// What the values depend on.
#[derive(Clone, PartialEq)]
struct Key {
    /// The request, with the camera of the picture on the screen.
    request: Request,
    /// The pixels.
    min: UVec2,
    max: UVec2,
}

/// The value of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Value {
    Nothing,
    Number(f64),
    Index(u32),
}

impl Value {
    fn text(self, is_exact: bool) -> String {
        match self {
            Self::Nothing => "–".to_owned(),
            Self::Index(index) => index.to_string(),
            Self::Number(x) if is_exact => hexadecimal(x),
            Self::Number(x) => significant(x, DIGITS),
        }
    }
}

impl Key {
    /// The values of the pixels, row by row.
    fn values(&self) -> Vec<Value> {
        let (context, view) = (&self.request.context, self.request.integrator);
        let value = |pixel: UVec2| {
            let ray = context.camera.ray_through(pixel.as_dvec2() + 0.5);
            let hit = context.intersector.closest_hit(&ray);
            if view.shows_indices() {
                return hit.map_or(Value::Nothing, |hit| Value::Index(hit.primitive));
            }
            let number = view.number(context, &ray, hit, &mut Sampler::new(pixel, 0));
            number.map_or(Value::Nothing, Value::Number)
        };
        pixels(self.min, self.max).map(value).collect()
    }
}

/// The pixels of a rectangle, row by row.
fn pixels(min: UVec2, max: UVec2) -> impl Iterator<Item = UVec2> {
    (min.y..max.y).flat_map(move |y| (min.x..max.x).map(move |x| UVec2::new(x, y)))
}

impl App {
    /// Writes values into the pixels if they are large enough.
    pub(super) fn pixel_values_ui(&mut self, ui: &egui::Ui, canvas: Canvas, camera: &Camera) {
        let side = canvas.rect.width() / (canvas.part.width() * camera.resolution().x as f32);
        let values = &mut self.shown.magnifier.values;
        if !values.is_on || side < LEAST_SIDE {
            values.found = None;
            return;
        }
        let rect = visible(canvas, camera);
        let texts = match self.values(ui.ctx(), camera, rect) {
            Ok(Some(texts)) => texts,
            Ok(None) => return,
            Err(broken) => return self.error(broken),
        };
        for (pixel, text) in pixels(rect.min, rect.max).zip(texts) {
            let corner = |offset| canvas.pos_of(pixel.as_dvec2() + offset, camera);
            let place = Rect::from_two_pos(corner(DVec2::ZERO), corner(DVec2::ONE));
            // The values are those of side A of a comparison.
            if !self.shows_a_at(place.center(), canvas) {
                continue;
            }
            self.write(ui, canvas, place, pixel, &text);
        }
    }

    /// The texts of the pixels, row by row; `None` until they are known.
    fn values(
        &mut self,
        ctx: &egui::Context,
        camera: &Camera,
        rect: PixelRect,
    ) -> Result<Option<Vec<String>>, TaskPanicked> {
        let Some(request) = self.traced.tracer.posted() else {
            return Ok(None);
        };
        let is_exact = self.shown.magnifier.values.is_exact;
        let view = request.integrator;
        if !view.shows_indices() && !matches!(view.scale(&request.context), Ok(Some(_))) {
            let film = self.traced.tracer.film();
            let is_shown = film.size() == camera.resolution();
            let light = |pixel: UVec2| {
                // A picture of another size is stretched over the canvas.
                let light = is_shown.then(|| film.radiance(pixel)).flatten();
                let text = |x: f32| Value::Number(x.into()).text(is_exact);
                light.map_or(String::new(), |light| light.to_array().map(text).join("\n"))
            };
            return Ok(Some(pixels(rect.min, rect.max).map(light).collect()));
        }
        let mut key = Key {
            request: request.clone(),
            min: rect.min,
            max: rect.max,
        };
        key.request.context.camera = *camera;
        let values = &mut self.shown.magnifier.values;
        if values.found.as_ref().is_none_or(|(known, _)| *known != key) {
            let wanted = key.clone();
            let start = || Task::spawn("pixel values", ctx, move || wanted.values());
            values.found = values
                .task
                .get(key.clone(), start)?
                .map(|values| (key, values));
        }
        let text = |value: &Value| value.text(is_exact);
        let found = values.found.as_ref();
        Ok(found.map(|(_, values)| values.iter().map(text).collect()))
    }

    /// Writes a text into a pixel, in black or white. It is a widget, so that assistive technology reads it.
    fn write(&self, ui: &egui::Ui, canvas: Canvas, place: Rect, pixel: UVec2, text: &str) {
        let longest = text.lines().map(|line| line.chars().count()).max();
        let Some(longest) = longest.filter(|longest| *longest > 0) else {
            return;
        };
        let size = place.width() / (DIGIT_WIDTH * longest as f32);
        if size < FONT_SIZES[0] {
            return;
        }
        let font = FontId::proportional(size.min(FONT_SIZES[1]));
        let colour = self.colour_on(pixel);
        let painter = ui.painter_at(canvas.rect.intersect(place));
        let galley = painter.layout(text.to_owned(), font, colour, f32::INFINITY);
        let corner: Pos2 = place.center() - 0.5 * galley.size();
        painter.galley(corner, Arc::clone(&galley), colour);
        let id = ui.scope_id().with(("pixel value", pixel.to_array()));
        let response = ui.interact(place.intersect(canvas.rect), id, Sense::hover());
        let name = format!(
            "Pixel {}, {}: {}",
            pixel.x,
            pixel.y,
            text.replace('\n', ", ")
        );
        response.widget_info(|| WidgetInfo::labeled(Role::Label, true, &name));
    }

    /// Black on bright pixels, white on the others, for the higher contrast.
    fn colour_on(&self, pixel: UVec2) -> Color32 {
        /// The luminance that has the same contrast with black and with white, (L + 0.05)² = 0.05 · 1.05: see the Web
        /// Content Accessibility Guidelines 2.2, “contrast ratio”.
        const MIDDLE: f32 = 0.179;
        let film = self.traced.tracer.film();
        let index = (pixel.y * film.size().x + pixel.x) as usize;
        match self.traced.development.pixels(film).get(index) {
            Some(&[r, g, b, _]) if luminance(from_texel([r, g, b])) > MIDDLE => Color32::BLACK,
            _ => Color32::WHITE,
        }
    }
}

/// The pixels of a camera's picture that are at least partly on the screen.
fn visible(canvas: Canvas, camera: &Camera) -> PixelRect {
    let size = camera.resolution();
    let [min, max] = [canvas.rect.min, canvas.rect.max].map(|pos| canvas.pixel_of(pos, camera));
    PixelRect {
        min: min.max(DVec2::ZERO).floor().as_uvec2().min(size),
        max: max.max(DVec2::ZERO).ceil().as_uvec2().min(size),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_shown_in_decimal_or_exactly() {
        let third = Value::Number(1.0 / 3.0);
        assert_eq!(third.text(false), "0.33333");
        assert_eq!(third.text(true), "0x1.5555555555555p-2");
        assert_eq!(Value::Index(12).text(true), "12");
        assert_eq!(Value::Nothing.text(false), "–");
    }
}
