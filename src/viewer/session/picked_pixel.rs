//! A pick of the list as plain data.

use crate::comparison::Side;
use crate::picks;
use glam::{DMat3, DVec3, UVec2};
use hitscope_core::Camera;
use hitscope_core::camera::Projection;
use serde::{Deserialize, Serialize};
use std::ops::Not;

/// The largest number of a pick in a session. It is far below `u32::MAX`, so that the numbers of later picks don't
/// overflow.
const MAX_NUMBER: u32 = 1_000_000_000;

/// A picked pixel, with the camera of the picture that was clicked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PickedPixel {
    /// Its number in the list; 0 if it has none yet.
    #[serde(default)]
    pub number: u32,
    /// The name that the user gave it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub name: String,
    /// Whether it stays when another pixel is picked.
    #[serde(default, skip_serializing_if = "Not::not")]
    pub is_pinned: bool,
    /// Whether it is the one that is inspected. Sessions with a single pick may lack this.
    #[serde(default = "yes")]
    pub is_selected: bool,
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

fn yes() -> bool {
    true
}

impl PickedPixel {
    /// A pick that isn't selected, in a scene with this origin.
    pub fn new(pick: &picks::PickedPixel, origin: DVec3) -> Self {
        let camera = &pick.camera;
        Self {
            number: pick.number,
            name: pick.name.clone(),
            is_pinned: pick.is_pinned,
            is_selected: false,
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
            pixel: pick.pixel.to_array(),
            crossing: None,
            side: pick.side,
        }
    }

    /// The same pick, selected, with the crossing that is marked instead of the hit.
    #[must_use]
    pub fn selected(self, crossing: Option<usize>) -> Self {
        Self {
            is_selected: true,
            crossing,
            ..self
        }
    }

    /// The pick in a scene with this origin.
    ///
    /// # Errors
    /// Why there is no such camera.
    pub fn in_scene(&self, origin: DVec3) -> Result<picks::PickedPixel, String> {
        Ok(picks::PickedPixel {
            number: self.number,
            name: self.name.clone(),
            is_pinned: self.is_pinned,
            side: self.side,
            camera: self.camera(origin)?,
            pixel: self.pixel(),
        })
    }

    /// Whether both are inspected in the same way: they may differ in number, name and pin.
    pub fn is_inspected_as(&self, other: &Self) -> bool {
        let unlisted = |pick: &Self| Self {
            number: 0,
            name: String::new(),
            is_pinned: false,
            ..pick.clone()
        };
        unlisted(self) == unlisted(other)
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
        if self.number > MAX_NUMBER {
            return Err(format!("a pick: its number is larger than {MAX_NUMBER}"));
        }
        Ok(())
    }
}
