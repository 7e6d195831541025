//! Intersector of several groups: their hits in one order.

use super::numbered::{GroupRays, Numbered, box_ray};
use super::ranked_hit::{RankedHit, crossings_of};
use super::{Cost, Crossing, Intersector};
use crate::aabb::Aabb;
use crate::bvh::OpenedBox;
use crate::kernel::{KernelInfo, Precision};
use crate::ray::{Hit, Ray};

/// Intersector of one group.
pub trait GroupIntersector: Intersector {
    /// The nearest hit of one ray, to be compared with the hits of other groups, and its cost.
    fn nearest_with_cost(&self, ray: &Ray) -> (Option<RankedHit>, Cost);

    /// All hits of one ray, in any order.
    fn every_hit(&self, ray: &Ray) -> Vec<RankedHit>;

    /// The box that rays which start at their origin or ahead of it must meet to hit anything, as tested by `BoxRay`;
    /// `None` if there is none.
    fn box_to_meet(&self) -> Option<Aabb> {
        None
    }
}

/// The intersector of a scene's groups, given their numbers of primitives; that of the group if there is only one.
pub(crate) fn scene_intersector(
    kernel: &'static KernelInfo,
    mut groups: Vec<(usize, Box<dyn GroupIntersector>)>,
) -> Box<dyn Intersector> {
    if groups.len() == 1 {
        return groups.remove(0).1;
    }
    let mut first = 0;
    let number = |(count, intersector): (usize, Box<dyn GroupIntersector>)| {
        let numbered = Numbered::new(first, count as u32, intersector);
        first += count as u32;
        numbered
    };
    Box::new(SceneIntersector {
        kernel,
        groups: groups.into_iter().map(number).collect(),
    })
}

/// See the [module](self).
struct SceneIntersector {
    kernel: &'static KernelInfo,
    groups: Vec<Numbered>,
}

/// The least number of rays for which each group searches once for all of them; for fewer, the lists cost more.
const LEAST_BATCH: usize = 8;

impl SceneIntersector {
    fn nearest_with_cost(&self, ray: &Ray) -> (Option<RankedHit>, Cost) {
        self.each_group(ray, |_, _| ())
    }

    /// Finds the nearest hit. Passes each group with the ray that is traced in it to `visit` first.
    fn each_group(
        &self,
        ray: &Ray,
        mut visit: impl FnMut(&Numbered, &Ray),
    ) -> (Option<RankedHit>, Cost) {
        let mut nearest: Option<RankedHit> = None;
        let mut sum = Cost::default();
        for group in &self.groups {
            // Hits at the same t, or at one that rounds to the same f32, are compared.
            let t_max = nearest
                .as_ref()
                .map_or(ray.t_max, |nearest| nearest.t_bound(ray));
            let ray = group.ray(ray, t_max);
            visit(group, &ray);
            let (found, cost) = group.intersector.nearest_with_cost(&ray);
            sum += cost;
            let found = found.map(|found| group.ranked(found));
            if let Some(found) = found
                && nearest
                    .as_ref()
                    .is_none_or(|nearest| found.is_before(nearest))
            {
                nearest = Some(found);
            }
        }
        (nearest, sum)
    }

    /// The nearest hit, by each group's fast search, which rounds t to f32; `None` if two groups' hits are too close to each
    /// other to be compared by that.
    fn clearly_closest_hit(&self, ray: &Ray) -> Option<Option<Hit>> {
        let box_ray = box_ray(ray);
        let mut nearest: Option<Hit> = None;
        for group in &self.groups {
            let t_max = self.t_max(ray, nearest);
            if !group.may_be_hit(box_ray.as_ref(), t_max) {
                continue;
            }
            let Some(found) = group.closest_hit(ray, t_max) else {
                continue;
            };
            if !self.is_clear(found, nearest) {
                return None;
            }
            nearest = Some(group.numbered(found));
        }
        Some(nearest)
    }

    /// The nearest hits of rays. Each group searches once, for the rays that meet its box.
    fn closest_hits_by_group(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        hits.fill(None);
        let mut are_clear = vec![true; rays.len()];
        let (mut subset, mut found) =
            (GroupRays::with_capacity(rays.len()), vec![None; rays.len()]);
        for group in &self.groups {
            subset.select(group, rays, |i| Some(self.t_max(&rays[i], hits[i])));
            let found = &mut found[..subset.rays.len()];
            group.intersector.closest_hits(&subset.rays, found);
            for (&i, found) in subset.indices.iter().zip(&*found) {
                if let Some(found) = *found {
                    are_clear[i] &= self.is_clear(found, hits[i]);
                    hits[i] = Some(group.numbered(found));
                }
            }
        }
        let all = rays.iter().zip(hits).zip(are_clear);
        for ((ray, hit), _) in all.filter(|(_, is_clear)| !is_clear) {
            *hit = self.closest_hit_with_cost(ray).0;
        }
    }

    /// Which rays hit anything. Each group searches once, for the rays that meet its box and hit no earlier group.
    fn any_hits_by_group(&self, rays: &[Ray], are_hits: &mut [bool]) {
        are_hits.fill(false);
        let (mut subset, mut found) = (
            GroupRays::with_capacity(rays.len()),
            vec![false; rays.len()],
        );
        for group in &self.groups {
            subset.select(group, rays, |i| (!are_hits[i]).then_some(rays[i].t_max));
            let found = &mut found[..subset.rays.len()];
            group.intersector.any_hits(&subset.rays, found);
            for (&i, is_hit) in subset.indices.iter().zip(&*found) {
                are_hits[i] = *is_hit;
            }
        }
    }

    /// Whether a group's hits are rounded to f32, so that equal t may differ.
    fn is_rounded(&self) -> bool {
        self.kernel.precision != Precision::F32
    }

    /// An upper bound of t for hits of a later group that could precede the nearest so far.
    fn t_max(&self, ray: &Ray, nearest: Option<Hit>) -> f32 {
        match nearest {
            None => ray.t_max,
            Some(hit) if self.is_rounded() => hit.t.next_up().min(ray.t_max),
            // As computed: at an equal t, the earlier group's primitive precedes.
            Some(hit) => hit.t,
        }
    }

    /// Whether a hit within [`t_max`](Self::t_max) certainly precedes the nearest of earlier groups.
    fn is_clear(&self, found: Hit, nearest: Option<Hit>) -> bool {
        !self.is_rounded() || nearest.is_none_or(|nearest| found.t < nearest.t.next_down())
    }
}

impl Intersector for SceneIntersector {
    fn kernel(&self) -> &'static KernelInfo {
        self.kernel
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        if rays.len() >= LEAST_BATCH {
            return self.closest_hits_by_group(rays, hits);
        }
        for (ray, hit) in rays.iter().zip(hits) {
            let closest = || self.closest_hit_with_cost(ray).0;
            *hit = self.clearly_closest_hit(ray).unwrap_or_else(closest);
        }
    }

    fn coherent_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        hits.fill(None);
        let (mut found, mut are_clear) = (vec![None; rays.len()], vec![true; rays.len()]);
        for group in &self.groups {
            let mut pairs = rays.iter().zip(&*hits);
            if pairs.all(|(ray, hit)| hit.is_none() && group.exclude(ray) == ray.exclude) {
                group.intersector.coherent_hits(rays, &mut found);
            } else {
                let pairs = rays.iter().zip(&*hits);
                let rays: Vec<Ray> = pairs
                    .map(|(ray, hit)| group.ray(ray, self.t_max(ray, *hit)))
                    .collect();
                group.intersector.coherent_hits(&rays, &mut found);
            }
            for ((hit, found), is_clear) in hits.iter_mut().zip(&found).zip(&mut are_clear) {
                if let Some(found) = *found {
                    *is_clear &= self.is_clear(found, *hit);
                    *hit = Some(group.numbered(found));
                }
            }
        }
        let all = rays.iter().zip(hits).zip(are_clear);
        for ((ray, hit), _) in all.filter(|(_, is_clear)| !is_clear) {
            *hit = self.closest_hit_with_cost(ray).0;
        }
    }

    fn coherent_any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        are_hits.fill(false);
        let mut left: Vec<usize> = (0..rays.len()).collect();
        for group in &self.groups {
            let rays: Vec<Ray> = left
                .iter()
                .map(|&i| group.ray(&rays[i], rays[i].t_max))
                .collect();
            let mut found = vec![false; rays.len()];
            group.intersector.coherent_any_hits(&rays, &mut found);
            for (&i, is_hit) in left.iter().zip(found) {
                are_hits[i] = is_hit;
            }
            left.retain(|&i| !are_hits[i]);
        }
    }

    fn rays_together(&self) -> usize {
        let together = self.groups.iter().map(|g| g.intersector.rays_together());
        together.max().unwrap_or(1)
    }

    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        let (nearest, cost) = self.nearest_with_cost(ray);
        (nearest.map(|nearest| nearest.hit), cost)
    }

    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        if rays.len() >= LEAST_BATCH {
            return self.any_hits_by_group(rays, are_hits);
        }
        for (ray, is_hit) in rays.iter().zip(are_hits) {
            let box_ray = box_ray(ray);
            *is_hit = self
                .groups
                .iter()
                .any(|group| group.may_be_hit(box_ray.as_ref(), ray.t_max) && group.any_hit(ray));
        }
    }

    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        let mut hits: Vec<RankedHit> = Vec::new();
        for group in &self.groups {
            let found = group.intersector.every_hit(&group.ray(ray, ray.t_max));
            hits.extend(found.into_iter().map(|hit| group.ranked(hit)));
        }
        crossings_of(hits)
    }

    fn candidates(&self, ray: &Ray) -> Vec<u32> {
        let of_group = |group: &Numbered| {
            let local = group.intersector.candidates(&group.ray(ray, ray.t_max));
            local
                .into_iter()
                .map(|index| group.first + index)
                .collect::<Vec<_>>()
        };
        self.groups.iter().flat_map(of_group).collect()
    }

    fn opened_boxes(&self, ray: &Ray) -> Vec<OpenedBox> {
        let mut opened = Vec::new();
        self.each_group(ray, |group, ray| {
            let of_group = group.intersector.opened_boxes(ray).into_iter();
            opened.extend(of_group.map(|opened| opened.numbered_from(group.first)));
        });
        opened
    }

    fn count_hits(&self, ray: &Ray) -> usize {
        let counts = self.groups.iter().map(|g| g.intersector.count_hits(ray));
        counts.sum()
    }

    fn bytes(&self) -> usize {
        self.groups.iter().map(|g| g.intersector.bytes()).sum()
    }
}
