//! Cameras: rays of pixels, and pixels of points.
//!
//! Pixel (0, 0) is at the top left; its centre is at (0.5, 0.5). Right-handed: x right, y up, and
//! the camera looks along −z of its own space.

mod turntable;

pub use turntable::{StandardView, Turntable, UpAxis};

use crate::ray::Ray;
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, UVec2, Vec2, Vec3};

/// The largest width or height of a picture in pixels, the usual limit of GPU textures.
pub const MAX_SIDE: u32 = 16384;

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
    #[error(
        "the camera's position, target or height isn't finite, or is too large for 32-bit numbers, which end at 3.4e38"
    )]
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
    /// The axes aren't perpendicular unit vectors.
    #[error("the camera's axes must be perpendicular and of length 1")]
    BadAxes,
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

    /// A camera with these axes as columns: right, up and back. They must be perpendicular unit vectors.
    ///
    /// # Errors
    /// See [`CameraError`].
    pub fn from_axes(
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
        // Axes that were read from a file; the product of rounded ones is closer to the identity.
        const AXES_BOUND: f64 = 1e-9;
        let product = world_from_camera.transpose() * world_from_camera;
        if !product.abs_diff_eq(DMat3::IDENTITY, AXES_BOUND) {
            return Err(CameraError::BadAxes);
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

    /// The same before it was rounded to f32.
    pub fn exact_eye(&self) -> DVec3 {
        self.exact_eye
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
mod tests;
