//! The picture on the screen as pixels, with both sides of a comparison, for pictures that are saved or copied.

use crate::app::App;
use crate::comparison::{Mode, difference_picture};
use glam::UVec2;

/// The picture on the screen without its overlay.
pub(in crate::app) struct ShownPicture {
    pub size: UVec2,
    /// sRGB with alpha, row by row from the top.
    pub pixels: Vec<[u8; 4]>,
    /// The number of columns, from the left, that the overlay is drawn over: those that show the open scene.
    pub overlaid_columns: u32,
}

impl App {
    /// Why there will be no picture on the screen; `None` if there is one, or will be.
    pub(in crate::app) fn lacks_shown_picture(&self) -> Option<&'static str> {
        match self.seen.comparison.mode {
            _ if !self.is_comparing() => None,
            Mode::A => None,
            Mode::Distance => self.map_status(),
            Mode::B | Mode::Wipe | Mode::Difference => self.lacks_b(),
        }
    }

    /// The picture on the screen; `None` until all of its sides have pixels of the same size.
    pub(in crate::app) fn shown_picture(&self) -> Option<ShownPicture> {
        let film = self.traced.tracer.film();
        if !self.is_comparing() {
            let pixels = self.traced.development.pixels(film);
            return Some(ShownPicture::new(
                film.size(),
                pixels.to_vec(),
                film.size().x,
            ));
        }
        let (size, a) = self.pixels_of_a()?;
        let of_b = || {
            let b = self.compared.pixels().filter(|(of_b, _)| *of_b == size);
            b.map(|(_, pixels)| pixels)
        };
        let width = size.x as usize;
        let overlaid_of_b = if self.compared.source.is_other_scene() {
            0
        } else {
            size.x
        };
        match self.seen.comparison.mode {
            Mode::A => Some(ShownPicture::new(size, a.to_vec(), size.x)),
            Mode::B => Some(ShownPicture::new(size, of_b()?.to_vec(), overlaid_of_b)),
            Mode::Wipe => {
                let divider = self.divider_column(size.x);
                let mut pixels = a.to_vec();
                let rows = pixels.chunks_mut(width).zip(of_b()?.chunks(width));
                for (row, other) in rows {
                    let from = divider as usize;
                    row[from..].copy_from_slice(&other[from..]);
                }
                Some(ShownPicture::new(size, pixels, overlaid_of_b.max(divider)))
            }
            Mode::Difference => {
                let gain = self.seen.comparison.gain;
                let pixels = difference_picture(a, of_b()?, gain);
                Some(ShownPicture::new(size, pixels, 0))
            }
            Mode::Distance => {
                let map = self.compared.measured.map_pixels();
                let map = map.filter(|_| self.is_map_shown())?;
                Some(ShownPicture::new(size, map.to_vec(), 0))
            }
        }
    }
}

impl ShownPicture {
    fn new(size: UVec2, pixels: Vec<[u8; 4]>, overlaid_columns: u32) -> Self {
        Self {
            size,
            pixels,
            overlaid_columns,
        }
    }
}
