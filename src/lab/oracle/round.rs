//! Exact intersections with spheres, cylinders, cones and quadrics.
//!
//! Each surface is 0 of a polynomial of degree 2 in t, and each of its borders one of degree 2 at most, both with integer
//! coefficients. With p = o + t·d − p₀ and the axis w = p₁ − p₀, the squared distance from the axis is
//! (w²·p² − (p·w)²)/w²; the kernels have it as |p×w|². A cone is measured from its base; the kernels measure it from its
//! apex. A quadric's polynomial is found by interpolation of three values; the kernels multiply it out.

use super::exact_t::ExactT;
use super::quadratic::Quadratic;
use super::shapes::{IntegerRay, Oracle, integer_of, roots_where};
use super::triangle::{dot, minus};
use dashu_int::IBig;
use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::shape::{Cone, Cylinder, Quadric, Sphere};

impl Oracle for Sphere {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let crossings = || {
            let all = IntegerRay::new(ray, &[self.centre, Vec3::splat(self.radius)])?;
            let (f, r) = (all.from(0), &all.places[1][0]);
            let surface = squared_length(&f, &all.dir).minus(&Quadratic::constant(r * r));
            Some(all.positive(roots_where(&surface, &[])))
        };
        let crossings = (self.radius > 0.0).then(crossings);
        crossings.flatten().unwrap_or_default()
    }
}

impl Oracle for Cylinder {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let crossings = || {
            let axial = Axial::new(ray, self.p0, self.p1, self.radius)?;
            let mut found = roots_where(&axial.beside.minus(&axial.reach), &axial.between_ends());
            if self.is_capped {
                let inside = [axial.reach.minus(&axial.beside)];
                found.extend(roots_where(&axial.height, &inside));
                found.extend(roots_where(&axial.depth(), &inside));
            }
            Some(axial.ray.positive(found))
        };
        crossings().unwrap_or_default()
    }
}

impl Oracle for Cone {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let crossings = || {
            let axial = Axial::new(ray, self.p0, self.p1, self.radius)?;
            // The distance from the axis is r·(w² − p·w)/w².
            let [depth, step, _] = axial.depth().0;
            let r_squared = &axial.radius * &axial.radius;
            let slope = Quadratic::square([&depth, &step]).times(&r_squared);
            let surface = axial.beside.times(&axial.length_squared).minus(&slope);
            let mut found = roots_where(&surface, &axial.between_ends());
            if self.is_capped {
                let inside = axial.reach.minus(&axial.beside);
                found.extend(roots_where(&axial.height, &[inside]));
            }
            Some(axial.ray.positive(found))
        };
        crossings().unwrap_or_default()
    }
}

/// A ray in the coordinates of an axis.
struct Axial {
    ray: IntegerRay,
    radius: IBig,
    /// w².
    length_squared: IBig,
    /// p·w.
    height: Quadratic,
    /// The squared distance from the axis, times w².
    beside: Quadratic,
    /// The squared radius, times w².
    reach: Quadratic,
}

impl Axial {
    /// `None` if the shape can't be hit.
    fn new(ray: &Ray, p0: Vec3, p1: Vec3, radius: f32) -> Option<Self> {
        let ray = IntegerRay::new(ray, &[p0, p1, Vec3::splat(radius)])?;
        let f = ray.from(0);
        let (w, radius) = (
            minus(&ray.places[1], &ray.places[0]),
            ray.places[2][0].clone(),
        );
        let length_squared = dot(&w, &w);
        let [height, step] = [dot(&f, &w), dot(&ray.dir, &w)];
        let beside = squared_length(&f, &ray.dir)
            .times(&length_squared)
            .minus(&Quadratic::square([&height, &step]));
        let can_be_hit = radius > IBig::ZERO && length_squared > IBig::ZERO;
        can_be_hit.then(|| Self {
            reach: Quadratic::constant(&radius * &radius * &length_squared),
            height: Quadratic::linear(height, step),
            ray,
            radius,
            length_squared,
            beside,
        })
    }

    /// (p₁ − p)·w.
    fn depth(&self) -> Quadratic {
        Quadratic::constant(self.length_squared.clone()).minus(&self.height)
    }

    fn between_ends(&self) -> [Quadratic; 2] {
        [self.height.clone(), self.depth()]
    }
}

/// |f + t·d|².
fn squared_length(f: &[IBig; 3], d: &[IBig; 3]) -> Quadratic {
    Quadratic([dot(f, f), dot(f, d) << 1, dot(d, d)])
}

impl Oracle for Quadric {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let crossings = || {
            // With 1 among the lengths, their unit is at most 1.
            let all = IntegerRay::new(ray, &[self.centre, self.half, Vec3::ONE])?;
            let (f, one) = (all.from(0), &all.places[2][0]);
            let coefficients = with_common_exponent(&self.coefficients)?;
            let value = |t: i32| {
                let step = all.dir.each_ref().map(|d| d * IBig::from(t));
                let p: [IBig; 3] = std::array::from_fn(|axis| &f[axis] + &step[axis]);
                equation(&coefficients, &p, one)
            };
            let surface = Quadratic::through([&value(-1), &value(0), &value(1)]);
            let half = &all.places[1];
            let mut in_box = Vec::with_capacity(6);
            for axis in 0..3 {
                let x = Quadratic::linear(f[axis].clone(), all.dir[axis].clone());
                let half = Quadratic::constant(half[axis].clone());
                in_box.extend([half.minus(&x), half.plus(&x)]);
            }
            Some(all.positive(roots_where(&surface, &in_box)))
        };
        let crossings = (self.half.max_element() > 0.0).then(crossings);
        crossings.flatten().unwrap_or_default()
    }
}

/// The numbers as integers, in a common unit.
pub(super) fn with_common_exponent(numbers: &[f32; 10]) -> Option<Vec<IBig>> {
    let decoded: Vec<(IBig, i32)> = numbers
        .iter()
        .map(|&x| integer_of(x))
        .collect::<Option<_>>()?;
    let nonzero = decoded
        .iter()
        .filter(|(mantissa, _)| *mantissa != IBig::ZERO);
    let least = nonzero.map(|(_, exponent)| *exponent).min().unwrap_or(0);
    let shifted = decoded.into_iter().map(|(mantissa, exponent)| {
        let is_zero = mantissa == IBig::ZERO;
        mantissa
            << if is_zero {
                0
            } else {
                (exponent - least) as usize
            }
    });
    Some(shifted.collect())
}

/// The left side of the quadric's equation at a point in units of 1/one, times one².
pub(super) fn equation(coefficients: &[IBig], [x, y, z]: &[IBig; 3], one: &IBig) -> IBig {
    let [a, b, c, d, e, f, g, h, i, j] = coefficients else {
        return IBig::ZERO;
    };
    // A row of the symmetric matrix times (x, y, z, 1).
    let row = |k: [&IBig; 4]| k[0] * x + k[1] * y + k[2] * z + k[3] * one;
    row([a, d, f, g]) * x + row([d, b, e, h]) * y + row([f, e, c, i]) * z + row([g, h, i, j]) * one
}

#[cfg(test)]
mod tests {
    use super::super::shapes::crossings_in_f64;
    use super::*;

    fn ray(origin: [f32; 3], dir: [f32; 3]) -> Ray {
        Ray::new(origin.into(), dir.into()).expect("a ray")
    }

    #[test]
    fn roots_of_integers_are_exact_and_others_rounded() {
        let sphere = Sphere {
            centre: Vec3::ZERO,
            radius: 1.0,
        };
        let unit = |origin, dir| crossings_in_f64(&ray(origin, dir), &sphere);
        assert_eq!(unit([0.0, 0.0, 3.0], [0.0, 0.0, -1.0]), [2.0, 4.0]);
        assert_eq!(unit([0.0, 0.0, 0.0], [0.0, 0.0, -2.0]), [0.5]);
        assert_eq!(unit([1.0, 0.0, 3.0], [0.0, 0.0, -1.0]), [3.0]);
        assert!(unit([1f32.next_up(), 0.0, 3.0], [0.0, 0.0, -1.0]).is_empty());
        assert!(unit([0.0, 0.0, 3.0], [0.0, 0.0, 1.0]).is_empty());
        // On the surface, t = 0 doesn't count.
        assert_eq!(unit([0.0, 0.0, 1.0], [0.0, 0.0, -1.0]), [2.0]);
        // 3 ∓ √0.75 = 2.13397459621556135323… and 3.86602540378443864676…
        let roots = unit([0.5, 0.0, 3.0], [0.0, 0.0, -1.0]);
        assert_eq!(roots, [2.133974596215561, 3.866025403784439]);
    }

    #[test]
    fn a_cylinder_and_a_cone_are_crossed_at_sides_caps_rims_and_apex() {
        let [p0, p1, radius] = [Vec3::ZERO, Vec3::new(0.0, 0.0, 4.0), Vec3::splat(2.0)];
        for is_capped in [false, true] {
            let radius = radius.x;
            let cylinder = Cylinder {
                p0,
                p1,
                radius,
                is_capped,
            };
            let cone = Cone {
                p0,
                p1,
                radius,
                is_capped,
            };
            let at = |origin, dir| {
                let ray = ray(origin, dir);
                [
                    crossings_in_f64(&ray, &cylinder),
                    crossings_in_f64(&ray, &cone),
                ]
            };
            let [on_cylinder, on_cone] = at([5.0, 0.0, 2.0], [-1.0, 0.0, 0.0]);
            assert_eq!((on_cylinder, on_cone), (vec![3.0, 7.0], vec![4.0, 6.0]));
            // Along the axis: caps and the apex.
            let [on_cylinder, on_cone] = at([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]);
            assert_eq!(on_cylinder, if is_capped { vec![1.0, 5.0] } else { vec![] });
            assert_eq!(on_cone, if is_capped { vec![1.0, 5.0] } else { vec![5.0] });
            // In the cylinder's side, and through the rim of the base.
            let [on_cylinder, on_cone] = at([2.0, 0.0, -1.0], [0.0, 0.0, 1.0]);
            assert_eq!(on_cylinder, if is_capped { vec![1.0, 5.0] } else { vec![] });
            assert_eq!(on_cone, [1.0]);
        }
    }

    #[test]
    fn a_quadric_is_cut_by_its_box() {
        // x² + y² + z² = 4 about (1, 0, 0), where |x − 1| ≤ 1.
        let quadric = Quadric {
            coefficients: [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -4.0],
            centre: Vec3::X,
            half: Vec3::new(1.0, 2.0, 2.0),
        };
        let at = |origin, dir| crossings_in_f64(&ray(origin, dir), &quadric);
        assert_eq!(at([1.0, 5.0, 0.0], [0.0, -1.0, 0.0]), [3.0, 7.0]);
        assert!(at([-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]).is_empty());
        assert_eq!(at([1.0, 2.0, 5.0], [0.0, 0.0, -1.0]), [5.0]);
    }
}
