//! `inspect --view --sample`: the path of a sample.

use crate::folder::Folder;
use glam::{UVec2, Vec3};
use hitscope_lab::commands::{InspectArgs, RenderArgs};
use serde_json::Value;

/// A bright sphere before a wall that it lights.
const SCENE: &str = r#"<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="40"/>
  <transform name="to_world"><lookat origin="0,0,10" target="0,0,0" up="0,1,0"/></transform>
  <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/></film></sensor>
<shape type="sphere"><emitter type="area"><rgb name="radiance" value="1 2 3"/></emitter></shape>
<shape type="rectangle"><bsdf type="twosided"><bsdf type="diffuse"/></bsdf>
  <transform name="to_world"><scale value="9"/><translate z="-2"/></transform></shape></scene>"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("scene.xml", SCENE);
    folder
}

fn path(folder: &Folder, options: &str) -> Value {
    let line = format!("@scene.xml --json {options}");
    folder.json(|f, out| f.args::<InspectArgs>(&line).run(out))["path"].clone()
}

fn rgb(light: &Value) -> Vec3 {
    let light = light.as_array().expect("three numbers");
    let number = |x: &Value| x.as_f64().expect("a number") as f32;
    Vec3::new(number(&light[0]), number(&light[1]), number(&light[2]))
}

#[test]
fn inspect_shows_the_path_of_a_sample_in_the_picture() {
    let folder = folder();
    let options = "--environment constant:0.5 --depth 3";
    let line = format!("@scene.xml -o @out.png --samples 1 --view path {options}");
    let picture = folder.args::<RenderArgs>(&line).trace().expect("a picture");
    for pixel in [UVec2::ZERO, UVec2::new(3, 8), UVec2::splat(8)] {
        let UVec2 { x, y } = pixel;
        let path = path(&folder, &format!("--pixel {x},{y} --view path {options}"));
        let in_picture = picture.film.radiance(pixel).expect("a sample");
        assert_eq!(rgb(&path["radiance"]), in_picture, "{pixel}");
        assert_eq!(path["sample"], 0);
        let vertices = path["vertices"].as_array().expect("a list");
        let light = vertices
            .iter()
            .map(|vertex| rgb(&vertex["emission"]) + rgb(&vertex["direct"]));
        let sum = light.sum::<Vec3>() + rgb(&path["from_afar"]);
        // Eight sums in another order than the path's.
        let most = 8.0 * f32::EPSILON * in_picture;
        assert!((sum - in_picture).abs().cmple(most).all(), "{pixel}");
    }
    let on_sphere = path(&folder, "--pixel 8,8 --view path");
    let first = &on_sphere["vertices"][0];
    assert_eq!(first["shape"], "sphere");
    assert_eq!(rgb(&first["emission"]), Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn the_view_of_a_path_is_named_or_that_of_the_file() {
    let folder = folder();
    let on_wall = "--pixel 3,8";
    assert_eq!(path(&folder, on_wall), Value::Null);
    let path = |options: &str| path(&folder, &format!("{on_wall} {options}"));
    assert_eq!(path("--sample 2")["view"], "path");
    assert_eq!(path("--sample 2")["sample"], 2);
    assert_ne!(
        path("--sample 2")["vertices"],
        path("--sample 3")["vertices"]
    );
    let direct = path("--view direct");
    assert_eq!(direct["view"], "direct");
    assert!(direct["vertices"].as_array().map(Vec::len) <= Some(2));
}

#[test]
fn the_text_of_a_path_has_a_line_for_each_vertex() {
    let folder = folder();
    let line = "@scene.xml --pixel 3,8 --sample 5";
    let text = folder.text(|f, out| f.args::<InspectArgs>(line).run(out));
    let path = path(&folder, "--pixel 3,8 --sample 5");
    let vertices = path["vertices"].as_array().expect("a list").len();
    let start = text.find("path of sample 5 in the view “path”");
    let lines: Vec<&str> = text[start.expect("a title")..].lines().collect();
    // Title, header, end and colour.
    assert_eq!(lines.len(), vertices + 4, "{text}");
    assert!(lines[2].contains("rectangle"), "{text}");
    let end = path["end"].as_str().expect("text");
    assert!(lines[vertices + 2].contains(end), "{text}");
}

#[test]
fn options_of_light_without_a_path_are_refused() {
    let folder = folder();
    let refused = |options: &str| {
        let line = format!("@scene.xml --pixel 3,8 {options}");
        let result = folder.args::<InspectArgs>(&line).run(&mut Vec::new());
        let error = result.expect_err(options);
        assert!(error.is_usage(), "{error}");
        error.to_string()
    };
    assert_eq!(
        refused("--environment studio"),
        "--environment has no effect: it needs --view or --sample"
    );
    assert!(refused("--view direct --depth 2").contains("--depth has no effect"));
    assert!(refused("--sample 1 --ao-distance 2").contains("--ao-distance has no effect"));
}
