//! Random combined solids.

use super::samples::Sampled;
use crate::oracle::{Enclosing, OracleSolid};
use glam::{DVec3, Vec3};
use hitscope_core::group::CsgOperation;
use hitscope_core::random::Random;
use hitscope_core::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Plane, Quadric, Sphere, Torus,
};

/// A random solid.
#[derive(Clone, Debug)]
pub struct SampledSolid {
    /// The solid.
    pub solid: OracleSolid,
    /// A point of an edge or of the surface of each of its shapes.
    pub points: Vec<DVec3>,
    /// The direction of an axis, or of a normal, of each of its shapes.
    pub axes: Vec<Vec3>,
}

/// A random primitive of one shape.
type SampleShape = fn(&mut Random, DVec3, f64) -> SampledSolid;

/// All closed shapes and half-spaces.
const SHAPES: [SampleShape; 9] = [
    sampled::<Sphere>,
    |random, near, size| {
        let cylinder = Cylinder::sample(random, near, size);
        one(
            random,
            Cylinder {
                is_capped: true,
                ..cylinder
            },
        )
    },
    |random, near, size| {
        let cone = Cone::sample(random, near, size);
        one(
            random,
            Cone {
                is_capped: true,
                ..cone
            },
        )
    },
    sampled::<Torus>,
    sampled::<Cuboid>,
    sampled::<AxisBox>,
    sampled::<Quadric>,
    sampled::<Plane>,
    sampled::<AxisPlane>,
];
/// The number of those that are bounded; they come first.
const BOUNDED: usize = 7;

fn sampled<S: Sampled + Enclosing>(random: &mut Random, near: DVec3, size: f64) -> SampledSolid {
    let shape = S::sample(random, near, size);
    one(random, shape)
}

fn one<S: Sampled + Enclosing>(random: &mut Random, shape: S) -> SampledSolid {
    SampledSolid {
        points: shape.edge_point(random).into_iter().collect(),
        axes: vec![shape.axis()],
        solid: OracleSolid::of(shape),
    }
}

impl SampledSolid {
    /// A combination of shapes of about this size near a point: a tree of operations of at most this depth, with random
    /// shapes and operations. It may be empty or unbounded.
    pub fn random(random: &mut Random, near: DVec3, size: f64, depth: u32) -> Self {
        Self::of_shapes(&SHAPES, random, near, size, depth)
    }

    /// The same without half-spaces.
    pub fn random_bounded(random: &mut Random, near: DVec3, size: f64, depth: u32) -> Self {
        Self::of_shapes(&SHAPES[..BOUNDED], random, near, size, depth)
    }

    fn of_shapes(
        shapes: &[SampleShape],
        random: &mut Random,
        near: DVec3,
        size: f64,
        depth: u32,
    ) -> Self {
        // One part in four ends before the greatest depth.
        if depth == 0 || random.index(4) == 0 {
            return shapes[random.index(shapes.len())](random, near, size);
        }
        let operation = CsgOperation::ALL[random.index(CsgOperation::ALL.len())];
        let count = if random.index(4) == 0 { 3 } else { 2 };
        let part = |_| Self::of_shapes(shapes, random, near, size, depth - 1);
        let parts: Vec<Self> = (0..count).map(part).collect();
        let points = parts.iter().flat_map(|part| &part.points).copied();
        let axes = parts.iter().flat_map(|part| &part.axes).copied();
        Self {
            points: points.collect(),
            axes: axes.collect(),
            solid: OracleSolid::Combined(
                operation,
                parts.into_iter().map(|part| part.solid).collect(),
            ),
        }
    }
}
