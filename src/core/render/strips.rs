//! Rendering in strips, one after another, which limits the memory of large pictures.
//!
//! A strip consists of whole rows. Samples depend on the coordinates of their pixel in the whole picture, so the strips
//! together equal the picture rendered whole, bit for bit.

use super::job::{Job, RenderError, render_while};
use crate::film::{BYTES_PER_PIXEL, Film};
use crate::picture::{Alpha, TraceError, shown_pixels};
use crate::plan::TILE_PX;
use crate::progress::Progress;
use glam::UVec2;
use std::ops::Range;

/// Memory of a strip: enough for about three million pixels, and allocated and freed in less than a second.
pub const STRIP_BYTES: u64 = 256 << 20;

/// The rows of the strips of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strips {
    size: UVec2,
    /// Number of rows of each strip but the last one.
    height: u32,
}

impl Strips {
    /// Strips of a picture of `size` pixels with at most `bytes` of memory each, but at least a row of tiles.
    pub fn new(size: UVec2, bytes: u64) -> Self {
        let row_bytes = u64::from(size.x.max(1)) * BYTES_PER_PIXEL as u64;
        let tiles = bytes / (row_bytes * u64::from(TILE_PX));
        let rows = tiles.max(1).saturating_mul(TILE_PX.into());
        Self {
            size,
            height: rows.min(size.y.into()) as u32,
        }
    }

    /// The memory of the largest strip.
    pub fn bytes(&self) -> u64 {
        u64::from(self.size.x) * u64::from(self.height) * BYTES_PER_PIXEL as u64
    }

    /// The rows of each strip, from the top.
    pub fn rows(&self) -> impl Iterator<Item = Range<u32>> + use<> {
        let Self { size, height } = *self;
        let starts = (0..size.y).step_by(height.max(1) as usize);
        starts.map(move |start| start..start.saturating_add(height).min(size.y))
    }
}

/// Rendered rows of a picture.
pub struct Strip {
    /// The rows in the picture.
    pub rows: Range<u32>,
    /// The rows as a picture of their own.
    pub film: Film,
    /// The part of each pixel that surfaces cover, if the background is transparent.
    pub alpha: Option<Alpha>,
}

impl Strip {
    /// Renders rows of a job's picture on `threads` threads, until `goes_on` returns false.
    ///
    /// `goes_on` receives the traced part of the whole picture, from 0 to 1. `progress` can cancel the tracing of
    /// alpha.
    ///
    /// # Errors
    /// See [`RenderError`]; of panics the first.
    pub fn render(
        job: &Job,
        rows: Range<u32>,
        threads: usize,
        progress: &Progress,
        mut goes_on: impl FnMut(f64) -> bool,
    ) -> Result<Self, RenderError> {
        let Job {
            context,
            integrator,
            plan,
        } = job;
        let height = f64::from(plan.size().y);
        let of_rows = Job {
            context: context.clone(),
            integrator,
            plan: plan.of_rows(rows.clone()),
        };
        let (before, own) = (f64::from(rows.start), f64::from(rows.end - rows.start));
        let film = render_while(of_rows, threads, |part| {
            goes_on((before + part * own) / height)
        })?;
        let trace = || {
            let (camera, intersector) = (&context.camera, &*context.intersector);
            Alpha::trace(camera, intersector, film.plan(), threads, progress)
        };
        let is_transparent = context.options.has_transparent_background;
        let alpha = is_transparent.then(trace).transpose();
        let alpha = alpha.map_err(|error| match error {
            TraceError::Cancelled => RenderError::Cancelled,
            error => RenderError::Alpha(error),
        })?;
        Ok(Self { rows, film, alpha })
    }

    /// The pixels as they are displayed, in sRGB with straight alpha, row by row from the top.
    pub fn pixels(&self) -> Vec<[u8; 4]> {
        shown_pixels(&self.film, self.alpha.as_ref())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_cover_each_row_once_and_keep_within_their_memory() {
        let bytes = BYTES_PER_PIXEL as u64;
        for (size, memory, heights) in [
            ((100, 200), 100 * 96 * bytes, vec![96, 96, 8]),
            ((100, 200), 100 * 143 * bytes, vec![96, 96, 8]),
            ((100, 200), u64::MAX, vec![200]),
            ((100, 40), 0, vec![40]),
            ((100, 96), 0, vec![48, 48]),
        ] {
            let size = UVec2::from(size);
            let strips = Strips::new(size, memory);
            let rows: Vec<Range<u32>> = strips.rows().collect();
            let found: Vec<usize> = rows.iter().map(ExactSizeIterator::len).collect();
            assert_eq!(found, heights, "{size}");
            assert!(rows.windows(2).all(|pair| pair[0].end == pair[1].start));
            assert_eq!(rows.last().map(|rows| rows.end), Some(size.y));
            assert_eq!(strips.bytes(), 100 * u64::from(rows[0].end) * bytes);
        }
    }

    #[test]
    fn the_largest_picture_has_strips_of_bounded_memory() {
        let strips = Strips::new(UVec2::splat(16384), STRIP_BYTES);
        assert!(strips.bytes() <= STRIP_BYTES);
        assert!(strips.rows().count() > 64);
    }
}
