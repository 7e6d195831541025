//! Textures of scene files: where they are placed, what is shared, and warnings.

use super::{Files, loaded};
use glam::{Vec2, Vec3};
use hitscope_core::Ray;
use hitscope_core::bsdf::Scatter as _;
use hitscope_core::interaction::texture_coordinates;
use hitscope_core::kernel::exact_triangle_kernel;
use hitscope_core::loading::LoadedScene;
use hitscope_core::mesh::Property;

/// A PNG of 2 by 1 texels: red on the left, blue on the right.
fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbImage::from_vec(2, 1, vec![255, 0, 0, 0, 0, 255]).expect("two texels");
    let written = picture.write_to(&mut bytes, image::ImageFormat::Png);
    written.expect("written");
    bytes.into_inner()
}

/// The diffuse colour that a ray straight down sees, without light.
fn colour_below(loaded: &LoadedScene, x: f32, y: f32) -> Vec3 {
    let scene = &loaded.scene;
    let ray = Ray::new(Vec3::new(x, y, 10.0), Vec3::NEG_Z).expect("a ray");
    let intersector = scene.intersector(exact_triangle_kernel());
    let hit = intersector.closest_hit(&ray).expect("a hit");
    let material = scene
        .mesh()
        .attributes()
        .materials
        .get(scene.material(hit.primitive));
    let sides = material
        .and_then(|m| m.sides.as_deref())
        .expect("a scene's material");
    let (slot, map) = sides.front.maps[0];
    let position = scene.surface(&ray, &hit).position;
    let uv = texture_coordinates(scene, position, &hit).expect("coordinates");
    let value = map.value(&scene.mesh().attributes().textures, uv);
    sides.front.bsdf.with(slot, value).colour()
}

#[test]
fn textures_are_placed_on_shapes_and_meshes() {
    let textured = "<bsdf type='diffuse'><ref name='reflectance' id='t'/></bsdf>";
    let files = Files::new(&format!(
        "<texture type='bitmap' id='t'><string name='filename' value='t.png'/>
           <string name='filter_type' value='nearest'/></texture>
         <shape type='rectangle'>{textured}</shape>
         <shape type='rectangle'>{textured}<transform name='to_world'><rotate z='1' angle='180'/>
           <translate x='10'/></transform></shape>
         <shape type='sphere'>{textured}<transform name='to_world'><rotate x='1' angle='90'/>
           <translate x='20'/></transform></shape>
         <shape type='obj'>{textured}<string name='filename' value='uv.obj'/></shape>"
    ));
    std::fs::write(files.folder.path().join("t.png"), png()).expect("written");
    let obj = "v 30 0 0\nv 31 0 0\nv 30 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
    std::fs::write(files.folder.path().join("uv.obj"), obj).expect("written");
    let scene = files.load().expect("a scene");
    assert_eq!(scene.report.warnings, []);
    assert!(
        scene
            .report
            .files
            .iter()
            .any(|path| path.ends_with("t.png"))
    );
    let (red, blue) = (Vec3::X, Vec3::Z);
    for (x, y, expected) in [
        (-0.5, 0.3, red),
        (0.5, 0.3, blue),
        (9.5, 0.3, blue),
        (10.5, 0.3, red),
        // Turned by 90° about x, the sphere shows its y towards +z, and its angles run from x over z.
        (20.5, 0.0, red),
        (19.5, 0.0, red),
        (30.2, 0.1, red),
        (30.8, 0.1, blue),
    ] {
        assert_eq!(colour_below(&scene, x, y), expected, "{x} {y}");
    }
}

#[test]
fn textures_that_cannot_be_shown_give_a_warning_with_their_line() {
    let board = "<texture name='reflectance' type='checkerboard'/>";
    let scene = loaded(&format!(
        "<shape type='cone'><bsdf type='diffuse'>{board}</bsdf></shape>
         <shape type='obj'><string name='filename' value='mesh.obj'/><bsdf type='diffuse'>{board}</bsdf></shape>
         <shape type='disk'><bsdf type='diffuse'>
         <texture name='reflectance' type='bitmap'><string name='filename' value='none.png'/></texture></bsdf></shape>
         <shape type='cone'><bsdf type='diffuse'>{board}</bsdf></shape>"
    ));
    let warnings: Vec<String> = scene
        .report
        .warnings
        .iter()
        .map(ToString::to_string)
        .collect();
    let without = |line: u32, kind: &str| {
        format!(
            "line {line}: a shape “{kind}” has a texture, but no texture coordinates; the parameter's default is used"
        )
    };
    assert_eq!(warnings[..2], [without(2, "cone"), without(3, "obj")]);
    assert_eq!(warnings.len(), 3);
    assert!(
        warnings[2].starts_with("line 5: texture "),
        "{}",
        warnings[2]
    );
    let end = "none.png: not found; the parameter's default is used";
    assert!(warnings[2].ends_with(end), "{}", warnings[2]);
}

#[test]
fn a_texture_gives_the_light_of_an_emitter() {
    let files = Files::new(
        "<shape type='rectangle'><emitter type='area'>
           <texture name='radiance' type='bitmap'><string name='filename' value='t.png'/></texture></emitter></shape>",
    );
    std::fs::write(files.folder.path().join("t.png"), png()).expect("written");
    let scene = files.load().expect("a scene");
    assert_eq!(scene.report.warnings, []);
    let materials = scene.scene.mesh().attributes().materials.entries();
    let material = &materials[scene.scene.material(0) as usize];
    assert_eq!(material.emission, Vec3::ONE);
    assert!(material.further_map(Property::Emission).is_some());
    let ray = Ray::new(Vec3::new(0.5, 0.0, 10.0), Vec3::NEG_Z).expect("a ray");
    let intersector = scene.scene.intersector(exact_triangle_kernel());
    let hit = intersector.closest_hit(&ray).expect("a hit");
    let position = scene.scene.surface(&ray, &hit).position;
    let uv = texture_coordinates(&scene.scene, position, &hit);
    // Texel centres are at ¼ and ¾.
    assert!((uv.expect("coordinates").x - 0.75).abs() < 1e-6);
}

/// An OBJ file with a texture, and texture coordinates v from 0 to 0.25.
fn textured(files: &Files) {
    let folder = files.folder.path();
    let obj = "mtllib t.mtl\nusemtl t\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0.25\nvt 0 0\nf 1/1 2/2 3/3\n";
    std::fs::write(folder.join("textured.obj"), obj).expect("written");
    std::fs::write(folder.join("t.mtl"), "newmtl t\nmap_Kd t.png\n").expect("written");
    let picture = image::RgbImage::from_pixel(64, 64, image::Rgb([255, 0, 0]));
    picture.save(folder.join("t.png")).expect("written");
}

#[test]
fn shapes_of_one_file_share_its_textures_and_flip_the_coordinates_alone() {
    let shape = |parts: &str| {
        format!("<shape type='obj'><string name='filename' value='textured.obj'/>{parts}</shape>")
    };
    let flipped = shape("<boolean name='flip_tex_coords' value='false'/>");
    let files = Files::new(&[shape(""), flipped, shape("<bsdf type='diffuse'/>")].concat());
    textured(&files);
    let scene = files.load().expect("a scene").scene;
    let attributes = scene.mesh().attributes();
    assert_eq!(attributes.textures.len(), 1);
    let material = |triangle: u32| attributes.materials.index(triangle);
    assert_eq!(material(0), material(1));
    assert_ne!(material(0), material(2));
    let second = |triangle: u32| attributes.texture_coordinates.of_triangle(triangle)[1];
    // As Mitsuba 3.9.1 shows the texture.
    assert_eq!(second(0), Some(Vec2::new(1.0, 0.25)));
    assert_eq!(second(1), Some(Vec2::new(1.0, 0.75)));
}
