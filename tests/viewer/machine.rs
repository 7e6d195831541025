//! Tests of standard input, warnings, and machines that lack memory or threads.

use crate::program::{Program, assert_fails, stderr, stdout};

/// A mesh with three faults that don't keep it from loading: a missing library, a missing material, a face of zero
/// area.
const ODD: &str = "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nf 1 1 2\n";

#[test]
fn warnings_are_printed_one_per_line_even_if_stderr_is_not_a_terminal() {
    let program = Program::new();
    program.write("odd.obj", ODD);
    program.write("rays.txt", "0.2 0.2 1 0 0 -1\n");
    let info = stdout(&program.run("info odd.obj --json"));
    let info: serde_json::Value = serde_json::from_str(&info).expect("JSON");
    let warnings = info["warnings"].as_array().expect("a list");
    assert!(warnings.len() >= 2, "{info}");
    let expected: String = warnings
        .iter()
        .map(|warning| format!("odd.obj: warning: {}\n", warning.as_str().expect("a text")))
        .collect();
    for line in [
        "info odd.obj",
        "trace odd.obj --rays rays.txt",
        "inspect odd.obj --pixel 0,0",
        "render odd.obj -o out.png --size 4x4 --samples 1",
        "bench odd.obj --size 4x4 --rounds 1",
    ] {
        let ran = program.run(line);
        assert!(ran.status.success(), "{line}: {}", stderr(&ran));
        assert_eq!(stderr(&ran), expected, "{line}");
    }
}

#[test]
fn a_mesh_can_be_read_from_standard_input() {
    let program = Program::new();
    program.write("rays.txt", "0.2 0.2 1 0 0 -1\n");
    let good = std::fs::read_to_string(program.path("good.obj")).expect("there");
    for line in [
        "trace FILE --rays rays.txt",
        "inspect FILE --pixel 600,300 --json",
        "render FILE -o /dev/stdout --size 40x30 --samples 1",
    ] {
        let from_file = program.run(&line.replace("FILE", "good.obj"));
        let piped = program.run_with_input(&line.replace("FILE", "-"), &good);
        assert!(piped.status.success(), "{line}: {}", stderr(&piped));
        assert_eq!(piped.stdout, from_file.stdout, "{line}");
    }
    for line in [
        "info -",
        "lab --quick --scene - --size 8x8",
        "bench - --size 8x8 --rounds 1",
    ] {
        let piped = program.run_with_input(line, &good);
        assert!(piped.status.success(), "{line}: {}", stderr(&piped));
    }
    let ran = program.run_with_input("info -", "v 0 0 0\nf 1 1 7\n");
    assert_fails(&ran, 1, "hitscope: standard input:2: vertex index 7 ");
    let ran = program.run_with_input("info -", ODD);
    assert!(ran.status.success(), "{}", stderr(&ran));
    let said = stderr(&ran);
    assert!(said.starts_with("standard input: warning: "), "{said}");
    assert!(said.contains("standard input has no folder"), "{said}");
}

#[test]
fn the_threads_of_the_command_line_load_and_build() {
    let program = Program::new();
    let load_threads = |options: &str| {
        let line = format!("bench good.obj --size 4x4 --rounds 1 --json {options}");
        let mut command = program.command();
        command.env("RAYON_NUM_THREADS", "3");
        let ran = command.args(line.split_whitespace()).output();
        let report = stdout(&ran.expect("the program runs"));
        let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
        report["load_threads"].clone()
    };
    assert_eq!(load_threads(""), 3);
    assert_eq!(load_threads("--threads 1"), 1);
}

#[test]
fn a_lack_of_threads_is_reported_in_one_line() {
    let program = Program::new();
    for line in [
        "info good.obj",
        "bench good.obj",
        "render good.obj -o out.png",
        "good.obj",
    ] {
        // No address space can hold such a stack, so no thread can be started.
        let mut command = program.command();
        command.env("RUST_MIN_STACK", (1_u64 << 60).to_string());
        let ran = command.args(line.split_whitespace()).output();
        let ran = ran.expect("the program runs");
        assert_fails(&ran, 1, "hitscope: the system grants no threads: ");
    }
}

#[test]
fn a_picture_too_large_for_the_memory_is_reported_in_one_line() {
    let program = Program::new();
    // 105 bytes for each of 67 million pixels, with a limit of 3 GB.
    let ran = program
        .shell("ulimit -v 3000000; exec \"$hitscope\" render good.obj -o out.exr --size 8192x8192");
    let message = "hitscope: there isn't enough memory for a picture of 8192x8192 pixels";
    assert_fails(&ran, 1, message);
}

#[test]
fn the_memory_limit_includes_the_picture_and_refuses_nothing_that_fits() {
    let program = Program::new();
    // 105 bytes for each of 180 000 pixels: 18.02 MiB.
    let render = |more: &str| program.run(&format!("render {more} -o out.exr --size 600x300"));
    assert!(render("good.obj --max-memory 19").status.success());
    let ran = render("none.obj --max-memory 18");
    assert_fails(&ran, 2, "error: a picture of 600x300 pixels takes 19 MB");
    let ran = program
        .run("render good.obj -o out.png --size 600x300 --depth-map depth.exr --max-memory 18");
    assert_fails(&ran, 2, "error: a picture of 600x300 pixels takes 19 MB");
    // The picture that replaces the window: 105 bytes for each of 1280 × 720 pixels, 92.3 MiB.
    let ran = program.run("good.obj --max-memory 92");
    assert_eq!(ran.status.code(), Some(2), "{}", stderr(&ran));
    let ran = program.run("good.obj --max-memory 95");
    assert_eq!(ran.status.code(), Some(0), "{}", stderr(&ran));
    // A mesh whose triangles take more than the remaining MiB.
    let vertices: String = (0..16_000)
        .map(|k| format!("v {k} 0 0\nv {k} 1 {k}\n"))
        .collect();
    let faces: String = (1..31_998)
        .map(|k| format!("f {k} {} {}\n", k + 1, k + 2))
        .collect();
    program.write("strip.obj", vertices + &faces);
    assert!(render("strip.obj --max-memory 50").status.success());
    let ran = render("strip.obj --max-memory 19");
    assert_eq!(ran.status.code(), Some(1), "{}", stderr(&ran));
    assert!(stderr(&ran).contains("--max-memory"), "{}", stderr(&ran));
}

#[test]
fn a_large_png_picture_is_rendered_in_strips_of_less_memory() {
    let program = Program::new();
    // 105 bytes for each of 4 million pixels: 420 MiB.
    let render = |more: &str| {
        let line = format!("render good.obj --samples 1 --size 4096x1024 {more}");
        program.run(&line)
    };
    let ran = render("-o whole.exr --max-memory 100");
    assert_fails(&ran, 2, "error: a picture of 4096x1024 pixels takes 420 MB");
    for (name, limit) in [("large.png", 8192), ("strips.png", 40)] {
        let ran = render(&format!("-o {name} --max-memory {limit}"));
        assert!(ran.status.success(), "{}", stderr(&ran));
    }
    let read = |name: &str| std::fs::read(program.path(name)).expect("written");
    let large = read("large.png");
    assert_eq!(
        large[16..24],
        [4096_u32, 1024].map(u32::to_be_bytes).concat()
    );
    assert!(large == read("strips.png"));
    // Not even one row of tiles.
    let ran = render("-o large.png --max-memory 16");
    assert_eq!(ran.status.code(), Some(1), "{}", stderr(&ran));
    assert!(stderr(&ran).contains("a picture of 4096x1024 pixels takes 20 MB"));
}
