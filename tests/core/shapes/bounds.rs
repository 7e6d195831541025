//! The boxes of shapes: no point of the surface lies outside, and no plane is much farther than needed.

use super::Sample;
use glam::{DVec2, DVec3, Vec3};
use hitscope_core::Aabb;
use hitscope_core::random::Random;
use hitscope_core::shape::{Cone, Cylinder, Disk, Quadric, Rectangle, Shape, Span, Sphere, Torus};
use std::f64::consts::TAU;

/// u of f32.
const U: f64 = f32::EPSILON as f64 / 2.0;

/// A surface in f64.
trait Surface: Shape {
    /// A random point.
    fn point(&self, random: &mut Random) -> DVec3;

    /// The true box, by another formula than that of the shape.
    fn extremes(&self) -> [DVec3; 2];
}

/// A point of the unit circle.
fn on_circle(random: &mut Random) -> DVec2 {
    let (sin, cos) = (TAU * random.unit()).sin_cos();
    DVec2::new(cos, sin)
}

/// Two unit vectors across an axis.
fn across(axis: DVec3) -> [DVec3; 2] {
    let (u, v) = axis.normalize().any_orthonormal_pair();
    [u, v]
}

/// How far an ellipse with these half axes reaches.
fn reach([u, v]: [DVec3; 2]) -> DVec3 {
    DVec3::new(u.x.hypot(v.x), u.y.hypot(v.y), u.z.hypot(v.z))
}

impl Surface for Sphere {
    fn point(&self, random: &mut Random) -> DVec3 {
        self.centre.as_dvec3() + f64::from(self.radius) * random.direction()
    }

    fn extremes(&self) -> [DVec3; 2] {
        let (centre, radius) = (self.centre.as_dvec3(), f64::from(self.radius));
        [centre - radius, centre + radius]
    }
}

impl Surface for Disk {
    fn point(&self, random: &mut Random) -> DVec3 {
        let [centre, u, v] = [self.0.centre, self.0.u, self.0.v].map(Vec3::as_dvec3);
        let at = random.unit().sqrt() * on_circle(random);
        centre + at.x * u + at.y * v
    }

    fn extremes(&self) -> [DVec3; 2] {
        let [centre, u, v] = [self.0.centre, self.0.u, self.0.v].map(Vec3::as_dvec3);
        let reach = reach([u, v]);
        [centre - reach, centre + reach]
    }
}

impl Surface for Rectangle {
    fn point(&self, random: &mut Random) -> DVec3 {
        let [centre, u, v] = [self.0.centre, self.0.u, self.0.v].map(Vec3::as_dvec3);
        centre + random.signed() * u + random.signed() * v
    }

    fn extremes(&self) -> [DVec3; 2] {
        let [centre, u, v] = [self.0.centre, self.0.u, self.0.v].map(Vec3::as_dvec3);
        let reach = u.abs() + v.abs();
        [centre - reach, centre + reach]
    }
}

impl Surface for Cylinder {
    fn point(&self, random: &mut Random) -> DVec3 {
        let [p0, p1] = [self.p0, self.p1].map(Vec3::as_dvec3);
        let ([u, v], at) = (across(p1 - p0), on_circle(random));
        // Half of the points are on the rims.
        let along = [0.0, 1.0, random.unit(), random.unit()][random.index(4)];
        p0.lerp(p1, along) + f64::from(self.radius) * (at.x * u + at.y * v)
    }

    fn extremes(&self) -> [DVec3; 2] {
        let [p0, p1] = [self.p0, self.p1].map(Vec3::as_dvec3);
        let reach = f64::from(self.radius) * reach(across(p1 - p0));
        [p0.min(p1) - reach, p0.max(p1) + reach]
    }
}

impl Surface for Cone {
    fn point(&self, random: &mut Random) -> DVec3 {
        let [base, apex] = [self.p0, self.p1].map(Vec3::as_dvec3);
        let ([u, v], at) = (across(apex - base), on_circle(random));
        let along = [0.0, 1.0, random.unit(), random.unit()][random.index(4)];
        let radius = (1.0 - along) * f64::from(self.radius);
        base.lerp(apex, along) + radius * (at.x * u + at.y * v)
    }

    fn extremes(&self) -> [DVec3; 2] {
        let [base, apex] = [self.p0, self.p1].map(Vec3::as_dvec3);
        let reach = f64::from(self.radius) * reach(across(apex - base));
        [(base - reach).min(apex), (base + reach).max(apex)]
    }
}

impl Surface for Torus {
    fn point(&self, random: &mut Random) -> DVec3 {
        let axis = self.axis.as_dvec3().normalize();
        let ([u, v], at) = (across(axis), on_circle(random));
        let (outwards, in_tube) = (at.x * u + at.y * v, on_circle(random));
        let [major, minor] = [self.major, self.minor].map(f64::from);
        let tube = in_tube.x * outwards + in_tube.y * axis;
        self.centre.as_dvec3() + major * outwards + minor * tube
    }

    fn extremes(&self) -> [DVec3; 2] {
        let [major, minor] = [self.major, self.minor].map(f64::from);
        let reach = major * reach(across(self.axis.as_dvec3())) + minor;
        let centre = self.centre.as_dvec3();
        [centre - reach, centre + reach]
    }
}

/// Checks points of a surface, and how much larger than the true box the shape's is: by at most 36u of how far the shape
/// reaches from its middle, as a disk's reach is, and by half an ulp and two ulps, or 5u, of each plane's coordinate.
/// Formulas of this test in f64 err by far less than 2⁻⁴⁸ of the coordinates.
fn is_enclosed_tightly<S: Surface>(shape: &S, points: u32, random: &mut Random) {
    let Aabb { min, max } = shape.bounds();
    let [min, max] = [min, max].map(Vec3::as_dvec3);
    let [lower, upper] = shape.extremes();
    let in_test = 2f64.powi(-48) * lower.abs().max(upper.abs()).max_element();
    for _ in 0..points {
        let p = shape.point(random);
        let is_inside = (min - in_test).cmple(p).all() && p.cmple(max + in_test).all();
        assert!(is_inside, "{shape:?} {p} {min} {max}");
    }
    for (plane, true_plane, beyond) in [(min, lower, lower - min), (max, upper, max - upper)] {
        assert!(
            beyond.cmpge(DVec3::splat(-in_test)).all(),
            "{shape:?} {plane} {true_plane}"
        );
        let allowed = 18.0 * U * (upper - lower) + 5.0 * U * plane.abs() + in_test;
        assert!(
            beyond.cmple(allowed).all(),
            "{shape:?} {plane} {true_plane} {beyond} {allowed}"
        );
    }
}

fn random_shapes_are_enclosed_tightly<S: Surface + Sample>(seed: u64) {
    let mut random = Random::new(seed);
    for (size, offset) in [
        (1.0, 0.0),
        (1e-4, 0.0),
        (1e4, 0.0),
        (1.0, 1e2),
        (10.0, 1e6),
        (1e-12, 1e-12),
        (1e12, 1e12),
    ] {
        for _ in 0..3 {
            let near = offset * random.in_cube().as_vec3();
            let shape = S::sample(&mut random, near, size);
            is_enclosed_tightly(&shape, 10_000, &mut random);
        }
        for _ in 0..1000 {
            let near = offset * random.in_cube().as_vec3();
            let shape = S::sample(&mut random, near, size);
            is_enclosed_tightly(&shape, 1, &mut random);
        }
    }
}

#[test]
fn boxes_enclose_random_shapes_tightly() {
    random_shapes_are_enclosed_tightly::<Sphere>(1);
    random_shapes_are_enclosed_tightly::<Disk>(2);
    random_shapes_are_enclosed_tightly::<Rectangle>(3);
    random_shapes_are_enclosed_tightly::<Cylinder>(4);
    random_shapes_are_enclosed_tightly::<Cone>(5);
    random_shapes_are_enclosed_tightly::<Torus>(6);
}

/// Checks a box whose planes are exact sums, which are moved outwards by two ulps at most. For a torus, this is done
/// twice. 0 stays 0.
pub(super) fn is_exact(found: Aabb, min: impl Into<DVec3>, max: impl Into<DVec3>) {
    let inwards = |x: f32, next: fn(f32) -> f32| {
        let moved = (0..4).fold(x, |x, _| next(x));
        f64::from(if x == 0.0 { x } else { moved })
    };
    let (min, max) = (min.into(), max.into());
    for k in 0..3 {
        let (lower, upper) = (found.min[k], found.max[k]);
        let is_lower = f64::from(lower) <= min[k] && min[k] <= inwards(lower, f32::next_up);
        let is_upper = max[k] <= f64::from(upper) && inwards(upper, f32::next_down) <= max[k];
        assert!(is_lower && is_upper, "{found:?} {min} {max}");
    }
}

#[test]
fn boxes_of_shapes_along_the_axes_are_exact_but_for_their_rounding() {
    let at = Vec3::new(1.0, 2.0, 0.0);
    for k in 0..3 {
        for length in [3.0, -3.0f32] {
            let axis = length * Vec3::AXES[k];
            let (p0, p1, radius) = (at, at + axis, 0.5);
            // The ends along the axis, and the radius across.
            let flat = |reach: f64| {
                let mut half = [reach; 3];
                half[k] = 0.0;
                DVec3::from(half)
            };
            let (a, b) = (p0.min(p1).as_dvec3(), p0.max(p1).as_dvec3());
            let (min, max) = (a - flat(0.5), b + flat(0.5));
            for is_capped in [false, true] {
                let cylinder = Cylinder {
                    p0,
                    p1,
                    radius,
                    is_capped,
                };
                is_exact(cylinder.bounds(), min, max);
                let cone = Cone {
                    p0,
                    p1,
                    radius,
                    is_capped,
                };
                is_exact(cone.bounds(), min, max);
            }
            let torus = Torus {
                centre: 8.0 * at,
                axis,
                major: 1.0,
                minor: 0.25,
            };
            let half = flat(1.0) + 0.25;
            let far = 8.0 * at.as_dvec3();
            is_exact(torus.bounds(), far - half, far + half);
            let disk = Disk(Span {
                centre: at,
                u: length * Vec3::AXES[(k + 1) % 3],
                v: length * Vec3::AXES[(k + 2) % 3],
            });
            let half = flat(3.0);
            is_exact(disk.bounds(), at.as_dvec3() - half, at.as_dvec3() + half);
        }
    }
    // As for any quadric, its own box.
    let quadric = Quadric {
        coefficients: [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0],
        centre: at,
        half: Vec3::new(1.0, 2.0, 4.0),
    };
    is_exact(quadric.bounds(), [0.0, 0.0, -4.0], [2.0, 4.0, 4.0]);
}

#[test]
fn an_axis_of_any_length_gives_the_same_box() {
    let torus = |axis: Vec3| Torus {
        centre: Vec3::ZERO,
        axis,
        major: 2.0,
        minor: 0.5,
    };
    let direction = Vec3::new(1.0, -2.0, 3.0);
    let usual = torus(direction).bounds();
    // Powers of 2 are exact but for the least numbers, where these three still are.
    for power in [-149, -148, -100, -60, 60, 100, 126] {
        let scaled = direction * 2f64.powi(power) as f32;
        assert_eq!(torus(scaled).bounds(), usual, "2^{power}");
    }
    assert_eq!(torus(Vec3::ZERO).bounds(), Aabb::EMPTY);
}

#[test]
fn extreme_cylinders_and_cones_are_enclosed() {
    let mut random = Random::new(7);
    let far = Vec3::new(1e6, -1e6, 1e6);
    let tilted = Vec3::new(0.6, -0.7, 0.4);
    for (p0, p1, radius) in [
        // Nearly a disk, and nearly a line.
        (Vec3::ZERO, 1e-30 * tilted, 1.0),
        (Vec3::ZERO, 1e30 * tilted, 1.0),
        (Vec3::ZERO, 1e-30 * tilted, 1e-3),
        // A tiny radius beside a large offset.
        (far, far + 3.0 * tilted, 1e-30),
        (far, far + 3.0 * tilted, 1e-3),
        // The shortest axis at an offset.
        (far, far.map(f32::next_up), 10.0),
        // Nearly along an axis: the disk reaches 1e-25 along it.
        (Vec3::ZERO, Vec3::new(0.0, 1e-25, 1.0), 1.0),
        (Vec3::ZERO, Vec3::new(1e-30, 1e-35, 1.0), 1.0),
        (Vec3::ZERO, Vec3::new(1e10, 1e-20, 0.0), 1e20),
    ] {
        let cylinder = Cylinder {
            p0,
            p1,
            radius,
            is_capped: true,
        };
        is_enclosed_tightly(&cylinder, 10_000, &mut random);
        let cone = Cone {
            p0: p1,
            p1: p0,
            radius,
            is_capped: false,
        };
        is_enclosed_tightly(&cone, 10_000, &mut random);
    }
    // The smallest reach along the axis is kept, which f64 above rounds away.
    let nearly_aligned = Cylinder {
        p0: Vec3::ZERO,
        p1: Vec3::new(0.0, 1e-25, 1.0),
        radius: 1.0,
        is_capped: false,
    };
    let below = f64::from(nearly_aligned.bounds().min.z);
    assert!((-1.00001e-25..=-0.99999e-25).contains(&below), "{below:e}");
    // The axis overflows: the radius counts in all directions.
    let longest = Cylinder {
        p0: Vec3::splat(-3e38),
        p1: Vec3::splat(3e38),
        radius: 1e37,
        is_capped: false,
    };
    let Aabb { min, max } = longest.bounds();
    assert!(min.cmple(Vec3::splat(-3.09e38)).all() && Vec3::splat(3.09e38).cmple(max).all());
    assert!(min.is_finite() && max.is_finite());
}

#[test]
fn shapes_that_no_ray_hits_have_empty_boxes() {
    let cylinder = |p1: Vec3, radius: f32| Cylinder {
        p0: Vec3::ONE,
        p1,
        radius,
        is_capped: true,
    };
    for (p1, radius) in [
        (Vec3::ONE, 1.0),
        (Vec3::ZERO, 0.0),
        (Vec3::ZERO, -1.0),
        (Vec3::ZERO, f32::NAN),
        (Vec3::ZERO, f32::INFINITY),
        (Vec3::NAN, 1.0),
        (Vec3::INFINITY, 1.0),
    ] {
        assert_eq!(cylinder(p1, radius).bounds(), Aabb::EMPTY, "{p1} {radius}");
        let cone = Cone {
            p0: Vec3::ONE,
            p1,
            radius,
            is_capped: false,
        };
        assert_eq!(cone.bounds(), Aabb::EMPTY, "{p1} {radius}");
    }
    let disk = Disk(Span {
        centre: Vec3::ZERO,
        u: Vec3::X,
        v: Vec3::new(0.0, f32::NAN, 0.0),
    });
    assert_eq!(disk.bounds(), Aabb::EMPTY);
}
