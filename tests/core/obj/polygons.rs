//! Closed meshes of polygons stay closed, wherever the polygons' corners lie.

use super::{STRICT, parse};
use glam::{DMat3, DQuat, DVec3};
use hitscope_core::Ray;
use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::mesh::{Flaw, Health};
use hitscope_core::obj::Loaded;
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use std::fmt::Write as _;

/// A prism over a random star-shaped outline, with further corners at random places on the outline's edges and on
/// upright ones; the text of its OBJ file.
///
/// Coordinates are multiples of 8 before the prism is turned, so that the further corners lie exactly on the edges.
fn prism(random: &mut Random, turn: DMat3) -> String {
    let count = 5 + random.index(9);
    let mut outline: Vec<DVec3> = Vec::new();
    for k in 0..count {
        let angle = std::f64::consts::TAU * (k as f64 + 0.6 * random.unit()) / count as f64;
        let radius = 200.0 + 1800.0 * random.unit();
        let p = 8.0 * (radius / 8.0 * DVec3::new(angle.cos(), angle.sin(), 0.0)).round();
        outline.push(p);
    }
    let mut corners = Vec::new();
    for k in 0..count {
        let (from, to) = (outline[k], outline[(k + 1) % count]);
        corners.push(from);
        for eighth in 1..8 {
            if random.index(6) == 0 {
                corners.push(from + (to - from) / 8.0 * f64::from(eighth));
            }
        }
    }
    let n = corners.len();
    let (mut text, mut face_text) = (String::new(), String::new());
    let heights = [-512.0, 0.0, 512.0];
    // The ring at the middle exists only at some corners.
    let has_middle: Vec<bool> = (0..n).map(|_| random.index(3) == 0).collect();
    let mut index = 0;
    let mut rings = [const { Vec::new() }; 3];
    for (ring, height) in rings.iter_mut().zip(heights) {
        for (corner, &has_middle) in corners.iter().zip(&has_middle) {
            if height == 0.0 && !has_middle {
                ring.push(0);
                continue;
            }
            let p = turn * (corner + height * DVec3::Z);
            writeln!(text, "v {} {} {}", p.x, p.y, p.z).expect("memory");
            index += 1;
            ring.push(index);
        }
    }
    let [bottom, middle, top] = rings;
    let mut face = |corners: &mut dyn Iterator<Item = usize>| {
        let words: Vec<String> = corners.map(|index| index.to_string()).collect();
        writeln!(face_text, "f {}", words.join(" ")).expect("memory");
    };
    face(&mut top.iter().copied());
    face(&mut bottom.iter().rev().copied());
    for k in 0..n {
        let next = (k + 1) % n;
        let side = [
            bottom[k],
            bottom[next],
            middle[next],
            top[next],
            top[k],
            middle[k],
        ];
        face(&mut side.into_iter().filter(|&index| index > 0));
    }
    text + &face_text
}

#[test]
fn prisms_with_concave_outlines_and_corners_on_edges_are_closed() {
    const PRISMS: usize = 10_000;
    const RAYS: usize = 100;
    let mut random = Random::new(21);
    let mut rays = 0;
    for k in 0..PRISMS {
        let axis = DVec3::from_array([(); 3].map(|()| random.unit() - 0.5));
        // Turned corners are rounded, so that those on an edge lie only nearly on it.
        let turn = if k % 2 == 0 {
            DMat3::IDENTITY
        } else {
            DMat3::from_quat(DQuat::from_axis_angle(axis.normalize(), random.unit()))
        };
        let text = prism(&mut random, turn);
        let Loaded { mesh, report } = parse(text.as_bytes(), STRICT).expect("a mesh");
        let health = Health::of(&mesh);
        for flaw in [Flaw::OpenEdge, Flaw::NonManifoldEdge, Flaw::FlippedEdge] {
            assert_eq!(health.places(flaw).count(), Some(0), "{flaw:?}:\n{text}");
        }
        assert_eq!(report.dropped.zero_area, 0, "{text}");
        // The outline is star-shaped about the origin, which is inside.
        let scene = scene(mesh);
        let (mesh, intersector) = (scene.mesh(), scene.intersector(default_triangle_kernel()));
        for _ in 0..RAYS {
            let [a, b, _] = mesh.corners(random.index(mesh.triangles().len()) as u32);
            let inside = mesh.origin().as_vec3() * -1.0;
            let target = a.lerp(b, random.unit() as f32) + 1e-4 * random.in_cube_f32();
            let Ok(ray) = Ray::new(inside, target - inside) else {
                continue;
            };
            assert!(intersector.any_hit(&ray), "{ray:?} leaves:\n{text}");
            rays += 1;
        }
    }
    assert!(rays > PRISMS * RAYS * 9 / 10, "{rays}");
}

/// A frame whose ends touch: a corner of one lies on an edge of the other. Its triangulation has more triangles than a fan,
/// for which no space was reserved.
#[test]
fn a_polygon_that_touches_itself_may_have_more_triangles_than_a_fan() {
    const CORNERS: [[f64; 2]; 12] = [
        [0.0, 2.0],
        [0.0, 0.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [0.0, 4.0],
        [0.0, 3.0],
        [0.45, 2.0],
        [1.0, 3.0],
        [3.0, 3.0],
        [3.0, 1.0],
        [1.0, 1.0],
        [1.0, 2.0],
    ];
    // Enough for a Delaunay triangulation.
    const PER_EDGE: usize = 10;
    let (mut text, mut face) = (String::new(), "f".to_owned());
    for (k, start) in CORNERS.iter().enumerate() {
        let end = CORNERS[(k + 1) % CORNERS.len()];
        for step in 0..PER_EDGE {
            let along = |axis: usize| {
                start[axis] + (end[axis] - start[axis]) * step as f64 / PER_EDGE as f64
            };
            writeln!(text, "v {} {} 0", along(0), along(1)).expect("memory");
            write!(face, " {}", k * PER_EDGE + step + 1).expect("memory");
        }
    }
    let last = "f 11 21 31\n";
    let mesh = parse(format!("{text}{face}\n{last}").as_bytes(), STRICT)
        .expect("good")
        .mesh;
    let count = mesh.triangles().len() as u32;
    assert!(count as usize > CORNERS.len() * PER_EDGE - 2 + 1, "{count}");
    let area = |triangle: u32| {
        let [a, b, c] = mesh.corners(triangle).map(|p| p.as_dvec3());
        0.5 * (b - a).cross(c - a).z
    };
    // The frame without its hole and the gaps on both sides of the corner; and a triangle.
    let frame: f64 = (0..count - 1).map(area).sum();
    assert!((frame - (16.0 - 4.0 - 0.5)).abs() < 1e-6, "{frame}");
    assert_eq!((area(count - 1), mesh.face_of(count - 1)), (8.0, 1));
}

/// Two corners of these polygons lie one above the other, or nearly, so that a projection makes them one. Other corners lie
/// on a line.
#[test]
fn a_prism_with_corners_above_each_other_is_closed() {
    let step: Vec<[f64; 3]> = [
        [0.0, 0.0],
        [2.0, 0.0],
        [4.0, 0.0],
        [4.0, 4.0],
        [4.0, 4.0],
        [0.0, 4.0],
    ]
    .iter()
    .enumerate()
    .map(|(k, [x, y])| [*x, *y, if k == 4 { 0.01 } else { 0.0 }])
    .collect();
    // A star of so many corners that it gets a Delaunay triangulation, with a step after one of them.
    let star = |after: u32| -> Vec<[f64; 3]> {
        let corner = |k: u32| {
            let corner = k - u32::from(k > after);
            let angle = f64::from(corner) * std::f64::consts::TAU / 130.0;
            let radius = if corner.is_multiple_of(2) { 4.0 } else { 3.0 };
            let z = if k > after { 0.01 } else { 0.0 };
            // The outline returns to the height of its start.
            let z = z * f64::from(130 - corner) / f64::from(130 - after);
            [radius * angle.cos(), radius * angle.sin(), z]
        };
        (0..131).map(corner).collect()
    };
    let stars = [0, 1, 20, 33, 64, 65, 99, 100].map(star);
    for outline in stars.into_iter().chain([step]) {
        for up in [[1.0, 0.0, 5.0], [0.5, 0.25, 5.0]] {
            let text = prism_of(&outline, up);
            let mesh = parse(text.as_bytes(), STRICT).expect("a mesh").mesh;
            let open = Health::of(&mesh).places(Flaw::OpenEdge).count();
            assert_eq!(open, Some(0), "{text}");
        }
    }
}

/// A prism over an outline, extruded by `up`.
fn prism_of(outline: &[[f64; 3]], up: [f64; 3]) -> String {
    let (mut text, count) = (String::new(), outline.len());
    for top in [0.0, 1.0] {
        for p in outline {
            let [x, y, z] = [0, 1, 2].map(|axis| p[axis] + top * up[axis]);
            writeln!(text, "v {x:.3} {y:.3} {z:.3}").expect("memory");
        }
    }
    let face = |corners: &mut dyn Iterator<Item = usize>| {
        corners.fold("f".to_owned(), |face, corner| format!("{face} {corner}"))
    };
    let bottom = face(&mut (1..=count).rev());
    let top = face(&mut (count + 1..=2 * count));
    writeln!(text, "{bottom}\n{top}").expect("memory");
    for k in 0..count {
        let next = (k + 1) % count;
        let side = [k + 1, next + 1, count + next + 1, count + k + 1];
        writeln!(text, "{}", face(&mut side.into_iter())).expect("memory");
    }
    text
}
