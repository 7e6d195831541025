//! The magnifier: enlarges a part of the picture on the screen without moving the camera.

use super::App;
use super::canvas::Canvas;
use super::navigation::POINTS_PER_E;
use super::pixel_values::PixelValues;
use egui::{Pos2, Rect, Response, Vec2, pos2};

/// The side of the largest pixel, in points.
const LARGEST_PIXEL: f32 = 256.0;
/// The side of a pixel after the command, in points: large enough for its value.
const CHOSEN_PIXEL: f32 = 64.0;

/// The part of the picture that is shown.
pub(crate) struct Magnifier {
    /// The factor; 1 for the whole picture.
    zoom: f32,
    /// The middle of the part, from (0, 0) at the top left of the picture to (1, 1) at its bottom right.
    centre: Pos2,
    /// Whether the scrolling in progress magnifies the picture. egui spreads scrolling over several frames. Meanwhile
    /// the keys may be released, or the whole picture may be shown again.
    owns_scroll: bool,
    /// The values in large pixels.
    pub values: PixelValues,
}

impl Default for Magnifier {
    fn default() -> Self {
        Self {
            zoom: 1.0,
            centre: pos2(0.5, 0.5),
            owns_scroll: false,
            values: PixelValues::default(),
        }
    }
}

impl Magnifier {
    /// Whether the picture is magnified.
    pub fn is_on(&self) -> bool {
        self.zoom > 1.0
    }

    /// The part that is shown; the unit square for the whole picture.
    pub fn part(&self) -> Rect {
        Rect::from_center_size(self.centre, Vec2::splat(1.0 / self.zoom))
    }

    /// Shows the whole picture. Returns whether it was magnified.
    pub fn leave(&mut self) -> bool {
        let was_on = self.is_on();
        self.set(1.0, self.centre);
        was_on
    }

    /// Multiplies the factor, and keeps a position in the picture where it is on the screen.
    fn zoom_at(&mut self, at: Pos2, factor: f32, most: f32) {
        /// Below this, the whole picture is shown.
        const LEAST: f32 = 1.01;
        let zoom = (self.zoom * factor).clamp(1.0, most.max(1.0));
        let zoom = if zoom < LEAST { 1.0 } else { zoom };
        self.set(zoom, at + (self.centre - at) * (self.zoom / zoom));
    }

    fn set(&mut self, zoom: f32, centre: Pos2) {
        let half = 0.5 / zoom;
        let inside = |x: f32| x.clamp(half, 1.0 - half);
        self.zoom = zoom;
        self.centre = pos2(inside(centre.x), inside(centre.y));
    }
}

impl App {
    /// Handles Ctrl+Shift+scroll, and while the picture is magnified, also scrolling and dragging. Returns whether it
    /// used the input.
    pub(super) fn magnify(&mut self, ui: &egui::Ui, response: &Response, canvas: Canvas) -> bool {
        let (modifiers, scroll, pinch) = ui.input(|input| {
            let scroll = input.smooth_scroll_delta();
            (input.modifiers, scroll, input.zoom_delta())
        });
        let magnifier = &mut self.shown.magnifier;
        let was_on = magnifier.is_on();
        let factor = pinch * ((scroll.x + scroll.y) / POINTS_PER_E).exp();
        let is_scrolling = factor != 1.0;
        let is_asked = was_on || (modifiers.command && modifiers.shift) || magnifier.owns_scroll;
        magnifier.owns_scroll = is_asked && is_scrolling;
        let pos = response.hover_pos().filter(|_| magnifier.owns_scroll);
        if let Some(pos) = pos {
            let most = LARGEST_PIXEL * canvas.pixels_per_point;
            magnifier.zoom_at(canvas.part_at(pos), factor, most);
            ui.ctx().request_repaint();
        }
        if was_on && response.dragged() {
            let moved = response.drag_delta() / canvas.rect.size() / magnifier.zoom;
            magnifier.set(magnifier.zoom, magnifier.centre - moved);
        }
        if was_on {
            self.navigation.rest();
        }
        was_on || pos.is_some()
    }

    /// Magnifies the picture at the pointer until the values fit into the pixels, or shows the whole picture again.
    pub(crate) fn toggle_magnifier(&mut self, ctx: &egui::Context) {
        let magnifier = &mut self.shown.magnifier;
        if magnifier.leave() {
            return;
        }
        let rect = self.shown.canvas_rect;
        let pos = ctx.input(|input| input.pointer.hover_pos());
        let pos = pos.filter(|pos| rect.contains(*pos));
        let within = (pos.unwrap_or(rect.center()) - rect.min) / rect.size();
        let zoom = CHOSEN_PIXEL * ctx.pixels_per_point();
        magnifier.zoom_at(within.to_pos2(), zoom, zoom);
    }

    /// The part of the status line about the magnified picture.
    pub(super) fn magnified_part(&self) -> Option<String> {
        let magnifier = &self.shown.magnifier;
        let text = || {
            format!(
                "magnified {:.0}×, Esc shows the whole picture",
                magnifier.zoom
            )
        };
        magnifier.is_on().then(text)
    }

    /// The factor by which the picture is magnified; 1 for the whole picture.
    pub fn magnification(&self) -> f32 {
        self.shown.magnifier.zoom
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_place_under_the_pointer_stays_and_the_part_stays_in_the_picture() {
        let mut magnifier = Magnifier::default();
        let at = pos2(0.3, 0.8);
        let within = |magnifier: &Magnifier| {
            let part = magnifier.part();
            (at - part.min) / part.size()
        };
        let before = within(&magnifier);
        for factor in [3.0, 20.0, 0.5, 100.0] {
            magnifier.zoom_at(at, factor, 64.0);
            assert!((within(&magnifier) - before).length() < 1e-3);
        }
        assert_eq!(magnifier.zoom, 64.0);
        magnifier.set(4.0, pos2(0.99, -3.0));
        let part = magnifier.part();
        assert_eq!((part.min, part.max), (pos2(0.75, 0.0), pos2(1.0, 0.25)));
        assert!(magnifier.leave() && !magnifier.leave());
        let part = magnifier.part();
        assert_eq!((part.min, part.max), (Pos2::ZERO, pos2(1.0, 1.0)));
    }
}
