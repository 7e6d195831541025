//! A side of a material: a BSDF, and the textures of its parameters.

use super::bsdf::Bsdf;
use super::parameters::Parameters;
use super::problem::{Problem, quoted};
use super::reader::Reader;
use super::relief::Relief;
use super::textures::{Nested, Texture};
use crate::bsdf::Slot;

/// How a side of a surface scatters light.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// The model with its parameters.
    pub bsdf: Bsdf,
    /// Textures in place of parameters.
    pub textures: Vec<(Slot, Texture)>,
    /// What tilts the shading normal.
    pub relief: Option<Relief>,
}

impl From<Bsdf> for Side {
    fn from(bsdf: Bsdf) -> Self {
        Self {
            bsdf,
            textures: Vec::new(),
            relief: None,
        }
    }
}

impl Side {
    /// The texture in place of a parameter.
    pub fn texture(&self, slot: Slot) -> Option<&Texture> {
        let found = self.textures.iter().find(|(other, _)| *other == slot);
        found.map(|(_, texture)| texture)
    }

    /// All textures.
    pub fn textures(&self) -> impl Iterator<Item = &Texture> {
        let relief = self.relief.iter().map(|relief| &relief.texture);
        self.textures
            .iter()
            .map(|(_, texture)| texture)
            .chain(relief)
    }
}

/// The parameters of a BSDF that textures can give.
fn slots(kind: &str) -> &'static [(&'static str, Slot)] {
    const SPECULAR: (&str, Slot) = ("specular_reflectance", Slot::Specular);
    const TRANSMITTANCE: (&str, Slot) = ("specular_transmittance", Slot::Transmittance);
    const ROUGHNESS: (&str, Slot) = ("alpha", Slot::Roughness);
    match kind {
        "diffuse" => &[("reflectance", Slot::Diffuse)],
        "conductor" => &[SPECULAR],
        "roughconductor" => &[SPECULAR, ROUGHNESS],
        "dielectric" | "thindielectric" => &[SPECULAR, TRANSMITTANCE],
        "roughdielectric" => &[SPECULAR, TRANSMITTANCE, ROUGHNESS],
        // The roughness of rough plastic is a number in Mitsuba, too.
        "plastic" | "roughplastic" => &[("diffuse_reflectance", Slot::Diffuse), SPECULAR],
        _ => &[],
    }
}

/// The nested textures of a BSDF, with the parameters whose values they are. Others give a warning.
///
/// # Errors
/// A parameter is given twice.
pub(super) fn assigned(
    reader: &mut Reader,
    parameters: &Parameters,
    kind: &str,
    nested: Vec<Nested>,
) -> Result<Vec<(Slot, Texture)>, Problem> {
    let mut textures: Vec<(Slot, Texture)> = Vec::new();
    for Nested {
        place,
        name,
        texture,
    } in nested
    {
        let slot = slots(kind).iter().find(|(known, _)| *known == name);
        let slot = slot.map(|(_, slot)| *slot);
        let is_given = parameters.place_of(&[&name]).is_some();
        if is_given || textures.iter().any(|(other, _)| Some(*other) == slot) {
            let message = format!("parameter {} is given twice", quoted(&name));
            return Err(Problem::at(place, message));
        }
        let object = parameters.object();
        match (slot, texture) {
            (Some(slot), Some(texture)) => textures.push((slot, texture)),
            (Some(_), None) => {
                let name = quoted(&name);
                let message =
                    format!("{object}: the texture of {name} isn't supported; the default is used");
                reader.warnings.add(place, message);
            }
            (None, _) => {
                let name = quoted(&name);
                let message =
                    format!("{object}: a texture for {name} isn't supported; the default is used");
                reader.warnings.add(place, message);
            }
        }
    }
    Ok(textures)
}
