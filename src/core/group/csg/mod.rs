//! Constructive solid geometry: solids combined by set operations.
//!
//! Source: Roth, "Ray Casting for Modeling Solids", Computer Graphics and Image Processing 18(2), 1982.
//!
//! | module | contents |
//! |---|---|
//! | `solid` | solids as trees of operations over shapes |
//! | `crossings` | the points at which a ray enters and leaves a solid |
//! | `along_line` | the intervals of a line inside a solid, for display |
//! | `intersector` | intersector of several solids |
//! | `kernels` | one description per tier |
//! | `lines` | wireframe lines |

mod along_line;
mod crossings;
mod intersector;
mod kernels;
mod lines;
mod solid;

pub use along_line::LineIntervals;
pub use kernels::CSG_KERNELS;
pub use solid::{CsgOperation, Solid, SolidNode, SolidOperand};

use super::{Appearance, Group, Shown};
use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::intersector::GroupIntersector;
use crate::kernel::{KernelChoice, KernelInfo, Tier};
use crate::progress::{Cancelled, Progress};
use crate::ray::{Hit, Ray};
use crate::shape::{AddLine, Interior, LineDetail, ShapeInfo, SurfacePoint};
use crate::simd::SimdLevel;
use crossings::PackedSolid;
use intersector::CsgIntersector;
use kernels::kernel_of;
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

/// The names of solids.
pub static INFO: ShapeInfo = ShapeInfo {
    name: "solid",
    plural: "solids",
    parameters: &[],
    equations: &[],
};

/// A group of combined solids.
#[derive(Debug)]
pub(crate) struct CsgGroup {
    solids: Arc<Vec<Solid>>,
    bvh: Arc<Bvh>,
    bounds: Aabb,
    build_time: Duration,
    /// The material and the side of each solid.
    appearance: Appearance,
    /// Each solid packed for the exact kernel, on first use.
    exact: Vec<OnceLock<PackedSolid>>,
}

impl CsgGroup {
    /// Builds the tree.
    pub fn new(
        solids: Vec<Solid>,
        appearance: Appearance,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        Self::with_shown(Arc::new(solids), appearance, &Shown::default(), progress)
    }

    /// A group with a tree over the solids that are shown.
    fn with_shown(
        solids: Arc<Vec<Solid>>,
        appearance: Appearance,
        shown: &Shown,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let start = Instant::now();
        let (count, are_bounded) = (solids.len(), solids.iter().all(|s| s.bounds().is_some()));
        let bounds_of = |index: u32| solids[index as usize].bounds().unwrap_or(Aabb::EMPTY);
        // A tree leaves out solids with an empty box.
        let shown_bounds = |index: u32| {
            if shown.contains(index) {
                bounds_of(index)
            } else {
                Aabb::EMPTY
            }
        };
        let bvh = if are_bounded {
            Bvh::build(count, &shown_bounds, &|| progress.check())?
        } else {
            Bvh::unbounded(&shown.indices(count))
        };
        let boxes = (0..count as u32).map(bounds_of);
        Ok(Self {
            bounds: boxes.fold(Aabb::EMPTY, Aabb::union),
            bvh: Arc::new(bvh),
            build_time: start.elapsed(),
            exact: solids.iter().map(|_| OnceLock::new()).collect(),
            solids,
            appearance,
        })
    }

    fn exact(&self, index: u32) -> &PackedSolid {
        self.exact[index as usize].get_or_init(|| {
            let exact = KernelChoice {
                info: kernel_of(Tier::Exact),
            };
            PackedSolid::new(&self.solids[index as usize], exact, SimdLevel::current())
        })
    }
}

impl Group for CsgGroup {
    fn shape(&self) -> &'static ShapeInfo {
        &INFO
    }

    fn kernels(&self) -> Vec<&'static KernelInfo> {
        CSG_KERNELS.to_vec()
    }

    fn count(&self) -> usize {
        self.solids.len()
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn is_bounded(&self) -> bool {
        self.solids.iter().all(|solid| solid.bounds().is_some())
    }

    fn bvh(&self) -> Arc<Bvh> {
        Arc::clone(&self.bvh)
    }

    fn has_best_tree(&self) -> bool {
        true
    }

    fn build_time(&self) -> Duration {
        self.build_time
    }

    fn improve(&self, _: &Progress) -> Result<(), Cancelled> {
        Ok(())
    }

    /// `hit.v` is the index of the operand whose surface is hit.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let mut surface = self.solids[hit.primitive as usize].surface(ray, hit);
        self.appearance.turn(hit.primitive, &mut surface);
        surface
    }

    fn lines(&self, index: u32, detail: &LineDetail, add: AddLine<'_>) {
        let lines = |add: AddLine<'_>| self.exact(index).lines(detail, add);
        self.appearance.lines(index, lines, add);
    }

    /// A solid isn't an operand of another: trees are flattened.
    fn interior(&self, _: u32, _: &Ray) -> Interior {
        Interior::Open
    }

    fn solid(&self, index: u32) -> Option<&Solid> {
        self.solids.get(index as usize)
    }

    fn exact_answer(&self, ray: &Ray, index: u32) -> Option<[f64; 3]> {
        let first = self.exact(index).crossings(ray).into_iter().next()?;
        Some([first.t_in_f64(), first.hit.u.into(), first.hit.v.into()])
    }

    fn material(&self, index: u32) -> u32 {
        self.appearance.materials.of(index)
    }

    fn is_flipped(&self, index: u32) -> bool {
        self.appearance.is_flipped(index)
    }

    fn numbers(&self, _: u32) -> Vec<f32> {
        Vec::new()
    }

    fn subset(&self, indices: &[u32]) -> Arc<dyn Group> {
        let solids = indices.iter().map(|&i| self.solids[i as usize].clone());
        let sides = self.appearance.sides_of(indices);
        let group = Self::new(solids.collect(), sides, &Progress::default());
        Arc::new(group.expect("nobody cancels"))
    }

    fn showing(&self, shown: Shown, progress: &Progress) -> Result<Arc<dyn Group>, Cancelled> {
        let (solids, appearance) = (Arc::clone(&self.solids), self.appearance.clone());
        let group = Self::with_shown(solids, appearance, &shown, progress)?;
        Ok(Arc::new(group))
    }

    fn intersector(&self, kernel: KernelChoice, level: SimdLevel) -> Box<dyn GroupIntersector> {
        let packed = |solid: &Solid| PackedSolid::new(solid, kernel, level);
        Box::new(CsgIntersector::new(
            kernel_of(kernel.tier()),
            Arc::clone(&self.bvh),
            self.solids.iter().map(packed).collect(),
        ))
    }
}
