//! Intersector whose tree can be replaced while rays are traced; every tree gives the same bits.

use super::{Cost, Crossing, GroupIntersector, Intersector, RankedHit};
use crate::aabb::Aabb;
use crate::bvh::OpenedBox;
use crate::kernel::KernelInfo;
use crate::ray::{Hit, Ray};
use std::sync::{Arc, PoisonError, RwLock, Weak};

/// Shared handle to the current intersector.
#[derive(Clone)]
pub(crate) struct Current(Arc<RwLock<Arc<dyn GroupIntersector>>>);

/// Weak handle for the thread that replaces the intersector.
pub(crate) struct WeakCurrent(Weak<RwLock<Arc<dyn GroupIntersector>>>);

impl Current {
    pub fn new(first: Box<dyn GroupIntersector>) -> Self {
        Self(Arc::new(RwLock::new(Arc::from(first))))
    }

    pub fn downgrade(&self) -> WeakCurrent {
        WeakCurrent(Arc::downgrade(&self.0))
    }

    /// Clones the pointer, so that no lock is held while tracing.
    fn get(&self) -> Arc<dyn GroupIntersector> {
        Arc::clone(&self.0.read().unwrap_or_else(PoisonError::into_inner))
    }
}

impl WeakCurrent {
    /// Replaces the intersector; `next` is called only if the handle is still in use.
    pub fn replace(&self, next: impl FnOnce() -> Box<dyn GroupIntersector>) {
        if let Some(current) = self.0.upgrade() {
            let next = Arc::from(next());
            let mut place = current.write().unwrap_or_else(PoisonError::into_inner);
            let last = std::mem::replace(&mut *place, next);
            // The old intersector is freed after the lock has been released.
            drop(place);
            drop(last);
        }
    }
}

/// Forwards to the current intersector.
pub(crate) struct Improving {
    pub kernel: &'static KernelInfo,
    pub current: Current,
}

impl Intersector for Improving {
    fn kernel(&self) -> &'static KernelInfo {
        self.kernel
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        self.current.get().closest_hits(rays, hits);
    }

    fn coherent_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        self.current.get().coherent_hits(rays, hits);
    }

    fn rays_together(&self) -> usize {
        self.current.get().rays_together()
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        self.current.get().closest_hit_with_cost(ray)
    }

    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        self.current.get().any_hits(rays, are_hits);
    }

    fn coherent_any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        self.current.get().coherent_any_hits(rays, are_hits);
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        self.current.get().all_hits(ray)
    }

    fn candidates(&self, ray: &Ray) -> Vec<u32> {
        self.current.get().candidates(ray)
    }

    fn opened_boxes(&self, ray: &Ray) -> Vec<OpenedBox> {
        self.current.get().opened_boxes(ray)
    }

    fn count_hits(&self, ray: &Ray) -> usize {
        self.current.get().count_hits(ray)
    }

    fn bytes(&self) -> usize {
        self.current.get().bytes()
    }
}

impl GroupIntersector for Improving {
    fn nearest_with_cost(&self, ray: &Ray) -> (Option<RankedHit>, Cost) {
        self.current.get().nearest_with_cost(ray)
    }

    fn box_to_meet(&self) -> Option<Aabb> {
        self.current.get().box_to_meet()
    }

    fn every_hit(&self, ray: &Ray) -> Vec<RankedHit> {
        self.current.get().every_hit(ray)
    }
}
