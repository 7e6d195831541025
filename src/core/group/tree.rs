//! The tree over a group's primitives, and its replacement by a better one.

use super::Shown;
use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::intersector::improving::{Current, Improving, WeakCurrent};
use crate::intersector::{GroupIntersector, Packing, intersector};
use crate::kernel::{KernelList, KernelRow};
use crate::progress::{Cancelled, Progress};
use crate::shape::{Primitives, Shape};
use crate::simd::SimdLevel;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, RwLock};
use std::time::{Duration, Instant};

/// The tree that a group starts with. Either gives the same hits, bit for bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FirstTree {
    /// The tree that is fastest to trace.
    #[default]
    Best,
    /// For a large group, one that is built sooner; [`Scene::improve`](crate::Scene::improve) replaces it.
    Quick,
}

/// Options of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneOptions {
    /// The tree to start with.
    pub first_tree: FirstTree,
    /// Whether primitives are packed for speed or for memory.
    pub packing: Packing,
}

/// From this many primitives on, the best tree takes more than 0.1 s on two cores (2026-11).
const LARGE: usize = 200_000;

#[derive(Clone, Debug)]
struct Built {
    bvh: Arc<Bvh>,
    time: Duration,
    is_best: bool,
}

/// See the [module](self).
#[derive(Debug)]
pub(super) struct Tree<S: 'static> {
    built: RwLock<Built>,
    shown: Shown,
    packing: Packing,
    /// Held while the better tree is built.
    turn: Mutex<()>,
    waiting: Mutex<Vec<PendingIntersector<S>>>,
}

/// An intersector that uses the first tree and waits for the better one.
struct PendingIntersector<S: 'static> {
    current: WeakCurrent,
    kernel: &'static KernelRow<S>,
    level: SimdLevel,
}

impl<S> std::fmt::Debug for PendingIntersector<S> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.kernel.info.name)
    }
}

impl<S: KernelList> Tree<S> {
    pub fn build(
        primitives: &dyn Primitives<S>,
        options: SceneOptions,
        shown: Shown,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let is_large = primitives.count() >= LARGE;
        let first = if is_large {
            options.first_tree
        } else {
            FirstTree::Best
        };
        Ok(Self {
            built: RwLock::new(built(primitives, first, &shown, progress)?),
            shown,
            packing: options.packing,
            turn: Mutex::default(),
            waiting: Mutex::default(),
        })
    }

    /// A tree over some of the same primitives; if there are many, a quick one.
    pub fn showing(
        &self,
        primitives: &dyn Primitives<S>,
        shown: Shown,
        progress: &Progress,
    ) -> Result<Self, Cancelled> {
        let options = SceneOptions {
            first_tree: FirstTree::Quick,
            packing: self.packing,
        };
        Self::build(primitives, options, shown, progress)
    }

    pub fn bvh(&self) -> Arc<Bvh> {
        self.current().bvh
    }

    pub fn build_time(&self) -> Duration {
        self.current().time
    }

    pub fn is_best(&self) -> bool {
        self.current().is_best
    }

    fn current(&self) -> Built {
        let built = self.built.read().unwrap_or_else(PoisonError::into_inner);
        built.clone()
    }

    /// Packs the primitives for a kernel; [`improve`](Self::improve) packs it again.
    pub fn intersector(
        &self,
        primitives: &dyn Primitives<S>,
        kernel: &'static KernelRow<S>,
        level: SimdLevel,
    ) -> Box<dyn GroupIntersector> {
        let Built { bvh, is_best, .. } = self.current();
        let packed = intersector(kernel, primitives, bvh, level, self.packing);
        if is_best {
            return packed;
        }
        let current = Current::new(packed);
        let mut waiting = locked(&self.waiting);
        if self.is_best() {
            // The better tree has arrived meanwhile; the list is no longer read.
            drop(waiting);
            return self.intersector(primitives, kernel, level);
        }
        waiting.push(PendingIntersector {
            current: current.downgrade(),
            kernel,
            level,
        });
        Box::new(Improving {
            kernel: kernel.info,
            current,
        })
    }

    pub fn improve(
        &self,
        primitives: &dyn Primitives<S>,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        // One thread builds, the others wait.
        let _turn = locked(&self.turn);
        if !self.is_best() {
            let better = built(primitives, FirstTree::Best, &self.shown, progress)?;
            *self.built.write().unwrap_or_else(PoisonError::into_inner) = better;
        }
        loop {
            progress.check()?;
            let next = locked(&self.waiting).pop();
            let Some(PendingIntersector {
                current,
                kernel,
                level,
            }) = next
            else {
                return Ok(());
            };
            current.replace(|| intersector(kernel, primitives, self.bvh(), level, self.packing));
        }
    }
}

/// Locks, also after a panic: no data is half written under these locks.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn built<S: Shape>(
    primitives: &dyn Primitives<S>,
    tree: FirstTree,
    shown: &Shown,
    progress: &Progress,
) -> Result<Built, Cancelled> {
    let (start, count) = (Instant::now(), primitives.count());
    // A tree leaves out primitives with an empty box.
    let bounds_of = &|index| {
        if shown.contains(index) {
            primitives.primitive(index).bounds()
        } else {
            Aabb::EMPTY
        }
    };
    let keep_going = || progress.check();
    let bvh = match tree {
        _ if !S::IS_BOUNDED => Bvh::unbounded(&shown.indices(count)),
        FirstTree::Best => Bvh::build(count, bounds_of, &keep_going)?,
        FirstTree::Quick => Bvh::build_quickly(count, bounds_of, &keep_going)?,
    };
    Ok(Built {
        bvh: Arc::new(bvh),
        time: start.elapsed(),
        is_best: tree == FirstTree::Best,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::{default_triangle_kernel, triangle_kernel};
    use crate::mesh::shapes::{Placement, sphere};
    use crate::ray::Ray;
    use crate::scene::Scene;
    use glam::Vec3;

    /// 12·150² triangles.
    fn large() -> Scene {
        let mesh = sphere(150, Placement::UNIT);
        assert!(mesh.triangles().len() > LARGE);
        let options = SceneOptions {
            first_tree: FirstTree::Quick,
            ..SceneOptions::default()
        };
        Scene::with_options(mesh, options, &Progress::default()).expect("nobody cancels")
    }

    #[test]
    fn the_better_tree_replaces_the_first_in_existing_intersectors() {
        let scene = large();
        let quick = scene.intersector(default_triangle_kernel());
        let ray = Ray::new(Vec3::new(0.1, 0.2, 3.0), -Vec3::Z).expect("a ray");
        let (hit, cost) = quick.closest_hit_with_cost(&ray);
        assert!(hit.is_some() && !scene.has_best_tree());
        scene.improve(&Progress::default()).expect("nobody cancels");
        let (hit_again, cost_again) = quick.closest_hit_with_cost(&ray);
        assert_eq!(hit, hit_again);
        assert!(scene.has_best_tree() && cost_again != cost);
        let packed_later = scene.intersector(default_triangle_kernel());
        assert_eq!(packed_later.closest_hit_with_cost(&ray).1, cost_again);
    }

    #[test]
    fn a_cancelled_improvement_keeps_the_first_tree_and_can_be_restarted() {
        let scene = large();
        let cancelled = Progress::default();
        cancelled.cancel();
        assert_eq!(scene.improve(&cancelled), Err(Cancelled));
        assert!(!scene.has_best_tree());
        scene.improve(&Progress::default()).expect("nobody cancels");
        assert!(scene.has_best_tree());
    }

    #[test]
    fn intersectors_made_while_the_tree_is_replaced_get_the_better_tree() {
        let scene = large();
        let fast = triangle_kernel("fast").expect("in the table");
        let ray = Ray::new(Vec3::new(0.1, 0.2, 3.0), -Vec3::Z).expect("a ray");
        let made = std::thread::scope(|threads| {
            let improving = threads.spawn(|| scene.improve(&Progress::default()));
            let made: Vec<_> = (0..6).map(|_| scene.intersector(fast)).collect();
            improving.join().expect("no panic").expect("nobody cancels");
            made
        });
        let expected = scene.intersector(fast).closest_hit_with_cost(&ray);
        for intersector in made {
            assert_eq!(intersector.closest_hit_with_cost(&ray), expected);
        }
    }
}
