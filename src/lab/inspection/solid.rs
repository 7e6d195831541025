//! A hit of a solid: the operand that is hit, and the intervals of t inside each part.

use super::Parameters;
use crate::formula;
use hitscope_core::group::{LineIntervals, Solid, SolidNode, SolidOperand};
use hitscope_core::{Hit, Ray, Scene, TriangleMesh};
use serde::Serialize;

/// The number and the shape of a solid's operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct OperandName {
    /// Its index in the solid, counted from 0.
    pub index: usize,
    /// Its shape.
    pub shape: &'static str,
}

/// An operand of a solid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OperandReport {
    /// Its number and shape.
    #[serde(flatten)]
    pub name: OperandName,
    /// Its parameters by name.
    pub parameters: Parameters,
    /// Whether it is subtracted. The solid's normal is then the opposite of the operand's.
    pub is_subtracted: bool,
}

/// A hit of a solid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SolidReport {
    /// The operand whose surface is hit.
    pub operand: OperandReport,
    /// The tree of operations.
    pub tree: SolidPart,
    /// The tree as text, one part per line.
    #[serde(skip)]
    pub lines: Vec<String>,
}

/// A part of a solid.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SolidPart {
    /// The operand or the operation.
    #[serde(flatten)]
    pub kind: SolidPartKind,
    /// The intervals of t inside this part along the ray's whole line, decided as in exact arithmetic and rounded to f64.
    /// JSON has null for an infinite end.
    pub intervals: Vec<[f64; 2]>,
}

/// A shape or an operation.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum SolidPartKind {
    /// The interior of a shape.
    Operand(OperandReport),
    /// A combination of parts.
    Operation {
        /// Its name.
        operation: &'static str,
        /// What it combines.
        parts: Vec<SolidPart>,
    },
}

impl OperandName {
    /// The operand whose surface is hit, if the primitive is a solid.
    pub fn of_hit(scene: &Scene, hit: &Hit) -> Option<Self> {
        let (group, index) = scene.group_of(hit.primitive);
        let (index, operand) = group.solid(index)?.operand_of(hit);
        Some(Self::new(index, operand))
    }

    fn new(index: usize, operand: &SolidOperand) -> Self {
        Self {
            index,
            shape: operand.surface.shape().name,
        }
    }
}

impl OperandReport {
    fn new(index: usize, operand: &SolidOperand, mesh: &TriangleMesh) -> Self {
        Self {
            name: OperandName::new(index, operand),
            parameters: Parameters::of(&*operand.surface, 0, mesh),
            is_subtracted: operand.is_subtracted,
        }
    }
}

impl SolidReport {
    /// The solid that a ray hits; `None` if the primitive isn't a solid. `t_as_given` converts t of the ray.
    pub fn new(
        scene: &Scene,
        ray: &Ray,
        hit: &Hit,
        t_as_given: impl Fn(f64) -> f64,
    ) -> Option<Self> {
        let (group, index) = scene.group_of(hit.primitive);
        let solid = group.solid(index)?;
        let mesh = scene.mesh();
        let (index, operand) = solid.operand_of(hit);
        let intervals = solid.intervals(ray);
        let parts = Parts {
            solid,
            mesh,
            t_as_given: &t_as_given,
        };
        Some(Self {
            operand: OperandReport::new(index, operand, mesh),
            tree: parts.part(solid.root(), &mut intervals.iter()),
            lines: formula::solid_tree(solid, &intervals),
        })
    }
}

struct Parts<'a> {
    solid: &'a Solid,
    mesh: &'a TriangleMesh,
    t_as_given: &'a dyn Fn(f64) -> f64,
}

impl Parts<'_> {
    /// A part, to which the first of the intervals belong.
    fn part(&self, node: &SolidNode, rest: &mut std::slice::Iter<'_, LineIntervals>) -> SolidPart {
        let own = rest.next().map(LineIntervals::list).unwrap_or_default();
        let kind = match node {
            &SolidNode::Operand(index) => {
                let operand = &self.solid.operands()[index];
                SolidPartKind::Operand(OperandReport::new(index, operand, self.mesh))
            }
            SolidNode::Operation(operation, nodes) => SolidPartKind::Operation {
                operation: operation.name(),
                parts: nodes.iter().map(|node| self.part(node, rest)).collect(),
            },
        };
        SolidPart {
            kind,
            intervals: own
                .into_iter()
                .map(|ends| ends.map(self.t_as_given))
                .collect(),
        }
    }
}
