//! Names of the parameters of shapes.

use super::ShapeInfo;

/// A named parameter of a shape, made of one or three of its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The name, as in JSON.
    pub name: &'static str,
    /// The symbol in the shape's equations.
    pub symbol: &'static str,
    /// The meaning of its numbers.
    pub kind: ParameterKind,
}

/// The meaning of a parameter's numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// Three coordinates of a point, relative to the scene's origin.
    Point,
    /// Three coordinates of a vector.
    Vector,
    /// One number.
    Number,
    /// 1 for yes, 0 for no.
    Flag,
}

impl Parameter {
    /// A parameter that is a point.
    pub(super) const fn point(name: &'static str, symbol: &'static str) -> Self {
        Self {
            name,
            symbol,
            kind: ParameterKind::Point,
        }
    }

    /// A parameter that is a vector.
    pub(super) const fn vector(name: &'static str, symbol: &'static str) -> Self {
        Self {
            name,
            symbol,
            kind: ParameterKind::Vector,
        }
    }

    /// A parameter that is a number.
    pub(super) const fn number(name: &'static str, symbol: &'static str) -> Self {
        Self {
            name,
            symbol,
            kind: ParameterKind::Number,
        }
    }

    /// A parameter that is true or false.
    pub(super) const fn flag(name: &'static str) -> Self {
        Self {
            name,
            symbol: name,
            kind: ParameterKind::Flag,
        }
    }

    /// How many of the shape's numbers it consists of.
    pub fn width(self) -> usize {
        match self.kind {
            ParameterKind::Point | ParameterKind::Vector => 3,
            ParameterKind::Number | ParameterKind::Flag => 1,
        }
    }
}

impl ShapeInfo {
    /// Each parameter with its numbers, from the numbers of a primitive.
    ///
    /// # Panics
    /// If there are fewer numbers than the parameters consist of.
    pub fn named<'n>(
        &self,
        mut numbers: &'n [f32],
    ) -> impl Iterator<Item = (&'static Parameter, &'n [f32])> {
        self.parameters.iter().map(move |parameter| {
            let (own, rest) = numbers.split_at(parameter.width());
            numbers = rest;
            (parameter, own)
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::shape::{Shape as _, Sphere};

    #[test]
    fn numbers_are_split_by_parameter() {
        let named = Sphere::INFO.named(&[1.0, 2.0, 3.0, 4.0]);
        let named = named.map(|(parameter, own)| (parameter.name, own.to_vec()));
        let expected = [("centre", vec![1.0, 2.0, 3.0]), ("radius", vec![4.0])];
        assert_eq!(named.collect::<Vec<_>>(), expected);
    }
}
