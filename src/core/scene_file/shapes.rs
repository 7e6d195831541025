//! Shapes: `<shape>` elements.

use super::description::{CsgOperation, Quadric, Shape, ShapeKind};
use super::element::Element;
use super::materials;
use super::objects::{self, Head};
use super::parameters::Parameters;
use super::plane::plane;
use super::plugin::Plugin;
use super::problem::{Problem, quoted, unknown};
use super::properties;
use super::reader::Reader;
use glam::DVec3;

/// The shapes that are read: Mitsuba's, then our own.
const SHAPES: [&str; 12] = [
    "obj",
    "sphere",
    "cylinder",
    "disk",
    "rectangle",
    "cube",
    "plane",
    "box",
    "cone",
    "torus",
    "quadric",
    "csg",
];

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
struct Parts {
    parameters: Parameters,
    is_csg: bool,
    children: Vec<Shape>,
    material: Option<u32>,
    emitter: Option<Box<Plugin>>,
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
    if !SHAPES.contains(&kind) {
        return Err(element.problem(unknown("shape", kind, &SHAPES)));
    }
    reader
        .memory
        .take(2 * size_of::<Shape>() as u64, element.place)?;
    let mut parts = Parts {
        parameters: Parameters::new("shape", kind, element.place),
        is_csg: kind == "csg",
        children: Vec::new(),
        material: None,
        emitter: None,
    };
    reader.each_child(element, &mut |reader, child| parts.add(reader, child))?;
    let to_world = parts.parameters.world_transform()?;
    let flip_normals = parts.parameters.boolean("flip_normals", false)?;
    let unused = ["silhouette_sampling_weight"];
    parts.parameters.warn_about(&unused, &mut reader.warnings);
    let kind = kind_of(kind, &mut parts, element, reader)?;
    parts.parameters.finish()?;
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

impl Parts {
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
                self.emitter = Some(Box::new(reader.unused_plugin(child)?));
                Ok(())
            }
            "shape" if self.is_csg => {
                let nested = shape(reader, child)?;
                self.children.push(nested);
                Ok(())
            }
            "shape" => Err(child.problem("a shape can only be nested in a csg")),
            _ => objects::skip(reader, child, &self.parameters.object()),
        }
    }
}

fn kind_of(
    kind: &str,
    parts: &mut Parts,
    element: Element,
    reader: &mut Reader,
) -> Result<ShapeKind, Problem> {
    let parameters = &mut parts.parameters;
    Ok(match kind {
        "obj" => obj(parameters, element, reader)?,
        "sphere" => ShapeKind::Sphere {
            center: parameters.point("center", DVec3::ZERO)?,
            radius: parameters.positive("radius", 1.0)?,
        },
        "cylinder" => {
            let (p0, p1) = axis(parameters)?;
            ShapeKind::Cylinder {
                p0,
                p1,
                radius: parameters.positive("radius", 1.0)?,
                is_capped: parameters.boolean("capped", false)?,
            }
        }
        "disk" => ShapeKind::Disk,
        "rectangle" => ShapeKind::Rectangle,
        "cube" => ShapeKind::Cube,
        "plane" => plane(parameters)?,
        "box" => {
            let (min, max) = extent(parameters)?;
            ShapeKind::Box { min, max }
        }
        "cone" => {
            let (p0, p1) = axis(parameters)?;
            ShapeKind::Cone {
                p0,
                p1,
                radius: parameters.positive("radius", 1.0)?,
                is_capped: parameters.boolean("capped", false)?,
            }
        }
        "torus" => ShapeKind::Torus {
            center: parameters.point("center", DVec3::ZERO)?,
            axis: parameters.direction("axis", DVec3::Z)?,
            major: parameters.positive("major", 1.0)?,
            minor: parameters.positive("minor", 0.25)?,
        },
        "quadric" => ShapeKind::Quadric(Box::new(quadric(parameters)?)),
        _ => ShapeKind::Csg {
            operation: operation(parameters)?,
            children: solids(parts)?,
        },
    })
}

fn obj(
    parameters: &mut Parameters,
    element: Element,
    reader: &mut Reader,
) -> Result<ShapeKind, Problem> {
    let Some((name, place)) = parameters.text("filename")? else {
        return Err(parameters.problem("parameter “filename” is missing"));
    };
    let folder = &element.file.folder;
    let file = reader.named_file(&name, folder, place)?;
    let main_folder = reader.scene.files[0].parent().unwrap_or(folder);
    if main_folder.join(&name) != file {
        let name = quoted(&name);
        let message =
            format!("Mitsuba looks for {name} in the folder of the main file, not of this one");
        reader.warnings.add(place, message);
    }
    Ok(ShapeKind::Obj {
        file,
        face_normals: parameters.boolean("face_normals", false)?,
        flip_tex_coords: parameters.boolean("flip_tex_coords", true)?,
    })
}

/// The ends of an axis.
fn axis(parameters: &mut Parameters) -> Result<(DVec3, DVec3), Problem> {
    let p0 = parameters.point("p0", DVec3::ZERO)?;
    let p1 = parameters.point("p1", DVec3::Z)?;
    if p0 == p1 {
        return Err(parameters.problem("p0 and p1 are the same point"));
    }
    Ok((p0, p1))
}

/// The corners of a box.
fn extent(parameters: &mut Parameters) -> Result<(DVec3, DVec3), Problem> {
    let min = parameters.point("min", DVec3::NEG_ONE)?;
    let max = parameters.point("max", DVec3::ONE)?;
    if !min.cmplt(max).all() {
        return Err(parameters.problem("“min” must be less than “max” in each coordinate"));
    }
    Ok((min, max))
}

fn quadric(parameters: &mut Parameters) -> Result<Quadric, Problem> {
    const NAMES: [&str; 10] = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j"];
    let mut coefficients = [0.0; 10];
    for (coefficient, name) in coefficients.iter_mut().zip(NAMES) {
        *coefficient = parameters.float(name)?.map_or(0.0, |(number, _)| number);
    }
    if coefficients[..9].iter().all(|&c| c == 0.0) {
        return Err(parameters.problem("the coefficients “a” to “i” are all zero"));
    }
    let (min, max) = extent(parameters)?;
    Ok(Quadric {
        coefficients,
        min,
        max,
    })
}

fn operation(parameters: &mut Parameters) -> Result<CsgOperation, Problem> {
    let Some((name, place)) = parameters.text("operation")? else {
        return Err(parameters.problem("parameter “operation” is missing"));
    };
    let all = CsgOperation::ALL;
    let found = all.into_iter().find(|operation| operation.name() == name);
    let names = all.map(CsgOperation::name);
    found.ok_or_else(|| Problem::at(place, unknown("operation", &name, &names)))
}

fn solids(parts: &mut Parts) -> Result<Vec<Shape>, Problem> {
    if parts.children.len() < 2 {
        return Err(parts
            .parameters
            .problem("at least two nested shapes are needed"));
    }
    Ok(std::mem::take(&mut parts.children))
}
