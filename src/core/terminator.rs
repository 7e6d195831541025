//! Repairs of the shadow terminator: the edge of light on coarse triangles with vertex normals.
//!
//! Vertex normals pretend a curved surface, but shadows are those of the flat triangles: where they turn away from the
//! light, they get dark at once. The repairs hide this, and none of them is exact: the picture is that of neither surface.
//! [`TERMINATOR_REPAIRS`] is the table of repairs. They change nothing where the shading normal is the geometric one.

use glam::Vec3;

/// A repair.
pub struct TerminatorRepair {
    /// The name, as in `--terminator`.
    pub name: &'static str,
    /// The title in menus.
    pub title: &'static str,
    /// Author, title, year.
    pub source: &'static str,
    /// What it does, in a sentence or two.
    pub summary: &'static str,
    /// The part that is left of light from a direction, by the geometric normal, the shading normal and the direction, all
    /// of unit length. Either side of the surface may be lit.
    pub(crate) part: Option<fn(Vec3, Vec3, Vec3) -> f32>,
    /// The offset of rays that leave a triangle.
    pub(crate) offset: Option<Offset>,
}

/// The offset of rays that leave a triangle on the side of its normals, by the point's barycentric coordinates, the
/// triangle's corners and their unit normals.
pub(crate) type Offset = fn([f32; 3], [Vec3; 3], [Vec3; 3]) -> Vec3;

/// All repairs; the first one, which is the default, is none.
pub static TERMINATOR_REPAIRS: &[TerminatorRepair] = &[
    TerminatorRepair {
        name: "none",
        title: "None",
        source: "",
        summary: "Shadows are those of the flat triangles.",
        part: None,
        offset: None,
    },
    TerminatorRepair {
        name: "chiang",
        title: "Darker towards the edge",
        source: "Chiang, Li, Burley, Taming the Shadow Terminator, SIGGRAPH 2019 Talks",
        summary: "Not exact: light fades smoothly before its edge, so that surfaces get darker there.",
        part: Some(remaining_part),
        offset: None,
    },
    TerminatorRepair {
        name: "hanika",
        title: "Moved shadow rays",
        source: "Hanika, Hacking the Shadow Terminator, Ray Tracing Gems II, 2021",
        summary: "Not exact: shadow rays start on a curved surface above the triangle, so that shadows move, and small gaps let light pass.",
        part: None,
        offset: Some(offset_to_patch),
    },
];

/// The repair of this name.
pub fn terminator_repair(name: &str) -> Option<&'static TerminatorRepair> {
    TERMINATOR_REPAIRS.iter().find(|repair| repair.name == name)
}

/// None.
pub fn default_terminator_repair() -> &'static TerminatorRepair {
    &TERMINATOR_REPAIRS[0]
}

/// −g³ + g² + g, for the ratio g of the cosines to the light, over the cosine between the normals; at most 1.
fn remaining_part(geometric_normal: Vec3, shading_normal: Vec3, dir: Vec3) -> f32 {
    let (by_geometry, by_shading) = (geometric_normal.dot(dir), shading_normal.dot(dir));
    // Either side may be lit; a NaN leaves nothing.
    let g = by_geometry / (by_shading * geometric_normal.dot(shading_normal));
    if g > 0.0 {
        let g = g.min(1.0);
        (g * (1.0 + g * (1.0 - g))).min(1.0)
    } else {
        0.0
    }
}

/// To the mean of the point's projections to the planes through the corners, normal to their normals, if it lies below
/// them.
///
/// If it lies below all, that is a point of the quadratic patch of Boubekeur, Alexa, "Phong Tessellation", SIGGRAPH Asia
/// 2008.
fn offset_to_patch(weights: [f32; 3], corners: [Vec3; 3], normals: [Vec3; 3]) -> Vec3 {
    let [a, b, c] = corners;
    // Relative to a corner, so that the offset of a small triangle far from the origin isn't lost in rounding.
    let point = weights[1] * (b - a) + weights[2] * (c - a);
    let corners = [Vec3::ZERO, b - a, c - a];
    let lift = |k: usize| {
        let height = (point - corners[k]).dot(normals[k]);
        -weights[k] * height.min(0.0) * normals[k]
    };
    lift(0) + lift(1) + lift(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_fades_without_a_step_from_all_where_both_normals_agree_to_none_at_the_edge() {
        let geometric = Vec3::Z;
        let shading = Vec3::new(0.28, 0.0, 0.96);
        let at = |degrees: f32| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            // Towards the side where the shading normal sees more.
            remaining_part(geometric, shading, Vec3::new(sin, 0.0, cos))
        };
        assert_eq!(remaining_part(geometric, geometric, shading), 1.0);
        // Along the shading normal, at 16.26°, the ratio is 1, where the slope by it is 0; where the geometric normal sees
        // more, it is above 1.
        assert!((at(16.26) - 1.0).abs() < 1e-5);
        assert_eq!(at(-30.0), 1.0);
        // Behind the geometric normal is none.
        assert_eq!((at(91.0), at(100.0)), (0.0, 0.0));
        let mut last = 1.0;
        for k in 0..=900 {
            let part = at(0.1 * k as f32);
            // In front of the edge the cosine, and so g, grows by 0.0017 a step, over 0.28·0.96; the slope by g is at most
            // 4/3.
            assert!(
                (last - part).abs() < 0.01 && (0.0..=1.0).contains(&part),
                "{k}: {part}"
            );
            last = part;
        }
        assert!(last < 0.01);
        // The back is lit as the front is.
        let dir = Vec3::new(0.6, 0.0, 0.8);
        assert_eq!(
            remaining_part(geometric, shading, dir),
            remaining_part(geometric, shading, -dir)
        );
    }

    /// The quadratic patch: its corners' squared weights, and what each pair of corners projects to each other's planes.
    fn patch(weights: [f32; 3], corners: [Vec3; 3], normals: [Vec3; 3]) -> Vec3 {
        let projected = |from: usize, to: usize| {
            let way = corners[from] - corners[to];
            corners[from] - way.dot(normals[to]) * normals[to]
        };
        let mut sum = Vec3::ZERO;
        for i in 0..3 {
            sum += weights[i] * weights[i] * corners[i];
            for j in 0..i {
                let pair = projected(i, j) + projected(j, i);
                sum += weights[i] * weights[j] * pair;
            }
        }
        sum
    }

    #[test]
    fn points_below_the_planes_of_the_corners_move_to_the_quadratic_patch() {
        // Three points of the unit sphere, whose normals are their positions.
        let corners = [
            Vec3::new(0.6, 0.0, 0.8),
            Vec3::new(-0.28, 0.0, 0.96),
            Vec3::new(0.0, 0.6, 0.8),
        ];
        for weights in [
            [0.2, 0.3, 0.5],
            [0.5, 0.5, 0.0],
            [0.1, 0.1, 0.8],
            [1.0, 0.0, 0.0],
        ] {
            let point: Vec3 = (0..3).map(|k| weights[k] * corners[k]).sum();
            let moved = point + offset_to_patch(weights, corners, corners);
            let expected = patch(weights, corners, corners);
            // A few roundings of numbers of size 1.
            assert!(
                (moved - expected).length() < 1e-6,
                "{weights:?}: {moved} {expected}"
            );
        }
    }

    #[test]
    fn points_of_flat_and_hollow_triangles_stay_where_they_are() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let weights = [0.25, 0.25, 0.5];
        assert_eq!(offset_to_patch(weights, corners, [Vec3::Z; 3]), Vec3::ZERO);
        let centre = Vec3::new(0.3, 0.3, 1.0);
        let inwards = corners.map(|corner| (centre - corner).normalize());
        assert_eq!(offset_to_patch(weights, corners, inwards), Vec3::ZERO);
    }
}
