//! Compares loaded meshes with the results of tobj, an independent OBJ reader.

use glam::{DVec3, Vec3};
use hitscope_core::TriangleMesh;
use hitscope_core::mesh::shapes::{Placement, sphere, torus};
use hitscope_core::obj::{self, LoadOptions};
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use hitscope_lab::second_opinion::{SecondOpinion, compare};
use rayon::prelude::*;
use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

fn assert_same(path: &Path) {
    let progress = Progress::default();
    let loaded = obj::load(path, LoadOptions::default(), &progress);
    let loaded = loaded.unwrap_or_else(|error| panic!("{error}"));
    let bytes = std::fs::read(path).expect("it was loaded");
    let opinion = compare(&bytes, &loaded.mesh, &loaded.report);
    assert_eq!(
        (&opinion.refused, &opinion.differences[..]),
        (&None, &[][..])
    );
    assert_eq!(opinion.triangles, loaded.mesh.triangles().len());
}

/// The data of a file of [`written`] besides positions and faces.
#[derive(Clone, Copy, PartialEq)]
enum With {
    Nothing,
    Colours,
    /// Negative indices, normals, texture coordinates, a texture, and groups.
    Everything,
}

fn written(mesh: &TriangleMesh, with: With, offset: DVec3) -> String {
    let mut text = String::new();
    for &p in mesh.positions() {
        let q = p.as_dvec3() + offset;
        write!(text, "v {} {} {}", q.x, q.y, q.z).expect("memory");
        if with == With::Colours {
            let c = p.abs().min(Vec3::ONE);
            write!(text, " {} {} {}", c.x, c.y, c.z).expect("memory");
        }
        text.push('\n');
        if with == With::Everything {
            writeln!(text, "vn {} {} {}\nvt {} {}", p.z, p.x, p.y, p.x, p.y).expect("memory");
        }
    }
    if with == With::Everything {
        text += "mtllib a.mtl\nusemtl a\n";
    }
    let count = mesh.positions().len() as i64;
    for (index, corners) in mesh.triangles().iter().enumerate() {
        if with == With::Everything && index % 1000 == 0 {
            writeln!(text, "g part {index}").expect("memory");
        }
        text.push('f');
        for &vertex in corners {
            let written = match with {
                With::Everything => {
                    let vertex = i64::from(vertex) - count;
                    write!(text, " {vertex}/{}/{vertex}", vertex + count + 1)
                }
                _ => write!(text, " {}", vertex + 1),
            };
            written.expect("memory");
        }
        text.push('\n');
    }
    text
}

/// Triangles of several chunks.
#[test]
fn large_clean_files_give_the_same_numbers_as_tobj() {
    let folder = tempfile::tempdir().expect("a folder");
    let texel = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/core/obj/files/texel.png");
    std::fs::copy(texel, folder.path().join("t.png")).expect("copied");
    let library = "newmtl a\nmap_Kd t.png\n";
    std::fs::write(folder.path().join("a.mtl"), library).expect("written");
    let path = folder.path().join("x.obj");
    let mesh = torus(300, 250, Placement::UNIT);
    assert!(mesh.triangles().len() > 2 << 16);
    for with in [With::Nothing, With::Colours, With::Everything] {
        for offset in [DVec3::ZERO, DVec3::new(5e6, -1e5, 3e6)] {
            std::fs::write(&path, written(&mesh, with, offset)).expect("written");
            assert_same(&path);
        }
    }
}

/// Also reads real meshes, if `HITSCOPE_MESHES` names a folder of them.
#[test]
fn files_written_by_programs_give_the_same_numbers_as_tobj() {
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    let folders = std::env::var_os("HITSCOPE_MESHES").map(PathBuf::from);
    let mut count = 0;
    for folder in folders.into_iter().chain([assets]) {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("readable").path();
            if path.extension().is_some_and(|extension| extension == "obj") {
                assert_same(&path);
                count += 1;
            }
        }
    }
    eprintln!("{count} files compared");
    assert!(count > 0, "the built-in scene is there");
}

#[test]
fn quads_give_the_same_numbers_as_tobj() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("x.obj");
    let ball = sphere(3, Placement::UNIT);
    let mut text = written(
        &TriangleMesh::new(ball.positions().to_vec(), Vec::new()),
        With::Nothing,
        DVec3::ZERO,
    );
    // The shape's triangles come in pairs, each pair a quad.
    for pair in ball.triangles().chunks(2) {
        let [[a, b, c], [_, d, e]] = [pair[0], pair[1]];
        let corners = if d == c { [a, b, c, e] } else { [a, d, b, c] };
        let [a, b, c, d] = corners.map(|vertex| vertex + 1);
        writeln!(text, "f {a} {b} {c} {d}").expect("memory");
    }
    std::fs::write(&path, text).expect("written");
    assert_same(&path);
}

/// Random faces of all kinds, mostly valid, in a form that tobj reads, too.
fn random_file(random: &mut Random) -> String {
    const NUMBERS: [&str; 12] = [
        "0",
        "-1",
        "1.5",
        ".25",
        "-2.",
        "+3",
        "1e-3",
        "7E2",
        "0.1",
        "123456.789",
        "1e400",
        "nan",
    ];
    let mut text = String::new();
    let (has_normals, has_textures) = (random.index(2) == 0, random.index(2) == 0);
    let ending = ["\n", "\r\n"][random.index(2)];
    let (mut vertices, mut normals, mut textures) = (0, 0, 0);
    for _ in 0..4 + random.index(56) {
        let mut number = || match random.index(3) {
            0 => NUMBERS[random.index(NUMBERS.len())].to_owned(),
            1 => format!("{}", random.unit()),
            _ => format!("{:.3e}", 1e3 * random.unit() - 500.0),
        };
        let [x, y, z] = [number(), number(), number()];
        let index = |random: &mut Random, count: usize| {
            let from_one = 1 + random.index(count) as i64;
            if random.index(4) == 0 {
                from_one - count as i64 - 1
            } else {
                from_one
            }
        };
        match random.index(8) {
            6 => write!(text, "usemtl m{}", random.index(3)),
            7 => write!(text, "s {}", random.index(3)),
            0..3 => {
                vertices += 1;
                write!(text, "v {x} {y}\t{z}")
            }
            3 if has_normals && (!has_textures || random.index(2) == 0) => {
                normals += 1;
                write!(text, "vn {x} {y} {z}")
            }
            4 => write!(text, "g part {}", random.index(3)),
            3 if has_textures => {
                textures += 1;
                write!(text, "vt {x} {y}")
            }
            _ if vertices > 0
                && (!has_normals || normals > 0)
                && (!has_textures || textures > 0) =>
            {
                text.push('f');
                for _ in 0..3 + random.index(4) / 3 * random.index(4) {
                    let vertex = index(random, vertices);
                    write!(text, "  {vertex}").expect("memory");
                    if has_textures {
                        write!(text, "/{}", index(random, textures)).expect("memory");
                    } else if has_normals {
                        text.push('/');
                    }
                    if has_normals {
                        write!(text, "/{}", index(random, normals)).expect("memory");
                    }
                }
                Ok(())
            }
            _ => write!(text, "# {x}"),
        }
        .expect("memory");
        text += ending;
    }
    text
}

/// `HITSCOPE_FUZZ` sets the number of files.
#[test]
fn random_files_give_the_same_numbers_as_tobj() {
    const FILES: u64 = 20_000;
    let files = std::env::var("HITSCOPE_FUZZ").ok();
    let files = files.and_then(|files| files.parse().ok()).unwrap_or(FILES);
    let none = |_: &str| Err(io::ErrorKind::NotFound.into());
    let (path, progress) = (Path::new("x.obj"), Progress::default());
    // The number of triangles that were compared; `None` if the file wasn't.
    let compared_triangles = |seed: u64| -> Option<u64> {
        let text = random_file(&mut Random::new(seed));
        let options = LoadOptions::default();
        let loaded = match obj::parse(text.as_bytes(), path, options, &none, &progress) {
            Ok(loaded) => loaded,
            Err(error) => {
                let message = error.to_string();
                let reasons = ["no triangles left", "no faces", "no vertices"];
                let is_empty = reasons.iter().any(|reason| message.contains(reason));
                assert!(is_empty, "seed {seed}: {message}\n{text}");
                return None;
            }
        };
        let opinion = compare(text.as_bytes(), &loaded.mesh, &loaded.report);
        assert_eq!(opinion.differences, [""; 0], "seed {seed}:\n{text}");
        opinion
            .refused
            .is_none()
            .then_some(opinion.triangles as u64)
    };
    let compared = (0..files).into_par_iter().filter_map(compared_triangles);
    let [compared, triangles] = compared
        .map(|triangles| [1, triangles])
        .reduce(|| [0, 0], |a, b| [a[0] + b[0], a[1] + b[1]]);
    eprintln!("{files} files, {compared} compared, with {triangles} triangles");
    assert!(compared > files * 2 / 5, "{compared} of {files}");
}

#[test]
fn a_file_that_tobj_reads_differently_or_not_at_all_is_reported() {
    let opinion = |text: &str| -> SecondOpinion {
        let none = |_: &str| Err(io::ErrorKind::NotFound.into());
        let (path, progress) = (Path::new("x.obj"), Progress::default());
        let loaded = obj::parse(
            text.as_bytes(),
            path,
            LoadOptions::default(),
            &none,
            &progress,
        );
        let loaded = loaded.expect("a mesh");
        compare(text.as_bytes(), &loaded.mesh, &loaded.report)
    };
    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let same = opinion(&format!("{TRIANGLE}f 1 2 3\n"));
    assert_eq!(
        (same.refused, same.triangles, same.difference_count),
        (None, 1, 0)
    );
    // tobj takes a polyline for a face.
    let line = opinion(&format!("{TRIANGLE}v 5 5 5\nl 2 3 4\nf 1 2 3\n"));
    assert!(
        line.difference_count > 0 && line.differences[0].starts_with("face 1, line 6: "),
        "{line:?}"
    );
    let comment = opinion(&format!("{TRIANGLE}f 1 2 3 # a comment\n"));
    assert!(comment.refused.is_some(), "{comment:?}");
}
