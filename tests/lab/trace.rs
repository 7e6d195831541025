//! `trace`: the lines it reads, the numbers it prints, and rays that are rounded.

use crate::folder::Folder;
use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::random::Random;
use hitscope_lab::commands::TraceArgs;
use hitscope_lab::oracle;
use serde_json::{Value, json};

const PLANE: &str = "v -2 -2 0\nv 4 -2 0\nv -2 4 0\nf 1 2 3\n";

/// The text that `trace` prints for a mesh and rays.
fn text(mesh: &str, options: &str, rays: impl AsRef<[u8]>) -> String {
    let folder = Folder::new();
    folder.write("mesh.obj", mesh);
    let path = folder.write("rays.txt", "");
    std::fs::write(path, rays).expect("written");
    folder.text(|folder, out| {
        let line = format!("@mesh.obj --rays @rays.txt {options}");
        folder.args::<TraceArgs>(&line).run(out)
    })
}

fn answers(mesh: &str, options: &str, rays: impl AsRef<[u8]>) -> Vec<Value> {
    let text = text(mesh, options, rays);
    let parsed = text
        .lines()
        .map(|line| serde_json::from_str(line).expect("JSON"));
    parsed.collect()
}

/// A line of numbers that read back to the same doubles.
fn line(numbers: impl IntoIterator<Item = f64>) -> String {
    let words: Vec<String> = numbers.into_iter().map(|x| format!("{x}")).collect();
    words.join(" ") + "\n"
}

fn rounding(answer: &Value) -> f64 {
    answer["ray_rounding"].as_f64().expect("a number")
}

#[test]
fn answers_name_the_lines_of_their_rays_however_lines_end() {
    let rays = [
        "# heading",
        "0 0 1 0 0 -1",
        "",
        "  # note",
        "1 2 3",
        "0 0 1 0 0 1 # away",
    ];
    for end in ["\n", "\r", "\r\n"] {
        let found = answers(PLANE, "", rays.join(end));
        let numbers: Vec<_> = found.iter().map(|answer| answer["line"].clone()).collect();
        assert_eq!(numbers, [2, 5, 6], "{end:?}");
        let are_hits: Vec<_> = found.iter().map(|answer| answer["hit"].clone()).collect();
        assert_eq!(
            are_hits,
            [json!(true), Value::Null, json!(false)],
            "{end:?}"
        );
        for options in ["--any", "--all"] {
            let found = answers(PLANE, options, rays.join(end));
            let numbers: Vec<_> = found.iter().map(|answer| answer["line"].clone()).collect();
            assert_eq!(numbers, [2, 5, 6], "{end:?} {options}");
        }
    }
}

#[test]
fn a_summary_counts_rays_and_bad_lines() {
    let rays = "0 0 1 0 0 -1\n\n# note\nx\n1 2\n0 0 1 0 0 1\n";
    let summary = &answers(PLANE, "--summary", rays)[0];
    let counts = ["rays", "hits", "bad_lines"].map(|name| summary[name].clone());
    assert_eq!(counts, [2, 1, 2]);
    assert_eq!(summary["max_ray_rounding"], 0.0);
    let rounded = &answers(PLANE, "--summary", "0.1 0 1 0 0 -1\n0 0 1 0 0 -1\n")[0];
    let error = f64::from(0.1f32) - 0.1;
    assert_eq!(rounded["max_ray_rounding"], error);
}

#[test]
fn long_lines_and_long_words_are_refused_in_few_words() {
    let word = "7".repeat(60_000) + "x";
    let line = "7 ".repeat(40_000);
    let comment = format!("0 0 1 0 0 -1 # {}", "note ".repeat(40_000));
    let rays = [&*word, &line, &comment, "0 0 1 0 0 1"].join("\n");
    let found = answers(PLANE, "", rays);
    assert_eq!(found.len(), 4);
    let shown = "7".repeat(40);
    assert_eq!(found[0]["error"], format!("“{shown}…” is not a number"));
    assert_eq!(found[1]["error"], "the line is longer than 65536 bytes");
    assert_eq!(
        (&found[2]["hit"], &found[3]["hit"]),
        (&true.into(), &false.into())
    );
    let numbers: Vec<_> = found.iter().map(|answer| answer["line"].clone()).collect();
    assert_eq!(numbers, [1, 2, 3, 4]);
}

#[test]
fn numbers_read_back_to_the_same_doubles() {
    // The distance is an f32: 1.0000029 for who reads f32, another number for who reads doubles.
    // The f32 next to it, in full: 1.00000286102294921875.
    let t = f64::from(1.000_002_9_f32);
    assert_eq!(f64::from(t as f32), t);
    let found = text(PLANE, "", line([0.25, 0.5, t, 0.0, 0.0, -1.0]));
    assert!(found.contains("\"t\":1.0000028610229492,"), "{found}");
    let answer: Value = serde_json::from_str(&found).expect("JSON");
    assert_eq!(answer["t"].as_f64(), Some(t));
    for weight in answer["barycentric"].as_array().expect("three") {
        let weight = weight.as_f64().expect("a number");
        assert_eq!(f64::from(weight as f32), weight, "the value of an f32");
    }
}

#[test]
fn no_weight_is_below_zero_and_no_zero_has_a_sign() {
    let corners = [[0.1, 0.2, 0.3], [0.9, -0.3, 0.1], [0.2, 0.7, -0.4]];
    let mesh: String = corners
        .iter()
        .map(|p| format!("v {} {} {}\n", p[0], p[1], p[2]))
        .collect();
    let mut random = Random::new(5);
    // At the edge BC, where 1 − u − v is 0 but for roundings.
    let rays: String = (0..2_000)
        .map(|_| {
            let along = random.unit();
            let origin = [random.signed(), random.signed(), 2.0];
            let dir = [0, 1, 2].map(|k| {
                let target = corners[1][k] + along * (corners[2][k] - corners[1][k]);
                target - origin[k]
            });
            line(origin.into_iter().chain(dir))
        })
        .collect();
    for kernel in TRIANGLE_KERNELS.iter() {
        let options = format!("--kernel {}", kernel.info.name);
        let printed = text(&(mesh.clone() + "f 1 2 3\n"), &options, &rays);
        let hits = printed.lines().filter(|line| line.contains("true")).count();
        assert!(hits > 100, "{options}: {hits} hits");
        for line in printed.lines() {
            let (_, weights) = line.split_once("barycentric\":[").unwrap_or_default();
            let (weights, _) = weights.split_once(']').unwrap_or_default();
            assert!(
                !weights.contains("[-") && !weights.contains(",-") && !weights.starts_with('-'),
                "{options}: {line}"
            );
        }
        // The plane z = 0 from above, at x = 0.
        let printed = text(PLANE, &options, "-0.0 -0.0 1 0 0 -1\n");
        assert!(!printed.contains("-0"), "{options}: {printed}");
    }
}

#[test]
fn rays_of_f32_numbers_are_not_rounded_where_the_files_numbers_are_f32() {
    let mesh = "v 1000 0 0\nv 1000 1 0\nv 1000 0 1\nf 1 2 3\n";
    for kernel in ["watertight", "precise", "exact"] {
        let options = format!("--kernel {kernel}");
        // A billionth below the edge y = 0, and on it, and above it.
        let rays = "0 -1e-9 0.5 1 0 0\n0 0 0.5 1 0 0\n0 1e-9 0.5 1 0 0\n";
        let found = answers(mesh, &options, rays);
        let are_hits: Vec<_> = found.iter().map(|answer| answer["hit"].clone()).collect();
        assert_eq!(are_hits, [false, true, true], "{kernel}");
        // Half an ulp of 1e-9.
        let bound = 2f64.powi(-54);
        assert!(
            found.iter().all(|answer| rounding(answer) <= bound),
            "{found:?}"
        );
        assert_eq!(found[1]["t"], 1000.0);
    }
}

#[test]
fn hit_or_miss_of_f32_rays_about_a_far_f32_mesh_is_the_oracles() {
    let mut random = Random::new(11);
    let mut near = |middle: f32| Vec3::splat(middle) + 0.5 * random.in_cube_f32();
    let corners = [near(1000.0), near(1000.0), near(1000.0)];
    let rays: Vec<Ray> = (0..20_000)
        .map(|k| {
            // At an edge: which side is decided by what f32 leaves of the direction.
            let (from, to) = (corners[k % 3], corners[(k + 1) % 3]);
            let target = from + (to - from) * ((k as f32 + 0.5) / 20_000.0);
            let origin = near(0.0);
            Ray::new(origin, target - origin).expect("a ray")
        })
        .collect();
    let vertex = |p: &Vec3| "v ".to_owned() + &line(p.as_dvec3().to_array());
    let mesh: String = corners.iter().map(vertex).collect();
    let numbers = |ray: &Ray| ray.origin.to_array().into_iter().chain(ray.dir.to_array());
    let lines: String = rays
        .iter()
        .map(|ray| line(numbers(ray).map(f64::from)))
        .collect();
    let found = answers(&(mesh + "f 1 2 3\n"), "--kernel exact", lines);
    let mut hits = 0;
    for (answer, ray) in found.iter().zip(&rays) {
        let expected = oracle::intersect(ray, corners);
        assert_eq!(answer["hit"], expected.is_some(), "{ray:?}: {answer}");
        assert_eq!(rounding(answer), 0.0, "{ray:?}");
        hits += usize::from(expected.is_some());
    }
    // Some of both, or nothing was decided.
    assert!((2_000..18_000).contains(&hits), "{hits}");
}

#[test]
fn rays_from_far_away_hit_what_they_aim_at() {
    let mesh = "v 500000 4649776 0\nv 500001 4649776 0\nv 500000 4649777 0\nf 1 2 3\n";
    let found = &answers(mesh, "", "1000500032.1 4649776.25 1000000031.85 -1 0 -1\n")[0];
    assert_eq!(found["hit"], true);
    assert_eq!(found["t"], 1_000_000_031.85);
    // The origin's decimals are rounded to f64 by up to 2⁻²⁴ and 2⁻²⁴, an ulp of f32 at 0.25 is 2⁻²⁶.
    assert!(rounding(found) < 2f64.powi(-23), "{found}");

    let mut random = Random::new(3);
    let mut rays = String::new();
    let mut expected = Vec::new();
    for distance in [1.0, 1e3, 1e6, 1e9].map(|x: f64| 2f64.powi(x.log2() as i32)) {
        for _ in 0..200 {
            // Sums and products of so few bits are exact in f64, and near the mesh in f32.
            let target = [0; 2].map(|_| (random.signed() * 1024.0).round() / 1024.0);
            let slope = [0; 2].map(|_| (random.signed() * 64.0).round() / 64.0);
            let origin = [
                500_000.0 + target[0] - distance * slope[0],
                4_649_776.0 + target[1] - distance * slope[1],
                distance,
            ];
            rays += &line(origin.into_iter().chain([slope[0], slope[1], -1.0]));
            let [x, y] = target;
            expected.push((x >= 0.0 && y >= 0.0 && x + y <= 1.0, distance));
        }
    }
    for kernel in ["watertight", "precise", "exact"] {
        for end in ["", " --any"] {
            let found = answers(mesh, &format!("--kernel {kernel}{end}"), &rays);
            assert_eq!(found.len(), expected.len());
            for (answer, (is_hit, distance)) in found.iter().zip(&expected) {
                assert_eq!(answer["hit"], *is_hit, "{kernel}{end}: {answer}");
                assert_eq!(rounding(answer), 0.0, "{answer}");
                if *is_hit && end.is_empty() {
                    // From the start near the mesh, within its size: an ulp or two of f32 at up to 4.
                    let t = answer["t"].as_f64().expect("a number");
                    assert!((t - distance).abs() < 1e-6, "{distance}: {answer}");
                }
            }
        }
    }
}

#[test]
fn the_interval_is_that_of_the_ray_as_given() {
    // From 10⁹ away, where an f32 would be rounded by up to 32.
    let far = [0.25, 0.25, 1_000_000_001.5, 0.0, 0.0, -1.0];
    let t = far[2];
    let cases = [
        ([0.0, f64::INFINITY], true),
        ([t - 0.25, t + 0.25], true),
        ([t - 0.5, t], false),
        ([t, t + 0.5], false),
        ([0.0, 5.0], false),
        // Ends before the mesh by less than the rounding of the origin.
        ([0.0, t - 12.0], false),
        ([-5.0, t - 1.0], false),
        ([t - 1e-6, f64::INFINITY], true),
        ([f64::NEG_INFINITY, f64::INFINITY], true),
        ([t + 5.0, t + 6.0], false),
    ];
    let rays: String = cases
        .iter()
        .map(|(ends, _)| line(far.into_iter().chain(*ends)))
        .collect();
    for kernel in ["watertight", "exact"] {
        let found = answers(PLANE, &format!("--kernel {kernel}"), &rays);
        for (answer, (ends, is_hit)) in found.iter().zip(&cases) {
            assert_eq!(answer["hit"], *is_hit, "{kernel} {ends:?}: {answer}");
            if *is_hit {
                assert_eq!(answer["t"], t, "{kernel} {ends:?}");
            }
        }
    }
    // Ends that aren't f32 numbers are compared as given with a t that is.
    let t = f64::from(0.1f32);
    let near = |ends: [f64; 2]| line([0.25, 0.25, t, 0.0, 0.0, -1.0].into_iter().chain(ends));
    let rays = near([t - 1e-12, 1.0])
        + &near([0.0, t + 1e-12])
        + &near([t - 2e-12, t - 1e-12])
        + "0 0 1 0 0 -1 2 1\n";
    let found = answers(PLANE, "", rays);
    let are_hits: Vec<_> = found.iter().map(|answer| answer["hit"].clone()).collect();
    assert_eq!(are_hits[..3], [true, true, false]);
    assert_eq!(
        found[3]["error"],
        "tmin must be less than tmax, and neither may be NaN"
    );
}

#[test]
fn what_is_left_of_rounding_is_told() {
    // Decimals near the mesh: 0.1 alone is rounded.
    let found = &answers(PLANE, "", "0.1 0.5 1 0 0 -1\n")[0];
    assert_eq!(rounding(found), f64::from(0.1f32) - 0.1);
    // A direction that is rounded matters more at the far end of the mesh, 5 lengths away.
    let slope = 0.1f64;
    let long = "v 0 0 -5\nv 1 0 -5\nv 0 1 0\nf 1 2 3\n";
    let found = &answers(long, "", line([0.25, 0.25, 0.0, slope, 0.0, -1.0]))[0];
    let error = f64::from(0.1f32) - slope;
    assert!(
        (5.0 * error..8.0 * error).contains(&rounding(found)),
        "{found} {error}"
    );
    // --any and --all tell it, too.
    for options in ["--any", "--all"] {
        assert_eq!(
            rounding(&answers(PLANE, options, "0.1 0.5 1 0 0 -1\n")[0]),
            f64::from(0.1f32) - 0.1
        );
    }
}

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
    let line = "@scene.xml --rays @rays.txt --all";
    let text = folder.text(|folder, out| folder.args::<TraceArgs>(line).run(out));
    let heights = |line: &str| -> Vec<i64> {
        let answer: Value = serde_json::from_str(line).expect("JSON");
        let hits = answer["hits"].as_array().expect("a list");
        let height = |hit: &Value| hit["position"][2].as_f64().expect("a number").round() as i64;
        hits.iter().map(height).collect()
    };
    let found: Vec<_> = text.lines().map(heights).collect();
    assert_eq!(found, [vec![1000, 1, -1, -1000], vec![-1000]]);
}
