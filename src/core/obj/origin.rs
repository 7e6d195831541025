//! Chooses a mesh's origin so that f32 keeps its detail.

use super::Recentre;
use super::elements::{ElementKind, Elements};
use super::error::Warning;
use super::rounding::rounding_of;
use crate::counts::counted_as;
use crate::mesh::TriangleMesh;
use crate::polygon::vector_area;
use glam::DVec3;
use rayon::prelude::*;

/// A mesh's origin, and the part of the mesh that decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ChosenOrigin {
    pub origin: DVec3,
    /// The box around nearly all of the surface, if vertices outside of it were left out.
    pub core: Option<[DVec3; 2]>,
}

/// A point near the mesh whose coordinates have few bits, so that subtracting it in f64 is exact for
/// coordinates of up to about 29 bits below the mesh's size; zero if the mesh isn't far away.
///
/// `surface` samples the surface. It decides if some vertices lie far from all others, such as a stray point at
/// (0, 0, 0) in a survey.
pub(super) fn choose_origin(
    points: &[DVec3],
    surface: &[DVec3],
    recentre: Recentre,
) -> ChosenOrigin {
    let here = ChosenOrigin {
        origin: DVec3::ZERO,
        core: None,
    };
    if recentre == Recentre::Off {
        return here;
    }
    let none = || [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let finite = points.par_iter().filter(|p| p.is_finite());
    let whole = finite
        .fold(none, |[min, max], &p| [min.min(p), max.max(p)])
        .reduce(none, |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    if let Some(origin) = origin_near(whole) {
        return ChosenOrigin { origin, ..here };
    }
    let core = core(surface);
    match core.and_then(origin_near) {
        Some(origin) => ChosenOrigin { origin, core },
        None => here,
    }
}

/// The box around all but the outermost fiftieth of the points on either side of each axis.
fn core(points: &[DVec3]) -> Option<[DVec3; 2]> {
    let outermost = points.len() / 50;
    let ends = |axis: usize| {
        let mut along: Vec<f64> = points.iter().map(|p| p[axis]).collect();
        along.sort_unstable_by(f64::total_cmp);
        Some([*along.get(outermost)?, along[along.len() - 1 - outermost]])
    };
    let [x, y, z] = [ends(0)?, ends(1)?, ends(2)?];
    Some([0, 1].map(|end| DVec3::new(x[end], y[end], z[end])))
}

/// A point near a box; `None` if (0, 0, 0) is near enough.
pub(crate) fn origin_near([min, max]: [DVec3; 2]) -> Option<DVec3> {
    /// Within this many sizes of zero, f32 loses at most two bits more than at zero.
    const NEAR: f64 = 4.0;
    let size = (max - min).max_element();
    let centre = 0.5 * min + 0.5 * max;
    if !centre.is_finite() || centre.abs().max_element() <= NEAR * size {
        return None;
    }
    // A mesh of one point: its own coordinates rounded to f32.
    if size == 0.0 {
        let origin = centre.as_vec3().as_dvec3();
        return origin.is_finite().then_some(origin);
    }
    let grid = 2f64.powi(size.log2().floor() as i32);
    // Adding +0 clears the sign of a zero, which depends on the order of the points.
    let origin = (centre / grid).round() * grid + DVec3::ZERO;
    origin.is_finite().then_some(origin)
}

/// Three corners each of some faces with an area, spread over the file.
pub(super) fn sample_surface(elements: &[Elements], positions: &[DVec3]) -> Vec<DVec3> {
    const MOST_CHUNKS: usize = 64;
    const FACES_PER_CHUNK: usize = 64;
    let step = elements.len().div_ceil(MOST_CHUNKS).max(1);
    let chunks = elements.par_iter().step_by(step);
    let faces_of = |elements: &Elements| {
        let faces = elements
            .iter()
            .filter(|element| element.kind == ElementKind::Face);
        let some = faces.step_by(elements.count.div_ceil(FACES_PER_CHUNK).max(1));
        let corners = some.map(|face| {
            let vertices = &elements.corners[0][face.corners];
            [0, 1, 2].map(|third| positions[vertices[third * vertices.len() / 3] as usize])
        });
        corners.filter(has_area).collect::<Vec<_>>()
    };
    chunks.map(faces_of).collect::<Vec<_>>().concat().concat()
}

fn has_area(corners: &[DVec3; 3]) -> bool {
    let area = vector_area(corners);
    area.is_finite() && area != DVec3::ZERO
}

/// The warning about vertices outside the core of a surface, and what it costs them.
pub(super) fn far_vertices(
    mesh: &TriangleMesh,
    exact: &[DVec3],
    [min, max]: [DVec3; 2],
    has_long_numbers: bool,
) -> Option<Warning> {
    /// Within this many sizes of the core, f32 loses few bits.
    const FAR: f64 = 16.0;
    let (centre, size) = (0.5 * (min + max), (max - min).max_element());
    let is_far = |p: &DVec3| p.is_finite() && (*p - centre).abs().max_element() > FAR * size;
    let count = exact.iter().filter(|p| is_far(p)).count();
    let rounding = |far: bool| rounding_of(mesh, exact, has_long_numbers, |p| is_far(p) == far);
    let (near, far) = (rounding(false), rounding(true));
    (count > 0 && far > near).then(|| {
        let vertices = counted_as(count, "vertex lies", "vertices lie");
        Warning::of_file(format!(
            "{vertices} far from the rest of the mesh, rounded by up to {far:.1e}; the rest is rounded by up to {near:.1e}"
        ))
    })
}
