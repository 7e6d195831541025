//! What the user chooses about the colours of views.

use crate::colour::ColourMap;
use crate::srgb::from_display;
use glam::Vec3;
use std::sync::Arc;

/// Choices about the colours of views. By default there are none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ViewOptions {
    /// The colour, in linear RGB, that is mixed into back faces in the view *Shaded*. Back faces that a clip opens have
    /// [`back_face_colour`] without it.
    pub back_face_tint: Option<Vec3>,
    /// The scale of views of numbers.
    pub scale: ScaleOptions,
    /// Colours that replace those of materials in the view *Shaded*.
    pub surface_colours: Option<SurfaceColours>,
    /// Whether rays that hit nothing are black, whatever the background and the environment. Their pixels are transparent;
    /// see [`Alpha`](crate::picture::Alpha).
    pub has_transparent_background: bool,
}

/// Colours, in linear RGB, that replace the diffuse colours of some primitives.
#[derive(Clone, Debug)]
pub struct SurfaceColours {
    /// For each primitive the number of its colour, counted from 1; 0 if it keeps its own.
    numbers: Arc<Vec<u32>>,
    colours: Vec<Vec3>,
}

impl PartialEq for SurfaceColours {
    /// Compares the numbers by identity, because there are as many as primitives.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.numbers, &other.numbers) && self.colours == other.colours
    }
}

impl SurfaceColours {
    /// Colours, and for each primitive the number of its colour, counted from 1; 0, or a number without a colour,
    /// leaves the primitive's own.
    pub fn new(numbers: Vec<u32>, colours: Vec<Vec3>) -> Self {
        let numbers = Arc::new(numbers);
        Self { numbers, colours }
    }

    /// The same primitives with other colours.
    #[must_use]
    pub fn recoloured(self, colours: Vec<Vec3>) -> Self {
        Self { colours, ..self }
    }

    /// The colour of a primitive; `None` if it keeps its own.
    pub fn of(&self, primitive: u32) -> Option<Vec3> {
        let number = *self.numbers.get(primitive as usize)?;
        let index = number.checked_sub(1)?;
        self.colours.get(index as usize).copied()
    }
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
