//! The turntable: a pivot, a distance and three angles.
//!
//! | file | part |
//! |---|---|
//! | this file | the state, framing, orbiting and panning, and its camera |
//! | `freely` | free rotation, rotation about other points, flying |
//! | `zoom` | zooming, and the limits of pivot and distance |
//! | `transition` | the states between two turntables |

mod freely;
mod transition;
mod zoom;

use super::{Camera, CameraError, Projection};
use crate::aabb::Aabb;
use glam::{DMat3, DVec2, DVec3, UVec2};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// The axis of the file that points up. OBJ doesn't define it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// The convention of most modellers.
    #[default]
    Y,
    /// The convention of CAD and surveying.
    Z,
}

impl UpAxis {
    /// The axis nearest to a direction that points up; Y if both are equally near.
    pub fn nearest(up: DVec3) -> Self {
        if up.z.abs() > up.y.abs() {
            Self::Z
        } else {
            Self::Y
        }
    }
}

/// A view along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StandardView {
    /// From +Z (Y up) or −Y (Z up).
    Front,
    /// From the opposite side.
    Back,
    /// From +X.
    Right,
    /// From −X.
    Left,
    /// From above.
    Top,
    /// From below.
    Bottom,
    /// From above, the front and the right. In an orthographic picture, the three axes have equal lengths.
    Isometric,
}

/// A camera on a sphere around a pivot, with a level horizon unless a file's view is tilted.
///
/// Lengths are in the scene's units; nothing depends on the scene's size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turntable {
    /// Centre of rotation and of the picture.
    pub pivot: DVec3,
    /// Distance from the pivot to the eye.
    pub distance: f64,
    /// Angle about the up axis, from 0 to 2π; 0 looks from the front.
    pub yaw_radians: f64,
    /// Angle above the horizon, from −π/2 to π/2.
    pub pitch_radians: f64,
    /// Rotation of the camera about the viewing direction, counterclockwise; 0 unless a file's view is tilted.
    pub roll_radians: f64,
    /// Vertical field of view in radians; in an orthographic picture it defines the height at the pivot.
    pub fov_y_radians: f64,
    /// Whether the projection is orthographic.
    pub is_orthographic: bool,
    /// The axis that points up.
    pub up_axis: UpAxis,
    /// Bounding sphere of the scene's box.
    centre: DVec3,
    radius: f64,
}

impl StandardView {
    /// The view from the positive or the negative end of an axis: 0 for x, 1 for y, 2 for z.
    pub fn from_end(axis: usize, is_positive: bool, up_axis: UpAxis) -> Self {
        let [from_positive, from_negative] = match (axis, up_axis) {
            (0, _) => [Self::Right, Self::Left],
            (1, UpAxis::Y) | (2, UpAxis::Z) => [Self::Top, Self::Bottom],
            (2, UpAxis::Y) => [Self::Front, Self::Back],
            _ => [Self::Back, Self::Front],
        };
        if is_positive {
            from_positive
        } else {
            from_negative
        }
    }
}

impl Turntable {
    /// Default vertical field of view.
    pub const FOV_Y_RADIANS: f64 = 40.0 * PI / 180.0;
    /// Rotation in radians by a drag across the height of the picture.
    const RADIANS_PER_HEIGHT: f64 = PI;

    /// The default view: the whole scene, from slightly above and to the right.
    pub fn framing(bounds: Aabb, resolution: UVec2) -> Self {
        let mut turntable = Self {
            pivot: DVec3::ZERO,
            distance: 1.0,
            yaw_radians: 30f64.to_radians(),
            pitch_radians: 20f64.to_radians(),
            roll_radians: 0.0,
            fov_y_radians: Self::FOV_Y_RADIANS,
            is_orthographic: false,
            up_axis: UpAxis::Y,
            centre: DVec3::ZERO,
            radius: 1.0,
        };
        turntable.frame(bounds, resolution);
        turntable
    }

    /// The turntable that shows a given view, with the pivot on its axis at the depth of the scene's centre.
    ///
    /// `up` needn't be perpendicular to `forward`. The eye of an orthographic view moves along its axis.
    ///
    /// # Errors
    /// See [`CameraError`].
    pub fn looking(
        [eye, forward, up]: [DVec3; 3],
        projection: Projection,
        up_axis: UpAxis,
        bounds: Aabb,
    ) -> Result<Self, CameraError> {
        // Refuses what no camera can show.
        let camera = Camera::look_at(eye, eye + forward, up, projection, UVec2::ONE)?;
        let mut turntable = Self::framing(bounds, UVec2::ONE);
        turntable.up_axis = up_axis;
        turntable.set_axes(camera.right(), camera.back());
        let depth = camera.depth_of(turntable.centre);
        let ahead = if depth > 0.0 { depth } else { turntable.radius };
        turntable.distance = match projection {
            Projection::Perspective { fov_y_radians } => {
                turntable.fov_y_radians = fov_y_radians;
                ahead
            }
            Projection::Orthographic { height } => {
                turntable.is_orthographic = true;
                0.5 * height / (0.5 * turntable.fov_y_radians).tan()
            }
        };
        turntable.pivot = eye - ahead * camera.back();
        Ok(turntable)
    }

    /// [`looking`](Self::looking) about the y or the z axis: the one for which the horizon is less tilted; of two, the one for
    /// which the view is more level; of those, `preferred`.
    ///
    /// # Errors
    /// See [`CameraError`].
    pub fn looking_level(
        view: [DVec3; 3],
        projection: Projection,
        preferred: UpAxis,
        bounds: Aabb,
    ) -> Result<Self, CameraError> {
        /// More than the rounding of angles.
        const SAME_TILT: f64 = 1e-9;
        let other = match preferred {
            UpAxis::Y => UpAxis::Z,
            UpAxis::Z => UpAxis::Y,
        };
        let about = |axis| Self::looking(view, projection, axis, bounds);
        let (kept, other) = (about(preferred)?, about(other)?);
        let more_tilt = other.roll_radians.abs() - kept.roll_radians.abs();
        let is_better = if more_tilt.abs() < SAME_TILT {
            other.pitch_radians.abs() < kept.pitch_radians.abs()
        } else {
            more_tilt < 0.0
        };
        Ok(if is_better { other } else { kept })
    }

    /// Moves along the viewing direction until the scene's box fits the picture.
    ///
    /// An empty scene, or a point at the origin, counts as a sphere of radius 1; another point as one whose radius
    /// is a thousandth of its largest coordinate.
    pub fn frame(&mut self, bounds: Aabb, resolution: UVec2) {
        /// Margin between the box and the edge of the picture.
        const MARGIN: f64 = 1.06;
        self.set_scene(bounds);
        self.pivot = self.centre;
        let aspect = f64::from(resolution.x.max(1)) / f64::from(resolution.y.max(1));
        let half_height = (0.5 * self.fov_y_radians).tan();
        let half_width = half_height * aspect;
        let camera_from_world = self.world_from_camera().transpose();
        let needed = corners(bounds).into_iter().map(|corner| {
            let p = camera_from_world * (corner - self.centre);
            p.z.max(0.0) + MARGIN * (p.x.abs() / half_width).max(p.y.abs() / half_height)
        });
        self.distance = needed.fold(self.radius, f64::max);
    }

    /// Replaces the scene and keeps the camera.
    pub fn set_scene(&mut self, bounds: Aabb) {
        (self.centre, self.radius) = sphere(bounds);
    }

    /// Rotates by a drag, in pixels to the right and down. The horizon stays as level as it is.
    pub fn orbit(&mut self, drag_px: DVec2, resolution: UVec2) {
        // The drag relative to the level horizon.
        let (sin, cos) = self.roll_radians.sin_cos();
        let drag_px = DVec2::new(
            cos * drag_px.x + sin * drag_px.y,
            cos * drag_px.y - sin * drag_px.x,
        );
        let angle = drag_px * Self::RADIANS_PER_HEIGHT / f64::from(resolution.y.max(1));
        if angle.is_finite() {
            self.turn(-angle.x);
            self.pitch_radians = (self.pitch_radians + angle.y).clamp(-FRAC_PI_2, FRAC_PI_2);
        }
    }

    /// Rotates about the pivot, counterclockwise as seen from above.
    pub fn turn(&mut self, radians: f64) {
        self.yaw_radians = (self.yaw_radians + radians).rem_euclid(TAU);
    }

    /// Pans by a drag, so that the plane through the pivot follows the pointer.
    pub fn pan(&mut self, drag_px: DVec2, resolution: UVec2) {
        let axes = self.world_from_camera();
        let per_pixel = self.height_at_pivot() / f64::from(resolution.y.max(1));
        self.pivot += (axes.y_axis * drag_px.y - axes.x_axis * drag_px.x) * per_pixel;
        self.keep_in_reach();
    }

    /// Turns about a point from now on and shows it in the middle of the picture. The eye moves across the
    /// view only, so that nothing changes its size in the picture. A point behind the eye is ignored.
    pub fn centre_on(&mut self, point: DVec3) {
        let back = self.world_from_camera().z_axis;
        let distance = self.distance - (point - self.pivot).dot(back);
        if self.is_orthographic {
            self.pivot = point;
        } else if distance > 0.0 && distance.is_finite() {
            (self.pivot, self.distance) = (point, distance);
        }
        self.keep_in_reach();
    }

    /// Looks along an axis.
    pub fn look_from(&mut self, view: StandardView) {
        self.roll_radians = 0.0;
        (self.yaw_radians, self.pitch_radians) = match view {
            StandardView::Front => (0.0, 0.0),
            StandardView::Back => (PI, 0.0),
            StandardView::Right => (FRAC_PI_2, 0.0),
            StandardView::Left => (3.0 * FRAC_PI_2, 0.0),
            StandardView::Top => (0.0, FRAC_PI_2),
            StandardView::Bottom => (0.0, -FRAC_PI_2),
            StandardView::Isometric => (FRAC_PI_4, FRAC_1_SQRT_2.atan()),
        };
    }

    /// The camera for a picture of this size; a size of zero counts as one pixel.
    ///
    /// The eye of an orthographic camera is outside the scene, so that nothing is cut off. Coordinates of
    /// the eye are clamped to the range of f32.
    pub fn camera(&self, resolution: UVec2) -> Camera {
        let axes = self.world_from_camera();
        let (projection, distance) = if self.is_orthographic {
            // The rays of the widest picture then start within the range of f32, too.
            let height = self.height_at_pivot().min(f64::from(f32::MAX) / 1e5);
            let outside = 2.0 * self.radius + (self.pivot - self.centre).length();
            (
                Projection::Orthographic { height },
                self.distance.max(outside),
            )
        } else {
            let fov_y_radians = self.fov_y_radians;
            (Projection::Perspective { fov_y_radians }, self.distance)
        };
        let limit = DVec3::splat(f64::from(f32::MAX) / 2.0);
        let eye = (self.pivot + axes.z_axis * distance).clamp(-limit, limit);
        Camera::from_axes(eye, axes, projection, resolution.max(UVec2::ONE))
            .expect("the eye is finite, the projection within its limits")
    }

    /// Right, up and back.
    fn world_from_camera(&self) -> DMat3 {
        let level = self.level_axes();
        let (sin, cos) = self.roll_radians.sin_cos();
        DMat3::from_cols(
            cos * level.x_axis + sin * level.y_axis,
            cos * level.y_axis - sin * level.x_axis,
            level.z_axis,
        )
    }

    /// Right, up and back with a level horizon; well defined from straight above, too.
    fn level_axes(&self) -> DMat3 {
        let (sin_yaw, cos_yaw) = self.yaw_radians.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch_radians.sin_cos();
        let right = DVec3::new(cos_yaw, 0.0, -sin_yaw);
        let back = DVec3::new(cos_pitch * sin_yaw, sin_pitch, cos_pitch * cos_yaw);
        let in_file = |v: DVec3| match self.up_axis {
            UpAxis::Y => v,
            UpAxis::Z => DVec3::new(v.x, -v.z, v.y),
        };
        let (right, back) = (in_file(right), in_file(back));
        DMat3::from_cols(right, back.cross(right), back)
    }

    fn height_at_pivot(&self) -> f64 {
        2.0 * self.distance * (0.5 * self.fov_y_radians).tan()
    }
}

/// Centre and radius of a scene; the radius is positive and finite.
fn sphere(bounds: Aabb) -> (DVec3, f64) {
    if bounds.is_empty() {
        return (DVec3::ZERO, 1.0);
    }
    let centre = bounds.centre().as_dvec3();
    let place = centre.abs().max_element();
    match bounds.radius() {
        0.0 if place == 0.0 => (centre, 1.0),
        0.0 => (centre, 1e-3 * place),
        radius => (centre, radius),
    }
}

/// The eight corners of a box; none if it is empty.
fn corners(bounds: Aabb) -> Vec<DVec3> {
    let corner = |k: usize| {
        let pick = |axis: usize| [bounds.min, bounds.max][k >> axis & 1][axis];
        DVec3::new(pick(0).into(), pick(1).into(), pick(2).into())
    };
    let count = if bounds.is_empty() { 0 } else { 8 };
    (0..count).map(corner).collect()
}

#[cfg(test)]
mod navigation_tests;
#[cfg(test)]
mod tests;
