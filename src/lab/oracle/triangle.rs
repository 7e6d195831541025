//! Exact ray–triangle intersection.
//!
//! It computes the point on the plane first, then its barycentric coordinates from two of its three
//! coordinates. No kernel uses this method, so an error in either shows. With e = B − A, f = C − A:
//!
//! ```text
//! n = e×f,  det = d·n,  t = (A − o)·n/det,  p = det·(P − A) = det·(o − A) + (A − o)·n·d
//! l2 = (p_x·f_y − p_y·f_x)/(det·n_k),  l3 = (e_x·p_y − e_y·p_x)/(det·n_k),  l1 = 1 − l2 − l3
//! ```
//!
//! where k is a coordinate in which n isn't 0, and x and y are the two following ones.
//!
//! Every f32 is an integer times a power of two, so integers suffice.

use super::fraction::{Fraction, decode};
use dashu_int::IBig;
use glam::Vec3;
use hitscope_core::{Ray, TriangleMesh};

/// The exact hit of a ray and a triangle.
#[derive(Clone, Debug)]
pub struct ExactHit {
    /// The hit's t, in lengths of the direction.
    pub t: Fraction,
    /// Barycentric coordinates of the hit; their sum is 1.
    pub barycentric: [Fraction; 3],
    /// Whether the hit is on an edge or at a corner.
    pub is_on_boundary: bool,
}

/// The hit with `t_min < t < t_max`, or `None`.
///
/// The triangle is closed: it includes its boundary. A ray in its plane misses it; every ray misses a
/// triangle of zero area. A NaN or an infinity anywhere except in `t_max` is a miss.
pub fn intersect(ray: &Ray, corners: [Vec3; 3]) -> Option<ExactHit> {
    let places = [ray.origin, corners[0], corners[1], corners[2]];
    let (places, length_exponent) = integers(&places)?;
    let (dirs, dir_exponent) = integers(&[ray.dir])?;
    let d = &dirs[0];
    let [o, a, b, c] = [&places[0], &places[1], &places[2], &places[3]];
    let (e, f, to_a) = (minus(b, a), minus(c, a), minus(a, o));

    // The plane.
    let normal = cross(&e, &f);
    let det = dot(d, &normal);
    if det == IBig::ZERO {
        return None;
    }
    let numerator = dot(&to_a, &normal);
    let t = Fraction::new(numerator.clone(), det.clone())?.scaled(length_exponent - dir_exponent);

    // The hit point, in the plane's own coordinates.
    let k = (0..3).find(|&k| normal[k] != IBig::ZERO)?;
    let (x, y) = ((k + 1) % 3, (k + 2) % 3);
    let p = |axis: usize| &numerator * &d[axis] - &det * &to_a[axis];
    let (p_x, p_y) = (p(x), p(y));
    let whole = &det * &normal[k];
    let l2 = &p_x * &f[y] - &p_y * &f[x];
    let l3 = &e[x] * &p_y - &e[y] * &p_x;
    let weights = [&whole - &l2 - &l3, l2, l3];

    // Inside: no barycentric coordinate has the opposite sign of their sum.
    let outside = whole.cmp(&IBig::ZERO).reverse();
    if weights.iter().any(|w| w.cmp(&IBig::ZERO) == outside) {
        return None;
    }
    let is_before_end = match ray.t_max {
        f32::INFINITY => true,
        t_max => t < Fraction::from_f64(t_max.into())?,
    };
    if t <= Fraction::from_f64(ray.t_min.into())? || !is_before_end {
        return None;
    }
    let is_on_boundary = weights.contains(&IBig::ZERO);
    let [l1, l2, l3] = weights.map(|w| Fraction::new(w, whole.clone()));
    Some(ExactHit {
        t,
        barycentric: [l1?, l2?, l3?],
        is_on_boundary,
    })
}

/// A crossing of a ray with a mesh: the hit, and the triangles hit there in the order in which they were
/// tested.
pub type Crossing = (ExactHit, Vec<u32>);

/// All crossings of a ray with the given triangles, nearest first; hits at exactly the same t are one
/// crossing.
pub fn crossings(mesh: &TriangleMesh, ray: &Ray, triangles: &[u32]) -> Vec<Crossing> {
    let hit = |&triangle| Some((intersect(ray, mesh.corners(triangle))?, triangle));
    let mut hits: Vec<(ExactHit, u32)> = triangles.iter().filter_map(hit).collect();
    // The sort is stable: triangles at the same t keep their order.
    hits.sort_by(|a, b| a.0.t.cmp(&b.0.t));
    let mut crossings: Vec<Crossing> = Vec::new();
    for (hit, triangle) in hits {
        match crossings.last_mut() {
            Some((first, triangles)) if first.t == hit.t => triangles.push(triangle),
            _ => crossings.push((hit, vec![triangle])),
        }
    }
    crossings
}

/// The nearest hit and its triangle; the first of several triangles at the same t.
pub fn nearest(mesh: &TriangleMesh, ray: &Ray, triangles: &[u32]) -> Option<(u32, ExactHit)> {
    triangles
        .iter()
        .filter_map(|&triangle| Some((triangle, intersect(ray, mesh.corners(triangle))?)))
        .min_by(|a, b| a.1.t.cmp(&b.1.t))
}

/// The vectors as integers times a common power of two, and its exponent.
pub(super) fn integers(vectors: &[Vec3]) -> Option<(Vec<[IBig; 3]>, i32)> {
    let mut decoded = Vec::with_capacity(vectors.len());
    for v in vectors {
        let [x, y, z] = v.to_array().map(|x| decode(f64::from(x)));
        decoded.push([x?, y?, z?]);
    }
    let nonzero = decoded
        .iter()
        .flatten()
        .filter(|(mantissa, _)| *mantissa != 0);
    let common = nonzero.map(|(_, exponent)| *exponent).min().unwrap_or(0);
    let integer = |(mantissa, exponent): (i64, i32)| match mantissa {
        0 => IBig::ZERO,
        _ => IBig::from(mantissa) << (exponent - common) as usize,
    };
    let integers = decoded.into_iter().map(|v| v.map(integer)).collect();
    Some((integers, common))
}

pub(super) fn minus(a: &[IBig; 3], b: &[IBig; 3]) -> [IBig; 3] {
    std::array::from_fn(|k| &a[k] - &b[k])
}

fn cross(a: &[IBig; 3], b: &[IBig; 3]) -> [IBig; 3] {
    std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        &a[i] * &b[j] - &a[j] * &b[i]
    })
}

pub(super) fn dot(a: &[IBig; 3], b: &[IBig; 3]) -> IBig {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: [Vec3; 3] = [
        Vec3::ZERO,
        Vec3::new(4.0, 0.0, 0.0),
        Vec3::new(0.0, 4.0, 0.0),
    ];

    fn hit(origin: Vec3, dir: Vec3) -> Option<ExactHit> {
        intersect(&Ray::new(origin, dir).expect("a ray"), TRIANGLE)
    }

    fn answer(hit: &ExactHit) -> [String; 4] {
        let [l1, l2, l3] = &hit.barycentric;
        [&hit.t, l1, l2, l3].map(ToString::to_string)
    }

    #[test]
    fn hits_inside_and_at_a_corner_are_exact_and_other_rays_miss() {
        let inside = hit(Vec3::new(1.0, 2.0, 6.0), Vec3::new(0.0, 0.0, -4.0)).expect("inside");
        assert_eq!(answer(&inside), ["3/2", "1/4", "1/4", "1/2"]);
        assert!(!inside.is_on_boundary);
        let corner = hit(Vec3::new(4.0, 0.0, -1.0), Vec3::Z).expect("the boundary is included");
        assert_eq!(answer(&corner), ["1", "0", "1", "0"]);
        assert!(corner.is_on_boundary);
        assert!(
            hit(Vec3::new(2.1, 2.0, 1.0), Vec3::NEG_Z).is_none(),
            "outside"
        );
        assert!(hit(Vec3::new(1.0, 1.0, 1.0), Vec3::Z).is_none(), "behind");
        assert!(hit(Vec3::new(1.0, 1.0, 0.0), Vec3::Z).is_none(), "t = 0");
        assert!(
            hit(Vec3::new(-1.0, 1.0, 0.0), Vec3::X).is_none(),
            "in its plane"
        );
    }

    #[test]
    fn one_ulp_past_the_edge_is_outside_at_any_scale() {
        for exponent in [-120, -60, 0, 60, 120] {
            let scale = 2f32.powi(exponent);
            let corners = TRIANGLE.map(|p| p * scale);
            let at =
                |x: f32| Ray::new(Vec3::new(x, 2.0 * scale, scale), Vec3::NEG_Z).expect("a ray");
            let edge = 2.0 * scale;
            assert!(intersect(&at(edge), corners).is_some_and(|h| h.is_on_boundary));
            assert!(intersect(&at(edge.next_up()), corners).is_none());
            assert!(intersect(&at(edge.next_down()), corners).is_some_and(|h| !h.is_on_boundary));
        }
    }

    #[test]
    fn a_non_finite_ray_or_triangle_is_a_miss() {
        let ray = Ray::new(Vec3::Z, Vec3::NEG_Z).expect("a ray");
        assert!(intersect(&ray, [Vec3::ZERO; 3]).is_none());
        assert!(intersect(&ray, [Vec3::NAN, Vec3::X, Vec3::Y]).is_none());
        assert!(intersect(&ray, [Vec3::INFINITY, Vec3::X, Vec3::Y]).is_none());
    }

    #[test]
    fn the_interval_is_open() {
        let ray = |lo, hi| {
            Ray::with_interval(Vec3::new(1.0, 1.0, 2.0), Vec3::NEG_Z, lo, hi).expect("a ray")
        };
        assert!(intersect(&ray(0.0, 2.5), TRIANGLE).is_some());
        assert!(intersect(&ray(2.0, 2.5), TRIANGLE).is_none());
        assert!(intersect(&ray(0.0, 2.0), TRIANGLE).is_none());
    }
}
