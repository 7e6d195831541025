//! Barycentric coordinates, and the interpolation of values at a triangle's corners by them.
//!
//! Source: Lensch, Basic Geometry, lecture, 2022.

use glam::{DVec3, Vec3};

/// Δ(ABC), the signed area of a triangle in a plane with a unit normal: positive if, seen from the side of the normal,
/// its corners run counterclockwise. With a longer normal it is multiplied by the normal's length.
pub fn signed_area([a, b, c]: [DVec3; 3], normal: DVec3) -> f64 {
    0.5 * (b - a).cross(c - a).dot(normal)
}

/// The weights of a triangle's corners at a point of its plane, as ratios of signed areas: λ₁ = Δ(BCP)/Δ(ABC) and so
/// on. A weight is negative beyond the opposite edge. Not finite for a triangle without area.
pub fn weights_by_areas([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let whole = signed_area([a, b, c], normal);
    [[b, c, p], [c, a, p], [a, b, p]].map(|part| signed_area(part, normal) / whole)
}

/// The same weights in the coordinate plane onto which the triangle's projection is largest: with b = C − A, c = B − A and
/// p = P − A, λ₂ = (b×p)/(b×c), λ₃ = (p×c)/(b×c) and λ₁ = 1 − λ₂ − λ₃, where × is the cross product in the plane.
pub fn weights_in_2d([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a).abs();
    let k = if normal.x >= normal.y && normal.x >= normal.z {
        0
    } else if normal.y >= normal.z {
        1
    } else {
        2
    };
    let (x, y) = ((k + 1) % 3, (k + 2) % 3);
    let cross = |v: DVec3, w: DVec3| v[x] * w[y] - v[y] * w[x];
    let (b, c, p) = (c - a, b - a, p - a);
    let second = cross(b, p) / cross(b, c);
    let third = cross(p, c) / cross(b, c);
    [1.0 - second - third, second, third]
}

/// λ₁·a + λ₂·b + λ₃·c: colours, texture coordinates, or normals before they are normalised.
pub fn weighted([l1, l2, l3]: [f32; 3], [a, b, c]: [Vec3; 3]) -> Vec3 {
    l1 * a + l2 * b + l3 * c
}

/// The weighted mean of unit vectors on the unit sphere: the point from which the arcs to them, times their weights,
/// add up to 0. `None` if the linear mean is 0 or a number isn't finite.
///
/// Source: Buss, Fillmore, "Spherical Averages and Applications to Spherical Splines and Interpolation", TOG 20(2),
/// 2001 (the algorithm that converges linearly).
pub fn spherical_mean(weights: [f32; 3], normals: [Vec3; 3]) -> Option<Vec3> {
    /// Of 20 000 random triples up to 80° apart none took more than 9 steps (2026-11).
    const STEPS: usize = 20;
    /// Well below the resolution of f32, 6·10⁻⁸.
    const LEAST: f64 = 1e-9;
    let normals = normals.map(Vec3::as_dvec3);
    let terms = || weights.map(f64::from).into_iter().zip(normals);
    let linear: DVec3 = terms().map(|(weight, normal)| weight * normal).sum();
    let mut mean = linear.try_normalize()?;
    for _ in 0..STEPS {
        let step: DVec3 = terms()
            .map(|(weight, normal)| weight * arc(mean, normal))
            .sum();
        let angle = step.length();
        if angle < LEAST {
            break;
        }
        mean = (angle.cos() * mean + angle.sin() / angle * step).try_normalize()?;
    }
    mean.is_finite().then(|| mean.as_vec3())
}

/// The arc from one unit vector to another: a tangent whose length is the angle between them.
fn arc(from: DVec3, to: DVec3) -> DVec3 {
    let tangent = to - from.dot(to) * from;
    tangent.normalize_or_zero() * from.angle_between(to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn ratios_of_areas_and_the_formula_in_2d_give_the_same_weights() {
        let mut random = Random::new(1);
        for _ in 0..10_000 {
            let corners = [(); 3].map(|()| random.in_cube());
            let [a, b, c] = corners;
            let area = (b - a).cross(c - a).length();
            let expected = [random.signed() * 2.0, random.signed() * 2.0];
            let [l2, l3] = expected;
            let p = (1.0 - l2 - l3) * a + l2 * b + l3 * c;
            let (areas, flat) = (weights_by_areas(corners, p), weights_in_2d(corners, p));
            // Some twenty operations on products of differences up to 10, over an area.
            let bound = 1e3 * f64::EPSILON / area.powi(2).min(1.0);
            for k in 0..3 {
                assert!((areas[k] - flat[k]).abs() < bound, "{corners:?} {p}");
            }
            assert!((areas[1] - l2).abs() < bound && (areas[2] - l3).abs() < bound);
        }
    }

    #[test]
    fn a_weight_is_negative_beyond_the_opposite_edge() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        for weights in [weights_by_areas, weights_in_2d] {
            assert_eq!(
                weights(corners, DVec3::new(0.25, 0.5, 0.0)),
                [0.25, 0.25, 0.5]
            );
            assert_eq!(
                weights(corners, DVec3::new(1.0, 1.0, 0.0)),
                [-1.0, 1.0, 1.0]
            );
            assert_eq!(weights(corners, DVec3::X), [0.0, 1.0, 0.0]);
        }
    }

    #[test]
    fn weights_apply_to_their_corners() {
        let corners = [Vec3::X, Vec3::Y, Vec3::Z];
        assert_eq!(weighted([0.2, 0.3, 0.5], corners), Vec3::new(0.2, 0.3, 0.5));
    }

    #[test]
    fn along_an_edge_the_spherical_mean_turns_at_a_constant_rate() {
        let corners = [Vec3::X, Vec3::Y, Vec3::Z];
        for part in [0.0, 0.1, 0.25, 0.5, 1.0f32] {
            let mean = spherical_mean([1.0 - part, part, 0.0], corners).expect("a mean");
            let (sin, cos) = (part * std::f32::consts::FRAC_PI_2).sin_cos();
            assert!((mean - Vec3::new(cos, sin, 0.0)).length() < 1e-6, "{mean}");
            let linear = weighted([1.0 - part, part, 0.0], corners).normalize();
            let is_same = (mean - linear).length() < 1e-6;
            assert_eq!(is_same, [0.0, 0.5, 1.0].contains(&part));
        }
    }

    #[test]
    fn the_spherical_mean_balances_the_arcs() {
        let mut random = Random::new(2);
        for _ in 0..1000 {
            let axis = random.direction();
            let normals = [(); 3].map(|()| (axis + 0.8 * random.in_cube()).normalize().as_vec3());
            let (a, b) = (random.unit() as f32, random.unit() as f32);
            let weights = [a * b, a * (1.0 - b), 1.0 - a];
            let mean = spherical_mean(weights, normals).expect("a mean").as_dvec3();
            let terms = weights.into_iter().zip(normals);
            let sum: DVec3 = terms
                .map(|(weight, normal)| f64::from(weight) * arc(mean, normal.as_dvec3()))
                .sum();
            assert!(sum.length() < 1e-6, "{weights:?} {normals:?} {sum}");
        }
    }
}
