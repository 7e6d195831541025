//! Lines and normals of shapes that aren't triangles.

use crate::gpu::lines::Line;
use glam::DVec3;
use hitscope_core::Scene;
use hitscope_core::shape::{LineDetail, LinePoint};

/// The number of shapes per group with lines; others have only outlines.
const MAX_SHAPES: usize = 20_000;
/// Approximate number of line segments per group.
const SEGMENTS: usize = 2_000_000;
/// Lines per shape, about.
const LINES_PER_SHAPE: usize = 16;

/// Lines of constant surface coordinates.
pub fn lines(scene: &Scene) -> Vec<Line> {
    let mut lines = Vec::new();
    each_line(scene, &mut |points, gap| {
        let pieces = points.windows(2).map(|pair| piece(pair, gap));
        lines.extend(pieces);
    });
    lines
}

/// The lines of one primitive.
pub fn lines_of(scene: &Scene, primitive: u32) -> Vec<Line> {
    let (group, index) = scene.group_of(primitive);
    let mut lines = Vec::new();
    group.lines(index, &detail(scene, 1), &mut |points: &[LinePoint]| {
        lines.extend(points.windows(2).map(|pair| piece(pair, 0.0)));
    });
    lines
}

/// Normals at points of the same lines. Their length is the scene's radius; the style shortens them.
pub fn normals(scene: &Scene) -> Vec<Line> {
    /// One normal for this many points of a line.
    const EVERY: usize = 4;
    let length = scene.bounds().radius();
    let mut lines = Vec::new();
    each_line(scene, &mut |points, gap| {
        lines.extend(points.iter().step_by(EVERY).map(|point| {
            let end = point.position + length * point.normal;
            let (side, _) = point.normal.any_orthonormal_pair();
            Line {
                start: point.position.as_vec3(),
                end: end.as_vec3(),
                gap: (gap * side).as_vec3(),
            }
        }));
    });
    lines
}

/// Passes the lines of all primitives that are shown, each with the expected distance to the next line.
fn each_line(scene: &Scene, line: &mut dyn FnMut(&[LinePoint], f64)) {
    let mut first = scene.mesh().triangles().len();
    for group in scene.other_groups() {
        let is_shown = |index: &u32| scene.is_shown(first as u32 + index);
        let count = group.count().min(MAX_SHAPES);
        let detail = detail(scene, count);
        for index in (0..count as u32).filter(is_shown) {
            let mut lines: Vec<Vec<LinePoint>> = Vec::new();
            group.lines(index, &detail, &mut |points| lines.push(points.to_vec()));
            // Roughly eight lines cross a shape.
            let gap = extent(&lines) / 8.0;
            lines.iter().for_each(|points| line(points, gap));
        }
        first += group.count();
    }
}

fn detail(scene: &Scene, count: usize) -> LineDetail {
    let segments = SEGMENTS / (LINES_PER_SHAPE * count.max(1));
    LineDetail {
        segments: segments.clamp(8, 64) as u32,
        around: scene.bounds(),
    }
}

fn piece(points: &[LinePoint], gap: f64) -> Line {
    let [start, end] = [points[0], points[1]];
    let along = end.position - start.position;
    let side = along.cross(start.normal).normalize_or_zero();
    Line {
        start: start.position.as_vec3(),
        end: end.position.as_vec3(),
        gap: (gap * side).as_vec3(),
    }
}

/// The longest edge of the box around lines.
fn extent(lines: &[Vec<LinePoint>]) -> f64 {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let points = lines.iter().flatten();
    let (min, max) = points.fold(none, |(min, max), point| {
        (min.min(point.position), max.max(point.position))
    });
    (max - min).max_element()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use hitscope_core::TriangleMesh;
    use hitscope_core::mesh::Runs;
    use hitscope_core::progress::Progress;
    use hitscope_core::scene::{SceneOptions, scene};
    use hitscope_core::shape::Sphere;

    #[test]
    fn lines_and_normals_of_a_sphere_start_on_it() {
        let mut scene = scene(TriangleMesh::default());
        let sphere = Sphere {
            centre: Vec3::X,
            radius: 2.0,
        };
        let options = SceneOptions::default();
        let added = scene.add_group(vec![sphere], Runs::default(), options, &Progress::default());
        added.expect("nobody cancels");
        let (lines, normals) = (lines(&scene), normals(&scene));
        assert!(lines.len() > 500 && lines.len() == lines_of(&scene, 0).len());
        for line in lines.iter().chain(&normals) {
            assert!(((line.start - Vec3::X).length() - 2.0).abs() < 1e-5);
        }
        for normal in &normals {
            let along = (normal.end - normal.start).normalize();
            assert!((along - (normal.start - Vec3::X) / 2.0).length() < 1e-5);
        }
    }
}
