//! Files as programs write them, against the format's letter.

use super::STRICT;
use glam::Vec3;
use hitscope_core::mesh::Material;
use hitscope_core::obj::{self, Loaded};
use hitscope_core::progress::Progress;
use std::io;
use std::path::Path;

/// A triangle with texture coordinates, material `m` of `m.mtl`.
const TEXTURED: &str = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n";
const TEXEL: &[u8] = include_bytes!("files/texel.png");

/// Loads a text whose library is `library`; every picture is a texel.
fn load(text: &str, library: &str) -> Loaded {
    let files = |name: &str| match name {
        "m.mtl" => Ok(library.as_bytes().to_vec()),
        "wood #2.png" | "wood.png" => Ok(TEXEL.to_vec()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let progress = Progress::default();
    let loaded = obj::parse(
        text.as_bytes(),
        Path::new("x.obj"),
        STRICT,
        &files,
        &progress,
    );
    loaded.unwrap_or_else(|error| panic!("{error}"))
}

/// The material of the first triangle.
fn first_material(loaded: &Loaded) -> &Material {
    let material = loaded.mesh.attributes().materials.of(0);
    material.expect("a material")
}

/// The opacity of material `m` of a textured triangle, and the warnings.
fn opacity(library: &str) -> (f32, Vec<String>) {
    let loaded = load(TEXTURED, library);
    (first_material(&loaded).opacity, super::warnings(&loaded))
}

#[test]
fn a_transparency_of_1_in_every_material_means_opaque() {
    // As MeshLab, OpenMVS and texrecon wrote it.
    let (value, warnings) = opacity("newmtl m\nKd 1 0 0\nTr 1.0\nnewmtl n\nTr 1\n");
    assert_eq!(value, 1.0);
    assert_eq!(
        warnings,
        ["material library “m.mtl”: every material has “Tr 1” and no “d”; treated as opaque"]
    );
    // Another material is opaque, but no face has it.
    let (value, warnings) = opacity("newmtl m\nTr 1\nnewmtl n\nTr 0\n");
    assert_eq!(value, 1.0);
    assert_eq!(
        warnings,
        ["nothing would be visible; “Tr 1” treated as opaque"]
    );
    let (value, warnings) = opacity("newmtl m\nd 0\n");
    assert_eq!(value, 0.0);
    assert_eq!(
        warnings,
        ["nothing is visible: the material of every face has opacity 0"]
    );
    let (value, warnings) = opacity("newmtl m\nd 0.5\nTr 1\n");
    assert_eq!((value, warnings), (0.5, vec![]));
    // Half of the mesh is visible.
    let half = load(
        &format!("{TEXTURED}usemtl n\nf 1 2 3\n"),
        "newmtl m\nTr 1\nnewmtl n\n",
    );
    assert_eq!(first_material(&half).opacity, 0.0);
    assert_eq!(half.report.warnings, []);
}

#[test]
fn values_above_1_are_clamped() {
    let library = "newmtl m\nKd 1.000001 0.5 0\nKs 1.5\nKe 7\nd 1.000001\n";
    let loaded = load(TEXTURED, library);
    let material = first_material(&loaded);
    assert_eq!(material.diffuse, Some(Vec3::new(1.0, 0.5, 0.0)));
    assert_eq!(material.specular, Vec3::ONE);
    assert_eq!(material.emission, Vec3::splat(7.0));
    assert_eq!(material.opacity, 1.0);
    let clamped = |keyword: &str, line: u32| {
        format!(
            "material library “m.mtl”: 1 “{keyword}” statement with a value above 1 clamped, on line {line}"
        )
    };
    let expected = [clamped("Kd", 2), clamped("Ks", 3), clamped("d", 5)];
    assert_eq!(super::warnings(&loaded), expected);
}

#[test]
fn black_reflectance_does_not_hide_a_texture() {
    let loaded = load(TEXTURED, "newmtl m\nKd 0 0 0\nmap_Kd wood.png\n");
    let material = first_material(&loaded);
    assert_eq!(material.diffuse, Some(Vec3::ONE));
    assert_eq!(
        super::warnings(&loaded),
        ["material library “m.mtl”: material “m”: “Kd 0” would hide the texture; treated as 1"]
    );
    let black = load(TEXTURED, "newmtl m\nKd 0\n");
    assert_eq!(first_material(&black).diffuse, Some(Vec3::ZERO));
    assert_eq!(black.report.warnings, []);
}

#[test]
fn a_number_sign_in_a_texture_name_begins_a_comment_only_if_no_such_file_exists() {
    for (map, is_found) in [
        ("wood #2.png", true),
        ("wood.png # a comment", true),
        ("oak.png # a comment", false),
    ] {
        let loaded = load(TEXTURED, &format!("newmtl m\nKd 1\nmap_Kd {map}\n"));
        assert_eq!(loaded.mesh.attributes().textures.len(), 1, "{map}");
        assert_eq!(
            loaded.report.warnings.is_empty(),
            is_found,
            "{map}: {:?}",
            loaded.report.warnings
        );
    }
}

#[test]
fn keywords_and_materials_are_found_in_another_case() {
    let library = "NEWMTL M\nKD 1 0 0\nmap_KD wood.png\n";
    let loaded = load(&TEXTURED.replace('v', "V").replace('f', "F"), library);
    let material = first_material(&loaded);
    assert_eq!(material.diffuse, Some(Vec3::X));
    assert!(material.diffuse_map.is_some());
    assert_eq!(loaded.report.warnings, []);
    // The exact name counts first.
    let both = load(TEXTURED, "newmtl M\nKd 1 0 0\nnewmtl m\nKd 0 1 0\n");
    assert_eq!(first_material(&both).diffuse, Some(Vec3::Y));
}

#[test]
fn numbers_that_are_not_finite_are_read_in_any_form() {
    for word in ["-nan(ind)", "nan(snan)", "1.#QNAN", "-1.#IND00", "1.#INF"] {
        let text = format!(
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv {word} 0 0\nvn {word} 0 0\nvt {word} 0\n\
             f 1/1/1 2/1/1 3/1/1\nf 1 2 4\n"
        );
        let loaded = load(&text, "");
        assert_eq!(loaded.mesh.triangles().len(), 1, "{word}");
        assert_eq!(loaded.report.dropped.non_finite, 1, "{word}");
    }
}

#[test]
fn indices_of_lists_that_the_file_does_not_have_are_ignored() {
    for (corner, what, entries) in [
        ("1/1", "texture", "texture coordinates"),
        ("1/-1", "texture", "texture coordinates"),
        ("1//1", "normal", "normals"),
        ("1//0", "normal", "normals"),
    ] {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf {corner} 2 3\n");
        let loaded = load(&text, "");
        assert_eq!(loaded.mesh.triangles().len(), 1);
        assert_eq!(
            super::warnings(&loaded),
            [format!(
                "line 4: faces have {what} indices, but the file has no {entries}"
            )]
        );
    }
}

/// A tower of a hundred quads in UTM coordinates.
fn tower() -> String {
    use std::fmt::Write as _;
    let mut text = String::new();
    for level in 0..=25 {
        for (x, y) in [(0.0, 0.0), (0.37, 0.0), (0.37, 0.29), (0.0, 0.29)] {
            let (x, y, z) = (
                500_000.12 + x,
                5_600_000.45 + y,
                100.7 + 0.21 * f64::from(level),
            );
            writeln!(text, "v {x} {y} {z}").expect("memory");
        }
    }
    for level in 0..25 {
        for k in 0..4 {
            let (a, b) = (4 * level + k + 1, 4 * level + (k + 1) % 4 + 1);
            writeln!(text, "f {a} {b} {} {}", b + 4, a + 4).expect("memory");
        }
    }
    text
}

#[test]
fn a_few_stray_elements_do_not_cost_a_survey_its_detail() {
    let alone = load(&tower(), "");
    assert!(
        alone.report.max_rounding < 1e-6,
        "{}",
        alone.report.max_rounding
    );
    for (stray, is_far) in [
        ("v 0 0 0\np -1\n", false),
        ("v 0 0 0\nv 0.1 0 0\nl -1 -2\n", true),
        ("v 0 0 0\nf -1 -1 -1\n", false),
        ("v 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf -1 -2 -3\n", true),
    ] {
        let loaded = load(&format!("{}{stray}", tower()), "");
        let mesh = &loaded.mesh;
        assert_eq!(mesh.origin(), alone.mesh.origin(), "{stray}");
        assert_eq!(
            mesh.positions()[..104],
            alone.mesh.positions()[..],
            "{stray}"
        );
        let says_so =
            |warning: &String| warning.contains("far from the rest of the mesh, rounded by up to");
        assert_eq!(
            super::warnings(&loaded).iter().any(says_so),
            is_far,
            "{stray}"
        );
    }
    // The same, if the surface is a single triangle.
    let one = "v 500000.12 5600000.45 100.7\nv 500000.13 5600000.45 100.7\n\
               v 500000.12 5600000.46 100.7\nf 1 2 3\nv 0 0 0\nf 4 4 4\np 4\n";
    assert_eq!(load(one, "").mesh.triangles().len(), 1);
}
