//! A group of primitives with its place in the scene's numbering, and the rays of a batch that may hit it.

use super::groups::GroupIntersector;
use super::is_behind;
use super::ranked_hit::RankedHit;
use crate::bvh::BoxRay;
use crate::ray::{Hit, Ray};
use glam::Vec3A;

/// A group whose primitives are numbered from `first`.
pub(super) struct Numbered {
    pub first: u32,
    count: u32,
    /// The lower and upper bounds of [`GroupIntersector::box_to_meet`].
    bounds: Option<[Vec3A; 2]>,
    pub intersector: Box<dyn GroupIntersector>,
}

impl Numbered {
    pub fn new(first: u32, count: u32, intersector: Box<dyn GroupIntersector>) -> Self {
        Self {
            first,
            count,
            bounds: intersector
                .box_to_meet()
                .map(|b| [b.min, b.max].map(Vec3A::from)),
            intersector,
        }
    }

    /// Whether a ray may hit the group before `t_max`. `box_ray` is `None` for rays that start behind their origin.
    #[inline]
    pub fn may_be_hit(&self, box_ray: Option<&BoxRay>, t_max: f32) -> bool {
        match (box_ray, &self.bounds) {
            (Some(ray), Some(bounds)) => ray.meets(*bounds, t_max),
            _ => true,
        }
    }

    /// The ray in this group's numbers, up to `t_max`.
    #[inline]
    pub fn ray(&self, ray: &Ray, t_max: f32) -> Ray {
        Ray {
            exclude: self.exclude(ray),
            t_max,
            ..*ray
        }
    }

    /// The excluded primitive in this group's numbers.
    #[inline]
    pub fn exclude(&self, ray: &Ray) -> Option<u32> {
        let local = ray.exclude.and_then(|index| index.checked_sub(self.first));
        local.filter(|&index| index < self.count)
    }

    /// The nearest hit up to `t_max`, in the group's numbers.
    #[inline]
    pub fn closest_hit(&self, ray: &Ray, t_max: f32) -> Option<Hit> {
        // Without this, copying a ray that has just been written waits for its stores.
        if t_max == ray.t_max && self.exclude(ray) == ray.exclude {
            return self.intersector.closest_hit(ray);
        }
        self.intersector.closest_hit(&self.ray(ray, t_max))
    }

    /// Whether a ray hits the group.
    #[inline]
    pub fn any_hit(&self, ray: &Ray) -> bool {
        if self.exclude(ray) == ray.exclude {
            return self.intersector.any_hit(ray);
        }
        self.intersector.any_hit(&self.ray(ray, ray.t_max))
    }

    /// The hit in the scene's numbers.
    pub fn numbered(&self, hit: Hit) -> Hit {
        Hit {
            primitive: self.first + hit.primitive,
            ..hit
        }
    }

    /// The ranked hit in the scene's numbers.
    pub fn ranked(&self, ranked: RankedHit) -> RankedHit {
        RankedHit {
            hit: self.numbered(ranked.hit),
            ..ranked
        }
    }
}

/// The rays of a batch that meet a group's box, with primitives numbered as in the group.
pub(super) struct GroupRays {
    pub rays: Vec<Ray>,
    /// The index in the batch of each ray.
    pub indices: Vec<usize>,
}

impl GroupRays {
    pub fn with_capacity(count: usize) -> Self {
        Self {
            rays: Vec::with_capacity(count),
            indices: Vec::with_capacity(count),
        }
    }

    /// Selects the rays that may hit a group before `t_max` of their index; `None` excludes a ray.
    pub fn select(&mut self, group: &Numbered, rays: &[Ray], t_max: impl Fn(usize) -> Option<f32>) {
        self.rays.clear();
        self.indices.clear();
        for (i, ray) in rays.iter().enumerate() {
            // Preparing a ray for the test of a box takes less time than keeping it for the next group.
            if let Some(t_max) = t_max(i)
                && group.may_be_hit(box_ray(ray).as_ref(), t_max)
            {
                self.rays.push(group.ray(ray, t_max));
                self.indices.push(i);
            }
        }
    }
}

/// The ray for tests of groups' boxes; `None` if it starts behind its origin.
#[inline]
pub(super) fn box_ray(ray: &Ray) -> Option<BoxRay> {
    (!is_behind(ray)).then(|| BoxRay::new(ray))
}
