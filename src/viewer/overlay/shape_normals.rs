//! Normals of shapes that aren't triangles, at points that are spread evenly over each shape.
//!
//! Points are taken from the shape's lines, each line's middle first, and left out where another point with a similar
//! normal is near.

use super::gather::Gather;
use super::normals::LENGTH;
use super::shapes::{detail, each_group, extent};
use super::spec::{Fade, LineSpec};
use crate::gpu::lines::Line;
use glam::DVec3;
use hitscope_core::Scene;
use hitscope_core::group::Group;
use hitscope_core::shape::LinePoint;
use std::collections::HashMap;

/// The number of shapes per group with normals.
const MAX_SHAPES: usize = 20_000;
/// The number of spaces between points along the longest edge of a shape's box.
const SPACES: f64 = 4.0;
/// The number of candidates per space along a line.
const CANDIDATES: f64 = 4.0;

/// The lines for rows of the table.
pub const NORMALS_OF_SHAPES: LineSpec = LineSpec {
    fade: Fade::Spread,
    length: Some(&LENGTH),
    ..LineSpec::new(|input, _| {
        let has_any = input.scene.has_other_shapes();
        has_any.then(|| Gather::new((), |scene, ()| normals(scene)))
    })
};

/// The normals. Their length is the scene's radius; the style shortens them.
pub fn normals(scene: &Scene) -> Vec<Line> {
    let length = scene.bounds().radius();
    // A scene without bounds, such as a plane alone, counts as the unit sphere.
    let length = if length > 0.0 { length } else { 1.0 };
    let mut lines = Vec::new();
    each_group(scene, &mut |group, first| {
        let count = group.count().min(MAX_SHAPES);
        for index in (0..count as u32).filter(|index| scene.is_shown(first + index)) {
            let (points, space) = spread(scene, group, index, count);
            lines.extend(points.iter().map(|point| Line {
                start: point.position.as_vec3(),
                end: (point.position + length * point.normal).as_vec3(),
                gap: (space * DVec3::X).as_vec3(),
            }));
        }
    });
    lines
}

/// Points of a primitive, and the least distance between them.
fn spread(scene: &Scene, group: &dyn Group, index: u32, count: usize) -> (Vec<LinePoint>, f64) {
    let mut lines: Vec<Vec<LinePoint>> = Vec::new();
    let detail = detail(scene, count, None);
    group.lines(index, &detail, &mut |points| lines.push(points.to_vec()));
    let space = extent(&lines) / SPACES;
    let mut kept = Kept::new(space);
    for line in &lines {
        for point in candidates(line, space / CANDIDATES) {
            kept.add(point);
        }
    }
    (kept.points, space)
}

/// Points at equal distances along a line, from its middle outwards.
fn candidates(line: &[LinePoint], distance: f64) -> Vec<LinePoint> {
    if line.len() < 2 {
        return Vec::new();
    }
    let mut places = vec![0.0];
    for pair in line.windows(2) {
        let last = places[places.len() - 1];
        places.push(last + pair[0].position.distance(pair[1].position));
    }
    let length = places[places.len() - 1];
    // The positions on both sides of the middle. Rounding mustn't omit the ends.
    let count = (0.5 * length / distance + 1e-6).floor();
    let step = if count > 0.0 {
        0.5 * length / count
    } else {
        0.0
    };
    let at = |k: i32| {
        let place = (0.5 * length + step * f64::from(k)).clamp(0.0, length);
        let piece = places
            .partition_point(|end| *end < place)
            .clamp(1, line.len() - 1);
        let [from, to] = [line[piece - 1], line[piece]];
        let part = (place - places[piece - 1]) / (places[piece] - places[piece - 1]);
        let part = if part.is_finite() { part } else { 0.0 };
        LinePoint {
            position: from.position.lerp(to.position, part),
            normal: from.normal.lerp(to.normal, part).normalize_or_zero(),
        }
    };
    (0..=count as i32)
        .flat_map(|k| if k == 0 { vec![0] } else { vec![-k, k] })
        .map(at)
        .collect()
}

/// Points with a least distance between those with similar normals, in a grid of cells as wide as this distance.
struct Kept {
    space: f64,
    points: Vec<LinePoint>,
    cells: HashMap<[i64; 3], Vec<usize>>,
}

impl Kept {
    fn new(space: f64) -> Self {
        Self {
            space,
            points: Vec::new(),
            cells: HashMap::new(),
        }
    }

    /// Adds a point unless it is near one with a similar normal.
    fn add(&mut self, point: LinePoint) {
        /// Points on a lattice of this distance are kept in spite of rounding.
        const ROUNDING: f64 = 0.99;
        /// The least cosine of the angle between similar normals: that of 45°.
        const SIMILAR: f64 = std::f64::consts::FRAC_1_SQRT_2;
        if point.normal == DVec3::ZERO {
            return;
        }
        let cell = (point.position / self.space)
            .floor()
            .to_array()
            .map(|x| x as i64);
        let near = |other: &usize| {
            let other = &self.points[*other];
            let distance = other.position.distance(point.position);
            distance < ROUNDING * self.space && other.normal.dot(point.normal) > SIMILAR
        };
        let around = (0..27).filter_map(|k: i64| {
            let step = [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1];
            self.cells
                .get(&std::array::from_fn(|axis| cell[axis] + step[axis]))
        });
        if !around.flatten().any(near) {
            self.cells.entry(cell).or_default().push(self.points.len());
            self.points.push(point);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use hitscope_core::TriangleMesh;
    use hitscope_core::group::Grouped;
    use hitscope_core::mesh::Runs;
    use hitscope_core::progress::Progress;
    use hitscope_core::scene::{SceneOptions, scene};
    use hitscope_core::shape::{AxisBox, Sphere, Torus};

    /// Starts and directions of the normals of a shape alone.
    fn normals_of(shape: impl Grouped) -> Vec<[DVec3; 2]> {
        let mut scene = scene(TriangleMesh::default());
        let options = SceneOptions::default();
        let added = scene.add_group(vec![shape], Runs::default(), options, &Progress::default());
        added.expect("nobody cancels");
        let of_line = |line: &Line| {
            let [start, end] = [line.start, line.end].map(Vec3::as_dvec3);
            [start, (end - start).normalize()]
        };
        normals(&scene).iter().map(of_line).collect()
    }

    #[test]
    fn every_face_of_a_box_has_normals_at_its_centre_and_within_it() {
        for size in [Vec3::ONE, Vec3::new(1.0, 0.3, 0.05)] {
            let normals = normals_of(AxisBox {
                min: -size,
                max: size,
            });
            for axis in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
                let centre = axis * size.as_dvec3();
                let face = normals.iter().filter(|[_, normal]| normal.dot(axis) > 0.99);
                let is_at_centre = |[start, _]: &&[DVec3; 2]| start.distance(centre) < 1e-6;
                assert_eq!(
                    face.clone().filter(is_at_centre).count(),
                    1,
                    "{axis} of {size}"
                );
                if size == Vec3::ONE {
                    assert_eq!(face.count(), 25);
                }
            }
        }
    }

    #[test]
    fn shapes_of_a_size_have_similar_numbers_of_normals_that_are_apart() {
        let sphere = normals_of(Sphere {
            centre: Vec3::ZERO,
            radius: 1.0,
        });
        let torus = normals_of(Torus {
            centre: Vec3::ZERO,
            axis: Vec3::Z,
            major: 0.7,
            minor: 0.3,
        });
        for normals in [&sphere, &torus] {
            assert!((20..120).contains(&normals.len()), "{}", normals.len());
            for (k, [a, n]) in normals.iter().enumerate() {
                for [b, m] in &normals[k + 1..] {
                    assert!(a.distance(*b) > 0.49 || n.dot(*m) < 0.71);
                }
            }
        }
        for [start, normal] in sphere {
            // Points of a chord of a circle with 64 pieces are 0.0012 inside.
            assert!((start.normalize() - normal).length() < 1e-3);
            assert!((start.length() - 1.0).abs() < 2e-3);
        }
    }
}
