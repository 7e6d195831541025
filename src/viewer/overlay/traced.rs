//! Depth and outlines of shapes that aren't meshes: one traced ray per pixel, to hide lines behind these shapes.

use crate::gpu::traced::TracedPixel;
use crate::gpu::view::ViewUniform;
use glam::{DVec3, UVec2, Vec2};
use hitscope_core::kernel::{KernelTable as _, Tier};
use hitscope_core::plan::PixelRect;
use hitscope_core::progress::{Cancelled, Progress};
use hitscope_core::shape::Triangle;
use hitscope_core::{Camera, Intersector, Ray, Scene};
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// Within this many pixels of its border a surface doesn't hide lines behind it: half a line's width, half a pixel of
/// soft edge, and a margin, so that it doesn't hide the lines on it. Outlines depend on as many pixels around them.
const REACH_PX: usize = 2;

/// A surface hides lines that are farther than it by more than this many pixels, so that it doesn't hide the lines on
/// it, whose pieces are chords: they may be deeper by the tolerance of lines, a tenth of a pixel.
const SLACK_PX: f64 = 0.5;

/// Between neighbouring pixels of one surface that show a fold, its depth changes by more than this factor of the
/// change beside them. It changes less at a silhouette without a fold, where depth is proportional to the square root
/// of the distance x from it, by at most (√(x+1) − √x)/(√(x+2) − √(x+1)) < 1 + √2.
const FOLD: f32 = 3.0;

/// The depth of a fold, in units of the slack: two pixels.
const FOLD_SLACKS: f32 = 4.0;

/// The shapes of a scene other than triangles, packed without the clip on first use.
#[derive(Clone, Default)]
pub struct Shapes(Arc<OnceLock<Arc<dyn Intersector>>>);

/// The surface visible in a pixel, with its reversed depth; 0 and `None` for a miss. The depth is that of a point
/// behind the surface by the slack.
#[derive(Clone, Copy, PartialEq)]
struct VisibleSurface {
    depth: f32,
    /// The change of depth within [`SLACK_PX`].
    slack: f32,
    surface: Option<[u32; 2]>,
}

impl VisibleSurface {
    const NONE: Self = Self {
        depth: 0.0,
        slack: 0.0,
        surface: None,
    };
}

impl Shapes {
    /// Traces one ray through the centre of each pixel of a part of the picture, row by row from the top. Takes as long
    /// as a picture of one sample per pixel. `view` is that of the whole picture.
    ///
    /// # Errors
    /// [`Cancelled`], before the next row is traced.
    pub fn trace(
        &self,
        scene: &Scene,
        camera: &Camera,
        view: &ViewUniform,
        part: PixelRect,
        progress: &Progress,
    ) -> Result<Vec<TracedPixel>, Cancelled> {
        let whole = self.0.get_or_init(|| {
            let shapes = scene.without_triangles().with_clip(None);
            // The lines' width exceeds the error of t, and exact arithmetic would take several times as long.
            Arc::from(shapes.intersector(Triangle::kernel_of(Tier::Watertight)))
        });
        let intersector = scene.clipped(Arc::clone(whole));
        // A pixel depends on those around it.
        let margin = UVec2::splat(REACH_PX as u32);
        let min = part.min.saturating_sub(margin);
        let size = (part.max + margin).min(camera.resolution()) - min;
        let mut visible = vec![VisibleSurface::NONE; (size.x * size.y) as usize];
        let rows = visible.par_chunks_mut(size.x as usize).zip(0..size.y);
        rows.map(|(row, y)| {
            progress.check()?;
            trace_row(&*intersector, camera, view, min + UVec2::new(0, y), row);
            Ok(())
        })
        .collect::<Result<(), Cancelled>>()?;
        let hides = farthest_around(&visible, size);
        let width = size.x as usize;
        let [rows, columns] = [1, 0].map(|axis| {
            let start = part.min[axis] - min[axis];
            let end = part.max[axis] - min[axis];
            start as usize..end as usize
        });
        let indices = rows.flat_map(|y| columns.clone().map(move |x| y * width + x));
        let pixel = |index: usize| TracedPixel {
            hides: hides[index],
            outline: outline(&visible, size, index),
        };
        Ok(indices.map(pixel).collect())
    }
}

/// Traces a part of a row from its first pixel.
fn trace_row(
    intersector: &dyn Intersector,
    camera: &Camera,
    view: &ViewUniform,
    first: UVec2,
    row: &mut [VisibleSurface],
) {
    let ray = |x: u32| camera.ray(first + UVec2::new(x, 0), Vec2::splat(0.5));
    let rays: Vec<Ray> = (0..row.len() as u32).map(ray).collect();
    let mut hits = vec![None; rays.len()];
    intersector.coherent_hits(&rays, &mut hits);
    for ((visible, hit), ray) in row.iter_mut().zip(hits).zip(&rays) {
        if let Some(hit) = hit {
            let point = ray.at(hit.t);
            let depth = view.depth_of(behind(point, ray, camera));
            *visible = VisibleSurface {
                depth,
                slack: view.depth_of(point) - depth,
                // v tells the operands of a solid apart.
                surface: Some([hit.primitive, hit.v.to_bits()]),
            };
        }
    }
}

/// The point behind a hit by [`SLACK_PX`], and by what rounding of t and of lines' points to f32 takes.
fn behind(point: DVec3, ray: &Ray, camera: &Camera) -> DVec3 {
    const ULPS: f64 = 4.0;
    let reach = point.abs().max_element() + ray.origin.as_dvec3().abs().max_element();
    let rounding = ULPS * f64::from(f32::EPSILON) * reach;
    let pixel = camera.pixel_size_at(camera.depth_of(point));
    point + (SLACK_PX * pixel + rounding) * ray.dir.as_dvec3().normalize_or_zero()
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

/// The depth of the outline in a pixel, or −1 if there is none: the nearer of two neighbouring pixels that show
/// different surfaces, or a fold of one surface in front of itself, has it; both do if they are equally near.
fn outline(visible: &[VisibleSurface], size: UVec2, index: usize) -> f32 {
    let (width, height) = (size.x as usize, size.y as usize);
    let (x, y) = (index % width, index / width);
    // The number of pixels on a side, and the distance of their indices.
    let sides = [
        (x, -1),
        (width - 1 - x, 1),
        (y, -(width as isize)),
        (height - 1 - y, width as isize),
    ];
    let own = visible[index];
    let is_outline = |side: usize| {
        let (count, step) = sides[side];
        let at = |steps: isize| visible[(index as isize + steps * step) as usize];
        if count == 0 {
            return false;
        }
        let other = at(1);
        if other.surface != own.surface {
            return other.depth <= own.depth;
        }
        // Depth is linear in the picture where a surface is flat.
        let change = |a: VisibleSurface, b: VisibleSurface| {
            let is_same = a.surface == own.surface && b.surface == own.surface;
            is_same.then(|| (a.depth - b.depth).abs())
        };
        let before = (sides[side ^ 1].0 > 0)
            .then(|| change(at(-1), own))
            .flatten();
        let after = (count > 1).then(|| change(other, at(2))).flatten();
        let Some(beside) = before.into_iter().chain(after).reduce(f32::max) else {
            return false;
        };
        own.depth - other.depth > (FOLD * beside).max(FOLD_SLACKS * own.slack)
    };
    if own.surface.is_some() && (0..4).any(is_outline) {
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
            slack: 0.0,
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

    #[test]
    fn a_fold_of_one_surface_has_an_outline_and_a_round_border_and_an_edge_have_none() {
        let outlined = |depths: &[f32]| -> Vec<usize> {
            let visible: Vec<VisibleSurface> = depths
                .iter()
                .map(|&depth| VisibleSurface {
                    depth,
                    slack: 1e-3,
                    surface: Some([0, 0]),
                })
                .collect();
            let size = UVec2::new(depths.len() as u32, 1);
            let has_outline = |index: &usize| outline(&visible, size, *index) >= 0.0;
            (0..depths.len()).filter(has_outline).collect()
        };
        assert_eq!(outlined(&[0.2, 0.21, 0.22, 0.5, 0.52, 0.53]), [3]);
        assert_eq!(outlined(&[0.5, 0.45, 0.2, 0.19]), [1]);
        let round: Vec<f32> = (0..9).map(|x| 0.1 + 0.1 * (x as f32).sqrt()).collect();
        assert!(outlined(&round).is_empty());
        assert!(outlined(&[0.5, 0.5, 0.5, 0.48, 0.46, 0.44]).is_empty());
    }
}
