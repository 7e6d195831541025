//! The legend of a view of numbers, drawn to the right of its picture: a bar of the colours, with numbers.

use super::DARK_BACKGROUND;
use super::digits::{ADVANCE, HEIGHT, glyph};
use glam::UVec2;
use hitscope_core::colour::{ColourScale, Tick};
use hitscope_core::srgb::from_display;
use hitscope_core::tone::Display;
use std::iter::repeat_n;

/// Sizes in pixels of the font.
const MARGIN: u32 = 8;
const BAR: u32 = 12;
const TICK: u32 = 3;
const GAP: u32 = 2;
/// Least distance between numbers.
const LINE: u32 = 2 * HEIGHT;
/// The most numbers.
const MOST_TICKS: u32 = 12;
/// The colour of numbers and ticks, with alpha.
const INK: [u8; 4] = [220, 220, 220, 255];

/// The legend of a picture. Sizes are in pixels of the font.
pub(super) struct Legend<'a> {
    scale: &'a ColourScale,
    ticks: Vec<Tick>,
    width: u32,
    height: u32,
    bar: u32,
    /// Width of the picture in its own pixels.
    picture_width: u32,
    /// Pixels of the picture per pixel of the font: one per 360 rows, so that text is legible.
    zoom: u32,
}

impl<'a> Legend<'a> {
    /// The legend of a picture of `size` pixels.
    pub(super) fn new(size: UVec2, scale: &'a ColourScale) -> Self {
        let zoom = (size.y / 360).max(1);
        let height = size.y / zoom;
        let bar = height.saturating_sub(2 * MARGIN).max(1);
        let ticks = scale.ticks((bar / LINE).clamp(2, MOST_TICKS) as usize);
        let longest = ticks.iter().map(|tick| tick.label.chars().count()).max();
        let text = ADVANCE * longest.unwrap_or(0) as u32;
        Self {
            scale,
            ticks,
            width: MARGIN + BAR + TICK + GAP + text + MARGIN,
            height,
            bar,
            picture_width: size.x,
            zoom,
        }
    }

    /// The width of the picture and the legend together, in pixels of the picture.
    pub(super) fn width_together(&self) -> u32 {
        self.picture_width + self.zoom * self.width
    }

    /// Rows of the picture, beginning with `first_row`, with the legend to their right.
    pub(super) fn beside(&self, pixels: &[[u8; 4]], first_row: u32) -> Vec<[u8; 4]> {
        let rows = pixels.chunks(self.picture_width as usize);
        let mut all = Vec::with_capacity(rows.len() * self.width_together() as usize);
        let mut drawn: Vec<[u8; 4]> = Vec::new();
        for (y, row) in (first_row..).zip(rows) {
            if y % self.zoom == 0 || drawn.is_empty() {
                let pixel = |x| self.pixel(UVec2::new(x, y / self.zoom));
                drawn = (0..self.width).map(pixel).collect();
            }
            all.extend_from_slice(row);
            let wide = |pixel: &[u8; 4]| repeat_n(*pixel, self.zoom as usize);
            all.extend(drawn.iter().flat_map(wide));
        }
        all
    }

    fn pixel(&self, UVec2 { x, y }: UVec2) -> [u8; 4] {
        let Some(x) = x.checked_sub(MARGIN) else {
            return self.background();
        };
        let top = self.height.saturating_sub(self.bar) / 2;
        let is_beside_bar = (top..top + self.bar).contains(&y);
        if x < BAR && is_beside_bar {
            let up = 1.0 - (f64::from(y - top) + 0.5) / f64::from(self.bar);
            let colour = self.scale.map().colour(self.part_at(up as f32));
            return Display::default().encode(colour);
        }
        for tick in &self.ticks {
            let down = (1.0 - self.part_at(tick.part)) * self.bar as f32;
            let middle = top + (down as u32).min(self.bar - 1);
            let is_line = y == middle && (BAR..BAR + TICK).contains(&x);
            let row = (y + HEIGHT / 2).checked_sub(middle);
            if is_line || row.is_some_and(|row| is_ink(&tick.label, x, row)) {
                return INK;
            }
        }
        self.background()
    }

    /// The part of the scale at a part of the bar's height, or the other way round: the larger number is at the top.
    fn part_at(&self, up: f32) -> f32 {
        let [first, last] = self.scale.range();
        if first < last { up } else { 1.0 - up }
    }

    fn background(&self) -> [u8; 4] {
        Display::default().encode(from_display(DARK_BACKGROUND))
    }
}

/// Whether a pixel of a text behind the bar is set; `row` is counted from the top of the text.
fn is_ink(text: &str, x: u32, row: u32) -> bool {
    let Some(x) = x.checked_sub(BAR + TICK + GAP) else {
        return false;
    };
    let (character, column) = (text.chars().nth((x / ADVANCE) as usize), x % ADVANCE);
    let rows = character.map(glyph);
    let row = rows.and_then(|rows| rows.get(row as usize).copied());
    // Five columns and a blank one.
    column < 5 && row.is_some_and(|row| row >> (4 - column) & 1 == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::colour::colour_map;

    fn scale(range: [f64; 2]) -> ColourScale {
        let map = colour_map("viridis").expect("in the table");
        ColourScale::new("depth", "m", range, map, false).expect("a range")
    }

    #[test]
    fn the_bar_has_the_largest_number_at_its_top_and_the_picture_is_unchanged() {
        let size = UVec2::new(5, 100);
        let picture = vec![[1, 2, 3, 255]; 500];
        for range in [[0.0, 10.0], [10.0, 0.0]] {
            let scale = scale(range);
            let legend = Legend::new(size, &scale);
            let all = legend.beside(&picture, 0);
            let whole = UVec2::new(legend.width_together(), size.y);
            // Two digits of “10”.
            assert_eq!(whole, UVec2::new(5 + 8 + 12 + 3 + 2 + 12 + 8, 100));
            let at = |x: u32, y: u32| all[(y * whole.x + x) as usize];
            assert_eq!(at(4, 50), [1, 2, 3, 255]);
            let bar: Vec<[u8; 4]> = (8..92).map(|y| at(5 + 8 + 6, y)).collect();
            let encoded = |x: f64| Display::default().encode(scale.colour(x));
            for (found, expected) in [(bar[0], encoded(10.0)), (bar[83], encoded(0.0))] {
                // Half a pixel is a fifth of the way to the next of the map's colours.
                let differs = found.iter().zip(expected).any(|(a, b)| a.abs_diff(b) > 5);
                assert!(!differs, "{found:?} {expected:?}");
            }
            // The tick of 10 is at the top, that of 0 at the bottom, and there is none above.
            let tick = |y: u32| at(5 + 8 + 12 + 1, y) == INK;
            assert!(tick(8) && tick(91) && !tick(4), "{range:?}");
        }
    }

    #[test]
    fn text_grows_with_the_picture_and_tiny_pictures_have_a_legend_too() {
        let width = |height: u32| {
            let scale = scale([0.0, 1.0]);
            Legend::new(UVec2::new(1, height), &scale).width_together() - 1
        };
        assert_eq!(width(2000) % 5, 0);
        assert!(width(2000) > 4 * width(300));
        assert!(width(1) > 0);
    }

    #[test]
    fn rows_have_the_legend_of_the_whole_picture() {
        let (size, scale) = (UVec2::new(3, 800), scale([0.0, 1.0]));
        let picture = vec![[9; 4]; size.element_product() as usize];
        let legend = Legend::new(size, &scale);
        let whole = legend.beside(&picture, 0);
        assert_eq!(whole.len(), (legend.width_together() * 800) as usize);
        // An odd number of rows: two rows of the picture are one of the legend.
        for first in [0, 47, 401] {
            let rows = legend.beside(&picture[..3 * 200], first);
            let start = (legend.width_together() * first) as usize;
            assert_eq!(rows, &whole[start..start + rows.len()]);
        }
    }
}
