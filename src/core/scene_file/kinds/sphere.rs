//! Spheres.

use super::Kind;
use crate::scene_file::problem::Problem;
use crate::scene_file::reader::Reader;
use crate::scene_file::shapes::Parts;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;
use glam::DVec3;

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its centre.
    pub center: DVec3,
    /// Its radius.
    pub radius: f64,
}

impl Kind for Sphere {
    const NAME: &'static str = "sphere";

    fn read(parts: &mut Parts, _: &mut Reader) -> Result<Self, Problem> {
        Ok(Self {
            center: parts.parameters.point("center", DVec3::ZERO)?,
            radius: parts.parameters.positive("radius", 1.0)?,
        })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        writer.point("center", self.center)?;
        writer.float("radius", self.radius)
    }
}
