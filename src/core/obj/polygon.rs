//! Which triangles is a polygon cut into?

use super::error::Problem;
use super::fence::fenced;
use crate::progress::{BackgroundError, Progress};
use earcut::Earcut;
use glam::DVec3;

/// Of more corners than this, rounding makes a circle concave here and there; by so little that a fan fits it.
const MANY: usize = 1000;
/// Of more corners than this, ears are clipped on a thread of their own, which nobody waits for if the load is
/// cancelled: of this many that takes up to 0.1 s (2026-11), and the time grows by the square.
const LARGE: usize = 10_000;
/// Of more corners than this, ears aren't clipped: it takes 1 s for a star, up to 20 s for worse (2026-11).
const LARGEST: usize = 100_000;

/// Cuts polygons; keeps its buffers between them.
pub(super) struct Triangulator {
    earcut: Earcut<f64>,
    projected: Vec<[f64; 2]>,
    indices: Vec<u32>,
}

/// How a polygon was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cut {
    /// As it should be.
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

    /// Calls `triangle` with three corners of the polygon for each of its triangles, which keep the
    /// polygon's winding. There are always n − 2 of a fan and at most as many otherwise.
    ///
    /// A convex polygon becomes a fan; others are ear-clipped in the plane of their vector area.
    ///
    /// # Errors
    /// Cancelled by `progress`, or there is no thread to be had.
    pub(super) fn cut(
        &mut self,
        corners: &[DVec3],
        progress: &Progress,
        mut triangle: impl FnMut([usize; 3]),
    ) -> Result<Cut, Problem> {
        let count = corners.len();
        let is_fan = count == 3 || is_convex(corners) || (count > MANY && fan_fits(corners));
        if !is_fan && self.clip_ears_unless_cancelled(corners, progress)? {
            for corner in self.indices.chunks_exact(3) {
                triangle([corner[0] as usize, corner[1] as usize, corner[2] as usize]);
            }
            return Ok(Cut::Good);
        }
        (1..count - 1).for_each(|k| triangle([0, k, k + 1]));
        Ok(if is_fan { Cut::Good } else { Cut::Fan })
    }

    fn clip_ears_unless_cancelled(
        &mut self,
        corners: &[DVec3],
        progress: &Progress,
    ) -> Result<bool, Problem> {
        if corners.len() <= LARGE {
            // What the crate makes of a polygon that it panics at, a fan can do without it.
            let is_cut = fenced("cutting a polygon", || self.clip_ears(corners));
            return Ok(is_cut.unwrap_or(false));
        }
        if corners.len() > LARGEST {
            return Ok(false);
        }
        let (mut other, corners) = (Self::new(), corners.to_vec());
        let clip = move || {
            let is_cut = fenced("cutting a polygon", || other.clip_ears(&corners));
            (is_cut.unwrap_or(false), other)
        };
        let (is_cut, other) = match progress.run_in_background("polygon", clip) {
            Ok(result) => result,
            Err(BackgroundError::Cancelled) => return Err(Problem::Cancelled),
            Err(BackgroundError::NoThread(error)) => return Err(Problem::Read(error)),
        };
        *self = other;
        Ok(is_cut)
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

/// Half the sum of the cross products along the edges: the polygon's normal, as long as its area.
fn vector_area(corners: &[DVec3]) -> DVec3 {
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
    wrong <= 1e-9 * right && right > 0.0
}

/// Whether every corner turns the same way and the boundary goes round once: a fan then fits.
fn is_convex(corners: &[DVec3]) -> bool {
    let normal = vector_area(corners);
    let count = corners.len();
    let edge = |k: usize| corners[(k + 1) % count] - corners[k % count];
    let turns_left = |k: usize| edge(k).cross(edge(k + 1)).dot(normal) >= 0.0;
    let fan_is_positive = (1..count - 1).all(|k| {
        let side = (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]);
        side.dot(normal) >= 0.0
    });
    normal != DVec3::ZERO && (0..count).all(turns_left) && fan_is_positive
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(points: &[[f64; 2]]) -> (Cut, f64) {
        // In a slanted plane, far away.
        let place = |p: &[f64; 2]| DVec3::new(p[0] + 1e4, p[1], 0.3 * p[0] - 0.2 * p[1]);
        let corners: Vec<DVec3> = points.iter().map(place).collect();
        let mut area = 0.0;
        let progress = Progress::default();
        let how = Triangulator::new().cut(&corners, &progress, |t| {
            let [a, b, c] = t.map(|k| points[k]);
            area += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
        });
        (how.expect("nobody cancels"), area)
    }

    #[test]
    fn the_triangles_have_the_polygons_area_and_winding() {
        let arrow = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]];
        let l_shape = [
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        let u_shape = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [2.0, 3.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ];
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let cases: [(&[[f64; 2]], f64); 4] = [
            (&arrow, 1.0),
            (&l_shape, 3.0),
            (&u_shape, 7.0),
            (&square, 1.0),
        ];
        for (points, area) in cases {
            for reversed in [false, true] {
                let mut points = points.to_vec();
                if reversed {
                    points.reverse();
                }
                let (how, found) = cut(&points);
                assert_eq!(how, Cut::Good);
                assert!((found.abs() - area).abs() < 1e-9, "{points:?}: {found}");
                assert_eq!(found < 0.0, reversed);
            }
        }
    }

    #[test]
    fn what_crosses_itself_or_has_no_plane_becomes_a_fan() {
        assert_eq!(
            cut(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]).0,
            Cut::Fan
        );
        assert_eq!(
            cut(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]).0,
            Cut::Fan
        );
        let star: Vec<[f64; 2]> = (0..5)
            .map(|k| f64::from(k) * 4.0 * std::f64::consts::PI / 5.0)
            .map(|a| [a.cos(), a.sin()])
            .collect();
        assert_eq!(cut(&star).0, Cut::Fan);
    }

    /// A star of so many corners.
    fn star(count: u32) -> Vec<[f64; 2]> {
        let corner = |k: u32| {
            let angle = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
            let radius = if k.is_multiple_of(2) { 1.0 } else { 0.7 };
            [radius * angle.cos(), radius * angle.sin()]
        };
        (0..count).map(corner).collect()
    }

    #[test]
    fn large_polygons_are_cut_aside_and_the_largest_as_a_fan() {
        let count = LARGE as u32 + 2;
        let (how, area) = cut(&star(count));
        // As many triangles of radii 1 and 0.7 as corners.
        let angle = std::f64::consts::TAU / f64::from(count);
        let expected = f64::from(count) * 0.5 * 0.7 * angle.sin();
        assert_eq!(how, Cut::Good);
        assert!((area - expected).abs() < 1e-9, "{area}, {expected}");
        assert_eq!(cut(&star(LARGEST as u32 + 2)).0, Cut::Fan);
    }

    #[test]
    fn a_large_circle_is_a_fan_although_its_corners_are_rounded() {
        let count = 2 * LARGEST as u32;
        let corner = |k: u32| {
            let angle = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
            [angle.cos() as f32, angle.sin() as f32].map(f64::from)
        };
        let (how, area) = cut(&(0..count).map(corner).collect::<Vec<_>>());
        assert_eq!(how, Cut::Good);
        assert!((area - std::f64::consts::PI).abs() < 1e-5, "{area}");
    }

    #[test]
    fn nobody_waits_for_a_large_polygon_that_is_not_wanted() {
        let corners: Vec<DVec3> = star(LARGEST as u32)
            .iter()
            .map(|p| DVec3::new(p[0], p[1], 0.0))
            .collect();
        let progress = Progress::default();
        progress.cancel();
        let result = Triangulator::new().cut(&corners, &progress, |_| {});
        assert!(matches!(result, Err(Problem::Cancelled)));
    }
}
