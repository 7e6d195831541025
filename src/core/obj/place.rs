//! Chooses a mesh's origin so that f32 keeps its detail, and bounds the rounding error.

use super::Recentre;
use super::elements::{Element, Elements};
use super::error::Warning;
use super::polygon::vector_area;
use crate::counts::counted_as;
use crate::mesh::TriangleMesh;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// The origin of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placement {
    pub origin: DVec3,
    /// The box around nearly all of the surface, if some vertices lie so far away that they didn't count.
    pub core: Option<[DVec3; 2]>,
}

/// A point near the mesh whose coordinates have few bits, so that subtracting it in f64 is exact for
/// coordinates of up to about 29 bits below the mesh's size; zero if the mesh isn't far away.
///
/// `surface` samples the surface: a mesh whose vertices include a few far from all others, as a stray point at (0, 0, 0)
/// in a survey is, is placed by the others.
pub(super) fn placement(points: &[DVec3], surface: &[DVec3], recentre: Recentre) -> Placement {
    let here = Placement {
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
        return Placement { origin, ..here };
    }
    let core = core(surface);
    match core.and_then(origin_near) {
        Some(origin) => Placement { origin, core },
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
fn origin_near([min, max]: [DVec3; 2]) -> Option<DVec3> {
    /// Within this many sizes of zero, f32 loses at most two bits more than at zero.
    const NEAR: f64 = 4.0;
    let size = (max - min).max_element();
    let centre = 0.5 * min + 0.5 * max;
    if !centre.is_finite() || centre.abs().max_element() <= NEAR * size {
        return None;
    }
    // A mesh of one point: its own coordinates rounded to f32.
    if size == 0.0 {
        return Some(centre.as_vec3().as_dvec3());
    }
    let grid = 2f64.powi(size.log2().floor() as i32);
    // Adding +0 clears the sign of a zero, which depends on the order of the points.
    let origin = (centre / grid).round() * grid + DVec3::ZERO;
    origin.is_finite().then_some(origin)
}

/// The corners of some faces with an area, spread over the file.
pub(super) fn sample_surface(elements: &[Elements], positions: &[DVec3]) -> Vec<DVec3> {
    const MOST_CHUNKS: usize = 64;
    const FACES_PER_CHUNK: usize = 64;
    let mut sample = Vec::new();
    let mut corners = Vec::new();
    for elements in elements
        .iter()
        .step_by(elements.len().div_ceil(MOST_CHUNKS).max(1))
    {
        let faces = elements
            .iter()
            .filter(|element| element.kind == Element::Face);
        for face in faces.step_by(elements.count.div_ceil(FACES_PER_CHUNK).max(1)) {
            corners.clear();
            let vertices = &elements.corners[0][face.corners];
            corners.extend(vertices.iter().map(|&vertex| positions[vertex as usize]));
            let area = vector_area(&corners);
            if area.is_finite() && area != DVec3::ZERO {
                sample.append(&mut corners);
            }
        }
    }
    sample
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

/// Upper bound, per coordinate, on the distance between the traced mesh and the numbers in the file.
///
/// It sums the errors of three roundings: of the decimal to f64, of the difference from the origin, and of
/// that to f32. The last two are known exactly. The first is at most half an ulp of the f64, and zero if the
/// decimal equals the f64. `has_long_numbers` says whether a coordinate may have more than 15 digits.
/// Different decimals of at most 15 digits are different f64s, so that an f64 whose own value has no more
/// digits was written as exactly that value.
pub(super) fn max_rounding(mesh: &TriangleMesh, exact: &[DVec3], has_long_numbers: bool) -> f64 {
    rounding_of(mesh, exact, has_long_numbers, |_| true)
}

/// [`max_rounding`] of some of the vertices.
fn rounding_of(
    mesh: &TriangleMesh,
    exact: &[DVec3],
    has_long_numbers: bool,
    counts: impl Fn(&DVec3) -> bool + Sync,
) -> f64 {
    let vertices = mesh.positions().par_iter().zip(exact);
    let larger_of = |mut most: f64, (own, in_file): (&Vec3, &DVec3)| {
        for axis in 0..3 {
            let (x, origin) = (in_file[axis], mesh.origin()[axis]);
            let (from_origin, lost) = difference(x, origin);
            // Exact: the two differ by less than half an ulp of an f32.
            let moved = (from_origin - f64::from(own[axis])).abs() + lost.abs();
            // An upper bound on `read`.
            if moved + x.abs() * f64::EPSILON <= most {
                continue;
            }
            let read = half_last_place(x);
            if moved + read > most {
                let is_exact = !has_long_numbers && has_15_digits(x);
                most = most.max(if is_exact { moved } else { moved + read });
            }
        }
        most
    };
    let most = vertices
        .filter(|(own, in_file)| own.is_finite() && counts(in_file))
        .fold(|| 0.0, larger_of)
        .reduce(|| 0.0, f64::max);
    // The two sums above round at most three times.
    most * (1.0 + 4.0 * f64::EPSILON)
}

/// a − b rounded, and the rounding error.
///
/// Source: Knuth, The Art of Computer Programming, volume 2, section 4.2.2, theorem B.
fn difference(a: f64, b: f64) -> (f64, f64) {
    let rounded = a - b;
    let of_b = rounded - a;
    (rounded, (a - (rounded - of_b)) - (b + of_b))
}

/// Half an ulp of an f64: the largest error of a decimal parsed as this f64.
fn half_last_place(x: f64) -> f64 {
    0.5 * (x.abs().next_up() - x.abs())
}

/// Whether the exact decimal expansion of an f64 has at most 15 digits. Returns false for some integers above
/// 2⁵³.
fn has_15_digits(x: f64) -> bool {
    const TOO_LARGE: u64 = 1_000_000_000_000_000;
    // 5²² is larger.
    const LEAST_POWER: i32 = -21;
    if x == 0.0 {
        return true;
    }
    let bits = x.abs().to_bits();
    let (exponent, fraction) = ((bits >> 52) as i32, bits & ((1 << 52) - 1));
    let whole = fraction | 1 << 52;
    // x = odd·2^power. Subnormal numbers have too many fractional bits in any case.
    let power = exponent - 1075 + whole.trailing_zeros().cast_signed();
    let odd = whole >> whole.trailing_zeros();
    match power {
        // odd·2⁻ᵏ = odd·5ᵏ·10⁻ᵏ.
        LEAST_POWER..0 => {
            let digits = odd.checked_mul(5u64.pow(power.unsigned_abs()));
            digits.is_some_and(|digits| digits < TOO_LARGE)
        }
        0..53 => x.abs() < TOO_LARGE as f64,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_of_an_f64s_exact_decimal_expansion_are_counted() {
        for (x, expected) in [
            (0.0, true),
            (-3.0, true),
            (0.5, true),
            (4_649_776.25, true),
            (999_999_999_999_999.0, true),
            (1e15, false),
            (0.1, false),
            (1e22, false),
            (1e-310, false),
            // 15 and 16 digits.
            (1.0 + 2f64.powi(-14), true),
            (1.0 + 2f64.powi(-15), false),
        ] {
            assert_eq!(has_15_digits(x), expected, "{x:e}");
        }
    }
}
