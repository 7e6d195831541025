//! The commands on scene files with shapes other than triangles.

use crate::folder::Folder;
use hitscope_lab::commands::{InfoArgs, InspectArgs, LabArgs, RenderArgs, TraceArgs};
use serde_json::{Value, json};

/// A sphere in front of a box, seen along −z by a sensor with a film of 30 × 20 pixels.
const SCENE: &str = r#"<scene version="3.0.0">
<sensor type="perspective"><float name="fov" value="40"/>
  <transform name="to_world"><lookat origin="0,0,10" target="0,0,0" up="0,1,0"/></transform>
  <film type="hdrfilm"><integer name="width" value="30"/><integer name="height" value="20"/></film></sensor>
<shape type="sphere"><point name="center" x="0" y="0" z="0"/><float name="radius" value="2"/></shape>
<shape type="cube"><transform name="to_world"><translate z="-5"/></transform></shape>
<shape type="cylinder"><point name="p0" x="6" y="0" z="0"/><point name="p1" x="6" y="0" z="-1"/><boolean name="capped" value="true"/></shape>
</scene>"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("scene.xml", SCENE);
    folder
}

fn inspected(folder: &Folder, pixel: &str) -> Value {
    let line = format!("@scene.xml --pixel {pixel} --size 21x21 --json");
    folder.json(|f, out| f.args::<InspectArgs>(&line).run(out))
}

fn lines(found: &Value) -> Vec<&str> {
    let lines = found["hit"]["formula"].as_array().expect("lines");
    lines.iter().filter_map(Value::as_str).collect()
}

#[test]
fn inspect_names_the_parameters_and_derives_t_of_a_sphere() {
    let found = inspected(&folder(), "10,10");
    let hit = &found["hit"];
    assert_eq!((&hit["shape"], &hit["t"]), (&"sphere".into(), &8.0.into()));
    let parameters = json!({ "centre": [0.0, 0.0, 0.0], "radius": 2.0 });
    assert_eq!(hit["parameters"], parameters);
    let lines = lines(&found);
    for line in [
        "r(t) = o + t d",
        "o = (0, 0, 10)",
        "d = (0, 0, -1)",
        "r = 2",
        "0 = (p − c)·(p − c) − r²",
        "p = r(t): 0 = (d·d) t² + 2 (f·d) t + f·f − r²",
        "0 = 1 t² − 20 t + 96",
        "discriminant: (-20)² − 4·1·96 = 16",
        "t1 = 8, t2 = 12",
        "r(8) = (0, 0, 2)",
    ] {
        assert!(lines.contains(&line), "{line} in {lines:#?}");
    }
}

#[test]
fn inspect_lists_all_crossings_of_the_ray() {
    let folder = folder();
    let found = inspected(&folder, "10,10");
    let crossings = found["crossings"].as_array().expect("a list");
    let shown = |crossing: &Value| json!([crossing["shape"], crossing["t"], crossing["side"]]);
    let shown: Vec<Value> = crossings.iter().map(shown).collect();
    let expected = json!([
        ["sphere", 8.0, "front"],
        ["sphere", 12.0, "back"],
        ["axis-aligned box", 14.0, "front"],
        ["axis-aligned box", 16.0, "back"]
    ]);
    assert_eq!(json!(shown), expected);
    assert_eq!(crossings[3]["position"], json!([0.0, 0.0, -6.0]));
    let line = "@scene.xml --pixel 10,10 --size 21x21";
    let text = folder.text(|f, out| f.args::<InspectArgs>(line).run(out));
    for part in [
        "4 crossings",
        "back  of axis-aligned box 1",
        "centre       [0.0, 0.0, 0.0]",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

#[test]
fn the_formula_of_a_box_has_the_planes_of_each_pair() {
    let folder = Folder::new();
    let scene = r#"<scene version="3.0.0"><shape type="cube"/></scene>"#;
    folder.write("cube.xml", scene);
    let line = "@cube.xml --pixel 0,0 --size 1x1 --eye 0.5,0.25,5 --target 0.5,0.25,0 --json";
    let found = folder.json(|f, out| f.args::<InspectArgs>(line).run(out));
    let lines = lines(&found);
    for line in [
        "x = min.x, max.x: parallel to the ray, which is between",
        "z = min.z, max.z: t_near = 4, t_far = 6",
        "t_near = max = 4",
        "t_far = min = 6",
    ] {
        assert!(lines.contains(&line), "{line} in {lines:#?}");
    }
}

#[test]
fn the_formula_of_a_capped_cylinder_has_an_equation_for_each_part() {
    let folder = Folder::new();
    let scene = r#"<scene version="3.0.0"><shape type="cylinder"><boolean name="capped" value="true"/></shape></scene>"#;
    folder.write("can.xml", scene);
    let line = "@can.xml --pixel 0,0 --size 1x1 --eye 0.5,0,5 --target 0.5,0,0 --json";
    let found = folder.json(|f, out| f.args::<InspectArgs>(line).run(out));
    let lines = lines(&found);
    assert_eq!(found["hit"]["parameters"]["capped"], true);
    assert_eq!(
        lines
            .iter()
            .filter(|line| line.starts_with("p = r(t): 0 = "))
            .count(),
        3
    );
    // Along the axis, the side is never met: |f × w|² − r²(w·w) = 0.25 − 1.
    for line in ["p = r(t): 0 = -0.75", "no real root", "t = 4", "t = 5"] {
        assert!(lines.contains(&line), "{line} in {lines:#?}");
    }
}

#[test]
fn the_formula_of_each_crossing_ends_at_that_crossing() {
    let folder = Folder::new();
    let sphere = r#"<scene version="3.0.0"><shape type="sphere"/></scene>"#;
    folder.write("ball.xml", sphere);
    folder.write("rays.txt", "0 0 5 0 0 -1\n");
    let line = "@ball.xml --rays @rays.txt --all --explain";
    let found = folder.json(|f, out| f.args::<TraceArgs>(line).run(out));
    let crossings = found["hits"].as_array().expect("a list");
    let last = |crossing: &Value| {
        let lines = crossing["formula"]
            .as_array()
            .and_then(|lines| lines.last());
        lines.cloned().expect("a line")
    };
    let last: Vec<Value> = crossings.iter().map(last).collect();
    assert_eq!(
        json!(last),
        json!(["r(4) = (0, 0, 1)", "r(6) = (0, 0, -1)"])
    );
}

#[test]
fn a_scenes_report_has_a_page_with_each_kernel_and_one_row_per_tier() {
    let folder = folder();
    let line = "--quick --scene @scene.xml --size 8x6 --out @report";
    let text = folder.text(|f, out| f.args::<LabArgs>(line).run(out));
    assert!(text.contains("Each row measures the whole scene"), "{text}");
    let count = |name: &str| {
        let mut words = text
            .lines()
            .filter_map(|line| line.split_whitespace().next());
        words.by_ref().filter(|&word| word == name).count()
    };
    for name in ["fast", "exact", "sphere-moved-origin", "cylinder-naive-f64"] {
        assert_eq!(count(name), 1, "{name} in {text}");
    }
    // These serve a tier.
    assert_eq!(count("sphere-hearn-baker"), 0, "{text}");
    let page = std::fs::read_to_string(folder.path("report/report.html")).expect("a page");
    assert!(page.contains("sphere-moved-origin"));
    let json = std::fs::read_to_string(folder.path("report/lab.json")).expect("a file");
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert!(json["kernels"].as_array().map_or(0, Vec::len) > 15);
}

#[test]
fn the_sensors_film_is_the_default_size_and_an_explicit_size_wins() {
    let folder = folder();
    let size = |options: &str| {
        let line = format!("@scene.xml -o @out.png --samples 1 --threads 1{options}");
        let rendered = folder.args::<RenderArgs>(&line).trace().expect("rendered");
        rendered.film.size().to_array()
    };
    assert_eq!(size(""), [30, 20]);
    assert_eq!(size(" --size 12x9"), [12, 9]);
    let outside = folder.args::<InspectArgs>("@scene.xml --pixel 30,0");
    let error = outside.run(&mut Vec::new()).expect_err("outside");
    assert_eq!(
        error.to_string(),
        "pixel 30,0 is outside the picture of 30x20 pixels"
    );
    folder.write("huge.xml", &SCENE.replace("\"30\"", "\"20000\""));
    let huge = folder.args::<InspectArgs>("@huge.xml --pixel 0,0");
    let error = huge
        .run(&mut Vec::new())
        .expect_err("too large")
        .to_string();
    let reason = "“width” must be from 1 to 16384";
    assert!(error.ends_with(reason), "{error}");
}

#[test]
fn info_lists_the_groups() {
    let folder = folder();
    let info = folder.json(|f, out| f.args::<InfoArgs>("@scene.xml --json").run(out));
    let shapes = info["shapes"].as_array().expect("a list");
    let names: Vec<_> = shapes.iter().map(|group| &group["shape"]).collect();
    assert_eq!(names, ["sphere", "axis-aligned box", "cylinder"]);
    for group in shapes {
        assert_eq!(group["count"], 1, "{group}");
        assert!(group["tree_bytes"].as_u64() > Some(0), "{group}");
    }
    let near = shapes[0]["bounds"]["min"][0].as_f64().expect("a number");
    assert!((-2.001..=-2.0).contains(&near), "{near}");
    let text = folder.text(|f, out| f.args::<InfoArgs>("@scene.xml").run(out));
    assert!(text.contains("1 sphere: tree of "), "{text}");
}

#[test]
fn info_lists_the_materials_with_their_textures_and_use() {
    let folder = Folder::new();
    folder.write(
        "scene.xml",
        r#"<scene version="3.0.0">
           <bsdf type="twosided" id="tiles"><bsdf type="diffuse"><texture name="reflectance" type="checkerboard"/></bsdf></bsdf>
           <bsdf type="dielectric" id="unused"/>
           <shape type="disk"><ref id="tiles"/></shape>
           <shape type="sphere"><ref id="tiles"/></shape>
           <shape type="sphere"><bsdf type="mask"><float name="opacity" value="0.25"/><bsdf type="diffuse"/></bsdf>
             <transform name="to_world"><translate x="9"/></transform></shape>
           </scene>"#,
    );
    let info = folder.json(|f, out| f.args::<InfoArgs>("@scene.xml --json").run(out));
    let (grey, none) = ([0.5, 0.5, 0.5], [0.0, 0.0, 0.0]);
    let maps = json!([{ "of": "diffuse", "texture": "checkerboard" }]);
    let found = info["material_list"].as_array().expect("a list");
    let expected = json!({
        "name": "tiles", "model": "diffuse", "back": null, "colour": grey, "emission": none,
        "opacity": 1.0, "maps": maps, "triangles": 0, "shapes": 2,
        "properties": [], "is_two_sided": true
    });
    assert_eq!(found[0], expected);
    assert_eq!(found[1]["name"], "unused");
    assert_eq!(found[1]["shapes"], 0);
    let expected = json!({
        "name": "", "model": "diffuse", "back": "black", "colour": grey, "emission": none,
        "opacity": 0.25, "maps": [], "triangles": 0, "shapes": 1,
        "properties": [], "is_two_sided": false
    });
    assert_eq!(found[2], expected);
    assert_eq!(found.len(), 3);
    let text = folder.text(|f, out| f.args::<InfoArgs>("@scene.xml").run(out));
    for line in [
        "tiles: diffuse, colour [0.5, 0.5, 0.5], both sides, diffuse from checkerboard; 2 shapes",
        "unused: dielectric, colour [1, 1, 1]; not used",
        "(no name): diffuse, colour [0.5, 0.5, 0.5], back black, opacity 0.25; 1 shape",
    ] {
        let line = format!("material            {line}\n");
        assert!(text.contains(&line), "{text}");
    }
}

#[test]
fn info_lists_the_materials_of_a_library() {
    let folder = Folder::new();
    folder.write(
        "m.mtl",
        "newmtl red\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 20\nnewmtl spare\n",
    );
    folder.write(
        "red.obj",
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nusemtl red\nf 2 4 3\n",
    );
    let info = folder.json(|f, out| f.args::<InfoArgs>("@red.obj --json").run(out));
    let list = info["material_list"].as_array().expect("a list");
    let found: Vec<_> = list
        .iter()
        .map(|m| {
            (
                m["name"].as_str(),
                m["model"].as_str(),
                m["triangles"].as_u64(),
            )
        })
        .collect();
    let expected = [
        (Some(""), Some("diffuse"), Some(1)),
        (Some("red"), Some("phong"), Some(1)),
    ];
    assert_eq!(found, expected);
}

#[test]
fn lab_measures_the_kernels_of_the_scenes_shapes() {
    let folder = Folder::new();
    let scene = r#"<scene version="3.0.0"><shape type="sphere"/><shape type="torus"><point name="center" x="3" y="0" z="0"/></shape></scene>"#;
    folder.write("round.xml", scene);
    let line = "--scene @round.xml --quick --json --size 32x32";
    let found = folder.json(|f, out| f.args::<LabArgs>(line).run(out));
    let rows = found["kernels"].as_array().expect("rows");
    let of = |shape: &str| -> Vec<&str> {
        let rows = rows.iter().filter(|row| row["shape"] == shape);
        rows.filter_map(|row| row["kernel"].as_str()).collect()
    };
    assert_eq!(of("sphere").len() + of("torus").len(), rows.len());
    assert!(of("sphere").contains(&"sphere-geometric"), "{rows:?}");
    assert!(of("torus").contains(&"torus-shifted"), "{rows:?}");
    for row in rows {
        assert_eq!(row["speed"]["ns_per_test"], Value::Null);
        let is_exact = row["kernel"] == "exact";
        let wrong = row["missed"].as_u64().expect("a count");
        assert!(!is_exact || wrong == 0, "{row}");
    }
}

#[test]
fn info_prints_a_scene_file_with_the_same_contents() {
    let folder = folder();
    for name in ["scene.xml", "cube.obj"] {
        let line = format!("@{name} --xml");
        let text = folder.text(|f, out| f.args::<InfoArgs>(&line).run(out));
        folder.write("again.xml", &text);
        let [old, new] = [name, "again.xml"].map(|name| {
            let line = format!("@{name} --json");
            folder.json(|f, out| f.args::<InfoArgs>(&line).run(out))
        });
        for key in ["triangles", "bounds"] {
            assert_eq!(old[key], new[key], "{name} {key}");
        }
        let counts = |info: &Value| -> Vec<Value> {
            let shapes = info["shapes"].as_array().expect("a list").iter();
            shapes
                .map(|group| json!([group["shape"], group["count"]]))
                .collect()
        };
        assert_eq!(counts(&old), counts(&new), "{name}");
    }
}

#[test]
fn reversed_normals_are_told() {
    let folder = Folder::new();
    folder.write(
        "mirrored.xml",
        r#"<scene version="3.0.0">
<shape type="sphere"><transform name="to_world"><scale x="-1"/></transform></shape>
<shape type="sphere"><point name="center" value="9 0 0"/></shape>
<shape type="plane"><point name="point" value="0 0 -5"/></shape></scene>"#,
    );
    let info = folder.json(|f, out| f.args::<InfoArgs>("@mirrored.xml --json").run(out));
    let shapes = info["shapes"].as_array().expect("a list");
    let reversed: Vec<&Value> = shapes.iter().map(|s| &s["reversed_normals"]).collect();
    assert_eq!(reversed, [1, 0]);
    let text = folder.text(|f, out| f.args::<InfoArgs>("@mirrored.xml").run(out));
    assert!(text.contains("2 spheres, normals of 1 reversed:"), "{text}");
    folder.write("rays.txt", "0 0 3 0 0 -1\n9 0 3 0 0 -1\n");
    let line = "@mirrored.xml --rays @rays.txt --explain";
    let text = folder.text(|f, out| f.args::<TraceArgs>(line).run(out));
    for (line, (is_reversed, z)) in text.lines().zip([(true, -1.0), (false, 1.0)]) {
        let found: Value = serde_json::from_str(line).expect("JSON");
        assert_eq!(found["is_reversed"], is_reversed, "{line}");
        assert_eq!(found["normal"][2], z, "{line}");
    }
}

#[test]
fn info_prints_tight_bounds_of_the_scene_of_all_shapes() {
    let assets = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    let line = format!("{} --json", assets.join("shapes.xml").display());
    let info = folder().json(|f, out| f.args::<InfoArgs>(&line).run(out));
    let at = |end: &str, axis: usize| info["bounds"][end][axis].as_f64().expect("a number");
    // The box of the ellipsoid, which is a quadric, is larger by a part of 10⁻⁵; the cone is the highest shape.
    let (low, high) = (at("min", 2), at("max", 2));
    assert!((-1e-5..=0.0).contains(&low), "{low}");
    assert!((2.1..2.1001).contains(&high), "{high}");
    // The torus about (−5, 0.2), with both radii.
    assert!((-6.301..=-6.3).contains(&at("min", 0)), "{}", at("min", 0));
}
