//! A centre and two half axes: what disks and rectangles have in common.

use super::flat_patch::Outline;
use super::{FlatPatch, Parameter, SampledPoint, SurfacePoint};
use crate::algebra::{
    Polynomial, QuickLine, QuickSpan, RayIn, Ring, cross, difference, dot, vector,
};
use crate::lane::Values;
use crate::ray::{Hit, Ray};
use glam::{DVec2, Vec3};

/// The plane of the points c + a·u + b·v, with a and b as its coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The centre c.
    pub centre: Vec3,
    /// The first half axis.
    pub u: Vec3,
    /// The second half axis, not parallel to the first.
    pub v: Vec3,
}

impl Span {
    /// The number of its parameters.
    pub(super) const NUMBERS: usize = 9;
    /// Their names.
    pub(super) const PARAMETERS: &'static [Parameter] = &[
        Parameter::point("centre", "c"),
        Parameter::vector("axis_u", "u"),
        Parameter::vector("axis_v", "v"),
    ];
    /// No plane.
    pub(super) const NOWHERE: Self = Self {
        centre: Vec3::NAN,
        u: Vec3::NAN,
        v: Vec3::NAN,
    };

    /// Whether all numbers are finite. If the half axes are parallel, the exact kernel finds no crossing.
    pub(super) fn is_finite(&self) -> bool {
        self.centre.is_finite() && self.u.is_finite() && self.v.is_finite()
    }

    pub(super) fn write(&self, numbers: &mut [f32]) {
        for (vector, kept) in [self.centre, self.u, self.v]
            .iter()
            .zip(numbers.chunks_exact_mut(3))
        {
            kept.copy_from_slice(&vector.to_array());
        }
    }

    #[inline(always)]
    pub(super) fn read(numbers: &impl Values<f32>) -> Self {
        let [centre, u, v] =
            [numbers.three(0), numbers.three(3), numbers.three(6)].map(Vec3::from_array);
        Self { centre, u, v }
    }

    /// The area of the parallelogram c ± u ± v.
    pub(super) fn area(&self) -> f64 {
        4.0 * self.u.as_dvec3().cross(self.v.as_dvec3()).length()
    }

    /// The point with coordinates a and b.
    pub(super) fn at(&self, at: DVec2) -> SampledPoint {
        let [centre, u, v] = [self.centre, self.u, self.v].map(Vec3::as_dvec3);
        SampledPoint {
            position: centre + at.x * u + at.y * v,
            u: at.x as f32,
            v: at.y as f32,
        }
    }

    /// The crossing of a line with the plane; `None` if it isn't certain that there is one.
    #[inline(always)]
    pub(super) fn crossed_by(&self, line: &QuickLine) -> Option<QuickSpan> {
        line.in_plane(self.centre, [self.u, self.v])
    }

    /// The point of a hit, with a and b as its surface coordinates.
    pub(super) fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let [centre, u, v] = [self.centre, self.u, self.v].map(Vec3::as_dvec3);
        let normal = u.cross(v);
        let across = normal.length_squared();
        let p = ray.at(hit.t) - centre;
        let uv = DVec2::new(p.cross(v).dot(normal), u.cross(p).dot(normal)) / across;
        FlatPatch::with_normal(self, normal, Outline::Rectangle).surface_at(uv)
    }
}

/// A ray in the coordinates of a span.
pub(super) struct SpannedRay<R> {
    /// 0 where the ray meets the plane.
    pub plane: Polynomial<R>,
    /// a and b times `scale`.
    pub a: Polynomial<R>,
    pub b: Polynomial<R>,
    /// |u×v|², not negative.
    pub scale: R,
}

impl<R: Ring> SpannedRay<R> {
    /// With n = u×v and p = o + t·d − c: n·p, (v×n)·p = n·(p×v) and (n×u)·p = n·(u×p).
    pub fn new(span: &Span, ray: &RayIn<R>) -> Self {
        let [u, v] = [span.u, span.v].map(vector::<R>);
        let normal = cross(&u, &v);
        let f = difference(&ray.origin, &vector(span.centre));
        let along = |w: &[R; 3]| Polynomial::new([dot(w, &f), dot(w, &ray.dir)]);
        Self {
            plane: along(&normal),
            a: along(&cross(&v, &normal)),
            b: along(&cross(&normal, &u)),
            scale: dot(&normal, &normal),
        }
    }
}
