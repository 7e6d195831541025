//! Cylinders of finite length, open or capped.

use super::compact::Slots;
use super::extent::{disk_reach, rounded_outwards};
use super::lines::{disk_lines, side_lines};
use super::sample::part_by_area;
use super::{
    AddLine, Interior, LineDetail, Parameter, SampledPoint, Shape, ShapeInfo, SurfacePoint, U,
    in_disk, numbers_of,
};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{
    Piece, Pieces, Polynomial, RayIn, Ring, cross, difference, dot, squared_length, vector,
};
use crate::lane::{Lane, Values, greatest, least, minus, plus};
use crate::ray::{Hit, Ray};
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// The points at a radius from the segment between two points, and two disks if it is capped. No ray hits it if the
/// points are equal, the radius isn't positive, or a number isn't finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// The centre of one end.
    pub p0: Vec3,
    /// The centre of the other end.
    pub p1: Vec3,
    /// The radius.
    pub radius: f32,
    /// Whether disks close the ends.
    pub is_capped: bool,
}

/// The parts of a cylinder's and a cone's surface.
pub(crate) const SIDE: u8 = 0;
/// The disk about `p0`.
pub(crate) const BASE: u8 = 1;
/// The disk about `p1`.
pub(crate) const TOP: u8 = 2;

impl Cylinder {
    fn can_be_hit(&self) -> bool {
        let is_finite = self.p0.is_finite() && self.p1.is_finite() && self.radius.is_finite();
        is_finite && self.radius > 0.0 && self.p0 != self.p1
    }

    /// The areas of the side, the base and the top.
    fn areas(&self) -> [f64; 3] {
        let radius = f64::from(self.radius);
        let length = (self.p1.as_dvec3() - self.p0.as_dvec3()).length();
        let cap = if self.is_capped {
            PI * radius * radius
        } else {
            0.0
        };
        [TAU * radius * length, cap, cap]
    }
}

impl Shape for Cylinder {
    const INFO: ShapeInfo = ShapeInfo {
        name: "cylinder",
        plural: "cylinders",
        parameters: &[
            Parameter::point("p0", "p0"),
            Parameter::point("p1", "p1"),
            Parameter::number("radius", "r"),
            Parameter::flag("capped"),
        ],
        equations: &[
            "0 = |f × w|² − r²(w·w), where 0 ≤ f·w ≤ w·w, f = p − p0, w = p1 − p0",
            "0 = f·w, where |f × w|² ≤ r²(w·w), f = p − p0, w = p1 − p0",
            "0 = w·w − f·w, where |f × w|² ≤ r²(w·w), f = p − p0, w = p1 − p0",
        ],
    };
    type Compact = Slots<Self>;
    const NUMBERS: usize = 8;
    const MOST_CROSSINGS: usize = 4;

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

    /// The box around both ends.
    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let (p0, p1) = (numbers.three(0), numbers.three(3));
        let reach = disk_reach(minus(&p1, &p0), numbers.value(6));
        let (lower, upper) = (least(&p0, &p1), greatest(&p0, &p1));
        rounded_outwards(minus(&lower, &reach), plus(&upper, &reach))
    }

    fn bounds(&self) -> Aabb {
        if self.can_be_hit() {
            Aabb::from_planes(Self::planes(&numbers_of(self)))
        } else {
            Aabb::EMPTY
        }
    }

    /// u is the angle about the axis, from 0 to 1, and v the position along it; on a cap v is the distance from the axis
    /// in radii.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let radius = f64::from(self.radius);
        let along = Along::new(self.p0, self.p1, ray.at(hit.t));
        let (normal, position, v) = match part_of(hit) {
            SIDE => {
                let position = along.foot + radius * along.outwards;
                (along.outwards, position, along.part)
            }
            part => {
                let at_top = f64::from(u8::from(part == TOP));
                let normal = (2.0 * at_top - 1.0) * along.axis;
                let position = along.on_cap(at_top);
                (normal, position, along.distance / radius)
            }
        };
        SurfacePoint {
            position: position.as_vec3(),
            normal,
            uv: DVec2::new(along.turn, v),
            error: error(self.p0, self.p1, self.radius),
            is_flat: false,
        }
    }

    fn area(&self) -> f64 {
        self.areas().iter().sum()
    }

    fn sampled_point(&self, at: DVec2) -> Option<SampledPoint> {
        let (part, x) = part_by_area(&self.areas(), at.x)?;
        let (ends, radius) = (
            [self.p0, self.p1].map(Vec3::as_dvec3),
            f64::from(self.radius),
        );
        let axis = (ends[1] - ends[0]).normalize_or(DVec3::Z);
        let (across, along) = axis.any_orthonormal_pair();
        let part = [SIDE, BASE, TOP][part];
        let position = if part == SIDE {
            let (sin, cos) = libm::sincos(TAU * at.y);
            ends[0].lerp(ends[1], x) + radius * (cos * across + sin * along)
        } else {
            let on_cap = radius * in_disk(DVec2::new(x, at.y).as_vec2()).0.as_dvec2();
            ends[usize::from(part == TOP)] + on_cap.x * across + on_cap.y * along
        };
        Some(SampledPoint {
            position,
            u: part.into(),
            v: 0.0,
        })
    }

    fn interior(&self, _: &Ray) -> Interior {
        if self.is_capped {
            Interior::Convex
        } else {
            Interior::Open
        }
    }

    /// Circles and straight lines, also on the caps.
    fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        let ends = [self.p0, self.p1].map(Vec3::as_dvec3);
        let radius = f64::from(self.radius);
        side_lines(ends, [radius; 2], detail, add);
        if self.is_capped {
            let axis = (ends[1] - ends[0]).normalize_or(DVec3::Z);
            let (x, y) = axis.any_orthonormal_pair();
            for (end, normal) in ends.into_iter().zip([-axis, axis]) {
                disk_lines(end, [radius * x, radius * y], normal, detail, add);
            }
        }
    }
}

impl Pieces for Cylinder {
    fn centre(&self) -> Vec3 {
        0.5 * self.p0 + 0.5 * self.p1
    }

    /// With w = p1 − p0 and f = o + t·d − p0: |f×w|² = r²·w·w where 0 ≤ f·w ≤ w·w, and f·w = 0 or w·w where
    /// |f×w|² ≤ r²·w·w.
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.can_be_hit() {
            return;
        }
        let axial = AxialRay::new(self.p0, self.p1, ray);
        let r = R::from(self.radius);
        let reach = Polynomial::constant(r.square().times(&axial.length_squared));
        let beyond_end = Polynomial::constant(axial.length_squared.clone()).minus(&axial.along);
        emit(Piece {
            part: SIDE,
            surface: &axial.across_squared.minus(&reach),
            conditions: &[axial.along.clone(), beyond_end.clone()],
        });
        if self.is_capped {
            let inside = [reach.minus(&axial.across_squared)];
            for (part, surface) in [(BASE, &axial.along), (TOP, &beyond_end)] {
                emit(Piece {
                    part,
                    surface,
                    conditions: &inside,
                });
            }
        }
    }
}

/// A ray in the coordinates of an axis from a point p0 to a point p1: w = p1 − p0, f = o + t·d − p0.
pub(super) struct AxialRay<R> {
    /// f·w.
    pub along: Polynomial<R>,
    /// |f×w|².
    pub across_squared: Polynomial<R>,
    /// w·w.
    pub length_squared: R,
}

impl<R: Ring> AxialRay<R> {
    pub fn new(p0: Vec3, p1: Vec3, ray: &RayIn<R>) -> Self {
        let origin = vector::<R>(p0);
        let w = difference(&vector::<R>(p1), &origin);
        let f = difference(&ray.origin, &origin);
        let (from, step) = (cross(&f, &w), cross(&ray.dir, &w));
        Self {
            along: Polynomial::new([dot(&f, &w), dot(&ray.dir, &w)]),
            across_squared: Polynomial::new([
                squared_length(&from),
                dot(&from, &step).doubled(),
                squared_length(&step),
            ]),
            length_squared: squared_length(&w),
        }
    }
}

/// A point in the coordinates of an axis.
pub(super) struct Along {
    /// Unit vector along the axis.
    pub axis: DVec3,
    /// Unit vector from the axis to the point.
    pub outwards: DVec3,
    /// The nearest point of the axis.
    pub foot: DVec3,
    /// Where that is: 0 at p0, 1 at p1.
    pub part: f64,
    /// The distance from the axis.
    pub distance: f64,
    /// The angle about the axis, from 0 to 1.
    pub turn: f64,
    p0: DVec3,
    length: f64,
}

impl Along {
    pub fn new(p0: Vec3, p1: Vec3, p: DVec3) -> Self {
        let [p0, p1] = [p0, p1].map(Vec3::as_dvec3);
        let length = (p1 - p0).length();
        let axis = (p1 - p0) / length;
        let part = (p - p0).dot(axis) / length;
        let foot = p0 + part * (p1 - p0);
        let side = p - foot;
        let (x, y) = axis.any_orthonormal_pair();
        let turn = side.dot(y).atan2(side.dot(x)) / TAU;
        Self {
            axis,
            outwards: side.normalize_or(x),
            foot,
            part,
            distance: side.length(),
            turn: turn.rem_euclid(1.0),
            p0,
            length,
        }
    }

    /// The point moved along the axis to p0 (0) or p1 (1).
    pub fn on_cap(&self, at: f64) -> DVec3 {
        self.p0 + at * self.length * self.axis + self.distance * self.outwards
    }
}

/// The part that a hit is on.
pub(super) fn part_of(hit: &Hit) -> u8 {
    hit.u as u8
}

/// The error of a point of a cylinder or a cone: the point is rounded, and the next test sees the surface to some
/// roundings of its size.
pub(super) fn error(p0: Vec3, p1: Vec3, radius: f32) -> Vec3 {
    let size = (p1 - p0).length() + radius;
    let reach = p0.abs().max(p1.abs()) + Vec3::splat(radius);
    2.0 * U * reach + Vec3::splat(16.0 * U * size)
}
