//! A piece of a shape in exact numbers.

use super::algebraic::{Algebraic, Root};
use super::dyadic::Dyadic;
use super::interval::Interval;
use super::pieces::{Piece, Pieces, RayIn};
use super::polynomial::Polynomial;
use super::ring::Ring as _;
use crate::ray::Ray;
use std::cmp::Ordering;

/// A piece of a shape in exact numbers.
pub(super) struct ExactPiece {
    pub part: u8,
    pub surface: Polynomial<Dyadic>,
    pub conditions: Vec<Polynomial<Dyadic>>,
}

impl ExactPiece {
    /// The piece with the given index. If the shape emits fewer, it has no roots.
    #[inline(never)]
    pub fn of<P: Pieces>(ray: &Ray, shape: &P, index: usize) -> Self {
        let mut result = Self {
            part: 0,
            surface: Polynomial::constant(Dyadic::zero()),
            conditions: Vec::new(),
        };
        let mut next = 0;
        shape.pieces(&RayIn::of(ray), &mut |piece: Piece<Dyadic>| {
            if next == index {
                result = Self::new(&piece);
            }
            next += 1;
        });
        result
    }

    pub fn new(piece: &Piece<Dyadic>) -> Self {
        Self {
            part: piece.part,
            surface: piece.surface.clone(),
            conditions: piece.conditions.to_vec(),
        }
    }

    pub fn roots(&self) -> Vec<Root> {
        Root::all(&self.surface)
    }

    /// Whether no condition is negative at `t`, which is within the bounds.
    pub fn contains(&self, t: &Algebraic, bounds: Interval) -> bool {
        let sign = |condition: &Polynomial<Dyadic>| {
            // The exact sign costs a sequence of remainders.
            let value = condition.enclosure().at(&bounds);
            value.sign().unwrap_or_else(|| t.sign_of(condition))
        };
        self.conditions
            .iter()
            .all(|condition| sign(condition) != Ordering::Less)
    }
}
