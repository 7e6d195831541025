//! Checks of single triangles: slivers and duplicates.

use crate::mesh::{TriangleMesh, Welded, aspect};
use rayon::prelude::*;

/// Ratio of longest edge to height above which a triangle counts as a sliver. Above it, f32 kernels decide some rays
/// wrongly.
pub const SLIVER_ASPECT: f64 = 1e3;

/// The slivers, and the largest [`aspect`] of any triangle.
pub(super) fn slivers(mesh: &TriangleMesh) -> (Vec<u32>, f64) {
    let triangles = (0..mesh.triangles.len() as u32).into_par_iter();
    let aspects = triangles.map(|triangle| (triangle, aspect(mesh.corners(triangle))));
    let max_aspect = aspects.clone().map(|(_, aspect)| aspect);
    let max_aspect = max_aspect.reduce(|| 0.0, f64::max);
    let slivers = aspects.filter(|(_, aspect)| *aspect > SLIVER_ASPECT);
    (slivers.map(|(triangle, _)| triangle).collect(), max_aspect)
}

/// Triangles with the same three vertices as an earlier one, regardless of winding.
pub(super) fn duplicates(mesh: &TriangleMesh, welded: &Welded) -> Vec<u32> {
    let key = |(triangle, &corners): (usize, &[u32; 3])| {
        let mut places = welded.corners(corners);
        places.sort_unstable();
        (places, triangle as u32)
    };
    let mut order: Vec<([u32; 3], u32)> = mesh.triangles.par_iter().enumerate().map(key).collect();
    order.par_sort_unstable();
    let same = order.chunk_by(|a, b| a.0 == b.0);
    let mut duplicates: Vec<u32> = same
        .flat_map(|same| same[1..].iter().map(|(_, triangle)| *triangle))
        .collect();
    duplicates.sort_unstable();
    duplicates
}
