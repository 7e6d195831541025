//! Rays at random primitives: ordinary ones, and those about which decisions are hard.

use super::samples::Sampled;
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::kernel::Tier;
use hitscope_core::random::Random;

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
    let size = 2f64.powf(4.0 * random.signed());
    let near = 4.0 * size * random.in_cube();
    loop {
        let shape = S::sample(random, near, size);
        let place = Place {
            near,
            size,
            distance,
        };
        let ray = match aim {
            Aim::Around => Some(place.around(random)),
            Aim::Silhouette => place.silhouette(random, &shape),
            Aim::Edges => place.edges(random, &shape),
            Aim::Axes => place.axes(random, &shape),
            Aim::FromInside => {
                let origin = near + 0.5 * size * random.in_cube();
                Some(ray(origin, random.direction().as_vec3()))
            }
        };
        if let Some(ray) = ray {
            return (ray, shape);
        }
    }
}

/// A place of primitives, and the distance of rays.
struct Place {
    near: DVec3,
    size: f64,
    distance: f64,
}

impl Place {
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

    fn silhouette<S: Sampled>(&self, random: &mut Random, shape: &S) -> Option<Ray> {
        let near = Self {
            distance: 3.0,
            ..*self
        };
        let kernel = S::kernel_of(Tier::Precise);
        let (surface, normal) = (0..64).find_map(|_| {
            let ray = near.around(random);
            let hit = kernel.intersect(&ray, shape.clone())?;
            let surface = shape.surface(&ray, &hit);
            Some((surface.position.as_dvec3(), surface.normal))
        })?;
        let side = normal.cross(random.direction()).normalize_or_zero();
        let small = 2f64.powi(-10 - random.index(43) as i32) * random.signed();
        let (target, dir) = if random.index(2) == 0 {
            (surface + small * self.size * normal, side)
        } else {
            (surface, side + small * normal)
        };
        let origin = (target - self.distance * self.size * dir).as_vec3();
        let dir = (target - origin.as_dvec3()).as_vec3();
        (dir != Vec3::ZERO).then(|| ray(origin.as_dvec3(), dir))
    }

    fn edges<S: Sampled>(&self, random: &mut Random, shape: &S) -> Option<Ray> {
        let target = shape.edge_point(random)?.as_vec3();
        Some(self.towards(random, target.as_dvec3()))
    }

    fn axes<S: Sampled>(&self, random: &mut Random, shape: &S) -> Option<Ray> {
        let axis = match random.index(4) {
            0 => shape.axis(),
            1 => -shape.axis(),
            2 => Vec3::AXES[random.index(3)],
            _ => -Vec3::AXES[random.index(3)],
        };
        let axis = axis.as_dvec3();
        let tilt = [0.0, 1e-8][random.index(2)] * axis.length() * random.direction();
        let dir = (axis + tilt).as_vec3();
        let target = if random.index(2) == 0 {
            shape.edge_point(random)?
        } else {
            self.near + self.size * random.in_cube()
        };
        let back = self.distance * self.size * axis.normalize();
        Some(ray(target - back, dir))
    }
}

fn ray(origin: DVec3, dir: Vec3) -> Ray {
    Ray::new(origin.as_vec3(), dir).expect("finite, and a direction other than 0")
}
