//! The parameters of a primitive by name.

use hitscope_core::group::Group;
use hitscope_core::shape::ParameterKind;
use hitscope_core::{Scene, TriangleMesh};
use serde::{Serialize, Serializer};
use std::fmt::{self, Display, Formatter};

/// The parameters of a primitive, in the order of its shape. Serialises to an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters(pub Vec<ParameterReport>);

/// A parameter of a primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterReport {
    /// Its name.
    pub name: &'static str,
    /// Its symbol in formulas.
    pub symbol: &'static str,
    /// Its value.
    pub value: ParameterValue,
}

/// The value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum ParameterValue {
    /// A point in the file's coordinates.
    Point([f64; 3]),
    /// A vector.
    Vector([f32; 3]),
    /// A number.
    Number(f32),
    /// Yes or no.
    Flag(bool),
}

impl Parameters {
    /// The parameters of a primitive of a scene, if it is neither a triangle nor a solid.
    pub fn of_primitive(scene: &Scene, primitive: u32) -> Option<Self> {
        if scene.is_triangle(primitive) {
            return None;
        }
        let (group, index) = scene.group_of(primitive);
        let is_solid = group.solid(index).is_some();
        (!is_solid).then(|| Self::of(group, index, scene.mesh()))
    }

    /// The parameters of a primitive of a group.
    pub(super) fn of(group: &dyn Group, index: u32, mesh: &TriangleMesh) -> Self {
        let numbers = group.numbers(index);
        let named = group.shape().named(&numbers).map(|(parameter, own)| {
            let three = || [own[0], own[1], own[2]];
            ParameterReport {
                name: parameter.name,
                symbol: parameter.symbol,
                value: match parameter.kind {
                    ParameterKind::Point => {
                        let in_file = mesh.vertex_in_file(three().into());
                        ParameterValue::Point(in_file.to_array())
                    }
                    ParameterKind::Vector => ParameterValue::Vector(three()),
                    ParameterKind::Number => ParameterValue::Number(own[0]),
                    ParameterKind::Flag => ParameterValue::Flag(own[0] != 0.0),
                },
            }
        });
        Self(named.collect())
    }
}

impl Display for ParameterValue {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Point(p) => write!(f, "{p:?}"),
            Self::Vector(v) => write!(f, "{v:?}"),
            Self::Number(x) => write!(f, "{x}"),
            Self::Flag(is_set) => f.write_str(if *is_set { "yes" } else { "no" }),
        }
    }
}

impl Serialize for Parameters {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let pairs = self
            .0
            .iter()
            .map(|parameter| (parameter.name, parameter.value));
        serializer.collect_map(pairs)
    }
}
