//! Axis-aligned boxes.

use super::compact::Slots;
use super::lines::box_grid;
use super::sample::part_by_area;
use super::{
    AddLine, Interior, LineDetail, Parameter, SampledPoint, Shape, ShapeInfo, SurfacePoint, U,
};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{Piece, Pieces, Polynomial, RayIn, Ring};
use crate::lane::{Lane, Values};
use crate::ray::{Hit, Ray};
use glam::{DVec2, DVec3, Vec3};

/// The surface of a box with edges along the axes. No ray hits it if a lower coordinate exceeds the upper one or a
/// number isn't finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisBox {
    /// The lowest corner.
    pub min: Vec3,
    /// The highest corner.
    pub max: Vec3,
}

impl AxisBox {
    /// The areas of the faces, lower before upper along each axis.
    fn face_areas(&self) -> [f64; 6] {
        let DVec3 { x, y, z } = self.max.as_dvec3() - self.min.as_dvec3();
        [y * z, y * z, z * x, z * x, x * y, x * y]
    }

    fn can_be_hit(&self) -> bool {
        self.min.is_finite() && self.max.is_finite() && self.min.cmple(self.max).all()
    }
}

impl Shape for AxisBox {
    const INFO: ShapeInfo = ShapeInfo {
        name: "axis-aligned box",
        plural: "axis-aligned boxes",
        parameters: &[
            Parameter::point("min", "min"),
            Parameter::point("max", "max"),
        ],
        equations: &[
            "0 = x − min.x, where min ≤ p ≤ max in y and z",
            "0 = x − max.x, where min ≤ p ≤ max in y and z",
            "0 = y − min.y, where min ≤ p ≤ max in x and z",
            "0 = y − max.y, where min ≤ p ≤ max in x and z",
            "0 = z − min.z, where min ≤ p ≤ max in x and y",
            "0 = z − max.z, where min ≤ p ≤ max in x and y",
        ],
    };
    type Compact = Slots<Self>;
    const NUMBERS: usize = 6;
    const MOST_CROSSINGS: usize = 2;

    fn nowhere() -> Self {
        Self {
            min: Vec3::NAN,
            max: Vec3::NAN,
        }
    }

    fn write(&self, numbers: &mut [f32]) {
        numbers[..3].copy_from_slice(&self.min.to_array());
        numbers[3..].copy_from_slice(&self.max.to_array());
    }

    #[inline(always)]
    fn read(numbers: &impl Values<f32>) -> Self {
        Self {
            min: Vec3::from_array(numbers.three(0)),
            max: Vec3::from_array(numbers.three(3)),
        }
    }

    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let ([a, c, e], [b, d, f]) = (numbers.three(0), numbers.three(3));
        [a, b, c, d, e, f]
    }

    fn bounds(&self) -> Aabb {
        if self.can_be_hit() {
            Aabb {
                min: self.min,
                max: self.max,
            }
        } else {
            Aabb::EMPTY
        }
    }

    /// u and v are the two other coordinates on the face, from −1 to 1; NaN along an edge of length 0.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        let mut position = ray.at(hit.t).clamp(min, max);
        let part = hit.u as usize % 6;
        let (axis, is_upper) = (part / 2, part % 2 == 1);
        position[axis] = if is_upper { max[axis] } else { min[axis] };
        let mut normal = DVec3::ZERO;
        normal[axis] = if is_upper { 1.0 } else { -1.0 };
        let in_box = (2.0 * position - (min + max)) / (max - min);
        SurfacePoint {
            position: position.as_vec3(),
            normal,
            uv: DVec2::new(in_box[(axis + 1) % 3], in_box[(axis + 2) % 3]),
            // Of the position only the coordinates along the face are rounded, but the next test rounds differences and
            // quotients of coordinates of this size.
            error: 4.0 * U * self.min.abs().max(self.max.abs()),
            is_flat: false,
        }
    }

    fn area(&self) -> f64 {
        self.face_areas().iter().sum()
    }

    fn sampled_point(&self, at: DVec2) -> Option<SampledPoint> {
        let (face, x) = part_by_area(&self.face_areas(), at.x)?;
        let axis = face / 2;
        let mut part = DVec3::ZERO;
        part[axis] = (face % 2) as f64;
        part[(axis + 1) % 3] = x;
        part[(axis + 2) % 3] = at.y;
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        Some(SampledPoint {
            position: min + part * (max - min),
            u: face as f32,
            v: 0.0,
        })
    }

    fn interior(&self, _: &Ray) -> Interior {
        Interior::Convex
    }

    /// A grid on each face.
    fn lines(&self, _: &LineDetail, add: AddLine<'_>) {
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        let half = 0.5 * (max - min);
        let axes = [half.x * DVec3::X, half.y * DVec3::Y, half.z * DVec3::Z];
        box_grid(0.5 * (min + max), axes, add);
    }
}

impl Pieces for AxisBox {
    fn centre(&self) -> Vec3 {
        0.5 * self.min + 0.5 * self.max
    }

    /// The parts are x = min, x = max, y = min and so on, each limited to the box's extent along the other axes.
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.can_be_hit() {
            return;
        }
        let beyond = |axis: usize, plane: Vec3| {
            let from = ray.origin[axis].minus(&R::from(plane[axis]));
            Polynomial::new([from, ray.dir[axis].clone()])
        };
        let above = [0, 1, 2].map(|axis| beyond(axis, self.min));
        let past = [0, 1, 2].map(|axis| beyond(axis, self.max));
        let nothing = Polynomial::constant(R::zero());
        let below = past.each_ref().map(|past| nothing.minus(past));
        for axis in 0..3 {
            let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
            let others = [&above[j], &below[j], &above[k], &below[k]].map(Clone::clone);
            for (side, surface) in [&above[axis], &past[axis]].into_iter().enumerate() {
                emit(Piece {
                    part: (2 * axis + side) as u8,
                    surface,
                    conditions: &others,
                });
            }
        }
    }
}
