//! What does exact arithmetic say? Integers of any size; no rounding, no formula of the kernels.

mod fraction;
mod triangle;

pub use fraction::Fraction;
pub use triangle::{Crossing, ExactHit, crossings, intersect, nearest};
