//! Intersector that cuts rays with a clip, and forwards them to another one.
//!
//! All rays of a clipped scene pass through it: those of the camera, of picks and of shadows, and those that surfaces
//! scatter. A scene without a clip has no such intersector, so nothing is tested for it.
//!
//! A hit at the end of the cut interval is lost if its kernel reports it so far before its box that it ranks behind the
//! end: by more than 16 ulp, which kernels in f32 may do with needles and at flat angles.

use super::{Cost, Crossing, Intersector};
use crate::bvh::OpenedBox;
use crate::clip::{Clip, CutRay, KeptInterval};
use crate::kernel::KernelInfo;
use crate::lane::PACKET;
use crate::ray::{Hit, Ray};
use std::sync::Arc;

/// See the [module](self).
pub(crate) struct Clipped {
    clip: Clip,
    whole: Arc<dyn Intersector>,
}

/// The number of rays that are cut before they are traced: four packets.
const AT_ONCE: usize = 4 * PACKET;

/// The rays of which a part is kept.
struct CutRays {
    rays: [Ray; AT_ONCE],
    /// What is kept of each, and its index among all rays.
    kept: [(KeptInterval, usize); AT_ONCE],
    count: usize,
}

impl CutRays {
    /// Cuts at least one and at most [`AT_ONCE`] rays.
    fn of(clip: &Clip, rays: &[Ray]) -> Self {
        let mut cut = Self {
            rays: [rays[0]; AT_ONCE],
            kept: [(KeptInterval::ALL, 0); AT_ONCE],
            count: 0,
        };
        for (index, ray) in rays.iter().enumerate() {
            if let Some(CutRay { ray, kept }) = clip.cut(ray) {
                (cut.rays[cut.count], cut.kept[cut.count]) = (ray, (kept, index));
                cut.count += 1;
            }
        }
        cut
    }

    fn rays(&self) -> &[Ray] {
        &self.rays[..self.count]
    }
}

/// How an intersector finds nearest hits.
type Find = fn(&dyn Intersector, &[Ray], &mut [Option<Hit>]);

impl Clipped {
    pub fn new(whole: Arc<dyn Intersector>, clip: Clip) -> Self {
        Self { clip, whole }
    }

    fn find(&self, rays: &[Ray], hits: &mut [Option<Hit>], find: Find) {
        for (rays, hits) in rays.chunks(AT_ONCE).zip(hits.chunks_mut(AT_ONCE)) {
            let cut = CutRays::of(&self.clip, rays);
            let mut found = [None; AT_ONCE];
            find(&*self.whole, cut.rays(), &mut found[..cut.count]);
            hits.fill(None);
            for ((&ray, &(kept, index)), hit) in cut.rays().iter().zip(&cut.kept).zip(found) {
                hits[index] = hit.and_then(|hit| self.kept(&CutRay { ray, kept }, hit));
            }
        }
    }

    /// The nearest hit that the clip keeps, where `hit` is the nearest one of the cut ray.
    #[inline]
    fn kept(&self, cut: &CutRay, hit: Hit) -> Option<Hit> {
        if cut.kept.contains(hit.t) {
            Some(hit)
        } else {
            self.kept_crossings(cut).next().map(|crossing| crossing.hit)
        }
    }

    /// The crossings that the clip keeps.
    fn kept_crossings(&self, cut: &CutRay) -> impl Iterator<Item = Crossing> + use<> {
        let kept = cut.kept;
        let crossings = self.whole.all_hits(&cut.ray).into_iter();
        crossings.filter(move |crossing| kept.contains(crossing.hit.t))
    }
}

impl Intersector for Clipped {
    fn kernel(&self) -> &'static KernelInfo {
        self.whole.kernel()
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        self.find(rays, hits, |whole, rays, hits| {
            whole.closest_hits(rays, hits);
        });
    }

    fn coherent_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        self.find(rays, hits, |whole, rays, hits| {
            whole.coherent_hits(rays, hits);
        });
    }

    fn rays_together(&self) -> usize {
        self.whole.rays_together()
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        let Some(cut) = self.clip.cut(ray) else {
            return (None, Cost::default());
        };
        let (hit, cost) = self.whole.closest_hit_with_cost(&cut.ray);
        (hit.and_then(|hit| self.kept(&cut, hit)), cost)
    }

    /// Hits within an ulp of a plane may count on both of its sides.
    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        for (rays, are_hits) in rays.chunks(AT_ONCE).zip(are_hits.chunks_mut(AT_ONCE)) {
            let cut = CutRays::of(&self.clip, rays);
            let mut found = [false; AT_ONCE];
            self.whole.any_hits(cut.rays(), &mut found[..cut.count]);
            are_hits.fill(false);
            for (&(_, index), is_hit) in cut.kept[..cut.count].iter().zip(found) {
                are_hits[index] = is_hit;
            }
        }
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        let cut = self.clip.cut(ray);
        cut.map_or_else(Vec::new, |cut| self.kept_crossings(&cut).collect())
    }

    fn candidates(&self, ray: &Ray) -> Vec<u32> {
        let cut = self.clip.cut(ray);
        cut.map_or_else(Vec::new, |cut| self.whole.candidates(&cut.ray))
    }

    fn opened_boxes(&self, ray: &Ray) -> Vec<OpenedBox> {
        let cut = self.clip.cut(ray);
        cut.map_or_else(Vec::new, |cut| self.whole.opened_boxes(&cut.ray))
    }

    fn count_hits(&self, ray: &Ray) -> usize {
        let cut = self.clip.cut(ray);
        cut.map_or(0, |cut| self.whole.count_hits(&cut.ray))
    }

    fn bytes(&self) -> usize {
        self.whole.bytes()
    }
}
