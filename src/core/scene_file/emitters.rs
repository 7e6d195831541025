//! Emitters: `<emitter>` elements.

use super::description::Place;
use super::element::Element;
use super::emitter::{Emitter, EmitterKind};
use super::objects::{self, Head};
use super::parameters::Parameters;
use super::plugin::Value;
use super::problem::{Problem, quoted, unknown};
use super::properties;
use super::reader::Reader;
use super::textures::{self, Nested, Texture};
use crate::brightness::{check_brightness, check_intensity};
use glam::{DMat3, DMat4, DVec3};

/// The emitters that are read.
const SUPPORTED: [&str; 5] = ["area", "constant", "directional", "envmap", "point"];
/// Mitsuba's other emitters, and the most similar one that is read.
const MOST_SIMILAR: [(&str, &str); 5] = [
    ("directionalarea", "area"),
    ("projector", "point"),
    ("spot", "point"),
    ("sunsky", "envmap"),
    ("timed_sunsky", "envmap"),
];

/// Where an emitter stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parent {
    Scene,
    Shape,
}

/// An emitter.
///
/// # Errors
/// Its type isn't known, or can't stand in this parent, or a part of it isn't valid.
pub(super) fn emitter(
    reader: &mut Reader,
    element: Element,
    parent: Parent,
) -> Result<Emitter, Problem> {
    let kind = element.required("type", &reader.defaults)?;
    if !SUPPORTED.contains(&&*kind) {
        return unsupported(reader, element);
    }
    require_place(element, &kind, parent)?;
    let head = Head::of(reader, element)?;
    reader
        .memory
        .take(2 * size_of::<Emitter>() as u64, element.place)?;
    let mut parameters = Parameters::new("emitter", &head.kind, element.place);
    let mut texture = None;
    reader.each_child(element, &mut |reader, child| {
        if let Some(parameter) = properties::parameter(reader, child)? {
            return parameters.add(parameter);
        }
        if head.kind == "area"
            && let Some(found) = textures::nested(reader, child)?
            && let Some(found) = of_radiance(found, &parameters, &texture)?
        {
            texture = Some(Box::new(found));
            return Ok(());
        }
        if matches!(child.tag(), "ref" | "texture") {
            let message = format!(
                "{}: textures aren't supported; a constant of 1 is used",
                parameters.object()
            );
            reader.warnings.add(child.place, message);
            return Ok(());
        }
        objects::skip(reader, child, &parameters.object())
    })?;
    let mut kind = kind_of(&head.kind, &mut parameters, element, reader)?;
    if let EmitterKind::Area {
        texture: of_kind, ..
    } = &mut kind
    {
        *of_kind = texture;
    }
    // It changes noise, not the picture.
    parameters.warn_about(&["sampling_weight"], &mut reader.warnings);
    parameters.finish(&mut reader.memory)?;
    Ok(Emitter {
        place: element.place,
        id: head.id,
        name: head.name,
        kind,
    })
}

/// Refuses an emitter in the wrong parent.
fn require_place(element: Element, kind: &str, parent: Parent) -> Result<(), Problem> {
    match (kind, parent) {
        ("area", Parent::Scene) => Err(element.problem("emitter “area” must stand in a shape")),
        ("area", Parent::Shape) | (_, Parent::Scene) => Ok(()),
        (kind, Parent::Shape) => {
            let kind = quoted(kind);
            let message = format!("emitter {kind} can't stand in a shape, only “area” can");
            Err(element.problem(message))
        }
    }
}

/// The texture of a radiance; `None` if it isn't supported.
///
/// # Errors
/// The radiance is given twice, or this is another parameter.
fn of_radiance(
    nested: Nested,
    parameters: &Parameters,
    other: &Option<Box<Texture>>,
) -> Result<Option<Texture>, Problem> {
    let name = &nested.name;
    if name != "radiance" {
        let message = unknown("parameter of emitter “area”:", name, &["radiance"]);
        return Err(Problem::at(nested.place, message));
    }
    if other.is_some() || parameters.place_of(&["radiance"]).is_some() {
        let message = "parameter “radiance” is given twice";
        return Err(Problem::at(nested.place, message));
    }
    Ok(nested.texture)
}

/// An emitter of Mitsuba's that isn't supported, with a warning.
fn unsupported(reader: &mut Reader, element: Element) -> Result<Emitter, Problem> {
    let mut plugin = objects::plugin(reader, element)?;
    let bytes = 2 * size_of::<Emitter>() as u64;
    reader.memory.take(bytes, element.place)?;
    let kind = quoted(&plugin.kind);
    let similar = MOST_SIMILAR.iter().find(|(name, _)| *name == plugin.kind);
    let similar = similar.map_or(String::new(), |(_, similar)| {
        format!(
            "; the most similar one that is supported is {}",
            quoted(similar)
        )
    });
    let message = format!("emitter {kind} isn't supported and gives no light{similar}");
    reader.warnings.add(plugin.place, message);
    Ok(Emitter {
        place: plugin.place,
        id: plugin.id.take(),
        name: plugin.name.take(),
        kind: EmitterKind::Other(Box::new(plugin)),
    })
}

fn kind_of(
    kind: &str,
    parameters: &mut Parameters,
    element: Element,
    reader: &mut Reader,
) -> Result<EmitterKind, Problem> {
    Ok(match kind {
        "area" => {
            if parameters.has_any(&["to_world"]) {
                let message = "“to_world” isn't allowed: the light is where the shape is";
                return Err(parameters.problem(message));
            }
            EmitterKind::Area {
                radiance: light(parameters, "radiance")?,
                texture: None,
            }
        }
        "constant" => EmitterKind::Constant {
            radiance: light(parameters, "radiance")?,
        },
        "point" => EmitterKind::Point {
            position: position(parameters)?,
            intensity: light(parameters, "intensity")?,
        },
        "directional" => EmitterKind::Directional {
            direction: direction(parameters)?,
            irradiance: light(parameters, "irradiance")?,
        },
        _ => envmap(parameters, element, reader)?,
    })
}

/// Light in linear RGB; 1 by default.
fn light(parameters: &mut Parameters, name: &'static str) -> Result<DVec3, Problem> {
    let Some(given) = parameters.take(name) else {
        return Ok(DVec3::ONE);
    };
    let at = |message: String| Err(Problem::at(given.place, message));
    let rgb = match given.value {
        Value::Rgb(rgb) => rgb,
        Value::Spectrum(all) | Value::Float(all) => DVec3::splat(all),
        other => {
            let (name, element) = (quoted(name), other.element());
            return at(format!("{name} must be <rgb>, not <{element}>"));
        }
    };
    let checked = match name {
        "intensity" => check_intensity(rgb),
        _ => check_brightness(rgb),
    };
    match checked {
        Ok(()) => Ok(rgb),
        Err(fault) => at(format!("{} {fault}", quoted(name))),
    }
}

/// Refuses two parameters that mean the same.
fn exclude(parameters: &mut Parameters, name: &'static str) -> Result<(), Problem> {
    if parameters.has_any(&[name]) && parameters.has_any(&["to_world"]) {
        let message = format!("{} and “to_world” exclude each other", quoted(name));
        return Err(parameters.problem(&message));
    }
    Ok(())
}

/// The position of a point: `position`, or where `to_world` moves the origin.
fn position(parameters: &mut Parameters) -> Result<DVec3, Problem> {
    exclude(parameters, "position")?;
    let to_world = parameters.world_transform()?;
    parameters.point("position", to_world.transform_point3(DVec3::ZERO))
}

/// The direction in which light travels: `direction`, or that of +z after `to_world`.
fn direction(parameters: &mut Parameters) -> Result<DVec3, Problem> {
    exclude(parameters, "direction")?;
    let to_world = parameters.world_transform()?;
    parameters.direction("direction", to_world.transform_vector3(DVec3::Z))
}

fn envmap(
    parameters: &mut Parameters,
    element: Element,
    reader: &mut Reader,
) -> Result<EmitterKind, Problem> {
    let Some((name, place)) = parameters.text("filename")? else {
        return Err(parameters.problem("parameter “filename” is missing"));
    };
    let file = reader.data_file(&name, element, place)?;
    reader.memory.take(name.len() as u64, place)?;
    let scale = match parameters.float("scale")? {
        Some((scale, place)) => {
            let fault = |fault| Problem::at(place, format!("“scale” {fault}"));
            check_brightness(DVec3::splat(scale)).map_err(fault)?;
            scale
        }
        None => 1.0,
    };
    // It changes noise, not the picture.
    parameters.boolean("mis_compensation", false)?;
    let to_world = parameters.world_transform()?;
    require_rotation(to_world, element.place)?;
    Ok(EmitterKind::Envmap {
        file,
        scale,
        to_world,
    })
}

/// Refuses a transform that changes angles: the directions of a picture can be rotated or mirrored.
fn require_rotation(to_world: DMat4, place: Place) -> Result<(), Problem> {
    /// A matrix typed with four digits deviates by less.
    const TOLERANCE: f64 = 1e-3;
    let linear = DMat3::from_mat4(to_world);
    let product = linear.transpose() * linear;
    if product.abs_diff_eq(DMat3::IDENTITY, TOLERANCE) {
        return Ok(());
    }
    let message = "emitter “envmap”: “to_world” must be a rotation";
    Err(Problem::at(place, message))
}
