//! The commands on combined solids: the operand that is hit, the tree of operations, and the intervals inside each part.

use crate::folder::Folder;
use hitscope_lab::commands::{InspectArgs, TraceArgs};
use serde_json::{Value, json};

/// The cube from −1 to 1 with a dent of radius 0.5 in the middle of its upper side.
const DENTED: &str = r#"<scene version="3.0.0"><shape type="csg"><string name="operation" value="difference"/>
<shape type="cube"/>
<shape type="sphere"><point name="center" x="0" y="0" z="1"/><float name="radius" value="0.5"/></shape>
</shape></scene>"#;

/// The lower half of a sphere, and a smaller sphere below it.
const HALF: &str = r#"<scene version="3.0.0"><shape type="csg"><string name="operation" value="union"/>
<shape type="csg"><string name="operation" value="intersection"/>
  <shape type="plane"><point name="point" x="0" y="0" z="0"/><vector name="normal" x="0" y="0" z="1"/></shape>
  <shape type="sphere"><float name="radius" value="2"/></shape>
</shape>
<shape type="sphere"><point name="center" x="0" y="0" z="-4"/><float name="radius" value="1"/></shape>
</shape></scene>"#;

fn folder(scene: &str) -> Folder {
    let folder = Folder::new();
    folder.write("scene.xml", scene);
    folder
}

/// The pixel whose ray goes from (0, 0, 5) along −z.
const PIXEL: &str = "@scene.xml --pixel 0,0 --size 1x1 --eye 0,0,5 --target 0,0,0";

fn inspected(folder: &Folder) -> Value {
    let line = format!("{PIXEL} --json");
    folder.json(|f, out| f.args::<InspectArgs>(&line).run(out))
}

/// The answer to one ray.
fn traced(folder: &Folder, ray: &str, options: &str) -> Value {
    folder.write("rays.txt", ray);
    let line = format!("@scene.xml --rays @rays.txt {options}");
    folder.json(|f, out| f.args::<TraceArgs>(&line).run(out))
}

/// Fails if a line is missing.
fn contains(found: &Value, lines: &[&str]) {
    let found = found.as_array().expect("lines");
    for line in lines {
        assert!(found.contains(&json!(line)), "{line} in {found:#?}");
    }
}

#[test]
fn inspect_shows_the_subtracted_operand_and_the_intervals_of_each_part() {
    let folder = folder(DENTED);
    let found = inspected(&folder);
    let hit = &found["hit"];
    assert_eq!((&hit["shape"], &hit["t"]), (&json!("solid"), &json!(4.5)));
    assert_eq!(hit["geometric_normal"], json!([0.0, 0.0, 1.0]));
    assert_eq!(hit["parameters"], Value::Null);
    let cube = json!({
        "index": 0, "shape": "axis-aligned box", "is_subtracted": false,
        "parameters": { "min": [-1.0, -1.0, -1.0], "max": [1.0, 1.0, 1.0] },
        "intervals": [[4.0, 6.0]],
    });
    let mut ball = json!({
        "index": 1, "shape": "sphere", "is_subtracted": true,
        "parameters": { "centre": [0.0, 0.0, 1.0], "radius": 0.5 },
        "intervals": [[3.5, 4.5]],
    });
    let tree = json!({
        "operation": "difference", "parts": [cube, ball.clone()], "intervals": [[4.5, 6.0]],
    });
    assert_eq!(hit["solid"]["tree"], tree);
    ball.as_object_mut().expect("an object").remove("intervals");
    assert_eq!(hit["solid"]["operand"], ball);
    let formula = [
        "difference of: [4, 6] \\ [3.5, 4.5] = [4.5, 6]",
        "  operand 0, axis-aligned box: [4, 6]",
        "  operand 1, sphere, subtracted: [3.5, 4.5]",
        "The hit is on operand 1, sphere:",
        "c = (0, 0, 1)",
        "t1 = 3.5, t2 = 4.5",
        "Operand 1 is subtracted: the solid's normal is the opposite of its normal.",
        "r(4.5) = (0, 0, 0.5)",
    ];
    contains(&hit["formula"], &formula);
    let crossings = found["crossings"].as_array().expect("a list");
    let operands: Vec<&Value> = crossings.iter().map(|c| &c["operand"]["index"]).collect();
    assert_eq!(operands, [1, 0]);
    let text = folder.text(|f, out| f.args::<InspectArgs>(PIXEL).run(out));
    for part in [
        "operand      1, sphere, subtracted: the solid's normal is the opposite of its own",
        "centre       [0.0, 0.0, 1.0]",
        "back  of solid 0, operand 0, axis-aligned box",
        formula[0],
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
}

#[test]
fn trace_names_the_operand_and_explains_every_hit_on_request() {
    let folder = folder(HALF);
    let ray = "0 0 5 0 0 -1";
    let found = traced(&folder, ray, "");
    assert_eq!(
        (&found["t"], &found["operand"]),
        (
            &json!(5.0),
            &json!({ "index": 0, "shape": "axis-aligned plane" })
        )
    );
    assert!(found["formula"].is_null() && found["solid"].is_null());
    let found = traced(&folder, ray, "--all --explain");
    let hits = found["hits"].as_array().expect("a list");
    let summary = |hit: &Value| json!([hit["t"], hit["operand"]["index"]]);
    let summaries: Vec<Value> = hits.iter().map(summary).collect();
    let expected = json!([[5.0, 0], [7.0, 1], [8.0, 2], [10.0, 2]]);
    assert_eq!(json!(summaries), expected);
    contains(
        &hits[3]["formula"],
        &[
            "union of: [5, 7] ∪ [8, 10]",
            "  intersection of: [5, ∞) ∩ [3, 7] = [5, 7]",
            "    operand 0, axis-aligned plane: [5, ∞)",
            "The hit is on operand 2, sphere:",
            "r(10) = (0, 0, -5)",
        ],
    );
}

#[test]
fn intervals_are_in_lengths_of_the_given_direction() {
    let folder = folder(HALF);
    // A direction of this length is scaled before it is traced.
    let found = traced(&folder, "0 0 5 0 0 -1048576", "--explain");
    let unit = 1.0 / 1_048_576.0;
    assert_eq!(found["t"], 5.0 * unit);
    let tree = &found["solid"]["tree"];
    assert_eq!(
        tree["intervals"],
        json!([[5.0 * unit, 7.0 * unit], [8.0 * unit, 10.0 * unit]])
    );
    let half = &tree["parts"][0]["parts"][0];
    assert_eq!(half["intervals"], json!([[5.0 * unit, null]]));
}

#[test]
fn trace_explains_hits_of_triangles_and_other_shapes_too() {
    let folder = Folder::new();
    let found = folder.trace("--explain", "0.5 0.25 5 0 0 -1");
    contains(
        &found[0]["formula"],
        &["o = (0.5, 0.25, 5)", "P = r(t) = (0.5, 0.25, 1)"],
    );
    assert!(found[0]["parameters"].is_null() && found[0]["solid"].is_null());
    let sphere = r#"<scene version="3.0.0"><shape type="sphere"/></scene>"#;
    folder.write("scene.xml", sphere);
    let found = traced(&folder, "0 0 3 0 0 -1", "--explain");
    assert_eq!(found["parameters"]["radius"], 1.0);
    contains(&found["formula"], &["t1 = 2, t2 = 4"]);
}
