//! The commands' options of light, and the lights that `info` lists.

use crate::folder::Folder;
use glam::{UVec2, Vec3};
use hitscope_core::film::Noise;
use hitscope_lab::commands::{InfoArgs, RenderArgs, Rendered};
use serde_json::json;

/// A sphere in the middle of the picture, without a light.
const DARK: &str = r#"<sensor type="perspective"><float name="fov" value="40"/>
  <transform name="to_world"><lookat origin="0,0,10" target="0,0,0" up="0,1,0"/></transform>
  <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/></film></sensor>
<shape type="sphere"><bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>"#;

fn folder(contents: &str) -> Folder {
    let folder = Folder::new();
    let text = format!("<scene version=\"3.0.0\">{contents}</scene>");
    folder.write("scene.xml", &text);
    folder
}

fn rendered(folder: &Folder, options: &str) -> Rendered {
    let line = format!("@scene.xml -o @out.png --samples 4 {options}");
    let args = folder.args::<RenderArgs>(&line);
    args.trace().expect("rendered")
}

/// The radiance of a pixel beside the sphere and of one on it.
fn corner_and_middle(rendered: &Rendered) -> [Vec3; 2] {
    [UVec2::ZERO, UVec2::splat(8)].map(|pixel| rendered.film.radiance(pixel).expect("traced"))
}

#[test]
fn an_environment_replaces_that_of_the_file() {
    let folder = folder(&format!("<emitter type='constant'/>{DARK}"));
    let [corner, middle] = corner_and_middle(&rendered(&folder, "--view direct"));
    assert_eq!(corner, Vec3::ONE);
    // The file's reflectance is 0.5; every direction from a sphere is open.
    assert!((middle - 0.5).abs().max_element() < 1e-5, "{middle}");
    let option = "--integrator direct --environment constant:0.25,0.5,2";
    let [corner, middle] = corner_and_middle(&rendered(&folder, option));
    assert_eq!(corner, Vec3::new(0.25, 0.5, 2.0));
    let expected = 0.5 * corner;
    assert!((middle - expected).abs().max_element() < 1e-5, "{middle}");
}

#[test]
fn the_sky_of_an_environment_is_above_the_scene_if_the_z_axis_points_up() {
    let z_up = DARK
        .replace("0,0,10", "0,-10,0")
        .replace("up=\"0,1,0\"", "up=\"0,0,1\"");
    let folder = folder(&z_up);
    // White above and black below.
    let mut sky = b"#?RADIANCE\n\n-Y 2 +X 1\n".to_vec();
    sky.extend([128, 128, 128, 129, 0, 0, 0, 0]);
    std::fs::write(folder.path("sky.hdr"), sky).expect("written");
    let corners = |options: &str| {
        let options = format!("--view direct --environment @sky.hdr {options}");
        let film = rendered(&folder, &options).film;
        [0, 15].map(|y| film.radiance(UVec2::new(0, y)).expect("traced").x)
    };
    // The horizon is grey. Half of the angle of view, 20°, is a ninth of the way from pole to pole.
    let [above, below] = corners("");
    assert!(above - below > 0.1, "{above} {below}");
    // Seen from below, the zenith is in the middle of the picture.
    let [above, below] = corners("--environment-up y");
    assert!((above - below).abs() < 0.02, "{above} {below}");
    // The rotation is about the vertical axis, along which this sky changes.
    let [above, below] = corners("--rotation 90");
    assert!(above - below > 0.1, "{above} {below}");
    let args = folder.args::<RenderArgs>("@scene.xml -o @out.png --view path --environment-up z");
    let error = args.trace().err().expect("refused").to_string();
    assert!(error.contains("--environment FILE"), "{error}");
}

#[test]
fn a_scene_without_a_light_is_lit_by_white_light() {
    for view in ["direct", "path"] {
        let rendered = rendered(&folder(DARK), &format!("--view {view}"));
        let [corner, middle] = corner_and_middle(&rendered);
        assert_eq!(corner, Vec3::ONE);
        assert!(middle.min_element() > 0.4, "{middle}");
    }
}

#[test]
fn the_studio_is_ambient_light_and_lamps() {
    let rendered = rendered(&folder(DARK), "--view direct --environment studio");
    let [corner, middle] = corner_and_middle(&rendered);
    assert!((corner - 0.1).abs().max_element() < 1e-6, "{corner}");
    assert!(middle.min_element() > 0.1, "{middle}");
}

#[test]
fn exposure_multiplies_light_before_it_is_encoded() {
    let folder = folder(DARK);
    let dim = rendered(
        &folder,
        "--view direct --environment constant:0.25 --exposure 1",
    );
    let bright = rendered(&folder, "--view direct --environment constant:0.5");
    assert_eq!(dim.film.pixels(), bright.film.pixels());
}

#[test]
fn exposure_and_tone_change_neither_the_background_nor_views_without_light() {
    let lamp = "<emitter type='directional'><vector name='direction' value='0 0 -1'/></emitter>";
    let folder = folder(&format!("{lamp}{DARK}"));
    for view in ["direct", "whitted", "path"] {
        let colours = |options: &str| {
            let rendered = rendered(&folder, &format!("--view {view} {options}"));
            let pixels = rendered.film.pixels();
            [pixels[0], pixels[8 * 16 + 8]]
        };
        let ([background, dim], exposed) = (colours(""), colours("--exposure 3 --tone neutral"));
        assert_eq!(exposed[0], background, "{view}");
        assert!(exposed[1][0] > dim[0], "{view}");
    }
    let args = |options: &str| {
        let line = format!(
            "@scene.xml -o @out-{{view}}.png --samples 1 --view normal --view path {options}"
        );
        folder.args::<RenderArgs>(&line).trace().expect("rendered")
    };
    let normals = args("--exposure 3");
    assert!(normals.film.pixels() == args("").film.pixels());
}

#[test]
fn the_integrator_of_a_scene_file_is_the_default_view() {
    let folder = folder(&format!("<integrator type='normal'/>{DARK}"));
    let pixels = |options: &str| rendered(&folder, options).film.pixels().to_vec();
    assert_eq!(pixels(""), pixels("--view normal"));
    assert_ne!(pixels(""), pixels("--view depth"));
}

#[test]
fn the_depth_limit_is_that_of_the_file_unless_an_option_sets_it() {
    // Mitsuba's depth of 1 shows emitters alone.
    let depth = "<integer name='max_depth' value='1'/>";
    let folder = folder(&format!(
        "<integrator type='path'>{depth}</integrator><emitter type='constant'/>{DARK}"
    ));
    let middle = |options: &str| corner_and_middle(&rendered(&folder, options))[1];
    assert_eq!(middle(""), Vec3::ZERO);
    assert!(middle("--depth 1").min_element() > 0.4);
}

#[test]
fn occlusion_ends_at_the_distance() {
    let folder = folder(&format!(
        "{DARK}<shape type='disk'><transform name='to_world'><scale value='9'/><translate z='-1'/></transform></shape>"
    ));
    // Beside the sphere, near its contact with the disk.
    let mean = |options: &str| {
        let rendered = rendered(&folder, &format!("--view ao {options}"));
        let pixels = (0..256).map(|k| UVec2::new(k % 16, k / 16));
        let light = pixels.map(|pixel| rendered.film.radiance(pixel).expect("traced").x);
        light.sum::<f32>() / 256.0
    };
    assert!(mean("") < mean("--ao-distance 0.001"));
}

#[test]
fn an_offset_of_the_coordinates_shows_self_shadowing_and_keeps_the_picture() {
    let folder = Folder::new();
    // Slanted, so that points on it are rounded.
    folder.write(
        "slope.obj",
        "v -1 -1 -0.3\nv 1 -1 0.2\nv 1 1 0.7\nv -1 1 0.2\nf 1 2 3 4\n",
    );
    let trace = |view: &str, options: &str| {
        let line = format!(
            "@slope.obj -o @out.png --samples 4 --size 16x16 --eye 0.1,0.2,4 --target 0,0,0.2 --fov 30 --view {view} {options}"
        );
        folder.args::<RenderArgs>(&line).trace().expect("rendered")
    };
    let compared = |offset: &str| {
        let options = format!("--spawn combined --second-spawn fixed-epsilon {offset}");
        trace("spawning", &options).film.pixels().to_vec()
    };
    // Nothing shadows a slope. Near 10⁶, numbers are rounded to 1/16, far more than the fixed ε.
    let grey = |pixels: &[[u8; 4]]| {
        pixels
            .iter()
            .filter(|[r, g, b, _]| r == g && g == b)
            .count()
    };
    let (near, far) = (compared(""), compared("--offset 1e6,1e6,1e6"));
    assert!(grey(&far) < grey(&near), "{} {}", grey(&far), grey(&near));
    // The camera moves with the scene: a power of two keeps all bits of this view of hits.
    let hits = |options: &str| trace("normal", options).film.pixels().to_vec();
    let is_background =
        |pixels: &[[u8; 4]]| pixels.iter().map(|p| *p == pixels[0]).collect::<Vec<_>>();
    assert_eq!(
        is_background(&hits("")),
        is_background(&hits("--offset 0,0,16"))
    );
    let sphere = self::folder(DARK);
    let args = sphere.args::<RenderArgs>("@scene.xml -o @out.png --offset 1,2,3");
    let error = args.trace().err().expect("refused").to_string();
    assert!(
        error.starts_with("--offset moves scenes of triangle meshes"),
        "{error}"
    );
}

#[test]
fn two_spawn_policies_are_compared() {
    let folder = folder(DARK);
    let pixels = |options: &str| {
        let camera = "--eye 0,0,100 --target 0,0,0 --fov 4";
        let rendered = rendered(&folder, &format!("--view spawning {camera} {options}"));
        rendered.film.pixels().to_vec()
    };
    // At a distance of 100, many points are rounded by more than the fixed ε.
    assert_ne!(pixels(""), pixels("--second-spawn combined"));
    assert_eq!(pixels(""), pixels("--second-spawn fixed-epsilon"));
    let args =
        folder.args::<RenderArgs>("@scene.xml -o @out.png --view path --second-spawn nvidia");
    let error = args.trace().err().expect("refused");
    assert_eq!(
        error.to_string(),
        "--second-spawn has no effect on the view “path”: it needs --view spawning"
    );
}

#[test]
fn a_tone_curve_changes_bright_colours() {
    let folder = folder(DARK);
    let shown = |options: &str| {
        let options = format!("--view direct --environment constant:4 {options}");
        rendered(&folder, &options).film.pixels()[0]
    };
    assert_eq!(shown(""), [255; 4]);
    assert_eq!(shown("--tone clip"), [255; 4]);
    assert!(shown("--tone neutral")[0] < 255);
}

#[test]
fn the_environment_of_a_file_is_turned_by_an_option() {
    let folder = folder(DARK);
    // White around +z and black around −z, on two rows.
    let mut sky = "#?RADIANCE\n\n-Y 2 +X 4\n".as_bytes().to_vec();
    for _ in 0..2 {
        sky.extend([
            0, 0, 0, 0, 128, 128, 128, 129, 128, 128, 128, 129, 0, 0, 0, 0,
        ]);
    }
    std::fs::write(folder.write("sky.hdr", ""), sky).expect("written");
    // The camera looks along −z.
    let corner = |degrees: f32| {
        let line = format!(
            "@scene.xml -o @out.png --samples 4 --view direct --environment @sky.hdr --rotation {degrees}"
        );
        let rendered = folder.args::<RenderArgs>(&line).trace().expect("rendered");
        rendered.film.radiance(UVec2::ZERO).expect("traced").y
    };
    assert!(corner(0.0) < 0.5, "{}", corner(0.0));
    assert!(corner(180.0) > 0.5, "{}", corner(180.0));
}

#[test]
fn noise_is_that_of_the_samples() {
    let folder = folder(DARK);
    let even = rendered(
        &folder,
        "--view direct --environment constant:1 --eye 0,0,10 --target 0,0,20",
    );
    assert_eq!(even.noise(), Noise::default());
    let noise = |options: &str| {
        let options = format!("--view direct --environment {options}");
        rendered(&folder, &options).noise()
    };
    let studio = noise("studio");
    assert!(
        studio.mean > 0.0 && studio.worst > studio.mean,
        "{studio:?}"
    );
    // Neither exposure nor brighter light changes it.
    assert_eq!(noise("studio --exposure 5"), studio);
    let [dim, bright] = ["0.5", "2"].map(|light| noise(&format!("constant:{light}")));
    // Powers of two, and a few roundings.
    assert!((dim.mean - bright.mean).abs() < 1e-6, "{dim:?} {bright:?}");
}

#[test]
fn a_rotation_without_an_environment_map_is_refused() {
    let folder = folder(DARK);
    let args = folder.args::<RenderArgs>("@scene.xml -o @out.png --view path --rotation 90");
    let error = args.trace().err().expect("refused");
    assert!(error.is_usage());
    assert_eq!(
        error.to_string(),
        "--rotation has no effect: the scene has no picture of an environment"
    );
}

#[test]
fn options_that_the_view_of_a_scene_file_ignores_are_refused() {
    let folder = folder(&format!("<integrator type='normal'/>{DARK}"));
    let args = folder.args::<RenderArgs>("@scene.xml -o @out.png --environment studio");
    let error = args.trace().err().expect("refused");
    assert!(error.is_usage(), "{error}");
    assert!(error.to_string().contains("the view “normal”"), "{error}");
}

#[test]
fn info_lists_lights() {
    let folder = folder(
        r#"<emitter type="constant"><rgb name="radiance" value="1 2 3"/></emitter>
           <emitter type="point"><point name="position" value="1 2 3"/></emitter>
           <emitter type="directional"><vector name="direction" value="0 0 -2"/><float name="irradiance" value="4"/></emitter>
           <shape type="rectangle"><emitter type="area"><float name="radiance" value="5"/></emitter></shape>
           <shape type="rectangle"><emitter type="area"><float name="radiance" value="5"/></emitter>
             <transform name="to_world"><translate z="1"/></transform></shape>
           <shape type="disk"/>"#,
    );
    let info = folder.json(|f, out| f.args::<InfoArgs>("@scene.xml --json").run(out));
    let expected = json!([
        { "kind": "area", "radiance": [5.0, 5.0, 5.0], "emits_on_back": false, "primitives": 2, "area": 8.0 },
        { "kind": "constant", "radiance": [1.0, 2.0, 3.0] },
        { "kind": "point", "intensity": [1.0, 1.0, 1.0], "position": [1.0, 2.0, 3.0] },
        { "kind": "directional", "irradiance": [4.0, 4.0, 4.0], "direction": [-0.0, -0.0, -1.0] },
    ]);
    assert_eq!(info["lights"], expected);
    let text = folder.text(|f, out| f.args::<InfoArgs>("@scene.xml").run(out));
    let line = "light               area: 2 primitives, radiance [5, 5, 5], front, area 8\n";
    assert!(text.contains(line), "{text}");
    let none = folder.json(|f, out| f.args::<InfoArgs>("@cube.obj --json").run(out));
    assert_eq!(none["lights"], json!([]));
}
