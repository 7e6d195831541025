//! Tori.

use super::compact::Slots;
use super::extent::{above, disk_reach, rounded_outwards};
use super::{
    AddLine, Interior, LineDetail, Parameter, Shape, ShapeInfo, SurfacePoint, U, numbers_of,
};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{
    Piece, Pieces, Polynomial, RayIn, Ring, difference, dot, squared_length, vector,
};
use crate::lane::{Lane, Values, minus, plus};
use crate::ray::{Hit, Ray};
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::TAU;

/// The points at the minor radius from a circle with the major radius. No ray hits it if a radius isn't positive, the
/// axis is 0, or a number isn't finite. If the minor radius is larger, the surface meets itself: normals point away from
/// the circle, on its inner sheet too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// The centre.
    pub centre: Vec3,
    /// The axis of the circle, of any length.
    pub axis: Vec3,
    /// The radius of the circle.
    pub major: f32,
    /// The radius of the tube.
    pub minor: f32,
}

impl Torus {
    fn can_be_hit(&self) -> bool {
        let is_finite = self.centre.is_finite() && self.axis.is_finite();
        let has_axis = is_finite && self.axis != Vec3::ZERO;
        let is_radius = |r: f32| r > 0.0 && r.is_finite();
        has_axis && is_radius(self.major) && is_radius(self.minor)
    }
}

impl Torus {
    /// Bounds the rounding of a point at this distance from the axis, and the distance at which the next test in f32
    /// sees the surface.
    ///
    /// With ρ = R + r and the distance q from the axis, the quartic is a difference of (p·p + R² − r²)² = 4R²q² and
    /// 4R²·|p×w|². From the point of the ray nearest to the centre, the terms of the first are positive and those of the
    /// second add up to 8R²ρ² at most. The kernel's sums and products and Horner's rule round either some 24 times, so
    /// the quartic errs by 24u·(4R²q² + 8R²ρ²). Its gradient at the surface is 8R·q·r long. That point's own rounding
    /// moves the ray by 4u·ρ. The bound ends at r/8, as a ray has to start near the tube: tubes thinner than about
    /// R/300 are beyond that kernel.
    fn error(&self, from_axis: f32) -> Vec3 {
        let (major, minor) = (self.major, self.minor);
        let reach = major + minor;
        let quartic = 12.0 * from_axis + 24.0 * reach * (reach / from_axis.abs());
        let seen = U * (4.0 * reach + quartic * (major / minor));
        // NaN and infinities, where the surface meets itself, become r/8.
        let seen = seen.min(0.125 * minor);
        2.0 * U * (self.centre.abs() + Vec3::splat(reach)) + Vec3::splat(seen)
    }
}

impl Shape for Torus {
    const INFO: ShapeInfo = ShapeInfo {
        name: "torus",
        plural: "tori",
        parameters: &[
            Parameter::point("centre", "c"),
            Parameter::vector("axis", "w"),
            Parameter::number("major", "R"),
            Parameter::number("minor", "r"),
        ],
        equations: &["0 = (q·q + R² − r²)²(w·w) − 4R²|q × w|², where q = p − c"],
    };
    type Compact = Slots<Self>;
    const NUMBERS: usize = 8;
    const MOST_CROSSINGS: usize = 4;

    fn nowhere() -> Self {
        Self {
            centre: Vec3::NAN,
            axis: Vec3::NAN,
            major: f32::NAN,
            minor: f32::NAN,
        }
    }

    fn write(&self, numbers: &mut [f32]) {
        numbers[..3].copy_from_slice(&self.centre.to_array());
        numbers[3..6].copy_from_slice(&self.axis.to_array());
        numbers[6..].copy_from_slice(&[self.major, self.minor]);
    }

    #[inline(always)]
    fn read(numbers: &impl Values<f32>) -> Self {
        Self {
            centre: Vec3::from_array(numbers.three(0)),
            axis: Vec3::from_array(numbers.three(3)),
            major: numbers.value(6),
            minor: numbers.value(7),
        }
    }

    /// The box around the circle, extended by the minor radius on all sides.
    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let (centre, minor) = (numbers.three(0), numbers.value(7));
        let [x, y, z] = disk_reach(numbers.three(3), numbers.value(6));
        let reach = [above(x + minor), above(y + minor), above(z + minor)];
        rounded_outwards(minus(&centre, &reach), plus(&centre, &reach))
    }

    fn bounds(&self) -> Aabb {
        if self.can_be_hit() {
            Aabb::from_planes(Self::planes(&numbers_of(self)))
        } else {
            Aabb::EMPTY
        }
    }

    /// u is the angle about the axis and v that about the tube, from 0 to 1.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let (centre, axis) = (
            self.centre.as_dvec3(),
            self.axis.as_dvec3().normalize_or(DVec3::Z),
        );
        let [major, minor] = [self.major, self.minor].map(f64::from);
        let p = ray.at(hit.t) - centre;
        let height = p.dot(axis);
        let side = p - height * axis;
        let (x, y) = axis.any_orthonormal_pair();
        // Of the circles about which the tube's cut is drawn, the one on whose rim the point lies. It is the one on this
        // side of the axis, but for the inner sheet of a surface that meets itself.
        let this_side = side.normalize_or(x);
        let off_rim = |towards: DVec3| ((p - major * towards).length() - minor).abs();
        let outwards = if minor > major && off_rim(-this_side) < off_rim(this_side) {
            -this_side
        } else {
            this_side
        };
        let in_tube = p - major * outwards;
        let normal = in_tube.normalize_or(outwards);
        let turn = |sin: f64, cos: f64| (sin.atan2(cos) / TAU).rem_euclid(1.0);
        let from_axis = major + minor * normal.dot(outwards);
        SurfacePoint {
            position: (centre + major * outwards + minor * normal).as_vec3(),
            normal,
            uv: DVec2::new(
                turn(outwards.dot(y), outwards.dot(x)),
                turn(height, in_tube.dot(outwards)),
            ),
            error: self.error(from_axis as f32),
            is_flat: false,
        }
    }

    fn interior(&self, _: &Ray) -> Interior {
        Interior::Bounded
    }

    /// Circles about the axis and about the tube.
    fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        const ABOUT_AXIS: u32 = 8;
        const ABOUT_TUBE: u32 = 24;
        let axis = self.axis.as_dvec3().normalize_or(DVec3::Z);
        let (x, y) = axis.any_orthonormal_pair();
        let centre = self.centre.as_dvec3();
        let [major, minor] = [self.major, self.minor].map(f64::from);
        let angle = |k: u32, count: u32| TAU * f64::from(k) / f64::from(count);
        for k in 0..ABOUT_AXIS {
            let (sin, cos) = angle(k, ABOUT_AXIS).sin_cos();
            let radius = major + minor * cos;
            let on = centre + minor * sin * axis;
            detail.circle(on, [radius * x, radius * y], add, |outwards| {
                // The radius is negative inside a tube that meets the axis.
                radius.signum() * cos * outwards + sin * axis
            });
        }
        for k in 0..ABOUT_TUBE {
            let (sin, cos) = angle(k, ABOUT_TUBE).sin_cos();
            let outwards = cos * x + sin * y;
            let on = centre + major * outwards;
            detail.circle(on, [minor * outwards, minor * axis], add, |normal| normal);
        }
    }
}

impl Pieces for Torus {
    fn centre(&self) -> Vec3 {
        self.centre
    }

    /// With p = o + t·d − c, the axis w, and w·w·p·p − (p·w)² = |p×w|²: (p·p + R² − r²)²·w·w = 4R²·|p×w|².
    ///
    /// Source: Hanrahan, "A Survey of Ray-Surface Intersection Algorithms", in Glassner (ed.), An Introduction to Ray
    /// Tracing, 1989.
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.can_be_hit() {
            return;
        }
        let f = difference(&ray.origin, &vector(self.centre));
        let axis = vector::<R>(self.axis);
        let axis_squared = squared_length(&axis);
        let [major, minor] = [self.major, self.minor].map(|r| R::from(r).square());
        let squared = Polynomial::new([
            squared_length(&f),
            dot(&f, &ray.dir).doubled(),
            squared_length(&ray.dir),
        ]);
        let along = Polynomial::new([dot(&f, &axis), dot(&ray.dir, &axis)]);
        let across = squared.scaled(&axis_squared).minus(&along.times(&along));
        let ball = squared.plus(&Polynomial::constant(major.minus(&minor)));
        let four_major = major.doubled().doubled();
        let surface = ball
            .times(&ball)
            .scaled(&axis_squared)
            .minus(&across.scaled(&four_major));
        emit(Piece {
            part: 0,
            surface: &surface,
            conditions: &[],
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sheets_of_a_torus_that_meets_itself_have_their_own_position_and_normal() {
        let torus = Torus {
            centre: Vec3::ZERO,
            axis: Vec3::Z,
            major: 0.6,
            minor: 1.0,
        };
        let ray = Ray::new(Vec3::new(0.2, 0.0, 3.0), Vec3::NEG_Z).expect("a ray");
        // The circles about (±0.6, 0), at x = 0.2.
        for (side, height) in [
            (1.0, f64::sqrt(1.0 - 0.16)),
            (-1.0, 0.6),
            (-1.0, -0.6),
            (1.0, -f64::sqrt(1.0 - 0.16)),
        ] {
            let hit = Hit {
                t: (3.0 - height) as f32,
                u: 0.0,
                v: 0.0,
                primitive: 0,
            };
            let found = torus.surface(&ray, &hit);
            let expected = DVec3::new(0.2, 0.0, height);
            let normal = expected - DVec3::new(0.6 * side, 0.0, 0.0);
            // t is a multiple of 2⁻²².
            let tolerance = 1e-6;
            assert!(
                (found.position.as_dvec3() - expected).length() < tolerance,
                "{found:?}"
            );
            assert!((found.normal - normal).length() < tolerance, "{found:?}");
        }
    }
}
