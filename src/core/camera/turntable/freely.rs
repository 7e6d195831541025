//! Free rotation, rotation about other points than the pivot, and flying.

use super::{Turntable, UpAxis};
use glam::{DMat3, DVec2, DVec3, UVec2};
use std::f64::consts::TAU;

impl Turntable {
    /// Sets the angles to those of a camera with these axes, which are perpendicular unit vectors.
    pub(super) fn set_axes(&mut self, right: DVec3, back: DVec3) {
        let level_back = match self.up_axis {
            UpAxis::Y => back,
            UpAxis::Z => DVec3::new(back.x, back.z, -back.y),
        };
        self.yaw_radians = level_back.x.atan2(level_back.z).rem_euclid(TAU);
        self.pitch_radians = level_back.y.atan2(level_back.x.hypot(level_back.z));
        let level = self.level_axes();
        self.roll_radians = right.dot(level.y_axis).atan2(right.dot(level.x_axis));
    }

    /// The same view with angles about another axis.
    #[must_use]
    pub fn about_axis(mut self, up_axis: UpAxis) -> Self {
        if up_axis != self.up_axis {
            let axes = self.world_from_camera();
            self.up_axis = up_axis;
            self.set_axes(axes.x_axis, axes.z_axis);
        }
        self
    }

    /// Rotates by a drag, in pixels to the right and down, about the axes of the picture. The horizon may tilt.
    pub fn orbit_freely(&mut self, drag_px: DVec2, resolution: UVec2) {
        let angle = drag_px * Self::RADIANS_PER_HEIGHT / f64::from(resolution.y.max(1));
        if !angle.is_finite() {
            return;
        }
        // One rotation about the axis in the picture that is perpendicular to the drag.
        let in_camera = DVec3::new(-angle.y, -angle.x, 0.0);
        let rotation = DMat3::from_quat(glam::DQuat::from_scaled_axis(in_camera));
        let axes = self.world_from_camera() * rotation;
        self.set_axes(axes.x_axis.normalize(), axes.z_axis.normalize());
    }

    /// Changes the angles by `turn` and moves the camera so that it has rotated about `point`, which keeps its place in
    /// the picture. `turn` must not move the pivot.
    pub fn turn_about(&mut self, point: DVec3, turn: impl FnOnce(&mut Self)) {
        let before = self.world_from_camera();
        turn(self);
        if point.is_finite() {
            let rotation = self.world_from_camera() * before.transpose();
            self.pivot = point + rotation * (self.pivot - point);
            self.keep_in_reach();
        }
    }

    /// Turns the camera about its eye by a drag, in pixels to the right and down: the picture follows the drag the other
    /// way round, as if one turned the head towards the pointer.
    pub fn look_around(&mut self, drag_px: DVec2, resolution: UVec2) {
        let eye = self.pivot + self.distance * self.world_from_camera().z_axis;
        // A drag across the picture turns by its field of view.
        let scale = self.fov_y_radians / Self::RADIANS_PER_HEIGHT;
        self.turn_about(eye, |turntable| {
            turntable.orbit(drag_px * scale, resolution);
        });
    }

    /// Moves the camera with its pivot: by `by`, in units of the scene, to the right, up and back. In an orthographic
    /// picture, where moving ahead changes nothing, moving ahead zooms.
    pub fn fly(&mut self, by: DVec3) {
        if !by.is_finite() {
            return;
        }
        let axes = self.world_from_camera();
        if self.is_orthographic {
            self.pivot += axes * by.with_z(0.0);
            self.zoom((by.z / self.distance).clamp(-1.0, 1.0).exp(), self.pivot);
        } else {
            self.pivot += axes * by;
        }
        self.keep_in_reach();
    }

    /// The radius of the scene, the unit of speeds; positive.
    pub fn scene_radius(&self) -> f64 {
        self.radius
    }
}
