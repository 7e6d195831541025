//! Materials: `<bsdf>` elements and references to them.

use super::bsdf::Bsdf;
use super::bsdfs::{self, PLAIN};
use super::description::{Material, Place, Shape};
use super::element::Element;
use super::kinds::ShapeKind;
use super::memory::bytes_per_map_entry;
use super::objects::{self, Head};
use super::parameters::Parameters;
use super::problem::{Problem, quoted, unknown};
use super::properties;
use super::reader::Reader;
use super::relief;
use super::side::Side;
use super::textures::{self, Texture};
use crate::bsdf::Slot;
use std::collections::HashMap;

/// The BSDFs of Mitsuba 3.9.1.
const BSDFS: [&str; 23] = [
    "diffuse",
    "twosided",
    "blendbsdf",
    "bumpmap",
    "circular",
    "conductor",
    "dielectric",
    "hair",
    "mask",
    "measured",
    "measured_polarized",
    "normalmap",
    "null",
    "plastic",
    "polarizer",
    "pplastic",
    "principled",
    "principledthin",
    "retarder",
    "roughconductor",
    "roughdielectric",
    "roughplastic",
    "thindielectric",
];

/// BSDFs that aren't supported, and the most similar one that is.
const MOST_SIMILAR: [(&str, &str); 5] = [
    ("blendbsdf", "diffuse"),
    ("measured", "roughconductor"),
    ("pplastic", "plastic"),
    ("principled", "roughplastic"),
    ("principledthin", "thindielectric"),
];

/// Marks an index into the list of materials without identifier.
const UNNAMED: u32 = 1 << 31;

/// The materials defined or referred to so far.
#[derive(Default)]
pub(super) struct Materials {
    /// Those with identifiers, in the order in which they are mentioned.
    named: Vec<Named>,
    by_id: HashMap<String, u32>,
    /// The others, until the shapes that use them are known.
    unnamed: Vec<Option<Material>>,
}

struct Named {
    id: String,
    /// Where it is mentioned first.
    place: Place,
    material: Option<Material>,
}

impl Materials {
    /// A temporary index of the material with an identifier, which may be defined later.
    fn mention(&mut self, id: &str, place: Place) -> u32 {
        if let Some(&index) = self.by_id.get(id) {
            return index;
        }
        let index = self.named.len() as u32;
        self.by_id.insert(id.to_owned(), index);
        self.named.push(Named {
            id: id.to_owned(),
            place,
            material: None,
        });
        index
    }

    /// The list of materials. Replaces the shapes' temporary indices.
    ///
    /// # Errors
    /// A material isn't defined.
    pub(super) fn finish(
        self,
        shapes: &mut [Shape],
        ids: &HashMap<String, Registered>,
    ) -> Result<Vec<Material>, Problem> {
        let named = self.named.into_iter().map(|named| {
            let missing = || undefined(&named.id, named.place, ids);
            named.material.ok_or_else(missing)
        });
        let mut materials: Vec<Material> = named.collect::<Result<_, _>>()?;
        materials.reserve_exact(self.unnamed.len());
        let mut unnamed = self.unnamed;
        resolve(shapes, &mut unnamed, &mut materials);
        Ok(materials)
    }
}

/// Appends the shapes' unnamed materials to the list. Those of nested shapes come first, as the writer writes them.
fn resolve(
    shapes: &mut [Shape],
    unnamed: &mut Vec<Option<Material>>,
    materials: &mut Vec<Material>,
) {
    for shape in shapes {
        if let ShapeKind::Csg(csg) = &mut shape.kind {
            resolve(&mut csg.children, unnamed, materials);
        }
        let Some(index) = shape.material.filter(|index| index & UNNAMED != 0) else {
            continue;
        };
        let material = unnamed[(index & !UNNAMED) as usize].take();
        shape.material = Some(materials.len() as u32);
        materials.extend(material);
    }
}

/// An object with an identifier.
pub(super) struct Registered {
    pub place: Place,
    pub element: String,
}

fn undefined(id: &str, place: Place, ids: &HashMap<String, Registered>) -> Problem {
    /// More than any scene has; comparing a name with all takes time.
    const MAX_COMPARED: usize = 1000;
    if let Some(other) = ids.get(id) {
        let message = format!("{} is <{}>, not <bsdf>", quoted(id), other.element);
        return Problem::at(place, message);
    }
    let known = ids.iter().filter(|(_, other)| other.element == "bsdf");
    let mut known: Vec<&str> = known
        .map(|(id, _)| id.as_str())
        .take(MAX_COMPARED)
        .collect();
    known.sort_unstable();
    Problem::at(place, unknown("id of a bsdf:", id, &known))
}

/// The temporary index of the material that a `<ref>` names.
pub(super) fn reference(reader: &mut Reader, element: Element) -> Result<u32, Problem> {
    let id = objects::reference(reader, element)?;
    if !reader.materials.by_id.contains_key(&id) {
        reader.memory.take(bytes_of_id(&id), element.place)?;
    }
    Ok(reader.materials.mention(&id, element.place))
}

/// The memory of an identifier in the lists.
fn bytes_of_id(id: &str) -> u64 {
    let entry = bytes_per_map_entry::<(String, u32)>();
    (2 * size_of::<Named>() + entry + 2 * id.len()) as u64
}

/// The temporary index of a new material.
pub(super) fn define(reader: &mut Reader, element: Element) -> Result<u32, Problem> {
    let material = bsdf(reader, element)?;
    add(reader, material)
}

/// The temporary index of a new material, whose memory is taken.
fn add(reader: &mut Reader, material: Material) -> Result<u32, Problem> {
    let (id, place) = (material.id.clone(), material.place);
    // A list with one texture has room for four.
    let texture = |texture: &Texture| 4 * size_of::<(Slot, Texture)>() + texture.path_bytes();
    let textures = material.textures().map(texture).sum::<usize>();
    // In the final list, besides the temporary one.
    reader
        .memory
        .take((size_of::<Material>() + textures) as u64, place)?;
    let Some(id) = id else {
        let list = &mut reader.materials.unnamed;
        reader.memory.push(list, Some(material), place)?;
        return Ok(UNNAMED | (list.len() as u32 - 1));
    };
    let bytes = size_of::<Material>() as u64 + bytes_of_id(&id);
    reader.memory.take(bytes, place)?;
    let index = reader.materials.mention(&id, place);
    reader.materials.named[index as usize].material = Some(material);
    Ok(index)
}

fn bsdf(reader: &mut Reader, element: Element) -> Result<Material, Problem> {
    let head = Head::of(reader, element)?;
    let mut material = Material {
        place: element.place,
        id: head.id,
        front: Bsdf::GREY.into(),
        back: None,
        opacity: 1.0,
        opacity_texture: None,
    };
    match head.kind.as_str() {
        kind if PLAIN.contains(&kind) => material.front = bsdfs::plain(reader, element, kind)?,
        "mask" => {
            let masked = masked(reader, element)?;
            material = Material {
                place: material.place,
                id: material.id,
                ..masked
            };
        }
        "bumpmap" | "normalmap" => {
            let kind = if head.kind == "bumpmap" {
                "bumpmap"
            } else {
                "normalmap"
            };
            material = Material {
                place: material.place,
                id: material.id,
                ..relief::read(reader, element, kind)?
            };
        }
        "twosided" => {
            let (front, back) = both_sides(reader, element)?;
            material.front = front;
            material.back = Some(back);
        }
        kind if BSDFS.contains(&kind) => {
            let similar = MOST_SIMILAR.iter().find(|(name, _)| *name == kind);
            let similar = similar.map_or(String::new(), |(_, similar)| {
                let similar = quoted(similar);
                format!("; the most similar one that is supported is {similar}")
            });
            let kind = quoted(kind);
            let message = format!(
                "bsdf {kind} isn't supported; a diffuse reflectance of 0.5 is used{similar}"
            );
            reader.warnings.add(element.place, message);
            material.back = Some(Bsdf::GREY.into());
        }
        kind => return Err(element.problem(unknown("bsdf", kind, &BSDFS))),
    }
    Ok(material)
}

/// A nested BSDF, or the one that a nested reference names, which must be defined before; `None` for other elements.
pub(super) fn nested(reader: &mut Reader, child: Element) -> Result<Option<Material>, Problem> {
    match child.tag() {
        "bsdf" => {
            let nested = bsdf(reader, child)?;
            if nested.id.is_some() {
                add(reader, nested.clone())?;
            }
            Ok(Some(nested))
        }
        "ref" => {
            let id = objects::reference(reader, child)?;
            let index = reader.materials.by_id.get(&id);
            let named = index.and_then(|&index| {
                let named = &reader.materials.named[index as usize];
                named.material.clone()
            });
            match named {
                Some(named) => Ok(Some(named)),
                None => {
                    let id = quoted(&id);
                    Err(child.problem(format!("no bsdf {id} is defined before this line")))
                }
            }
        }
        _ => Ok(None),
    }
}

/// The BSDF that a `mask` contains, with its opacity.
fn masked(reader: &mut Reader, element: Element) -> Result<Material, Problem> {
    let mut parameters = Parameters::new("bsdf", "mask", element.place);
    let (mut inner, mut texture) = (None, None);
    reader.each_child(element, &mut |reader, child| {
        if let Some(parameter) = properties::parameter(reader, child)? {
            return parameters.add(parameter);
        }
        if let Some(found) = textures::nested(reader, child)? {
            if texture.replace(found).is_some() {
                return Err(child.problem("bsdf “mask” contains two textures"));
            }
            return Ok(());
        }
        match nested(reader, child)? {
            Some(_) if inner.is_some() => Err(child.problem("bsdf “mask” contains two BSDFs")),
            Some(found) => {
                inner = Some(found);
                Ok(())
            }
            None => objects::skip(reader, child, &parameters.object()),
        }
    })?;
    let opacity = match parameters.float("opacity")? {
        Some((opacity, place)) if !(0.0..=1.0).contains(&opacity) => {
            let message = "“opacity” must be from 0 to 1".to_owned();
            return Err(Problem::at(place, message));
        }
        found => found.map_or(0.5, |(opacity, _)| opacity),
    };
    let Some(mut inner) = inner else {
        return Err(parameters.problem("a nested bsdf is missing"));
    };
    parameters.finish(&mut reader.memory)?;
    match texture.map(|nested| (nested.place, nested.texture)) {
        Some((_, Some(texture))) if inner.opacity_texture.is_none() => {
            inner.opacity_texture = Some(texture);
        }
        Some((place, _)) => {
            let message = "bsdf “mask”: its texture isn't supported; an opacity of 0.5 is used";
            reader.warnings.add(place, message.to_owned());
            inner.opacity *= opacity;
        }
        None => inner.opacity *= opacity,
    }
    Ok(inner)
}

/// The front and the back of a `twosided` BSDF, which contains one BSDF for both or two.
fn both_sides(reader: &mut Reader, element: Element) -> Result<(Side, Side), Problem> {
    let parameters = Parameters::new("bsdf", "twosided", element.place);
    let mut sides = Vec::new();
    reader.each_child(element, &mut |reader, child| {
        let Some(side) = nested(reader, child)? else {
            return objects::skip(reader, child, &parameters.object());
        };
        if side.front.bsdf.transmits() {
            let message = "light passes through this bsdf, so it can't stand in “twosided”: use it alone, it has both sides";
            return Err(child.problem(message));
        }
        if sides.len() == 2 {
            return Err(child.problem("bsdf “twosided” contains more than two BSDFs"));
        }
        sides.push(side.front);
        Ok(())
    })?;
    let mut sides = sides.into_iter();
    match (sides.next(), sides.next()) {
        (Some(both), None) => Ok((both.clone(), both)),
        (Some(front), Some(back)) => Ok((front, back)),
        _ => Err(parameters.problem("a nested bsdf is missing")),
    }
}
