//! The box around the scene, with its sizes.

use super::gather::Gather;
use super::input::OverlayInput;
use super::label::Label;
use super::spec::{Behind, LineSpec, OverlaySpec, OverlayStyle};
use crate::gpu::lines::Line;
use crate::numbers::significant;
use glam::DVec3;
use hitscope_core::{Aabb, Scene};

/// The overlay.
pub static BOUNDING_BOX: OverlaySpec = OverlaySpec {
    name: "box",
    title: "Bounding box",
    about: "The box around the scene, with the lengths of its edges",
    style: OverlayStyle {
        colour: [230, 170, 60],
        opacity: 0.9,
        width_px: 1.2,
    },
    lines: &[LineSpec {
        behind: Behind::Faint,
        is_cut: false,
        ..LineSpec::new(|input, _| {
            let is_empty = input.scene.bounds_with_elements().is_empty();
            (!is_empty).then(|| Gather::new((), |scene, ()| lines(scene)))
        })
    }],
    labels,
    ..OverlaySpec::SWITCH
};

/// The twelve edges of the box around the scene.
pub fn lines(scene: &Scene) -> Vec<Line> {
    edges_of(&scene.bounds_with_elements())
}

/// The twelve edges of a box.
pub(super) fn edges_of(bounds: &Aabb) -> Vec<Line> {
    let of_axis = |axis| edges(bounds, axis);
    let all = (0..3).flat_map(of_axis);
    all.map(|[start, end]| Line::between(start.as_vec3(), end.as_vec3()))
        .collect()
}

/// The four edges along an axis.
fn edges(bounds: &Aabb, axis: usize) -> [[DVec3; 2]; 4] {
    let ends = [bounds.min.as_dvec3(), bounds.max.as_dvec3()];
    [0, 1, 2, 3].map(|k| {
        let mut edge = ends;
        for end in &mut edge {
            end[(axis + 1) % 3] = ends[k & 1][(axis + 1) % 3];
            end[(axis + 2) % 3] = ends[k >> 1][(axis + 2) % 3];
        }
        edge
    })
}

/// The box's size along each axis, at the edge that is farthest from the box's centre in the picture.
fn labels(input: &OverlayInput) -> Vec<Label> {
    let bounds = input.scene.bounds_with_elements();
    let Some(centre) = input.camera.pixel_of(bounds.centre().as_dvec3()) else {
        return Vec::new();
    };
    let of_axis = |axis: usize| {
        let middles = edges(&bounds, axis).map(|[a, b]| 0.5 * a + 0.5 * b);
        let seen = middles.into_iter().filter_map(|middle| {
            let distance = (input.camera.pixel_of(middle)? - centre).length();
            Some((middle, distance))
        });
        let (middle, _) = seen.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Label::at(middle, significant(bounds.extent()[axis], 4)))
    };
    (0..3).filter_map(of_axis).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::overlay::label::Place;
    use crate::overlay::tests::input;
    use glam::Vec3;
    use hitscope_core::TriangleMesh;
    use hitscope_core::scene::scene;
    use std::sync::Arc;

    fn block() -> Scene {
        let corners = vec![
            Vec3::ZERO,
            Vec3::new(1.0, 2.0, 0.0),
            Vec3::new(0.0, 2.0, 3.0),
        ];
        scene(TriangleMesh::new(corners, vec![[0, 1, 2]]))
    }

    #[test]
    fn the_box_has_twelve_different_edges_along_its_axes() {
        let lines = lines(&block());
        assert_eq!(lines.len(), 12);
        for (i, line) in lines.iter().enumerate() {
            assert_eq!((line.end - line.start)[i / 4], [1.0, 2.0, 3.0][i / 4]);
            assert!(
                (line.end - line.start)
                    .cmpeq(Vec3::ZERO)
                    .bitmask()
                    .count_ones()
                    == 2
            );
            assert!(!lines[..i].contains(line));
        }
    }

    #[test]
    fn each_size_is_written_at_an_edge_of_its_axis() {
        let labels = labels(&input(&Arc::new(block())));
        let texts: Vec<&str> = labels.iter().map(|label| label.text.as_str()).collect();
        assert_eq!(texts, ["1.000", "2.000", "3.000"]);
        for (axis, label) in labels.iter().enumerate() {
            let Place::Point(point) = label.place else {
                panic!("at a point");
            };
            assert_eq!(point[axis], [0.5, 1.0, 1.5][axis]);
        }
    }

    #[test]
    fn an_empty_scene_has_no_box() {
        let input = input(&Arc::new(scene(TriangleMesh::default())));
        let state = crate::overlay::tests::state_of(&BOUNDING_BOX);
        assert!((BOUNDING_BOX.lines[0].gather)(&input, &state).is_none());
        assert_eq!(labels(&input), []);
    }
}
