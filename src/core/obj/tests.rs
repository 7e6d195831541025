//! Short texts that load, or are refused with a message.

use super::*;
use crate::mesh::NO_INDEX;
use crate::random::Random;
use glam::{DVec3, Vec3};
use std::io;

fn load_text(text: &str) -> Result<Loaded, String> {
    load_bytes(text.as_bytes())
}

fn load_bytes(bytes: &[u8]) -> Result<Loaded, String> {
    let library = |name: &str| match name {
        "a b.mtl" => Ok(b"newmtl red\nKd 1 0 0\n".to_vec()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let progress = Progress::default();
    let path = Path::new("x.obj");
    let options = LoadOptions::default();
    parse(bytes, path, options, &library, &progress).map_err(|e| e.to_string())
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn errors_name_the_line_and_the_word() {
    let cases = [
        (
            "f 1 2 6148914691236517206",
            "x.obj:4:7: vertex index 6148914691236517206 is out of range",
        ),
        (
            "vn 0 0 1\nf 1//6148914691236517206 2//1 3//1",
            "x.obj:5:3: normal index 6148914691236517206 is out of range",
        ),
        (
            "f 1 2 4",
            "x.obj:4: vertex index 4 is out of range: there are 3",
        ),
        (
            "f 1 2 -4",
            "x.obj:4:7: vertex index -4 is out of range: there are 3",
        ),
        ("f 0 1 2", "x.obj:4:3: vertex index 0; indices start at 1"),
        (
            "vn 0 0 1\nf 1//-5 2 3",
            "x.obj:5:3: normal index -5 is out of range: there is 1",
        ),
        (
            "f 1//1 2//2 3//1\nvn 0 0 1",
            "x.obj:4: normal index 2 is out of range: there is 1",
        ),
        (
            "f 1/1/1/1 2 3",
            "x.obj:4:3: “1/1/1/1” has more parts than vertex/texture/normal",
        ),
        ("f 1.0 2 3", "x.obj:4:3: “1.0” is not an index"),
        ("f 1/x 2 3", "x.obj:4:3: “x” in “1/x” is not an index"),
        (
            "f 1 2",
            "x.obj:4: a face needs at least three corners; this one has 2",
        ),
        ("\nv 0 1,5 0\nf 1 2 3", "x.obj:5:5: “1,5” is not a number"),
        ("v 0 1\nf 1 2 3", "x.obj:4: “v” needs 3 numbers, found 2"),
        ("vn a b c", "x.obj:4:4: “a” is not a number"),
        (
            " v 0 1.2.3 0\nf 1 2 3",
            "x.obj:4:6: “1.2.3” is not a number",
        ),
        ("g é\nv é 1e 0\nf 1 2 3", "x.obj:5:3: “é” is not a number"),
        ("vn 0 1 1e\nf 1 2 3", "x.obj:4:8: “1e” is not a number"),
        ("l 1 2", "x.obj: no faces, only 1 line or point"),
        ("", "x.obj: no faces, only 3 vertices"),
        ("f 1 1 2", "x.obj:4: no triangles left: 1 with zero area"),
        (
            "v nan 0 0\nf 1 2 4",
            "x.obj:5: no triangles left: 1 with a corner that is NaN, infinite or too large for f32",
        ),
    ];
    for (statement, expected) in cases {
        let error = load_text(&format!("{TRIANGLE}{statement}\n")).expect_err(statement);
        assert_eq!(error, expected, "{statement}");
    }
}

#[test]
fn a_distant_mesh_keeps_its_detail() {
    let text = "v 4649776.25 30.125 -10000000.5\nv 4649777.25 30.125 -10000000.5\nv 4649776.25 31.1 -10000000.5\nf 1 2 3\n";
    let loaded = load_text(text).expect("good");
    let mesh = &loaded.mesh;
    assert_ne!(mesh.origin(), DVec3::ZERO);
    let file = |p: Vec3| p.as_dvec3() + mesh.origin();
    assert_eq!(
        file(mesh.positions()[0]),
        DVec3::new(4_649_776.25, 30.125, -10_000_000.5)
    );
    assert!(
        loaded.report.max_rounding < 1e-7,
        "{}",
        loaded.report.max_rounding
    );
}

#[test]
fn the_largest_rounding_of_a_coordinate_is_reported() {
    let loaded = load_text("v 0.1 0 0\nv 1 0.3 0\nv 0 1 0.75\nf 1 2 3\n").expect("good");
    // 0.3 errs by more than 0.1. Rounding decimals to f64 adds at most 2⁻⁵⁴.
    let expected = f64::from(0.3f32) - 0.3;
    let difference = (loaded.report.max_rounding - expected).abs();
    assert!(
        difference <= 2f64.powi(-54),
        "{}",
        loaded.report.max_rounding
    );
}

#[test]
fn an_ordinary_mesh_keeps_the_files_numbers() {
    let loaded = load_text(&format!("{TRIANGLE}f 1 2 3\n")).expect("good");
    assert_eq!(loaded.mesh.origin(), DVec3::ZERO);
    assert_eq!(loaded.report.max_rounding, 0.0);
}

#[test]
fn polygons_keep_their_id_and_diagonals_are_not_outlined() {
    let text = format!("{TRIANGLE}v 1 1 0\nf 1 2 3\nf 1 2 4 3\n");
    let mesh = load_text(&text).expect("good").mesh;
    assert_eq!([0, 1, 2].map(|t| mesh.face_of(t)), [0, 1, 1]);
    assert_eq!(
        [0, 1, 2].map(|t| mesh.attributes().faces.outline(t)),
        [0b111, 0b011, 0b110]
    );
    assert_eq!(mesh.face_count(), 2);
}

#[test]
fn faces_get_their_names_normals_and_materials() {
    let text = format!(
        "mtllib a b.mtl\nmtllib missing.mtl\n{TRIANGLE}vn 0 0 2\nf 1 2 3\ng left side #2\nusemtl red\nf 1//1 2//1 3//1\nusemtl blue\nf 1//1 2 3//1\nl 1 2\nl 2 3\ncurv 1\n"
    );
    let loaded = load_text(&text).expect("good");
    let mesh = &loaded.mesh;
    let material = |t: u32| mesh.attributes().materials.of(t).expect("one of the list");
    assert_eq!(
        [0, 1, 2].map(|t| material(t).name.as_str()),
        ["", "red", "blue"]
    );
    assert_eq!(material(1).diffuse, Some(Vec3::X));
    assert_eq!(material(2).diffuse, None);
    let attributes = mesh.attributes();
    let group = attributes.groups.of(1);
    assert_eq!(group.map(String::as_str), Some("left side #2"));
    let normals = [0, 1, 2].map(|t| attributes.normals.indices(t));
    assert_eq!(normals, [[NO_INDEX; 3], [0; 3], [0, NO_INDEX, 0]]);
    let warnings: Vec<String> = loaded
        .report
        .warnings
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(mesh.attributes().lines, [[0, 1], [1, 2]]);
    assert_eq!(warnings.len(), 3, "{warnings:?}");
    assert_eq!(warnings[0], "line 15: 1 “curv” statement ignored");
    assert!(warnings[1].starts_with("line 2: material library “missing.mtl”: "));
    assert_eq!(warnings[2], "1 undefined material, the first is “blue”");
}

#[test]
fn a_cancelled_load_is_an_error() {
    let progress = Progress::default();
    progress.cancel();
    let library = |_: &str| Err(io::ErrorKind::NotFound.into());
    let result = parse(
        TRIANGLE.as_bytes(),
        Path::new("x.obj"),
        LoadOptions::default(),
        &library,
        &progress,
    );
    assert!(matches!(result, Err(LoadError::Cancelled { .. })));
}

#[test]
fn an_endless_line_is_refused() {
    let library = |_: &str| Err(io::ErrorKind::NotFound.into());
    let progress = Progress::default();
    let result = parse(
        io::repeat(b'1'),
        Path::new("x.obj"),
        LoadOptions::default(),
        &library,
        &progress,
    );
    let error = result.expect_err("endless").to_string();
    assert!(
        error.starts_with("x.obj:1: the statement is longer than "),
        "{error}"
    );
    let zeros = parse(
        io::repeat(0),
        Path::new("x.obj"),
        LoadOptions::default(),
        &library,
        &progress,
    );
    assert!(zeros.expect_err("zeros").to_string().contains("binary"));
}

/// A file with everything that is resolved across chunks: indices of all kinds, names, smoothing groups, lines and points,
/// and statements that aren't read.
fn mixed_file(random: &mut Random) -> String {
    let (mut text, mut vertices) = (String::new(), 0);
    for _ in 0..400 {
        let [x, y, z] = [(); 3].map(|()| 1000.0 * random.unit());
        text += &format!("v {x:.3} {y:.3} {z:.3}\nvt {x:.1} {y:.1}\nvn {z:.1} 1 0\n");
        vertices += 1;
        let any = |random: &mut Random| 1 + random.index(vertices) as i64;
        let mut index = || any(random) - [0, vertices as i64 + 1][random.index(2)];
        let [a, b, c, d] = [(); 4].map(|()| index());
        text += &match random.index(10) {
            0 => format!("usemtl m{}\ng g{}\n", a.rem_euclid(9), b.rem_euclid(9)),
            1 => format!("s {}\n", a.rem_euclid(3)),
            2 => format!("l {a} {b}\np {c}\n"),
            3 => format!("curv {a}\nF {a}// \\\n {b}//{c} {c}\n"),
            4 => format!("f {a} {b} {c} {d}\n"),
            5 => format!("f {a}/{b} {b}/{a}/{c} {c}/{d}\n"),
            6 => format!("f {a} {b} {}\nf {a}/0 {b} {c}\n", 10_000),
            _ => format!("f {a}/{b}/{c} {b}/{c}/{d} {c}/{d}/{a} # {d}\n"),
        };
    }
    text
}

fn in_chunks(text: &str, chunk_size: usize) -> String {
    let progress = Progress::default();
    let options = LoadOptions {
        faults: FaultPolicy::Lenient,
        ..LoadOptions::default()
    };
    let mut steps = LoadSteps::default();
    let contents = parallel::read(
        text.as_bytes(),
        chunk_size,
        (&options, 0),
        &progress,
        &mut steps,
    )
    .expect("good");
    let none = NamedFiles(&|_| Err(io::ErrorKind::NotFound.into()));
    let loaded =
        assemble::assemble(contents, &options, &none, &progress, &mut steps).expect("a mesh");
    let Loaded { mesh, report } = loaded;
    let lines: Vec<usize> = (0..report.face_lines.count())
        .map(|face| report.face_lines.line(face))
        .collect();
    format!(
        "{mesh:?} {:?} {:?} {lines:?}",
        report.warnings, report.dropped
    )
}

#[test]
fn chunks_of_any_size_give_the_same_mesh() {
    let mut random = Random::new(31);
    for _ in 0..20 {
        let text = mixed_file(&mut random);
        let whole = in_chunks(&text, 1 << 20);
        for size in [64, 300, 5000] {
            assert!(in_chunks(&text, size) == whole, "chunks of {size} bytes");
        }
    }
}

/// A blank before a statement keeps it from being plain.
#[test]
fn plain_statements_are_read_as_others_are() {
    let mut random = Random::new(32);
    for _ in 0..50 {
        let mut text = mixed_file(&mut random);
        for number in [
            "+1",
            ".5",
            "1.",
            "1e3",
            "-1E-2",
            "0.30000000000000004",
            "123456789012345678901",
        ] {
            text += &format!(
                "v {number} 0 {number}\nvt {number} 1 2\nvt {number}\t0.5\nvn  0 {number} 1 \n"
            );
            text += "f -1 -2 -3\nf 1 2 3\t4\r\nf 5//6  7//8 9//10\n";
        }
        let indented: String = text.lines().map(|line| format!(" {line}\n")).collect();
        assert!(in_chunks(&text, 1 << 20) == in_chunks(&indented, 1 << 20));
    }
}

#[test]
fn a_comment_directly_after_a_number_does_not_continue() {
    let text = format!("{TRIANGLE}v 5 5 5# C:\\models\\\nf 1 2 3\n");
    let loaded = load_text(&text).expect("good");
    assert_eq!(
        (loaded.report.vertex_count, loaded.mesh.triangles().len()),
        (4, 1)
    );
}
