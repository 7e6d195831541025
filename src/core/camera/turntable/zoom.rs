//! Zooming, and the limits of pivot and distance.
//!
//! Zooming moves the eye along the line to a point, by a part of their distance. That alone would never reach the point.
//! Within the smallest distance the eye therefore moves past the point, and the pivot moves ahead.

use super::Turntable;
use glam::DVec3;

impl Turntable {
    /// Minimum distance from the pivot, relative to the scene: f32 still resolves a hundredth of it.
    const NEAREST: f64 = 1e-5;
    /// Maximum distance from the pivot, and of the pivot from the scene, in radii of the scene.
    const FARTHEST: f64 = 1e4;

    /// The smallest distance: the scene, and the rounding of coordinates to f32, resolve it.
    fn nearest(&self) -> f64 {
        let relative = Self::NEAREST * (self.radius + (self.pivot - self.centre).length());
        // Four steps of f32 at the largest coordinate, so that moving by this changes the rounded eye.
        let rounding = 4.0 * f64::from(f32::EPSILON) * self.pivot.abs().max_element();
        relative.max(rounding)
    }

    fn farthest(&self) -> f64 {
        (Self::FARTHEST * self.radius).max(self.nearest())
    }

    /// Moves the eye so that its distance from `anchor` is scaled by `factor`, and keeps `anchor` at its position in the
    /// picture. The distance of the pivot scales likewise, within the limits. Closer to the anchor than the smallest
    /// distance, the eye passes it. Ignores a factor or an anchor that isn't finite, or a factor that isn't positive.
    pub fn zoom(&mut self, factor: f64, anchor: DVec3) {
        if !(factor > 0.0 && factor.is_finite() && anchor.is_finite()) {
            return;
        }
        let nearest = self.nearest();
        if self.is_orthographic || factor >= 1.0 {
            let distance = (self.distance * factor).clamp(nearest, self.farthest());
            let scale = distance / self.distance;
            self.pivot = anchor + (self.pivot - anchor) * scale;
            self.distance = distance;
        } else {
            self.approach(factor, anchor, nearest);
        }
        self.keep_in_reach();
    }

    /// Zooms in in perspective.
    fn approach(&mut self, factor: f64, anchor: DVec3, nearest: f64) {
        let back = self.world_from_camera().z_axis;
        let eye = self.pivot + self.distance * back;
        let to_anchor = anchor - eye;
        // Half of it more, as the anchor may be on the pivot's plane, which is that far away up to rounding. An anchor in a
        // picture that is older than the view may even be behind the eye.
        let close = 1.5 * nearest;
        let is_at_limit = self.distance <= close;
        if -to_anchor.dot(back) <= close {
            let eye = eye - 2.0 * nearest * back;
            if is_at_limit {
                self.distance = self.radius.max(nearest);
            }
            self.pivot = eye - self.distance * back;
            return;
        }
        let eye = anchor - to_anchor * factor;
        let depth = (eye - anchor).dot(back);
        // A pivot that is as near as it can be continues at the anchor.
        let wanted = if is_at_limit {
            depth
        } else {
            self.distance * factor
        };
        self.distance = wanted.clamp(nearest, self.farthest());
        self.pivot = eye - self.distance * back;
    }

    /// Limits the pivot to the surroundings of the scene and the distance to what can be resolved. A value that isn't
    /// finite becomes that of the scene.
    pub(super) fn keep_in_reach(&mut self) {
        let offset = self.pivot - self.centre;
        self.pivot = if offset.is_finite() {
            self.centre + offset.clamp_length_max(Self::FARTHEST * self.radius)
        } else {
            self.centre
        };
        let (nearest, farthest) = (self.nearest(), self.farthest());
        self.distance = if self.distance.is_finite() {
            self.distance.clamp(nearest, farthest)
        } else {
            self.radius.clamp(nearest, farthest)
        };
    }
}
