//! Polygon triangulation, and the outlines of triangulated polygons.

mod delaunay;
mod outline;

pub(crate) use outline::Outline;

use crate::mesh::{aspect, has_zero_area};
use crate::progress::{Cancelled, Progress};
use earcut::Earcut;
use glam::{DVec3, Vec3};
use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Maximum number of corners for ear clipping. It takes up to `FEW`³ steps for a polygon that crosses itself: a tenth
/// of a millisecond (2026-11). Larger polygons get a Delaunay triangulation in O(n log n): 50 ms for 10 000 corners.
const FEW: usize = 100;
/// Above this many corners, a fan may have flipped triangles of negligible area: rounding makes large circles slightly
/// concave in places.
const EXACT_FAN: usize = 1000;
/// Memory per corner for a Delaunay triangulation (measured 2026-11).
pub(crate) const BYTES_PER_CORNER: usize = 450;
/// Above this many corners, a concave polygon becomes a fan, to limit the memory.
pub(crate) const LARGEST: usize = 1_000_000;

/// Buffers for triangulating polygons, reused for each polygon.
pub(crate) struct Triangulator {
    earcut: Earcut<f64>,
    projected: Vec<[f64; 2]>,
    indices: Vec<u32>,
}

/// The outcome of a triangulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cut {
    /// The triangles cover the polygon once.
    Good,
    /// A fan from the first corner, because the polygon crosses itself, has no plane, or is too large.
    Fan,
    /// Some corners belong to no triangle, or only to triangles without an area.
    Incomplete,
}

impl Triangulator {
    pub(crate) fn new() -> Self {
        Self {
            earcut: Earcut::new(),
            projected: Vec::new(),
            indices: Vec::new(),
        }
    }

    /// Triangulates a polygon; [`triangle`](Self::triangle) returns the result, in the polygon's winding. A fan has n − 2
    /// triangles. Other triangulations may have fewer, or more if the polygon touches itself. `corners` are the file's
    /// coordinates; `placed` are the mesh's, which are rounded.
    ///
    /// A convex polygon becomes a fan. A small concave polygon is ear-clipped in the plane of its vector area; a large
    /// one gets a Delaunay triangulation. If the result misses a corner or has a triangle of little or no area, as
    /// happens with collinear corners, the rounded polygon gets a Delaunay triangulation. Each edge of the polygon must
    /// belong to a triangle; otherwise a closed mesh gets open edges. Two polygons must not share a diagonal; otherwise
    /// an edge gets more than two triangles.
    ///
    /// # Errors
    /// [`Cancelled`] by `progress`.
    pub(crate) fn cut(
        &mut self,
        corners: &[DVec3],
        placed: &[Vec3],
        progress: &Progress,
    ) -> Result<Cut, Cancelled> {
        progress.check()?;
        let count = corners.len();
        let fan = || (1..count as u32 - 1).flat_map(|k| [0, k, k + 1]);
        let mut how = Cut::Good;
        let is_fan = count == 3 || is_convex(corners) || (count > EXACT_FAN && fan_fits(corners));
        if is_fan {
            self.indices.clear();
            self.indices.extend(fan());
        } else if !self.cut_concave(corners, progress)? {
            self.indices.clear();
            self.indices.extend(fan());
            how = Cut::Fan;
        }
        // A large concave polygon already has a Delaunay triangulation. It needs a second one only if rounding flattened a
        // triangle.
        let is_bad = if is_fan || count <= FEW {
            is_thin
        } else {
            has_zero_area
        };
        if how == Cut::Good && count > 3 && count <= LARGEST && !self.is_regular(placed, is_bad) {
            how = self.retriangulate(placed, progress)?;
        }
        Ok(how)
    }

    /// Replaces the triangles by a Delaunay triangulation, if one reaches all corners with triangles that have an area.
    fn retriangulate(&mut self, placed: &[Vec3], progress: &Progress) -> Result<Cut, Cancelled> {
        /// Directions of projection, the first one along an axis: corners that it makes one are apart in the others. An
        /// edge between two such corners may fold the outline in some of the others, but hardly in all four quadrants.
        const SHEARS: [[f64; 2]; 5] = [
            [0.0, 0.0],
            [0.25, 0.125],
            [-0.125, 0.25],
            [-0.25, -0.125],
            [0.125, -0.25],
        ];
        /// Larger polygons take too long to be triangulated several times.
        const MOST_SHEARED: usize = 10_000;
        let corners: Vec<DVec3> = placed.iter().map(|p| p.as_dvec3()).collect();
        let count = if corners.len() > MOST_SHEARED {
            1
        } else {
            SHEARS.len()
        };
        let mut incomplete = None;
        for &shear in &SHEARS[..count] {
            let mut indices = Vec::new();
            if !triangulated(&corners, shear, progress, &mut indices)? {
                continue;
            }
            if is_complete(&indices, placed) {
                self.indices = indices;
                return Ok(Cut::Good);
            }
            incomplete.get_or_insert(indices);
        }
        if is_complete(&self.indices, placed) {
            return Ok(Cut::Good);
        }
        if let Some(indices) = incomplete {
            self.indices = indices;
        }
        Ok(Cut::Incomplete)
    }

    /// Number of triangles of the polygon that was triangulated last.
    pub(crate) fn count(&self) -> usize {
        self.indices.len() / 3
    }

    /// The corners of one of these triangles.
    pub(crate) fn triangle(&self, index: usize) -> [usize; 3] {
        [0, 1, 2].map(|k| self.indices[3 * index + k] as usize)
    }

    /// Whether there are as many triangles as in a fan, so that no corner is missed, and none is bad.
    fn is_regular(&self, placed: &[Vec3], is_bad: fn([Vec3; 3]) -> bool) -> bool {
        let mut triangles = self.indices.chunks_exact(3);
        triangles.len() == placed.len() - 2
            && triangles.all(|t| !is_bad([0, 1, 2].map(|k| placed[t[k] as usize])))
    }

    /// Fills `self.indices` for a concave polygon. Returns `false` if it can't be triangulated.
    fn cut_concave(&mut self, corners: &[DVec3], progress: &Progress) -> Result<bool, Cancelled> {
        if corners.len() <= FEW {
            // If a dependency panics, the polygon becomes a fan.
            let work = AssertUnwindSafe(|| self.clip_ears(corners));
            return Ok(catch_unwind(work).unwrap_or(false));
        }
        self.indices.clear();
        if corners.len() > LARGEST {
            return Ok(false);
        }
        triangulated(corners, [0.0; 2], progress, &mut self.indices)
    }

    /// Triangulates by ear clipping. Returns whether the triangles' areas add up to the polygon's.
    fn clip_ears(&mut self, corners: &[DVec3]) -> bool {
        let Some(normal) = vector_area(corners).try_normalize() else {
            return false;
        };
        let (x, y) = normal.any_orthonormal_pair();
        // Project relative to a corner, so that a distant polygon keeps its shape.
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
        // Both sums of n products have a relative error of about n·2⁻⁵². A polygon that isn't quite flat projects to
        // slightly less than its area. A crossing changes the area far more.
        (cut - whole).abs() <= 1e-9 * whole
    }
}

/// Whether a triangle's height is so small, relative to its longest edge, that it may come from rounding: a corner on
/// an edge is off by half an ulp of its coordinates, which are up to some thousand times the edge's length.
fn is_thin(corners: [Vec3; 3]) -> bool {
    const THIN: f64 = 4096.0;
    aspect(corners) >= THIN
}

/// Whether each triangle has an area, and each corner, or another one at its position, belongs to a triangle.
fn is_complete(indices: &[u32], placed: &[Vec3]) -> bool {
    let mut is_reached = vec![false; placed.len()];
    for triangle in indices.chunks_exact(3) {
        let corners = [0, 1, 2].map(|k| triangle[k] as usize);
        if has_zero_area(corners.map(|corner| placed[corner])) {
            return false;
        }
        for corner in corners {
            is_reached[corner] = true;
        }
    }
    if !is_reached.contains(&false) {
        return true;
    }
    // Adding +0 makes −0 equal to 0.
    let bits = |corner: usize| (placed[corner] + Vec3::ZERO).to_array().map(f32::to_bits);
    let (reached, missed): (Vec<usize>, Vec<usize>) =
        (0..placed.len()).partition(|&corner| is_reached[corner]);
    let reached: HashSet<[u32; 3]> = reached.into_iter().map(bits).collect();
    missed
        .into_iter()
        .all(|corner| reached.contains(&bits(corner)))
}

/// Appends a Delaunay triangulation to `indices`. Returns `false` if there is none or the dependency panics.
fn triangulated(
    corners: &[DVec3],
    shear: [f64; 2],
    progress: &Progress,
    indices: &mut Vec<u32>,
) -> Result<bool, Cancelled> {
    let work = || delaunay::triangulate(corners, shear, progress, indices);
    catch_unwind(AssertUnwindSafe(work)).unwrap_or(Ok(false))
}

/// The vector area: half the sum of the cross products along the edges. Its direction is the polygon's normal, its
/// length the area.
pub(crate) fn vector_area(corners: &[DVec3]) -> DVec3 {
    let from_first = |p: DVec3| p - corners[0];
    let edge = |pair: &[DVec3]| from_first(pair[0]).cross(from_first(pair[1]));
    0.5 * corners.windows(2).map(edge).sum::<DVec3>()
}

/// Whether the flipped triangles of a fan have negligible area, and the boundary winds once.
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
    wrong <= 1e-9 * right && right > 0.0 && winds_once(corners, normal)
}

/// Whether every corner turns the same way and the boundary winds once, so that a fan covers the polygon.
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
        && winds_once(corners, normal)
}

/// Whether a polygon winds once around its centre. All its corners must turn the same way, except for rounding.
fn winds_once(corners: &[DVec3], normal: DVec3) -> bool {
    // Polygons with fewer corners can't wind twice.
    const MIN_CORNERS: usize = 5;
    let count = corners.len();
    let Some(normal) = normal.try_normalize() else {
        return count < MIN_CORNERS;
    };
    if count < MIN_CORNERS {
        return true;
    }
    let y = normal.any_orthonormal_vector();
    let middle = corners.iter().sum::<DVec3>() / count as f64;
    // Count signed crossings of the ray from the centre along x.
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
