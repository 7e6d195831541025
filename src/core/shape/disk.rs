//! Disks, and their images under affine maps.

use super::compact::Slots;
use super::extent::{ellipse_reach, rounded_outwards};
use super::flat_patch::Outline;
use super::lines::disk_lines;
use super::span::{Span, SpannedRay};
use super::{
    AddLine, FlatPatch, LineDetail, SampledPoint, SampledSurface, Shape, ShapeInfo, SurfacePoint,
    in_disk, numbers_of,
};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{Piece, Pieces, Polynomial, QuickLine, RayIn, Ring, RootIntervals};
use crate::lane::{Lane, Values, minus, plus};
use crate::ray::{Hit, Ray};
use glam::{DVec2, Vec3};
use std::f64::consts::PI;

/// The points c + a·u + b·v with a² + b² ≤ 1: a disk if u and v are perpendicular and equally long, else an ellipse.
/// No ray hits it if they are parallel or a number isn't finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk(pub Span);

impl Shape for Disk {
    const INFO: ShapeInfo = ShapeInfo {
        name: "disk",
        plural: "disks",
        parameters: Span::PARAMETERS,
        equations: &["0 = (p − c)·(u × v), where p = c + αu + βv with α² + β² ≤ 1"],
    };
    type Compact = Slots<Self>;
    const NUMBERS: usize = Span::NUMBERS;
    const MOST_CROSSINGS: usize = 1;

    fn nowhere() -> Self {
        Self(Span::NOWHERE)
    }

    fn write(&self, numbers: &mut [f32]) {
        self.0.write(numbers);
    }

    #[inline(always)]
    fn read(numbers: &impl Values<f32>) -> Self {
        Self(Span::read(numbers))
    }

    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let (centre, u, v) = (numbers.three(0), numbers.three(3), numbers.three(6));
        let along = |axis: usize| ellipse_reach(u[axis], v[axis]);
        let reach = [along(0), along(1), along(2)];
        rounded_outwards(minus(&centre, &reach), plus(&centre, &reach))
    }

    fn bounds(&self) -> Aabb {
        if self.0.is_finite() {
            Aabb::from_planes(Self::planes(&numbers_of(self)))
        } else {
            Aabb::EMPTY
        }
    }

    /// u and v are a and b, each from −1 to 1.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        self.0.surface(ray, hit)
    }

    fn area(&self) -> f64 {
        0.25 * PI * self.0.area()
    }

    fn sampled_point(&self, at: DVec2) -> Option<SampledPoint> {
        Some(self.0.at(in_disk(at.as_vec2()).0.as_dvec2()))
    }

    fn sampled_surface(&self, _: Vec3, at: DVec2) -> Option<SampledSurface> {
        Some(FlatPatch::new(&self.0, Outline::Disk).sampled(at))
    }

    fn flat_patch(&self) -> Option<FlatPatch> {
        Some(FlatPatch::new(&self.0, Outline::Disk))
    }

    /// Circles and diameters.
    fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        let [centre, u, v] = [self.0.centre, self.0.u, self.0.v].map(Vec3::as_dvec3);
        let normal = u.cross(v).normalize_or_zero();
        disk_lines(centre, [u, v], normal, detail, add);
    }
}

impl Pieces for Disk {
    fn centre(&self) -> Vec3 {
        self.0.centre
    }

    #[inline(always)]
    fn quick_roots(&self, line: &QuickLine) -> Option<RootIntervals> {
        self.0.crossed_by(line)?.in_ellipse()
    }

    /// The plane, and 1 − a² − b².
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.0.is_finite() {
            return;
        }
        let SpannedRay { plane, a, b, scale } = SpannedRay::new(&self.0, ray);
        let inside = Polynomial::constant(scale.square())
            .minus(&a.times(&a))
            .minus(&b.times(&b));
        emit(Piece {
            part: 0,
            surface: &plane,
            conditions: &[inside],
        });
    }
}
