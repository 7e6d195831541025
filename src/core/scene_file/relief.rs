//! Normal maps and bump maps: `normalmap` and `bumpmap` BSDFs.

use super::description::Material;
use super::element::Element;
use super::materials;
use super::objects;
use super::parameters::Parameters;
use super::problem::{Problem, quoted};
use super::properties;
use super::reader::Reader;
use super::side::Side;
use super::textures::{self, Nested, Texture};
use super::writer::Writer;
use super::xml::WriteError;

/// A texture that tilts the shading normal.
#[derive(Clone, Debug, PartialEq)]
pub struct Relief {
    /// The texture.
    pub texture: Texture,
    /// The meaning of its values.
    pub kind: ReliefKind,
}

/// The meaning of a relief's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReliefKind {
    /// `normalmap`: normals, 0…1 for −1…1.
    Normals,
    /// `bumpmap`: heights in the scene's unit.
    Heights {
        /// Multiplies the height.
        scale: f64,
    },
}

/// Adds the relief of a `bumpmap` or `normalmap` to both sides of the nested BSDF's material.
pub(super) fn read(
    reader: &mut Reader,
    element: Element,
    kind: &'static str,
) -> Result<Material, Problem> {
    let mut parameters = Parameters::new("bsdf", kind, element.place);
    let (inner, texture) = children(reader, element, &mut parameters)?;
    let relief_kind = if kind == "bumpmap" {
        let scale = parameters.float("scale")?;
        ReliefKind::Heights {
            scale: scale.map_or(1.0, |(scale, _)| scale),
        }
    } else {
        ReliefKind::Normals
    };
    warn_about_switches(&mut parameters, reader)?;
    let Some(mut material) = inner else {
        return Err(parameters.problem("a nested bsdf is missing"));
    };
    let Some(Nested { texture, .. }) = texture else {
        return Err(parameters.problem("a nested texture is missing"));
    };
    let object = parameters.object();
    parameters.finish(&mut reader.memory)?;
    let Some(texture) = texture else {
        let message = format!("{object}: its texture isn't supported; the surface stays flat");
        reader.warnings.add(element.place, message);
        return Ok(material);
    };
    let relief = Relief {
        texture,
        kind: relief_kind,
    };
    for side in std::iter::once(&mut material.front).chain(&mut material.back) {
        if side.relief.replace(relief.clone()).is_some() {
            let message = format!("{object}: a relief inside another one isn't used");
            reader.warnings.add(element.place, message);
        }
    }
    Ok(material)
}

/// The nested BSDF's material and the nested texture, if the element has them. Its parameters are added to
/// `parameters`.
///
/// # Errors
/// There are two of either.
fn children(
    reader: &mut Reader,
    element: Element,
    parameters: &mut Parameters,
) -> Result<(Option<Material>, Option<Nested>), Problem> {
    let (mut inner, mut texture) = (None, None);
    reader.each_child(element, &mut |reader, child| {
        if let Some(parameter) = properties::parameter(reader, child)? {
            return parameters.add(parameter);
        }
        let object = parameters.object();
        if let Some(found) = textures::nested(reader, child)? {
            if texture.replace(found).is_some() {
                return Err(child.problem(format!("{object} contains two textures")));
            }
            return Ok(());
        }
        match materials::nested(reader, child)? {
            Some(_) if inner.is_some() => {
                Err(child.problem(format!("{object} contains two BSDFs")))
            }
            Some(found) => {
                inner = Some(found);
                Ok(())
            }
            None => objects::skip(reader, child, &object),
        }
    })?;
    Ok((inner, texture))
}

/// Warns about switches that differ from Mitsuba's defaults, which are used.
fn warn_about_switches(parameters: &mut Parameters, reader: &mut Reader) -> Result<(), Problem> {
    for name in ["flip_invalid_normals", "use_shadowing_function"] {
        let place = parameters.place_of(&[name]);
        let is_default = parameters.boolean(name, true)?;
        if let Some(place) = place
            && !is_default
        {
            let name = quoted(name);
            let message = format!("{}: {name} is always true here", parameters.object());
            reader.warnings.add(place, message);
        }
    }
    Ok(())
}

impl Writer<'_> {
    /// Writes a side within its relief.
    ///
    /// # Errors
    /// A name has no form in the format.
    pub(super) fn side(&mut self, side: &Side, id: Option<&str>) -> Result<(), WriteError> {
        let Some(Relief { texture, kind }) = &side.relief else {
            return self.bsdf(side, id);
        };
        let plugin = match kind {
            ReliefKind::Normals => "normalmap",
            ReliefKind::Heights { .. } => "bumpmap",
        };
        let attributes = super::writer::attributes(plugin, id, None);
        self.xml.open("bsdf", &attributes)?;
        if let ReliefKind::Heights { scale } = kind {
            self.float("scale", *scale)?;
        }
        // Mitsuba accepts any name for the texture of a bump map.
        self.texture("normalmap", texture)?;
        self.bsdf(side, None)?;
        self.xml.close();
        Ok(())
    }
}
