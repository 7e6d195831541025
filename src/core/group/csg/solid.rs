//! Solids: shapes combined by set operations.

use crate::aabb::Aabb;
use crate::group::{Appearance, Group, Grouped, SceneOptions};
use crate::progress::Progress;
use crate::ray::{Hit, Ray};
use crate::shape::{Cuboid, Quadric, SurfacePoint, UNBOUNDED};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// An operation on solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CsgOperation {
    /// All points in any solid.
    Union,
    /// The points in every solid.
    Intersection,
    /// The points in the first solid and in no other.
    Difference,
}

impl CsgOperation {
    /// All operations.
    pub const ALL: [Self; 3] = [Self::Union, Self::Intersection, Self::Difference];

    /// The name, as in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Union => "union",
            Self::Intersection => "intersection",
            Self::Difference => "difference",
        }
    }

    /// Whether a point is inside a combination, given whether it is inside each of the combined solids.
    fn is_inside(self, mut solids: impl ExactSizeIterator<Item = bool>) -> bool {
        match self {
            Self::Union => solids.any(|is_inside| is_inside),
            Self::Intersection => solids.len() > 0 && solids.all(|is_inside| is_inside),
            Self::Difference => {
                solids.next().unwrap_or(false) && !solids.any(|is_inside| is_inside)
            }
        }
    }
}

/// A solid: a shape's interior, or a combination of such solids. A point is on the surface
/// only if it separates inside from outside (“regularised” operations).
#[derive(Clone, Debug)]
pub struct Solid {
    operands: Vec<SolidOperand>,
    root: SolidNode,
    /// The boxes around the points inside and around all others.
    bounds_of_sides: [Aabb; 2],
}

/// The interior of a shape, as part of a solid.
#[derive(Clone, Debug)]
pub struct SolidOperand {
    /// A group of the one shape whose crossings count.
    pub boundary: Arc<dyn Group>,
    /// A group of the one shape that the surface belongs to: a quadric with its box.
    pub surface: Arc<dyn Group>,
    /// Whether it is subtracted, so that its normals are reversed.
    pub is_subtracted: bool,
}

impl SolidOperand {
    /// The solid's normal where the shape's is `normal`.
    pub fn outward(&self, normal: DVec3) -> DVec3 {
        if self.is_subtracted { -normal } else { normal }
    }
}

/// A part of a solid.
#[derive(Clone, Debug)]
pub enum SolidNode {
    /// The interior of a shape, as an index into [`Solid::operands`].
    Operand(usize),
    /// A combination of parts.
    Operation(CsgOperation, Vec<SolidNode>),
}

impl Solid {
    /// The interior of a shape, empty if its surface isn't closed or a number isn't finite. A plane's interior is the
    /// half-space behind its normal. For a quadric use [`of_quadric`](Self::of_quadric).
    pub fn of<S: Grouped>(shape: S) -> Self {
        let bounds_of_sides = shape.bounds_of_sides();
        let group = group_of(shape);
        Self::one(Arc::clone(&group), group, bounds_of_sides)
    }

    /// The points in a quadric's box where the left side of its equation is negative.
    pub fn of_quadric(quadric: Quadric) -> Self {
        let boundary = group_of(Quadric {
            half: Vec3::splat(UNBOUNDED),
            ..quadric
        });
        let Vec3 { x, y, z } = quadric.half;
        let cut = Cuboid {
            centre: quadric.centre,
            axes: [x * Vec3::X, y * Vec3::Y, z * Vec3::Z],
        };
        let inside = Self::one(boundary, group_of(quadric), [Aabb::EVERYWHERE; 2]);
        Self::combined(CsgOperation::Intersection, vec![inside, Self::of(cut)])
    }

    fn one(boundary: Arc<dyn Group>, surface: Arc<dyn Group>, bounds_of_sides: [Aabb; 2]) -> Self {
        Self {
            operands: vec![SolidOperand {
                boundary,
                surface,
                is_subtracted: false,
            }],
            root: SolidNode::Operand(0),
            bounds_of_sides,
        }
    }

    /// Combines solids. Without any, the result is empty.
    pub fn combined(operation: CsgOperation, solids: Vec<Self>) -> Self {
        let boxes: Vec<[Aabb; 2]> = solids.iter().map(|solid| solid.bounds_of_sides).collect();
        let (mut operands, mut nodes) = (Vec::new(), Vec::new());
        for (index, solid) in solids.into_iter().enumerate() {
            let is_subtracted = operation == CsgOperation::Difference && index > 0;
            nodes.push(solid.root.moved(operands.len()));
            operands.extend(solid.operands.into_iter().map(|operand| SolidOperand {
                is_subtracted: operand.is_subtracted != is_subtracted,
                ..operand
            }));
        }
        Self {
            operands,
            root: SolidNode::Operation(operation, nodes),
            bounds_of_sides: bounds_of_sides(operation, boxes),
        }
    }

    /// Upper bound on the bytes of a solid in a group, with its boundaries' trees, and packed for a kernel.
    pub(crate) fn bytes(operand_count: usize) -> u64 {
        /// Measured with 20 000 solids of two operands and with one of 50 000 (2026-11).
        const BYTES_PER_SOLID: usize = 1_000;
        const BYTES_PER_OPERAND: usize = 2_400;
        (BYTES_PER_SOLID + BYTES_PER_OPERAND * operand_count) as u64
    }

    /// The box around it; `None` if it may be infinite.
    pub fn bounds(&self) -> Option<Aabb> {
        let bounds = self.infinite_bounds();
        let is_finite = bounds.min.is_finite() && bounds.max.is_finite();
        (bounds.is_empty() || is_finite).then_some(bounds)
    }

    /// The box around it, infinite in the directions in which it may be.
    pub(super) fn infinite_bounds(&self) -> Aabb {
        self.bounds_of_sides[0]
    }

    /// The shapes that it is made of, in the order in which its parts name them.
    pub fn operands(&self) -> &[SolidOperand] {
        &self.operands
    }

    /// The tree of operations.
    pub fn root(&self) -> &SolidNode {
        &self.root
    }

    /// The operand whose surface is hit.
    ///
    /// # Panics
    /// If it isn't a hit of this solid.
    pub fn operand_of(&self, hit: &Hit) -> (usize, &SolidOperand) {
        let index = hit.v as usize;
        (index, &self.operands[index])
    }

    /// Whether a point is inside, given whether it is inside each operand.
    pub(super) fn is_inside(&self, operands: &[bool]) -> bool {
        self.root.is_inside(operands)
    }

    /// The surface at a hit; `hit.v` is the index of the operand.
    pub(super) fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let (_, operand) = self.operand_of(hit);
        let own = Hit {
            v: 0.0,
            primitive: 0,
            ..*hit
        };
        let point = operand.surface.surface(ray, &own);
        SurfacePoint {
            normal: operand.outward(point.normal),
            // A spawned ray may hit another operand.
            is_flat: false,
            ..point
        }
    }
}

impl SolidNode {
    /// The same node after `count` other operands.
    fn moved(self, count: usize) -> Self {
        match self {
            Self::Operand(index) => Self::Operand(index + count),
            Self::Operation(operation, nodes) => {
                let nodes = nodes.into_iter().map(|node| node.moved(count));
                Self::Operation(operation, nodes.collect())
            }
        }
    }

    /// Whether a point is inside, given whether it is inside each operand.
    fn is_inside(&self, operands: &[bool]) -> bool {
        match self {
            Self::Operand(index) => operands[*index],
            Self::Operation(operation, nodes) => {
                operation.is_inside(nodes.iter().map(|node| node.is_inside(operands)))
            }
        }
    }

    /// Passes the node and all below it to `visit`: each before its own parts.
    pub(super) fn each<'a>(&'a self, visit: &mut impl FnMut(&'a Self)) {
        visit(self);
        if let Self::Operation(_, nodes) = self {
            nodes.iter().for_each(|node| node.each(visit));
        }
    }

    /// Whether a point is inside each node, in the order of [`each`](Self::each).
    pub(super) fn inside_each(&self, operands: &[bool]) -> Vec<bool> {
        let mut inside = Vec::new();
        self.each(&mut |node| inside.push(node.is_inside(operands)));
        inside
    }
}

/// A group of one primitive.
fn group_of<S: Grouped>(shape: S) -> Arc<dyn Group> {
    let (options, progress) = (SceneOptions::default(), Progress::default());
    let group = S::group(vec![shape], Appearance::default(), options, &progress);
    group.expect("nobody cancels")
}

/// The boxes around the points inside a combination of solids and around all others, from those of the solids.
fn bounds_of_sides(operation: CsgOperation, mut solids: Vec<[Aabb; 2]>) -> [Aabb; 2] {
    // A point is inside a difference if it is inside the first solid and outside each of the others.
    if operation == CsgOperation::Difference {
        solids.iter_mut().skip(1).for_each(|sides| sides.reverse());
    }
    let of_side = |side: usize| solids.iter().map(move |sides| sides[side]);
    let in_any = |side: usize| of_side(side).fold(Aabb::EMPTY, Aabb::union);
    let in_all = |side: usize| of_side(side).fold(Aabb::EVERYWHERE, Aabb::intersection);
    match operation {
        CsgOperation::Union => [in_any(0), in_all(1)],
        _ if solids.is_empty() => [Aabb::EMPTY, Aabb::EVERYWHERE],
        CsgOperation::Intersection | CsgOperation::Difference => [in_all(0), in_any(1)],
    }
}
