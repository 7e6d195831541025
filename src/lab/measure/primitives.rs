//! Scenes of random primitives of one shape.

use super::shapes::{Sampled, SampledSolid};
use glam::DVec3;
use hitscope_core::Scene;
use hitscope_core::group::Grouped;
use hitscope_core::mesh::{Runs, TriangleMesh};
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use hitscope_core::scene::SceneOptions;
use hitscope_core::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Disk, Plane, Quadric, Rectangle, Sphere, Torus,
    Triangle,
};

/// The greatest depth of a solid's tree of operations.
const SOLID_DEPTH: u32 = 2;
/// There is one solid for this many primitives of other shapes.
const PRIMITIVES_PER_SOLID: usize = 8;

/// The numbers of primitives of a shape.
#[derive(Clone, Copy)]
pub(super) struct Counts {
    /// Of a bounded shape; there are fewer solids.
    pub bounded: usize,
    /// Of an infinite shape, for which there is no tree.
    pub infinite: usize,
}

/// A scene of each shape. The triangles are a group, not the scene's mesh.
pub(super) fn scenes(counts: Counts, random: &mut Random) -> [Scene; 13] {
    [
        primitives::<Triangle>(counts, random),
        primitives::<Sphere>(counts, random),
        primitives::<Plane>(counts, random),
        primitives::<AxisPlane>(counts, random),
        primitives::<Disk>(counts, random),
        primitives::<Rectangle>(counts, random),
        primitives::<Cuboid>(counts, random),
        primitives::<AxisBox>(counts, random),
        primitives::<Cylinder>(counts, random),
        primitives::<Cone>(counts, random),
        primitives::<Torus>(counts, random),
        primitives::<Quadric>(counts, random),
        solids(counts.bounded.div_ceil(PRIMITIVES_PER_SOLID), random),
    ]
}

/// A place in a cube in which there is room for `n` primitives of size 1.
fn place(n: usize, random: &mut Random) -> DVec3 {
    (n as f64).cbrt() * random.in_cube()
}

fn primitives<S: Sampled>(counts: Counts, random: &mut Random) -> Scene {
    let n = if S::IS_BOUNDED {
        counts.bounded
    } else {
        counts.infinite
    };
    let sample = |_| {
        let near = place(n, random);
        S::sample(random, near, 1.0)
    };
    of_primitives((0..n).map(sample).collect())
}

/// A scene of these primitives.
pub(super) fn of_primitives<S: Grouped>(primitives: Vec<S>) -> Scene {
    let mut scene = hitscope_core::scene::scene(TriangleMesh::default());
    let (options, progress) = (SceneOptions::default(), Progress::default());
    let added = scene.add_group(primitives, Runs::default(), options, &progress);
    added.expect("nobody cancels");
    scene
}

fn solids(n: usize, random: &mut Random) -> Scene {
    let sample = |_| {
        let near = place(n, random);
        let sampled = SampledSolid::random_bounded(random, near, 1.0, SOLID_DEPTH);
        sampled.solid.solid()
    };
    let sampled = (0..n).map(sample).collect();
    let mut scene = hitscope_core::scene::scene(TriangleMesh::default());
    let added = scene.add_solids(sampled, Runs::default(), &Progress::default());
    added.expect("nobody cancels");
    scene
}
