//! Cutting polygons into triangles.

use earcut::Earcut;
use glam::DVec3;

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
    /// It crosses itself or has no plane: a fan from its first corner.
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
    pub(super) fn cut(&mut self, corners: &[DVec3], mut triangle: impl FnMut([usize; 3])) -> Cut {
        let count = corners.len();
        if count == 3 || is_convex(corners) {
            (1..count - 1).for_each(|k| triangle([0, k, k + 1]));
            return Cut::Good;
        }
        if self.clip_ears(corners) {
            for corner in self.indices.chunks_exact(3) {
                triangle([corner[0] as usize, corner[1] as usize, corner[2] as usize]);
            }
            return Cut::Good;
        }
        (1..count - 1).for_each(|k| triangle([0, k, k + 1]));
        Cut::Fan
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
        let how = Triangulator::new().cut(&corners, |t| {
            let [a, b, c] = t.map(|k| points[k]);
            area += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
        });
        (how, area)
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
}
