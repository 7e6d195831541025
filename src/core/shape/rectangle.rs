//! Rectangles, and their images under affine maps.

use super::compact::Slots;
use super::extent::{above, rounded_outwards};
use super::flat_patch::Outline;
use super::lines::grid;
use super::span::{Span, SpannedRay};
use super::{
    AddLine, FlatPatch, LineDetail, SampledPoint, SampledSurface, Shape, ShapeInfo, SurfacePoint,
    numbers_of,
};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{Piece, Pieces, Polynomial, QuickLine, RayIn, Ring, RootIntervals};
use crate::lane::{Lane, Values, minus, plus};
use crate::ray::{Hit, Ray};
use glam::{DVec2, Vec3};

/// The points c + a·u + b·v with |a| ≤ 1 and |b| ≤ 1: a rectangle if u and v are perpendicular, else a parallelogram.
/// No ray hits it if they are parallel or a number isn't finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle(pub Span);

impl Shape for Rectangle {
    const INFO: ShapeInfo = ShapeInfo {
        name: "rectangle",
        plural: "rectangles",
        parameters: Span::PARAMETERS,
        equations: &["0 = (p − c)·(u × v), where p = c + αu + βv with |α| ≤ 1 and |β| ≤ 1"],
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

    /// |u| + |v| on either side of the centre.
    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let (centre, u, v) = (numbers.three(0), numbers.three(3), numbers.three(6));
        let along = |axis: usize| above(u[axis].abs() + v[axis].abs());
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
        self.0.area()
    }

    fn sampled_point(&self, at: DVec2) -> Option<SampledPoint> {
        Some(self.0.at(2.0 * at - 1.0))
    }

    fn sampled_surface(&self, _: Vec3, at: DVec2) -> Option<SampledSurface> {
        Some(FlatPatch::new(&self.0, Outline::Rectangle).sampled(at))
    }

    fn flat_patch(&self) -> Option<FlatPatch> {
        Some(FlatPatch::new(&self.0, Outline::Rectangle))
    }

    /// A grid.
    fn lines(&self, _: &LineDetail, add: AddLine<'_>) {
        let [centre, u, v] = [self.0.centre, self.0.u, self.0.v].map(Vec3::as_dvec3);
        grid(centre, [u, v], 4, u.cross(v).normalize_or_zero(), add);
    }
}

impl Pieces for Rectangle {
    fn centre(&self) -> Vec3 {
        self.0.centre
    }

    #[inline(always)]
    fn quick_roots(&self, line: &QuickLine) -> Option<RootIntervals> {
        self.0.crossed_by(line)?.in_parallelogram()
    }

    /// The plane, and 1 ± a and 1 ± b.
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.0.is_finite() {
            return;
        }
        let SpannedRay { plane, a, b, scale } = SpannedRay::new(&self.0, ray);
        let one = Polynomial::constant(scale);
        emit(Piece {
            part: 0,
            surface: &plane,
            conditions: &[one.minus(&a), one.plus(&a), one.minus(&b), one.plus(&b)],
        });
    }
}
