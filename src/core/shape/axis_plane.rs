//! Infinite planes that are perpendicular to an axis.

use super::compact::Slots;
use super::interior::negative_side;
use super::lines::plane_grid;
use super::{AddLine, Interior, LineDetail, Parameter, Shape, ShapeInfo, SurfacePoint, U};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{Piece, Pieces, Polynomial, RayIn, Ring};
use crate::lane::{Lane, Values};
use crate::ray::{Hit, Ray};
use glam::{DVec2, DVec3, Vec3};

/// A plane perpendicular to an axis. No ray hits it if that isn't finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisPlane {
    /// The axis that is perpendicular to the plane: 0, 1 or 2; higher numbers count as 2.
    pub axis: u8,
    /// The points' coordinate along the axis.
    pub coordinate: f32,
    /// Whether the normal points along the axis, to higher coordinates, and not against it.
    pub is_along_axis: bool,
}

impl AxisPlane {
    fn axis(&self) -> usize {
        usize::from(self.axis).min(2)
    }

    fn normal(&self) -> DVec3 {
        let mut normal = DVec3::ZERO;
        normal[self.axis()] = if self.is_along_axis { 1.0 } else { -1.0 };
        normal
    }
}

impl Shape for AxisPlane {
    const INFO: ShapeInfo = ShapeInfo {
        name: "axis-aligned plane",
        plural: "axis-aligned planes",
        parameters: &[
            Parameter::number("axis", "k"),
            Parameter::number("coordinate", "D"),
            Parameter::flag("normal_along_axis"),
        ],
        equations: &["0 = p_k − D, hence t = (D − o_k)/d_k"],
    };
    type Compact = Slots<Self>;
    const NUMBERS: usize = 3;
    const MOST_CROSSINGS: usize = 1;
    const IS_BOUNDED: bool = false;

    fn nowhere() -> Self {
        Self {
            axis: 0,
            coordinate: f32::NAN,
            is_along_axis: true,
        }
    }

    fn write(&self, numbers: &mut [f32]) {
        let is_along_axis = f32::from(u8::from(self.is_along_axis));
        numbers.copy_from_slice(&[self.axis.into(), self.coordinate, is_along_axis]);
    }

    #[inline(always)]
    fn read(numbers: &impl Values<f32>) -> Self {
        Self {
            axis: numbers.value(0) as u8,
            coordinate: numbers.value(1),
            is_along_axis: numbers.value(2) == 1.0,
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

    /// Half-spaces.
    fn bounds_of_sides(&self) -> [Aabb; 2] {
        let [mut below, mut above] = [Aabb::EVERYWHERE; 2];
        if self.coordinate.is_finite() {
            below.max[self.axis()] = self.coordinate;
            above.min[self.axis()] = self.coordinate;
        }
        if self.is_along_axis {
            [below, above]
        } else {
            [above, below]
        }
    }

    /// u and v are the two other coordinates, in cyclic order.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let axis = self.axis();
        let mut position = ray.at(hit.t);
        position[axis] = self.coordinate.into();
        let rounded = position.as_vec3();
        SurfacePoint {
            position: rounded,
            normal: self.normal(),
            uv: DVec2::new(position[(axis + 1) % 3], position[(axis + 2) % 3]),
            error: 2.0 * U * rounded.abs(),
            is_flat: true,
        }
    }

    /// The half-space behind the normal.
    fn interior(&self, ray: &Ray) -> Interior {
        negative_side(self, ray)
    }

    /// A grid near the region of interest.
    fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        plane_grid(Pieces::centre(self).as_dvec3(), self.normal(), detail, add);
    }
}

impl Pieces for AxisPlane {
    fn centre(&self) -> Vec3 {
        let mut centre = Vec3::ZERO;
        centre[self.axis()] = self.coordinate;
        centre
    }

    /// o + t·d − D along the axis, or the opposite if the normal points down.
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.coordinate.is_finite() {
            return;
        }
        let axis = self.axis();
        let from = ray.origin[axis].minus(&R::from(self.coordinate));
        let above = Polynomial::new([from, ray.dir[axis].clone()]);
        let nothing = Polynomial::constant(R::zero());
        let surface = if self.is_along_axis {
            above
        } else {
            nothing.minus(&above)
        };
        emit(Piece {
            part: 0,
            surface: &surface,
            conditions: &[],
        });
    }
}
