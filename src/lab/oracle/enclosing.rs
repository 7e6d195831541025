//! Exact decisions about points: inside a closed shape or a half-space, on its surface, or outside.
//!
//! The interior is given by polynomials that are negative there, evaluated with integers at one point. Crossings don't
//! enter into it.

use super::exact_t::ExactT;
use super::flat::solve;
use super::fraction::decode;
use super::round::{equation, with_common_exponent};
use super::shapes::{IntegerRay, Oracle};
use super::triangle::{dot, integers, minus};
use dashu_int::IBig;
use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::group::{Grouped, Solid};
use hitscope_core::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Plane, Quadric, Sphere, Torus,
};
use std::cmp::Ordering;
use std::fmt::Debug;
use std::sync::Arc;

/// A shape that encloses points.
pub trait Enclosing: Oracle + Grouped {
    /// Whether the point o + t·d is inside (`Less`), on the surface (`Equal`) or outside (`Greater`). `None` if the
    /// primitive encloses nothing: it is open, can't be hit, or has a NaN or an infinity.
    fn side(&self, ray: &Ray, t: f64) -> Option<Ordering>;

    /// All t > 0 at which the side may change, in any order.
    fn changes(&self, ray: &Ray) -> Vec<ExactT> {
        self.crossings(ray)
    }

    /// The interior as a solid.
    fn solid(&self) -> Solid {
        Solid::of(self.clone())
    }

    /// The shapes that are the solid's operands.
    fn operands(&self) -> Vec<Arc<dyn EnclosingShape>> {
        vec![Arc::new(self.clone())]
    }
}

/// [`Enclosing`] for a primitive of any shape.
pub trait EnclosingShape: Debug + Send + Sync {
    /// See [`Enclosing::side`]. All points are outside a primitive that encloses nothing.
    fn side(&self, ray: &Ray, t: f64) -> Ordering;

    /// See [`Enclosing::changes`].
    fn changes(&self, ray: &Ray) -> Vec<ExactT>;

    /// See [`Enclosing::solid`].
    fn solid(&self) -> Solid;

    /// See [`Enclosing::operands`].
    fn operands(&self) -> Vec<Arc<dyn EnclosingShape>>;
}

impl<S: Enclosing> EnclosingShape for S {
    fn side(&self, ray: &Ray, t: f64) -> Ordering {
        S::side(self, ray, t).unwrap_or(Ordering::Greater)
    }

    fn changes(&self, ray: &Ray) -> Vec<ExactT> {
        S::changes(self, ray)
    }

    fn solid(&self) -> Solid {
        S::solid(self)
    }

    fn operands(&self) -> Vec<Arc<dyn EnclosingShape>> {
        S::operands(self)
    }
}

/// A point of a ray, and places, in a common unit.
struct IntegerPoint {
    at: [IBig; 3],
    places: Vec<[IBig; 3]>,
}

impl IntegerPoint {
    /// `None` if a number isn't finite.
    fn new(ray: &Ray, t: f64, places: &[Vec3]) -> Option<Self> {
        let all = IntegerRay::new(ray, places)?;
        let (mantissa, exponent) = match decode(t)? {
            (0, _) => (0, all.exponent),
            nonzero => nonzero,
        };
        // t is in units of 2^exponent of the ray; a finer unit makes it an integer.
        let shift = exponent - all.exponent;
        let finer = shift.min(0).unsigned_abs() as usize;
        let t = IBig::from(mantissa) << shift.max(0) as usize;
        let at = |axis: usize| (&all.origin[axis] << finer) + &all.dir[axis] * &t;
        let places = all.places.iter();
        Some(Self {
            at: std::array::from_fn(at),
            places: places
                .map(|place| place.each_ref().map(|x| x << finer))
                .collect(),
        })
    }

    /// The point relative to a place.
    fn from(&self, place: usize) -> [IBig; 3] {
        minus(&self.at, &self.places[place])
    }
}

/// The side of a shape whose interior is where all of these are negative.
fn where_negative<const N: usize>(values: [IBig; N]) -> Option<Ordering> {
    values.iter().map(|value| value.cmp(&IBig::ZERO)).max()
}

impl Enclosing for Sphere {
    fn side(&self, ray: &Ray, t: f64) -> Option<Ordering> {
        let point = IntegerPoint::new(ray, t, &[self.centre, Vec3::splat(self.radius)])?;
        let (f, r) = (point.from(0), &point.places[1][0]);
        where_negative([dot(&f, &f) - r * r]).filter(|_| self.radius > 0.0)
    }
}

impl Enclosing for Plane {
    fn side(&self, ray: &Ray, t: f64) -> Option<Ordering> {
        let point = IntegerPoint::new(ray, t, &[self.point])?;
        let (normals, _) = integers(&[self.normal])?;
        let side = where_negative([dot(&normals[0], &point.from(0))]);
        side.filter(|_| self.normal != Vec3::ZERO)
    }
}

impl Enclosing for AxisPlane {
    fn side(&self, ray: &Ray, t: f64) -> Option<Ordering> {
        let point = IntegerPoint::new(ray, t, &[Vec3::splat(self.coordinate)])?;
        let above = &point.from(0)[usize::from(self.axis)];
        where_negative([if self.is_along_axis {
            above.clone()
        } else {
            -above
        }])
    }
}

impl Enclosing for Cuboid {
    fn side(&self, ray: &Ray, t: f64) -> Option<Ordering> {
        let [a, b, c] = self.axes;
        let point = IntegerPoint::new(ray, t, &[self.centre, a, b, c])?;
        let axes = [1, 2, 3].map(|k| point.places[k].clone());
        let ([at], one) = solve(&axes, [point.from(0)])?;
        where_negative(at.map(|x| &x * &x - &one * &one))
    }
}

impl Enclosing for AxisBox {
    fn side(&self, ray: &Ray, t: f64) -> Option<Ordering> {
        let point = IntegerPoint::new(ray, t, &[self.min, self.max])?;
        let below = where_negative(point.from(0).map(|x| -x))?;
        let above = where_negative(point.from(1))?;
        Some(below.max(above))
    }
}

/// A point in the coordinates of the axis w = p₁ − p₀, with f from p₀ to it.
struct Axial {
    /// f·w.
    height: IBig,
    /// w².
    length_squared: IBig,
    /// The squared distance from the axis, times w².
    beside: IBig,
    radius_squared: IBig,
}

impl Axial {
    /// `None` if the shape can't be hit.
    fn new(ray: &Ray, t: f64, p0: Vec3, p1: Vec3, radius: f32) -> Option<Self> {
        let point = IntegerPoint::new(ray, t, &[p0, p1, Vec3::splat(radius)])?;
        let (f, w) = (point.from(0), minus(&point.places[1], &point.places[0]));
        let (height, length_squared) = (dot(&f, &w), dot(&w, &w));
        let radius_here = &point.places[2][0];
        let can_be_hit = radius > 0.0 && length_squared > IBig::ZERO;
        can_be_hit.then(|| Self {
            beside: dot(&f, &f) * &length_squared - &height * &height,
            radius_squared: radius_here * radius_here,
            height,
            length_squared,
        })
    }

    /// Negative between the two ends.
    fn between_ends(&self) -> [IBig; 2] {
        [-&self.height, &self.height - &self.length_squared]
    }
}

impl Enclosing for Cylinder {
    fn side(&self, ray: &Ray, t: f64) -> Option<Ordering> {
        let axial = Axial::new(ray, t, self.p0, self.p1, self.radius)?;
        let [first, second] = axial.between_ends();
        let around = &axial.beside - &axial.radius_squared * &axial.length_squared;
        where_negative([first, second, around]).filter(|_| self.is_capped)
    }
}

impl Enclosing for Cone {
    /// The distance from the axis is below r·(w² − f·w)/w².
    fn side(&self, ray: &Ray, t: f64) -> Option<Ordering> {
        let axial = Axial::new(ray, t, self.p0, self.p1, self.radius)?;
        let [first, second] = axial.between_ends();
        let around =
            &axial.beside * &axial.length_squared - &axial.radius_squared * &second * &second;
        where_negative([first, second, around]).filter(|_| self.is_capped)
    }
}

impl Enclosing for Torus {
    /// Where the tube meets itself, it is hollow.
    fn side(&self, ray: &Ray, t: f64) -> Option<Ordering> {
        let radii = Vec3::new(self.major, self.minor, 0.0);
        let point = IntegerPoint::new(ray, t, &[self.centre, radii])?;
        let (axes, _) = integers(&[self.axis])?;
        let (p, w, [major, minor, _]) = (point.from(0), &axes[0], &point.places[1]);
        let (major, minor) = (major * major, minor * minor);
        let (along, axis) = (dot(&p, w), dot(w, w));
        let from_ball = dot(&p, &p) - &major - &minor;
        let tube = &axis * (&from_ball * &from_ball) + ((&major * &along * &along) << 2)
            - ((&major * &minor * &axis) << 2);
        let can_be_hit = self.major > 0.0 && self.minor > 0.0 && self.axis != Vec3::ZERO;
        where_negative([tube]).filter(|_| can_be_hit)
    }
}

impl Enclosing for Quadric {
    /// Inside are the points of the box where the left side of the equation is negative.
    fn side(&self, ray: &Ray, t: f64) -> Option<Ordering> {
        let point = IntegerPoint::new(ray, t, &[self.centre, self.half, Vec3::ONE])?;
        let (p, one) = (point.from(0), &point.places[2][0]);
        let coefficients = with_common_exponent(&self.coefficients)?;
        let value = where_negative([equation(&coefficients, &p, one)])?;
        let half = &point.places[1];
        let in_box = std::array::from_fn(|axis| &p[axis] * &p[axis] - &half[axis] * &half[axis]);
        let in_box = where_negative::<3>(in_box)?;
        (self.half.min_element() > 0.0).then(|| value.max(in_box))
    }

    /// The crossings with the surface, also beyond the box, and those with the box.
    fn changes(&self, ray: &Ray) -> Vec<ExactT> {
        let (surface, cut) = parts(self);
        let mut changes = surface.crossings(ray);
        changes.extend(cut.crossings(ray));
        changes
    }

    fn solid(&self) -> Solid {
        Solid::of_quadric(*self)
    }

    fn operands(&self) -> Vec<Arc<dyn EnclosingShape>> {
        let (surface, cut) = parts(self);
        vec![Arc::new(surface), Arc::new(cut)]
    }
}

/// A quadric in a box that is larger than any scene, and its own box.
fn parts(quadric: &Quadric) -> (Quadric, Cuboid) {
    let Vec3 { x, y, z } = quadric.half;
    let cut = Cuboid {
        centre: quadric.centre,
        axes: [x * Vec3::X, y * Vec3::Y, z * Vec3::Z],
    };
    let half = Vec3::splat(1e30);
    (Quadric { half, ..*quadric }, cut)
}
