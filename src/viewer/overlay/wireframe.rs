//! The wireframe: edges of meshes and lines of other shapes.

use super::gather::Gather;
use super::input::OverlayInput;
use super::shapes::{self, ShapeLines};
use super::spec::{Fade, LineSpec, OptionKind, OverlayOption, OverlaySpec, OverlayStyle};
use crate::gpu::lines::Line;
use glam::Vec3;
use hitscope_core::{Scene, TriangleMesh};

/// The overlay.
pub static WIREFRAME: OverlaySpec = OverlaySpec {
    name: "wireframe",
    title: "Wireframe",
    about: "Edges of the file's polygons, and lines of other shapes",
    style: OverlayStyle {
        colour: [12, 14, 18],
        opacity: 0.85,
        width_px: 1.0,
    },
    options: &[&DIAGONALS],
    lines: &[
        LineSpec {
            fade: Fade::ShortOrDense,
            ..LineSpec::new(|_, state| {
                let edges = if state.is_set(&DIAGONALS) {
                    WireframeEdges::Triangles
                } else {
                    WireframeEdges::Polygons
                };
                let gather = Gather::new(edges, |scene, edges| lines(scene, *edges));
                Some(gather)
            })
        },
        LineSpec {
            fade: Fade::Dense,
            has_outlines: true,
            ..LineSpec::new(|input, _| of_shapes(input, ShapeLines::Seen(input.lines_camera)))
        },
        LineSpec {
            fade: Fade::Dense,
            ..LineSpec::new(|input, _| of_shapes(input, ShapeLines::Fixed))
        },
    ],
    ..OverlaySpec::SWITCH
};

fn of_shapes(input: &OverlayInput, which: ShapeLines) -> Option<Gather> {
    let has_any = input.scene.has_other_shapes();
    has_any.then(|| Gather::new(which, shapes::lines))
}

/// Whether the diagonals of triangulated polygons are drawn.
pub static DIAGONALS: OverlayOption = OverlayOption {
    name: "diagonals",
    title: "Diagonals",
    kind: OptionKind::Switch,
    default: 0.0,
};

/// The edges that are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WireframeEdges {
    /// Edges of the file's polygons.
    Polygons,
    /// Edges of all triangles, including diagonals.
    Triangles,
}

/// Lines for all edges of triangles that are shown, each once, with the smaller height of its triangles as the gap to the next line.
pub fn lines(scene: &Scene, edges: WireframeEdges) -> Vec<Line> {
    let mesh = scene.mesh();
    let mut uses: Vec<(u64, u32, u8)> = Vec::with_capacity(3 * mesh.triangles().len());
    for (triangle, corners) in (0..).zip(mesh.triangles()) {
        if !scene.is_shown(triangle) {
            continue;
        }
        for k in 0..3u8 {
            if edges == WireframeEdges::Polygons
                && mesh.attributes().faces.outline(triangle) & (1 << k) == 0
            {
                continue;
            }
            let (a, b) = (corners[usize::from(k)], corners[(usize::from(k) + 1) % 3]);
            let key = u64::from(a.min(b)) << 32 | u64::from(a.max(b));
            uses.push((key, triangle, k));
        }
    }
    uses.sort_unstable();
    let same_edge = uses.chunk_by(|a, b| a.0 == b.0);
    let line = |uses: &[(u64, u32, u8)]| {
        let each = uses
            .iter()
            .map(|&(_, triangle, k)| edge(mesh, triangle, k.into()));
        // In f64, in which squares of f32 numbers neither under- nor overflow.
        let length = |line: &Line| line.gap.as_dvec3().length_squared();
        each.min_by(|a, b| length(a).total_cmp(&length(b)))
    };
    same_edge.filter_map(line).collect()
}

/// The outline of one triangle.
pub fn triangle_lines(mesh: &TriangleMesh, triangle: u32) -> [Line; 3] {
    [0, 1, 2].map(|k| edge(mesh, triangle, k))
}

/// Edge k of a triangle, with the triangle's height on it as the gap.
fn edge(mesh: &TriangleMesh, triangle: u32, k: usize) -> Line {
    let corners = mesh.corners(triangle);
    let (start, end, opposite) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
    let [a, b, c] = [start, end, opposite].map(Vec3::as_dvec3);
    let height = (c - a).reject_from(b - a);
    let gap = if height.is_finite() {
        height.as_vec3()
    } else {
        Vec3::ZERO
    };
    Line { start, end, gap }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::mesh::{Attributes, Faces};
    use hitscope_core::progress::Progress;
    use hitscope_core::scene::scene;
    use std::sync::Arc;

    /// A unit square of two triangles that share the diagonal from 0 to 2.
    fn square() -> TriangleMesh {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];
        let mut faces = Faces::default();
        faces.push(0, 0, 0b011);
        faces.push(1, 0, 0b110);
        TriangleMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).with_attributes(Attributes {
            faces,
            ..Attributes::default()
        })
    }

    #[test]
    fn diagonals_are_hidden_and_shared_edges_drawn_once() {
        assert_eq!(lines(&scene(square()), WireframeEdges::Polygons).len(), 4);
        let all = lines(&scene(square()), WireframeEdges::Triangles);
        assert_eq!(all.len(), 5);
        let diagonal = all
            .iter()
            .find(|l| (l.end - l.start).length() > 1.1)
            .expect("drawn");
        assert!((diagonal.gap.length() - 0.5f32.sqrt()).abs() < 1e-6);
    }

    #[test]
    fn the_gap_is_the_triangles_height() {
        let gaps = triangle_lines(&square(), 0).map(|line| line.gap);
        assert_eq!(gaps[0], Vec3::Y);
        assert_eq!(gaps[1], Vec3::NEG_X);
    }

    #[test]
    fn hidden_triangles_have_no_edges_of_their_own() {
        let flags = Arc::new(vec![true, false]);
        let part = scene(square()).showing(Some(flags), &Progress::default());
        let part = part.expect("nobody cancels");
        assert_eq!(lines(&part, WireframeEdges::Polygons).len(), 2);
        assert_eq!(lines(&part, WireframeEdges::Triangles).len(), 3);
    }
}
