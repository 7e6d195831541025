//! Cones of finite height, open or capped.

use super::compact::Slots;
use super::cylinder::{Along, AxialRay, BASE, SIDE, error, part_of};
use super::extent::{disk_reach, rounded_outwards};
use super::lines::{disk_lines, side_lines};
use super::{AddLine, Interior, LineDetail, Parameter, Shape, ShapeInfo, SurfacePoint, numbers_of};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{Piece, Pieces, Polynomial, RayIn, Ring};
use crate::lane::{Lane, Values, greatest, least, minus, plus};
use crate::ray::{Hit, Ray};
use glam::{DVec2, DVec3, Vec3};

/// The lines from an apex to a circle about the axis, and a disk in the circle if it is capped. No ray hits it if the
/// circle's centre is the apex, the radius isn't positive, or a number isn't finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The centre of the base.
    pub p0: Vec3,
    /// The apex.
    pub p1: Vec3,
    /// The radius of the base.
    pub radius: f32,
    /// Whether a disk closes the base.
    pub is_capped: bool,
}

impl Cone {
    fn can_be_hit(&self) -> bool {
        let is_finite = self.p0.is_finite() && self.p1.is_finite() && self.radius.is_finite();
        is_finite && self.radius > 0.0 && self.p0 != self.p1
    }
}

impl Shape for Cone {
    const INFO: ShapeInfo = ShapeInfo {
        name: "cone",
        plural: "cones",
        parameters: &[
            Parameter::point("p0", "p0"),
            Parameter::point("p1", "p1"),
            Parameter::number("radius", "r"),
            Parameter::flag("capped"),
        ],
        equations: &[
            "0 = |f × w|²(w·w) − r²(f·w)², where 0 ≤ f·w ≤ w·w, f = p − p1, w = p0 − p1",
            "0 = w·w − f·w, where |f × w|² ≤ r²(w·w), f = p − p1, w = p0 − p1",
        ],
    };
    type Compact = Slots<Self>;
    const NUMBERS: usize = 8;
    const MOST_CROSSINGS: usize = 3;

    fn nowhere() -> Self {
        Self {
            p0: Vec3::NAN,
            p1: Vec3::NAN,
            radius: f32::NAN,
            is_capped: false,
        }
    }

    fn write(&self, numbers: &mut [f32]) {
        numbers[..3].copy_from_slice(&self.p0.to_array());
        numbers[3..6].copy_from_slice(&self.p1.to_array());
        numbers[6] = self.radius;
        numbers[7] = f32::from(u8::from(self.is_capped));
    }

    #[inline(always)]
    fn read(numbers: &impl Values<f32>) -> Self {
        Self {
            p0: Vec3::from_array(numbers.three(0)),
            p1: Vec3::from_array(numbers.three(3)),
            radius: numbers.value(6),
            is_capped: numbers.value(7) == 1.0,
        }
    }

    /// The box around the base and the apex.
    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let (base, apex) = (numbers.three(0), numbers.three(3));
        let reach = disk_reach(minus(&apex, &base), numbers.value(6));
        rounded_outwards(
            least(&minus(&base, &reach), &apex),
            greatest(&plus(&base, &reach), &apex),
        )
    }

    fn bounds(&self) -> Aabb {
        if self.can_be_hit() {
            Aabb::from_planes(Self::planes(&numbers_of(self)))
        } else {
            Aabb::EMPTY
        }
    }

    /// u is the angle about the axis, from 0 to 1, and v the position along it; on the cap v is the distance from the
    /// axis in radii.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let (radius, along) = (
            f64::from(self.radius),
            Along::new(self.p0, self.p1, ray.at(hit.t)),
        );
        let height = f64::from((self.p1 - self.p0).length());
        let (normal, position, v) = if part_of(hit) == SIDE {
            let slope = height * along.outwards + radius * along.axis;
            let at = (1.0 - along.part) * radius;
            let position = along.foot + at * along.outwards;
            (slope.normalize_or(along.axis), position, along.part)
        } else {
            (-along.axis, along.on_cap(0.0), along.distance / radius)
        };
        SurfacePoint {
            position: position.as_vec3(),
            normal,
            uv: DVec2::new(along.turn, v),
            error: error(self.p0, self.p1, self.radius),
            is_flat: false,
        }
    }

    fn interior(&self, _: &Ray) -> Interior {
        if self.is_capped {
            Interior::Convex
        } else {
            Interior::Open
        }
    }

    /// Circles and straight lines, also on the base.
    fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        let ends = [self.p0, self.p1].map(Vec3::as_dvec3);
        let radius = f64::from(self.radius);
        side_lines(ends, [radius, 0.0], detail, add);
        if self.is_capped {
            let axis = (ends[1] - ends[0]).normalize_or(DVec3::Z);
            let (x, y) = axis.any_orthonormal_pair();
            disk_lines(ends[0], [radius * x, radius * y], -axis, detail, add);
        }
    }
}

impl Pieces for Cone {
    fn centre(&self) -> Vec3 {
        0.5 * self.p0 + 0.5 * self.p1
    }

    /// From the apex, with w = p0 − p1 and f = o + t·d − p1: |f×w|²·w·w = r²·(f·w)² where 0 ≤ f·w ≤ w·w; on the base
    /// f·w = w·w where |f×w|² ≤ r²·w·w.
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.can_be_hit() {
            return;
        }
        let axial = AxialRay::new(self.p1, self.p0, ray);
        let r_squared = R::from(self.radius).square();
        let beyond_base = Polynomial::constant(axial.length_squared.clone()).minus(&axial.along);
        let lines = axial.across_squared.scaled(&axial.length_squared);
        emit(Piece {
            part: SIDE,
            surface: &lines.minus(&axial.along.times(&axial.along).scaled(&r_squared)),
            conditions: &[axial.along.clone(), beyond_base.clone()],
        });
        if self.is_capped {
            let reach = Polynomial::constant(r_squared.times(&axial.length_squared));
            emit(Piece {
                part: BASE,
                surface: &beyond_base,
                conditions: &[reach.minus(&axial.across_squared)],
            });
        }
    }
}
