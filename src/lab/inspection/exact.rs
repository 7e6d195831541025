//! The exact answer for a ray.

use crate::oracle::{self, ExactHit, Fraction};
use hitscope_core::kernel::exact_triangle_kernel;
use hitscope_core::{Ray, Scene};
use serde::Serialize;

/// The exact answer, correctly rounded to f64.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExactReport {
    /// The nearest primitive; the lowest index of several at the same t. For a scene of triangles alone, also called
    /// `triangle`.
    #[serde(rename = "triangle")]
    pub primitive: u32,
    /// Other primitives at exactly the same t.
    pub also: Vec<u32>,
    /// Distance in units of the direction's length.
    pub t: f64,
    /// The answer of the oracle about a triangle.
    #[serde(flatten)]
    pub fractions: Option<ExactTriangle>,
}

/// The exact answer about a triangle, also as fractions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExactTriangle {
    /// Barycentric coordinates for the three corners.
    pub barycentric: [f64; 3],
    /// t as numerator/denominator.
    pub t_fraction: String,
    /// The barycentric coordinates likewise.
    pub barycentric_fractions: [String; 3],
    /// Whether the hit lies on an edge or at a corner.
    pub is_on_boundary: bool,
}

impl ExactReport {
    /// The nearest hit: by the oracle if all candidates are triangles, else by the exact kernels.
    pub(super) fn nearest(
        scene: &Scene,
        subset: &Scene,
        ray: &Ray,
        candidates: &[u32],
    ) -> Option<Self> {
        let mesh = scene.mesh();
        if candidates
            .iter()
            .all(|&primitive| scene.is_triangle(primitive))
        {
            let mut crossings = oracle::crossings(mesh, &scene.cut(ray)?, candidates).into_iter();
            let shown = crossings.find(|(hit, _)| scene.shows(ray, hit.t.to_f32()));
            let (hit, triangles) = shown?;
            return Some(Self::of_triangle(&hit, triangles));
        }
        let crossings = subset.intersector(exact_triangle_kernel()).all_hits(ray);
        let first = crossings.into_iter().next()?;
        let number = |index: u32| candidates[index as usize];
        let primitive = number(first.hit.primitive);
        let also = first.also.into_iter().map(number);
        if scene.is_triangle(primitive) {
            let hit = oracle::intersect(ray, mesh.corners(primitive))?;
            let all = std::iter::once(primitive).chain(also).collect();
            return Some(Self::of_triangle(&hit, all));
        }
        Some(Self {
            primitive,
            also: also.collect(),
            t: scene.exact_answer(ray, primitive)?[0],
            fractions: None,
        })
    }

    fn of_triangle(hit: &ExactHit, primitives: Vec<u32>) -> Self {
        Self {
            primitive: primitives[0],
            also: primitives[1..].to_vec(),
            t: hit.t.to_f64(),
            fractions: Some(ExactTriangle {
                barycentric: hit.barycentric.each_ref().map(Fraction::to_f64),
                t_fraction: hit.t.to_string(),
                barycentric_fractions: hit.barycentric.each_ref().map(ToString::to_string),
                is_on_boundary: hit.is_on_boundary,
            }),
        }
    }
}
