//! Lines of shapes that aren't triangles.

use crate::gpu::lines::Line;
use glam::DVec3;
use hitscope_core::group::Group;
use hitscope_core::shape::{LineDetail, LinePoint, LineView};
use hitscope_core::{Camera, Scene};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The number of shapes per group with lines; others have only outlines.
const MAX_SHAPES: usize = 20_000;
/// The number of solids per group whose lines follow the camera. Others take too long: each point of their lines is compared
/// with all operands.
const MAX_SOLIDS: usize = 20;
/// Approximate number of line segments per group.
const SEGMENTS: usize = 2_000_000;
/// Lines per shape, about.
const LINES_PER_SHAPE: usize = 16;
/// Permitted distances between a line and its curve, in pixels. The first that needs at most [`SEGMENTS`] segments is used.
/// The depth that hides lines allows for the first.
const TOLERANCES_PX: [f64; 3] = [0.1, 1.6, 25.6];

/// Which lines of constant surface coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShapeLines {
    /// Those that are divided for a camera, so that they look like curves however near it is.
    Seen(Camera),
    /// Those of large groups of solids, which are the same for all cameras.
    Fixed,
}

/// Lines of constant surface coordinates.
pub fn lines(scene: &Scene, which: &ShapeLines) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    each_group(scene, &mut |group, first| {
        let count = group.count().min(MAX_SHAPES);
        let is_fixed = group.solid(0).is_some() && count > MAX_SOLIDS;
        let indices: Vec<u32> = (0..count as u32)
            .filter(|index| scene.is_shown(first + index))
            .collect();
        match which {
            ShapeLines::Seen(camera) if !is_fixed => {
                lines.extend(
                    lines_seen(scene, group, &indices, camera)
                        .into_iter()
                        .flatten(),
                );
            }
            ShapeLines::Fixed if is_fixed => {
                let detail = detail(scene, count, None);
                lines.extend(
                    lines_within(group, &indices, &detail, usize::MAX)
                        .into_iter()
                        .flatten(),
                );
            }
            _ => {}
        }
    });
    lines
}

/// The lines of one primitive, divided for a camera.
pub fn lines_of(scene: &Scene, primitive: u32, camera: &Camera) -> Vec<Line> {
    let (group, index) = scene.group_of(primitive);
    lines_seen(scene, group, &[index], camera).unwrap_or_default()
}

/// Passes each group with the number of its first primitive.
pub(super) fn each_group(scene: &Scene, visit: &mut dyn FnMut(&dyn Group, u32)) {
    let mut first = scene.mesh().triangles().len();
    for group in scene.other_groups() {
        visit(&**group, first as u32);
        first += group.count();
    }
}

fn lines_seen(
    scene: &Scene,
    group: &dyn Group,
    indices: &[u32],
    camera: &Camera,
) -> Option<Vec<Line>> {
    let within = |tolerance_px: f64, limit: usize| {
        let view = LineView {
            camera: *camera,
            tolerance_px,
        };
        let detail = detail(scene, indices.len(), Some(view));
        lines_within(group, indices, &detail, limit)
    };
    let mut tolerances = TOLERANCES_PX.into_iter();
    let found = tolerances.find_map(|tolerance| within(tolerance, SEGMENTS));
    found.or_else(|| within(f64::INFINITY, usize::MAX))
}

/// The lines of some primitives of a group; `None` if there are more than the limit.
fn lines_within(
    group: &dyn Group,
    indices: &[u32],
    detail: &LineDetail,
    limit: usize,
) -> Option<Vec<Line>> {
    let count = AtomicUsize::new(0);
    let lines = indices.par_iter().map(|&index| {
        let mut curves: Vec<Vec<LinePoint>> = Vec::new();
        group.lines(index, detail, &mut |points| curves.push(points.to_vec()));
        // Roughly eight lines cross a shape.
        let gap = extent(&curves) / 8.0;
        let pieces = curves.iter().flat_map(|points| points.windows(2));
        let lines: Vec<Line> = pieces.map(|pair| piece(pair, gap)).collect();
        let before = count.fetch_add(lines.len(), Ordering::Relaxed);
        (before + lines.len() <= limit).then_some(lines)
    });
    let lines: Option<Vec<Vec<Line>>> = lines.collect();
    Some(lines?.concat())
}

pub(super) fn detail(scene: &Scene, count: usize, view: Option<LineView>) -> LineDetail {
    let segments = SEGMENTS / (LINES_PER_SHAPE * count.max(1));
    LineDetail {
        segments: segments.clamp(8, 64) as u32,
        around: scene.bounds(),
        view,
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
pub(super) fn extent(lines: &[Vec<LinePoint>]) -> f64 {
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let points = lines.iter().flatten();
    let (min, max) = points.fold(none, |(min, max), point| {
        (min.min(point.position), max.max(point.position))
    });
    (max - min).max_element().max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{UVec2, Vec3};
    use hitscope_core::TriangleMesh;
    use hitscope_core::camera::Projection;
    use hitscope_core::mesh::Runs;
    use hitscope_core::progress::Progress;
    use hitscope_core::scene::{SceneOptions, scene};
    use hitscope_core::shape::Sphere;

    #[test]
    fn lines_of_a_sphere_are_on_it_and_have_more_pieces_where_a_camera_is_near() {
        let mut scene = scene(TriangleMesh::default());
        let sphere = Sphere {
            centre: Vec3::X,
            radius: 2.0,
        };
        let options = SceneOptions::default();
        let added = scene.add_group(vec![sphere], Runs::default(), options, &Progress::default());
        added.expect("nobody cancels");
        let camera = |distance: f64| {
            let eye = DVec3::new(3.0 + distance, 0.0, 0.0);
            let (projection, size) = (
                Projection::Perspective { fov_y_radians: 0.7 },
                UVec2::new(800, 600),
            );
            Camera::look_at(eye, DVec3::X, DVec3::Z, projection, size).expect("a camera")
        };
        for distance in [50.0, 0.5, 0.005] {
            let camera = camera(distance);
            let lines = lines(&scene, &ShapeLines::Seen(camera));
            assert!(lines.len() > 500 && lines.len() < 10_000);
            assert_eq!(lines.len(), lines_of(&scene, 0, &camera).len());
            let near = lines
                .iter()
                .filter(|line| (line.start - 3.0 * Vec3::X).length() < 0.01);
            assert_eq!(near.count() > 8, distance < 0.01, "{distance}");
            for line in &lines {
                assert!(((line.start - Vec3::X).length() - 2.0).abs() < 1e-5);
            }
        }
        assert!(lines(&scene, &ShapeLines::Fixed).is_empty());
    }
}
