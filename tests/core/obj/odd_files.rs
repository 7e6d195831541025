//! A file for each oddity, and its result.

use super::{STRICT, load, load_path, warnings};
use glam::{DVec3, Vec3};
use hitscope_core::mesh::{Crease, NO_INDEX, VertexNormals};
use hitscope_core::obj::Loaded;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// Files that contain one triangle in various notations.
#[test]
fn unusual_notations_are_read() {
    for name in [
        "mark.obj",
        "crlf.obj",
        "cr.obj",
        "continued.obj",
        "comments.obj",
        "latin1.obj",
        "utf16.obj",
        "spelling.obj",
        "early.obj",
        "no_textures.obj",
        "packed.obj.gz",
    ] {
        let loaded = load(name);
        assert_eq!(loaded.mesh.triangles().len(), 1, "{name}");
        let corners = loaded.mesh.corners(0);
        assert_eq!(corners, [Vec3::ZERO, Vec3::X, Vec3::Y], "{name}");
        let warned = usize::from(name == "no_textures.obj");
        assert_eq!(
            loaded.report.warnings.len(),
            warned,
            "{name}: {:?}",
            loaded.report.warnings
        );
    }
    for name in ["latin1.obj", "utf16.obj"] {
        assert_eq!(
            load(name).mesh.attributes().groups.entries(),
            ["", "café"],
            "{name}"
        );
    }
}

fn areas_by_group(loaded: &Loaded) -> BTreeMap<&str, f64> {
    let mesh = &loaded.mesh;
    let mut areas = BTreeMap::new();
    for triangle in 0..mesh.triangles().len() as u32 {
        let [a, b, c] = mesh.corners(triangle).map(Vec3::as_dvec3);
        // All polygons in the file are counterclockwise around +z.
        let area = 0.5 * (b - a).cross(c - a).dot(DVec3::Z);
        assert!(area > 0.0, "triangle {triangle} is flipped");
        let group = mesh.attributes().groups.of(triangle).expect("a group");
        *areas.entry(group.as_str()).or_default() += area;
    }
    areas
}

#[test]
fn concave_polygons_and_holes_keep_their_area_and_outline() {
    let loaded = load("concave.obj");
    let expected = [("arrow", 1.0), ("frame", 12.0), ("l", 3.0), ("u", 7.0)];
    assert_eq!(areas_by_group(&loaded), BTreeMap::from(expected));
    assert_eq!(warnings(&loaded), [""; 0]);
    let mesh = &loaded.mesh;
    assert_eq!(mesh.face_count(), 4);
    // The arrow: both triangles of face 0 have two of its edges and share the diagonal.
    let of_arrow = (0..2).map(|t| {
        (
            mesh.face_of(t),
            mesh.attributes().faces.outline(t).count_ones(),
        )
    });
    assert!(of_arrow.eq([(0, 2), (0, 2)]));
    // The frame's eight edges, without the bridge between its two squares.
    let of_frame = (0..mesh.triangles().len() as u32).filter(|&t| mesh.face_of(t) == 3);
    let edges: u32 = of_frame
        .map(|t| mesh.attributes().faces.outline(t).count_ones())
        .sum();
    assert_eq!(edges, 8);
}

#[test]
fn non_planar_polygons_are_triangulated_the_same_way_each_time() {
    let first = load("not_flat.obj");
    assert_eq!(
        warnings(&first),
        [
            "line 11: 1 polygon triangulated as a fan: self-intersecting, without a plane or with too many corners"
        ]
    );
    assert_eq!(first.mesh.triangles()[..2], [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(
        load("not_flat.obj").mesh.triangles(),
        first.mesh.triangles()
    );
}

#[test]
fn lines_and_points_are_stored_apart_from_faces() {
    let mesh = load("elements.obj").mesh;
    assert_eq!(mesh.triangles(), [[0, 1, 2]]);
    assert_eq!(
        mesh.attributes().lines,
        [[0, 1], [1, 3], [3, 4], [0, 1], [4, 3]]
    );
    assert_eq!(mesh.attributes().points, [3, 4]);
    // Unused vertices aren't kept.
    assert_eq!(mesh.positions().len(), 5);
    assert_eq!((mesh.face_of(0), mesh.face_count()), (0, 1));
}

#[test]
fn normals_are_read_where_present_and_computed_elsewhere() {
    let mesh = load("mixed.obj").mesh;
    let given = &mesh.attributes().normals;
    assert_eq!(given.indices(0), [0; 3]);
    assert_eq!(given.indices(2), [NO_INDEX; 3]);
    assert_eq!(given.indices(4), [0, NO_INDEX, NO_INDEX]);
    let normals = VertexNormals::of(&mesh, Crease::FromFile);
    assert_eq!(normals.of_triangle(&mesh, 0), [Vec3::Y; 3]);
    // The second quad's normals lean to the other side of the ridge where the quads meet.
    let right = normals.of_triangle(&mesh, 2);
    assert!(right[0].z > 0.9 && right[1].x > 0.7, "{right:?}");
}

#[test]
fn smoothing_groups_are_obeyed_across_seams() {
    let mesh = load("smoothing.obj").mesh;
    let normals = VertexNormals::of(&mesh, Crease::FromFile);
    // Corner 1 of the even triangles and corner 0 of the odd ones are at the ridge.
    let ridge = |roof: u32| {
        let [left, right] = [2 * roof, 2 * roof + 1].map(|t| normals.of_triangle(&mesh, t));
        [left[1], right[0]]
    };
    let [smooth, creased, flat] = [0, 1, 2].map(ridge);
    assert_eq!(smooth[0], smooth[1]);
    assert!((smooth[0] - Vec3::Z).length() < 1e-6, "{smooth:?}");
    let faces = [Vec3::new(-1.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 1.0)];
    for found in [creased, flat] {
        for (found, face) in found.into_iter().zip(faces) {
            assert!((found - face.normalize()).length() < 1e-6, "{found}");
        }
    }
}

#[test]
fn colours_stay_with_their_vertices() {
    let loaded = load("colours.obj");
    let expected = [Vec3::ONE, Vec3::X, Vec3::new(0.0, 0.5, 0.0), Vec3::ONE];
    assert_eq!(loaded.mesh.attributes().colours, expected);
    assert_eq!(warnings(&loaded), ["2 vertices without a colour are white"]);
    let all = load("all_coloured.obj");
    assert_eq!(all.mesh.attributes().colours, [Vec3::X, Vec3::Y, Vec3::Z]);
    assert_eq!(warnings(&all), [""; 0]);
}

#[test]
fn faces_with_a_non_finite_vertex_are_dropped_and_counted() {
    let loaded = load("not_finite.obj");
    assert_eq!(loaded.mesh.triangles().len(), 1);
    assert_eq!(loaded.report.dropped.non_finite, 4);
    assert_eq!(
        warnings(&loaded),
        ["line 8: 4 triangles dropped: a corner is not finite or too large"]
    );
}

#[test]
fn free_form_statements_are_named_and_counted() {
    let loaded = load("free_form.obj");
    assert_eq!(loaded.mesh.triangles().len(), 1);
    let ignored = [
        (5, 1, "cstype"),
        (6, 1, "deg"),
        (7, 2, "curv"),
        (9, 1, "parm"),
        (10, 1, "end"),
        (11, 1, "surf"),
    ];
    let expected = ignored.map(|(line, count, keyword)| {
        let ending = if count == 1 { "" } else { "s" };
        format!("line {line}: {count} “{keyword}” statement{ending} ignored")
    });
    assert_eq!(warnings(&loaded), expected);
}

/// Vertices a millimetre apart, as in a survey.
#[test]
fn a_millimetre_in_utm_coordinates_is_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("utm.obj");
    let mut text = String::new();
    for k in 0..3 {
        let x = f64::from(k) * 0.001;
        writeln!(text, "v {:.3} 4649776.000 100.000", 500_000.0 + x).expect("memory");
        writeln!(text, "v {:.3} 4649776.001 100.000", 500_000.0 + x).expect("memory");
    }
    text += "f 1 3 4 2\nf 3 5 6 4\n";
    std::fs::write(&path, text).expect("written");
    let loaded = load_path(Path::new(&path), STRICT).expect("good");
    let mesh = &loaded.mesh;
    assert!(
        loaded.report.max_rounding < 1e-9,
        "{}",
        loaded.report.max_rounding
    );
    let spelt: Vec<DVec3> = mesh
        .positions()
        .iter()
        .map(|&p| mesh.vertex_in_file(p))
        .collect();
    assert_eq!(spelt[0], DVec3::new(500_000.0, 4_649_776.0, 100.0));
    assert_eq!(spelt[5], DVec3::new(500_000.002, 4_649_776.001, 100.0));
}

/// Elements of every kind over several chunks.
#[test]
fn elements_of_many_kinds_keep_their_own_data() {
    let mut text = String::from("vn 0 0 1\nvt 0.5 0.5\n");
    let count = 70_000;
    for k in 0..count {
        // Three vertices per element; an unused one before every seventh; colours for some.
        let x = f64::from(k);
        if k % 7 == 0 {
            text += "v -9 -9 -9\n";
        }
        let colour = if k % 3 == 1 { " 1 0 0" } else { "" };
        writeln!(text, "v {x} 0 0{colour}\nv {x} 1 0\nv {x} 0 1").expect("memory");
        match k % 5 {
            0 => text += "f -3 -2 -1\n",
            1 => text += "f -3//1 -2//1 -1//1\n",
            2 => text += "f -3/1 -2/1 -1/1\n",
            3 => text += "l -3 -2\n",
            _ => text += "p -1\n",
        }
        if k % 1000 == 999 {
            text += "f -1 -2 999999999\n";
        }
    }
    let loaded = super::parse(text.as_bytes(), super::LENIENT).expect("good");
    let mesh = &loaded.mesh;
    assert_eq!(loaded.report.dropped.bad_index, 70);
    assert_eq!(
        (
            mesh.triangles().len(),
            mesh.attributes().lines.len(),
            mesh.attributes().points.len()
        ),
        (42_000, 14_000, 14_000)
    );
    // Lines use two vertices, points one.
    assert_eq!(mesh.positions().len(), 42_000 * 3 + 14_000 * 2 + 14_000);
    for triangle in 0..42_000 {
        let k = triangle / 3 * 5 + triangle % 3;
        let x = mesh.origin().x + f64::from(mesh.corners(triangle)[0].x);
        assert_eq!(x, f64::from(k), "triangle {triangle}");
        let normal = mesh.attributes().normals.indices(triangle);
        assert_eq!(normal, [if k % 5 == 1 { 0 } else { NO_INDEX }; 3]);
        let first = mesh.triangles()[triangle as usize][0] as usize;
        let colour = if k % 3 == 1 { Vec3::X } else { Vec3::ONE };
        assert_eq!(
            mesh.attributes().colours[first],
            colour,
            "triangle {triangle}"
        );
    }
    let x = |vertex: u32| mesh.origin().x + f64::from(mesh.positions()[vertex as usize].x);
    for (index, (ends, &point)) in mesh
        .attributes()
        .lines
        .iter()
        .zip(&mesh.attributes().points)
        .enumerate()
    {
        let k = 5.0 * index as f64;
        assert_eq!(
            [x(ends[0]), x(ends[1]), x(point)],
            [k + 3.0, k + 3.0, k + 4.0]
        );
    }
}
