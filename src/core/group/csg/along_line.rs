//! The intervals of a line inside a solid, for display.

use super::crossings::PackedSolid;
use super::kernels::kernel_of;
use super::solid::Solid;
use crate::kernel::{KernelChoice, Tier};
use crate::ray::Ray;
use crate::simd::SimdLevel;

/// The intervals of a line inside a part of a solid.
#[derive(Clone, Debug, PartialEq)]
pub struct LineIntervals {
    /// Whether the line is inside at t = −∞.
    pub starts_inside: bool,
    /// t of all ends in ascending order, correctly rounded to f64.
    pub ends: Vec<f64>,
}

impl LineIntervals {
    /// The intervals in ascending order. An end may be infinite.
    pub fn list(&self) -> Vec<[f64; 2]> {
        let start = self.starts_inside.then_some(f64::NEG_INFINITY);
        let mut ends: Vec<f64> = start.into_iter().chain(self.ends.iter().copied()).collect();
        if ends.len() % 2 == 1 {
            ends.push(f64::INFINITY);
        }
        ends.chunks_exact(2)
            .map(|pair| [pair[0], pair[1]])
            .collect()
    }
}

impl Solid {
    /// The intervals of a ray's whole line inside each part of the solid, decided and ordered as in exact arithmetic. The
    /// root comes first, and each part before its own parts. The ray's interval is ignored.
    ///
    /// Source: Roth, "Ray Casting for Modeling Solids", 1982: an operation combines the intervals of its parts.
    pub fn intervals(&self, ray: &Ray) -> Vec<LineIntervals> {
        let exact = KernelChoice {
            info: kernel_of(Tier::Exact),
        };
        PackedSolid::new(self, exact, SimdLevel::current()).intervals(ray)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_may_be_infinite_on_either_side() {
        let list = |starts_inside, ends: &[f64]| {
            let ends = ends.to_vec();
            LineIntervals {
                starts_inside,
                ends,
            }
            .list()
        };
        let infinity = f64::INFINITY;
        assert_eq!(list(false, &[]), [[0.0; 2]; 0]);
        assert_eq!(list(true, &[]), [[-infinity, infinity]]);
        assert_eq!(list(false, &[1.0, 2.0, 3.0]), [[1.0, 2.0], [3.0, infinity]]);
        assert_eq!(list(true, &[1.0, 2.0]), [[-infinity, 1.0], [2.0, infinity]]);
    }
}
