//! Cases of one shape alone.

use super::cases::Special;
use super::rays::{Aim, aimed};
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::random::Random;
use hitscope_core::shape::{Sphere, Torus};

/// Small and distant spheres, and huge ones.
pub(super) const SPHERES: &[Special<Sphere>] = &[
    (
        "far-1e2",
        "from 10²",
        "From a hundred sizes away.",
        |random| aimed(random, Aim::Around, 1e2),
    ),
    ("far-4e3", "from 4000", "From 4000 sizes away.", |random| {
        aimed(random, Aim::Around, 4e3)
    }),
    (
        "far-1e9",
        "from 10⁹",
        "From a billion sizes away, such as a radius of 1 mm from 1000 km.",
        |random| aimed(random, Aim::Around, 1e9),
    ),
    (
        "huge-1",
        "10⁶, from 1 above",
        "A radius of a million, from a height of 1.",
        |random| huge(random, 1.0),
    ),
    (
        "huge-1e5",
        "10⁶, from 10⁵ above",
        "A radius of a million, from a height of 100 000.",
        |random| huge(random, 1e5),
    ),
    (
        "on-surface",
        "from its surface",
        "Rays that begin at a point of the surface, rounded to f32.",
        |random| huge(random, 0.0),
    ),
];

/// A ray towards a sphere of the radius 10⁶ from a height above it; at the height 0, in any direction from one of the
/// radius 1.
fn huge(random: &mut Random, height: f64) -> (Ray, Sphere) {
    let radius = if height > 0.0 { 1e6f32 } else { 1.0 };
    let up = random.direction();
    let origin = ((f64::from(radius) + height) * up).as_vec3();
    let dir = if height > 0.0 {
        random.direction() - up
    } else {
        random.direction()
    };
    let sphere = Sphere {
        centre: Vec3::ZERO,
        radius,
    };
    (ray(origin, dir), sphere)
}

/// Thick and thin tori from four distances, and the inner equator.
pub(super) const TORI: &[Special<Torus>] = &[
    ("0.25-from-3", "r = 0.25, from 3", TUBE, |random| {
        tube(random, 0.25, 3.0)
    }),
    ("0.25-from-30", "r = 0.25, from 30", TUBE, |random| {
        tube(random, 0.25, 30.0)
    }),
    ("0.25-from-300", "r = 0.25, from 300", TUBE, |random| {
        tube(random, 0.25, 300.0)
    }),
    ("0.25-from-3000", "r = 0.25, from 3000", TUBE, |random| {
        tube(random, 0.25, 3e3)
    }),
    ("0.01-from-3", "r = 0.01, from 3", TUBE, |random| {
        tube(random, 0.01, 3.0)
    }),
    ("0.01-from-30", "r = 0.01, from 30", TUBE, |random| {
        tube(random, 0.01, 30.0)
    }),
    ("0.01-from-300", "r = 0.01, from 300", TUBE, |random| {
        tube(random, 0.01, 300.0)
    }),
    ("0.01-from-3000", "r = 0.01, from 3000", TUBE, |random| {
        tube(random, 0.01, 3e3)
    }),
    (
        "inner",
        "inner equator",
        "Rays along the axis that touch the inner equator exactly.",
        inner,
    ),
];

const TUBE: &str = "A major radius of 1, rays within 1.2 minor radii of the circle.";

fn torus(minor: f32) -> Torus {
    Torus {
        centre: Vec3::ZERO,
        axis: Vec3::Z,
        major: 1.0,
        minor,
    }
}

fn tube(random: &mut Random, minor: f32, distance: f64) -> (Ray, Torus) {
    let around = random.direction().with_z(0.0).normalize_or(DVec3::X);
    let target = around + 1.2 * f64::from(minor) * random.in_cube();
    let origin = (target + distance * random.direction()).as_vec3();
    let dir = (target - origin.as_dvec3()).normalize();
    (ray(origin, dir), torus(minor))
}

/// The point (±3, ±4)/5·(1 − r) of the inner equator, in multiples of a power of two.
fn inner(random: &mut Random) -> (Ray, Torus) {
    let [x, y] = [[3, 4], [4, 3], [5, 0], [0, 5]][random.index(4)].map(|x| x as f32 / 8.0);
    let sign = |random: &mut Random| [-1.0, 1.0][random.index(2)];
    let height = 1.0 + random.index(1000) as f32;
    let origin = Vec3::new(sign(random) * x, sign(random) * y, height);
    (ray(origin, DVec3::NEG_Z), torus(0.375))
}

fn ray(origin: Vec3, dir: DVec3) -> Ray {
    Ray::new(origin, dir.normalize_or(DVec3::X).as_vec3()).expect("finite")
}
