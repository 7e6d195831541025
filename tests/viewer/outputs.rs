//! Tests of the files that the program writes, completely or not at all.

use crate::program::{Program, assert_fails, stderr, stdout};
use std::fs;
use std::os::unix::fs::{FileTypeExt as _, PermissionsExt as _, symlink};

/// A text that isn't a PNG.
const OLD: &str = "an older file";
/// Options that render quickly, into more bytes than the limits below.
const SMALL: &str = "--size 300x200 --samples 1 --view barycentric";

#[test]
fn an_unwritable_path_is_refused_before_the_mesh_is_loaded() {
    let program = Program::new();
    // The mesh doesn't exist, which would be the error otherwise.
    let ran = program.run("render none.obj -o no/out.png");
    assert_fails(&ran, 1, "hitscope: no/out.png: ");
    assert!(
        stderr(&ran).ends_with("its folder doesn't exist\n"),
        "{}",
        stderr(&ran)
    );
    let ran = program.run("render none.obj -o /proc/out.png");
    assert_fails(&ran, 1, "hitscope: /proc/out.png: ");
    fs::create_dir(program.path("hitscope.png")).expect("made");
    let ran = program.run("none.obj");
    let lines = stderr(&ran);
    assert!(lines.contains("hitscope: hitscope.png: "), "{lines}");
    assert!(!lines.contains("none.obj"), "{lines}");
    // Before the measurement, which takes half a minute.
    let ran = program.run("lab --quick --out good.obj");
    assert_fails(&ran, 1, "hitscope: good.obj: ");
    fs::create_dir_all(program.path("report/lab.json")).expect("made");
    let ran = program.run("lab --quick --out report");
    assert_fails(&ran, 1, "hitscope: report/lab.json: ");
}

#[test]
fn several_views_with_legends_distances_and_numbers_are_written_at_once() {
    let program = Program::new();
    let ran = program.run(
        "render good.obj -o out-{view}.png --size 60x40 --samples 1 --view depth --view orientation --legend \
         --depth-map depth.exr --ids ids.exr --clip-plane 1,0,0,0.5",
    );
    assert!(ran.status.success(), "{}", stderr(&ran));
    let printed = stdout(&ran);
    assert!(
        printed.starts_with("depth: Distance from the eye: "),
        "{printed}"
    );
    assert_eq!(printed.lines().count(), 1, "{printed}");
    let size = |name: &str| image::image_dimensions(program.path(name)).expect("a picture");
    let (width, height) = size("out-depth.png");
    assert!(width > 60 && height == 40);
    assert_eq!(size("out-orientation.png"), (60, 40));
    for name in ["depth.exr", "ids.exr"] {
        let bytes = fs::read(program.path(name)).expect("written");
        assert_eq!(bytes[..4], [0x76, 0x2f, 0x31, 0x01], "{name}: OpenEXR");
    }
}

#[test]
fn a_full_device_is_an_error() {
    let program = Program::new();
    let ran = program.run(&format!("render good.obj -o /dev/full {SMALL}"));
    assert_fails(&ran, 1, "hitscope: /dev/full: No space left");
    for command in ["info good.obj", "inspect good.obj --pixel 5,5"] {
        let ran = program.shell(&format!("\"$hitscope\" {command} > /dev/full"));
        assert_fails(&ran, 1, "hitscope: stdout: No space left");
    }
    // The error message can't be printed, but the exit status is right.
    let ran = program.shell("\"$hitscope\" info bad.obj 2> /dev/full");
    assert_eq!(ran.status.code(), Some(1));
}

#[test]
fn a_program_killed_while_writing_leaves_the_old_file_and_no_other() {
    let program = Program::new();
    program.write("out.png", OLD);
    let before = program.names();
    // The system kills a program that writes more than eight blocks to a file.
    let ran = program.shell(&format!(
        "ulimit -f 8; exec \"$hitscope\" render good.obj -o out.png {SMALL}"
    ));
    assert_eq!(ran.status.code(), None, "killed by a signal");
    assert_eq!(
        fs::read_to_string(program.path("out.png")).expect("there"),
        OLD
    );
    assert_eq!(program.names(), before);
    // If it isn't killed, it reports the error.
    let ran = program.shell(&format!(
        "trap '' XFSZ; ulimit -f 8; exec \"$hitscope\" render good.obj -o out.png {SMALL}"
    ));
    assert_fails(&ran, 1, "hitscope: out.png: File too large");
    assert_eq!(
        fs::read_to_string(program.path("out.png")).expect("there"),
        OLD
    );
    assert_eq!(program.names(), before);
}

#[test]
fn the_lab_prints_its_tables_even_if_its_files_cannot_be_written() {
    let program = Program::new();
    let ran = program.shell(
        "trap '' XFSZ; ulimit -f 0; exec \"$hitscope\" lab --quick --case order-edge --out report",
    );
    assert_fails(&ran, 1, "hitscope: report/lab.json: File too large");
    let tables = stdout(&ran);
    assert!(tables.contains("watertight"), "{tables}");
    let left = fs::read_dir(program.path("report")).expect("made");
    assert_eq!(left.count(), 0);
}

#[test]
fn links_and_permissions_are_preserved() {
    let program = Program::new();
    program.write("old.png", OLD);
    let permissions = fs::Permissions::from_mode(0o604);
    fs::set_permissions(program.path("old.png"), permissions).expect("set");
    symlink("old.png", program.path("link.png")).expect("linked");
    symlink("link.png", program.path("link2.png")).expect("linked");
    symlink("new.png", program.path("dangling.png")).expect("linked");
    for link in ["link2.png", "dangling.png"] {
        let ran = program.run(&format!("render good.obj -o {link} {SMALL}"));
        assert!(ran.status.success(), "{}", stderr(&ran));
        let info = fs::symlink_metadata(program.path(link)).expect("there");
        assert!(info.is_symlink(), "{link}");
        assert!(image::open(program.path(link)).is_ok(), "{link}");
    }
    let mode = |name: &str| {
        let info = fs::symlink_metadata(program.path(name)).expect("there");
        assert!(info.is_file(), "{name}");
        info.permissions().mode() & 0o777
    };
    assert_eq!(mode("old.png"), 0o604);
    let ran = program.shell(&format!(
        "umask 027; \"$hitscope\" render good.obj -o mine.png {SMALL}"
    ));
    assert!(ran.status.success(), "{}", stderr(&ran));
    assert_eq!(mode("mine.png"), 0o640);
}

#[test]
fn pictures_can_be_written_to_pipes_and_devices() {
    let program = Program::new();
    let picture = |output: &std::process::Output| {
        assert!(output.status.success(), "{}", stderr(output));
        let picture = image::load_from_memory(&output.stdout).expect("a PNG");
        (picture.width(), picture.height())
    };
    let ran = program.run(&format!("render good.obj -o /dev/stdout {SMALL}"));
    assert_eq!(picture(&ran), (300, 200));
    let ran = program.run(&format!("render good.obj -o - {SMALL}"));
    assert_eq!(picture(&ran), (300, 200));
    let ran = program.run(&format!("render good.obj -o - --format exr {SMALL}"));
    assert!(ran.stdout.starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    assert_eq!(program.names(), ["bad.obj", "good.obj"]);
    // The file that stdout is redirected to is appended to, not replaced.
    let ran = program.shell(&format!(
        "(printf before; \"$hitscope\" render good.obj -o /dev/stdout {SMALL}) >> out.bin"
    ));
    assert!(ran.status.success(), "{}", stderr(&ran));
    let bytes = fs::read(program.path("out.bin")).expect("there");
    assert!(bytes.starts_with(b"before\x89PNG"));
    let ran = program.shell(&format!(
        "mkfifo pipe.png; cat pipe.png & \"$hitscope\" render good.obj -o pipe.png {SMALL}; wait"
    ));
    assert_eq!(picture(&ran), (300, 200));
    let ran = program.run(&format!("render good.obj -o /dev/null {SMALL}"));
    assert!(ran.status.success(), "{}", stderr(&ran));
    let null = fs::metadata("/dev/null").expect("there").file_type();
    assert!(null.is_char_device());
}

#[test]
fn a_mesh_is_not_overwritten_by_a_picture_of_it() {
    let program = Program::new();
    let before = fs::read(program.path("good.obj")).expect("there");
    for line in [
        "good.obj --screenshot good.obj",
        "--screenshot good.obj",
        "render good.obj -o good.obj",
    ] {
        let ran = program.run(line);
        assert_fails(&ran, 2, "error: ");
        assert!(stderr(&ran).contains("must end in .png"), "{line}");
    }
    assert_eq!(fs::read(program.path("good.obj")).expect("there"), before);
}

#[test]
fn progress_is_shown_on_terminals_only() {
    let program = Program::new();
    // Long enough for a bar on most machines.
    let long = "--size 300x300 --samples 64 --view path --threads 1";
    let ran = program.run(&format!("render good.obj -o out.png {long}"));
    assert!(ran.status.success());
    assert_eq!(stderr(&ran), "");
}

#[test]
fn a_closed_stdout_ends_the_program_quietly() {
    let program = Program::new();
    program.write("rays.txt", "0.2 0.2 1 0 0 -1\n".repeat(100_000));
    let ran = program
        .shell("{ \"$hitscope\" trace good.obj --rays rays.txt; echo $? > status; } | head -1");
    assert_eq!(stdout(&ran).lines().count(), 1);
    assert_eq!(stderr(&ran), "");
    let status = fs::read_to_string(program.path("status"));
    assert_eq!(status.expect("there").trim(), "0");
}
