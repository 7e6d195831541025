//! Spheres.

use super::compact::Slots;
use super::extent::rounded_outwards;
use super::subtended::SubtendedCone;
use super::{
    AddLine, Interior, LineDetail, Parameter, SampledPoint, Shape, ShapeInfo, SurfacePoint,
    numbers_of, on_sphere, sphere_filter,
};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{
    Piece, Pieces, Polynomial, QuickLine, RayIn, Ring, RootIntervals, difference, dot,
    squared_length, vector,
};
use crate::lane::{Lane, Values, minus, plus};
use crate::ray::{Hit, Ray};
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::PI;

/// A sphere by its centre and radius. No ray hits it if the radius isn't positive or a number isn't finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// The centre.
    pub centre: Vec3,
    /// The radius.
    pub radius: f32,
}

impl Sphere {
    /// The point is rounded to half an ulp of |c| + r, at most u·(|c| + r). With f = o − c, which is exact or errs
    /// by u·|f|, the next test in f32 computes f·f − r² to some 8u·r², which a height of 4u·r outweighs.
    fn error(&self) -> Vec3 {
        let reach = self.centre.abs() + Vec3::splat(self.radius);
        f32::EPSILON * (reach + Vec3::splat(4.0 * self.radius))
    }

    /// The cone of directions from a point outside. A point of the sphere itself counts as inside, wherever it is rounded.
    fn cone(&self, from: Vec3) -> Option<SubtendedCone> {
        let way = self.centre.as_dvec3() - from.as_dvec3();
        let slack = self.error().as_dvec3().length();
        SubtendedCone::new(way, self.radius.into(), slack)
    }

    fn can_be_hit(&self) -> bool {
        self.radius > 0.0 && self.radius.is_finite() && self.centre.is_finite()
    }
}

impl Shape for Sphere {
    const INFO: ShapeInfo = ShapeInfo {
        name: "sphere",
        plural: "spheres",
        parameters: &[
            Parameter::point("centre", "c"),
            Parameter::number("radius", "r"),
        ],
        equations: &["0 = (p − c)·(p − c) − r²"],
    };
    type Compact = Slots<Self>;
    const NUMBERS: usize = 4;
    const MOST_CROSSINGS: usize = 2;

    fn nowhere() -> Self {
        Self {
            centre: Vec3::NAN,
            radius: f32::NAN,
        }
    }

    fn write(&self, numbers: &mut [f32]) {
        let Vec3 { x, y, z } = self.centre;
        numbers.copy_from_slice(&[x, y, z, self.radius]);
    }

    #[inline(always)]
    fn read(numbers: &impl Values<f32>) -> Self {
        Self {
            centre: Vec3::from_array(numbers.three(0)),
            radius: numbers.value(3),
        }
    }

    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let (centre, reach) = (numbers.three(0), [numbers.value(3); 3]);
        rounded_outwards(minus(&centre, &reach), plus(&centre, &reach))
    }

    #[inline(always)]
    fn may_meet<L: Lane>(line: [&[L; 3]; 2], numbers: &impl Values<L>) -> Option<L::Mask> {
        Some(sphere_filter::may_meet(
            line,
            &numbers.three(0),
            numbers.value(3),
        ))
    }

    fn bounds(&self) -> Aabb {
        if self.can_be_hit() {
            Aabb::from_planes(Self::planes(&numbers_of(self)))
        } else {
            Aabb::EMPTY
        }
    }

    /// u is the angle about the z axis and v the angle from it, from 0 to 1, as Mitsuba has them.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let centre = self.centre.as_dvec3();
        let p = ray.at(hit.t) - centre;
        let normal = p.try_normalize().unwrap_or(DVec3::Z);
        let angle = normal.y.atan2(normal.x) / std::f64::consts::TAU;
        SurfacePoint {
            position: (centre + f64::from(self.radius) * normal).as_vec3(),
            normal,
            uv: DVec2::new(angle.rem_euclid(1.0), normal.z.clamp(-1.0, 1.0).acos() / PI),
            error: self.error(),
            is_flat: false,
        }
    }

    fn area(&self) -> f64 {
        4.0 * PI * f64::from(self.radius).powi(2)
    }

    fn sampled_point(&self, at: DVec2) -> Option<SampledPoint> {
        let on_unit = on_sphere(at);
        Some(SampledPoint {
            position: self.centre.as_dvec3() + f64::from(self.radius) * on_unit,
            u: 0.0,
            v: 0.0,
        })
    }

    fn sampled_from(&self, from: Vec3, at: DVec2) -> Option<SampledPoint> {
        let Some(cone) = self.cone(from) else {
            return self.sampled_point(at);
        };
        Some(SampledPoint {
            position: self.centre.as_dvec3() + f64::from(self.radius) * cone.normal(at),
            u: 0.0,
            v: 0.0,
        })
    }

    fn density_from(&self, from: Vec3) -> Option<f64> {
        self.cone(from).map(|cone| cone.density())
    }

    fn interior(&self, _: &Ray) -> Interior {
        Interior::Convex
    }

    /// Meridians and parallels about the z axis.
    fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        const MERIDIANS: u32 = 6;
        const PARALLELS: [f64; 5] = [-60.0, -30.0, 0.0, 30.0, 60.0];
        let (centre, radius) = (self.centre.as_dvec3(), f64::from(self.radius));
        for k in 0..MERIDIANS {
            let (sin, cos) = (PI * f64::from(k) / f64::from(MERIDIANS)).sin_cos();
            let side = DVec3::new(cos, sin, 0.0);
            let axes = [radius * side, radius * DVec3::Z];
            detail.circle(centre, axes, add, |outwards| outwards);
        }
        for latitude in PARALLELS {
            let (sin, cos) = latitude.to_radians().sin_cos();
            let axes = [radius * cos * DVec3::X, radius * cos * DVec3::Y];
            let height = radius * sin * DVec3::Z;
            detail.circle(centre + height, axes, add, |outwards| {
                cos * outwards + sin * DVec3::Z
            });
        }
    }
}

impl Pieces for Sphere {
    fn centre(&self) -> Vec3 {
        self.centre
    }

    #[inline(always)]
    fn quick_roots(&self, line: &QuickLine) -> Option<RootIntervals> {
        line.at_distance(self.centre, self.radius)
    }

    /// |o + t·d − c|² − r².
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.can_be_hit() {
            return;
        }
        let f = difference(&ray.origin, &vector(self.centre));
        let r = R::from(self.radius);
        emit(Piece {
            part: 0,
            surface: &Polynomial::new([
                squared_length(&f) - r.square(),
                dot(&f, &ray.dir).doubled(),
                squared_length(&ray.dir),
            ]),
            conditions: &[],
        });
    }
}
