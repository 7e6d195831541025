//! Draws overlays in tiles that the device can hold, one row of tiles at a time.
//!
//! The tiles don't depend on the strips of a picture, so that a picture in strips equals the picture drawn whole.

use super::{blend, read_back};
use crate::gpu::GpuError;
use crate::gpu::depth::DepthMesh;
use crate::gpu::drawing::{Canvas, Drawing, DrawingState, DrawnLines, Overlay, Paces, Targets};
use crate::gpu::lines::LineSet;
use crate::gpu::traced::TracedLayer;
use crate::gpu::view::ViewUniform;
use crate::overlay::contents::WantedLines;
use crate::overlay::traced::Shapes;
use crate::overlay::{Contents, OverlayInput, Overlays};
use glam::UVec2;
use hitscope_core::plan::PixelRect;
use hitscope_core::progress::Progress;
use hitscope_core::{Camera, Scene};
use std::ops::Range;
use std::sync::Arc;

/// The overlays of a picture, ready to be drawn.
pub struct OverlayTiles {
    device: wgpu::Device,
    queue: wgpu::Queue,
    scene: Arc<Scene>,
    camera: Camera,
    view: ViewUniform,
    /// The shapes other than triangles, which also hide lines.
    shapes: Option<Shapes>,
    /// The drawing that tiles share; each tile has its own view and traced shapes.
    drawing: Drawing,
    overlay: Overlay,
    /// The longest side of a tile.
    side: u32,
    /// The row of tiles that was drawn last.
    drawn: Vec<DrawnTile>,
}

struct DrawnTile {
    rect: PixelRect,
    /// With premultiplied alpha.
    pixels: Vec<[u8; 4]>,
}

impl OverlayTiles {
    /// Prepares the overlays that are on.
    ///
    /// # Errors
    /// See [`GpuError`].
    pub fn new(
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        input: &OverlayInput,
        overlays: &Overlays,
    ) -> Result<Self, GpuError> {
        let scene = &input.scene;
        let Contents {
            lines,
            outline,
            view,
        } = Contents::of(input, overlays);
        let mut sets = Vec::new();
        for WantedLines { gather, looks, .. } in lines {
            let lines = Arc::new(LineSet::new(device, queue, &gather.lines(scene))?);
            sets.extend(looks.into_iter().map(|(kind, style)| DrawnLines {
                lines: Arc::clone(&lines),
                style,
                kind,
            }));
        }
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            scene: Arc::clone(scene),
            camera: input.camera,
            view,
            shapes: scene.has_other_shapes().then(Shapes::default),
            drawing: Drawing {
                view,
                traced: None,
                outline,
                mesh: Arc::new(DepthMesh::new(device, queue, scene)?),
                sets,
            },
            overlay: Overlay::new(device, queue),
            side: largest_tile(&device.limits()),
            drawn: Vec::new(),
        })
    }

    /// Draws over rows of the picture, beginning with `first_row`. Stops early once `goes_on` returns false.
    ///
    /// # Errors
    /// See [`GpuError`].
    pub fn draw_onto(
        &mut self,
        pixels: &mut [[u8; 4]],
        first_row: u32,
        goes_on: impl Fn() -> bool,
    ) -> Result<(), GpuError> {
        let count = pixels.len() / self.view.size().x.max(1) as usize;
        let rows = first_row..first_row + count as u32;
        self.for_each_run(rows, goes_on, |start, run| {
            for (under, over) in pixels[start..].iter_mut().zip(run) {
                *under = blend(*under, *over);
            }
        })
    }

    /// Calls `run` for each part of a row inside a tile, with its pixels and the index of its first pixel, counted from
    /// the first pixel of `rows`. Stops early once `goes_on` returns false.
    ///
    /// # Errors
    /// See [`GpuError`].
    pub fn for_each_run(
        &mut self,
        rows: Range<u32>,
        goes_on: impl Fn() -> bool,
        mut run: impl FnMut(usize, &[[u8; 4]]),
    ) -> Result<(), GpuError> {
        let size = self.view.size();
        for tile_row in rows.start / self.side..rows.end.div_ceil(self.side) {
            if !self.draw_row_of_tiles(tile_row, &goes_on)? {
                return Ok(());
            }
            for DrawnTile { rect, pixels } in &self.drawn {
                let width = (rect.max.x - rect.min.x) as usize;
                for (y, pixels) in (rect.min.y..).zip(pixels.chunks_exact(width)) {
                    if rows.contains(&y) {
                        let row = (y - rows.start) as usize * size.x as usize;
                        run(row + rect.min.x as usize, pixels);
                    }
                }
            }
        }
        Ok(())
    }

    /// Draws a row of tiles, unless it is the row that was drawn last. Returns false if `goes_on` returned false.
    fn draw_row_of_tiles(
        &mut self,
        tile_row: u32,
        goes_on: &impl Fn() -> bool,
    ) -> Result<bool, GpuError> {
        let top = tile_row * self.side;
        if self
            .drawn
            .first()
            .is_some_and(|tile| tile.rect.min.y == top)
        {
            return Ok(true);
        }
        self.drawn.clear();
        let rects = tiles(self.view.size(), self.side).filter(|rect| rect.min.y == top);
        let mut drawn = Vec::new();
        for rect in rects {
            if !goes_on() {
                return Ok(false);
            }
            let pixels = self.draw(rect)?;
            drawn.push(DrawnTile { rect, pixels });
        }
        self.drawn = drawn;
        Ok(true)
    }

    /// Draws a tile.
    fn draw(&self, rect: PixelRect) -> Result<Vec<[u8; 4]>, GpuError> {
        let (device, queue) = (&self.device, &self.queue);
        let is_whole = rect.min == UVec2::ZERO && rect.max == self.view.size();
        let view = if is_whole {
            self.view
        } else {
            self.view.of_part(rect)
        };
        let traced = self.shapes.as_ref().map(|shapes| {
            let progress = Progress::default();
            let pixels = shapes
                .trace(&self.scene, &self.camera, &self.view, rect, &progress)
                .expect("nobody else has the progress");
            TracedLayer::new(device, queue, view.size(), &pixels)
        });
        let drawing = Drawing {
            view,
            traced: traced.transpose()?.map(Arc::new),
            ..self.drawing.clone()
        };
        let canvas = Canvas {
            targets: Arc::new(Targets::new(device, view.size())?),
            colour: 0,
            has_depth: false,
        };
        let (mut paces, state) = (Paces::UNLIMITED, DrawingState::default());
        self.overlay
            .draw(&drawing, &canvas, &mut paces, &state, || ());
        read_back(device, queue, canvas.targets.colour(canvas.colour))
    }
}

/// The longest side of a tile that fits into a texture and into the buffer that reads it back.
fn largest_tile(limits: &wgpu::Limits) -> u32 {
    /// A tile of this size takes 200 MB on the GPU.
    const MOST: u32 = 4096;
    let mut side = limits.max_texture_dimension_2d.min(MOST);
    while side > 1 && super::row_bytes(side) * u64::from(side) > limits.max_buffer_size {
        side /= 2;
    }
    side
}

/// The tiles of a picture, each with sides of at most `side`.
fn tiles(size: UVec2, side: u32) -> impl Iterator<Item = PixelRect> {
    let counts = UVec2::new(size.x.div_ceil(side), size.y.div_ceil(side));
    let corners =
        (0..counts.y).flat_map(move |y| (0..counts.x).map(move |x| side * UVec2::new(x, y)));
    corners.map(move |min| PixelRect {
        min,
        max: (min + side).min(size),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_each_pixel_once() {
        for (size, side) in [((10, 7), 4), ((4, 4), 4), ((5, 1), 1), ((3, 9), 16)] {
            let size = UVec2::from(size);
            let mut seen = vec![0; size.element_product() as usize];
            for tile in tiles(size, side) {
                assert!((tile.max - tile.min).max_element() <= side);
                for y in tile.min.y..tile.max.y {
                    for x in tile.min.x..tile.max.x {
                        seen[(y * size.x + x) as usize] += 1;
                    }
                }
            }
            assert!(seen.iter().all(|&count| count == 1), "{size} {side}");
        }
    }

    #[test]
    fn a_tile_fits_textures_and_buffers() {
        let limits = |side, bytes| wgpu::Limits {
            max_texture_dimension_2d: side,
            max_buffer_size: bytes,
            ..wgpu::Limits::default()
        };
        assert_eq!(largest_tile(&limits(16384, 1 << 31)), 4096);
        assert_eq!(largest_tile(&limits(2048, 1 << 31)), 2048);
        assert_eq!(largest_tile(&limits(8192, 1 << 20)), 512);
    }
}
