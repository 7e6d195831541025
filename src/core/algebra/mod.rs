//! Exact arithmetic for the crossings of a ray with curved shapes.
//!
//! A shape states where a ray meets it as polynomials in t; see [`Pieces`]. Intervals of f64 decide most
//! questions about their roots, and integers of any size decide the rest.
//!
//! | module | contents |
//! |---|---|
//! | `ring` | the numbers that a shape's formulas are generic over, and vectors of them |
//! | `interval` | intervals of f64, rounded outwards |
//! | `dyadic` | exact numbers: an integer times a power of two |
//! | `polynomial` | polynomials of degree 4 at most over either kind of number |
//! | `interval_roots` | roots of a polynomial with interval coefficients |
//! | `remainders` | integer polynomials and their signed remainder sequences |
//! | `quick_line` | roots in plain f64 with a bound of their error |
//! | `quick_span` | the crossing with the plane of two half axes in plain f64, with a bound of its error |
//! | `isolation` | intervals that contain one root of an integer polynomial each |
//! | `algebraic` | exact roots: comparison, signs of polynomials, rounding |
//! | `pieces` | shapes as polynomials along a ray |
//! | `crossing` | crossings of a ray with a shape |
//! | `exact_piece` | a part of a shape's surface along a ray in exact numbers |
//! | `along_line` | a shape's equations along a line, for display |

mod algebraic;
mod along_line;
mod crossing;
mod dyadic;
mod exact_piece;
mod interval;
mod interval_roots;
mod isolation;
mod pieces;
mod polynomial;
mod quick_line;
mod quick_span;
mod remainders;
mod ring;

pub use algebraic::Algebraic;
pub use along_line::{LineEquation, LineRoot, line_equations};
pub use crossing::{Crossing, CrossingSolver, is_between};
pub use dyadic::Dyadic;
pub use interval_roots::RootIntervals;
pub use pieces::{Piece, Pieces, RayIn};
pub use polynomial::Polynomial;
pub use quick_line::QuickLine;
pub use quick_span::QuickSpan;
pub use ring::{Ring, cross, difference, dot, squared_length, vector};

#[cfg(test)]
mod tests;
