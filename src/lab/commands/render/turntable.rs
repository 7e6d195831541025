//! The cameras of a turntable: equal turns about the up axis.

use glam::{DQuat, DVec3};
use hitscope_core::camera::{CameraError, Turntable, UpAxis};
use hitscope_core::{Camera, Scene};
use std::f64::consts::TAU;

/// What a turntable turns about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    /// A point on it, in the scene's coordinates.
    pub pivot: DVec3,
    /// Unit vector that points up.
    pub up: DVec3,
}

impl Axis {
    /// The axis for a first camera. Without a `pivot`, it passes through the point in the middle of the picture at the
    /// depth of the scene's centre. Without an `up`, it is the y or z axis, whichever leaves the horizon more level.
    ///
    /// # Errors
    /// See [`CameraError`].
    pub fn new(
        first: &Camera,
        scene: &Scene,
        pivot: Option<DVec3>,
        up: Option<DVec3>,
    ) -> Result<Self, CameraError> {
        let view = [first.exact_eye(), -first.back(), first.up()];
        let turntable =
            Turntable::looking_level(view, first.projection(), UpAxis::Y, scene.bounds())?;
        let own = match turntable.up_axis {
            UpAxis::Y => DVec3::Y,
            UpAxis::Z => DVec3::Z,
        };
        let given = up.and_then(|up| (up / up.abs().max_element()).try_normalize());
        Ok(Self {
            pivot: pivot.unwrap_or(turntable.pivot),
            up: given.unwrap_or(own),
        })
    }

    /// The camera after a part of a turn, counterclockwise as seen from above; the first one itself after none.
    ///
    /// # Errors
    /// See [`CameraError`].
    pub fn turned(&self, first: &Camera, part: f64) -> Result<Camera, CameraError> {
        if part == 0.0 {
            return Ok(*first);
        }
        let turn = DQuat::from_axis_angle(self.up, TAU * part);
        let eye = self.pivot + turn * (first.exact_eye() - self.pivot);
        // A point ahead, as far away as the pivot, so that the sum keeps the direction's digits.
        let far = first
            .exact_eye()
            .distance(self.pivot)
            .max(f64::MIN_POSITIVE);
        let target = eye - turn * (far * first.back());
        let up = turn * first.up();
        Camera::look_at(eye, target, up, first.projection(), first.resolution())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::UVec2;
    use hitscope_core::camera::Projection;
    use hitscope_core::mesh::shapes::{Placement, cube};
    use hitscope_core::scene::scene;

    fn camera(eye: DVec3, target: DVec3, up: DVec3) -> Camera {
        let projection = Projection::Perspective { fov_y_radians: 0.7 };
        Camera::look_at(eye, target, up, projection, UVec2::new(40, 30)).expect("a camera")
    }

    #[test]
    fn a_full_turn_visits_all_sides_at_the_same_height_and_distance() {
        let scene = scene(cube(2, Placement::UNIT));
        let centre = DVec3::ONE;
        for up in [DVec3::Y, DVec3::Z] {
            let first = camera(centre + DVec3::new(3.0, 2.0, 5.0), centre, up);
            let axis = Axis::new(&first, &scene, None, None).expect("a view");
            assert_eq!(axis.up, up);
            assert!((axis.pivot - centre).length() < 1e-6, "{axis:?}");
            let quarter = axis.turned(&first, 0.25).expect("a camera");
            let (from, to) = (first.exact_eye() - centre, quarter.exact_eye() - centre);
            assert!((from.dot(up) - to.dot(up)).abs() < 1e-12);
            assert!((from.length() - to.length()).abs() < 1e-12);
            // Counterclockwise: up is the axis of the turn.
            let level = |v: DVec3| v - up * v.dot(up);
            assert!((level(from).cross(level(to)).normalize() - up).length() < 1e-12);
            assert!(level(from).dot(level(to)).abs() < 1e-5);
            assert!((quarter.back() - to.normalize()).length() < 1e-6);
            assert_eq!(axis.turned(&first, 0.0), Ok(first));
        }
    }

    #[test]
    fn a_pivot_and_an_axis_can_be_given() {
        let scene = scene(cube(2, Placement::UNIT));
        let first = camera(DVec3::new(9.0, 1.0, 1.0), DVec3::ONE, DVec3::Y);
        let pivot = DVec3::new(1.0, 5.0, 1.0);
        let axis = Axis::new(&first, &scene, Some(pivot), Some(1e300 * DVec3::NEG_Z));
        let axis = axis.expect("a view");
        let (expected, up) = (
            Axis {
                pivot,
                up: DVec3::NEG_Z,
            },
            axis.up,
        );
        assert_eq!(axis, expected);
        let half = axis.turned(&first, 0.5).expect("a camera");
        let opposite = 2.0 * pivot - first.exact_eye();
        assert!((half.exact_eye().truncate() - opposite.truncate()).length() < 1e-12);
        assert!((half.exact_eye() - first.exact_eye()).dot(up).abs() < 1e-12);
    }
}
