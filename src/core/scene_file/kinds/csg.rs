//! Solids made of others.

use super::Kind;
use crate::group::CsgOperation;
use crate::scene_file::description::Shape;
use crate::scene_file::parameters::Parameters;
use crate::scene_file::problem::{Problem, unknown};
use crate::scene_file::reader::Reader;
use crate::scene_file::shapes::Parts;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;

/// A solid made of others.
#[derive(Clone, Debug, PartialEq)]
pub struct Csg {
    /// How the solids are combined.
    pub operation: CsgOperation,
    /// The solids; at least two.
    pub children: Vec<Shape>,
}

impl Kind for Csg {
    const NAME: &'static str = "csg";
    const HAS_CHILDREN: bool = true;

    fn read(parts: &mut Parts, reader: &mut Reader) -> Result<Self, Problem> {
        let operation = operation(&mut parts.parameters)?;
        let children = std::mem::take(&mut parts.children);
        if children.len() < 2 {
            return Err(parts
                .parameters
                .problem("at least two nested shapes are needed"));
        }
        for child in &children {
            warn_about(child, parts.material, reader);
        }
        Ok(Self {
            operation,
            children,
        })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        writer.property("string", "operation", self.operation.name())?;
        self.children
            .iter()
            .try_for_each(|child| writer.shape(child))
    }
}

fn operation(parameters: &mut Parameters) -> Result<CsgOperation, Problem> {
    let Some((name, place)) = parameters.text("operation")? else {
        return Err(parameters.problem("parameter “operation” is missing"));
    };
    let all = CsgOperation::ALL;
    let found = all.into_iter().find(|operation| operation.name() == name);
    let names = all.map(CsgOperation::name);
    found.ok_or_else(|| Problem::at(place, unknown("operation", &name, &names)))
}

/// Adds warnings about what has no effect in a nested shape: the whole surface has the material and the side of the
/// solid. `material` is the solid's.
fn warn_about(child: &Shape, material: Option<u32>, reader: &mut Reader) {
    if child.material.is_some() && child.material != material {
        let message = "the bsdf of a shape in a csg isn't used: the csg's own applies";
        reader.warnings.add(child.place, message.to_owned());
    }
    if child.flip_normals {
        let message = "flip_normals of a shape in a csg isn't used: the csg's own applies";
        reader.warnings.add(child.place, message.to_owned());
    }
}
