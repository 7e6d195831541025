//! The attributes of objects, and objects that are kept as they are.

use super::element::Element;
use super::integrators::OTHERS;
use super::plugin::{Parameter, Plugin, Value};
use super::problem::{Problem, quoted, unknown};
use super::properties::{self, PROPERTIES};
use super::reader::Reader;
use super::transform::OPERATIONS;
use crate::integrator::INTEGRATORS;

/// The elements of Mitsuba's objects.
const OBJECTS: [&str; 12] = [
    "scene",
    "shape",
    "bsdf",
    "sensor",
    "emitter",
    "integrator",
    "film",
    "sampler",
    "rfilter",
    "texture",
    "medium",
    "volume",
];

/// Emitters of Mitsuba 3.9.1.
const EMITTERS: [&str; 10] = [
    "area",
    "constant",
    "directional",
    "directionalarea",
    "envmap",
    "point",
    "projector",
    "spot",
    "sunsky",
    "timed_sunsky",
];

/// The attributes of an object.
pub(super) struct Head {
    pub kind: String,
    pub id: Option<String>,
    pub name: Option<String>,
}

impl Head {
    /// The attributes of an object's element. Registers its identifier.
    ///
    /// # Errors
    /// `type` is missing, an attribute isn't known, or the identifier is in use.
    pub(super) fn of(reader: &mut Reader, element: Element) -> Result<Self, Problem> {
        element.require_known_attributes(&["type", "id", "name"])?;
        let kind = element.required("type", &reader.defaults)?.into_owned();
        let id = element.attribute("id", &reader.defaults)?;
        let id = id.filter(|id| !id.is_empty()).map(|id| id.into_owned());
        let name = element.attribute("name", &reader.defaults)?;
        let name = name.map(|name| name.into_owned());
        if let Some(id) = &id {
            reader.register(id, element)?;
        }
        let length = kind.len() + name.as_ref().map_or(0, String::len);
        reader.memory.take(length as u64, element.place)?;
        Ok(Self { kind, id, name })
    }
}

/// A `<ref>`: the identifier of another object.
///
/// # Errors
/// The identifier is missing, or an attribute isn't known.
pub(super) fn reference(reader: &Reader, element: Element) -> Result<String, Problem> {
    element.require_known_attributes(&["id", "name"])?;
    Ok(element.required("id", &reader.defaults)?.into_owned())
}

/// An integrator or emitter as it stands in the file, with nested objects.
///
/// # Errors
/// Its type isn't known, or a part of it isn't valid.
pub(super) fn plugin(reader: &mut Reader, element: Element) -> Result<Plugin, Problem> {
    let head = Head::of(reader, element)?;
    let known: Vec<&str> = match element.tag() {
        "integrator" => {
            let views = INTEGRATORS.iter().map(|view| view.name);
            views.chain(OTHERS.iter().map(|(name, _)| *name)).collect()
        }
        "emitter" => EMITTERS.to_vec(),
        _ => Vec::new(),
    };
    if !known.is_empty() && !known.contains(&head.kind.as_str()) {
        return Err(element.problem(unknown(element.tag(), &head.kind, &known)));
    }
    reader
        .memory
        .take(2 * size_of::<Plugin>() as u64, element.place)?;
    let mut plugin = Plugin {
        place: element.place,
        element: element.tag().to_owned(),
        kind: head.kind,
        id: head.id,
        name: head.name,
        parameters: Vec::new(),
        children: Vec::new(),
    };
    reader.each_child(element, &mut |reader, child| {
        if let Some(parameter) = properties::parameter(reader, child)? {
            plugin.parameters.push(parameter);
        } else if child.tag() == "ref" {
            let id = reference(reader, child)?;
            let name = child.attribute("name", &reader.defaults)?;
            let bytes = size_of::<Parameter>() + id.len();
            reader.memory.take(bytes as u64, child.place)?;
            plugin.parameters.push(Parameter {
                place: child.place,
                name: name.unwrap_or_default().into_owned(),
                value: Value::Reference(id),
            });
        } else if OBJECTS.contains(&child.tag()) {
            let nested = self::plugin(reader, child)?;
            plugin.children.push(nested);
        } else {
            return Err(unexpected(child));
        }
        Ok(())
    })?;
    Ok(plugin)
}

/// Warns about an object of Mitsuba's that isn't used.
///
/// # Errors
/// The element isn't one of Mitsuba's objects, or its identifier is in use.
pub(super) fn skip(reader: &mut Reader, element: Element, inside: &str) -> Result<(), Problem> {
    if !OBJECTS.contains(&element.tag()) || element.tag() == "scene" {
        return Err(unexpected(element));
    }
    if let Some(id) = element.attribute("id", &reader.defaults)?
        && !id.is_empty()
    {
        reader.register(&id, element)?;
    }
    let kind = element.attribute("type", &reader.defaults)?;
    let kind = kind.map_or(String::new(), |kind| format!(" {}", quoted(&kind)));
    let message = format!("{}{kind} in {inside} isn't used", element.tag());
    reader.warnings.add(element.place, message);
    Ok(())
}

/// The problem with an element that can't stand where it does.
pub(super) fn unexpected(element: Element) -> Problem {
    let tag = element.tag();
    if matches!(tag, "alias" | "path" | "phase") {
        return element.problem(format!("<{tag}> isn't supported"));
    }
    let others = ["ref", "default", "include"];
    let known = [&OBJECTS[..], &PROPERTIES, &OPERATIONS, &others].concat();
    if known.contains(&tag) {
        let parent = element.node.parent_element();
        let parent = parent.map_or("", |parent| parent.tag_name().name());
        return element.problem(format!("<{tag}> can't stand in <{parent}>"));
    }
    element.problem(unknown("element", tag, &known))
}
