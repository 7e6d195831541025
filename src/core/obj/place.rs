//! Where is a mesh put, so that f32 holds its detail, and what does that cost?

use super::Recentre;
use crate::mesh::TriangleMesh;
use glam::{DVec3, Vec3};

/// A point near the mesh whose coordinates have few bits, so that subtracting it in f64 is exact for
/// coordinates of up to some 29 bits below the mesh's size; zero if the mesh isn't far away.
pub(super) fn origin(points: &[DVec3], recentre: Recentre) -> DVec3 {
    /// Nearer than this many sizes, f32 loses at most two bits more than at the origin.
    const NEAR: f64 = 4.0;
    let finite = points.iter().filter(|p| p.is_finite());
    let (min, max) = finite.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), &p| {
        (min.min(p), max.max(p))
    });
    let size = (max - min).max_element();
    let centre = 0.5 * min + 0.5 * max;
    if recentre == Recentre::Off || !centre.is_finite() || centre.abs().max_element() <= NEAR * size
    {
        return DVec3::ZERO;
    }
    // A mesh of one point: its own coordinates, as f32 holds them.
    if size == 0.0 {
        return centre.as_vec3().as_dvec3();
    }
    let grid = 2f64.powi(size.log2().floor() as i32);
    let origin = (centre / grid).round() * grid;
    if origin.is_finite() {
        origin
    } else {
        DVec3::ZERO
    }
}

/// What recentring and rounding to f32 moved a coordinate by, at most.
pub(super) fn max_rounding(mesh: &TriangleMesh, exact: &[DVec3]) -> f64 {
    let moved = |(p, q): (&Vec3, &DVec3)| (p.as_dvec3() + mesh.origin - *q).abs().max_element();
    let finite = mesh
        .positions
        .iter()
        .zip(exact)
        .filter(|(p, _)| p.is_finite());
    finite.map(moved).fold(0.0, f64::max)
}
