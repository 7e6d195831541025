//! What the user chooses about the colours of views.

use crate::colour::ColourMap;
use crate::srgb::from_display;
use glam::Vec3;

/// Choices about the colours of views. By default there are none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ViewOptions {
    /// The colour, in linear RGB, that is mixed into back faces in the view *Shaded*. Back faces that a clip opens have
    /// [`back_face_colour`] without it.
    pub back_face_tint: Option<Vec3>,
    /// The scale of views of numbers.
    pub scale: ScaleOptions,
}

/// Choices about the scale of a view of numbers. `None` leaves a choice to the view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScaleOptions {
    /// The colour map.
    pub map: Option<&'static ColourMap>,
    /// The numbers with the first and the last colour.
    pub range: Option<[f64; 2]>,
    /// Whether equal factors, and not equal differences, are equally far apart.
    pub is_logarithmic: Option<bool>,
}

/// The colour of back faces, in linear RGB: vermilion.
///
/// Source: Okabe, Ito, "Color Universal Design", 2008, a palette for people with any colour vision.
pub fn back_face_colour() -> Vec3 {
    from_display(Vec3::new(213.0, 94.0, 0.0) / 255.0)
}

/// The colour of front faces in the view *Orientation*, in linear RGB: blue, of the same palette.
pub(super) fn front_face_colour() -> Vec3 {
    from_display(Vec3::new(0.0, 114.0, 178.0) / 255.0)
}
