//! The oracle: exact intersections in integers of any size. It doesn't round, and shares no formula with the
//! kernels.
//!
//! | module | content |
//! |---|---|
//! | `triangle` | triangles |
//! | `flat`, `aligned` | planes, disks, rectangles, boxes |
//! | `round` | spheres, cylinders, cones, quadrics |
//! | `torus` | tori |
//! | `shapes`, `exact_t` | the interface for all shapes, and exact values of t |
//! | `enclosing` | points inside and outside closed shapes |
//! | `solid` | combined solids |
//! | `fraction`, `surd`, `isolated` | rational numbers, roots of degree 2, roots of any degree |
//! | `quadratic`, `polynomial` | polynomials of degree 2, and of any degree |

mod aligned;
mod enclosing;
mod exact_t;
mod flat;
mod fraction;
mod isolated;
mod polynomial;
mod quadratic;
mod round;
mod shapes;
mod solid;
mod surd;
mod torus;
mod triangle;

pub use enclosing::{Enclosing, EnclosingShape};
pub use exact_t::ExactT;
pub use fraction::Fraction;
pub use shapes::{Oracle, crossings_in_f64};
pub use solid::{Division, OracleSolid};
pub use triangle::{Crossing, ExactHit, crossings, intersect, nearest};
