//! Clean files give the same numbers as tobj.

use super::{STRICT, load_path};
use glam::{DVec3, Vec2, Vec3};
use hitscope_core::TriangleMesh;
use hitscope_core::mesh::shapes::{Placement, sphere, torus};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// The data of a face's corner.
#[derive(Debug, PartialEq)]
struct Corner {
    position: DVec3,
    colour: Option<Vec3>,
    normal: Option<Vec3>,
    texture: Option<Vec2>,
}

/// The corners of every face, read by tobj.
fn faces_by_tobj(path: &Path) -> Vec<Vec<Corner>> {
    let options = tobj::LoadOptions {
        single_index: false,
        ..tobj::LoadOptions::default()
    };
    let (models, _) = tobj::load_obj(path, &options).expect("tobj reads it");
    let meshes = models.into_iter().map(|model| model.mesh);
    meshes.flat_map(|mesh| faces_of(&mesh)).collect()
}

fn faces_of(mesh: &tobj::Mesh) -> Vec<Vec<Corner>> {
    let three = |values: &[f64], k: u32| {
        let at = 3 * k as usize;
        values.get(at..at + 3).map(DVec3::from_slice)
    };
    let corner = |corner: usize| {
        let vertex = mesh.indices[corner];
        let normal = mesh.normal_indices.get(corner);
        let texture = mesh.texcoord_indices.get(corner);
        let texture = texture.map(|&k| [0, 1].map(|axis| mesh.texcoords[2 * k as usize + axis]));
        Corner {
            position: three(&mesh.positions, vertex).expect("a vertex"),
            colour: three(&mesh.vertex_color, vertex).map(|c| c.as_vec3()),
            normal: normal
                .and_then(|&k| three(&mesh.normals, k))
                .map(|n| n.as_vec3()),
            texture: texture.map(|[u, v]| Vec2::new(u as f32, v as f32)),
        }
    };
    // Listed only if a face doesn't have three corners.
    let arities = match &mesh.face_arities[..] {
        [] => vec![3; mesh.indices.len() / 3],
        arities => arities.to_vec(),
    };
    let mut start = 0;
    let face = |arity: u32| {
        let corners = start..start + arity as usize;
        start = corners.end;
        corners.map(corner).collect()
    };
    arities.into_iter().map(face).collect()
}

/// Compares the corners of each of hitscope's triangles with those of its face by tobj.
fn assert_same(path: &Path) {
    let loaded = load_path(path, STRICT).unwrap_or_else(|error| panic!("{error}"));
    let mesh = &loaded.mesh;
    let faces = faces_by_tobj(path);
    let in_fans: usize = faces.iter().map(|corners| corners.len() - 2).sum();
    let dropped = mesh.dropped.zero_area + mesh.dropped.non_finite;
    assert_eq!(
        mesh.triangles.len() + dropped,
        in_fans,
        "{}",
        path.display()
    );
    for (triangle, ours) in corners(mesh).enumerate() {
        let face = mesh.face_of(triangle as u32) as usize;
        for (k, ours) in ours.into_iter().enumerate() {
            let is_same = |theirs: &Corner| {
                let rounded = (theirs.position - mesh.origin).as_vec3();
                ours.position == mesh.in_file(rounded.as_dvec3())
                    && ours.colour == theirs.colour
                    && ours.normal == theirs.normal
                    && (mesh.textures.is_empty() || ours.texture == theirs.texture)
            };
            let theirs = &faces[face];
            let is_there = match theirs.len() {
                3 => is_same(&theirs[k]),
                _ => theirs.iter().any(is_same),
            };
            let place = path.display();
            assert!(
                is_there,
                "{place}, face {face}: {ours:?} isn't of {theirs:?}"
            );
        }
    }
}

fn corners(mesh: &TriangleMesh) -> impl Iterator<Item = [Corner; 3]> {
    (0..mesh.triangles.len()).map(|triangle| {
        [0, 1, 2].map(|k| {
            let vertex = mesh.triangles[triangle][k] as usize;
            let normal = mesh.corner_normals.get(triangle).map(|corners| corners[k]);
            let texture = mesh.corner_textures.get(triangle).map(|corners| corners[k]);
            Corner {
                position: mesh.in_file(mesh.positions[vertex].as_dvec3()),
                colour: mesh.colours.get(vertex).copied(),
                normal: normal.map(|index| mesh.normals[index as usize]),
                texture: texture.map(|index| mesh.texture_coordinates[index as usize]),
            }
        })
    })
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
    for &p in &mesh.positions {
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
    let count = mesh.positions.len() as i64;
    for (index, corners) in mesh.triangles.iter().enumerate() {
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

/// More triangles than one of tobj's lists gets.
#[test]
fn large_clean_files_give_the_same_numbers_as_tobj() {
    let folder = tempfile::tempdir().expect("a folder");
    let texel = super::files().join("texel.png");
    std::fs::copy(texel, folder.path().join("t.png")).expect("copied");
    let library = "newmtl a\nmap_Kd t.png\n";
    std::fs::write(folder.path().join("a.mtl"), library).expect("written");
    let path = folder.path().join("x.obj");
    let mesh = torus(300, 250, Placement::UNIT);
    assert!(mesh.triangles.len() > 2 << 16);
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
}

#[test]
fn quads_give_the_same_numbers_as_tobj() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("x.obj");
    let ball = sphere(3, Placement::UNIT);
    let mut text = written(
        &TriangleMesh {
            triangles: Vec::new(),
            ..ball.clone()
        },
        With::Nothing,
        DVec3::ZERO,
    );
    // The shape's triangles come in pairs, each pair a quad.
    for pair in ball.triangles.chunks(2) {
        let [[a, b, c], [_, d, e]] = [pair[0], pair[1]];
        let corners = if d == c { [a, b, c, e] } else { [a, d, b, c] };
        let [a, b, c, d] = corners.map(|vertex| vertex + 1);
        writeln!(text, "f {a} {b} {c} {d}").expect("memory");
    }
    std::fs::write(&path, text).expect("written");
    assert_same(&path);
}
