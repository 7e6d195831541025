//! Quadrics.

use super::Kind;
use super::cuboid::{corners, write_corners};
use crate::scene_file::problem::Problem;
use crate::scene_file::reader::Reader;
use crate::scene_file::shapes::Parts;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;
use glam::DVec3;

/// The names of the coefficients.
const NAMES: [&str; 10] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j"];

/// The part inside a box of the surface ax² + by² + cz² + 2dxy + 2eyz + 2fxz + 2gx + 2hy + 2iz + j = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadric {
    /// The coefficients a to j. In a box, so that other shapes don't need as much memory.
    pub coefficients: Box<[f64; 10]>,
    /// The lowest corner of the box.
    pub min: DVec3,
    /// The highest corner of the box.
    pub max: DVec3,
}

impl Kind for Quadric {
    const NAME: &'static str = "quadric";

    fn read(parts: &mut Parts, reader: &mut Reader) -> Result<Self, Problem> {
        let parameters = &mut parts.parameters;
        let mut coefficients = [0.0; 10];
        for (coefficient, name) in coefficients.iter_mut().zip(NAMES) {
            *coefficient = parameters.float(name)?.map_or(0.0, |(number, _)| number);
        }
        if coefficients[..9].iter().all(|&c| c == 0.0) {
            return Err(parameters.problem("the coefficients “a” to “i” are all zero"));
        }
        let [min, max] = corners(parameters)?;
        let bytes = size_of_val(&coefficients) as u64;
        reader.memory.take(bytes, parts.place)?;
        Ok(Self {
            coefficients: Box::new(coefficients),
            min,
            max,
        })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        for (name, value) in NAMES.into_iter().zip(*self.coefficients) {
            writer.float(name, value)?;
        }
        write_corners(writer, [self.min, self.max])
    }
}
