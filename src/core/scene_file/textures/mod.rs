//! Textures: `<texture>` elements, a file per kind and a row of the table.
//!
//! A new kind needs such a file, a row, and its conversion in `loading/textures`.

mod bitmap;
mod checkerboard;

pub use bitmap::Bitmap;
pub use checkerboard::Checkerboard;

use super::description::Place;
use super::element::Element;
use super::memory::bytes_per_map_entry;
use super::objects::{self, Head};
use super::parameters::Parameters;
use super::problem::{Problem, quoted, unknown};
use super::properties;
use super::reader::Reader;
use super::writer::Writer;
use super::xml::WriteError;
use glam::{DAffine2, DMat2, DMat4, Vec4Swizzles as _};
use std::collections::HashMap;

/// Other textures of Mitsuba 3.9.1.
const UNSUPPORTED: [&str; 2] = ["mesh_attribute", "volume"];

/// A texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The start of its element.
    pub place: Place,
    /// The kind with its parameters.
    pub kind: TextureKind,
    /// From the surface's texture coordinates to the texture's, whose second coordinate points down.
    pub to_uv: DAffine2,
}

impl Texture {
    /// The memory of its path.
    pub(super) fn path_bytes(&self) -> usize {
        match &self.kind {
            TextureKind::Bitmap(bitmap) => bitmap.file.as_os_str().len(),
            TextureKind::Checkerboard(_) => 0,
        }
    }
}

/// The parameters of a kind of texture.
trait Kind: Sized {
    /// The `type` attribute.
    const NAME: &'static str;

    /// Takes the parameters, or their defaults, of an element.
    ///
    /// # Errors
    /// A parameter is missing or isn't valid.
    fn read(
        parameters: &mut Parameters,
        element: Element,
        reader: &mut Reader,
    ) -> Result<Self, Problem>;

    /// Writes the parameters.
    ///
    /// # Errors
    /// A name has no form in the format.
    fn write(&self, writer: &mut Writer) -> Result<(), WriteError>;
}

type Read = fn(&mut Parameters, Element, &mut Reader) -> Result<TextureKind, Problem>;

macro_rules! texture_kinds {
    ($($(#[$doc:meta])* $kind:ident,)*) => {
        /// A kind of texture with its parameters.
        #[derive(Clone, Debug, PartialEq)]
        pub enum TextureKind {
            $($(#[$doc])* $kind($kind),)*
        }

        /// The names of all kinds, and how they are read.
        const KINDS: &[(&str, Read)] = &[$((
            $kind::NAME,
            |parameters, element, reader| {
                Ok(TextureKind::$kind($kind::read(parameters, element, reader)?))
            },
        ),)*];

        impl TextureKind {
            fn name(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => $kind::NAME,)*
                }
            }

            fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
                match self {
                    $(Self::$kind(kind) => kind.write(writer),)*
                }
            }
        }
    };
}

texture_kinds! {
    /// A picture.
    Bitmap,
    /// A checkerboard.
    Checkerboard,
}

/// The textures with identifiers, defined so far; `None` for those that aren't supported.
#[derive(Default)]
pub(super) struct Textures(HashMap<String, Option<Texture>>);

/// A texture that stands in another object.
pub(super) struct Nested {
    pub place: Place,
    /// The `name` attribute.
    pub name: String,
    /// `None` if it isn't supported.
    pub texture: Option<Texture>,
}

/// Reads a texture of the scene, to which others refer.
pub(super) fn define(reader: &mut Reader, element: Element) -> Result<(), Problem> {
    texture(reader, element)?;
    Ok(())
}

/// A texture; `None`, with a warning, for those of Mitsuba's that aren't supported.
fn texture(reader: &mut Reader, element: Element) -> Result<Option<Texture>, Problem> {
    let head = Head::of(reader, element)?;
    let found = known(reader, element, &head.kind)?;
    if let Some(id) = head.id {
        let path = found.as_ref().map_or(0, Texture::path_bytes);
        let bytes = bytes_per_map_entry::<(String, Option<Texture>)>() + 2 * id.len() + path;
        reader.memory.take(bytes as u64, element.place)?;
        reader.textures.0.insert(id, found.clone());
    }
    Ok(found)
}

fn known(reader: &mut Reader, element: Element, kind: &str) -> Result<Option<Texture>, Problem> {
    if UNSUPPORTED.contains(&kind) {
        let message = format!("texture {} isn't supported", quoted(kind));
        reader.warnings.add(element.place, message);
        return Ok(None);
    }
    let Some((_, read)) = KINDS.iter().find(|(name, _)| *name == kind) else {
        let names = KINDS.iter().map(|(name, _)| *name);
        let names: Vec<&str> = names.chain(UNSUPPORTED).collect();
        return Err(element.problem(unknown("texture", kind, &names)));
    };
    let mut parameters = Parameters::new("texture", kind, element.place);
    reader.each_child(
        element,
        &mut |reader, child| match properties::parameter(reader, child)? {
            Some(parameter) => parameters.add(parameter),
            None if child.tag() == "ref" => {
                objects::reference(reader, child)?;
                let message = format!("{}: a nested texture isn't used", parameters.object());
                reader.warnings.add(child.place, message);
                Ok(())
            }
            None => objects::skip(reader, child, &parameters.object()),
        },
    )?;
    let kind = read(&mut parameters, element, reader)?;
    let to_uv = parameters.transform("to_uv")?;
    parameters.finish(&mut reader.memory)?;
    let bytes = 2 * size_of::<Texture>() as u64;
    reader.memory.take(bytes, element.place)?;
    Ok(Some(Texture {
        place: element.place,
        kind,
        to_uv: in_plane(to_uv),
    }))
}

/// The part of a transform in the plane z = 0.
fn in_plane(transform: DMat4) -> DAffine2 {
    let linear = DMat2::from_cols(transform.x_axis.xy(), transform.y_axis.xy());
    DAffine2::from_mat2_translation(linear, transform.w_axis.xy())
}

/// A nested texture, or the one that a nested reference names, which must be defined before; `None` for other elements
/// and for references to other objects.
///
/// # Errors
/// The texture isn't valid.
pub(super) fn nested(reader: &mut Reader, child: Element) -> Result<Option<Nested>, Problem> {
    let texture = match child.tag() {
        "texture" => texture(reader, child)?,
        "ref" => {
            let id = objects::reference(reader, child)?;
            match reader.textures.0.get(&id) {
                Some(found) => found.clone(),
                None => return Ok(None),
            }
        }
        _ => return Ok(None),
    };
    let path = texture.as_ref().map_or(0, Texture::path_bytes);
    let bytes = 2 * size_of::<Nested>() + path;
    reader.memory.take(bytes as u64, child.place)?;
    let name = child.attribute("name", &reader.defaults)?;
    Ok(Some(Nested {
        place: child.place,
        name: name.unwrap_or_default().into_owned(),
        texture,
    }))
}

impl Writer<'_> {
    /// Writes a texture that is the value of a parameter.
    ///
    /// # Errors
    /// A name has no form in the format.
    pub(super) fn texture(&mut self, name: &str, texture: &Texture) -> Result<(), WriteError> {
        let attributes = [("type", texture.kind.name()), ("name", name)];
        self.xml.open("texture", &attributes)?;
        texture.kind.write(self)?;
        if texture.to_uv != DAffine2::IDENTITY {
            let DAffine2 {
                matrix2,
                translation,
            } = texture.to_uv;
            let mut transform = DMat4::IDENTITY;
            transform.x_axis = matrix2.x_axis.extend(0.0).extend(0.0);
            transform.y_axis = matrix2.y_axis.extend(0.0).extend(0.0);
            transform.w_axis = translation.extend(0.0).extend(1.0);
            self.transform("to_uv", transform)?;
        }
        self.xml.close();
        Ok(())
    }
}
