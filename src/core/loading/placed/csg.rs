//! Combined solids.

use super::{Groups, Look, Placeable, Placed, Refusal, placed};
use crate::group::{CsgOperation, Solid};
use crate::loading::memory::{BYTES_PER_ALLOCATION, Needs};
use crate::scene_file::{self, Place, Shape};
use glam::{DMat4, DVec3};

#[derive(Debug)]
struct PlacedSolid {
    place: Place,
    operation: CsgOperation,
    operands: Vec<Box<dyn Placed>>,
}

impl Placeable for scene_file::Csg {
    /// # Errors
    /// A nested shape can't be placed or isn't a solid.
    fn placed(&self, shape: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let operand = |shape: &Shape| {
            let operand = placed(shape, &(*to_world * shape.to_world))?;
            let refused = |message| Refusal::new(shape.place, message);
            operand.check_closed().map_err(refused)?;
            Ok(operand)
        };
        Ok(Box::new(PlacedSolid {
            place: shape.place,
            operation: self.operation,
            operands: self
                .children
                .iter()
                .map(operand)
                .collect::<Result<_, _>>()?,
        }))
    }
}

impl Placed for PlacedSolid {
    /// Near the surface if the operands that matter are bounded: a box around the first operand of a difference, or in
    /// all bounded operands of an intersection. Else around all bounded operands.
    fn bounds(&self) -> Option<[DVec3; 2]> {
        let boxes = || self.operands.iter().filter_map(|operand| operand.bounds());
        let around_all = || boxes().reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
        let nearest = match self.operation {
            CsgOperation::Union => None,
            CsgOperation::Intersection => boxes()
                .reduce(|[a, b], [c, d]| [a.max(c), b.min(d)])
                .filter(|[min, max]| min.cmple(*max).all()),
            CsgOperation::Difference => self.operands.first().and_then(|first| first.bounds()),
        };
        nearest.or_else(around_all)
    }

    fn push_to(&self, groups: &mut Groups, origin: DVec3, look: Look) {
        let solid = self.solid(origin, &mut groups.empty);
        groups.solids.push(solid, look);
    }

    fn check_closed(&self) -> Result<(), String> {
        Ok(())
    }

    fn solid(&self, origin: DVec3, empty: &mut Vec<Place>) -> Solid {
        let known = empty.len();
        let operands = self.operands.iter();
        let operands = operands.map(|operand| operand.solid(origin, empty));
        let solid = Solid::combined(self.operation, operands.collect());
        let has_empty_box = solid.bounds().is_some_and(|bounds| bounds.is_empty());
        if has_empty_box && empty.len() == known {
            empty.push(self.place);
        }
        solid
    }

    fn fits(&self, origin: DVec3) -> bool {
        self.operands.iter().all(|operand| operand.fits(origin))
    }

    fn needs(&self) -> Needs {
        let of_operand =
            |operand: &dyn Placed| operand.needs().placed + size_of::<Box<dyn Placed>>() as u64;
        let operands: u64 = self
            .operands
            .iter()
            .map(|operand| of_operand(&**operand))
            .sum();
        Needs {
            placed: operands + (size_of::<Self>() + BYTES_PER_ALLOCATION) as u64,
            shapes: Solid::bytes(self.operand_count()),
            primitive_count: 1,
            ..Needs::default()
        }
    }

    fn operand_count(&self) -> usize {
        let counts = self.operands.iter().map(|operand| operand.operand_count());
        counts.sum()
    }
}
