//! Rays at random primitives: ordinary ones, and those about which decisions are hard.

use super::samples::Sampled;
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::kernel::Tier;
use hitscope_core::random::Random;
use hitscope_core::shape::SurfacePoint;

/// The target of rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// The primitive and its surroundings.
    Around,
    /// The silhouette, which a ray misses or enters by 10⁻³ of the size to nothing; or a point of the surface, at an
    /// angle of 10⁻³ to nothing.
    Silhouette,
    /// A point of an edge, or a corner.
    Edges,
    /// Parallel to an axis of the primitive or the world, or almost: half of them at edges.
    Axes,
    /// Begins inside the primitive or close to it.
    FromInside,
}

/// A random primitive, and a ray from a distance in units of its size.
pub fn aimed<S: Sampled>(random: &mut Random, aim: Aim, distance: f64) -> (Ray, S) {
    let place = Place::random(random, distance);
    loop {
        let shape = S::sample(random, place.near, place.size);
        if let Some(ray) = place.ray(random, aim, &shape) {
            return (ray, shape);
        }
    }
}

/// A surface at which rays are aimed.
pub(super) trait Target {
    /// A point of an edge; `None` if none is found.
    fn point_of_edge(&self, random: &mut Random) -> Option<DVec3>;

    /// The direction of an axis.
    fn some_axis(&self, random: &mut Random) -> Vec3;

    /// The surface at a ray's first hit.
    fn first_surface(&self, ray: &Ray) -> Option<SurfacePoint>;
}

impl<S: Sampled> Target for S {
    fn point_of_edge(&self, random: &mut Random) -> Option<DVec3> {
        self.edge_point(random)
    }

    fn some_axis(&self, _: &mut Random) -> Vec3 {
        self.axis()
    }

    fn first_surface(&self, ray: &Ray) -> Option<SurfacePoint> {
        let hit = S::kernel_of(Tier::Precise).intersect(ray, self.clone())?;
        Some(self.surface(ray, &hit))
    }
}

/// A place of primitives, and the distance of rays.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub near: DVec3,
    pub size: f64,
    distance: f64,
}

impl Place {
    /// A place of random size.
    pub fn random(random: &mut Random, distance: f64) -> Self {
        let size = 2f64.powf(4.0 * random.signed());
        Self {
            near: 4.0 * size * random.in_cube(),
            size,
            distance,
        }
    }

    /// A ray at a target of this place; `None` if the target lacks the surface or the edge that it is to meet.
    pub fn ray(&self, random: &mut Random, aim: Aim, target: &impl Target) -> Option<Ray> {
        match aim {
            Aim::Around => Some(self.around(random)),
            Aim::Silhouette => self.silhouette(random, target),
            Aim::Edges => self.edges(random, target),
            Aim::Axes => self.axes(random, target),
            Aim::FromInside => {
                let origin = self.near + 0.5 * self.size * random.in_cube();
                Some(ray(origin, random.direction().as_vec3()))
            }
        }
    }

    fn around(&self, random: &mut Random) -> Ray {
        let Self { near, size, .. } = *self;
        let target = near + size * random.in_cube();
        self.towards(random, target)
    }

    /// A ray from a random side. Its direction is computed from the origin as it was rounded.
    fn towards(&self, random: &mut Random, target: DVec3) -> Ray {
        let origin = (target + self.distance * self.size * random.direction()).as_vec3();
        let dir = target - origin.as_dvec3();
        // A direction of about unit length unless the origin is near: like a camera's or a bounce's.
        let scale = if random.index(2) == 0 {
            1.0
        } else {
            dir.length()
        };
        ray(origin.as_dvec3(), (dir / scale).as_vec3())
    }

    fn silhouette(&self, random: &mut Random, target: &impl Target) -> Option<Ray> {
        let near = Self {
            distance: 3.0,
            ..*self
        };
        let (surface, normal) = (0..64).find_map(|_| {
            let surface = target.first_surface(&near.around(random))?;
            Some((surface.position.as_dvec3(), surface.normal))
        })?;
        let side = normal.cross(random.direction()).normalize_or_zero();
        let small = 2f64.powi(-10 - random.index(43) as i32) * random.signed();
        let (through, dir) = if random.index(2) == 0 {
            (surface + small * self.size * normal, side)
        } else {
            (surface, side + small * normal)
        };
        let origin = (through - self.distance * self.size * dir).as_vec3();
        let dir = (through - origin.as_dvec3()).as_vec3();
        (dir != Vec3::ZERO).then(|| ray(origin.as_dvec3(), dir))
    }

    fn edges(&self, random: &mut Random, target: &impl Target) -> Option<Ray> {
        let target = target.point_of_edge(random)?.as_vec3();
        Some(self.towards(random, target.as_dvec3()))
    }

    fn axes(&self, random: &mut Random, target: &impl Target) -> Option<Ray> {
        let axis = match random.index(4) {
            0 => target.some_axis(random),
            1 => -target.some_axis(random),
            2 => Vec3::AXES[random.index(3)],
            _ => -Vec3::AXES[random.index(3)],
        };
        let axis = axis.as_dvec3();
        let tilt = [0.0, 1e-8][random.index(2)] * axis.length() * random.direction();
        let dir = (axis + tilt).as_vec3();
        let through = if random.index(2) == 0 {
            target.point_of_edge(random)?
        } else {
            self.near + self.size * random.in_cube()
        };
        let back = self.distance * self.size * axis.normalize();
        Some(ray(through - back, dir))
    }
}

fn ray(origin: DVec3, dir: Vec3) -> Ray {
    Ray::new(origin.as_vec3(), dir).expect("finite, and a direction other than 0")
}
