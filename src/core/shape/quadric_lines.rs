//! Wireframe lines of quadrics: intersections with planes perpendicular to each axis.
//!
//! Source: Lorensen, Cline, "Marching Cubes", SIGGRAPH 1987, in the plane: the curve crosses a cell of a grid between
//! the edges at whose ends the left side has opposite signs.
//! Differs from it: the crossing with an edge is exact, as the left side is a quadratic polynomial along it.

use super::lines::{AddLine, LineDetail, LinePoint};
use super::quadric::Quadric;
use glam::DVec3;

/// Positions of the planes, relative to half the box's edge.
const PLANES: [f64; 5] = [-0.8, -0.4, 0.0, 0.4, 0.8];

/// Passes the curves to `add`, piece by piece.
pub(super) fn quadric_lines(quadric: &Quadric, detail: &LineDetail, add: AddLine<'_>) {
    let cells = (detail.segments / 2).max(4);
    let half = quadric.half.as_dvec3();
    for axis in 0..3 {
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        for at in PLANES {
            let corner = |a: u32, b: u32| {
                let place = |x: u32| 2.0 * f64::from(x) / f64::from(cells) - 1.0;
                let mut p = DVec3::ZERO;
                (p[axis], p[j], p[k]) = (at * half[axis], place(a) * half[j], place(b) * half[k]);
                p
            };
            for a in 0..cells {
                for b in 0..cells {
                    let corners = [(a, b), (a + 1, b), (a + 1, b + 1), (a, b + 1)];
                    cell(quadric, corners.map(|(a, b)| corner(a, b)), add);
                }
            }
        }
    }
}

/// The curve's pieces in a cell: one between two crossings of its edges, or two between four.
fn cell(quadric: &Quadric, corners: [DVec3; 4], add: AddLine<'_>) {
    let edges = (0..4).map(|k| (corners[k], corners[(k + 1) % 4]));
    let crossings: Vec<DVec3> = edges
        .filter_map(|(from, to)| crossing(quadric, from, to))
        .collect();
    for pair in crossings.chunks_exact(2) {
        let centre = quadric.centre.as_dvec3();
        add(&[pair[0], pair[1]].map(|p| LinePoint {
            position: centre + p,
            normal: quadric.gradient(p).normalize_or_zero(),
        }));
    }
}

/// The point between two others at which the left side changes its sign.
fn crossing(quadric: &Quadric, from: DVec3, to: DVec3) -> Option<DVec3> {
    let (start, end) = (quadric.value(from), quadric.value(to));
    if (start < 0.0) == (end < 0.0) {
        return None;
    }
    // The quadratic polynomial through the values at 0, 1/2 and 1: a·s² + b·s + start.
    let middle = quadric.value(0.5 * (from + to));
    let a = 2.0 * (start + end) - 4.0 * middle;
    let b = end - start - a;
    let root = (b * b - 4.0 * a * start).max(0.0).sqrt();
    let q = -0.5 * (b + root.copysign(b));
    let is_between = |s: &f64| (0.0..=1.0).contains(s);
    let s = [start / q, q / a].into_iter().find(is_between);
    Some(from.lerp(to, s.unwrap_or(0.5)))
}
