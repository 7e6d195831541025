//! Triangles projected along the dominant axis of their normal: precomputation shared by the kernels that
//! project.
//!
//! ```text
//!   y  C            P − A = u·(B − A) + v·(C − A), with the coordinate k left out:
//!   │ ╱ ╲           u = (p_x·c_y − p_y·c_x)/n_k,  v = (b_x·p_y − b_y·p_x)/n_k,
//!   A────B   x      where n_k = b_x·c_y − b_y·c_x is the normal's component along k.
//! ```
//!
//! u and v are linear in P − A, so each is the dot product of a row with P − A; component k of the row is 0.

use crate::lane::{Number, cross, longest_axis, minus};
use glam::Vec3;

/// Rows whose dot products with P − A are u, v, and the distance from the plane in units of n_k.
pub(super) struct Rows<N> {
    pub u: [N; 3],
    pub v: [N; 3],
    /// n/n_k.
    pub normal: [N; 3],
    pub a: [N; 3],
}

/// Computes the rows. They aren't finite for a triangle of zero area, which therefore is never hit.
pub(super) fn rows<N: Number>(corners: [Vec3; 3]) -> Rows<N> {
    let [a, b, c] = corners.map(|p| p.to_array().map(N::from));
    let (b, c) = (minus(&b, &a), minus(&c, &a));
    let normal = cross(&b, &c);
    let k = longest_axis(normal);
    let (x, y) = ((k + 1) % 3, (k + 2) % 3);
    let zero = N::from(0.0);
    let (mut u, mut v) = ([zero; 3], [zero; 3]);
    (u[x], u[y]) = (c[y] / normal[k], -c[x] / normal[k]);
    (v[x], v[y]) = (-b[y] / normal[k], b[x] / normal[k]);
    Rows {
        u,
        v,
        normal: normal.map(|n| n / normal[k]),
        a,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lane::dot;

    #[test]
    fn the_rows_map_each_corner_to_its_weights_for_every_dominant_axis() {
        let corners = [
            Vec3::new(1.0, 2.0, 3.0),
            Vec3::new(3.0, 2.5, 3.5),
            Vec3::new(1.5, 6.0, 2.75),
        ];
        for turn in 0..3 {
            let turned = corners.map(|p| Vec3::new(p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]));
            let rows = rows::<f64>(turned);
            for (corner, expected) in turned.iter().zip([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]) {
                let p = minus(&corner.to_array().map(f64::from), &rows.a);
                let found = [dot(&rows.u, &p), dot(&rows.v, &p), dot(&rows.normal, &p)];
                // Three products of numbers below 8 err by a few ulps.
                for (found, expected) in found.into_iter().zip([expected[0], expected[1], 0.0]) {
                    assert!((found - expected).abs() < 1e-14, "{turn}: {found}");
                }
            }
        }
    }
}
