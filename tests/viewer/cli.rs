//! The built program's commands, and what it does without a display.

use crate::harness::gpu;
use std::path::Path;
use std::process::{Command, Output};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const OCTAHEDRON: &str = "v 1 0 0\nv 0 1 0\nv 0 0 1\nv -1 0 0\nv 0 -1 0\nv 0 0 -1
f 1 2 3\nf 2 4 3\nf 4 5 3\nf 5 1 3\nf 2 1 6\nf 4 2 6\nf 5 4 6\nf 1 5 6\n";

/// Runs the program in a folder, with no display.
fn hitscope(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hitscope"))
        .args(args)
        .current_dir(folder)
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WAYLAND_SOCKET")
        .output()
        .expect("the program runs")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("good.obj"), TRIANGLE).expect("written");
    std::fs::write(folder.path().join("bad.obj"), "v 0 0 0\nf 1 1 7\n").expect("written");
    folder
}

#[test]
fn exit_statuses_tell_done_from_bad_input_from_bad_usage() {
    let folder = folder();
    let cases: [(&[&str], i32, &str); 8] = [
        (&["info", "good.obj"], 0, ""),
        (
            &["info", "bad.obj"],
            1,
            "hitscope: bad.obj:2: vertex index 7 is out of range: there are 1\n",
        ),
        (&["info", "none.obj"], 1, "hitscope: none.obj: "),
        (
            &[
                "render",
                "good.obj",
                "-o",
                "no/folder.png",
                "--samples",
                "1",
                "--size",
                "4x4",
            ],
            1,
            "hitscope: no/folder.png: ",
        ),
        (
            &["inspect", "good.obj", "--pixel", "9999,0"],
            1,
            "hitscope: pixel 9999,0 is outside",
        ),
        (&["render", "good.obj"], 2, "error: "),
        (
            &["trace", "good.obj", "--rays", "-", "--kernel", "none"],
            2,
            "error: ",
        ),
        (&["--nonsense"], 2, "error: "),
    ];
    for (args, status, message) in cases {
        let output = hitscope(folder.path(), args);
        assert_eq!(
            output.status.code(),
            Some(status),
            "{args:?}: {}",
            stderr(&output)
        );
        assert!(
            stderr(&output).starts_with(message),
            "{args:?}: {}",
            stderr(&output)
        );
        if status == 1 {
            assert_eq!(stderr(&output).lines().count(), 1, "{args:?}");
        }
    }
}

#[test]
fn without_a_display_the_picture_goes_to_a_file() {
    let folder = folder();
    for (args, name) in [
        (&[][..], "the built-in scene"),
        (&["good.obj"][..], "good.obj"),
    ] {
        let output = hitscope(folder.path(), args);
        assert!(output.status.success(), "{}", stderr(&output));
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(
            said.contains(&format!("rendered {name} to hitscope.png")),
            "{said}"
        );
        let image = image::open(folder.path().join("hitscope.png"))
            .expect("a PNG")
            .to_rgba8();
        let background = image.get_pixel(0, 0);
        assert!(image.pixels().any(|pixel| pixel != background));
        std::fs::remove_file(folder.path().join("hitscope.png")).expect("it was there");
    }
    let output = hitscope(folder.path(), &["bad.obj"]);
    assert_eq!(output.status.code(), Some(1));
}

#[test]
fn a_wireframe_is_drawn_over_a_render() {
    if gpu().is_none() {
        return;
    }
    let folder = folder();
    std::fs::write(folder.path().join("solid.obj"), OCTAHEDRON).expect("written");
    let render = |extra: &[&str]| {
        let args = [
            "render",
            "solid.obj",
            "-o",
            "out.png",
            "--size",
            "600x400",
            "--samples",
            "1",
            "--eye",
            "4,1,0.2",
        ];
        let output = hitscope(folder.path(), &[&args, extra].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        image::open(folder.path().join("out.png"))
            .expect("a PNG")
            .to_rgba8()
    };
    let plain = render(&[]);
    for overlay in ["--wireframe", "--normals"] {
        let drawn = render(&[overlay]);
        let changed = plain
            .pixels()
            .zip(drawn.pixels())
            .filter(|(a, b)| a != b)
            .count();
        // Some pixels, and by far not all.
        assert!(
            (10..24_000).contains(&changed),
            "{overlay}: {changed} pixels"
        );
    }
}

#[test]
fn a_simd_level_that_the_machine_has_not_got_is_refused() {
    let folder = folder();
    let run = |level: &str| {
        Command::new(env!("CARGO_BIN_EXE_hitscope"))
            .args(["info", "good.obj"])
            .current_dir(folder.path())
            .env("HITSCOPE_SIMD", level)
            .output()
            .expect("the program runs")
    };
    assert!(run("fallback").status.success());
    let refused = run("mmx");
    assert_eq!(refused.status.code(), Some(2));
    let text = stderr(&refused);
    assert!(
        text.starts_with("hitscope: HITSCOPE_SIMD=mmx: this machine has fallback"),
        "{text}"
    );
}
