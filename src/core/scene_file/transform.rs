//! Transforms, composed from operations.
//!
//! Each operation is applied after those before it: `<translate/><rotate/>` moves, then rotates. All are composed in
//! f64. Rotations by multiples of 90° about an axis of coordinates are exact.

use super::defaults::Defaults;
use super::element::Element;
use super::number::{float, floats, three};
use super::problem::{Problem, quoted, unknown};
use glam::{DMat3, DMat4, DVec3, DVec4, Vec3Swizzles as _};

/// The attributes with a vector.
const VECTOR: [&str; 4] = ["value", "x", "y", "z"];
/// The elements in a transform.
pub(super) const OPERATIONS: [&str; 5] = ["translate", "rotate", "scale", "matrix", "lookat"];

/// A composed transform.
pub(super) struct Composed {
    pub matrix: DMat4,
    /// The length of a rotation axis that isn't a unit vector. Mitsuba's formula, which is used here, too, then also
    /// scales.
    pub axis_length: Option<f64>,
}

/// The transform in a `<transform>` element.
///
/// # Errors
/// An operation isn't known, or a number isn't valid.
pub(super) fn composed(element: Element, defaults: &Defaults) -> Result<Composed, Problem> {
    let mut composed = Composed {
        matrix: DMat4::IDENTITY,
        axis_length: None,
    };
    for node in element.node.children().filter(|node| node.is_element()) {
        let operation = Element::new(node, element.file);
        if let Some(child) = operation.first_child() {
            let message = format!("<{}> contains an element", operation.tag());
            return Err(Problem::at(child.place, message));
        }
        let applied = match operation.tag() {
            "translate" => DMat4::from_translation(vector(operation, defaults, 0.0, &VECTOR)?),
            "scale" => DMat4::from_scale(vector(operation, defaults, 1.0, &VECTOR)?),
            "rotate" => rotation(operation, defaults, &mut composed.axis_length)?,
            "matrix" => matrix(operation, defaults)?,
            "lookat" => look_at(operation, defaults)?,
            other => return Err(operation.problem(unknown("operation", other, &OPERATIONS))),
        };
        composed.matrix = applied * composed.matrix;
        if !composed.matrix.is_finite() {
            return Err(operation.problem("the transform isn't finite"));
        }
    }
    Ok(composed)
}

/// The vector in `value`, or else in `x`, `y` and `z`; a missing coordinate is `missing`. `known` lists the attributes
/// that the element may have.
pub(super) fn vector(
    element: Element,
    defaults: &Defaults,
    missing: f64,
    known: &[&str],
) -> Result<DVec3, Problem> {
    let at = |message| element.problem(message);
    element.require_known_attributes(known)?;
    let value = element.attribute("value", defaults)?;
    let mut vector = DVec3::splat(missing);
    let mut has_coordinates = false;
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        if let Some(text) = element.attribute(name, defaults)? {
            vector[axis] = float(&text).map_err(at)?;
            has_coordinates = true;
        }
    }
    match value {
        Some(_) if has_coordinates => {
            Err(at("“value” and “x”, “y”, “z” exclude each other".to_owned()))
        }
        Some(text) => three(&text).map_err(at),
        None => Ok(vector),
    }
}

/// A rotation. The axis isn't normalised, as in Mitsuba.
fn rotation(
    element: Element,
    defaults: &Defaults,
    axis_length: &mut Option<f64>,
) -> Result<DMat4, Problem> {
    /// An axis with four decimals deviates by less.
    const TOLERANCE: f64 = 1e-3;
    let axis = vector(element, defaults, 0.0, &["value", "x", "y", "z", "angle"])?;
    let angle = element.required("angle", defaults)?;
    let degrees = float(&angle).map_err(|message| element.problem(message))?;
    if axis == DVec3::ZERO {
        return Err(element.problem("the rotation axis is zero"));
    }
    if (axis.length() - 1.0).abs() > TOLERANCE {
        axis_length.get_or_insert(axis.length());
    }
    let (sin, cos) = sin_cos_degrees(degrees);
    let across = axis * axis.zxy() * (1.0 - cos);
    // Exact for a coordinate of 0, 1 or −1.
    let along = axis.to_array().map(|a| match a * a {
        1.0 => 1.0,
        squared => cos + squared * (1.0 - cos),
    });
    // `across` holds the products xz, yx and zy.
    let DVec3 { x, y, z } = axis * sin;
    let rotation = DMat3::from_cols(
        DVec3::new(along[0], across.y + z, across.x - y),
        DVec3::new(across.y - z, along[1], across.z + x),
        DVec3::new(across.x + y, across.z - x, along[2]),
    );
    Ok(DMat4::from_mat3(rotation))
}

/// Sine and cosine, exact for multiples of 90°.
fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    // Exact.
    let reduced = degrees % 360.0;
    match reduced.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => reduced.to_radians().sin_cos(),
    }
}

/// 9 or 16 numbers, row by row. The last row of 16 must be 0 0 0 1; Mitsuba ignores it.
fn matrix(element: Element, defaults: &Defaults) -> Result<DMat4, Problem> {
    element.require_known_attributes(&["value"])?;
    let text = element.required("value", defaults)?;
    let numbers = floats(&text, 16).map_err(|message| element.problem(message))?;
    match *numbers {
        [a, b, c, d, e, f, g, h, i] => {
            let rows = DMat3::from_cols_array(&[a, b, c, d, e, f, g, h, i]);
            Ok(DMat4::from_mat3(rows.transpose()))
        }
        [a, b, c, d, e, f, g, h, i, j, k, l, 0.0, 0.0, 0.0, 1.0] => Ok(DMat4::from_cols(
            DVec4::new(a, e, i, 0.0),
            DVec4::new(b, f, j, 0.0),
            DVec4::new(c, g, k, 0.0),
            DVec4::new(d, h, l, 1.0),
        )),
        [.., x, y, z, w] if numbers.len() == 16 => Err(element.problem(format!(
            "the last row of the matrix must be 0 0 0 1, not {x} {y} {z} {w}; other transforms aren't affine"
        ))),
        _ => Err(element.problem(format!("{} isn't a list of 9 or 16 numbers", quoted(&text)))),
    }
}

/// Places the origin at `origin`, with +z towards `target`, y upwards and x to the left.
fn look_at(element: Element, defaults: &Defaults) -> Result<DMat4, Problem> {
    let at = |message: &str| element.problem(message);
    element.require_known_attributes(&["origin", "target", "up"])?;
    let point = |name: &str| {
        let text = element.required(name, defaults)?;
        let numbers = floats(&text, 3).map_err(|message| element.problem(message))?;
        <[f64; 3]>::try_from(numbers)
            .map(DVec3::from)
            .map_err(|_| element.problem(format!("{} isn't three numbers", quoted(&text))))
    };
    let (origin, target) = (point("origin")?, point("target")?);
    let forward = (target - origin).try_normalize();
    let forward = forward.ok_or_else(|| at("origin and target are the same point"))?;
    let up = match element.node.has_attribute("up") {
        true => point("up")?,
        // As in Mitsuba. Source: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
        false => forward.any_orthonormal_pair().0,
    };
    let left = up.cross(forward).try_normalize();
    let left = left.ok_or_else(|| at("the up vector is zero or points towards the target"))?;
    let up = forward.cross(left);
    Ok(DMat4::from_cols(
        left.extend(0.0),
        up.extend(0.0),
        forward.extend(0.0),
        origin.extend(1.0),
    ))
}
