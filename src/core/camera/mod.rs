//! Cameras: rays of pixels, and pixels of points.
//!
//! Pixel (0, 0) is at the top left; its centre is at (0.5, 0.5). Right-handed: x right, y up, and
//! the camera looks along −z of its own space.

mod turntable;

pub use turntable::{StandardView, Turntable, UpAxis};

use crate::ray::Ray;
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, UVec2, Vec2, Vec3};

/// Perspective or orthographic projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// All rays start at the eye.
    Perspective {
        /// Angle between the upper and the lower edge of the picture.
        fov_y_radians: f64,
    },
    /// All rays are parallel; they start in the plane through the eye.
    Orthographic {
        /// Height of the picture in the scene's units.
        height: f64,
    },
}

/// Why a camera can't be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CameraError {
    /// A position or the orthographic height isn't finite, or too large for f32.
    #[error("the camera's position, target or height isn't finite in f32")]
    NotFinite,
    /// Eye and target are the same point.
    #[error("the camera's eye and target are the same point")]
    NoDirection,
    /// The up vector points along the view.
    #[error("the camera's up vector is zero or points along the view")]
    NoUp,
    /// The field of view isn't between 0° and 180°, or the height isn't positive.
    #[error(
        "the field of view must be between 0 and 180 degrees, the orthographic height positive"
    )]
    BadProjection,
    /// The picture has no pixel.
    #[error("the picture has no pixels")]
    NoPixels,
}

/// A camera with its resolution. Immutable.
///
/// The eye is rounded to f32 like the origin of every ray, so that the overlay is drawn from the same point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: Vec3,
    /// Before it was rounded.
    exact_eye: DVec3,
    /// Columns: right, up, back.
    world_from_camera: DMat3,
    projection: Projection,
    resolution: UVec2,
    /// Half the width and height of the picture, at distance 1 in perspective.
    half_extent: DVec2,
}

impl Camera {
    /// A camera at `eye` with `target` in the centre of the picture and `up` pointing upwards.
    ///
    /// # Errors
    /// See [`CameraError`].
    pub fn look_at(
        eye: DVec3,
        target: DVec3,
        up: DVec3,
        projection: Projection,
        resolution: UVec2,
    ) -> Result<Self, CameraError> {
        if !(eye.as_vec3().is_finite() && target.as_vec3().is_finite()) {
            return Err(CameraError::NotFinite);
        }
        let back = direction(eye - target).ok_or(CameraError::NoDirection)?;
        let up = direction(up).ok_or(CameraError::NoUp)?;
        let right = up.cross(back);
        // Below this, rounding of the up vector decides which way is right.
        if right.length() < 1e-12 {
            return Err(CameraError::NoUp);
        }
        let right = right.normalize();
        Self::from_axes(
            eye,
            DMat3::from_cols(right, back.cross(right), back),
            projection,
            resolution,
        )
    }

    fn from_axes(
        eye: DVec3,
        world_from_camera: DMat3,
        projection: Projection,
        resolution: UVec2,
    ) -> Result<Self, CameraError> {
        let is_good = match projection {
            Projection::Perspective { fov_y_radians } => {
                fov_y_radians > 0.0 && fov_y_radians < std::f64::consts::PI
            }
            Projection::Orthographic { height } => height > 0.0 && height.is_finite(),
        };
        if !is_good {
            return Err(CameraError::BadProjection);
        }
        if resolution.min_element() == 0 {
            return Err(CameraError::NoPixels);
        }
        let half_height = match projection {
            Projection::Perspective { fov_y_radians } => (0.5 * fov_y_radians).tan(),
            Projection::Orthographic { height } => 0.5 * height,
        };
        let aspect = f64::from(resolution.x) / f64::from(resolution.y);
        let half_extent = DVec2::new(half_height * aspect, half_height);
        // Orthographic rays start up to the half extent away from the eye.
        let exact_eye = eye;
        let eye = eye.as_vec3();
        if !(eye.abs().max_element() + half_extent.as_vec2().max_element()).is_finite() {
            return Err(CameraError::NotFinite);
        }
        Ok(Self {
            eye,
            exact_eye,
            world_from_camera,
            projection,
            resolution,
            half_extent,
        })
    }

    /// The ray through a position in a pixel; `sample` is (0.5, 0.5) for its centre.
    ///
    /// The direction has unit length up to its rounding to f32.
    pub fn ray(&self, pixel: UVec2, sample: Vec2) -> Ray {
        self.ray_through(pixel.as_dvec2() + sample.as_dvec2())
    }

    /// The ray through a position in the picture, in pixels from the top left corner.
    pub fn ray_through(&self, at: DVec2) -> Ray {
        let (offset, dir) = self.offset_and_dir(at);
        Ray {
            origin: (self.eye.as_dvec3() + offset).as_vec3(),
            dir: dir.as_vec3(),
            t_min: 0.0,
            t_max: f32::INFINITY,
            scale: 0,
            exclude: None,
        }
    }

    /// Origin and direction of the same ray in f64, with the eye as it was given to [`look_at`](Self::look_at).
    pub fn ray_before_rounding(&self, at: DVec2) -> [DVec3; 2] {
        let (offset, dir) = self.offset_and_dir(at);
        [self.exact_eye + offset, dir]
    }

    /// Origin relative to the eye, and direction, of the ray through a position in the picture.
    fn offset_and_dir(&self, at: DVec2) -> (DVec3, DVec3) {
        let on_plane = self.plane_from_pixel(at);
        match self.projection {
            Projection::Perspective { .. } => {
                let dir = self.world_from_camera * on_plane.extend(-1.0).normalize();
                (DVec3::ZERO, dir)
            }
            Projection::Orthographic { .. } => {
                let offset = self.world_from_camera * on_plane.extend(0.0);
                (offset, -self.back())
            }
        }
    }

    /// The point under a place in the picture, in the plane through `point` that faces the camera.
    ///
    /// In perspective, a plane behind the eye counts as if it were as far ahead of it.
    pub fn on_plane_through(&self, point: DVec3, at: DVec2) -> DVec3 {
        let on_plane = self.plane_from_pixel(at);
        let depth = self.depth_of(point);
        let in_camera = match self.projection {
            Projection::Perspective { .. } => (on_plane * depth.abs()).extend(-depth.abs()),
            Projection::Orthographic { .. } => on_plane.extend(-depth),
        };
        self.eye.as_dvec3() + self.world_from_camera * in_camera
    }

    /// Distance of a point from the plane of the eye, along the view.
    pub fn depth_of(&self, point: DVec3) -> f64 {
        (self.eye.as_dvec3() - point).dot(self.back())
    }

    /// The same camera, moved. Its eye stays finite.
    #[must_use]
    pub fn moved(&self, by: DVec3) -> Self {
        let limit = DVec3::splat(f64::from(f32::MAX) / 2.0);
        let exact_eye = (self.exact_eye + by).clamp(-limit, limit);
        Self {
            eye: exact_eye.as_vec3(),
            exact_eye,
            ..*self
        }
    }

    /// The position of a point in the picture, in pixels from the top left corner; `None` if the point isn't in
    /// front of the camera or isn't finite.
    pub fn pixel_of(&self, point: DVec3) -> Option<DVec2> {
        let in_camera = self.world_from_camera.transpose() * (point - self.eye.as_dvec3());
        let depth = match self.projection {
            Projection::Perspective { .. } => -in_camera.z,
            Projection::Orthographic { .. } => 1.0,
        };
        if !(depth > 0.0 && in_camera.z <= 0.0 && in_camera.is_finite()) {
            return None;
        }
        let size = self.resolution.as_dvec2();
        let clip = in_camera.truncate() / depth / self.half_extent;
        Some((clip * DVec2::new(0.5, -0.5) + 0.5) * size)
    }

    /// Matrix from coordinates relative to the eye (along the scene's axes) to the clip space of a GPU.
    ///
    /// Depth is 1 at `near` and decreases: to 0 at infinity in perspective, which keeps precision far away, and
    /// to 0 at `far` in an orthographic picture.
    pub fn clip_from_eye(&self, near: f64, far: f64) -> DMat4 {
        let half = self.half_extent;
        let clip_from_camera = match self.projection {
            Projection::Perspective { .. } => DMat4::from_cols(
                DVec4::new(1.0 / half.x, 0.0, 0.0, 0.0),
                DVec4::new(0.0, 1.0 / half.y, 0.0, 0.0),
                DVec4::new(0.0, 0.0, 0.0, -1.0),
                DVec4::new(0.0, 0.0, near, 0.0),
            ),
            Projection::Orthographic { .. } => DMat4::from_cols(
                DVec4::new(1.0 / half.x, 0.0, 0.0, 0.0),
                DVec4::new(0.0, 1.0 / half.y, 0.0, 0.0),
                DVec4::new(0.0, 0.0, 1.0 / (far - near), 0.0),
                DVec4::new(0.0, 0.0, far / (far - near), 1.0),
            ),
        };
        clip_from_camera * DMat4::from_mat3(self.world_from_camera.transpose())
    }

    /// The origin of perspective rays; the centre of the plane where orthographic rays start.
    pub fn eye(&self) -> Vec3 {
        self.eye
    }

    /// Unit vector to the right of the picture.
    pub fn right(&self) -> DVec3 {
        self.world_from_camera.x_axis
    }

    /// Unit vector to the top of the picture.
    pub fn up(&self) -> DVec3 {
        self.world_from_camera.y_axis
    }

    /// Unit vector towards the viewer.
    pub fn back(&self) -> DVec3 {
        self.world_from_camera.z_axis
    }

    /// The projection.
    pub fn projection(&self) -> Projection {
        self.projection
    }

    /// Width and height in pixels.
    pub fn resolution(&self) -> UVec2 {
        self.resolution
    }

    /// Size of a pixel, in the scene's units, at a distance along the viewing direction.
    pub fn pixel_size_at(&self, depth: f64) -> f64 {
        let scale = match self.projection {
            Projection::Perspective { .. } => depth,
            Projection::Orthographic { .. } => 1.0,
        };
        2.0 * self.half_extent.y * scale / f64::from(self.resolution.y)
    }

    fn plane_from_pixel(&self, at: DVec2) -> DVec2 {
        let size = self.resolution.as_dvec2();
        (at / size - 0.5) * DVec2::new(2.0, -2.0) * self.half_extent
    }
}

/// The unit vector along a vector of any length: one whose square overflows or vanishes has a direction, too.
fn direction(v: DVec3) -> Option<DVec3> {
    (v / v.abs().max_element()).try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERSPECTIVE: Projection = Projection::Perspective { fov_y_radians: 1.0 };
    const ORTHOGRAPHIC: Projection = Projection::Orthographic { height: 3.0 };

    fn camera(projection: Projection) -> Camera {
        let (eye, target) = (DVec3::new(3.0, 4.0, 5.0), DVec3::new(0.0, 1.0, 0.0));
        Camera::look_at(eye, target, DVec3::Y, projection, UVec2::new(320, 200)).expect("good")
    }

    /// How many pixels a ray may pass beside where it was aimed, so far along the viewing direction: what its
    /// rounding to f32 comes to.
    ///
    /// Coordinates of a direction, at most 1, are off by 2⁻²⁵ at most, those of an orthographic origin, below 8,
    /// by 2⁻²²: √3 of that in length. In perspective an angle counts for 1 + tan² of the angle from the
    /// picture's centre, at most 1 + (1.6² + 1)·tan²(½) = 2.07, and the origin isn't rounded.
    fn rounding_px(camera: &Camera, distance: f64) -> f64 {
        let (of_dir, of_origin) = (3f64.sqrt() * 2f64.powi(-25), 3f64.sqrt() * 2f64.powi(-22));
        let pixel = camera.pixel_size_at(distance);
        match camera.projection() {
            Projection::Perspective { .. } => 2.07 * distance * of_dir / pixel,
            Projection::Orthographic { .. } => (of_origin + distance * of_dir) / pixel,
        }
    }

    /// Some sixty roundings of numbers up to 320 pixels in f64.
    const F64_PX: f64 = 60.0 * 320.0 * f64::EPSILON;

    #[test]
    fn a_point_projects_to_the_pixel_whose_ray_passes_through_it() {
        for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
            let camera = camera(projection);
            for at in [
                DVec2::new(0.5, 0.5),
                DVec2::new(160.0, 100.0),
                DVec2::new(300.2, 7.9),
            ] {
                let ray = camera.ray_through(at);
                let point = ray.origin.as_dvec3() + 6.0 * ray.dir.as_dvec3();
                let back = camera.pixel_of(point).expect("in front");
                let most = rounding_px(&camera, 6.0) + F64_PX;
                assert!((back - at).length() < most, "{at} {back}");
            }
        }
    }

    #[test]
    fn the_target_is_at_the_pictures_centre_and_up_points_upwards() {
        for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
            let camera = camera(projection);
            let middle = camera
                .pixel_of(DVec3::new(0.0, 1.0, 0.0))
                .expect("in front");
            assert!((middle - DVec2::new(160.0, 100.0)).length() < F64_PX);
            let above = camera
                .pixel_of(DVec3::new(0.0, 1.5, 0.0))
                .expect("in front");
            assert!(above.y < middle.y && (above.x - middle.x).abs() < F64_PX);
        }
    }

    #[test]
    fn a_sample_at_one_half_is_the_pixels_centre() {
        let camera = camera(PERSPECTIVE);
        let centre = camera.ray(UVec2::new(10, 20), Vec2::splat(0.5));
        assert_eq!(centre, camera.ray_through(DVec2::new(10.5, 20.5)));
    }

    #[test]
    fn a_pixels_point_on_a_plane_facing_the_camera_projects_to_the_pixel() {
        let on_plane = DVec3::new(0.5, 1.0, -2.0);
        for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
            let camera = camera(projection);
            let at = DVec2::new(300.2, 7.9);
            let point = camera.on_plane_through(on_plane, at);
            // Lengths and pixels of some 10 and 300, in f64.
            let off = camera.pixel_of(point).expect("in front") - at;
            assert!(off.length() < 1e-11, "{off}");
            assert!((point - on_plane).dot(camera.back()).abs() < 1e-13);
        }
    }

    #[test]
    fn moving_the_camera_and_a_point_together_keeps_the_pixel() {
        for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
            let camera = camera(projection);
            // f32 holds the eye and its sum with this.
            let by = DVec3::new(-8.0, 64.0, 0.5);
            let point = DVec3::new(0.5, 1.0, -2.0);
            let moved = camera.moved(by).pixel_of(point + by);
            assert_eq!(moved, camera.pixel_of(point));
        }
    }

    #[test]
    fn clip_space_agrees_with_pixels_and_depth_decreases_from_one() {
        for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
            let camera = camera(projection);
            let clip_from_eye = camera.clip_from_eye(0.5, 100.0);
            // The ray's direction is rounded to f32.
            let mut last_depth = 1.0 + f64::from(f32::EPSILON);
            for distance in [0.5, 1.0, 10.0, 99.0] {
                let ray = camera.ray_through(DVec2::new(40.0, 30.0));
                let along = distance / -ray.dir.as_dvec3().dot(camera.back());
                let point = ray.origin.as_dvec3() + along * ray.dir.as_dvec3();
                let clip = clip_from_eye * (point - camera.eye().as_dvec3()).extend(1.0);
                let at = (clip.truncate().truncate() / clip.w * DVec2::new(0.5, -0.5) + 0.5)
                    * DVec2::new(320.0, 200.0);
                let most = rounding_px(&camera, distance) + F64_PX;
                assert!((at - DVec2::new(40.0, 30.0)).length() < most, "{at}");
                let depth = clip.z / clip.w;
                assert!(depth > 0.0 && depth < last_depth, "{depth}");
                last_depth = depth;
            }
        }
    }

    #[test]
    fn up_vectors_and_distances_of_any_length_are_normalised() {
        let camera = |eye: DVec3, up: DVec3| {
            Camera::look_at(eye, DVec3::ZERO, up, PERSPECTIVE, UVec2::ONE).expect("good")
        };
        let usual = camera(DVec3::Z, DVec3::new(1.0, 1.0, 0.0));
        for length in [1e-320, 1e-200, 1e200, 1e308] {
            let up = DVec3::new(length, length, 0.0);
            assert_eq!(camera(DVec3::Z, up), usual, "{length}");
        }
        let near = camera(DVec3::Z * 1e-200, DVec3::Y);
        assert_eq!(near.back(), DVec3::Z);
    }

    #[test]
    fn invalid_cameras_are_refused_with_the_reason() {
        let make = |eye: DVec3, up: DVec3, projection, size| {
            Camera::look_at(eye, DVec3::ZERO, up, projection, size).expect_err("refused")
        };
        let (eye, size) = (DVec3::Z, UVec2::ONE);
        assert_eq!(
            make(DVec3::ZERO, DVec3::Y, PERSPECTIVE, size),
            CameraError::NoDirection
        );
        assert_eq!(
            make(DVec3::NAN, DVec3::Y, PERSPECTIVE, size),
            CameraError::NotFinite
        );
        assert_eq!(
            make(DVec3::Z * 1e300, DVec3::Y, PERSPECTIVE, size),
            CameraError::NotFinite
        );
        assert_eq!(make(eye, DVec3::Z, PERSPECTIVE, size), CameraError::NoUp);
        assert_eq!(
            make(eye, DVec3::Y, PERSPECTIVE, UVec2::ZERO),
            CameraError::NoPixels
        );
        for fov_y_radians in [0.0, 4.0, f64::NAN] {
            let projection = Projection::Perspective { fov_y_radians };
            assert_eq!(
                make(eye, DVec3::Y, projection, size),
                CameraError::BadProjection
            );
        }
    }
}
