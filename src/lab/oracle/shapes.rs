//! The oracle's interface, for every shape.

use super::exact_t::ExactT;
use super::fraction::decode;
use super::quadratic::Quadratic;
use super::surd::Surd;
use super::triangle::{self, integers, minus};
use dashu_int::IBig;
use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::shape::{Shape, Triangle};
use std::cmp::Ordering;

/// A shape with exact crossings.
pub trait Oracle: Shape {
    /// All t > 0 at which a ray crosses a primitive, in ascending order. A ray that touches a surface crosses it once;
    /// one that lies in a surface misses that surface. The ray's interval is ignored. A primitive that can't be hit, or
    /// with a NaN or an infinity, has no crossings.
    fn crossings(&self, ray: &Ray) -> Vec<ExactT>;
}

/// The same, correctly rounded to f64.
pub fn crossings_in_f64<S: Oracle>(ray: &Ray, shape: &S) -> Vec<f64> {
    let mut crossings = shape.crossings(ray);
    crossings.iter_mut().map(ExactT::to_f64).collect()
}

impl Oracle for Triangle {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let whole = Ray {
            t_min: 0.0,
            t_max: f32::INFINITY,
            ..*ray
        };
        let t = triangle::intersect(&whole, self.0).map(|hit| {
            let [n, d] = hit.t.parts();
            let t = Surd::rational(n.clone(), d.clone());
            ExactT::from(t.expect("the denominator isn't 0"))
        });
        t.into_iter().collect()
    }
}

/// A ray in integers: positions and lengths in a common unit, and t in units of 2^`exponent`.
pub(super) struct IntegerRay {
    pub origin: [IBig; 3],
    pub dir: [IBig; 3],
    /// The given positions and lengths.
    pub places: Vec<[IBig; 3]>,
    /// Of t.
    pub exponent: i32,
}

impl IntegerRay {
    /// `None` if a number isn't finite.
    pub fn new(ray: &Ray, places: &[Vec3]) -> Option<Self> {
        let all = [&[ray.origin], places].concat();
        let (mut places, length_exponent) = integers(&all)?;
        let (mut dirs, dir_exponent) = integers(&[ray.dir])?;
        Some(Self {
            origin: places.remove(0),
            dir: dirs.remove(0),
            places,
            exponent: length_exponent - dir_exponent,
        })
    }

    /// The origin relative to a place.
    pub fn from(&self, place: usize) -> [IBig; 3] {
        minus(&self.origin, &self.places[place])
    }

    /// The positive values of t among those given, in ascending order, equal ones once.
    pub fn positive(&self, found: Vec<Surd>) -> Vec<ExactT> {
        let mut found = found;
        found.retain(|t| t.sign() == Ordering::Greater);
        found.sort_by(Surd::compare);
        found.dedup_by(|a, b| a.compare(b) == Ordering::Equal);
        let scaled = found.into_iter().map(|t| t.scaled(self.exponent).into());
        scaled.collect()
    }
}

/// The roots of a polynomial at which no condition is negative.
pub(super) fn roots_where(surface: &Quadratic, conditions: &[Quadratic]) -> Vec<Surd> {
    let mut roots = Surd::roots(surface);
    roots.retain(|t| {
        let is_met = |condition: &Quadratic| t.sign_of(condition) != Ordering::Less;
        conditions.iter().all(is_met)
    });
    roots
}

/// A finite number as an integer times a power of two.
pub(super) fn integer_of(x: f32) -> Option<(IBig, i32)> {
    let (mantissa, exponent) = decode(f64::from(x))?;
    Some((mantissa.into(), exponent))
}
