//! Elements with a name and a value, such as `<float>`.

use super::element::Element;
use super::number::{boolean, float, floats, integer, three};
use super::plugin::{Parameter, Value};
use super::problem::{Problem, quoted};
use super::reader::Reader;
use super::transform;

/// The elements of properties.
pub(super) const PROPERTIES: [&str; 9] = [
    "boolean",
    "integer",
    "float",
    "string",
    "point",
    "vector",
    "rgb",
    "spectrum",
    "transform",
];

/// The parameter that an element gives to its object, or `None` if it is another kind of element.
///
/// # Errors
/// The name is missing, or the value isn't valid.
pub(super) fn parameter(
    reader: &mut Reader,
    element: Element,
) -> Result<Option<Parameter>, Problem> {
    if !PROPERTIES.contains(&element.tag()) {
        return Ok(None);
    }
    let name = element.required("name", &reader.defaults)?.into_owned();
    let value = value(reader, element)?;
    let parameter = Parameter {
        place: element.place,
        name,
        value,
    };
    reader.memory.take(bytes(&parameter), element.place)?;
    Ok(Some(parameter))
}

/// The memory of a parameter in a list, which may have room for twice as many.
pub(super) fn bytes(parameter: &Parameter) -> u64 {
    let value = match &parameter.value {
        Value::Text(text) => text.len(),
        Value::Transform(matrix) => size_of_val(&**matrix),
        _ => 0,
    };
    (2 * size_of::<Parameter>() + parameter.name.len() + value) as u64
}

fn value(reader: &mut Reader, element: Element) -> Result<Value, Problem> {
    let at = |message| element.problem(message);
    if element.tag() == "transform" {
        return transform_value(reader, element);
    }
    if let Some(child) = element.first_child() {
        let message = format!("<{}> contains an element", element.tag());
        return Err(Problem::at(child.place, message));
    }
    if matches!(element.tag(), "point" | "vector") {
        return point_or_vector(reader, element);
    }
    element.require_known_attributes(&["name", "value"])?;
    let text = element.required("value", &reader.defaults)?;
    match element.tag() {
        "boolean" => boolean(&text).map(Value::Boolean).map_err(at),
        "integer" => integer(&text).map(Value::Integer).map_err(at),
        "float" => float(&text).map(Value::Float).map_err(at),
        "rgb" => three(&text).map(Value::Rgb).map_err(at),
        "spectrum" => match floats(&text, 1) {
            Ok(numbers) if numbers.len() == 1 => Ok(Value::Spectrum(numbers[0])),
            _ => {
                let text = quoted(&text);
                Err(at(format!(
                    "{text} isn't a constant; spectra by wavelength aren't supported, use <rgb>"
                )))
            }
        },
        _ => Ok(Value::Text(text.trim().to_owned())),
    }
}

fn transform_value(reader: &mut Reader, element: Element) -> Result<Value, Problem> {
    element.require_known_attributes(&["name"])?;
    let composed = transform::composed(element, &reader.defaults)?;
    if let Some(length) = composed.axis_length {
        let message = format!(
            "the rotation axis has length {length:.4}, not 1: Mitsuba then also scales, and so does this"
        );
        reader.warnings.add(element.place, message);
    }
    Ok(Value::Transform(Box::new(composed.matrix)))
}

fn point_or_vector(reader: &Reader, element: Element) -> Result<Value, Problem> {
    let has = |name| element.node.has_attribute(name);
    if !has("value") {
        // Mitsuba has no default for a coordinate, unlike in transforms.
        let missing = ["x", "y", "z"].into_iter().find(|name| !has(*name));
        if let Some(name) = missing {
            let (tag, name) = (element.tag(), quoted(name));
            return Err(element.problem(format!("<{tag}> has no attribute {name}")));
        }
    }
    let vector = transform::vector(
        element,
        &reader.defaults,
        0.0,
        &["name", "value", "x", "y", "z"],
    )?;
    Ok(match element.tag() {
        "point" => Value::Point(vector),
        _ => Value::Vector(vector),
    })
}
