//! Names of the parameters of shapes.

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
