//! The lines and rays that `trace` reads.

use super::{PLANE, answers, line};
use serde_json::{Value, json};

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
