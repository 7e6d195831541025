//! Depth and outlines of shapes that aren't meshes: one traced ray per pixel, to hide lines behind these shapes.

use crate::gpu::traced::TracedPixel;
use crate::gpu::view::ViewUniform;
use glam::{UVec2, Vec2};
use hitscope_core::kernel::{KernelTable as _, Tier};
use hitscope_core::shape::Triangle;
use hitscope_core::{Camera, Intersector, Ray, Scene};
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// Within this many pixels of its border a surface doesn't hide lines behind it: half a line's width, half a pixel of soft
/// edge, and a margin, so that it doesn't hide the lines on it.
const REACH_PX: usize = 2;

/// The shapes of a scene other than triangles, packed without the clip on first use.
#[derive(Clone, Default)]
pub struct Shapes(Arc<OnceLock<Arc<dyn Intersector>>>);

/// The surface visible in a pixel, with its reversed depth; 0 and `None` for a miss.
#[derive(Clone, Copy, PartialEq)]
struct VisibleSurface {
    depth: f32,
    surface: Option<[u32; 2]>,
}

impl VisibleSurface {
    const NONE: Self = Self {
        depth: 0.0,
        surface: None,
    };
}

impl Shapes {
    /// Traces one ray through the centre of each pixel. Takes as long as a picture of one sample per pixel.
    pub fn trace(&self, scene: &Scene, camera: &Camera, view: &ViewUniform) -> Vec<TracedPixel> {
        let whole = self.0.get_or_init(|| {
            let shapes = scene.without_triangles().with_clip(None);
            // The lines' width exceeds the error of t, and exact arithmetic would take several times as long.
            Arc::from(shapes.intersector(Triangle::kernel_of(Tier::Watertight)))
        });
        let intersector = scene.clipped(Arc::clone(whole));
        let size = camera.resolution();
        let mut visible = vec![VisibleSurface::NONE; (size.x * size.y) as usize];
        let rows = visible.par_chunks_mut(size.x as usize).enumerate();
        rows.for_each(|(y, row)| trace_row(&*intersector, camera, view, y as u32, row));
        let hides = farthest_around(&visible, size);
        let outline = |(index, hides)| TracedPixel {
            hides,
            outline: outline(&visible, size, index),
        };
        hides.into_iter().enumerate().map(outline).collect()
    }
}

fn trace_row(
    intersector: &dyn Intersector,
    camera: &Camera,
    view: &ViewUniform,
    y: u32,
    row: &mut [VisibleSurface],
) {
    let ray = |x: u32| camera.ray(UVec2::new(x, y), Vec2::splat(0.5));
    let rays: Vec<Ray> = (0..row.len() as u32).map(ray).collect();
    let mut hits = vec![None; rays.len()];
    intersector.coherent_hits(&rays, &mut hits);
    for ((visible, hit), ray) in row.iter_mut().zip(hits).zip(&rays) {
        if let Some(hit) = hit {
            *visible = VisibleSurface {
                depth: view.depth_of(ray.at(hit.t)),
                // v tells the operands of a solid apart.
                surface: Some([hit.primitive, hit.v.to_bits()]),
            };
        }
    }
}

/// The least depth, which is the farthest point, near each pixel.
fn farthest_around(visible: &[VisibleSurface], size: UVec2) -> Vec<f32> {
    let (width, height) = (size.x as usize, size.y as usize);
    let least = |of: &dyn Fn(usize) -> f32, at: usize, count: usize| {
        let near = at.saturating_sub(REACH_PX)..count.min(at + REACH_PX + 1);
        near.map(of).fold(f32::INFINITY, f32::min)
    };
    let at = |index: usize| (index % width, index / width);
    let in_rows: Vec<f32> = (0..visible.len())
        .into_par_iter()
        .map(|index| {
            let (x, y) = at(index);
            least(&|x| visible[y * width + x].depth, x, width)
        })
        .collect();
    (0..visible.len())
        .into_par_iter()
        .map(|index| {
            let (x, y) = at(index);
            least(&|y| in_rows[y * width + x], y, height)
        })
        .collect()
}

/// The depth of the outline in a pixel, or −1 if there is none: the nearer of two neighbouring pixels that show different
/// surfaces has it; both do if they are equally near.
fn outline(visible: &[VisibleSurface], size: UVec2, index: usize) -> f32 {
    let width = size.x as usize;
    let (x, y) = (index % width, index / width);
    let neighbours = [
        (x > 0).then(|| index - 1),
        (x + 1 < width).then_some(index + 1),
        (y > 0).then(|| index - width),
        (y + 1 < size.y as usize).then_some(index + width),
    ];
    let own = visible[index];
    let is_outline = |other: &usize| {
        let other = visible[*other];
        other.surface != own.surface && other.depth <= own.depth
    };
    if own.surface.is_some() && neighbours.iter().flatten().any(is_outline) {
        own.depth
    } else {
        -1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(depths: &[f32]) -> Vec<VisibleSurface> {
        let visible = |&depth: &f32| VisibleSurface {
            depth,
            surface: (depth > 0.0).then_some([(10.0 * depth) as u32, 0]),
        };
        depths.iter().map(visible).collect()
    }

    #[test]
    fn the_nearer_surface_has_the_outline_and_a_surface_hides_nothing_at_its_border() {
        let visible = row(&[0.0, 0.0, 0.0, 0.5, 0.5, 0.5, 0.5, 0.5, 0.2, 0.2]);
        let size = UVec2::new(10, 1);
        let outlines: Vec<f32> = (0..10)
            .map(|index| outline(&visible, size, index))
            .collect();
        let none = -1.0;
        assert_eq!(
            outlines,
            [none, none, none, 0.5, none, none, none, 0.5, none, none]
        );
        let hides = farthest_around(&visible, size);
        assert_eq!(hides, [0.0, 0.0, 0.0, 0.0, 0.0, 0.5, 0.2, 0.2, 0.2, 0.2]);
    }
}
