//! The path of the picked pixel: its segments, and its rays to lights.

use super::gather::{Gather, Same};
use super::input::OverlayInput;
use super::spec::{Behind, LineSpec, OverlaySpec};
use crate::gpu::lines::Line;
use glam::Vec3;
use hitscope_core::Scene;
use hitscope_core::integrator::PathRecord;
use std::sync::Arc;

/// The overlay.
pub static PATH: OverlaySpec = OverlaySpec {
    name: "path",
    title: "Path",
    about: "The path of a sample of the picked pixel",
    lines: &[
        LineSpec {
            colour: Some([115, 230, 128]),
            width: 1.4,
            behind: Behind::Clear,
            is_cut: false,
            ..LineSpec::new(|input, _| gather(input, PathLines::Visible))
        },
        LineSpec {
            colour: Some([242, 77, 77]),
            width: 1.4,
            behind: Behind::Clear,
            is_cut: false,
            ..LineSpec::new(|input, _| gather(input, PathLines::Blocked))
        },
        LineSpec {
            colour: Some([255, 217, 51]),
            width: 2.4,
            behind: Behind::Clear,
            is_cut: false,
            ..LineSpec::new(|input, _| gather(input, PathLines::Segments))
        },
    ],
    ..OverlaySpec::MARK
};

fn gather(input: &OverlayInput, kind: PathLines) -> Option<Gather> {
    let path = Same(Arc::clone(input.marks.path.as_ref()?));
    let gather = Gather::new((path, kind), |scene, (path, kind)| {
        lines(scene, &path.0, *kind)
    });
    Some(gather)
}

/// The lines of a path by kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathLines {
    /// From the camera from surface to surface.
    Segments,
    /// To lights of which some light arrives.
    Visible,
    /// To lights that surfaces hide; dashed.
    Blocked,
}

/// Dashes of a blocked ray.
const DASHES: usize = 16;

/// The lines of a kind. Rays that end nowhere are as long as the scene's diameter.
pub fn lines(scene: &Scene, path: &PathRecord, kind: PathLines) -> Vec<Line> {
    let radius = scene.bounds_with_elements().radius() as f32;
    // Planes alone have no bounds.
    let reach = if radius > 0.0 { 2.0 * radius } else { 1.0 };
    match kind {
        PathLines::Segments => segments(path, reach),
        PathLines::Visible => shadow_rays(path, reach, |arriving| arriving > 0.0),
        PathLines::Blocked => {
            let rays = shadow_rays(path, reach, |arriving| arriving == 0.0);
            rays.into_iter().flat_map(dashes).collect()
        }
    }
}

fn segments(path: &PathRecord, reach: f32) -> Vec<Line> {
    let mut points = vec![path.origin];
    points.extend(path.vertices.iter().map(|vertex| vertex.position));
    let last = points[points.len() - 1];
    // A path that ends on a surface has no throughput behind it.
    let is_over = path.vertices.last().map(|vertex| vertex.throughput);
    if is_over != Some(Vec3::ZERO) {
        points.push(last + reach * path.last_dir);
    }
    points
        .windows(2)
        .map(|ends| Line::between(ends[0], ends[1]))
        .collect()
}

fn shadow_rays(path: &PathRecord, reach: f32, is_shown: impl Fn(f32) -> bool) -> Vec<Line> {
    let rays = path.vertices.iter().filter_map(|vertex| {
        let ray = vertex.shadow_ray.filter(|ray| is_shown(ray.arriving))?;
        let afar = vertex.position + reach * ray.dir;
        Some(Line::between(vertex.position, ray.target.unwrap_or(afar)))
    });
    rays.collect()
}

/// A line as dashes, with gaps of the same length between them.
fn dashes(line: Line) -> impl Iterator<Item = Line> {
    let parts = (2 * DASHES - 1) as f32;
    (0..DASHES).map(move |k| {
        let at = |part: usize| line.start.lerp(line.end, part as f32 / parts);
        Line::between(at(2 * k), at(2 * k + 1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::lines::LineOcclusion;
    use crate::overlay::{OVERLAYS, Overlays};
    use hitscope_core::integrator::{PathEnd, PathVertex, ShadowRay};
    use hitscope_core::mesh::shapes::{Placement, torus};
    use hitscope_core::scene::scene;

    fn vertex(position: Vec3, throughput: Vec3, arriving: f32, target: Option<Vec3>) -> PathVertex {
        PathVertex {
            position,
            primitive: 0,
            t: 1.0,
            is_passed: false,
            emission: Vec3::ZERO,
            direct: Vec3::ZERO,
            shadow_ray: Some(ShadowRay {
                dir: Vec3::Z,
                target,
                arriving,
            }),
            throughput,
            survival: None,
        }
    }

    #[test]
    fn lines_inside_and_behind_surfaces_are_clear_and_above_those_of_the_picked_primitive() {
        let overlays = Overlays::default();
        let state = overlays.state(&PATH);
        for spec in PATH.lines {
            let looks = spec.looks(state, 1.0);
            let behind = looks
                .iter()
                .find(|(kind, _)| kind.occlusion == LineOcclusion::Through);
            let (_, style) = behind.expect("drawn through surfaces");
            assert!(style.colour[3] >= 0.5, "{:?}", style.colour);
        }
        let place = |name| OVERLAYS.iter().position(|overlay| overlay.name == name);
        assert!(place("path") > place("picked"));
    }

    #[test]
    fn segments_join_the_vertices_and_rays_lead_to_lights() {
        let scene = scene(torus(24, 12, Placement::UNIT));
        let reach = 2.0 * scene.bounds_with_elements().radius() as f32;
        let mut path = PathRecord {
            origin: Vec3::X,
            vertices: vec![
                vertex(Vec3::Y, Vec3::ONE, 1.0, Some(Vec3::ONE)),
                vertex(Vec3::ZERO, Vec3::ONE, 0.0, None),
            ],
            last_dir: Vec3::NEG_Y,
            from_afar: Vec3::ZERO,
            end: PathEnd::Left,
            radiance: Vec3::ZERO,
        };
        let ends = |path: &PathRecord, kind| -> Vec<[Vec3; 2]> {
            let lines = lines(&scene, path, kind);
            lines.iter().map(|line| [line.start, line.end]).collect()
        };
        let mut segments = vec![
            [Vec3::X, Vec3::Y],
            [Vec3::Y, Vec3::ZERO],
            [Vec3::ZERO, reach * Vec3::NEG_Y],
        ];
        assert_eq!(ends(&path, PathLines::Segments), segments);
        assert_eq!(ends(&path, PathLines::Visible), [[Vec3::Y, Vec3::ONE]]);
        let blocked = ends(&path, PathLines::Blocked);
        assert_eq!(blocked.len(), DASHES);
        assert_eq!(blocked[0][0], Vec3::ZERO);
        assert_eq!(blocked[DASHES - 1][1], reach * Vec3::Z);
        // The path ends on the last surface.
        path.vertices[1].throughput = Vec3::ZERO;
        segments.pop();
        assert_eq!(ends(&path, PathLines::Segments), segments);
    }
}
