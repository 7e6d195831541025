//! Cubes and boxes.

use super::Kind;
use crate::scene_file::parameters::Parameters;
use crate::scene_file::problem::Problem;
use crate::scene_file::reader::Reader;
use crate::scene_file::shapes::Parts;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;
use glam::DVec3;

/// The cube from (−1, −1, −1) to (1, 1, 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cube;

/// A box with edges along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// Its lowest corner.
    pub min: DVec3,
    /// Its highest corner.
    pub max: DVec3,
}

impl Kind for Cube {
    const NAME: &'static str = "cube";

    fn read(_: &mut Parts, _: &mut Reader) -> Result<Self, Problem> {
        Ok(Self)
    }

    fn write(&self, _: &mut Writer) -> Result<(), WriteError> {
        Ok(())
    }
}

impl Kind for Cuboid {
    const NAME: &'static str = "box";

    fn read(parts: &mut Parts, _: &mut Reader) -> Result<Self, Problem> {
        let [min, max] = corners(&mut parts.parameters)?;
        Ok(Self { min, max })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        write_corners(writer, [self.min, self.max])
    }
}

/// The lowest and the highest corner of a box.
pub(super) fn corners(parameters: &mut Parameters) -> Result<[DVec3; 2], Problem> {
    let min = parameters.point("min", DVec3::NEG_ONE)?;
    let max = parameters.point("max", DVec3::ONE)?;
    if !min.cmplt(max).all() {
        return Err(parameters.problem("“min” must be less than “max” in each coordinate"));
    }
    Ok([min, max])
}

pub(super) fn write_corners(writer: &mut Writer, [min, max]: [DVec3; 2]) -> Result<(), WriteError> {
    writer.point("min", min)?;
    writer.point("max", max)
}
