//! The description of a sensor: a camera and its film.

use super::description::Place;
use glam::DMat4;

/// A sensor.
///
/// It looks along +z of its own coordinates, with y up and x to the **left**, as in Mitsuba.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensor {
    /// The start of its element.
    pub place: Place,
    /// The `id` attribute.
    pub id: Option<String>,
    /// The projection.
    pub kind: SensorKind,
    /// From the sensor's coordinates to the world. May contain a scale, which Mitsuba refuses except in
    /// `orthographic`.
    pub to_world: DMat4,
    /// The size of the picture.
    pub film: Film,
    /// Samples per pixel.
    pub sample_count: u32,
}

/// The projection of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SensorKind {
    /// A pinhole camera.
    Perspective(FieldOfView),
    /// Parallel rays. The picture spans x from −1 to 1 of the sensor's coordinates, and y in proportion, so that the
    /// scale of `to_world` determines its extent.
    Orthographic,
    /// A camera with a thin lens.
    ThinLens {
        /// The field of view.
        fov: FieldOfView,
        /// The radius of the lens.
        aperture_radius: f64,
        /// The distance along z of the plane in focus.
        focus_distance: f64,
    },
}

/// An angle of view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOfView {
    /// The angle in degrees, between 0 and 180.
    pub degrees: f64,
    /// Where the angle is measured.
    pub axis: FovAxis,
}

/// The axis along which a field of view is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FovAxis {
    /// From the left edge to the right edge.
    X,
    /// From the upper edge to the lower edge.
    Y,
    /// From corner to corner.
    Diagonal,
    /// The shorter of width and height.
    Smaller,
    /// The longer of width and height.
    Larger,
}

/// The size of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Film {
    /// Its width in pixels.
    pub width: u32,
    /// Its height in pixels.
    pub height: u32,
    /// The part that is rendered; `None` if it is the whole.
    pub crop: Option<Crop>,
}

impl Default for Film {
    /// Mitsuba's default.
    fn default() -> Self {
        Self {
            width: 768,
            height: 576,
            crop: None,
        }
    }
}

/// A part of a film, in pixels from the top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// The left edge.
    pub x: u32,
    /// The upper edge.
    pub y: u32,
    /// Its width.
    pub width: u32,
    /// Its height.
    pub height: u32,
}
