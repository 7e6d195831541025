//! Cylinders and cones.

use super::Kind;
use crate::scene_file::parameters::Parameters;
use crate::scene_file::problem::Problem;
use crate::scene_file::reader::Reader;
use crate::scene_file::shapes::Parts;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;
use glam::DVec3;

/// A cylinder, open unless it is capped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// The centre of one end.
    pub p0: DVec3,
    /// The centre of the other end.
    pub p1: DVec3,
    /// Its radius.
    pub radius: f64,
    /// Whether disks close its ends.
    pub is_capped: bool,
}

/// A cone, open unless it is capped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The centre of its base.
    pub p0: DVec3,
    /// Its apex.
    pub p1: DVec3,
    /// The radius of its base.
    pub radius: f64,
    /// Whether a disk closes its base.
    pub is_capped: bool,
}

impl Kind for Cylinder {
    const NAME: &'static str = "cylinder";

    fn read(parts: &mut Parts, _: &mut Reader) -> Result<Self, Problem> {
        let ([p0, p1], radius, is_capped) = read(&mut parts.parameters)?;
        Ok(Self {
            p0,
            p1,
            radius,
            is_capped,
        })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        write([self.p0, self.p1], self.radius, self.is_capped, writer)
    }
}

impl Kind for Cone {
    const NAME: &'static str = "cone";

    fn read(parts: &mut Parts, _: &mut Reader) -> Result<Self, Problem> {
        let ([p0, p1], radius, is_capped) = read(&mut parts.parameters)?;
        Ok(Self {
            p0,
            p1,
            radius,
            is_capped,
        })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        write([self.p0, self.p1], self.radius, self.is_capped, writer)
    }
}

/// The ends of the axis, the radius, and whether it is capped.
fn read(parameters: &mut Parameters) -> Result<([DVec3; 2], f64, bool), Problem> {
    let p0 = parameters.point("p0", DVec3::ZERO)?;
    let p1 = parameters.point("p1", DVec3::Z)?;
    if p0 == p1 {
        return Err(parameters.problem("p0 and p1 are the same point"));
    }
    let radius = parameters.positive("radius", 1.0)?;
    let is_capped = parameters.boolean("capped", false)?;
    Ok(([p0, p1], radius, is_capped))
}

fn write(
    [p0, p1]: [DVec3; 2],
    radius: f64,
    is_capped: bool,
    writer: &mut Writer,
) -> Result<(), WriteError> {
    writer.point("p0", p0)?;
    writer.point("p1", p1)?;
    writer.float("radius", radius)?;
    // Mitsuba has no such parameter.
    if is_capped {
        writer.boolean("capped", true)?;
    }
    Ok(())
}
