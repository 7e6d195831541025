//! General quadrics, cut by a box.

use super::compact::Slots;
use super::extent::rounded_outwards;
use super::interior::negative_side;
use super::quadric_lines::quadric_lines;
use super::{
    AddLine, Interior, LineDetail, Parameter, Shape, ShapeInfo, SurfacePoint, U, numbers_of,
};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{Piece, Pieces, Polynomial, RayIn, Ring};
use crate::lane::{Lane, Values, minus, plus};
use crate::ray::{Hit, Ray};
use glam::{DVec2, DVec3, Vec3};

/// The part inside a box of the surface ax² + by² + cz² + 2dxy + 2eyz + 2fxz + 2gx + 2hy + 2iz + j = 0, where x, y and z
/// are relative to the box's centre. No ray hits it if the box has no size or a number isn't finite.
///
/// Source of the notation: Goldstein, Nagel, "3-D Visual Simulation", Simulation 16(1), 1971.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric {
    /// The coefficients a to j.
    pub coefficients: [f32; 10],
    /// The centre of the box, from which x, y and z are measured.
    pub centre: Vec3,
    /// Half the box's edges.
    pub half: Vec3,
}

impl Quadric {
    fn can_be_hit(&self) -> bool {
        let is_finite = self.coefficients.iter().all(|x| x.is_finite());
        is_finite
            && self.centre.is_finite()
            && self.half.is_finite()
            && self.half.max_element() > 0.0
    }

    /// The left side at a point relative to the centre.
    pub(super) fn value(&self, p: DVec3) -> f64 {
        let [.., g, h, i, j] = self.coefficients.map(f64::from);
        p.dot(self.gradient(p)) + p.dot(DVec3::new(g, h, i)) + j
    }

    /// The gradient of the left side at a point relative to the centre, halved.
    pub(super) fn gradient(&self, p: DVec3) -> DVec3 {
        let [a, b, c, d, e, f, g, h, i, _] = self.coefficients.map(f64::from);
        DVec3::new(
            a * p.x + d * p.y + f * p.z + g,
            d * p.x + b * p.y + e * p.z + h,
            f * p.x + e * p.y + c * p.z + i,
        )
    }
}

impl Shape for Quadric {
    const INFO: ShapeInfo = ShapeInfo {
        name: "quadric",
        plural: "quadrics",
        parameters: &[
            Parameter::number("a", "a"),
            Parameter::number("b", "b"),
            Parameter::number("c", "c"),
            Parameter::number("d", "d"),
            Parameter::number("e", "e"),
            Parameter::number("f", "f"),
            Parameter::number("g", "g"),
            Parameter::number("h", "h"),
            Parameter::number("i", "i"),
            Parameter::number("j", "j"),
            Parameter::point("centre", "m"),
            Parameter::vector("half_size", "s"),
        ],
        equations: &[
            "0 = ax² + by² + cz² + 2dxy + 2eyz + 2fxz + 2gx + 2hy + 2iz + j, where (x, y, z) = p − m is in the box ±s",
        ],
    };
    type Compact = Slots<Self>;
    const NUMBERS: usize = 16;
    const MOST_CROSSINGS: usize = 2;

    fn nowhere() -> Self {
        Self {
            coefficients: [f32::NAN; 10],
            centre: Vec3::NAN,
            half: Vec3::NAN,
        }
    }

    fn write(&self, numbers: &mut [f32]) {
        numbers[..10].copy_from_slice(&self.coefficients);
        numbers[10..13].copy_from_slice(&self.centre.to_array());
        numbers[13..].copy_from_slice(&self.half.to_array());
    }

    #[inline(always)]
    fn read(numbers: &impl Values<f32>) -> Self {
        Self {
            coefficients: std::array::from_fn(|k| numbers.value(k)),
            centre: Vec3::from_array(numbers.three(10)),
            half: Vec3::from_array(numbers.three(13)),
        }
    }

    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let (centre, half) = (numbers.three(10), numbers.three(13));
        rounded_outwards(minus(&centre, &half), plus(&centre, &half))
    }

    fn bounds(&self) -> Aabb {
        if self.can_be_hit() {
            Aabb::from_planes(Self::planes(&numbers_of(self)))
        } else {
            Aabb::EMPTY
        }
    }

    /// u and v are the coordinates in the box along the two axes that are most nearly tangential, from −1 to 1.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let p = ray.at(hit.t) - self.centre.as_dvec3();
        let normal = self.gradient(p).normalize_or(DVec3::Z);
        let in_box = p / self.half.as_dvec3();
        let size = normal.abs();
        let uv = if size.z >= size.x && size.z >= size.y {
            DVec2::new(in_box.x, in_box.y)
        } else if size.y >= size.x {
            DVec2::new(in_box.z, in_box.x)
        } else {
            DVec2::new(in_box.y, in_box.z)
        };
        let reach = self.centre.abs() + self.half;
        SurfacePoint {
            position: (self.centre.as_dvec3() + p).as_vec3(),
            normal,
            uv,
            error: 2.0 * U * reach + Vec3::splat(32.0 * U * self.half.max_element()),
            is_flat: false,
        }
    }

    /// The points inside the surface without its box: those where the left side is negative.
    fn interior(&self, ray: &Ray) -> Interior {
        negative_side(self, ray)
    }

    /// Curves in planes across each axis.
    fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        quadric_lines(self, detail, add);
    }
}

impl Pieces for Quadric {
    fn centre(&self) -> Vec3 {
        self.centre
    }

    /// The equation, and half ± x, half ± y, half ± z.
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.can_be_hit() {
            return;
        }
        let line = |axis: usize| {
            let from = ray.origin[axis].minus(&R::from(self.centre[axis]));
            Polynomial::new([from, ray.dir[axis].clone()])
        };
        let [x, y, z] = [line(0), line(1), line(2)];
        let [a, b, c, d, e, f, g, h, i, j] = self.coefficients.map(R::from);
        let product = |k: R, p: &Polynomial<R>, q: &Polynomial<R>| p.times(q).scaled(&k);
        let surface = product(a, &x, &x)
            .plus(&product(b, &y, &y))
            .plus(&product(c, &z, &z))
            .plus(&product(d.doubled(), &x, &y))
            .plus(&product(e.doubled(), &y, &z))
            .plus(&product(f.doubled(), &x, &z))
            .plus(&x.scaled(&g.doubled()))
            .plus(&y.scaled(&h.doubled()))
            .plus(&z.scaled(&i.doubled()))
            .plus(&Polynomial::constant(j));
        let half = |axis: usize| Polynomial::constant(R::from(self.half[axis]));
        emit(Piece {
            part: 0,
            surface: &surface,
            conditions: &[
                half(0).minus(&x),
                half(0).plus(&x),
                half(1).minus(&y),
                half(1).plus(&y),
                half(2).minus(&z),
                half(2).plus(&z),
            ],
        });
    }
}
