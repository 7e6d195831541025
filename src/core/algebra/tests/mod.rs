//! Tests of the exact arithmetic.

/// Crossings of rays with shapes: intervals against exact numbers.
mod crossings;
/// Intervals and dyadic numbers.
mod numbers;
/// Roots in plain f64 against exact numbers.
mod quick_line;
/// Crossings with rectangles and disks in plain f64 against exact numbers.
mod quick_span;
/// Roots of polynomials, exact and in intervals.
mod roots;
/// A sphere, a cylinder and a torus as pieces.
mod shapes;
/// The time that crossings take; run by hand.
mod speed;
