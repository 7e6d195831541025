//! Tests of the commands' inputs and outputs.

use crate::folder::{CUBE, Folder};
use hitscope_lab::commands::{BenchArgs, InfoArgs, InspectArgs, Output, RenderArgs, TraceArgs};
use serde_json::Value;
use std::path::Path;

#[test]
fn trace_answers_each_ray_in_order() {
    let rays = "# a comment\n0.25 0.5 3 0 0 -2\n\n5 5 5 1 0 0 # misses\n0.5 0.5 3 0 0 0\n1 2 3\n0.5 0.5 3 0 0 x\n";
    let answers = Folder::new().trace("", rays);
    assert_eq!(answers.len(), 5);
    let hit = &answers[0];
    assert_eq!(hit["hit"], true);
    assert_eq!(
        hit["t"], 1.0,
        "two units away, in lengths of a direction of two"
    );
    assert_eq!(hit["face"], 5);
    assert_eq!(hit["position"], serde_json::json!([0.25, 0.5, 1.0]));
    let weights: f64 = hit["barycentric"]
        .as_array()
        .expect("three")
        .iter()
        .filter_map(Value::as_f64)
        .sum();
    assert_eq!(weights, 1.0);
    let miss = serde_json::json!({ "hit": false, "line": 4, "ray_rounding": 0.0 });
    assert_eq!(answers[1], miss);
    assert_eq!(answers[2]["error"], "the direction is zero in f32");
    assert_eq!(answers[3]["error"], "expected 6 or 8 numbers, found 3");
    assert_eq!(answers[4]["error"], "“x” is not a number");
}

#[test]
fn trace_obeys_the_interval_and_its_options() {
    let folder = Folder::new();
    let rays = "0.25 0.5 3 0 0 -1 0 2\n0.25 0.5 3 0 0 -1 2 9\n0.25 0.5 3 0 0 -1 3.5 9\n";
    let closest: Vec<Value> = folder
        .trace("", rays)
        .iter()
        .map(|a| a["t"].clone())
        .collect();
    assert_eq!(closest, [Value::Null, 3.0.into(), Value::Null]);
    let any: Vec<Value> = folder
        .trace("--any", rays)
        .iter()
        .map(|a| a["hit"].clone())
        .collect();
    assert_eq!(any, [false, true, false].map(Value::from));
    let summary = folder.trace("--summary", rays);
    assert_eq!(summary.len(), 1);
    assert_eq!(
        (&summary[0]["rays"], &summary[0]["hits"]),
        (&3.into(), &1.into())
    );
}

#[test]
fn trace_all_lists_every_crossing_once() {
    let rays = "0.25 0.75 3 0 0 -1\n0.5 0.5 3 0 0 -1\n9 9 9 1 0 0\n";
    let answers = Folder::new().trace("--all", rays);
    let ts = |answer: &Value| -> Vec<f64> {
        let hits = answer["hits"].as_array().expect("a list");
        hits.iter().filter_map(|hit| hit["t"].as_f64()).collect()
    };
    assert_eq!(ts(&answers[0]), [2.0, 3.0]);
    // Through both diagonals: two triangles at the same t are one crossing.
    assert_eq!(ts(&answers[1]), [2.0, 3.0]);
    assert_eq!(
        answers[1]["hits"][0]["also"].as_array().map(Vec::len),
        Some(1)
    );
    assert_eq!(ts(&answers[2]), [0.0; 0]);
}

#[test]
fn trace_gives_the_same_answers_on_any_number_of_threads() {
    let folder = Folder::new();
    let rays: String = (0..500)
        .map(|i| format!("{} 0.3 3 0.001 0.002 -1\n", f64::from(i) / 400.0))
        .collect();
    let one = folder.trace("--threads 1", &rays);
    assert_eq!(one.len(), 500);
    assert_eq!(one, folder.trace("--threads 7", &rays));
}

#[test]
fn inspect_prints_the_documented_values() {
    let folder = Folder::new();
    let line = "@cube.obj --pixel 50,30 --size 101x61 --eye 0.4,0.5,5 --target 0.4,0.5,0 --json";
    let found = folder.json(|f, out| f.args::<InspectArgs>(line).run(out));
    assert_eq!(found["pixel"], serde_json::json!([50, 30]));
    assert_eq!(found["kernel"], "exact");
    assert_eq!(found["hit"]["t"], 4.0);
    assert_eq!(
        (&found["hit"]["face"], &found["hit"]["material"]),
        (&5.into(), &"red".into())
    );
    assert_eq!(found["hit"]["group"], "front");
    assert_eq!(
        found["hit"]["geometric_normal"],
        serde_json::json!([0.0, 0.0, 1.0])
    );
    // The eye's 0.4 isn't an f32 number; the direction is along −z.
    assert_eq!(found["ray"]["ray_rounding"], f64::from(0.4f32) - 0.4);
    assert_eq!(found["exact"]["t_fraction"], "4");
    let kernels = found["kernels"].as_array().expect("a list");
    assert!(kernels.len() >= 2);
    for kernel in kernels {
        assert_eq!(
            (&kernel["hit"], &kernel["t_error_ulps"]),
            (&true.into(), &0.0.into())
        );
    }
    assert!(found["cost"]["boxes"].as_u64() > Some(0));
    let line = "@cube.obj --pixel 0,0 --size 101x61 --eye 0.4,0.5,5 --target 0.4,0.5,0 --json";
    let missed = folder.json(|f, out| f.args::<InspectArgs>(line).run(out));
    assert_eq!(
        (&missed["hit"], &missed["exact"]),
        (&Value::Null, &Value::Null)
    );
}

#[test]
fn inspect_reports_the_distance_from_the_cameras_ray() {
    let folder = Folder::new();
    // 0.1 isn't an f32 number, and at 10⁹ an ulp is 64.
    for (eye, least, most) in [("0.1,0.5,5", 1e-9, 1e-6), ("1000000010,0.5,5", 9.0, 64.0)] {
        let line =
            format!("@cube.obj --pixel 0,0 --size 1x1 --eye {eye} --target 0.5,0.5,0.5 --json");
        let found = folder.json(|f, out| f.args::<InspectArgs>(&line).run(out));
        let rounding = found["ray"]["ray_rounding"].as_f64().expect("a number");
        assert!((least..most).contains(&rounding), "{eye}: {rounding}");
        let line = line.replace(" --json", "");
        let text = folder.text(|f, out| f.args::<InspectArgs>(&line).run(out));
        assert!(text.contains("rounded by"), "{text}");
    }
}

#[test]
fn inspect_counts_triangles_and_faces_from_0_and_states_it() {
    let folder = Folder::new();
    let line = "@cube.obj --pixel 50,30 --size 101x61 --eye 0.4,0.5,5 --target 0.4,0.5,0";
    let text = folder.text(|f, out| f.args::<InspectArgs>(line).run(out));
    let json = folder.json(|f, out| f.args::<InspectArgs>(&format!("{line} --json")).run(out));
    let hit = &json["hit"];
    // The last of the file's six faces.
    assert_eq!(hit["face"], 5);
    let expected = format!(
        "front side of triangle {} in face {} on line {} (triangles and faces are counted from 0)",
        hit["triangle"], hit["face"], hit["line"]
    );
    assert_eq!(hit["side"], "front");
    assert!(text.contains(&expected), "{text}");
    assert!(!text.contains("-0.0") && !text.contains("-0,"), "{text}");
}

#[test]
fn inspect_measures_the_thickness_of_the_wall_and_looks_at_elements() {
    let folder = Folder::new();
    let line =
        "@cube.obj --pixel 50,30 --size 101x61 --eye 0.4,0.5,5 --target 0.4,0.5,0 --thickness";
    let found = folder.json(|f, out| f.args::<InspectArgs>(&format!("{line} --json")).run(out));
    let thickness = &found["thickness"];
    assert_eq!(thickness["normal"], serde_json::json!([0.0, 0.0, 1.0]));
    let wall = &thickness["inwards"];
    // The first face, on line 9.
    assert_eq!((&wall["distance"], &wall["face"]), (&1.0.into(), &0.into()));
    assert_eq!(
        (&wall["line"], &thickness["outwards"]),
        (&9.into(), &Value::Null)
    );
    let text = folder.text(|f, out| f.args::<InspectArgs>(line).run(out));
    assert!(text.contains("thickness: 1 to triangle "), "{text}");
    assert!(text.contains("clearance: no other surface"), "{text}");
    let line = "@cube.obj --size 100x60 --look-at face:3 --json";
    let found = folder.json(|f, out| f.args::<InspectArgs>(line).run(out));
    assert_eq!(found["pixel"], serde_json::json!([50, 30]));
    assert_eq!(found["hit"]["face"], 3);
    assert_eq!(found["thickness"], Value::Null);
    assert!(found.get("thickness").is_none());
    let line = "@cube.obj --pixel 0,0 --size 101x61 --thickness --json";
    let missed = folder.json(|f, out| f.args::<InspectArgs>(line).run(out));
    assert_eq!(missed.get("thickness"), Some(&Value::Null));
}

#[test]
fn inspect_refuses_a_pixel_outside_and_an_impossible_camera() {
    let folder = Folder::new();
    let error = |line: &str| {
        let result = folder.args::<InspectArgs>(line).run(&mut Vec::new());
        result.expect_err(line).to_string()
    };
    let outside = error("@cube.obj --pixel 100,0 --size 100x50");
    assert_eq!(
        outside,
        "pixel 100,0 is outside the picture of 100x50 pixels"
    );
    let same = error("@cube.obj --pixel 1,1 --eye 1,1,1 --target 1,1,1");
    assert_eq!(same, "the camera's eye and target are the same point");
    assert!(error("@none.obj --pixel 1,1").contains("none.obj: "));
}

#[test]
fn info_counts_the_elements_of_a_file() {
    let folder = Folder::new();
    let info = folder.json(|f, out| f.args::<InfoArgs>("@cube.obj --json").run(out));
    let expected = [
        ("vertices", 8),
        ("triangles", 12),
        ("polygons", 6),
        // “red”, and the one without a name that the other faces have.
        ("materials", 2),
        ("groups", 1),
    ];
    for (key, count) in expected {
        assert_eq!(info[key], count, "{key}");
    }
    let listed = info["material_list"].as_array().expect("a list");
    assert_eq!(info["materials"], listed.len());
    assert_eq!(info["bounds"]["max"], serde_json::json!([1.0, 1.0, 1.0]));
    assert_eq!(info["health"]["open_edges"], 0);
    assert_eq!(info["tier"]["name"], "watertight");
    folder.write("open.obj", &CUBE.replace("f 5 6 7 8", "f 5 6 7\nf 1 1 2"));
    let info = folder.json(|f, out| f.args::<InfoArgs>("@open.obj --json").run(out));
    assert_eq!(info["health"]["open_edges"], 3);
    assert_eq!(info["dropped"]["zero_area"], 1);
    // A dropped triangle, and a material that no library defines.
    assert_eq!(info["warnings"].as_array().map(Vec::len), Some(2));
}

#[test]
fn render_writes_a_png_of_the_given_size() {
    let folder = Folder::new();
    let args: RenderArgs =
        folder.args("@cube.obj -o @out.png --size 40x30 --samples 4 --threads 2");
    let rendered = args.trace().expect("rendered");
    let output = Output::create(&args.output).expect("a place to write");
    output
        .write_png(rendered.film.size(), rendered.film.pixels())
        .expect("written");
    let image = image::open(&args.output).expect("a PNG").to_rgba8();
    assert_eq!(image.dimensions(), (40, 30));
    assert_ne!(
        image.get_pixel(20, 15),
        image.get_pixel(0, 0),
        "the cube is in the middle"
    );
    // The same pixels in the same order.
    let pixels: Vec<[u8; 4]> = image.pixels().map(|pixel| pixel.0).collect();
    assert_eq!(pixels, rendered.film.pixels());
    let bad = Output::create(Path::new("/no/such/folder/x.png"));
    assert!(
        bad.expect_err("no folder")
            .to_string()
            .starts_with("/no/such/folder/x.png: ")
    );
}

#[test]
fn rays_and_hits_of_a_distant_mesh_are_in_the_files_coordinates() {
    let folder = Folder::new();
    let far: String = CUBE
        .lines()
        .map(|line| match line.strip_prefix("v ") {
            Some(rest) => {
                let p: Vec<f64> = rest
                    .split(' ')
                    .map(|x| x.parse::<f64>().expect("a number"))
                    .collect();
                format!("v {} {} {}\n", p[0] + 4_649_776.25, p[1] - 1e7, p[2])
            }
            None => format!("{line}\n"),
        })
        .collect();
    folder.write("cube.obj", &far);
    let ray = "4649776.5 -9999999.5 3 0 0 -1\n";
    let near = &folder.trace("", ray)[0];
    assert_eq!(
        near["position"],
        serde_json::json!([4_649_776.5, -9_999_999.5, 1.0])
    );
    assert_eq!(near["t"], 2.0);
}

#[test]
fn bench_prints_a_row_per_workload_and_kernel() {
    let folder = Folder::new();
    let line = "@cube.obj --size 24x16 --rounds 1 --threads 2 --kernel fast --kernel exact --json";
    let report = folder.json(|folder, out| folder.args::<BenchArgs>(line).run(out));
    assert_eq!(report["triangles"], 12);
    for figure in [
        "load_ms",
        "build_ms",
        "bytes_per_triangle",
        "bytes_per_primitive",
    ] {
        assert!(report[figure].as_f64().is_some_and(|x| x > 0.0), "{figure}");
    }
    let steps = report["load_steps_ms"].as_object().expect("steps");
    for step in ["cutting", "joining", "recentring", "triangulating"] {
        assert!(steps[step].as_f64().is_some_and(|x| x >= 0.0), "{step}");
    }
    let rows = report["workloads"].as_array().expect("rows");
    let workloads = [
        ("primary", 4),
        ("bounce", 2),
        ("random", 2),
        ("shadow", 2),
        ("lamp", 4),
    ];
    for (name, count) in workloads {
        let rows: Vec<_> = rows.iter().filter(|row| row["name"] == name).collect();
        assert_eq!(rows.len(), count, "{name}");
        for row in &rows {
            assert_eq!(row["threads"], 2, "{name}");
            assert_eq!(row["hits"], rows[0]["hits"], "{name}");
            assert!(
                row["mrays_per_s"].as_f64().is_some_and(|x| x > 0.0),
                "{name}"
            );
        }
    }
    assert_eq!(rows[0]["rays"], 24 * 16);
}

#[test]
fn compact_triangles_give_the_same_answers_in_less_memory() {
    let folder = Folder::new();
    folder.write(
        "rays.txt",
        "0.3 0.4 5 0 0 -1\n0.5 0.5 0.5 1 1 1\n9 9 9 1 0 0\n",
    );
    for kernel in ["fast", "watertight", "precise", "exact", "baldwin-weber"] {
        let trace = |more: &str| {
            folder.text(|folder, out| {
                let line = format!("@cube.obj --rays @rays.txt --all --kernel {kernel}{more}");
                folder.args::<TraceArgs>(&line).run(out)
            })
        };
        assert_eq!(trace(""), trace(" --compact"), "{kernel}");
    }
    let packed = |more: &str| {
        let info = folder.json(|folder, out| {
            let line = format!("@cube.obj --json{more}");
            folder.args::<InfoArgs>(&line).run(out)
        });
        info["bytes"]["packed primitives"]
            .as_u64()
            .expect("a number")
    };
    assert!(packed(" --compact") < packed(""));
}
