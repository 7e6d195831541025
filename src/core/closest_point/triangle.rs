//! The point of a triangle that is nearest to a point.
//!
//! Source: Ericson, "Real-Time Collision Detection", 2005, 5.1.5: the triple products that tell whether the point lies
//!   over the triangle. Differs from it: where it doesn't, the nearest points of all three edges are compared, and the
//!   region isn't looked up by products of dot products, which lose twice as many digits on slivers.

use glam::DVec3;

/// The point of a triangle nearest to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestOnTriangle {
    /// The point.
    pub position: DVec3,
    /// The square of its distance.
    pub distance_squared: f64,
    /// Its barycentric coordinates for the corners A, B and C. None is negative.
    pub barycentric: [f64; 3],
}

/// The point of the triangle with these corners that is nearest to `p`.
///
/// At a corner the result is exact. Elsewhere the distance errs by a few ulps of the largest coordinate, and so does the
/// position unless the triangle is a sliver, along which it may err more. A triangle without area counts as its edges.
pub fn closest_on_triangle(p: DVec3, corners: [DVec3; 3]) -> ClosestOnTriangle {
    over_triangle(p, corners).unwrap_or_else(|| {
        let edges = [0, 1, 2].map(|k| on_edge(p, corners, k));
        let [first, second, third] = edges;
        let nearer = |a: ClosestOnTriangle, b: ClosestOnTriangle| {
            if b.distance_squared < a.distance_squared {
                b
            } else {
                a
            }
        };
        nearer(nearer(first, second), third)
    })
}

/// The foot of the perpendicular, if it lies in the triangle.
fn over_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> Option<ClosestOnTriangle> {
    let normal = (b - a).cross(c - a);
    // Twice the area of the triangle between an edge and the foot, times the normal's length.
    let area = |from: DVec3, to: DVec3| normal.dot((to - from).cross(p - from));
    let areas = [area(b, c), area(c, a), area(a, b)];
    let sum: f64 = areas.iter().sum();
    // False for NaN, too.
    if !(sum > 0.0 && areas.iter().all(|&area| area >= 0.0)) {
        return None;
    }
    let barycentric = areas.map(|area| area / sum);
    let height = normal.dot(p - a);
    Some(ClosestOnTriangle {
        position: a + barycentric[1] * (b - a) + barycentric[2] * (c - a),
        distance_squared: height * height / normal.length_squared(),
        barycentric,
    })
}

/// The nearest point of the edge from corner `k` to the next corner.
fn on_edge(p: DVec3, corners: [DVec3; 3], k: usize) -> ClosestOnTriangle {
    let (next, from) = ((k + 1) % 3, corners[k]);
    let edge = corners[next] - from;
    // NaN for an edge without length, which counts as its first end.
    let along = (p - from).dot(edge) / edge.length_squared();
    let mut barycentric = [0.0; 3];
    let position = if along >= 1.0 {
        barycentric[next] = 1.0;
        corners[next]
    } else if along > 0.0 {
        (barycentric[k], barycentric[next]) = (1.0 - along, along);
        from + along * edge
    } else {
        barycentric[k] = 1.0;
        from
    };
    ClosestOnTriangle {
        position,
        distance_squared: p.distance_squared(position),
        barycentric,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    const A: DVec3 = DVec3::ZERO;
    const B: DVec3 = DVec3::new(4.0, 0.0, 0.0);
    const C: DVec3 = DVec3::new(0.0, 4.0, 0.0);

    #[test]
    fn each_region_around_a_triangle_has_its_nearest_point() {
        for (p, nearest) in [
            // Over the triangle, and beyond each edge and each corner.
            (DVec3::new(1.0, 1.0, 5.0), DVec3::new(1.0, 1.0, 0.0)),
            (DVec3::new(2.0, -3.0, 1.0), DVec3::new(2.0, 0.0, 0.0)),
            (DVec3::new(-3.0, 1.0, -1.0), DVec3::new(0.0, 1.0, 0.0)),
            (DVec3::new(5.0, 5.0, 2.0), DVec3::new(2.0, 2.0, 0.0)),
            (DVec3::new(-1.0, -1.0, 1.0), A),
            (DVec3::new(6.0, -1.0, 1.0), B),
            (DVec3::new(-1.0, 6.0, 0.0), C),
            // On the triangle.
            (DVec3::new(1.0, 2.0, 0.0), DVec3::new(1.0, 2.0, 0.0)),
            (B, B),
        ] {
            let found = closest_on_triangle(p, [A, B, C]);
            assert_eq!(found.position, nearest, "{p}");
            assert_eq!(found.distance_squared, p.distance_squared(nearest), "{p}");
        }
    }

    #[test]
    fn no_other_point_of_a_triangle_is_nearer() {
        const CELLS: u32 = 40;
        let mut random = Random::new(7);
        for flatness in [1.0, 1e-3, 1e-7] {
            for _ in 0..200 {
                // Around the x axis: slivers, if flat.
                let mut corner = || DVec3::X * random.signed() + flatness * random.in_cube();
                let corners = [corner(), corner(), corner()];
                let p = 2.0 * random.in_cube();
                let found = closest_on_triangle(p, corners);
                let [l1, l2, l3] = found.barycentric;
                let position = l1 * corners[0] + l2 * corners[1] + l3 * corners[2];
                assert!((position - found.position).length() < 1e-14);
                let distance = found.distance_squared.sqrt();
                // Points of a grid on the triangle.
                let weight = |k: u32| f64::from(k) / f64::from(CELLS);
                let points = (0..=CELLS).flat_map(|i| (0..=CELLS - i).map(move |j| (i, j)));
                let distances = points.map(|(i, j)| {
                    let (u, v) = (weight(i), weight(j));
                    let on = (1.0 - u - v) * corners[0] + u * corners[1] + v * corners[2];
                    p.distance(on)
                });
                let least = distances.fold(f64::INFINITY, f64::min);
                // A few ulps of the coordinates, which are at most 3.
                assert!(
                    distance < least + 1e-14,
                    "{distance} {least} {corners:?} {p}"
                );
                assert!((p.distance(found.position) - distance).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn a_triangle_without_area_counts_as_its_edges() {
        let line = [A, B, 0.5 * B];
        let found = closest_on_triangle(DVec3::new(3.0, 2.0, 0.0), line);
        assert_eq!(found.position, DVec3::new(3.0, 0.0, 0.0));
        let point = closest_on_triangle(B, [A; 3]);
        assert_eq!((point.position, point.distance_squared), (A, 16.0));
    }
}
