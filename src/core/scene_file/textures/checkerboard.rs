//! Checkerboards.

use super::Kind;
use crate::scene_file::bsdfs::reflectance;
use crate::scene_file::element::Element;
use crate::scene_file::parameters::Parameters;
use crate::scene_file::problem::Problem;
use crate::scene_file::reader::Reader;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;
use glam::DVec3;

/// Four fields between the coordinates 0 and 1, repeated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkerboard {
    /// The colours, linear RGB from 0 to 1: the first where both coordinates are in the same half.
    pub colours: [DVec3; 2],
}

impl Kind for Checkerboard {
    const NAME: &'static str = "checkerboard";

    fn read(parameters: &mut Parameters, _: Element, _: &mut Reader) -> Result<Self, Problem> {
        Ok(Self {
            colours: [
                reflectance(parameters, "color0", 0.4)?,
                reflectance(parameters, "color1", 0.2)?,
            ],
        })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        writer.colour("color0", self.colours[0])?;
        writer.colour("color1", self.colours[1])
    }
}
