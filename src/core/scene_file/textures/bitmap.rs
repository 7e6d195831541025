//! Pictures.

use super::Kind;
use crate::mesh::{Filter, Wrap};
use crate::scene_file::element::Element;
use crate::scene_file::kinds::name_of;
use crate::scene_file::parameters::Parameters;
use crate::scene_file::problem::{Problem, quoted, unknown};
use crate::scene_file::reader::Reader;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;
use std::path::PathBuf;

/// A picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bitmap {
    /// The path of the picture, as seen from the directory of the program.
    pub file: PathBuf,
    /// Whether texels are proportional to the value instead of sRGB.
    pub is_raw: bool,
    /// Values between texel centres.
    pub filter: Filter,
    /// Values beyond the picture.
    pub wrap: Wrap,
}

const FILTERS: [(&str, Filter); 2] = [("bilinear", Filter::Bilinear), ("nearest", Filter::Nearest)];
const WRAPS: [(&str, Wrap); 3] = [
    ("repeat", Wrap::Repeat),
    ("mirror", Wrap::Mirror),
    ("clamp", Wrap::Clamp),
];

impl Kind for Bitmap {
    const NAME: &'static str = "bitmap";

    fn read(
        parameters: &mut Parameters,
        element: Element,
        reader: &mut Reader,
    ) -> Result<Self, Problem> {
        let Some((name, place)) = parameters.text("filename")? else {
            return Err(parameters.problem("parameter “filename” is missing"));
        };
        let file = reader.data_file(&name, element, place)?;
        reader
            .memory
            .take(2 * file.as_os_str().len() as u64, place)?;
        // They change how Mitsuba stores and looks up texels.
        parameters.text("format")?;
        parameters.boolean("accel", true)?;
        Ok(Self {
            file,
            is_raw: parameters.boolean("raw", false)?,
            filter: one_of(parameters, "filter_type", &FILTERS)?,
            wrap: one_of(parameters, "wrap_mode", &WRAPS)?,
        })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        writer.text("filename", &name_of(&self.file, writer.folder)?)?;
        if self.is_raw {
            writer.boolean("raw", true)?;
        }
        if let Some((name, _)) = FILTERS[1..].iter().find(|(_, f)| *f == self.filter) {
            writer.text("filter_type", name)?;
        }
        if let Some((name, _)) = WRAPS[1..].iter().find(|(_, w)| *w == self.wrap) {
            writer.text("wrap_mode", name)?;
        }
        Ok(())
    }
}

/// A named value; the first one by default.
fn one_of<T: Copy>(
    parameters: &mut Parameters,
    name: &'static str,
    values: &[(&str, T)],
) -> Result<T, Problem> {
    let Some((text, place)) = parameters.text(name)? else {
        return Ok(values[0].1);
    };
    let found = values.iter().find(|(known, _)| *known == text);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let known: Vec<&str> = values.iter().map(|(known, _)| *known).collect();
        Problem::at(place, unknown(&quoted(name), &text, &known))
    })
}
