//! Texts of overlays. The window draws them over the picture; pictures without a window have none.

use glam::DVec3;

/// A text over the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Where it is drawn.
    pub place: Place,
    /// The text.
    pub text: String,
}

/// The place of a label.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Beside a point in the scene's coordinates.
    Point(DVec3),
    /// In the lower left corner of the picture, below earlier labels.
    Corner {
        /// Length of a horizontal bar beside the text, in pixels.
        bar_px: Option<f64>,
    },
}

impl Label {
    /// A text beside a point.
    pub fn at(point: DVec3, text: impl Into<String>) -> Self {
        Self {
            place: Place::Point(point),
            text: text.into(),
        }
    }
}
