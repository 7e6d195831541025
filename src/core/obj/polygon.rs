//! Cuts polygons into triangles.

use super::delaunay;
use super::error::Problem;
use super::fence::fenced;
use crate::progress::{Cancelled, Progress};
use earcut::Earcut;
use glam::DVec3;

/// Up to so many corners, ears are clipped: for a polygon that crosses itself that takes up to FEW³ steps, a tenth of
/// a millisecond (2026-11). Larger ones are cut by a Delaunay triangulation, which takes n log n: 50 ms for 10 000.
const FEW: usize = 100;
/// Of more corners than this, rounding makes a circle concave here and there; by so little that a fan fits it.
const MANY: usize = 1000;
/// Of more corners than this, a concave polygon becomes a fan: a triangulation takes some 300 bytes a corner.
pub(super) const LARGEST: usize = 1_000_000;

/// Cuts polygons; keeps its buffers between them.
pub(super) struct Triangulator {
    earcut: Earcut<f64>,
    projected: Vec<[f64; 2]>,
    indices: Vec<u32>,
}

/// How a polygon was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// Its triangles cover it once.
    Good,
    /// It crosses itself, has no plane, or is too large: a fan from its first corner.
    Fan,
}

impl Triangulator {
    pub(super) fn new() -> Self {
        Self {
            earcut: Earcut::new(),
            projected: Vec::new(),
            indices: Vec::new(),
        }
    }

    /// Calls `triangle` with three corners of the polygon for each of its triangles, which keep the polygon's winding.
    /// A fan has n − 2 triangles; otherwise there may be fewer, or more where the polygon touches itself.
    ///
    /// A convex polygon becomes a fan. A small one is ear-clipped in the plane of its vector area, a large one cut
    /// by a Delaunay triangulation.
    ///
    /// # Errors
    /// Cancelled by `progress`.
    pub(super) fn cut(
        &mut self,
        corners: &[DVec3],
        progress: &Progress,
        mut triangle: impl FnMut([usize; 3]),
    ) -> Result<Cut, Problem> {
        let count = corners.len();
        let is_fan = count == 3 || is_convex(corners) || (count > MANY && fan_fits(corners));
        if !is_fan && self.cut_concave(corners, progress)? {
            for corner in self.indices.chunks_exact(3) {
                triangle([corner[0] as usize, corner[1] as usize, corner[2] as usize]);
            }
            return Ok(Cut::Good);
        }
        (1..count - 1).for_each(|k| triangle([0, k, k + 1]));
        Ok(if is_fan { Cut::Good } else { Cut::Fan })
    }

    /// Fills the list of indices; `false` if the polygon can't be cut.
    fn cut_concave(&mut self, corners: &[DVec3], progress: &Progress) -> Result<bool, Problem> {
        if corners.len() <= FEW {
            // What a crate makes of a polygon that it panics at, a fan can do without it.
            let is_cut = fenced("cutting a polygon", || self.clip_ears(corners));
            return Ok(is_cut.unwrap_or(false));
        }
        self.indices.clear();
        if corners.len() > LARGEST {
            return Ok(false);
        }
        triangulated(corners, progress, &mut self.indices)
    }

    /// Whether ears could be clipped so that the triangles' areas add up to the polygon's.
    fn clip_ears(&mut self, corners: &[DVec3]) -> bool {
        let Some(normal) = vector_area(corners).try_normalize() else {
            return false;
        };
        let (x, y) = normal.any_orthonormal_pair();
        // Relative to a corner, so that a polygon far away keeps its shape.
        let project = |&p: &DVec3| [(p - corners[0]).dot(x), (p - corners[0]).dot(y)];
        self.projected.clear();
        self.projected.extend(corners.iter().map(project));
        self.indices.clear();
        self.earcut
            .earcut_slice(&self.projected, &[], &mut self.indices);

        let point = |i: u32| self.projected[i as usize];
        let area = |t: &mut [u32]| {
            let [a, b, c] = [point(t[0]), point(t[1]), point(t[2])];
            let doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
            if doubled < 0.0 {
                t.swap(1, 2);
            }
            doubled.abs()
        };
        let cut: f64 = self.indices.chunks_exact_mut(3).map(area).sum();
        let whole = 2.0 * vector_area(corners).length();
        // Sums of n products each would differ by some n·2⁻⁵², but a polygon that isn't quite flat
        // projects to a little less than its area; a crossing changes far more.
        (cut - whole).abs() <= 1e-9 * whole
    }
}

/// Fills `indices` by a Delaunay triangulation; `false` if there is none, also where the crate panics.
fn triangulated(
    corners: &[DVec3],
    progress: &Progress,
    indices: &mut Vec<u32>,
) -> Result<bool, Problem> {
    let work = || delaunay::triangulate(corners, progress, indices);
    match fenced("cutting a polygon", work) {
        Ok(is_cut) => is_cut.map_err(|Cancelled| Problem::Cancelled),
        Err(_) => Ok(false),
    }
}

/// Half the sum of the cross products along the edges: the polygon's normal, as long as its area.
pub(super) fn vector_area(corners: &[DVec3]) -> DVec3 {
    let from_first = |p: DVec3| p - corners[0];
    let edge = |pair: &[DVec3]| from_first(pair[0]).cross(from_first(pair[1]));
    0.5 * corners.windows(2).map(edge).sum::<DVec3>()
}

/// Whether the triangles of a fan that are turned over have next to no area.
fn fan_fits(corners: &[DVec3]) -> bool {
    let normal = vector_area(corners).normalize_or_zero();
    let doubled = |pair: &[DVec3]| {
        (pair[0] - corners[0])
            .cross(pair[1] - corners[0])
            .dot(normal)
    };
    let (right, wrong) = corners
        .windows(2)
        .map(doubled)
        .fold((0.0, 0.0), |(right, wrong), x| {
            (right + x.max(0.0), wrong + (-x).max(0.0))
        });
    wrong <= 1e-9 * right && right > 0.0 && goes_round_once(corners, normal)
}

/// Whether every corner turns the same way and the boundary goes round once, so that a fan fits.
fn is_convex(corners: &[DVec3]) -> bool {
    let normal = vector_area(corners);
    let count = corners.len();
    let edge = |k: usize| corners[(k + 1) % count] - corners[k % count];
    let turns_left = |k: usize| edge(k).cross(edge(k + 1)).dot(normal) >= 0.0;
    let fan_is_positive = (1..count - 1).all(|k| {
        let side = (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]);
        side.dot(normal) >= 0.0
    });
    normal != DVec3::ZERO
        && (0..count).all(turns_left)
        && fan_is_positive
        && goes_round_once(corners, normal)
}

/// Whether a polygon all of whose corners turn the same way, but for rounding, goes round its middle once.
fn goes_round_once(corners: &[DVec3], normal: DVec3) -> bool {
    // Fewer corners can't go round twice.
    const LEAST: usize = 5;
    let count = corners.len();
    let Some(normal) = normal.try_normalize() else {
        return count < LEAST;
    };
    if count < LEAST {
        return true;
    }
    let y = normal.any_orthonormal_vector();
    let middle = corners.iter().sum::<DVec3>() / count as f64;
    // Passes over the ray from the middle along x, less those the other way.
    let mut turns = 0;
    for k in 0..count {
        let [from, to] = [k, (k + 1) % count].map(|k| corners[k] - middle);
        let (is_above, becomes_above) = (from.dot(y) >= 0.0, to.dot(y) >= 0.0);
        let side = from.cross(to).dot(normal);
        if is_above != becomes_above && (side > 0.0) == becomes_above {
            turns += if becomes_above { 1 } else { -1 };
        }
    }
    turns == 1
}

#[cfg(test)]
mod tests;
