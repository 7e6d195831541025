//! Disks and rectangles.

use super::Kind;
use crate::scene_file::problem::Problem;
use crate::scene_file::reader::Reader;
use crate::scene_file::shapes::Parts;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;

/// The unit disk in the plane z = 0, facing +z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Disk;

/// The square from (−1, −1, 0) to (1, 1, 0), facing +z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rectangle;

impl Kind for Disk {
    const NAME: &'static str = "disk";

    fn read(_: &mut Parts, _: &mut Reader) -> Result<Self, Problem> {
        Ok(Self)
    }

    fn write(&self, _: &mut Writer) -> Result<(), WriteError> {
        Ok(())
    }
}

impl Kind for Rectangle {
    const NAME: &'static str = "rectangle";

    fn read(_: &mut Parts, _: &mut Reader) -> Result<Self, Problem> {
        Ok(Self)
    }

    fn write(&self, _: &mut Writer) -> Result<(), WriteError> {
        Ok(())
    }
}
