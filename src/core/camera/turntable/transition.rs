//! The states between two turntables, for animated changes of the view.

use super::Turntable;
use std::f64::consts::{PI, TAU};

impl Turntable {
    /// The state on the way to `target`: `part` is 0 here and 1 there. Angles take the shorter way, and the distance changes
    /// by equal factors in equal parts. Projection and up axis are those of the target at once.
    #[must_use]
    pub fn towards(&self, target: &Self, part: f64) -> Self {
        if part >= 1.0 {
            return *target;
        }
        let from = self.about_axis(target.up_axis);
        let mix = |a: f64, b: f64| a + (b - a) * part;
        let turn = |a: f64, b: f64| a + shorter_way(b - a) * part;
        let distance = (mix(from.distance.ln(), target.distance.ln())).exp();
        Self {
            pivot: from.pivot.lerp(target.pivot, part),
            distance,
            yaw_radians: turn(from.yaw_radians, target.yaw_radians).rem_euclid(TAU),
            pitch_radians: mix(from.pitch_radians, target.pitch_radians),
            roll_radians: turn(from.roll_radians, target.roll_radians),
            fov_y_radians: mix(from.fov_y_radians, target.fov_y_radians),
            ..*target
        }
    }
}

/// The same rotation by an angle from −π to π.
fn shorter_way(radians: f64) -> f64 {
    (radians + PI).rem_euclid(TAU) - PI
}
