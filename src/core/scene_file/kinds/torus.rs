//! Tori.

use super::Kind;
use crate::scene_file::problem::Problem;
use crate::scene_file::reader::Reader;
use crate::scene_file::shapes::Parts;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;
use glam::DVec3;

/// A torus.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// Its centre.
    pub center: DVec3,
    /// Its axis of revolution, of any length except 0.
    pub axis: DVec3,
    /// The radius of the circle of revolution.
    pub major: f64,
    /// The radius of the tube.
    pub minor: f64,
}

impl Kind for Torus {
    const NAME: &'static str = "torus";

    fn read(parts: &mut Parts, _: &mut Reader) -> Result<Self, Problem> {
        let parameters = &mut parts.parameters;
        Ok(Self {
            center: parameters.point("center", DVec3::ZERO)?,
            axis: parameters.direction("axis", DVec3::Z)?,
            major: parameters.positive("major", 1.0)?,
            minor: parameters.positive("minor", 0.25)?,
        })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        writer.point("center", self.center)?;
        writer.vector("axis", self.axis)?;
        writer.float("major", self.major)?;
        writer.float("minor", self.minor)
    }
}
