//! A picked pixel as plain data.

use crate::comparison::Side;
use glam::{DMat3, DVec3, UVec2};
use hitscope_core::Camera;
use hitscope_core::camera::Projection;
use serde::{Deserialize, Serialize};

/// A picked pixel, with the camera of the picture that was clicked.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PickedPixel {
    /// A point near the scene, in the file's coordinates.
    origin: [f64; 3],
    /// Position of the camera, relative to `origin`.
    eye: [f64; 3],
    right: [f64; 3],
    pub(super) up: [f64; 3],
    back: [f64; 3],
    projection: PickProjection,
    /// Width and height of the picture.
    size: [u32; 2],
    /// Column and row from the top left.
    pub(super) pixel: [u32; 2],
    /// The crossing that is marked instead of the hit, counted from 0.
    #[serde(default)]
    pub crossing: Option<usize>,
    /// The side of a comparison whose picture was clicked.
    #[serde(default)]
    pub side: Side,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum PickProjection {
    Perspective { fov_y_radians: f64 },
    Orthographic { height: f64 },
}

impl PickedPixel {
    /// A pixel of side A, by the camera of its picture, in a scene with this origin.
    pub fn new(camera: &Camera, pixel: UVec2, crossing: Option<usize>, origin: DVec3) -> Self {
        Self {
            origin: origin.to_array(),
            eye: camera.exact_eye().to_array(),
            right: camera.right().to_array(),
            up: camera.up().to_array(),
            back: camera.back().to_array(),
            projection: match camera.projection() {
                Projection::Perspective { fov_y_radians } => {
                    PickProjection::Perspective { fov_y_radians }
                }
                Projection::Orthographic { height } => PickProjection::Orthographic { height },
            },
            size: camera.resolution().to_array(),
            pixel: pixel.to_array(),
            crossing,
            side: Side::A,
        }
    }

    /// The same pixel on a side of a comparison.
    #[must_use]
    pub fn on(self, side: Side) -> Self {
        Self { side, ..self }
    }

    /// The pixel.
    pub fn pixel(&self) -> UVec2 {
        self.pixel.into()
    }

    /// The camera in a scene with this origin; exactly the same one if the origin is the same.
    ///
    /// # Errors
    /// Why there is no such camera.
    pub fn camera(&self, origin: DVec3) -> Result<Camera, String> {
        let axes = [self.right, self.up, self.back].map(DVec3::from_array);
        let projection = match self.projection {
            PickProjection::Perspective { fov_y_radians } => {
                Projection::Perspective { fov_y_radians }
            }
            PickProjection::Orthographic { height } => Projection::Orthographic { height },
        };
        let eye = DVec3::from_array(self.eye) + (DVec3::from_array(self.origin) - origin);
        let axes = DMat3::from_cols_array_2d(&axes.map(DVec3::into));
        let camera = Camera::from_axes(eye, axes, projection, self.size.into());
        camera.map_err(|error| format!("a pick: {error}"))
    }

    pub(super) fn check(&self) -> Result<(), String> {
        self.camera(DVec3::from_array(self.origin))?;
        if self.pixel().cmpge(self.size.into()).any() {
            return Err("a pick: the pixel is outside the picture".to_owned());
        }
        Ok(())
    }
}
