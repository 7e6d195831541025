//! Objects that are kept as they stand in the file: integrators, and emitters that aren't supported.

use super::description::Place;
use glam::{DMat4, DVec3};

/// An object with its parameters, of which only the types of values are checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Plugin {
    /// The start of its element.
    pub place: Place,
    /// The element's name, such as `emitter`.
    pub element: String,
    /// The `type` attribute.
    pub kind: String,
    /// The `id` attribute.
    pub id: Option<String>,
    /// The `name` attribute.
    pub name: Option<String>,
    /// The parameters in the order of the file.
    pub parameters: Vec<Parameter>,
    /// The nested objects in the order of the file.
    pub children: Vec<Plugin>,
}

/// A parameter of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its element.
    pub place: Place,
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: Value,
}

/// The value of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `<boolean>`.
    Boolean(bool),
    /// `<integer>`.
    Integer(i64),
    /// `<float>`.
    Float(f64),
    /// `<string>`.
    Text(String),
    /// `<point>`.
    Point(DVec3),
    /// `<vector>`.
    Vector(DVec3),
    /// `<rgb>`, linear.
    Rgb(DVec3),
    /// `<spectrum>` with the same value at all wavelengths.
    Spectrum(f64),
    /// `<transform>`, composed.
    Transform(Box<DMat4>),
    /// `<ref>`: the identifier of another object.
    Reference(String),
}

impl Parameter {
    /// The memory that the parameter takes.
    pub(super) fn bytes(&self) -> usize {
        let text_length = match &self.value {
            Value::Text(text) | Value::Reference(text) => text.len(),
            _ => 0,
        };
        size_of::<Self>() + self.name.len() + text_length
    }
}

impl Value {
    /// The name of the element with such a value.
    pub fn element(&self) -> &'static str {
        match self {
            Self::Boolean(_) => "boolean",
            Self::Integer(_) => "integer",
            Self::Float(_) => "float",
            Self::Text(_) => "string",
            Self::Point(_) => "point",
            Self::Vector(_) => "vector",
            Self::Rgb(_) => "rgb",
            Self::Spectrum(_) => "spectrum",
            Self::Transform(_) => "transform",
            Self::Reference(_) => "ref",
        }
    }
}
