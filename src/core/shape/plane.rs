//! Infinite planes.

use super::compact::Slots;
use super::interior::negative_side;
use super::lines::plane_grid;
use super::{AddLine, Interior, LineDetail, Parameter, Shape, ShapeInfo, SurfacePoint, U};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{Piece, Pieces, Polynomial, RayIn, Ring, difference, dot, vector};
use crate::lane::{Lane, Values};
use crate::ray::{Hit, Ray};
use glam::{DVec2, DVec3, Vec3};

/// The plane through a point that is perpendicular to a normal. No ray hits it if the normal is 0 or a number isn't
/// finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of the plane.
    pub point: Vec3,
    /// The normal, of any length.
    pub normal: Vec3,
}

impl Plane {
    fn can_be_hit(&self) -> bool {
        self.point.is_finite() && self.normal.is_finite() && self.normal != Vec3::ZERO
    }
}

impl Shape for Plane {
    const INFO: ShapeInfo = ShapeInfo {
        name: "plane",
        plural: "planes",
        parameters: &[
            Parameter::point("point", "a"),
            Parameter::vector("normal", "n"),
        ],
        equations: &["0 = (p − a)·n"],
    };
    type Compact = Slots<Self>;
    const NUMBERS: usize = 6;
    const MOST_CROSSINGS: usize = 1;
    const IS_BOUNDED: bool = false;

    fn nowhere() -> Self {
        Self {
            point: Vec3::NAN,
            normal: Vec3::NAN,
        }
    }

    fn write(&self, numbers: &mut [f32]) {
        numbers[..3].copy_from_slice(&self.point.to_array());
        numbers[3..].copy_from_slice(&self.normal.to_array());
    }

    #[inline(always)]
    fn read(numbers: &impl Values<f32>) -> Self {
        Self {
            point: Vec3::from_array(numbers.three(0)),
            normal: Vec3::from_array(numbers.three(3)),
        }
    }

    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let infinity = L::of(numbers.value(0).token(), f32::INFINITY);
        [
            -infinity, infinity, -infinity, infinity, -infinity, infinity,
        ]
    }

    fn bounds(&self) -> Aabb {
        Aabb::EMPTY
    }

    /// u and v are coordinates along two perpendicular unit vectors in the plane, from its point.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let normal = self.normal.as_dvec3().normalize_or_zero();
        let position = ray.at(hit.t);
        let from_point = position - self.point.as_dvec3();
        // Onto the plane, as t is rounded.
        let position = position - from_point.dot(normal) * normal;
        let (u, v) = normal.any_orthonormal_pair();
        let position = position.as_vec3();
        SurfacePoint {
            position,
            normal,
            uv: DVec2::new(from_point.dot(u), from_point.dot(v)),
            error: 2.0 * U * (position.abs() + self.point.abs()),
            is_flat: true,
        }
    }

    /// The half-space behind the normal.
    fn interior(&self, ray: &Ray) -> Interior {
        negative_side(self, ray)
    }

    /// A grid near the region of interest.
    fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        let normal = self.normal.as_dvec3().normalize_or(DVec3::Z);
        plane_grid(self.point.as_dvec3(), normal, detail, add);
    }
}

impl Pieces for Plane {
    fn centre(&self) -> Vec3 {
        self.point
    }

    /// n·(o + t·d − p).
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.can_be_hit() {
            return;
        }
        let normal = vector(self.normal);
        let f = difference(&ray.origin, &vector(self.point));
        emit(Piece {
            part: 0,
            surface: &Polynomial::new([dot(&normal, &f), dot(&normal, &ray.dir)]),
            conditions: &[],
        });
    }
}
