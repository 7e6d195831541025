//! Material libraries and textures, and how files refer to them.

use super::{STRICT, load, load_path, warnings};
use glam::{Vec2, Vec3};
use hitscope_core::mesh::{Material, NO_INDEX};
use hitscope_core::obj::Loaded;
use std::collections::BTreeMap;

fn materials(loaded: &Loaded) -> BTreeMap<&str, &Material> {
    let materials = loaded.mesh.attributes().materials.entries().iter();
    materials.map(|m| (m.name.as_str(), m)).collect()
}

#[test]
fn unusual_materials_are_read_and_skipped_statements_are_reported() {
    let loaded = load("unusual.obj");
    let materials = materials(&loaded);
    assert_eq!(materials["grey"].diffuse, Some(Vec3::splat(0.5)));
    assert_eq!(materials["spectral"].diffuse, Some(Vec3::X));
    assert_eq!(materials["halo"].opacity, 0.5);
    assert_eq!(materials["dim"].opacity, 0.75);
    let map = materials["mapped"].diffuse_map.expect("a map");
    assert_eq!(
        map.transform.transform_point2(Vec2::ONE),
        Vec2::new(2.5, 2.0)
    );
    // Half of texel.png is red, half is green; (0.375, 0) of the surface maps to u = 1.25.
    let colour = map.value(&loaded.mesh.attributes().textures, Vec2::new(0.375, 0.0));
    assert_eq!(colour, Vec3::X);
    let skipped = ["Kd", "Ps", "Pc", "map_Ns", "illum", "map_Kd", "map_Kd -bm"];
    let warnings = warnings(&loaded);
    assert_eq!(warnings.len(), skipped.len(), "{warnings:?}");
    for (warning, keyword) in warnings.iter().zip(skipped) {
        let expected = format!("material library “unusual.mtl”: 1 “{keyword}” statement skipped");
        assert!(warning.starts_with(&expected), "{warning}");
    }
}

#[test]
fn libraries_are_found_by_several_names_odd_names_and_wrong_case() {
    let loaded = load("libraries.obj");
    assert_eq!(warnings(&loaded), [""; 0]);
    let materials = materials(&loaded);
    let diffuse = |name: &str| materials[name].diffuse;
    assert_eq!(diffuse("first"), Some(Vec3::X));
    assert_eq!(diffuse("second"), Some(Vec3::Y));
    assert_eq!(diffuse("spaced"), Some(Vec3::Z));
    assert_eq!(diffuse("inner"), Some(Vec3::new(1.0, 1.0, 0.0)));
    assert_eq!(diffuse("capital"), Some(Vec3::new(0.0, 1.0, 1.0)));
    // The library in the folder names a picture in the mesh's folder.
    assert_eq!(loaded.mesh.attributes().textures.len(), 1);
    let names: Vec<_> = loaded
        .report
        .files
        .iter()
        .filter_map(|path| path.file_name())
        .collect();
    assert!(names.contains(&"inner.mtl".as_ref()) && names.contains(&"texel.png".as_ref()));
}

#[test]
fn a_missing_library_or_texture_gives_a_warning_and_the_mesh_loads() {
    let loaded = load("missing.obj");
    let warnings = warnings(&loaded);
    assert_eq!(loaded.mesh.triangles().len(), 2);
    assert!(
        warnings[0].starts_with("line 1: material library “nowhere.mtl”: "),
        "{warnings:?}"
    );
    assert!(
        warnings[1].starts_with("texture “lost.png”: "),
        "{warnings:?}"
    );
    assert!(
        warnings[1].ends_with("; shown as a checkerboard"),
        "{warnings:?}"
    );
    assert_eq!(warnings[2], "1 undefined material, the first is “nobody”");
    // Missing files are listed, so that they can be watched.
    let looked_for = |name: &str| loaded.report.files.iter().any(|path| path.ends_with(name));
    assert!(looked_for("nowhere.mtl") && looked_for("lost.png"));
    let map = materials(&loaded)["picture"].diffuse_map.expect("a map");
    let of = |x| map.value(&loaded.mesh.attributes().textures, Vec2::new(x, 1.0 / 16.0));
    assert_ne!(of(1.0 / 16.0), of(3.0 / 16.0));
}

#[test]
fn a_library_read_earlier_is_not_reported_as_missing() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("x.obj");
    for (name, text) in [
        ("a.mtl", "newmtl a\nKd 1 0 0\n"),
        ("b.mtl", "newmtl b\nKd 0 1 0\n"),
        (
            "x.obj",
            "mtllib a.mtl b.mtl\nmtllib b.mtl a.mtl\nmtllib a.mtl c.mtl\n\
             v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl unused\n",
        ),
    ] {
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    let loaded = load_path(&path, STRICT).expect("good");
    let warnings = warnings(&loaded);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(
        warnings[0].starts_with("line 3: material library “c.mtl”: "),
        "{warnings:?}"
    );
    // Names that no face uses aren't among the mesh's materials.
    assert_eq!(loaded.mesh.named_material_count(), 2);
}

/// Quirks of files that other programs write.
#[test]
fn quirks_of_programs_are_understood() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).expect("written");
    };
    write(
        "a.mtl",
        "newmtl a\nKd 1 0 0\nnewmtl # 2\nKd 0 1 0\n\0\nnewmtl c\nKd 0 0 1\n",
    );
    write("two words.mtl", "newmtl spaced\nKd 1 1 0\n");
    write(
        "x.obj",
        "mtllib a.mtl two words.mtl # libraries\n# C:\\models\\\n\
         v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 0 0 51\nvn 0 0 0\nvn 0 0 1\n\
         usemtl a # red\nf 1//1 2//2 3//2 # c:\\\nusemtl # 2\nf 1 2 3\nusemtl c\nf 1 2 3\nusemtl spaced\nf 1 2 3\n",
    );
    let loaded = load_path(&folder.path().join("x.obj"), STRICT).expect("good");
    let mesh = &loaded.mesh;
    let diffuse = [0, 1, 2, 3].map(|t| mesh.attributes().materials.of(t).and_then(|m| m.diffuse));
    let yellow = Vec3::new(1.0, 1.0, 0.0);
    assert_eq!(diffuse, [Vec3::X, Vec3::Y, Vec3::Z, yellow].map(Some));
    assert_eq!(
        mesh.attributes().colours,
        [Vec3::X, Vec3::Y, Vec3::new(0.0, 0.0, 0.2)]
    );
    assert_eq!(mesh.attributes().normals.indices(0), [NO_INDEX, 1, 1]);
    let warnings = warnings(&loaded);
    assert_eq!(
        warnings,
        [
            "vertex colours above 1: interpreted as bytes",
            "1 normal is zero or not finite in the file; computed instead",
            "material library “a.mtl”: 1 unknown statement skipped, on line 5",
        ]
    );
}

#[cfg(unix)]
#[test]
fn libraries_in_the_folder_of_a_links_target_are_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let [there, here] = ["there", "here"].map(|name| folder.path().join(name));
    std::fs::create_dir(&there).expect("made");
    std::fs::create_dir(&here).expect("made");
    std::fs::write(there.join("a.mtl"), "newmtl a\nKd 1 0 0\n").expect("written");
    let text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    std::fs::write(there.join("x.obj"), text).expect("written");
    let link = here.join("x.obj");
    std::os::unix::fs::symlink(there.join("x.obj"), &link).expect("linked");
    let loaded = load_path(&link, STRICT).expect("good");
    assert_eq!(warnings(&loaded), [""; 0]);
    // A missing file may appear in either folder.
    std::fs::remove_file(there.join("a.mtl")).expect("removed");
    let loaded = load_path(&link, STRICT).expect("good");
    for folder in [there.canonicalize().expect("there"), here] {
        assert!(
            loaded.report.files.contains(&folder.join("a.mtl")),
            "{:?}",
            loaded.report.files
        );
    }
}

#[test]
fn colours_slightly_above_one_are_not_taken_as_bytes() {
    let text = "v 0 0 0 1 1 1.5\nv 1 0 0 0.5 0 0\nv 0 1 0 0 -1 nan\nf 1 2 3\n";
    let loaded = super::parse(text.as_bytes(), STRICT).expect("good");
    let expected = [Vec3::ONE, Vec3::new(0.5, 0.0, 0.0), Vec3::ZERO];
    assert_eq!(loaded.mesh.attributes().colours, expected);
    let expected = "2 vertex colours with a value outside 0 to 1: clamped; NaN becomes 0";
    assert_eq!(warnings(&loaded), [expected]);
}
