//! Tests of polygon triangulation: areas, holes, touching corners and crossings.

use super::*;

fn placed(corners: &[DVec3]) -> Vec<Vec3> {
    corners.iter().map(|p| p.as_vec3()).collect()
}

/// Triangulates a polygon in a slanted plane, away from the origin. Returns the outcome and the triangles' signed area.
fn cut(points: &[[f64; 2]]) -> (Cut, f64) {
    let place = |p: &[f64; 2]| DVec3::new(p[0] + 1e4, p[1], 0.3 * p[0] - 0.2 * p[1]);
    let corners: Vec<DVec3> = points.iter().map(place).collect();
    let mut area = 0.0;
    let progress = Progress::default();
    let mut triangulator = Triangulator::new();
    let how = triangulator.cut(&corners, &placed(&corners), &progress);
    for index in 0..triangulator.count() {
        let [a, b, c] = triangulator.triangle(index).map(|k| points[k]);
        area += ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
    }
    (how.expect("not cancelled"), area)
}

#[test]
fn the_triangles_have_the_polygons_area_and_winding() {
    let arrow = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]];
    let l_shape = [
        [0.0, 0.0],
        [2.0, 0.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
        [0.0, 2.0],
    ];
    let u_shape = [
        [0.0, 0.0],
        [3.0, 0.0],
        [3.0, 3.0],
        [2.0, 3.0],
        [2.0, 1.0],
        [1.0, 1.0],
        [1.0, 3.0],
        [0.0, 3.0],
    ];
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let cases: [(&[[f64; 2]], f64); 4] = [
        (&arrow, 1.0),
        (&l_shape, 3.0),
        (&u_shape, 7.0),
        (&square, 1.0),
    ];
    for (points, area) in cases {
        for reversed in [false, true] {
            let mut points = points.to_vec();
            if reversed {
                points.reverse();
            }
            let (how, found) = cut(&points);
            assert_eq!(how, Cut::Good);
            assert!((found.abs() - area).abs() < 1e-9, "{points:?}: {found}");
            assert_eq!(found < 0.0, reversed);
        }
    }
}

#[test]
fn a_polygon_that_crosses_itself_or_has_no_plane_becomes_a_fan() {
    assert_eq!(
        cut(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]).0,
        Cut::Fan
    );
    assert_eq!(
        cut(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]).0,
        Cut::Fan
    );
    let star: Vec<[f64; 2]> = (0..5)
        .map(|k| f64::from(k) * 4.0 * std::f64::consts::PI / 5.0)
        .map(|a| [a.cos(), a.sin()])
        .collect();
    assert_eq!(cut(&star).0, Cut::Fan);
}

/// A star with `count` corners.
fn star(count: u32) -> Vec<[f64; 2]> {
    let corner = |k: u32| {
        let angle = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
        let radius = if k.is_multiple_of(2) { 1.0 } else { 0.7 };
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..count).map(corner).collect()
}

#[test]
fn stars_of_any_size_are_triangulated() {
    for count in [FEW as u32 - 2, FEW as u32 + 2, 10_000] {
        let (how, area) = cut(&star(count));
        // One triangle per corner, with sides of length 1 and 0.7.
        let angle = std::f64::consts::TAU / f64::from(count);
        let expected = f64::from(count) * 0.5 * 0.7 * angle.sin();
        assert_eq!(how, Cut::Good);
        // Sums of n numbers of at most 1. Each has an error of a few times 2⁻⁵³ · 1e4, as the polygon is at x = 1e4.
        assert!((area - expected).abs() < 1e-8, "{area}, {expected}");
    }
    assert_eq!(cut(&star(LARGEST as u32 + 2)).0, Cut::Fan);
}

#[test]
fn a_fan_fits_a_large_circle_with_rounded_corners() {
    let count = 200_000;
    let corner = |k: u32| {
        let angle = f64::from(k) / f64::from(count) * std::f64::consts::TAU;
        let [x, y] = [angle.cos() as f32, angle.sin() as f32].map(f64::from);
        DVec3::new(x, y, 0.0)
    };
    let corners: Vec<DVec3> = (0..count).map(corner).collect();
    assert!(!is_convex(&corners) && fan_fits(&corners));
}

#[test]
fn triangulation_stops_when_cancelled() {
    let in_plane = |p: &[f64; 2]| DVec3::new(p[0], p[1], 0.0);
    let progress = Progress::default();
    progress.cancel();
    let corners: Vec<DVec3> = star(10_000).iter().map(in_plane).collect();
    let result = Triangulator::new().cut(&corners, &placed(&corners), &progress);
    assert!(matches!(result, Err(Cancelled)));
}

/// Asserts that every edge of a simple polygon belongs to exactly one triangle. Where corners share a vertex, this
/// fails for a triangle with the wrong one of them.
fn assert_edges_are_covered(points: &[[f64; 2]]) {
    let corners: Vec<DVec3> = points.iter().map(|p| DVec3::new(0.0, p[0], p[1])).collect();
    let count = corners.len();
    let mut covered = vec![0; count];
    let mut add = |t: [usize; 3]| {
        for (from, to) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            if to == (from + 1) % count {
                covered[from] += 1;
            }
        }
    };
    let progress = Progress::default();
    let mut triangulator = Triangulator::new();
    let how = triangulator.cut(&corners, &placed(&corners), &progress);
    (0..triangulator.count()).for_each(|index| add(triangulator.triangle(index)));
    assert_eq!(how.expect("not cancelled"), Cut::Good);
    assert!(covered.iter().all(|&times| times == 1), "{covered:?}");
}

/// A ring of `count` corners around a point. `direction` is the number of turns; negative values are clockwise.
fn ring(
    count: u32,
    centre: [f64; 2],
    radius: f64,
    direction: f64,
) -> impl Iterator<Item = [f64; 2]> {
    (0..count).map(move |k| {
        let angle = direction * f64::from(k) / f64::from(count) * std::f64::consts::TAU;
        [
            centre[0] + radius * angle.cos(),
            centre[1] + radius * angle.sin(),
        ]
    })
}

#[test]
fn holes_with_bridges_are_cut_out() {
    for count in [8, 60, 500] {
        // Two holes, both with a bridge from the first corner.
        let mut points: Vec<[f64; 2]> = ring(count, [0.0, 0.0], 10.0, 1.0).collect();
        for centre in [[5.0, -3.0], [5.0, 1.0]] {
            points.push(points[0]);
            let hole: Vec<[f64; 2]> = ring(count, centre, 1.5, -1.0).collect();
            points.extend(&hole);
            points.push(hole[0]);
        }
        let (how, area) = cut(&points);
        let ring_area = |radius: f64| {
            0.5 * f64::from(count)
                * radius
                * radius
                * (std::f64::consts::TAU / f64::from(count)).sin()
        };
        assert_eq!(how, Cut::Good);
        let expected = ring_area(10.0) - 2.0 * ring_area(1.5);
        // The same error bound as for stars.
        assert!((area - expected).abs() < 1e-8, "{area}, {expected}");
        assert_edges_are_covered(&points);
    }
}

#[test]
fn corners_may_touch_an_edge_or_another_corner() {
    // Teeth from above touch the bottom edge or the tips of teeth from below.
    for tip in [0.0, 1.0] {
        let mut points = vec![[0.0, 0.0]];
        for k in 0..FEW as u32 {
            let x = f64::from(3 * k);
            if tip > 0.0 {
                points.extend([[x + 1.0, 0.0], [x + 1.5, tip], [x + 2.0, 0.0]]);
            }
        }
        let end = f64::from(3 * FEW as u32);
        points.extend([[end, 0.0], [end, 5.0]]);
        for k in (0..FEW as u32).rev() {
            let x = f64::from(3 * k);
            points.extend([[x + 2.0, 5.0], [x + 1.5, tip], [x + 1.0, 5.0]]);
        }
        points.push([0.0, 5.0]);
        let (how, area) = cut(&points);
        assert_eq!(how, Cut::Good);
        let tooth = 0.5 * tip + 0.5 * (5.0 - tip);
        let expected = 5.0 * end - tooth * FEW as f64;
        assert!((area - expected).abs() < 1e-8, "{area}, {expected}");
    }
}

#[test]
fn delaunay_and_ear_clipping_give_equally_many_triangles() {
    let mut random = crate::random::Random::new(3);
    for count in [FEW + 1, 300, 1500] {
        let mut radius = || 0.2 + 0.8 * (random.index(1 << 20) as f64) / f64::from(1 << 20);
        let corner = |k: usize| {
            let angle = k as f64 / count as f64 * std::f64::consts::TAU;
            let radius = radius();
            DVec3::new(radius * angle.cos(), 7.0, radius * angle.sin())
        };
        let corners: Vec<DVec3> = (0..count).map(corner).collect();
        let (mut ears, mut delaunay) = (Triangulator::new(), Vec::new());
        assert!(ears.clip_ears(&corners));
        assert!(
            triangulated(&corners, [0.0; 2], &Progress::default(), &mut delaunay)
                .expect("not cancelled")
        );
        assert_eq!(delaunay.len(), ears.indices.len());
        let normal = vector_area(&corners);
        for triangle in delaunay.chunks_exact(3) {
            let triangle = [0, 1, 2].map(|k| corners[triangle[k] as usize]);
            assert!(vector_area(&triangle).dot(normal) > 0.0);
        }
    }
}

#[test]
fn large_self_crossing_polygons_become_a_fan() {
    let mut random = crate::random::Random::new(5);
    let count = 2500;
    let noise = (0..count).map(|_| [random.index(1000) as f64, random.index(1000) as f64]);
    assert_eq!(cut(&noise.collect::<Vec<_>>()).0, Cut::Fan);
    // Two turns around the same circle.
    for count in [200, 2000] {
        let twice = ring(count, [0.0, 0.0], 1.0, 2.0);
        assert_eq!(cut(&twice.collect::<Vec<_>>()).0, Cut::Fan);
        assert_eq!(
            cut(&ring(count, [0.0, 0.0], 1.0, 1.0).collect::<Vec<_>>()).0,
            Cut::Good
        );
    }
    // Two turns around circles of different radii.
    let twice = ring(101, [0.0, 0.0], 1.0, 1.0).chain(ring(101, [0.0, 0.0], 2.0, 1.0));
    assert_eq!(cut(&twice.collect::<Vec<_>>()).0, Cut::Fan);
    // A figure eight whose halves only touch.
    let eight = ring(101, [1.0, 0.0], -1.0, 1.0).chain(ring(101, [-1.0, 0.0], 1.0, -1.0));
    assert_eq!(cut(&eight.collect::<Vec<_>>()).0, Cut::Fan);
}
