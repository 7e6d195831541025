//! The parameters of an object, looked up by name and type.

use super::description::Place;
use super::memory::Memory;
use super::plugin::{Parameter, Value};
use super::problem::{Problem, quoted, unknown};
use super::properties;
use super::warnings::Warnings;
use glam::{DMat4, DVec3};
use std::ops::RangeInclusive;

/// The parameters of an object that weren't looked up so far.
pub(super) struct Parameters {
    /// The object's element and type.
    element: &'static str,
    kind: String,
    place: Place,
    left: Vec<Parameter>,
    /// The names looked up.
    known: Vec<&'static str>,
    /// The memory taken for the parameters.
    bytes: u64,
}

impl Parameters {
    pub(super) fn new(element: &'static str, kind: &str, place: Place) -> Self {
        Self {
            element,
            kind: kind.to_owned(),
            place,
            left: Vec::new(),
            known: Vec::new(),
            bytes: 0,
        }
    }

    /// The object for messages, such as `shape “sphere”`.
    pub(super) fn object(&self) -> String {
        format!("{} {}", self.element, quoted(&self.kind))
    }

    /// # Errors
    /// There is a parameter of this name.
    pub(super) fn add(&mut self, parameter: Parameter) -> Result<(), Problem> {
        /// More than any object has; comparing all pairs takes quadratic time.
        const MAX_COUNT: usize = 64;
        let Parameter { place, name, .. } = &parameter;
        if self.left.iter().any(|other| other.name == *name) {
            let message = format!("parameter {} is given twice", quoted(name));
            return Err(Problem::at(*place, message));
        }
        if self.left.len() >= MAX_COUNT {
            let message = format!("{} has more than {MAX_COUNT} parameters", self.object());
            return Err(Problem::at(*place, message));
        }
        self.bytes += properties::bytes(&parameter);
        self.left.push(parameter);
        Ok(())
    }

    /// Whether one of these parameters is given.
    pub(super) fn has_any(&mut self, names: &[&'static str]) -> bool {
        self.known.extend(names);
        self.left
            .iter()
            .any(|other| names.contains(&other.name.as_str()))
    }

    /// Where the first of these parameters stands, if one is given.
    pub(super) fn place_of(&self, names: &[&str]) -> Option<Place> {
        let named = |parameter: &&Parameter| names.contains(&parameter.name.as_str());
        self.left
            .iter()
            .find(named)
            .map(|parameter| parameter.place)
    }

    /// Removes the parameter with a name.
    pub(super) fn take(&mut self, name: &'static str) -> Option<Parameter> {
        self.known.push(name);
        let index = self.left.iter().position(|other| other.name == name)?;
        Some(self.left.remove(index))
    }

    /// The value of a parameter, converted by `convert`, and its place.
    fn converted<T>(
        &mut self,
        name: &'static str,
        expected: &str,
        convert: impl FnOnce(&Value) -> Option<T>,
    ) -> Result<Option<(T, Place)>, Problem> {
        let Some(Parameter { place, value, .. }) = self.take(name) else {
            return Ok(None);
        };
        match convert(&value) {
            Some(converted) => Ok(Some((converted, place))),
            None => {
                let name = quoted(name);
                let message = format!("{name} must be <{expected}>, not <{}>", value.element());
                Err(Problem::at(place, message))
            }
        }
    }

    pub(super) fn float(&mut self, name: &'static str) -> Result<Option<(f64, Place)>, Problem> {
        self.converted(name, "float", |value| match *value {
            Value::Float(number) => Some(number),
            Value::Integer(number) => Some(number as f64),
            _ => None,
        })
    }

    /// A number greater than 0.
    pub(super) fn positive(&mut self, name: &'static str, default: f64) -> Result<f64, Problem> {
        match self.float(name)? {
            Some((number, place)) if number <= 0.0 => {
                let message = format!("{} must be greater than 0", quoted(name));
                Err(Problem::at(place, message))
            }
            found => Ok(found.map_or(default, |(number, _)| number)),
        }
    }

    /// An integer in a range.
    pub(super) fn count(
        &mut self,
        name: &'static str,
        range: RangeInclusive<u32>,
    ) -> Result<Option<u32>, Problem> {
        let Some((number, place)) = self.integer(name)? else {
            return Ok(None);
        };
        match u32::try_from(number) {
            Ok(count) if range.contains(&count) => Ok(Some(count)),
            _ => {
                let (least, most) = (range.start(), range.end());
                let message = format!("{} must be from {least} to {most}", quoted(name));
                Err(Problem::at(place, message))
            }
        }
    }

    pub(super) fn integer(&mut self, name: &'static str) -> Result<Option<(i64, Place)>, Problem> {
        self.converted(name, "integer", |value| match *value {
            Value::Integer(number) => Some(number),
            _ => None,
        })
    }

    pub(super) fn boolean(&mut self, name: &'static str, default: bool) -> Result<bool, Problem> {
        let found = self.converted(name, "boolean", |value| match *value {
            Value::Boolean(is_set) => Some(is_set),
            _ => None,
        })?;
        Ok(found.map_or(default, |(is_set, _)| is_set))
    }

    pub(super) fn text(&mut self, name: &'static str) -> Result<Option<(String, Place)>, Problem> {
        self.converted(name, "string", |value| match value {
            Value::Text(text) => Some(text.clone()),
            _ => None,
        })
    }

    /// A point or a vector; Mitsuba accepts either in place of the other.
    pub(super) fn point(&mut self, name: &'static str, default: DVec3) -> Result<DVec3, Problem> {
        let found = self.converted(name, "point", |value| match *value {
            Value::Point(p) | Value::Vector(p) => Some(p),
            _ => None,
        })?;
        Ok(found.map_or(default, |(p, _)| p))
    }

    /// A vector other than 0.
    pub(super) fn direction(
        &mut self,
        name: &'static str,
        default: DVec3,
    ) -> Result<DVec3, Problem> {
        let direction = self.point(name, default)?;
        if direction == DVec3::ZERO {
            return Err(self.problem(&format!("{} is zero", quoted(name))));
        }
        Ok(direction)
    }

    /// The transform from the object's coordinates.
    pub(super) fn world_transform(&mut self) -> Result<DMat4, Problem> {
        self.transform("to_world")
    }

    /// A transform; the identity by default.
    pub(super) fn transform(&mut self, name: &'static str) -> Result<DMat4, Problem> {
        let found = self.converted(name, "transform", |value| match value {
            Value::Transform(matrix) => Some(**matrix),
            _ => None,
        })?;
        Ok(found.map_or(DMat4::IDENTITY, |(matrix, _)| matrix))
    }

    /// Adds warnings about parameters that aren't used.
    pub(super) fn warn_about(&mut self, names: &[&'static str], warnings: &mut Warnings) {
        for name in names {
            if let Some(parameter) = self.take(name) {
                let name = quoted(name);
                let message = format!("{}: parameter {name} isn't used", self.object());
                warnings.add(parameter.place, message);
            }
        }
    }

    /// Gives the memory of the parameters back.
    ///
    /// # Errors
    /// There is a parameter that wasn't looked up.
    pub(super) fn finish(mut self, memory: &mut Memory) -> Result<(), Problem> {
        memory.give_back(self.bytes);
        self.known.sort_unstable();
        self.known.dedup();
        match self.left.first() {
            Some(Parameter { place, name, .. }) => {
                let what = format!("parameter of {}:", self.object());
                Err(Problem::at(*place, unknown(&what, name, &self.known)))
            }
            None => Ok(()),
        }
    }

    /// A problem with the object as a whole.
    pub(super) fn problem(&self, message: &str) -> Problem {
        Problem::at(self.place, format!("{}: {message}", self.object()))
    }
}
