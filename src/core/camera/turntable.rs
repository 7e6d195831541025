//! Turntable navigation: orbit, pan and zoom.

use super::{Camera, Projection};
use crate::aabb::Aabb;
use glam::{DMat3, DVec2, DVec3, UVec2};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The axis of the file that points up. OBJ doesn't define it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// The convention of most modellers.
    #[default]
    Y,
    /// The convention of CAD and surveying.
    Z,
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
}

/// A camera on a sphere around a pivot, with a level horizon.
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

impl Turntable {
    /// Default vertical field of view.
    pub const FOV_Y_RADIANS: f64 = 40.0 * PI / 180.0;
    /// Rotation in radians by a drag across the height of the picture.
    const RADIANS_PER_HEIGHT: f64 = PI;
    /// Minimum distance from the pivot, relative to the scene: f32 still resolves a hundredth of it.
    const NEAREST: f64 = 1e-5;
    /// Maximum distance from the pivot, in radii of the scene.
    const FARTHEST: f64 = 1e4;

    /// The default view: the whole scene, from slightly above and to the right.
    pub fn framing(bounds: Aabb, resolution: UVec2) -> Self {
        let mut turntable = Self {
            pivot: DVec3::ZERO,
            distance: 1.0,
            yaw_radians: 30f64.to_radians(),
            pitch_radians: 20f64.to_radians(),
            fov_y_radians: Self::FOV_Y_RADIANS,
            is_orthographic: false,
            up_axis: UpAxis::Y,
            centre: DVec3::ZERO,
            radius: 1.0,
        };
        turntable.frame(bounds, resolution);
        turntable
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

    /// Rotates by a drag, in pixels to the right and down.
    pub fn orbit(&mut self, drag_px: DVec2, resolution: UVec2) {
        let angle = drag_px * Self::RADIANS_PER_HEIGHT / f64::from(resolution.y.max(1));
        self.turn(-angle.x);
        self.pitch_radians = (self.pitch_radians + angle.y).clamp(-FRAC_PI_2, FRAC_PI_2);
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
    }

    /// Scales the distance by `factor`, within the limits, and keeps `anchor` at its position in the picture.
    /// Ignores a factor or an anchor that isn't finite.
    pub fn zoom(&mut self, factor: f64, anchor: DVec3) {
        let nearest = Self::NEAREST * (self.radius + (self.pivot - self.centre).length());
        let distance = (self.distance * factor).clamp(nearest, Self::FARTHEST * self.radius);
        if distance.is_finite() && anchor.is_finite() {
            let scale = distance / self.distance;
            self.pivot = anchor + (self.pivot - anchor) * scale;
            self.distance = distance;
        }
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
    }

    /// Looks along an axis.
    pub fn look_from(&mut self, view: StandardView) {
        (self.yaw_radians, self.pitch_radians) = match view {
            StandardView::Front => (0.0, 0.0),
            StandardView::Back => (PI, 0.0),
            StandardView::Right => (FRAC_PI_2, 0.0),
            StandardView::Left => (3.0 * FRAC_PI_2, 0.0),
            StandardView::Top => (0.0, FRAC_PI_2),
            StandardView::Bottom => (0.0, -FRAC_PI_2),
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

    /// Right, up and back, with a level horizon; well defined from straight above, too.
    fn world_from_camera(&self) -> DMat3 {
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
mod tests {
    use super::*;
    use glam::Vec3;

    const SIZE: UVec2 = UVec2::new(800, 600);

    /// Scenes of very different size, and one far from the mesh's origin.
    fn scenes() -> [Aabb; 5] {
        let cube = |size: f32, at: Vec3| Aabb::around([at, at + size]);
        [
            cube(1e-6, Vec3::ZERO),
            cube(1.0, Vec3::ZERO),
            cube(1e6, Vec3::ZERO),
            cube(100.0, Vec3::splat(1e7)),
            cube(1e30, Vec3::ZERO),
        ]
    }

    fn pixel_of(turntable: &Turntable, point: DVec3) -> DVec2 {
        turntable.camera(SIZE).pixel_of(point).expect("in front")
    }

    /// A hundredth of a pixel, or what rounding the eye to f32 moves it by.
    fn tolerance(turntable: &Turntable) -> f64 {
        let place = turntable.camera(SIZE).eye().as_dvec3().abs().max_element();
        let pixel = turntable.height_at_pivot() / f64::from(SIZE.y);
        0.01 + place * f64::from(f32::EPSILON) / pixel
    }

    #[test]
    fn framing_fits_the_whole_scene_to_the_picture() {
        for scene in scenes() {
            for orthographic in [false, true] {
                let mut turntable = Turntable::framing(scene, SIZE);
                turntable.is_orthographic = orthographic;
                let corners = corners(scene).into_iter();
                let pixels: Vec<DVec2> = corners.map(|p| pixel_of(&turntable, p)).collect();
                let inside =
                    |p: &DVec2| p.cmpge(DVec2::ZERO).all() && p.cmple(SIZE.as_dvec2()).all();
                assert!(pixels.iter().all(inside), "{scene:?}: {pixels:?}");
                let heights = pixels.iter().map(|p| p.y);
                let spread =
                    heights.clone().fold(f64::MIN, f64::max) - heights.fold(f64::MAX, f64::min);
                assert!(spread > 0.5 * f64::from(SIZE.y), "{spread}");
            }
        }
    }

    #[test]
    fn zooming_keeps_the_point_under_the_cursor() {
        for scene in scenes() {
            for orthographic in [false, true] {
                let mut turntable = Turntable::framing(scene, SIZE);
                turntable.is_orthographic = orthographic;
                let cursor = DVec2::new(600.0, 150.0);
                let camera = turntable.camera(SIZE);
                let anchor = camera.on_plane_through(turntable.pivot, cursor);
                for factor in [0.8, 0.5, 0.1, 1.5, 20.0] {
                    turntable.zoom(factor, anchor);
                    let moved = (pixel_of(&turntable, anchor) - cursor).length();
                    assert!(moved < tolerance(&turntable), "{scene:?} {factor}: {moved}");
                }
            }
        }
    }

    #[test]
    fn centring_on_a_point_keeps_sizes_in_the_picture() {
        for scene in scenes() {
            for orthographic in [false, true] {
                let mut turntable = Turntable::framing(scene, SIZE);
                turntable.is_orthographic = orthographic;
                let corners = corners(scene);
                let (point, before) = (corners[6], turntable);
                turntable.centre_on(point);
                let middle = 0.5 * SIZE.as_dvec2();
                let off = (pixel_of(&turntable, point) - middle).length();
                assert!(off < tolerance(&turntable), "{scene:?}: {off}");
                let size_at = |turntable: &Turntable, p: DVec3| {
                    let camera = turntable.camera(SIZE);
                    camera.pixel_size_at(camera.depth_of(p))
                };
                for corner in corners {
                    let (size, old_size) = (size_at(&turntable, corner), size_at(&before, corner));
                    // The eye's place is rounded to f32, by a part of a pixel of each height of the picture.
                    let tolerance = tolerance(&turntable) / f64::from(SIZE.y);
                    assert!((size / old_size - 1.0).abs() < tolerance, "{scene:?}");
                }
            }
        }
    }

    #[test]
    fn zooming_stops_within_the_range_of_f32() {
        for scene in scenes() {
            let mut turntable = Turntable::framing(scene, SIZE);
            let anchor = turntable.pivot;
            for factor in [0.5, 2.0] {
                (0..200).for_each(|_| turntable.zoom(factor, anchor));
                assert!(turntable.distance > 0.0 && turntable.distance.is_finite());
                let ray = turntable.camera(SIZE).ray_through(DVec2::ZERO);
                assert!(ray.origin.is_finite() && ray.dir.is_normalized());
            }
        }
    }

    #[test]
    fn the_largest_scene_in_f32_has_a_valid_camera() {
        let scene = Aabb::around([Vec3::splat(-3e38), Vec3::splat(3e38)]);
        let mut turntable = Turntable::framing(scene, SIZE);
        for is_orthographic in [false, true] {
            turntable.is_orthographic = is_orthographic;
            turntable.pan(DVec2::new(1e3, 1e3), SIZE);
            turntable.zoom(1.1, turntable.pivot);
            let ray = turntable
                .camera(UVec2::new(3000, 1))
                .ray_through(DVec2::ZERO);
            assert!(ray.origin.is_finite() && ray.dir.is_normalized(), "{ray:?}");
        }
    }

    #[test]
    fn panning_moves_the_pivots_plane_with_the_pointer() {
        for scene in scenes() {
            let mut turntable = Turntable::framing(scene, SIZE);
            let point = turntable.pivot;
            turntable.pan(DVec2::new(50.0, -30.0), SIZE);
            let expected = 0.5 * SIZE.as_dvec2() + DVec2::new(50.0, -30.0);
            let off = (pixel_of(&turntable, point) - expected).length();
            assert!(off < tolerance(&turntable), "{scene:?}: {off}");
        }
    }

    #[test]
    fn orbiting_keeps_the_pivot_the_distance_and_the_horizon() {
        for scene in scenes() {
            let mut turntable = Turntable::framing(scene, SIZE);
            let before = turntable;
            for drag in [
                DVec2::new(123.0, 45.0),
                DVec2::new(-3.0, 1e5),
                DVec2::new(7.0, -1e6),
            ] {
                turntable.orbit(drag, SIZE);
                assert_eq!(
                    (turntable.pivot, turntable.distance),
                    (before.pivot, before.distance)
                );
                let camera = turntable.camera(SIZE);
                assert!(camera.right().y.abs() < 1e-15 && camera.up().y > -1e-15);
                let axes = turntable.world_from_camera();
                assert!((axes.determinant() - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn standard_views_look_along_the_axes_for_either_up() {
        let mut turntable = Turntable::framing(scenes()[1], SIZE);
        for (up_axis, front, up) in [
            (UpAxis::Y, DVec3::Z, DVec3::Y),
            (UpAxis::Z, DVec3::NEG_Y, DVec3::Z),
        ] {
            turntable.up_axis = up_axis;
            for (view, back) in [
                (StandardView::Front, front),
                (StandardView::Back, -front),
                (StandardView::Right, DVec3::X),
                (StandardView::Left, DVec3::NEG_X),
                (StandardView::Top, up),
                (StandardView::Bottom, -up),
            ] {
                turntable.look_from(view);
                assert!(
                    (turntable.camera(SIZE).back() - back).length() < 1e-12,
                    "{view:?}"
                );
            }
        }
    }

    #[test]
    fn an_empty_scene_or_a_single_point_has_a_valid_camera() {
        let points = [Vec3::ZERO, Vec3::splat(1e7)].map(|point| Aabb::around([point]));
        for bounds in [Aabb::EMPTY, points[0], points[1]] {
            let turntable = Turntable::framing(bounds, SIZE);
            assert!(turntable.distance > 0.0);
            turntable.camera(UVec2::ZERO);
        }
    }
}
