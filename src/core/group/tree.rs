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
    /// The tree with which building and tracing this many coherent rays take less time together.
    ForRays(u64),
}

/// Coherent rays per primitive up to which the quick tree takes less time. The best one takes 170 ns per triangle more to
/// build, and saves 12 to 29 ns per ray (bunny, 1.1 M triangles, exact packets, AVX-512, AMD, 2026-11).
const RAYS_FOR_QUICK: u64 = 5;

impl FirstTree {
    /// Whether a group of `count` primitives starts with the quick tree.
    fn is_quick(self, count: usize) -> bool {
        match self {
            Self::Best => false,
            Self::Quick => count >= LARGE,
            Self::ForRays(rays) => rays < RAYS_FOR_QUICK * count as u64,
        }
    }
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
        let is_quick = options.first_tree.is_quick(primitives.count());
        Ok(Self {
            built: RwLock::new(built(primitives, is_quick, &shown, progress)?),
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
            let better = built(primitives, false, &self.shown, progress)?;
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
    is_quick: bool,
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
    let bvh = if !S::IS_BOUNDED {
        Bvh::unbounded(&shown.indices(count))
    } else if is_quick {
        Bvh::build_quickly(count, bounds_of, &keep_going)?
    } else {
        Bvh::build(count, bounds_of, &keep_going)?
    };
    Ok(Built {
        bvh: Arc::new(bvh),
        time: start.elapsed(),
        is_best: !is_quick || !S::IS_BOUNDED,
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
    fn the_number_of_rays_selects_the_first_tree() {
        let of_rays = |rays: u64| {
            let options = SceneOptions {
                first_tree: FirstTree::ForRays(rays),
                ..SceneOptions::default()
            };
            let mesh = sphere(20, Placement::UNIT);
            Scene::with_options(mesh, options, &Progress::default()).expect("nobody cancels")
        };
        let (few, many) = (of_rays(1 << 10), of_rays(1 << 20));
        assert!(!few.has_best_tree() && many.has_best_tree());
        let hit = |scene: &Scene| {
            let ray = Ray::new(Vec3::new(0.1, 0.2, 3.0), -Vec3::Z).expect("a ray");
            scene
                .intersector(default_triangle_kernel())
                .closest_hit(&ray)
        };
        assert!(hit(&few).is_some());
        assert_eq!(hit(&few), hit(&many));
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
