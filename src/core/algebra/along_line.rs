//! The equations of a shape along a line, rounded to f64 for display.

use super::dyadic::Dyadic;
use super::exact_piece::ExactPiece;
use super::pieces::{Piece, Pieces, RayIn};
use crate::ray::Ray;

/// The equation of one part of a shape's surface along a line: a polynomial in t that is 0 where the line meets it.
#[derive(Clone, Debug, PartialEq)]
pub struct LineEquation {
    /// The part, as an index into [`ShapeInfo::equations`](crate::shape::ShapeInfo::equations).
    pub part: u8,
    /// The coefficients in ascending order of powers of t, each with an error of at most an ulp.
    pub coefficients: Vec<f64>,
    /// All real roots in ascending order, also those outside the ray's interval.
    pub roots: Vec<LineRoot>,
}

/// A root of a [`LineEquation`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineRoot {
    /// t, correctly rounded.
    pub t: f64,
    /// Whether the point belongs to the shape. It doesn't if it lies beyond the end of a cylinder, for example.
    pub is_on_shape: bool,
}

/// The equations of all parts of a shape, with a ray's line substituted.
pub fn line_equations<P: Pieces>(ray: &Ray, shape: &P) -> Vec<LineEquation> {
    let mut equations = Vec::new();
    shape.pieces(&RayIn::of(ray), &mut |piece: Piece<Dyadic>| {
        let piece = ExactPiece::new(&piece);
        let coefficients = piece.surface.significant().iter().map(|coefficient| {
            let bounds = coefficient.enclosure();
            0.5 * bounds.lo + 0.5 * bounds.hi
        });
        let roots = piece.roots().into_iter().map(|root| {
            let mut t = root.value;
            let bounds = t.enclosure();
            LineRoot {
                is_on_shape: piece.contains(&t, bounds),
                t: t.nearest_f64(),
            }
        });
        equations.push(LineEquation {
            part: piece.part,
            coefficients: coefficients.collect(),
            roots: roots.collect(),
        });
    });
    equations
}
