//! The pixels on the screen: for each, the camera and the pixel whose samples it shows.
//!
//! The film changes before its changes are on the screen: tiles arrive, or another picture is begun. Therefore the
//! code that uploads the film's pixels records here what they show. While a new picture replaces an old one, tiles of
//! both are on the screen.

use super::Film;
use crate::Camera;
use crate::plan::{PixelRect, Plan, TILE_PX};
use crate::ray::Ray;
use glam::UVec2;

/// A pixel of a camera's picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownPixel {
    /// The camera.
    pub camera: Camera,
    /// The pixel.
    pub pixel: UVec2,
}

impl ShownPixel {
    /// The ray of the pixel's first sample, through its centre.
    pub fn ray(&self) -> Ray {
        self.camera.ray_through(self.pixel.as_dvec2() + 0.5)
    }
}

/// For each pixel of a picture on the screen, the camera and the pixel whose samples it shows.
#[derive(Clone, Debug, Default)]
pub struct ShownPixels {
    size: UVec2,
    /// Size in pixels of the block whose colour a pixel shows; 0 for its own.
    steps: Vec<u8>,
    /// The camera by tile; `None` if the tile shows only background.
    cameras: Vec<Option<Camera>>,
}

impl ShownPixels {
    /// Records that the film's tiles that a rectangle touches are on the screen now.
    pub fn update(&mut self, film: &Film, rect: PixelRect) {
        let size = film.size();
        if size != self.size {
            self.size = size;
            self.steps = vec![0; film.pixels().len()];
            self.cameras = vec![None; film.tiles.len()];
        }
        let starts = |min: u32, max: u32| (min / TILE_PX * TILE_PX..max).step_by(TILE_PX as usize);
        let corners = starts(rect.min.y, rect.max.y)
            .flat_map(|y| starts(rect.min.x, rect.max.x).map(move |x| UVec2::new(x, y)));
        for tile in corners.map(|corner| film.plan.tile_of(corner)) {
            self.cameras[tile] = film.tiles[tile].camera;
            let rect = film.plan.tile_rect(tile);
            for row in (rect.min.y..rect.max.y).map(|y| film.row(rect, y)) {
                match &film.tiles[tile].first_pass {
                    Some(first) => self.steps[row].fill(first.step),
                    None => self.steps[row.clone()].copy_from_slice(&film.shown_step[row]),
                }
            }
        }
    }

    /// The pixel whose samples a pixel shows: itself, or the one that represents its block in a coarse pass. `None` if it
    /// shows only background because it hasn't been traced, if its first samples couldn't be traced, or if it is outside of
    /// the picture.
    pub fn at(&self, pixel: UVec2) -> Option<ShownPixel> {
        if pixel.cmpge(self.size).any() {
            return None;
        }
        let camera = self.cameras[Plan::tile_in(self.size, pixel)]?;
        let pixel = match self.steps[(pixel.y * self.size.x + pixel.x) as usize] {
            0 => pixel,
            u8::MAX => return None,
            step => Plan::representative(self.size, pixel, step.into()),
        };
        Some(ShownPixel { camera, pixel })
    }
}

#[cfg(test)]
mod tests;
