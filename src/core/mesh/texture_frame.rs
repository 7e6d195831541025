//! Texture coordinates of points of surfaces.

use super::TriangleMesh;
use crate::ray::Hit;
use glam::{DVec3, Vec2, Vec3};

/// The texture coordinates of a point, and how the point moves with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureFrame {
    /// The texture coordinates.
    pub uv: Vec2,
    /// The derivatives of the point by the two coordinates.
    pub axes: [DVec3; 2],
}

impl TriangleMesh {
    /// The texture coordinates at a hit; `None` if a corner has none.
    pub fn texture_coordinates_at(&self, hit: &Hit) -> Option<Vec2> {
        let [a, b, c] = self.corner_coordinates(hit.primitive)?;
        let [l1, l2, l3] = hit.barycentric();
        Some(l1 * a + l2 * b + l3 * c)
    }

    fn corner_coordinates(&self, triangle: u32) -> Option<[Vec2; 3]> {
        let coordinates = &self.attributes().texture_coordinates;
        let [a, b, c] = coordinates.of_triangle(triangle);
        Some([a?, b?, c?])
    }

    /// The texture coordinates at a hit, and how the point moves with them; `None` if a corner has none, or if those of
    /// the corners lie on a line.
    pub fn texture_frame(&self, hit: &Hit) -> Option<TextureFrame> {
        let uv = self.texture_coordinates_at(hit)?;
        let [a, b, c] = self.corner_coordinates(hit.primitive)?.map(Vec2::as_dvec2);
        let [pa, pb, pc] = self.corners(hit.primitive).map(Vec3::as_dvec3);
        // p = pa + (∂p/∂u, ∂p/∂v)·(uv − a) at both other corners.
        let ([ab, ac], [e1, e2]) = ([b - a, c - a], [pb - pa, pc - pa]);
        let det = ab.perp_dot(ac);
        let axes = [(ac.y * e1 - ab.y * e2) / det, (ab.x * e2 - ac.x * e1) / det];
        let is_finite = axes.iter().all(|axis| axis.is_finite());
        is_finite.then_some(TextureFrame { uv, axes })
    }
}

#[cfg(test)]
mod tests {
    use crate::mesh::{Attributes, CornerValues, shapes::soup};
    use crate::ray::Hit;
    use glam::{DMat3, DVec3, Vec2, Vec3};

    #[test]
    fn axes_lead_from_a_point_to_points_with_other_coordinates() {
        let turn = DMat3::from_rotation_y(0.8) * DMat3::from_rotation_x(0.3);
        let corners = [
            DVec3::ZERO,
            DVec3::new(2.0, 1.0, 0.0),
            DVec3::new(-1.0, 3.0, 0.0),
        ];
        let corners = corners.map(|p| (turn * p).as_vec3());
        let hit = Hit {
            t: 1.0,
            u: 0.25,
            v: 0.5,
            primitive: 0,
        };
        for side in [1.0, -1.0] {
            // Coordinates (2x + 1, ±(x + 4y)), so that ∂p/∂u = (1/2, −1/8) and ∂p/∂v = (0, ±1/4).
            let at = |x: f32, y: f32| Vec2::new(2.0 * x + 1.0, side * (x + 4.0 * y));
            let coordinates = vec![at(0.0, 0.0), at(2.0, 1.0), at(-1.0, 3.0)];
            let mesh = soup(&[corners]).with_attributes(Attributes {
                texture_coordinates: CornerValues::new(coordinates, [[0, 1, 2]]),
                ..Attributes::default()
            });
            let frame = mesh.texture_frame(&hit).expect("a frame");
            // The point (0, 1.75).
            assert!((frame.uv - at(0.0, 1.75)).length() < 1e-5, "{}", frame.uv);
            let expected = [
                DVec3::new(0.5, -0.125, 0.0),
                DVec3::new(0.0, f64::from(side) * 0.25, 0.0),
            ];
            for (axis, expected) in frame.axes.into_iter().zip(expected) {
                // Corners are rounded to f32.
                assert!((axis - turn * expected).length() < 1e-6, "{axis}");
            }
        }
    }

    #[test]
    fn coordinates_on_a_line_have_no_axes() {
        let line = vec![Vec2::ZERO, Vec2::ONE, Vec2::splat(2.0)];
        let mesh = soup(&[[Vec3::ZERO, Vec3::X, Vec3::Y]]).with_attributes(Attributes {
            texture_coordinates: CornerValues::new(line, [[0, 1, 2]]),
            ..Attributes::default()
        });
        let hit = Hit {
            t: 1.0,
            u: 0.25,
            v: 0.25,
            primitive: 0,
        };
        assert_eq!(mesh.texture_frame(&hit), None);
        assert_eq!(mesh.texture_coordinates_at(&hit), Some(Vec2::splat(0.75)));
    }
}
