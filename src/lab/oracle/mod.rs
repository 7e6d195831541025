//! The oracle: exact intersections in integers of any size. It doesn't round, and shares no formula with the
//! kernels.

mod fraction;
mod sphere;
mod triangle;

pub use fraction::Fraction;
pub use sphere::sphere_crossings;
pub use triangle::{Crossing, ExactHit, crossings, intersect, nearest};
