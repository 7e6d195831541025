//! Textures in linear formats: their numbers reach the picture without decoding from sRGB.

use super::lamps::radiance;
use super::lit;
use exr::prelude::write_rgb_file;
use glam::{DVec3, Vec2, Vec3};
use hitscope_core::Ray;
use hitscope_core::loading::LoadedScene;
use hitscope_core::mesh::{Encoding, Sampling};
use hitscope_core::obj::LoadOptions;
use hitscope_core::progress::Progress;
use hitscope_core::scene::SceneOptions;
use std::path::Path;
use std::sync::Arc;

/// A lit square that emits and reflects by textures.
const OBJ: &str = "mtllib square.mtl\nvt 0.5 0.5\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl lamp\nf 1/1 2/1 3/1 4/1\n";

/// Writes pictures of one value each: `quarter.hdr`, `bright.exr` and `broken.exr`.
fn write_pictures(folder: &Path) {
    let mut quarter = b"#?RADIANCE\n\n-Y 1 +X 1\n".to_vec();
    // 128/256 · 2⁻¹.
    quarter.extend([128, 128, 128, 127]);
    std::fs::write(folder.join("quarter.hdr"), quarter).expect("written");
    let bright = folder.join("bright.exr");
    write_rgb_file(&bright, 1, 1, |_, _| (8.0_f32, -2.0_f32, 0.5_f32)).expect("written");
    let bytes = std::fs::read(&bright).expect("a file");
    std::fs::write(folder.join("broken.exr"), &bytes[..bytes.len() / 2]).expect("written");
}

fn load(folder: &Path, name: &str, text: &str) -> LoadedScene {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("written");
    let (load_options, options) = (LoadOptions::default(), SceneOptions::default());
    let loaded = LoadedScene::load(&path, load_options, options, &Progress::default());
    loaded.unwrap_or_else(|error| panic!("{error}"))
}

fn warnings(loaded: &LoadedScene) -> Vec<String> {
    let warnings = loaded.report.warnings.iter();
    warnings.map(ToString::to_string).collect()
}

/// The radiance of the square seen from above, without other lights than itself.
fn seen(loaded: LoadedScene) -> DVec3 {
    let scene = Arc::into_inner(loaded.scene).expect("no other owner");
    let context = lit(scene, loaded.lights);
    let ray = Ray::new(Vec3::new(0.25, 0.125, 1.0), Vec3::NEG_Z).expect("a ray");
    radiance(&context, "path", &ray).expect("a hit")
}

#[test]
fn textures_of_material_libraries_emit_and_reflect_their_linear_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    write_pictures(folder);
    let library = "newmtl lamp\nKd 1 1 1\nmap_Kd quarter.hdr\nKe 2 2 2\nmap_Ke bright.exr\nmap_Ks broken.exr\n";
    std::fs::write(folder.join("square.mtl"), library).expect("written");
    let loaded = load(folder, "square.obj", OBJ);
    let warnings = warnings(&loaded);
    assert_eq!(warnings.len(), 2, "{warnings:?}");
    assert!(
        warnings[0]
            .starts_with("texture “bright.exr”: 1 of 3 numbers in the picture can't be used")
    );
    assert!(
        warnings[1].starts_with("texture “broken.exr”: "),
        "{warnings:?}"
    );
    let textures = &loaded.scene.mesh().attributes().textures;
    for encoding in [Encoding::Srgb, Encoding::Linear] {
        let sampling = Sampling {
            encoding,
            ..Sampling::default()
        };
        let value = |k: usize| textures[k].value(Vec2::splat(0.5), sampling);
        assert_eq!(value(0), Vec3::splat(0.25));
        assert_eq!(value(1), Vec3::new(8.0, 0.0, 0.5));
    }
    assert_eq!(seen(loaded), 2.0 * DVec3::new(8.0, 0.0, 0.5));
}

#[test]
fn textures_of_scene_files_reflect_their_linear_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    write_pictures(folder.path());
    for (file, raw, expected) in [
        ("quarter.hdr", "false", DVec3::splat(0.25)),
        ("quarter.hdr", "true", DVec3::splat(0.25)),
        // A surface reflects no more than all light.
        ("bright.exr", "false", DVec3::new(1.0, 0.0, 0.5)),
    ] {
        let text = format!(
            "<scene version='3.0.0'><shape type='rectangle'><bsdf type='diffuse'><texture type='bitmap' name='reflectance'>
               <string name='filename' value='{file}'/><boolean name='raw' value='{raw}'/></texture></bsdf></shape>
             <emitter type='constant'/></scene>"
        );
        let found = seen(load(folder.path(), "scene.xml", &text));
        // Roundings of a few f32 numbers.
        assert!(
            (found - expected).abs().max_element() < 1e-6,
            "{file}: {found}"
        );
    }
}
