//! Tests of the program's exit statuses and of its behaviour without a display.

use crate::program::{Program, assert_fails, stderr, stdout};

#[test]
fn exit_statuses_distinguish_success_bad_input_and_bad_usage() {
    let program = Program::new();
    for (line, status, message) in [
        (
            "info bad.obj",
            1,
            "hitscope: bad.obj:2: vertex index 7 is out of range: there is 1\n",
        ),
        ("info none.obj", 1, "hitscope: none.obj: "),
        ("trace good.obj --rays none.txt", 1, "hitscope: none.txt: "),
        ("render good.obj", 2, "error: "),
        ("trace good.obj --rays - --kernel none", 2, "error: "),
        ("--nonsense", 2, "error: "),
    ] {
        assert_fails(&program.run(line), status, message);
    }
    let ran = program.run("info good.obj");
    assert_eq!((ran.status.code(), stderr(&ran)), (Some(0), String::new()));
}

#[test]
fn without_a_display_a_picture_is_written_to_a_file() {
    let program = Program::new();
    for (line, name) in [("", "the built-in scene"), ("good.obj", "good.obj")] {
        let ran = program.run(line);
        assert!(ran.status.success(), "{}", stderr(&ran));
        let said = stdout(&ran);
        assert!(
            said.contains(&format!("rendered {name} to hitscope.png")),
            "{said}"
        );
        let image = image::open(program.path("hitscope.png"))
            .expect("a PNG")
            .to_rgba8();
        let background = image.get_pixel(0, 0);
        assert!(image.pixels().any(|pixel| pixel != background));
        std::fs::remove_file(program.path("hitscope.png")).expect("it was there");
    }
    assert_eq!(program.run("bad.obj").status.code(), Some(1));
}

#[test]
fn an_unavailable_simd_level_is_refused() {
    let program = Program::new();
    let run = |level: &str| {
        let mut command = program.command();
        command
            .args(["info", "good.obj"])
            .env("HITSCOPE_SIMD", level);
        command.output().expect("the program runs")
    };
    assert!(run("fallback").status.success());
    let message = "hitscope: HITSCOPE_SIMD=mmx: this machine has fallback";
    assert_fails(&run("mmx"), 2, message);
}
