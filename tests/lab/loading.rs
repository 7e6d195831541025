//! Tests of loading meshes, and of the output of `info`.

use crate::folder::{CUBE, Folder};
use hitscope_lab::commands::{BenchArgs, InfoArgs, InspectArgs, RenderArgs};
use serde_json::json;

fn info(folder: &Folder, line: &str) -> serde_json::Value {
    folder.json(|f, out| f.args::<InfoArgs>(line).run(out))
}

#[test]
fn a_file_with_an_invalid_face_is_refused_or_the_face_is_dropped() {
    let folder = Folder::new();
    folder.write("bad.obj", &format!("{CUBE}f 1 2 99\n"));
    let strict = folder.args::<InfoArgs>("@bad.obj").run(&mut Vec::new());
    let error = strict.expect_err("refused").to_string();
    assert!(
        error.ends_with("bad.obj:17: vertex index 99 is out of range: there are 8"),
        "{error}"
    );
    let info = info(&folder, "@bad.obj --json --lenient");
    assert_eq!(info["triangles"], 12);
    assert_eq!(info["dropped"]["bad_index"], 1);
    assert_eq!(info["health"]["bad_index"], 1);
}

#[test]
fn a_file_that_needs_too_much_memory_is_refused() {
    let folder = Folder::new();
    folder.write("large.obj", &CUBE.repeat(20_000));
    let result = folder
        .args::<InfoArgs>("@large.obj --max-memory 4")
        .run(&mut Vec::new());
    let error = result.expect_err("refused").to_string();
    assert!(error.contains("--max-memory"), "{error}");
    assert_eq!(info(&folder, "@large.obj --json")["triangles"], 240_000);
}

#[test]
fn info_and_bench_group_the_digits_of_every_count() {
    let folder = Folder::new();
    folder.write("many.obj", &CUBE.repeat(200));
    let text = folder.text(|f, out| f.args::<InfoArgs>("@many.obj").run(out));
    let (narrow, has_long_run) = ('\u{202f}', |text: &str| {
        let digits = text.split(|c: char| !c.is_ascii_digit());
        digits.into_iter().any(|run| run.len() > 3)
    });
    for line in [
        format!("\ntriangles           2{narrow}400\n"),
        format!("vertices            1{narrow}600\n"),
        format!("2{narrow}400 triangles: tree of "),
    ] {
        assert!(text.contains(&line), "{line} in {text}");
    }
    let counts = text
        .lines()
        .filter(|line| line.starts_with("bytes ") || line.ends_with(" bytes"));
    for line in counts {
        assert!(!has_long_run(line), "{line}");
    }
    let line = "@many.obj --size 64x64 --rounds 1 --threads 1 --kernel fast";
    let text = folder.text(|f, out| f.args::<BenchArgs>(line).run(out));
    assert!(
        text.starts_with(&format!("2{narrow}400 triangles; ")),
        "{text}"
    );
    let row = text.lines().find(|line| line.starts_with("primary"));
    let row = row.expect("a row");
    assert!(row.contains(&format!(" 4{narrow}096 ")), "{row}");
    assert!(!has_long_run(row), "{row}");
}

#[test]
fn info_reports_flaws_and_the_memory_of_other_representations() {
    let folder = Folder::new();
    let cube = info(&folder, "@cube.obj --json");
    assert_eq!(cube["bytes_as"]["triangle list"], 12 * 36);
    assert_eq!(cube["bytes_as"]["indexed"], 8 * 12 + 12 * 12);
    assert!(cube["bytes_as"]["strips"].as_u64() < cube["bytes_as"]["indexed"].as_u64());
    for flaw in [
        "open_edges",
        "t_junctions",
        "touching_vertices",
        "duplicates",
        "slivers",
    ] {
        assert_eq!(cube["health"][flaw], 0, "{flaw}");
    }
    folder.write("twice.obj", &format!("{CUBE}f 5 6 7\n"));
    let twice = info(&folder, "@twice.obj --json");
    assert_eq!(twice["health"]["duplicates"], 1);
    assert_eq!(twice["health"]["non_manifold_edges"], 3);
}

/// Positions print as in the file, and a hit's position is correct to a micrometre.
#[test]
fn survey_coordinates_are_printed_as_in_the_file() {
    let folder = Folder::new();
    folder.write(
        "utm.obj",
        "v 500000.000 4649776.000 100\nv 500000.001 4649776.000 100\nv 500000.000 4649776.001 100\nf 1 2 3\n",
    );
    let bounds = &info(&folder, "@utm.obj --json")["bounds"];
    assert_eq!(bounds["min"], json!([500_000.0, 4_649_776.0, 100.0]));
    assert_eq!(bounds["max"], json!([500_000.001, 4_649_776.001, 100.0]));
    let line = "@utm.obj --pixel 4,4 --size 9x9 --eye 500000.00025,4649776.00025,101 \
        --target 500000.00025,4649776.00025,100 --json";
    let hit = &folder.json(|f, out| f.args::<InspectArgs>(line).run(out))["hit"];
    assert_eq!(hit["vertices"][1], json!([500_000.001, 4_649_776.0, 100.0]));
    let [x, y, z] = [0, 1, 2].map(|axis| hit["position"][axis].as_f64().expect("a number"));
    for (found, expected) in [(x, 500_000.000_25), (y, 4_649_776.000_25), (z, 100.0)] {
        assert!((found - expected).abs() < 1e-6, "{found} isn't {expected}");
    }
}

#[test]
fn a_crease_angle_changes_smooth_shading() {
    let folder = Folder::new();
    let picture = |crease: &str| {
        let line = format!(
            "@cube.obj -o @out.png --size 16x16 --samples 1 --threads 1 --shading smooth --view normal{crease}"
        );
        let rendered = folder.args::<RenderArgs>(&line).trace().expect("rendered");
        rendered.film.pixels().to_vec()
    };
    let smooth = picture("");
    assert_eq!(picture(" --crease 91"), smooth);
    let creased = picture(" --crease 30");
    assert_ne!(creased, smooth);
    // A cube with creases looks flat: it has three colours and the background.
    let colours: std::collections::HashSet<[u8; 4]> = creased.into_iter().collect();
    assert_eq!(colours.len(), 4);
}
