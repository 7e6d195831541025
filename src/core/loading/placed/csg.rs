//! Combined solids.

use super::{Groups, Look, Placeable, Placed, Refusal, placed};
use crate::group::{CsgOperation, Solid};
use crate::scene_file::{self, Place, Shape};
use glam::{DMat4, DVec3};

#[derive(Debug)]
struct PlacedSolid {
    operation: CsgOperation,
    operands: Vec<Box<dyn Placed>>,
}

impl Placeable for scene_file::Csg {
    /// # Errors
    /// A nested shape can't be placed or isn't a solid.
    fn placed(&self, _: Place, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let operand = |shape: &Shape| {
            let operand = placed(shape, &(*to_world * shape.to_world))?;
            let refused = |message| Refusal::new(shape.place, message);
            operand.check_closed().map_err(refused)?;
            Ok(operand)
        };
        Ok(Box::new(PlacedSolid {
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
    /// The box around all operands that are bounded.
    fn bounds(&self) -> Option<[DVec3; 2]> {
        let boxes = self.operands.iter().filter_map(|operand| operand.bounds());
        boxes.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
    }

    fn push_to(&self, groups: &mut Groups, origin: DVec3, look: Look) {
        groups.solids.push(self.solid(origin), look);
    }

    fn check_closed(&self) -> Result<(), String> {
        Ok(())
    }

    fn solid(&self, origin: DVec3) -> Solid {
        let operands = self.operands.iter().map(|operand| operand.solid(origin));
        Solid::combined(self.operation, operands.collect())
    }
}
