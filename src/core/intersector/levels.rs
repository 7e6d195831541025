//! The SIMD levels for which an intersector's code is compiled.

use super::method::Method;
use super::tree::TreeIntersector;
use crate::bvh::Stack;
use crate::ray::{Hit, Ray};
use crate::simd::baseline;
use fearless_simd::dispatch;

/// Runs an intersector's searches with the instructions of a level.
pub(super) trait Levels: Send + Sync + 'static {
    /// Finds the nearest hits; see [`TreeIntersector::find`].
    fn find<M: Method>(
        intersector: &TreeIntersector<M>,
        rays: &[Ray],
        hits: &mut [Option<Hit>],
        batch: &mut M::Batch,
        stack: &mut Stack,
    );

    /// Finds any hits; see [`TreeIntersector::find_any`].
    fn find_any<M: Method>(
        intersector: &TreeIntersector<M>,
        rays: &[Ray],
        are_hits: &mut [bool],
        stack: &mut Stack,
    );

    /// Counts hits; see [`TreeIntersector::count`].
    fn count<M: Method>(intersector: &TreeIntersector<M>, ray: &Ray) -> usize;
}

/// Every level of the CPU.
pub(super) struct EveryLevel;

/// The baseline alone. Each further level compiles the tree's walk once more.
pub(super) struct BaselineLevel;

impl Levels for EveryLevel {
    fn find<M: Method>(
        intersector: &TreeIntersector<M>,
        rays: &[Ray],
        hits: &mut [Option<Hit>],
        batch: &mut M::Batch,
        stack: &mut Stack,
    ) {
        if intersector.blocks.are_compact() {
            BaselineLevel::find(intersector, rays, hits, batch, stack);
        } else {
            let level = intersector.level.level();
            dispatch!(level, token => intersector.find::<false, _>(token, rays, hits, batch, stack));
        }
    }

    fn find_any<M: Method>(
        intersector: &TreeIntersector<M>,
        rays: &[Ray],
        are_hits: &mut [bool],
        stack: &mut Stack,
    ) {
        if intersector.blocks.are_compact() {
            BaselineLevel::find_any(intersector, rays, are_hits, stack);
        } else {
            let level = intersector.level.level();
            dispatch!(level, token => intersector.find_any::<false, _>(token, rays, are_hits, stack));
        }
    }

    fn count<M: Method>(intersector: &TreeIntersector<M>, ray: &Ray) -> usize {
        dispatch!(intersector.level.level(), token => intersector.count(token, ray))
    }
}

impl Levels for BaselineLevel {
    fn find<M: Method>(
        intersector: &TreeIntersector<M>,
        rays: &[Ray],
        hits: &mut [Option<Hit>],
        batch: &mut M::Batch,
        stack: &mut Stack,
    ) {
        intersector.find::<true, _>(baseline(), rays, hits, batch, stack);
    }

    fn find_any<M: Method>(
        intersector: &TreeIntersector<M>,
        rays: &[Ray],
        are_hits: &mut [bool],
        stack: &mut Stack,
    ) {
        intersector.find_any::<true, _>(baseline(), rays, are_hits, stack);
    }

    fn count<M: Method>(intersector: &TreeIntersector<M>, ray: &Ray) -> usize {
        intersector.count(baseline(), ray)
    }
}
