//! Constrained Delaunay triangulation of large polygons, in O(n log n).
//!
//! Source: L. P. Chew, "Constrained Delaunay Triangulations", Algorithmica 4, 1989; implemented by the crate `spade`,
//! whose predicates are exact.
//!
//! The polygon is projected onto the coordinate plane most nearly parallel to it, so that no coordinate is rounded:
//! corners that touch an edge, and bridges to holes, stay in place. The polygon's edges are forced into the
//! triangulation of its corners one by one; an edge that crosses another ends the attempt. The polygon's triangles are
//! those with winding number one.

use super::vector_area;
use crate::progress::{Cancelled, Progress};
use glam::DVec3;
use spade::handles::{FixedDirectedEdgeHandle, FixedFaceHandle, FixedVertexHandle, InnerTag};
use spade::{
    ConstrainedDelaunayTriangulation, HierarchyHintGenerator, Intersection,
    LineIntersectionIterator, Point2, Triangulation,
};
use std::collections::HashMap;

/// Limits on the steps for forcing edges: a constant, which takes about a second, plus a number per corner. Ordinary
/// polygons need a few steps per edge.
const MAX_STEPS: usize = 1 << 24;
const MAX_STEPS_PER_CORNER: usize = 64;
/// Number of corners or edges between two cancellation checks.
const CORNERS_PER_CHECK: usize = 1 << 8;
/// The corner of a directed edge that isn't an edge of the polygon.
const NO_CORNER: u32 = u32::MAX;

/// A constrained triangulation that locates each inserted point through a hierarchy of the previous ones.
///
/// Points are inserted one by one: bulk insertion takes quadratic time if they lie on few circles or lines (14 s for a
/// comb of 100 000, 2026-11).
type Mesh = ConstrainedDelaunayTriangulation<Point2<f64>, (), (), (), HierarchyHintGenerator<f64>>;

/// Appends the corner indices of a polygon's triangles, three per triangle, with the polygon's winding. Returns `false`
/// if the polygon crosses itself, has no plane, or takes too many steps.
///
/// `shear` tilts the direction of projection. Corners in a line along that direction become one.
///
/// # Errors
/// [`Cancelled`] by `progress`.
pub(super) fn triangulate(
    corners: &[DVec3],
    shear: [f64; 2],
    progress: &Progress,
    triangles: &mut Vec<u32>,
) -> Result<bool, Cancelled> {
    let Some(points) = projected(corners, shear) else {
        return Ok(false);
    };
    progress.check()?;
    let Some(mut polygon) = Polygon::new(&points, progress)? else {
        return Ok(false);
    };
    progress.check()?;
    if !polygon.force_edges(progress)? {
        return Ok(false);
    }
    let Some(inside) = polygon.inside() else {
        return Ok(false);
    };
    progress.check()?;
    polygon.spread_corners();
    for face in inside {
        let edges = polygon.mesh.face(face).adjacent_edges();
        triangles.extend(edges.map(|edge| polygon.corner_left_of(edge.fix())));
    }
    Ok(true)
}

/// The corners projected onto the coordinate plane most nearly parallel to the polygon, counterclockwise, scaled by a
/// power of two to a size of about 1. `None` if the vector area is zero or not finite.
///
/// A shear adds multiples of the third coordinate to the other two. For coordinates of 24 bits it is exact, too, unless
/// they differ by more than 25 binary orders of magnitude: corners on a line stay on a line.
fn projected(corners: &[DVec3], shear: [f64; 2]) -> Option<Vec<Point2<f64>>> {
    let area = vector_area(corners);
    if !area.is_finite() || area == DVec3::ZERO {
        return None;
    }
    let across = area.abs().max_position();
    let (mut x, mut y) = ((across + 1) % 3, (across + 2) % 3);
    if area[across] < 0.0 {
        (x, y) = (y, x);
    }
    let largest = corners
        .iter()
        .fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
    // The logarithm's integer part is the f64 exponent. The scaling is exact, except for subnormal sizes.
    let scale = 2f64.powi(-(largest.log2().floor() as i32).clamp(-1000, 1000));
    let scaled = |x: f64| {
        let x = x * scale;
        // spade rejects smaller numbers. They are negligible compared with 1. −0 also becomes 0.
        if x.abs() < spade::MIN_ALLOWED_VALUE {
            0.0
        } else {
            x
        }
    };
    let point = |p: &DVec3| {
        let [x, y] =
            [(x, shear[0]), (y, shear[1])].map(|(axis, shear)| p[axis] + shear * p[across]);
        Point2::new(scaled(x), scaled(y))
    };
    Some(corners.iter().map(point).collect())
}

/// A polygon and the triangulation of its corners. Several corners may share a vertex.
struct Polygon {
    mesh: Mesh,
    /// For each corner, its vertex in the triangulation.
    vertex_of: Vec<FixedVertexHandle>,
    /// For each vertex, its first corner and its number of corners.
    corners_at: Vec<(u32, u32)>,
    /// For each directed edge, the corner at which the edge starts and to which the inside on the edge's left belongs;
    /// [`NO_CORNER`] if the polygon has no such edge.
    corner_of: Vec<u32>,
    /// For each undirected edge, how many times the polygon traverses it along its first directed edge, minus how many
    /// times in the other direction.
    passes: Vec<i32>,
}

impl Polygon {
    /// Triangulates the corners. `None` if all are collinear.
    fn new(points: &[Point2<f64>], progress: &Progress) -> Result<Option<Self>, Cancelled> {
        let mut places: Vec<(Point2<f64>, u32, u32)> = Vec::new();
        let mut known: HashMap<[u64; 2], usize> = HashMap::with_capacity(points.len());
        let mut place_of = Vec::with_capacity(points.len());
        for (corner, point) in points.iter().enumerate() {
            let key = [point.x.to_bits(), point.y.to_bits()];
            let place = *known.entry(key).or_insert_with(|| {
                places.push((*point, corner as u32, 0));
                places.len() - 1
            });
            places[place].2 += 1;
            place_of.push(place);
        }
        drop(known);
        let mut mesh = Mesh::new();
        let mut vertices = vec![FixedVertexHandle::from_index(0); places.len()];
        let mut corners_at = Vec::with_capacity(places.len());
        for (number, place) in scattered(places.len()).enumerate() {
            if number % CORNERS_PER_CHECK == 0 {
                progress.check()?;
            }
            let (point, first, count) = places[place];
            let Ok(vertex) = mesh.insert(point) else {
                return Ok(None);
            };
            vertices[place] = vertex;
            // Vertices are numbered in the order of insertion.
            corners_at.push((first, count));
        }
        if mesh.num_vertices() != places.len() || mesh.num_inner_faces() == 0 {
            return Ok(None);
        }
        Ok(Some(Self {
            corner_of: vec![NO_CORNER; mesh.num_directed_edges()],
            passes: vec![0; mesh.num_undirected_edges()],
            mesh,
            vertex_of: place_of.iter().map(|&place| vertices[place]).collect(),
            corners_at,
        }))
    }

    /// Forces every edge of the polygon into the triangulation. Returns `false` if two edges cross or the limit on
    /// steps is exceeded.
    fn force_edges(&mut self, progress: &Progress) -> Result<bool, Cancelled> {
        let count = self.vertex_of.len();
        let max_steps = MAX_STEPS + MAX_STEPS_PER_CORNER * count;
        let mut steps = 0;
        for (number, corner) in scattered(count).enumerate() {
            if number % CORNERS_PER_CHECK == 0 {
                progress.check()?;
            }
            let (from, to) = (self.vertex_of[corner], self.vertex_of[(corner + 1) % count]);
            if from == to {
                continue;
            }
            // The search for an edge iterates over the corners at its first vertex.
            steps += self.corners_at[from.index()].1 as usize;
            let mut crossings = 0;
            for crossed in LineIntersectionIterator::new_from_handles(&self.mesh, from, to) {
                if let Intersection::EdgeIntersection(edge) = crossed {
                    crossings += 1;
                    if edge.is_constraint_edge() || steps + steps_for(crossings) > max_steps {
                        return Ok(false);
                    }
                }
            }
            steps += steps_for(crossings);
            let parts = self.mesh.try_add_constraint(from, to);
            if parts.is_empty() || steps > max_steps {
                return Ok(false);
            }
            for part in parts {
                self.note_edge(corner as u32, from, part);
            }
        }
        Ok(true)
    }

    /// Records an edge of the polygon, or one part of an edge that passes through other vertices.
    fn note_edge(&mut self, corner: u32, from: FixedVertexHandle, part: FixedDirectedEdgeHandle) {
        let start = self.mesh.directed_edge(part).from().fix();
        let corner = if start == from {
            corner
        } else {
            self.corners_at[start.index()].0
        };
        self.corner_of[part.index()] = corner;
        self.passes[part.as_undirected().index()] += if is_first(part) { 1 } else { -1 };
    }

    /// How many times the polygon traverses a directed edge, minus how many times in the other direction.
    fn passes_along(&self, edge: FixedDirectedEdgeHandle) -> i32 {
        let passes = self.passes[edge.as_undirected().index()];
        if is_first(edge) { passes } else { -passes }
    }

    /// The triangles with winding number one. `None` if a triangle has a winding number other than 0 and 1: the polygon
    /// crosses itself.
    fn inside(&self) -> Option<Vec<FixedFaceHandle<InnerTag>>> {
        const UNSEEN: i32 = i32::MAX;
        let mut winding = vec![UNSEEN; self.mesh.num_all_faces()];
        let (mut inside, mut open) = (Vec::new(), vec![self.mesh.outer_face().fix()]);
        winding[0] = 0;
        // The edges of the outer face are those of the convex hull.
        let hull = self.mesh.convex_hull().map(|edge| edge.fix());
        let mut across: Vec<FixedDirectedEdgeHandle> = hull.collect();
        while let Some(face) = open.pop() {
            let of_face = winding[face.index()];
            if let Some(inner) = self.mesh.face(face).as_inner() {
                match of_face {
                    0 => {}
                    1 => inside.push(inner.fix()),
                    _ => return None,
                }
                across.extend(inner.adjacent_edges().map(|edge| edge.fix()));
            }
            // The inside is on the left of the polygon's edges, so the winding number there is one higher than on the
            // right.
            for edge in across.drain(..) {
                let edge = self.mesh.directed_edge(edge);
                let edge = if edge.face().fix() == face {
                    edge
                } else {
                    edge.rev()
                };
                let next = edge.rev().face().fix();
                if winding[next.index()] == UNSEEN {
                    winding[next.index()] = of_face - self.passes_along(edge.fix());
                    open.push(next);
                }
            }
        }
        inside.sort_unstable_by_key(|face| face.index());
        Some(inside)
    }

    /// Where several corners share a vertex, copies the corner of each polygon edge to the edges that follow it
    /// counterclockwise around the vertex.
    ///
    /// ```text
    ///    into corner 1 ╲   ╱ out of corner 2
    ///                   ╲ ╱
    ///       inside of 1  •  inside of 2        each inside starts at the edge out of its corner
    ///                   ╱ ╲
    ///  out of corner 1 ╱   ╲ into corner 2
    /// ```
    fn spread_corners(&mut self) {
        let mut around = Vec::new();
        for (vertex, &(first, count)) in self.corners_at.iter().enumerate() {
            if count == 1 {
                continue;
            }
            let vertex = self.mesh.vertex(FixedVertexHandle::from_index(vertex));
            around.clear();
            around.extend(vertex.out_edges().map(|edge| edge.fix().index()));
            let last = around
                .iter()
                .rev()
                .find(|&&e| self.corner_of[e] != NO_CORNER);
            let mut corner = last.map_or(first, |&e| self.corner_of[e]);
            for &edge in &around {
                match self.corner_of[edge] {
                    NO_CORNER => self.corner_of[edge] = corner,
                    own => corner = own,
                }
            }
        }
    }

    /// The corner at which an edge starts, for the triangle on the edge's left.
    fn corner_left_of(&self, edge: FixedDirectedEdgeHandle) -> u32 {
        let vertex = self.mesh.directed_edge(edge).from().fix();
        match self.corners_at[vertex.index()] {
            (only, 1) => only,
            _ => self.corner_of[edge.index()],
        }
    }
}

/// Estimated steps for forcing a polygon edge that crosses this many edges of the triangulation. The crossed edges are
/// flipped, then others until the triangulation is Delaunay again: 1 µs per crossing, plus 12 ns times the square of
/// their number (2026-11).
fn steps_for(crossings: usize) -> usize {
    16 * crossings + crossings * crossings / 4
}

/// The numbers below `count`, in an order in which every run of them is spread evenly over the range. In the polygon's
/// own order, each of several long parallel edges would cross all edges that the previous one crossed: 12 s for a
/// sheared comb of 10 000 corners.
fn scattered(count: usize) -> impl Iterator<Item = usize> {
    /// The golden ratio minus 1.
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let mut stride = ((count as f64 * GOLDEN) as usize).max(1);
    while greatest_common_divisor(stride, count) != 1 {
        stride += 1;
    }
    (0..count).map(move |k| k * stride % count)
}

fn greatest_common_divisor(a: usize, b: usize) -> usize {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

/// Whether a directed edge is the first of its undirected edge.
fn is_first(edge: FixedDirectedEdgeHandle) -> bool {
    edge.as_undirected().as_directed() == edge
}
