//! The normals and positions that `trace` prints.

use super::{PLANE, answers, line};
use crate::folder::Folder;
use hitscope_lab::commands::TraceArgs;
use serde_json::Value;

/// A component of the normal as computed in f64 from f32 numbers errs by a few ulps.
fn assert_normal(answer: &Value, expected: [f64; 3]) {
    for (axis, expected) in expected.iter().enumerate() {
        let found = answer["normal"][axis].as_f64().expect("a number");
        assert!((found - expected).abs() < 1e-15, "{answer}");
    }
}

#[test]
fn normals_have_unit_length_and_do_not_depend_on_the_side_of_the_ray() {
    let rays = "0 0 2 0 0 -2\n0 0 -1 0 0 1\n";
    for (mesh, z) in [(PLANE, 1.0), (&PLANE.replace("1 2 3", "1 3 2"), -1.0)] {
        for answer in answers(mesh, "", rays) {
            assert_normal(&answer, [0.0, 0.0, z]);
        }
        for answer in answers(mesh, "--all", rays) {
            assert_normal(&answer["hits"][0], [0.0, 0.0, z]);
        }
    }
    // Far from (0, 0, 0), on a slope of 3 : 4.
    let sloped = "v 4000000 0 0\nv 4000000 1 0\nv 4000004 0 3\nf 1 3 2\n";
    let found = &answers(sloped, "", "4000001 0.25 9 0 0 -1\n")[0];
    assert_normal(found, [-0.6, 0.0, 0.8]);
}

#[test]
fn normals_of_closed_shapes_point_outwards() {
    let scene = r#"<scene version="3.0.0">
        <shape type="sphere"><point name="center" x="4" y="0" z="0"/><float name="radius" value="2"/></shape>
        <shape type="cube"><transform name="to_world"><translate x="10"/></transform></shape>
        <shape type="rectangle"><transform name="to_world"><translate x="20"/></transform></shape>
    </scene>"#;
    // Towards each shape from −z, and from its inside if it has one.
    let rays = "4 0 -9 0 0 1\n4 0 0 0 0 1\n10.5 0 -9 0 0 1\n10 0 0 1 0 0\n20.5 0 -9 0 0 1\n";
    let folder = Folder::new();
    folder.write("scene.xml", scene);
    folder.write("rays.txt", rays);
    let line = "@scene.xml --rays @rays.txt";
    let text = folder.text(|folder, out| folder.args::<TraceArgs>(line).run(out));
    let expected = [
        [0.0, 0.0, -1.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    assert_eq!(text.lines().count(), expected.len());
    for (line, expected) in text.lines().zip(expected) {
        assert_normal(&serde_json::from_str(line).expect("JSON"), expected);
    }
}

#[test]
fn positions_on_shapes_are_accurate_however_far_away_the_ray_starts() {
    let scene = r#"<scene version="3.0.0">
        <shape type="sphere"/>
        <shape type="cylinder"><point name="p0" x="4" y="-1" z="0"/><point name="p1" x="4" y="1" z="0"/></shape>
        <shape type="cube"><transform name="to_world"><translate x="8"/></transform></shape>
        <shape type="torus"><point name="center" x="12" y="0" z="0"/><float name="major" value="0.25"/></shape>
        <shape type="csg"><string name="operation" value="difference"/>
            <shape type="sphere"><point name="center" x="16" y="0" z="0"/></shape>
            <shape type="sphere"><point name="center" x="16" y="0" z="-1"/></shape>
        </shape>
    </scene>"#;
    let heights = [
        0.968_245_836_551_854_2,
        0.968_245_836_551_854_2,
        1.0,
        0.25,
        0.968_245_836_551_854_2,
    ];
    let folder = Folder::new();
    folder.write("scene.xml", scene);
    for far in [1e5, 1e7, 1e8, 123_456_789.123, 1e14] {
        let rays = (0..5).map(|k| line([4.0 * f64::from(k) + 0.25, 0.0, far, 0.0, 0.0, -1.0]));
        folder.write("rays.txt", &rays.collect::<String>());
        for kernel in ["fast", "watertight", "precise", "exact"] {
            let arguments = format!("@scene.xml --rays @rays.txt --kernel {kernel}");
            let text = folder.text(|folder, out| folder.args::<TraceArgs>(&arguments).run(out));
            assert_eq!(text.lines().count(), heights.len());
            for (text, height) in text.lines().zip(heights) {
                let answer: Value = serde_json::from_str(text).expect("JSON");
                let z = answer["position"][2].as_f64().expect(text);
                // The ray starts some 20 units away, where t is a multiple of 2⁻¹⁹.
                assert!((z - height).abs() < 2f64.powi(-19), "{kernel} {far} {text}");
            }
        }
    }
}

#[test]
fn an_infinite_plane_far_from_all_else_is_hit() {
    let scene = r#"<scene version="3.0.0">
        <shape type="sphere"/>
        <shape type="plane"><point name="point" x="0" y="0" z="1000"/><vector name="normal" x="0" y="0" z="1"/></shape>
        <shape type="plane"><point name="point" x="0" y="0" z="-1000"/><vector name="normal" x="0" y="0" z="1"/></shape>
    </scene>"#;
    let folder = Folder::new();
    folder.write("scene.xml", scene);
    folder.write("rays.txt", "0.25 0 123456789.125 0 0 -1\n3 0 500 0 0 -1\n");
    assert_eq!(heights(&folder), [vec![1000, 1, -1, -1000], vec![-1000]]);
}

#[test]
fn an_infinite_solid_beside_a_bounded_one_is_hit_far_from_all_else() {
    // Above z = 1000 but for a cube there; and a ball.
    let scene = r#"<scene version="3.0.0">
        <shape type="csg"><string name="operation" value="difference"/>
            <shape type="plane"><point name="point" x="0" y="0" z="1000"/><vector name="normal" x="0" y="0" z="-1"/></shape>
            <shape type="cube"><transform name="to_world"><translate x="50" z="1000"/></transform></shape>
        </shape>
        <shape type="csg"><string name="operation" value="union"/><shape type="sphere"/><shape type="sphere"/></shape>
    </scene>"#;
    let folder = Folder::new();
    folder.write("scene.xml", scene);
    folder.write("rays.txt", "0.25 0 123456789.125 0 0 -1\n");
    assert_eq!(heights(&folder), [[1000, 1, -1]]);
}

/// The rounded heights of all crossings of each ray.
fn heights(folder: &Folder) -> Vec<Vec<i64>> {
    let line = "@scene.xml --rays @rays.txt --all";
    let text = folder.text(|folder, out| folder.args::<TraceArgs>(line).run(out));
    let of_ray = |line: &str| {
        let answer: Value = serde_json::from_str(line).expect("JSON");
        let hits = answer["hits"].as_array().expect("a list");
        let height = |hit: &Value| hit["position"][2].as_f64().expect("a number").round() as i64;
        hits.iter().map(height).collect()
    };
    text.lines().map(of_ray).collect()
}
