//! Tests of usage errors: exit status 2, before the mesh is loaded.

use crate::program::{Program, assert_fails, stderr, stdout};
use hitscope_core::group::all_kernels;

#[test]
fn invalid_arguments_are_refused_before_the_mesh_is_loaded() {
    let program = Program::new();
    // The mesh doesn't exist, which would be the error otherwise.
    let render = "render none.obj -o out.png";
    let cases = [
        (&*format!("{render} --ortho 0"), "expected a height above 0"),
        (&format!("{render} --ortho -2"), "expected a height above 0"),
        (&format!("{render} --ortho 1e300"), "at most 3.4028235e38"),
        (
            &format!("{render} --fov -1"),
            "expected an angle in degrees, at least 0.000001",
        ),
        (
            &format!("{render} --fov 1e-300"),
            "expected an angle in degrees, at least 0.000001",
        ),
        (&format!("{render} --max-memory -5"), "an integer from 1"),
        (
            &format!("{render} --max-memory 17592186044416"),
            "from 1 to 17592186044415",
        ),
        (&format!("{render} --samples -1"), "-1 is not in 1..=65536"),
        (&format!("{render} --threads 0"), "0 is not in 1..=1024"),
        (&format!("{render} --size 1x16385"), "from 1 to 16384"),
        (
            &format!("{render} --eye 1,2"),
            "three numbers separated by commas",
        ),
        (
            &format!("{render} --eye 1,1,1 --target 1,1,1"),
            "eye and target are the same",
        ),
        (
            &format!("{render} --eye 0,5,0 --target 0,1,0"),
            "points along the view",
        ),
        (
            &format!("{render} --eye 0,5,0 --up 0,0,0"),
            "up vector is zero",
        ),
        ("inspect none.obj --pixel 9999,0", "is outside the picture"),
        ("inspect none.obj --pixel -1,0", "two non-negative integers"),
        ("lab --seed -1", "an integer from 0 to"),
        ("good.obj info", "hitscope info good.obj"),
        (
            &format!("{render} --environment constant:1,2"),
            "expected constant:R,G,B",
        ),
        (
            &format!("{render} --environment constant:-1"),
            "the radiance must not be negative",
        ),
        (
            &format!("{render} --environment constant:3e38"),
            "the radiance is too bright: a picture holds at most 2.8e14",
        ),
        (
            &format!("{render} --environment studoi"),
            "did you mean “studio”?",
        ),
        (
            &format!("{render} --environment="),
            "expected a file, constant:R,G,B, studio or built-in",
        ),
        (
            &format!("{render} --view triangle --environment studio"),
            "it needs --view direct, whitted, path, shading-normal or spawning",
        ),
        (
            &format!("{render} --rotation 400"),
            "expected degrees from -360 to 360",
        ),
        (
            &format!("{render} --spawn none"),
            "[possible values: fixed-epsilon",
        ),
        (
            &format!("{render} --overlay wirefram"),
            "a similar value exists: 'wireframe'",
        ),
        (
            &format!("{render} --overlay none"),
            "[possible values: wireframe, face-normals",
        ),
        (
            &format!("{render} --overlay picked"),
            "invalid value 'picked'",
        ),
        (
            "render none.obj -o out.exr --overlay grid",
            "overlays are drawn over PNG pictures only",
        ),
        (&format!("{render} --depth -1"), "--depth <N>"),
        (
            &format!("{render} --ao-distance 0"),
            "expected a distance above 0",
        ),
        (
            &format!("{render} --exposure 101"),
            "expected stops from -100 to 100",
        ),
        (&format!("{render} --tone bright"), "[possible values: clip"),
        (
            &format!("{render} --integrator bidirectional"),
            "[possible values: shaded",
        ),
        (
            &format!("{render} --view path --integrator direct"),
            "several views need {view} in the name of the output",
        ),
        (
            &format!("{render} --noise --samples 1"),
            "needs at least 2 samples",
        ),
        (
            "render none.obj -o /dev/stdout --noise",
            "write the picture to a file",
        ),
        (
            "inspect none.obj --pixel 0,0 --eye 1,1,1 --target 1,1,1",
            "eye and target are the same",
        ),
        (
            &format!("{render} --kernel watertihgt"),
            "did you mean watertight? `hitscope lab --help` lists all kernels",
        ),
        (
            "bench none.obj --kernel fast --kernel axis-box",
            "did you mean axis-box-slabs, axis-box-slabs-f64, axis-box-padded or axis-box-padded-f64?",
        ),
        (
            &format!("{render} --against embree"),
            "expected fast, watertight, precise, exact, or an algorithm that `hitscope lab --help` lists",
        ),
        ("bench none.obj --threads 9999999", "is not in 1..=1024"),
        ("bench none.obj --rounds 0", "0 is not in 1..=1000"),
        (
            "bench none.obj --eye 1,1,1 --target 1,1,1",
            "eye and target are the same",
        ),
        ("lab --case nonsense", "case names begin with one of box"),
        (
            "lab --scene none.obj --eye 1,1,1 --target 1,1,1",
            "eye and target are the same",
        ),
        (
            "render none.obj -o out.jpg",
            "must end in .png or .exr, or --format must be given",
        ),
        (
            "render none.obj -o out.png --turntable 3",
            "several cameras need {index} in the names of outputs",
        ),
        (
            "render none.obj -o {index}.png --turntable 0",
            "0 is not in 1..=100000",
        ),
        (
            "render none.obj -o out.png --cameras c.json --eye 1,2,3",
            "cannot be used with",
        ),
        (
            &format!("{render} --look-at edge:3"),
            "expected triangle:N, face:N, vertex:N, line:N or X,Y,Z",
        ),
        (
            &format!("{render} --look-at face:3 --eye 1,1,1 --target 0,0,0"),
            "cannot be used with",
        ),
        ("inspect none.obj", "--pixel <X,Y>"),
        ("compare none.obj -", "not standard input"),
        ("compare none.obj none.png", "a picture can't be compared"),
        ("compare none.obj none.obj --points 0", "0 is not in 1..="),
        ("compare none.obj none.obj --limit 1", "--output <OUT.png>"),
        ("compare a.obj b.obj -o out.exr", "only PNG files"),
        ("trace - --rays -", "can't both come from standard input"),
        ("-", "the window can't show standard input"),
    ];
    for (line, message) in cases {
        let ran = program.run(line);
        assert_fails(&ran, 2, "error: ");
        assert!(stderr(&ran).contains(message), "{line}: {}", stderr(&ran));
    }
}

#[test]
fn usage_errors_show_the_usage_of_their_command() {
    let program = Program::new();
    for (line, usage) in [
        (
            "render none.obj -o out.png --crease 30",
            "Usage: hitscope render",
        ),
        ("inspect none.obj --pixel 9999,0", "Usage: hitscope inspect"),
        ("good.obj other.obj", "Usage: hitscope [OPTIONS]"),
    ] {
        let ran = program.run(line);
        assert_fails(&ran, 2, "error: ");
        assert!(stderr(&ran).contains(usage), "{line}: {}", stderr(&ran));
    }
}

#[test]
fn options_without_effect_are_refused() {
    let program = Program::new();
    let render = "render none.obj -o out.png";
    let cases = [
        (
            &*format!("{render} --against fast"),
            "it needs --view disagreement",
        ),
        (
            &format!("{render} --against fast --view error-t"),
            "it needs --view disagreement",
        ),
        (
            &format!("{render} --environment studio"),
            "no effect on the view “shaded”: it needs --view",
        ),
        (
            &format!("{render} --view ao --environment studio"),
            "no effect on the view “ao”: it needs --view",
        ),
        (
            &format!("{render} --rotation 90"),
            "no effect on the view “shaded”: it needs --view",
        ),
        (
            &format!("{render} --view path --environment studio --rotation 90"),
            "as in --environment FILE",
        ),
        (
            &format!("{render} --spawn fixed-epsilon"),
            "no effect on the view “shaded”: it needs --view ao, direct",
        ),
        (
            &format!("{render} --view direct --depth 3"),
            "no effect on the view “direct”: it needs --view",
        ),
        (
            &format!("{render} --view ao --terminator chiang"),
            "no effect on the view “ao”: it needs --view",
        ),
        (
            &format!("{render} --view path --ao-distance 1"),
            "it needs --view ao",
        ),
        (
            &format!("{render} --view normal --exposure 1"),
            "no effect on the view “normal”: it needs --view shaded, direct",
        ),
        (
            &format!("{render} --view normal --tone clip"),
            "no effect on the view “normal”: it needs --view shaded, direct",
        ),
        (
            &format!("{render} --crease 30"),
            "it needs --shading smooth",
        ),
        (
            "inspect none.obj --pixel 1,1 --crease 30",
            "it needs --shading smooth",
        ),
        ("lab --quick --eye 1,2,3", "--scene <FILE>"),
        ("lab --quick --size 10x10", "--scene <FILE>"),
        ("lab --quick --lenient", "--scene <FILE>"),
        ("lab --quick --max-memory 5", "--scene <FILE>"),
        ("lab --quick --compact", "--scene <FILE>"),
        ("lab --quick --seed 2 --eye 1,2,3", "cannot be used with"),
        ("lab --case order-edge --lenient", "cannot be used with"),
        (&format!("{render} --target 1,2,3"), "--eye <X,Y,Z>"),
        ("good.obj --after 3", "--screenshot <OUT.png>"),
        (
            "good.obj --screenshot out.png --after last",
            "a non-negative number of seconds, or “first”",
        ),
    ];
    for (line, message) in cases {
        let ran = program.run(line);
        assert_fails(&ran, 2, "error: ");
        assert!(stderr(&ran).contains(message), "{line}: {}", stderr(&ran));
    }
}

#[test]
fn a_camera_that_does_not_fit_the_mesh_is_a_usage_error() {
    let program = Program::new();
    // The middle of the mesh.
    let ran = program.run("inspect good.obj --pixel 0,0 --eye 0.5,0.5,0");
    assert_fails(&ran, 2, "error: the camera's eye and target are the same");
}

#[test]
fn up_vectors_may_have_any_length() {
    let program = Program::new();
    let inspect = "inspect good.obj --pixel 3,3 --size 8x8 --eye 0.2,0.2,3 --json --up";
    let usual = program.run(&format!("{inspect} 1,1,0"));
    assert!(usual.status.success(), "{}", stderr(&usual));
    let long = program.run(&format!("{inspect} 1e308,1e308,0"));
    assert!(long.status.success(), "{}", stderr(&long));
    assert_eq!(stdout(&long), stdout(&usual));
}

#[test]
fn misspelt_commands_and_several_files_get_a_hint() {
    let program = Program::new();
    for (line, hint) in [
        ("rander good.obj", "did you mean “render”?"),
        ("rander good.obj -o out.png", "did you mean “render”?"),
        ("ifno", "did you mean “info”?"),
        ("INFO good.obj", "did you mean “info”?"),
        ("traces good.obj --rays -", "did you mean “trace”?"),
        ("good.obj bad.obj", "the window shows one file"),
    ] {
        let ran = program.run(line);
        assert_fails(&ran, 2, "error: ");
        assert!(stderr(&ran).contains(hint), "{line}: {}", stderr(&ran));
    }
    // An existing file isn't a misspelt command.
    std::fs::rename(program.path("bad.obj"), program.path("rander")).expect("renamed");
    let ran = program.run("rander");
    assert_eq!(ran.status.code(), Some(1));
    assert!(stderr(&ran).contains("rander:2: "), "{}", stderr(&ran));
}

#[test]
fn only_the_help_of_lab_lists_all_kernels() {
    let program = Program::new();
    // Without line breaks.
    let help = |line: &str| {
        let text = stdout(&program.run(line));
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    for command in ["render", "inspect", "trace", "bench", "converge"] {
        for option in ["-h", "--help"] {
            let text = help(&format!("{command} {option}"));
            assert!(text.contains("`hitscope lab --help`"), "{text}");
            assert!(!text.contains("torus-shifted"), "{text}");
        }
    }
    assert!(!help("lab -h").contains("torus-shifted"));
    let all = help("lab --help");
    for shape in all_kernels() {
        for kernel in shape.kernels {
            assert!(all.contains(&format!(" {}", kernel.name)), "{all}");
        }
    }
}

#[test]
fn every_command_has_a_version_and_help_with_examples() {
    let program = Program::new();
    let version = format!("{}\n", hitscope::about::version_and_target());
    for command in [
        "", "render", "inspect", "trace", "info", "compare", "lab", "bench", "converge",
    ] {
        let ran = program.run(&format!("{command} --version"));
        assert!(stdout(&ran).ends_with(&version), "{command}");
        let help = stdout(&program.run(&format!("{command} --help")));
        assert!(help.contains("Examples:"), "{command}: {help}");
    }
    let help = stdout(&program.run("--help"));
    for part in ["Exit status:", "Limits:"] {
        assert!(help.contains(part), "{help}");
    }
}
