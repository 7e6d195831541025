//! Texture coordinates of shapes that aren't triangles: those of the unit shapes that scene files transform.
//!
//! | unit shape | u | v |
//! |---|---|---|
//! | rectangle, −1…1 | (x + 1)/2 | (y + 1)/2 |
//! | disk | distance from the centre | angle about z, in turns |
//! | sphere | angle about z, in turns | angle from z, in half turns |
//! | cylinder, z from 0 to 1 | angle about z, in turns | z |
//! | cube, −1…1 | two of (1 ± x)/2, (1 ± y)/2, (1 ± z)/2 | |
//!
//! They are Mitsuba's, as measured with version 3.9.1. Its second coordinate points down in pictures, and that of meshes
//! here points up, so that 1 − v is returned.

use crate::mesh::TextureFrame;
use glam::{DMat4, DVec2, DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// A shape whose texture coordinates are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitShape {
    /// The square from −1 to 1 in the plane z = 0.
    Rectangle,
    /// The unit disk in the plane z = 0.
    Disk,
    /// The unit sphere.
    Sphere,
    /// The unit cylinder about the z axis from z = 0 to 1.
    Cylinder,
    /// The cube from −1 to 1.
    Cube,
}

/// A unit shape and its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    shape: UnitShape,
    /// From the unit shape's coordinates.
    to_scene: DMat4,
    from_scene: DMat4,
}

impl Placement {
    /// The unit shape transformed by an invertible affine map.
    pub fn new(shape: UnitShape, to_scene: DMat4) -> Self {
        Self {
            shape,
            to_scene,
            from_scene: to_scene.inverse(),
        }
    }

    /// The placement in coordinates about an origin.
    #[must_use]
    pub fn about(&self, origin: DVec3) -> Self {
        Self::new(self.shape, DMat4::from_translation(-origin) * self.to_scene)
    }

    /// The texture coordinates of a point of the surface.
    pub fn frame(&self, position: Vec3) -> TextureFrame {
        let p = self.from_scene.transform_point3(position.as_dvec3());
        let (uv, [du, dv]) = self.shape.coordinates(p);
        let in_scene = |axis: DVec3| self.to_scene.transform_vector3(axis);
        TextureFrame {
            uv: DVec2::new(uv.x, 1.0 - uv.y).as_vec2(),
            axes: [in_scene(du), -in_scene(dv)],
        }
    }
}

impl UnitShape {
    /// Mitsuba's coordinates of a point, and the derivatives of the point by them.
    fn coordinates(self, p: DVec3) -> (DVec2, [DVec3; 2]) {
        let DVec3 { x, y, z } = p;
        let turn = (libm::atan2(y, x) / TAU).rem_euclid(1.0);
        let around = TAU * DVec3::new(-y, x, 0.0);
        let outwards = DVec3::new(x, y, 0.0).normalize_or(DVec3::X);
        match self {
            Self::Rectangle => (
                0.5 * (DVec2::new(x, y) + 1.0),
                [2.0 * DVec3::X, 2.0 * DVec3::Y],
            ),
            Self::Disk => (DVec2::new(x.hypot(y), turn), [outwards, around]),
            Self::Sphere => {
                let across = x.hypot(y);
                let polar = libm::atan2(across, z) / PI;
                let down = PI * (z * outwards - across * DVec3::Z);
                (DVec2::new(turn, polar), [around, down])
            }
            Self::Cylinder => (DVec2::new(turn, z), [around, DVec3::Z]),
            Self::Cube => {
                let [u, v] = face(p);
                let coordinate = |axis: DVec3| 0.5 * (axis.dot(p) + 1.0);
                (DVec2::new(coordinate(u), coordinate(v)), [2.0 * u, 2.0 * v])
            }
        }
    }
}

/// The directions of both coordinates on the face of a cube that a point is on.
fn face(p: DVec3) -> [DVec3; 2] {
    let DVec3 { x, y, z } = p.abs();
    if x >= y && x >= z {
        [DVec3::Y, -p.x.signum() * DVec3::Z]
    } else if y >= z {
        if p.y > 0.0 {
            [-DVec3::X, -DVec3::Z]
        } else {
            [DVec3::Z, DVec3::X]
        }
    } else {
        [p.z.signum() * DVec3::Y, DVec3::X]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_those_of_mitsuba() {
        // Points of the unit shapes, and u, v, ∂p/∂u and ∂p/∂v there in Mitsuba 3.9.1, to four digits.
        let root = |x: f64, y: f64| (1.0 - x * x - y * y).sqrt();
        let known = [
            (
                UnitShape::Rectangle,
                [0.5, 0.25, 0.0],
                [0.75, 0.625],
                [2.0, 0.0, 0.0],
                [0.0, 2.0, 0.0],
            ),
            (
                UnitShape::Disk,
                [-0.3, -0.6, 0.0],
                [0.6708, 0.6762],
                [-0.4472, -0.8944, 0.0],
                [3.7699, -1.885, 0.0],
            ),
            (
                UnitShape::Sphere,
                [root(0.3, 0.2), 0.3, 0.2],
                [0.0495, 0.4359],
                [-1.885, 5.8606, 0.0],
                [0.5981, 0.1924, -3.0781],
            ),
            (
                UnitShape::Sphere,
                [0.3, -root(0.3, 0.2), 0.2],
                [0.7995, 0.4359],
                [5.8606, 1.885, 0.0],
                [0.1924, -0.5981, -3.0781],
            ),
            (
                UnitShape::Cylinder,
                [-root(0.3, 0.0), 0.3, 0.2],
                [0.4515, 0.2],
                [-1.885, -5.9938, 0.0],
                [0.0, 0.0, 1.0],
            ),
            (
                UnitShape::Cube,
                [0.5, 0.25, 1.0],
                [0.625, 0.75],
                [0.0, 2.0, 0.0],
                [2.0, 0.0, 0.0],
            ),
            (
                UnitShape::Cube,
                [0.5, 0.25, -1.0],
                [0.375, 0.75],
                [0.0, -2.0, 0.0],
                [2.0, 0.0, 0.0],
            ),
            (
                UnitShape::Cube,
                [1.0, 0.5, 0.25],
                [0.75, 0.375],
                [0.0, 2.0, 0.0],
                [0.0, 0.0, -2.0],
            ),
            (
                UnitShape::Cube,
                [-1.0, 0.5, 0.25],
                [0.75, 0.625],
                [0.0, 2.0, 0.0],
                [0.0, 0.0, 2.0],
            ),
            (
                UnitShape::Cube,
                [0.25, 1.0, 0.5],
                [0.375, 0.25],
                [-2.0, 0.0, 0.0],
                [0.0, 0.0, -2.0],
            ),
            (
                UnitShape::Cube,
                [0.25, -1.0, 0.5],
                [0.75, 0.625],
                [0.0, 0.0, 2.0],
                [2.0, 0.0, 0.0],
            ),
        ];
        for (shape, p, uv, du, dv) in known {
            let (found, axes) = shape.coordinates(DVec3::from(p));
            assert!(
                (found - DVec2::from(uv)).length() < 1e-4,
                "{shape:?} {p:?}: {found}"
            );
            for (axis, known) in axes.into_iter().zip([du, dv]) {
                assert!(
                    (axis - DVec3::from(known)).length() < 2e-4,
                    "{shape:?} {p:?}: {axis}"
                );
            }
        }
    }

    #[test]
    fn a_placed_shape_moves_its_coordinates_along() {
        let to_scene = DMat4::from_translation(DVec3::new(5.0, 0.0, 0.0))
            * DMat4::from_rotation_z(PI / 2.0)
            * DMat4::from_scale(DVec3::new(2.0, 3.0, 1.0));
        let placement = Placement::new(UnitShape::Rectangle, to_scene);
        // The unit rectangle's (0.5, 0, 0) lies at (1, 0) before the rotation.
        let frame = placement.frame(Vec3::new(5.0, 1.0, 0.0));
        assert!((frame.uv - glam::Vec2::new(0.75, 0.5)).length() < 1e-6);
        assert!((frame.axes[0] - 4.0 * DVec3::Y).length() < 1e-12);
        assert!((frame.axes[1] - 6.0 * DVec3::X).length() < 1e-12);
    }
}
