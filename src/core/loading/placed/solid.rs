//! Combined solids.

use super::{Groups, Placed, Refusal, placed};
use crate::group::{CsgOperation, Solid};
use crate::scene_file::Shape;
use glam::{DMat4, DVec3};

#[derive(Debug)]
pub(super) struct PlacedSolid {
    operation: CsgOperation,
    operands: Vec<Box<dyn Placed>>,
}

impl PlacedSolid {
    /// # Errors
    /// A nested shape can't be placed or isn't a solid.
    pub fn new(
        operation: CsgOperation,
        shapes: &[Shape],
        to_world: &DMat4,
    ) -> Result<Self, Refusal> {
        let operand = |shape: &Shape| {
            let refused = |message: String| Refusal {
                place: shape.place,
                message,
            };
            let operand = placed(shape, &(*to_world * shape.to_world))?;
            let operand =
                operand.ok_or_else(|| refused("a mesh can't be part of a csg".to_owned()))?;
            operand.check_closed().map_err(refused)?;
            Ok(operand)
        };
        Ok(Self {
            operation,
            operands: shapes.iter().map(operand).collect::<Result<_, _>>()?,
        })
    }
}

impl Placed for PlacedSolid {
    /// The box around all operands that are bounded.
    fn bounds(&self) -> Option<[DVec3; 2]> {
        let boxes = self.operands.iter().filter_map(|operand| operand.bounds());
        boxes.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
    }

    fn push_to(&self, groups: &mut Groups, origin: DVec3, material: u32) {
        groups.solids.push(self.solid(origin), material);
    }

    fn check_closed(&self) -> Result<(), String> {
        Ok(())
    }

    fn solid(&self, origin: DVec3) -> Solid {
        let operands = self.operands.iter().map(|operand| operand.solid(origin));
        Solid::combined(self.operation, operands.collect())
    }
}
