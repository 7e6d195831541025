//! Self-hits of rays that the default policy spawns on combined solids.

use super::solids::SampledSolid;
use super::spawning::{Again, ShapeSpawnCell, SpawnPlace, SpawnSurface, measure_surfaces};
use crate::oracle::{EnclosingShape, OracleSolid};
use glam::DVec3;
use hitscope_core::group::{CSG_KERNELS, SOLID_INFO};
use hitscope_core::kernel::{KernelChoice, KernelInfo};
use hitscope_core::random::Random;
use hitscope_core::shape::SurfacePoint;
use hitscope_core::{Hit, Intersector, Ray, Scene};
use std::cmp::Ordering;
use std::sync::Arc;

/// The depth of the trees of operations.
const DEPTH: u32 = 2;

/// Spawns up to `n` rays at hits of random bounded solids by each kernel; fewer where rays hit less than one in 16.
pub fn measure_solid_spawning(
    case: &str,
    kernels: &[&'static KernelInfo],
    place: SpawnPlace,
    n: u64,
    seed: u64,
) -> Vec<ShapeSpawnCell> {
    let cell = |&info: &&'static KernelInfo| {
        let sample = |random: &mut Random, near: DVec3| {
            let sampled = SampledSolid::random_bounded(random, near, place.size, DEPTH);
            PackedSolid::new(sampled.solid, KernelChoice { info })
        };
        let names = [SOLID_INFO.name, info.name];
        measure_surfaces(case, names, &sample, place, n, seed)
    };
    kernels.iter().map(cell).collect()
}

/// The same for all kernels of solids and a quarter of the rays, as packing a solid takes longer than tracing it.
pub(super) fn measure_all(case: &str, place: SpawnPlace, n: u64, seed: u64) -> Vec<ShapeSpawnCell> {
    measure_solid_spawning(case, &CSG_KERNELS, place, n.div_ceil(4), seed)
}

/// A solid in a scene of its own, packed for a kernel.
struct PackedSolid {
    solid: OracleSolid,
    operands: Vec<Arc<dyn EnclosingShape>>,
    scene: Scene,
    intersector: Box<dyn Intersector>,
}

impl PackedSolid {
    fn new(solid: OracleSolid, kernel: KernelChoice) -> Self {
        let scene = solid.scene();
        Self {
            operands: solid.operands(),
            intersector: scene.intersector(kernel),
            solid,
            scene,
        }
    }
}

impl SpawnSurface for PackedSolid {
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.intersector.closest_hit(ray)
    }

    fn point(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        self.scene.surface(ray, hit)
    }

    /// The ray began beyond an edge if it hits another operand or part. So it did if it began on the wrong side of the
    /// solid's surface, but on the right side of that of the operand that it left: close to a seam of two operands, or in a
    /// part of the solid that is thinner than the rounding.
    fn judge(&self, left: &Hit, is_outwards: bool, ray: &Ray, again: &Hit) -> Again {
        let (group, index) = self.scene.group_of(left.primitive);
        let is_same_part = [left.u, left.v] == [again.u, again.v];
        let Some(solid) = group.solid(index).filter(|_| is_same_part) else {
            return Again::BeyondEdge;
        };
        let (number, operand) = solid.operand_of(left);
        let right_side = if is_outwards != operand.is_subtracted {
            Ordering::Greater
        } else {
            Ordering::Less
        };
        let began_on_right_side = self.operands[number].side(ray, 0.0) == right_side;
        let began_as_it_should = self.solid.is_inside(ray, 0.0) == Some(!is_outwards);
        if began_on_right_side && !began_as_it_should {
            Again::BeyondEdge
        } else {
            Again::Same
        }
    }

    fn is_convex(&self) -> bool {
        false
    }
}
