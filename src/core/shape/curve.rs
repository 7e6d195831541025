//! Division of curves into straight pieces whose distance from the curve is less than a camera shows.

use super::lines::{LineDetail, LinePoint};
use crate::camera::{Camera, Projection};
use glam::DVec3;

/// A camera that shows lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineView {
    /// The camera.
    pub camera: Camera,
    /// The largest distance between a piece and its curve in the picture, in pixels.
    pub tolerance_px: f64,
}

impl LineView {
    /// The largest distance between a piece of a curve in this ball and the curve; infinite if the picture doesn't show
    /// the ball.
    fn tolerance(&self, centre: DVec3, radius: f64) -> f64 {
        let camera = &self.camera;
        let depth = camera.depth_of(centre);
        if depth + radius < 0.0 {
            return f64::INFINITY;
        }
        /// Wide lines beside the picture reach into it.
        const MARGIN: f64 = 1.1;
        let from_eye = centre - camera.eye().as_dvec3();
        let half = 0.5 * MARGIN * camera.pixel_size_at(1.0) * camera.resolution().as_dvec2();
        let is_beside = |across: f64, half: f64| match camera.projection() {
            Projection::Perspective { .. } => {
                across.abs() - half * depth > radius * half.hypot(1.0)
            }
            Projection::Orthographic { .. } => across.abs() > half + radius,
        };
        if is_beside(from_eye.dot(camera.right()), half.x)
            || is_beside(from_eye.dot(camera.up()), half.y)
        {
            return f64::INFINITY;
        }
        // The display has coordinates in f32.
        let rounding = f64::from(f32::EPSILON) * centre.abs().max_element();
        let pixel = camera.pixel_size_at((depth - radius).max(0.0));
        (self.tolerance_px * pixel).max(rounding)
    }

    /// Whether the picture shows a curve through three points to differ from the line between the first and the last.
    fn shows_bend(&self, start: DVec3, middle: DVec3, end: DVec3) -> bool {
        let (way, to_middle) = (end - start, middle - start);
        let along = way.normalize_or_zero();
        let bend = (to_middle - to_middle.dot(along) * along).length();
        let radius = to_middle.length() + (end - middle).length();
        bend > self.tolerance(middle, radius)
    }
}

impl LineDetail {
    /// Points of a curve, given by a function of a parameter in a range: at least as many as divide the range into this
    /// number of pieces. A piece may turn by less than half a circle, and not to both sides.
    pub(super) fn curve(
        &self,
        [from, to]: [f64; 2],
        pieces: u32,
        at: &dyn Fn(f64) -> LinePoint,
    ) -> Vec<LinePoint> {
        /// More halvings than f64 parameters distinguish.
        const LEVELS: u32 = 50;
        let mut points = vec![at(from)];
        let place = |k: u32| from + (to - from) * f64::from(k) / f64::from(pieces);
        for k in 0..pieces {
            self.divide([place(k), place(k + 1)], LEVELS, at, &mut points);
        }
        points
    }

    /// Adds the points of a piece without its first, which is the last of `points`.
    fn divide(
        &self,
        [from, to]: [f64; 2],
        levels: u32,
        at: &dyn Fn(f64) -> LinePoint,
        points: &mut Vec<LinePoint>,
    ) {
        let end = at(to);
        if let (Some(view), Some(start)) = (&self.view, points.last())
            && levels > 0
        {
            let half = 0.5 * (from + to);
            if view.shows_bend(start.position, at(half).position, end.position) {
                self.divide([from, half], levels - 1, at, points);
                self.divide([half, to], levels - 1, at, points);
                return;
            }
        }
        points.push(end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aabb::Aabb;
    use glam::UVec2;

    /// The unit circle about z, as a camera at a distance from (1, 0, 0) shows it.
    fn circle_seen_from(distance: f64) -> (Camera, Vec<LinePoint>) {
        let eye = DVec3::new(1.0 + distance, 0.0, 0.3 * distance);
        let projection = Projection::Perspective { fov_y_radians: 0.7 };
        let size = UVec2::new(800, 600);
        let camera = Camera::look_at(eye, DVec3::X, DVec3::Z, projection, size).expect("a camera");
        let detail = LineDetail {
            segments: 8,
            around: Aabb::EMPTY,
            view: Some(LineView {
                camera,
                tolerance_px: 0.1,
            }),
        };
        let mut points = Vec::new();
        detail.circle(
            DVec3::ZERO,
            [DVec3::X, DVec3::Y],
            &mut |line| points.extend_from_slice(line),
            |n| n,
        );
        (camera, points)
    }

    #[test]
    fn pieces_of_a_circle_are_within_a_fraction_of_a_pixel_at_any_zoom_and_few() {
        for distance in [100.0, 3.0, 0.3, 0.01] {
            let (camera, points) = circle_seen_from(distance);
            assert!(points.len() < 600, "{} at {distance}", points.len());
            let mut visible = 0;
            for pair in points.windows(2) {
                let middle = 0.5 * (pair[0].position + pair[1].position);
                let on_circle = middle.normalize();
                let Some(pixel) = camera.pixel_of(on_circle) else {
                    continue;
                };
                if pixel.min_element() < 0.0 || pixel.cmpgt(camera.resolution().as_dvec2()).any() {
                    continue;
                }
                visible += 1;
                let pixel_size = camera.pixel_size_at(camera.depth_of(on_circle));
                let off = (on_circle - middle).length();
                assert!(
                    off <= 0.1 * pixel_size + 1e-7,
                    "{off} for {pixel_size} at {distance}"
                );
            }
            assert!(visible > 1, "{distance}");
        }
    }
}
