//! Shapes other than triangles, by loops over their tables: boxes, kernels, intersectors, scenes of several groups,
//! spawned rays.

mod bounds;
mod bounds_of_solids;
mod groups;
mod kernels;
mod solids;
mod spawned;

use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::group::Grouped;
use hitscope_core::random::Random;
use hitscope_core::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Disk, Plane, Quadric, Rectangle, Span, Sphere,
    Torus,
};

/// A shape of which tests make random primitives.
trait Sample: Grouped {
    /// A primitive of about this size near a point.
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self;
}

impl Sample for Sphere {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        Self {
            centre: near + within(random, size),
            radius: size * (0.1 + 0.9 * random.unit() as f32),
        }
    }
}

impl Sample for Plane {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        Self {
            point: near + within(random, size),
            normal: random.direction().as_vec3(),
        }
    }
}

impl Sample for Disk {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        Self(span(random, near, size))
    }
}

impl Sample for Rectangle {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        Self(span(random, near, size))
    }
}

impl Sample for Cuboid {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        let Span { centre, u, v } = span(random, near, size);
        let w = size * u.cross(v).normalize() * (0.1 + 0.9 * random.unit() as f32);
        Self {
            centre,
            axes: [u, v, w],
        }
    }
}

impl Sample for AxisBox {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        let centre = near + within(random, size);
        let half = size * (Vec3::splat(0.1) + 0.9 * random.in_cube().as_vec3().abs());
        Self {
            min: centre - half,
            max: centre + half,
        }
    }
}

impl Sample for AxisPlane {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        let axis = random.index(3);
        Self {
            axis: axis as u8,
            coordinate: (near + within(random, size))[axis],
            is_along_axis: random.index(2) == 0,
        }
    }
}

impl Sample for Cylinder {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        let p0 = near + within(random, size);
        Self {
            p0,
            p1: p0 + (size * random.direction().as_vec3()),
            radius: size * (0.1 + 0.9 * random.unit() as f32),
            is_capped: random.index(2) == 0,
        }
    }
}

impl Sample for Cone {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        let Cylinder {
            p0,
            p1,
            radius,
            is_capped,
        } = Cylinder::sample(random, near, size);
        Self {
            p0,
            p1,
            radius,
            is_capped,
        }
    }
}

impl Sample for Quadric {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        // Of the second degree in units of the size.
        let mut coefficient = |power: i32| (random.signed() as f32) * size.powi(-power);
        let quadratic = [(); 6].map(|()| coefficient(2));
        let linear = [(); 3].map(|()| coefficient(1));
        let [a, b, c, d, e, f] = quadratic;
        let [g, h, i] = linear;
        let j = 0.5 * coefficient(0);
        Self {
            coefficients: [a, b, c, d, e, f, g, h, i, j],
            centre: near + within(random, size),
            half: Vec3::splat(size) * (0.5 + 0.5 * random.in_cube().as_vec3().abs()),
        }
    }
}

impl Sample for Torus {
    fn sample(random: &mut Random, near: Vec3, size: f32) -> Self {
        let major = size * (0.3 + 0.5 * random.unit() as f32);
        Self {
            centre: near + within(random, size),
            axis: random.direction().as_vec3(),
            major,
            minor: major * (0.1 + 0.6 * random.unit() as f32),
        }
    }
}

/// A vector in a cube of this size.
fn within(random: &mut Random, size: f32) -> Vec3 {
    size * random.in_cube().as_vec3()
}

/// A parallelogram that isn't narrow.
fn span(random: &mut Random, near: Vec3, size: f32) -> Span {
    let u = random.direction().as_vec3();
    let side = u.any_orthonormal_vector();
    let length = |random: &mut Random| size * (0.2 + 0.8 * random.unit() as f32);
    let (a, b) = (length(random), length(random));
    Span {
        centre: near + within(random, size),
        u: a * u,
        v: b * (side + 0.3 * u),
    }
}

/// A ray from the surroundings of a ball at `middle` through a point of it.
fn ray_near(random: &mut Random, middle: Vec3, size: f32, distance: f64) -> Ray {
    let middle = middle.as_dvec3();
    let size = f64::from(size);
    let origin = middle + distance * size * random.direction();
    let target = middle + size * random.in_cube();
    let dir: DVec3 = (target - origin).normalize_or(DVec3::X);
    Ray::new(origin.as_vec3(), dir.as_vec3()).expect("a ray")
}
