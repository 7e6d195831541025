//! Intersector of several groups: their hits in one order.

use super::order::{Comparison, precedes};
use super::{Cost, Crossing, Intersector, is_behind};
use crate::aabb::Aabb;
use crate::algebra::{Algebraic, is_between};
use crate::bvh::{BoxRay, OpenedBox};
use crate::kernel::{KernelInfo, Precision};
use crate::ray::{Hit, Ray};
use std::cell::OnceCell;
use std::cmp::Ordering;

/// A hit and its t, for comparison with hits of other groups.
pub struct RankedHit {
    /// The hit, rounded.
    pub hit: Hit,
    /// Bounds of t; equal if the kernel isn't exact.
    pub(super) t: [f64; 2],
    /// t, if the kernel is exact.
    pub(super) exact: Option<ExactT>,
    /// Whether the ray certainly touches the surface without passing through it.
    pub(crate) is_tangent: bool,
}

/// An exact t, computed on first use.
pub(super) struct ExactT {
    compute: Box<dyn Fn() -> Algebraic>,
    known: OnceCell<Algebraic>,
}

impl ExactT {
    pub fn new(compute: impl Fn() -> Algebraic + 'static) -> Self {
        Self {
            compute: Box::new(compute),
            known: OnceCell::new(),
        }
    }

    fn get(&self) -> &Algebraic {
        self.known.get_or_init(|| (self.compute)())
    }
}

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
        let numbered = Numbered {
            first,
            count: count as u32,
            bounds: intersector.box_to_meet(),
            intersector,
        };
        first += count as u32;
        numbered
    };
    Box::new(SceneIntersector {
        kernel,
        groups: groups.into_iter().map(number).collect(),
    })
}

/// A group whose primitives are numbered from `first`.
struct Numbered {
    first: u32,
    count: u32,
    /// See [`GroupIntersector::box_to_meet`].
    bounds: Option<Aabb>,
    intersector: Box<dyn GroupIntersector>,
}

impl Numbered {
    /// Whether a ray may hit the group before `t_max`. `box_ray` is `None` for rays that start behind their origin.
    #[inline]
    fn may_be_hit(&self, box_ray: Option<&BoxRay>, t_max: f32) -> bool {
        match (box_ray, &self.bounds) {
            (Some(ray), Some(bounds)) => ray.meets(bounds, t_max),
            _ => true,
        }
    }

    /// The ray in this group's numbers, up to `t_max`.
    #[inline]
    fn ray(&self, ray: &Ray, t_max: f32) -> Ray {
        Ray {
            exclude: self.exclude(ray),
            t_max,
            ..*ray
        }
    }

    /// The excluded primitive in this group's numbers.
    #[inline]
    fn exclude(&self, ray: &Ray) -> Option<u32> {
        let local = ray.exclude.and_then(|index| index.checked_sub(self.first));
        local.filter(|&index| index < self.count)
    }

    /// The nearest hit up to `t_max`, in the group's numbers.
    #[inline]
    fn closest_hit(&self, ray: &Ray, t_max: f32) -> Option<Hit> {
        // A copy of a ray that has just been made waits until it is in memory.
        if t_max == ray.t_max && self.exclude(ray) == ray.exclude {
            return self.intersector.closest_hit(ray);
        }
        self.intersector.closest_hit(&self.ray(ray, t_max))
    }

    /// Whether a ray hits the group.
    #[inline]
    fn any_hit(&self, ray: &Ray) -> bool {
        if self.exclude(ray) == ray.exclude {
            return self.intersector.any_hit(ray);
        }
        self.intersector.any_hit(&self.ray(ray, ray.t_max))
    }

    /// The hit in the scene's numbers.
    fn numbered(&self, hit: Hit) -> Hit {
        Hit {
            primitive: self.first + hit.primitive,
            ..hit
        }
    }

    fn ranked(&self, ranked: RankedHit) -> RankedHit {
        RankedHit {
            hit: self.numbered(ranked.hit),
            ..ranked
        }
    }
}

/// See the [module](self).
struct SceneIntersector {
    kernel: &'static KernelInfo,
    groups: Vec<Numbered>,
}

impl RankedHit {
    /// The same with another hit at the same t.
    pub(crate) fn with_hit(self, change: impl FnOnce(Hit) -> Hit) -> Self {
        Self {
            hit: change(self.hit),
            ..self
        }
    }

    /// t, rounded to f64; correctly if the kernel is exact.
    pub(crate) fn t_in_f64(&self) -> f64 {
        match &self.exact {
            Some(exact) if self.t[0] != self.t[1] => exact.get().clone().nearest_f64(),
            _ => self.t[0],
        }
    }

    /// Whether t lies in the ray's open interval.
    pub(crate) fn is_in_interval(&self, ray: &Ray) -> bool {
        let [start, end] = ray.finite_interval().map(f64::from);
        let [low, high] = self.t;
        match &self.exact {
            _ if start < low && high < end => true,
            _ if high <= start || end <= low => false,
            Some(exact) => is_between(exact.get(), [start, end]),
            None => false,
        }
    }

    /// An upper bound of t for hits that could precede this one.
    pub(crate) fn t_bound(&self, ray: &Ray) -> f32 {
        self.hit.t.next_up().min(ray.t_max)
    }

    /// Compares by t.
    pub(crate) fn compare(&self, other: &Self) -> Ordering {
        match (&self.exact, &other.exact) {
            _ if self.t[1] < other.t[0] => Ordering::Less,
            _ if self.t[0] > other.t[1] => Ordering::Greater,
            (Some(exact), Some(other)) => exact.get().compare(other.get()),
            _ => self.t[0].total_cmp(&other.t[0]),
        }
    }

    /// Whether it precedes another hit: by t, then by primitive.
    pub(crate) fn is_before(&self, other: &Self) -> bool {
        let order: Comparison<bool> = self.compare(other).into();
        precedes(order, order, self.hit.primitive < other.hit.primitive)
    }
}

/// The hits as crossings, ordered by t. Hits at equal t form one crossing, ordered by primitive.
pub(crate) fn crossings_of(mut hits: Vec<RankedHit>) -> Vec<Crossing> {
    hits.sort_by(|a, b| {
        let by_t = a.compare(b);
        by_t.then(a.hit.primitive.cmp(&b.hit.primitive))
    });
    hits.chunk_by(|a, b| a.compare(b).is_eq())
        .map(|equal| Crossing {
            hit: equal[0].hit,
            also: equal[1..].iter().map(|other| other.hit.primitive).collect(),
        })
        .collect()
}

/// The ray for tests of groups' boxes; `None` if it starts behind its origin.
#[inline]
fn box_ray(ray: &Ray) -> Option<BoxRay> {
    (!is_behind(ray)).then(|| BoxRay::new(ray))
}

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
