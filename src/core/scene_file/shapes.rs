//! Shapes: `<shape>` elements.

use super::description::{Place, Shape};
use super::element::Element;
use super::emitter::Emitter;
use super::emitters::{self, Parent};
use super::kinds::KINDS;
use super::materials;
use super::objects::{self, Head};
use super::parameters::Parameters;
use super::problem::{Problem, quoted, unknown};
use super::properties;
use super::reader::Reader;
use std::path::Path;

/// Other shapes of Mitsuba 3.9.1.
const UNSUPPORTED: [&str; 11] = [
    "blender",
    "bsplinecurve",
    "ellipsoids",
    "ellipsoidsmesh",
    "instance",
    "linearcurve",
    "merge",
    "ply",
    "sdfgrid",
    "serialized",
    "shapegroup",
];

/// The parts of a shape that are read so far.
pub(super) struct Parts<'a> {
    /// The folder against which file names are resolved.
    pub folder: &'a Path,
    pub parameters: Parameters,
    /// The start of the element.
    pub place: Place,
    has_children: bool,
    pub children: Vec<Shape>,
    /// A temporary index; see [`materials`].
    pub material: Option<u32>,
    emitter: Option<Box<Emitter>>,
}

/// A shape with its material, its emitter and nested shapes.
///
/// # Errors
/// Its type isn't known, or a part of it isn't valid.
pub(super) fn shape(reader: &mut Reader, element: Element) -> Result<Shape, Problem> {
    let head = Head::of(reader, element)?;
    let kind = head.kind.as_str();
    if UNSUPPORTED.contains(&kind) {
        return Err(element.problem(format!("shape {} isn't supported", quoted(kind))));
    }
    let Some(row) = KINDS.iter().find(|row| row.name == kind) else {
        let known: Vec<&str> = KINDS.iter().map(|row| row.name).collect();
        return Err(element.problem(unknown("shape", kind, &known)));
    };
    let mut parts = Parts {
        folder: &element.file.folder,
        parameters: Parameters::new("shape", kind, element.place),
        place: element.place,
        has_children: row.has_children,
        children: Vec::new(),
        material: None,
        emitter: None,
    };
    reader.each_child(element, &mut |reader, child| parts.add(reader, child))?;
    let to_world = parts.parameters.world_transform()?;
    let flip_normals = parts.parameters.boolean("flip_normals", false)?;
    let unused = ["silhouette_sampling_weight"];
    parts.parameters.warn_about(&unused, &mut reader.warnings);
    let kind = (row.read)(&mut parts, reader)?;
    parts.parameters.finish(&mut reader.memory)?;
    Ok(Shape {
        place: element.place,
        id: head.id,
        name: head.name,
        kind,
        to_world,
        flip_normals,
        material: parts.material,
        emitter: parts.emitter,
    })
}

impl Parts<'_> {
    fn add(&mut self, reader: &mut Reader, child: Element) -> Result<(), Problem> {
        if let Some(parameter) = properties::parameter(reader, child)? {
            return self.parameters.add(parameter);
        }
        match child.tag() {
            "bsdf" | "ref" if self.material.is_some() => {
                Err(child.problem(format!("{} has a second bsdf", self.parameters.object())))
            }
            "bsdf" => {
                self.material = Some(materials::define(reader, child)?);
                Ok(())
            }
            "ref" => {
                self.material = Some(materials::reference(reader, child)?);
                Ok(())
            }
            "emitter" if self.emitter.is_some() => {
                Err(child.problem(format!("{} has a second emitter", self.parameters.object())))
            }
            "emitter" => {
                let emitter = emitters::emitter(reader, child, Parent::Shape)?;
                self.emitter = Some(Box::new(emitter));
                Ok(())
            }
            "shape" if self.has_children => {
                let nested = shape(reader, child)?;
                reader.memory.push(&mut self.children, nested, child.place)
            }
            "shape" => Err(child.problem("a shape can only be nested in a csg")),
            _ => objects::skip(reader, child, &self.parameters.object()),
        }
    }
}
