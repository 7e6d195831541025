//! The commands on scenes that hold only a plane, only a solid, or nothing.

use crate::folder::Folder;
use hitscope_lab::commands::{BenchArgs, InfoArgs, InspectArgs, LabArgs, TraceArgs};
use serde_json::{Value, json};

const NOTHING: &str = "";
const PLANE: &str = "<shape type='plane'/>";
const SOLID: &str = "<shape type='csg'><string name='operation' value='union'/><shape type='cube'/>
    <shape type='sphere'><point name='center' x='0' y='0' z='1'/></shape></shape>";
/// The intersection of two boxes that lie apart.
const EMPTY_SOLID: &str =
    "<shape type='csg'><string name='operation' value='intersection'/><shape type='cube'/>
    <shape type='cube'><transform name='to_world'><translate x='9'/></transform></shape></shape>";

fn folder(contents: &str) -> Folder {
    let folder = Folder::new();
    let text = format!("<scene version=\"3.0.0\">{contents}</scene>");
    folder.write("scene.xml", &text);
    folder
}

fn info(folder: &Folder) -> (String, Value) {
    (
        folder.text(|f, out| f.args::<InfoArgs>("@scene.xml").run(out)),
        folder.json(|f, out| f.args::<InfoArgs>("@scene.xml --json").run(out)),
    )
}

#[test]
fn info_says_that_a_scene_is_empty() {
    let (text, json) = info(&folder(NOTHING));
    assert!(
        text.contains("\nshape               none: the scene is empty\n"),
        "{text}"
    );
    assert!(!text.contains("no bounds"), "{text}");
    assert_eq!(json["shapes"], json!([]));
    assert_eq!(
        (&json["materials"], &json["material_list"]),
        (&json!(0), &json!([]))
    );
}

#[test]
fn scenes_without_size_have_no_bounds() {
    let shapes = "The scene has no triangles, between which gaps could show; the fast kernels of other shapes err from far away.";
    for (contents, reason) in [
        (NOTHING, "The scene is empty."),
        (PLANE, shapes),
        (EMPTY_SOLID, shapes),
    ] {
        let (text, json) = info(&folder(contents));
        assert_eq!(json["bounds"], Value::Null, "{contents}");
        assert_eq!(json["tier"]["reasons"], json!([reason]), "{contents}");
        assert!(text.contains("\nbounds              none\n"), "{text}");
    }
}

#[test]
fn info_states_nothing_about_triangles_where_there_are_none() {
    for (contents, shape, tree) in [
        (PLANE, "1 axis-aligned plane", "no tree\n"),
        (SOLID, "1 solid", "tree of "),
        (EMPTY_SOLID, "1 solid", "tree of "),
    ] {
        let (text, json) = info(&folder(contents));
        let line = format!("\nshape               {shape}: {tree}");
        assert!(text.contains(&line), "{text}");
        for part in [
            "vertices rounded by",
            "open edges",
            "max aspect ratio",
            "as indexed",
        ] {
            assert!(!text.contains(part), "{part} in {text}");
        }
        // The material of shapes without one.
        assert_eq!(json["materials"], 1, "{contents}");
        assert!(text.contains("\nmaterials           1\n"), "{text}");
        assert_eq!(json["material_list"].as_array().map(Vec::len), Some(1));
    }
    let folder = Folder::new();
    let mesh = folder.text(|f, out| f.args::<InfoArgs>("@cube.obj").run(out));
    for part in ["vertices rounded by 0\n", "\nopen edges          0\n"] {
        assert!(mesh.contains(part), "{mesh}");
    }
}

#[test]
fn bench_names_the_primitives_and_shows_no_rate_without_rays() {
    for (contents, title, rays) in [
        (NOTHING, "an empty scene; ", [true, false, false]),
        (PLANE, "1 axis-aligned plane; ", [true, true, false]),
        (SOLID, "1 solid; ", [true; 3]),
    ] {
        let folder = folder(contents);
        let line = "@scene.xml --size 16x16 --rounds 1 --threads 1 --kernel fast";
        let text = folder.text(|f, out| f.args::<BenchArgs>(line).run(out));
        assert!(text.starts_with(title), "{text}");
        assert!(text.contains("bytes/primitive"), "{text}");
        assert!(
            !text.contains("triangle") && !text.contains("quick tree"),
            "{text}"
        );
        for (name, has_rays) in ["primary", "bounce", "random"].iter().zip(rays) {
            let mut rows = text.lines().filter(|row| row.starts_with(name));
            let row = rows.next().expect("a row");
            assert_eq!(!row.contains('–'), has_rays, "{text}");
        }
        let json = folder.json(|f, out| f.args::<BenchArgs>(&format!("{line} --json")).run(out));
        let count = usize::from(contents != NOTHING);
        assert_eq!(
            (&json["triangles"], &json["primitives"]),
            (&json!(0), &json!(count))
        );
        assert_eq!(json["bytes_per_primitive"], json["bytes_per_triangle"]);
        let packed = &json["kernels"][0];
        assert_eq!(packed["bytes_per_primitive"], packed["bytes_per_triangle"]);
    }
}

#[test]
fn lab_measures_a_plane_or_a_solid_alone_and_says_that_a_scene_is_empty() {
    let line = "--scene @scene.xml --quick --size 12x12";
    for (contents, shape) in [(PLANE, "axis-aligned plane"), (SOLID, "solid")] {
        let folder = folder(contents);
        let json = folder.json(|f, out| f.args::<LabArgs>(&format!("{line} --json")).run(out));
        let rows = json["kernels"].as_array().expect("rows");
        assert!(rows.iter().all(|row| row["shape"] == shape), "{json}");
        assert!(rows[0]["hits"].as_u64() > Some(0), "{json}");
        let text = folder.text(|f, out| f.args::<LabArgs>(line).run(out));
        assert!(
            text.contains("errors against the exact answer for "),
            "{text}"
        );
        // No random rays are aimed at what has no bounds.
        let has_dash = |row: &str| row.split_whitespace().nth(3) == Some("–");
        let row = text
            .lines()
            .find(|row| row.trim_start().starts_with("exact "));
        assert_eq!(row.map(has_dash), Some(contents == PLANE), "{text}");
    }
    let folder = folder(NOTHING);
    let text = folder.text(|f, out| f.args::<LabArgs>(line).run(out));
    assert_eq!(text, "the scene is empty: there is nothing to measure\n");
    let json = folder.json(|f, out| f.args::<LabArgs>(&format!("{line} --json")).run(out));
    assert_eq!(json["kernels"], json!([]));
}

#[test]
fn trace_and_inspect_answer_rays_at_a_plane_a_solid_and_nothing() {
    for (contents, t) in [
        (NOTHING, None),
        (PLANE, Some(4.0)),
        (SOLID, Some(2.0)),
        (EMPTY_SOLID, None),
    ] {
        let folder = folder(contents);
        folder.write("rays.txt", "0 0 4 0 0 -1\n");
        let line = "@scene.xml --rays @rays.txt";
        let found = folder.json(|f, out| f.args::<TraceArgs>(line).run(out));
        assert_eq!(found["t"].as_f64(), t, "{found}");
        assert_eq!(found["hit"], t.is_some(), "{found}");
        // The middle of the scene is the default target, also if it has no bounds.
        let line = "@scene.xml --pixel 0,0 --size 1x1 --eye 0,0,4 --up 0,1,0 --json";
        let found = folder.json(|f, out| f.args::<InspectArgs>(line).run(out));
        assert_eq!(found["hit"].is_null(), t.is_none(), "{contents}: {found}");
    }
}
