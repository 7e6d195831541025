//! Triangles.

use super::lines::straight;
use super::sample::in_triangle;
use super::shared_corners::SharedCorners;
use super::{
    AddLine, LineDetail, Parameter, SampledPoint, SampledSurface, Shape, ShapeInfo, SurfacePoint, U,
};
use crate::aabb::{Aabb, Planes};
use crate::lane::{Lane, Values};
use crate::ray::{Hit, Ray};
use glam::{DVec2, DVec3, Vec3};

/// A closed triangle by its corners A, B and C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle(pub [Vec3; 3]);

impl From<[Vec3; 3]> for Triangle {
    fn from(corners: [Vec3; 3]) -> Self {
        Self(corners)
    }
}

impl Shape for Triangle {
    const INFO: ShapeInfo = ShapeInfo {
        name: "triangle",
        plural: "triangles",
        parameters: &[
            Parameter::point("a", "A"),
            Parameter::point("b", "B"),
            Parameter::point("c", "C"),
        ],
        equations: &["0 = (p − A)·n, where n = (B − A) × (C − A) and p is in the triangle"],
    };
    type Compact = SharedCorners;

    const NUMBERS: usize = 9;
    const MOST_CROSSINGS: usize = 1;

    fn nowhere() -> Self {
        Self([Vec3::NAN; 3])
    }

    fn write(&self, numbers: &mut [f32]) {
        for (corner, kept) in self.0.iter().zip(numbers.chunks_exact_mut(3)) {
            kept.copy_from_slice(&corner.to_array());
        }
    }

    #[inline(always)]
    fn read(numbers: &impl Values<f32>) -> Self {
        Self([numbers.three(0), numbers.three(3), numbers.three(6)].map(Vec3::from_array))
    }

    #[inline(always)]
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L> {
        let [a, b, c] = [numbers.three(0), numbers.three(3), numbers.three(6)];
        let lower = |axis: usize| a[axis].lesser(b[axis]).lesser(c[axis]);
        let upper = |axis: usize| a[axis].greater(b[axis]).greater(c[axis]);
        [lower(0), upper(0), lower(1), upper(1), lower(2), upper(2)]
    }

    /// Encloses the corners, and the corners as a kernel recomputes them from the first corner and the edges.
    fn bounds(&self) -> Aabb {
        let [a, b, c] = self.0;
        Aabb::around([a, b, c, a + (b - a), a + (c - a)])
    }

    /// The point l1·A + l2·B + l3·C, with the error bounds of `Triangle::error`.
    fn surface(&self, _: &Ray, hit: &Hit) -> SurfacePoint {
        self.surface_at(hit)
    }

    fn area(&self) -> f64 {
        let [a, b, c] = self.0.map(Vec3::as_dvec3);
        0.5 * (b - a).cross(c - a).length()
    }

    fn sampled_point(&self, at: DVec2) -> Option<SampledPoint> {
        let [a, b, c] = self.0.map(Vec3::as_dvec3);
        let weights = in_triangle(at);
        Some(SampledPoint {
            position: a + weights.x * (b - a) + weights.y * (c - a),
            u: weights.x as f32,
            v: weights.y as f32,
        })
    }

    fn sampled_surface(&self, _: Vec3, at: DVec2) -> Option<SampledSurface> {
        let weights = in_triangle(at).as_vec2();
        let (u, v) = (weights.x, weights.y);
        let hit = Hit {
            t: 1.0,
            u,
            v,
            primitive: 0,
        };
        Some(SampledSurface {
            surface: self.surface_at(&hit),
            u,
            v,
            density: None,
        })
    }

    /// The edges.
    fn lines(&self, _: &LineDetail, add: AddLine<'_>) {
        let [a, b, c] = self.0.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for (from, to) in [(a, b), (b, c), (c, a)] {
            straight(from, to, normal, add);
        }
    }
}

impl Triangle {
    /// The surface at the barycentric coordinates of a hit.
    fn surface_at(&self, hit: &Hit) -> SurfacePoint {
        let [l1, l2, l3] = hit.barycentric();
        let [a, b, c] = self.0;
        let weighted = [l1 * a, l2 * b, l3 * c];
        let position = weighted.into_iter().sum();
        SurfacePoint {
            position,
            normal: self.unit_normal(),
            uv: DVec2::new(hit.u.into(), hit.v.into()),
            error: self.error(weighted, position),
            is_flat: true,
        }
    }

    /// The unit normal by the right-hand rule over A, B, C. Zero if the area is zero in f64 or a corner isn't finite.
    ///
    /// Computed in f64, where neither products nor lengths of f32 numbers under- or overflow.
    pub fn unit_normal(&self) -> DVec3 {
        let [a, b, c] = self.0.map(Vec3::as_dvec3);
        (b - a).cross(c - a).normalize_or_zero()
    }

    /// γ(7)·(s + e) per coordinate, where s bounds the error of the point and e the error with which the next test sees
    /// the plane.
    ///
    /// s is the sum of the magnitudes of the weighted corners. 1 − u − v is off by 1.5u, which moves the point
    /// along the normal by 1.5u·|n·P|, where |n·P| is at most Σ|lᵢPᵢ|·|n|; a product and two sums add 3u. The
    /// rest of 7u comes from the source, whose weights err more.
    ///
    /// e is the largest coordinate of a corner relative to the point. A test in f32 moves the corners to the new
    /// origin and shears them along the new ray, which moves each coordinate by up to 7u·e (see
    /// `kernel::triangle::exact::filter`). It sees a neighbour in the same plane, as large as this triangle, that
    /// much higher or lower. The source omits e, so it doesn't lift a point at all if the weighted corners'
    /// coordinates are 0: on an edge that lies in an axis, or in a plane through two axes.
    ///
    /// Source: Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, 2023, 6.8.6.
    fn error(&self, weighted: [Vec3; 3], p: Vec3) -> Vec3 {
        let size: Vec3 = weighted.iter().map(|p| p.abs()).sum();
        // Computed from halves, as an extent may overflow f32.
        let half_distances = self.0.map(|corner| (0.5 * corner - 0.5 * p).abs());
        let half_extent = half_distances.map(Vec3::max_element);
        let half_extent = half_extent.into_iter().fold(0.0, f32::max);
        GAMMA_7 * size + Vec3::splat(2.0 * GAMMA_7 * half_extent)
    }
}

/// 7u/(1 − 7u).
const GAMMA_7: f32 = 7.0 * U / (1.0 - 7.0 * U);
