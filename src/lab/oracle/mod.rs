//! The oracle: exact intersections in integers of any size. It doesn't round, and shares no formula with the
//! kernels.

mod fraction;
mod triangle;

pub use fraction::Fraction;
pub use triangle::{Crossing, ExactHit, crossings, intersect, nearest};
