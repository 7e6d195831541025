//! Boxes, and their images under affine maps.

use super::compact::Slots;
use super::lines::box_grid;
use super::sample::part_by_area;
use super::{
    AddLine, Interior, LineDetail, Parameter, SampledPoint, Shape, ShapeInfo, SurfacePoint, U,
    numbers_of,
};
use crate::aabb::{Aabb, Planes};
use crate::algebra::{Piece, Pieces, Polynomial, RayIn, Ring, cross, difference, dot, vector};
use crate::lane::{Lane, Values};
use crate::ray::{Hit, Ray};
use glam::{DVec2, DVec3, Vec3};

/// The surface of the points c + x·a₀ + y·a₁ + z·a₂ with |x|, |y|, |z| ≤ 1: a box if the half axes are perpendicular,
/// else a parallelepiped. No ray hits it if they lie in a plane or a number isn't finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// The centre.
    pub centre: Vec3,
    /// The half axes.
    pub axes: [Vec3; 3],
}

impl Cuboid {
    fn is_finite(&self) -> bool {
        self.centre.is_finite() && self.axes.iter().all(|axis| axis.is_finite())
    }

    /// Three vectors whose products with a point from the centre are its x, y and z, times the determinant; and that.
    pub(crate) fn cofactors(&self) -> ([DVec3; 3], f64) {
        let [a, b, c] = self.axes.map(Vec3::as_dvec3);
        let rows = [b.cross(c), c.cross(a), a.cross(b)];
        (rows, a.dot(rows[0]))
    }
}

impl Cuboid {
    /// The areas of the faces, lower before upper along each half axis.
    fn face_areas(&self) -> [f64; 6] {
        let (rows, _) = self.cofactors();
        let [x, y, z] = rows.map(|row| 4.0 * row.length());
        [x, x, y, y, z, z]
    }

    /// Half the edges of the bounding box.
    pub(crate) fn half_extent(&self) -> Vec3 {
        let [x, y, z] = self.axes.map(Vec3::abs);
        x + y + z
    }

    /// The box with these half edges about a centre, widened by 2⁻²¹ of the reach, of which each of four sums takes at
    /// most 2⁻²⁴.
    #[inline(always)]
    pub(crate) fn around<L: Lane>(centre: [L; 3], half: [L; 3]) -> Planes<L> {
        let side = |axis: usize| {
            let (c, half) = (centre[axis], half[axis]);
            let slack = (c.abs() + half) * L::of(c.token(), 4.0 * f32::EPSILON);
            [c - half - slack, c + half + slack]
        };
        let [[a, b], [c, d], [e, f]] = [side(0), side(1), side(2)];
        [a, b, c, d, e, f]
    }
}

impl Shape for Cuboid {
    const INFO: ShapeInfo = ShapeInfo {
        name: "box",
        plural: "boxes",
        parameters: &[
            Parameter::point("centre", "c"),
            Parameter::vector("axis_x", "a1"),
            Parameter::vector("axis_y", "a2"),
            Parameter::vector("axis_z", "a3"),
        ],
        equations: &[
            "0 = D(x + 1), where |y| ≤ 1 and |z| ≤ 1, p = c + x a1 + y a2 + z a3, D = a1·(a2 × a3)",
            "0 = D(x − 1), where |y| ≤ 1 and |z| ≤ 1, p = c + x a1 + y a2 + z a3, D = a1·(a2 × a3)",
            "0 = D(y + 1), where |x| ≤ 1 and |z| ≤ 1, p = c + x a1 + y a2 + z a3, D = a1·(a2 × a3)",
            "0 = D(y − 1), where |x| ≤ 1 and |z| ≤ 1, p = c + x a1 + y a2 + z a3, D = a1·(a2 × a3)",
            "0 = D(z + 1), where |x| ≤ 1 and |y| ≤ 1, p = c + x a1 + y a2 + z a3, D = a1·(a2 × a3)",
            "0 = D(z − 1), where |x| ≤ 1 and |y| ≤ 1, p = c + x a1 + y a2 + z a3, D = a1·(a2 × a3)",
        ],
    };
    type Compact = Slots<Self>;
    const NUMBERS: usize = 12;
    const MOST_CROSSINGS: usize = 2;

    fn nowhere() -> Self {
        Self {
            centre: Vec3::NAN,
            axes: [Vec3::NAN; 3],
        }
    }

    fn write(&self, numbers: &mut [f32]) {
        numbers[..3].copy_from_slice(&self.centre.to_array());
        for (axis, kept) in self.axes.iter().zip(numbers[3..].chunks_exact_mut(3)) {
            kept.copy_from_slice(&axis.to_array());
        }
    }

    #[inline(always)]
    fn read(numbers: &impl Values<f32>) -> Self {
        Self {
            centre: Vec3::from_array(numbers.three(0)),
            axes: [numbers.three(3), numbers.three(6), numbers.three(9)].map(Vec3::from_array),
        }
    }

    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let half = |axis: usize| {
            let [x, y, z] = [
                numbers.value(3 + axis),
                numbers.value(6 + axis),
                numbers.value(9 + axis),
            ];
            x.abs() + y.abs() + z.abs()
        };
        Self::around(numbers.three(0), [half(0), half(1), half(2)])
    }

    fn bounds(&self) -> Aabb {
        if self.is_finite() {
            Aabb::from_planes(Self::planes(&numbers_of(self)))
        } else {
            Aabb::EMPTY
        }
    }

    /// u and v are the two other coordinates on the face, from −1 to 1.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let (centre, (rows, det)) = (self.centre.as_dvec3(), self.cofactors());
        let p = ray.at(hit.t) - centre;
        let mut at = rows.map(|row| row.dot(p) / det);
        let part = hit.u as usize % 6;
        let (axis, side) = (part / 2, if part % 2 == 1 { 1.0 } else { -1.0 });
        at[axis] = side;
        let axes = self.axes.map(Vec3::as_dvec3);
        let position = centre + at[0] * axes[0] + at[1] * axes[1] + at[2] * axes[2];
        let reach = self.half_extent();
        SurfacePoint {
            position: position.as_vec3(),
            normal: (side * det.signum() * rows[axis]).normalize_or(DVec3::Z),
            uv: DVec2::new(at[(axis + 1) % 3], at[(axis + 2) % 3]),
            error: 2.0 * U * (self.centre.abs() + reach)
                + Vec3::splat(16.0 * U * reach.max_element()),
            is_flat: false,
        }
    }

    fn area(&self) -> f64 {
        self.face_areas().iter().sum()
    }

    fn sampled_point(&self, at: DVec2) -> Option<SampledPoint> {
        let (face, x) = part_by_area(&self.face_areas(), at.x)?;
        let axis = face / 2;
        let mut point = [0.0; 3];
        point[axis] = if face % 2 == 1 { 1.0 } else { -1.0 };
        point[(axis + 1) % 3] = 2.0 * x - 1.0;
        point[(axis + 2) % 3] = 2.0 * at.y - 1.0;
        let axes = self.axes.map(Vec3::as_dvec3);
        let offset: DVec3 = (0..3).map(|k| point[k] * axes[k]).sum();
        Some(SampledPoint {
            position: self.centre.as_dvec3() + offset,
            u: face as f32,
            v: 0.0,
        })
    }

    fn interior(&self, _: &Ray) -> Interior {
        Interior::Convex
    }

    /// A grid on each face.
    fn lines(&self, _: &LineDetail, add: AddLine<'_>) {
        box_grid(self.centre.as_dvec3(), self.axes.map(Vec3::as_dvec3), add);
    }
}

impl Pieces for Cuboid {
    fn centre(&self) -> Vec3 {
        self.centre
    }

    /// With the determinant D and x·D, y·D, z·D of the point: the parts are x = −1, x = 1, y = −1 and so on, each where
    /// the two others are between −D and D.
    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<'_, R>)) {
        if !self.is_finite() {
            return;
        }
        let [a, b, c] = self.axes.map(vector::<R>);
        let rows = [cross(&b, &c), cross(&c, &a), cross(&a, &b)];
        let det = dot(&a, &rows[0]);
        let f = difference(&ray.origin, &vector(self.centre));
        let at = rows.map(|row| Polynomial::new([dot(&row, &f), dot(&row, &ray.dir)]));
        let whole = Polynomial::constant(det.clone());
        let squared = Polynomial::constant(det.square());
        let inside = at
            .each_ref()
            .map(|coordinate| squared.minus(&coordinate.times(coordinate)));
        for (axis, coordinate) in at.iter().enumerate() {
            let others = [&inside[(axis + 1) % 3], &inside[(axis + 2) % 3]].map(Clone::clone);
            for (side, surface) in [coordinate.plus(&whole), coordinate.minus(&whole)]
                .iter()
                .enumerate()
            {
                emit(Piece {
                    part: (2 * axis + side) as u8,
                    surface,
                    conditions: &others,
                });
            }
        }
    }
}
