//! The memory limit holds, and loads that fit are accepted. Each load runs in a process of its own, whose
//! peak memory Linux reports.
//!
//! `cargo test -p hitscope-core --test memory`. It is a program of its own because it starts itself for each
//! load.

use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::loading::{LoadedScene, is_scene_file};
use hitscope_core::obj::LoadOptions;
use hitscope_core::progress::Progress;
use hitscope_core::scene::SceneOptions;
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, ExitCode};

const MB: u64 = 1 << 20;
/// A load is accepted if the limit is this multiple of its peak. The estimate counts the numbers and the mesh of a triangle
/// soup in full, 24 + 12 + 5 bytes per vertex and 4 + 17 per corner and triangle, where part of the numbers has been
/// freed at the peak; the rest is for lists of names and line numbers, counted by capacity.
const ACCEPTED_FROM: f64 = 1.5;
/// A load is refused if the limit is this fraction of its peak. The allocator keeps some freed memory.
const REFUSED_BELOW: f64 = 0.9;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [word, file, limit] = &arguments[..]
        && word == "load"
    {
        load(Path::new(file), limit.parse().expect("a number"));
        return ExitCode::SUCCESS;
    }
    if peak().is_none() {
        eprintln!("skipped: only Linux reports a process's peak memory");
        return ExitCode::SUCCESS;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut is_good = true;
    let path = folder.path().join("base.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let base = loaded(&path, u64::MAX).expect("no limit");
    let small = grid(9, |[a, b, c, d]| format!("f {a} {b} {d} {c}\n"));
    std::fs::write(folder.path().join("small.obj"), small).expect("written");
    let meshes = meshes().into_iter().map(|mesh| ("x.obj", mesh));
    let scenes = scenes().into_iter().map(|scene| ("x.xml", scene));
    for (file, (name, text)) in meshes.chain(scenes) {
        let path = folder.path().join(file);
        std::fs::write(&path, text).expect("written");
        let peak = loaded(&path, u64::MAX).expect("no limit") - base;
        let limit = |factor: f64| (peak as f64 * factor) as u64;
        let accepted = loaded(&path, limit(ACCEPTED_FROM)).is_some();
        let refused = loaded(&path, limit(REFUSED_BELOW)).is_none();
        eprintln!(
            "{name}: {} MB; accepted within {ACCEPTED_FROM} of that: {accepted}; refused within {REFUSED_BELOW}: {refused}",
            peak / MB
        );
        is_good &= accepted && refused;
    }
    ExitCode::from(u8::from(!is_good))
}

/// Loads a file and prints the process's peak memory; prints nothing if the memory limit refuses the file. Shapes of a
/// scene file are also packed.
fn load(path: &Path, max_memory: u64) {
    let options = LoadOptions {
        max_memory,
        ..LoadOptions::default()
    };
    let progress = Progress::default();
    match LoadedScene::load(path, options, SceneOptions::default(), &progress) {
        Ok(loaded) => {
            let pack = || loaded.scene.intersector(default_triangle_kernel());
            let _packed = is_scene_file(path).then(pack);
            out(&peak().expect("Linux").to_string());
        }
        Err(error) => assert!(error.to_string().contains("--max-memory"), "{error}"),
    }
}

/// Peak memory of a process that loads a file; `None` if it refuses the file.
fn loaded(path: &Path, max_memory: u64) -> Option<u64> {
    let program = std::env::current_exe().expect("this program");
    let output = Command::new(program)
        .arg("load")
        .arg(path)
        .arg(max_memory.to_string())
        // Allocators keep memory per thread.
        .env("RAYON_NUM_THREADS", "2")
        .output()
        .expect("started");
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout)
        .expect("text")
        .trim()
        .parse()
        .ok()
}

/// This process's peak memory in bytes.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}

/// Meshes of several hundred thousand triangles, each with different lists.
fn meshes() -> Vec<(&'static str, String)> {
    vec![
        (
            "triangles",
            grid(450, |[a, b, c, d]| {
                format!("f {a} {b} {d}\nf {a} {d} {c}\n")
            }),
        ),
        (
            "quads",
            grid(450, |[a, b, c, d]| format!("f {a} {b} {d} {c}\n")),
        ),
        (
            "normals",
            grid(350, |corners| {
                let [a, b, c, d] = corners.map(|k| format!("{k}//{k}"));
                format!("f {a} {b} {d} {c}\n")
            }),
        ),
        ("soup", soup(150_000)),
        ("polygon", star(100_000)),
    ]
}

/// Scenes of many shapes.
fn scenes() -> Vec<(&'static str, String)> {
    let repeated = |count: usize, shape: &dyn Fn(usize) -> String| {
        (0..count).map(shape).collect::<Vec<String>>().join("\n")
    };
    let scene = |contents: &str| format!("<scene version='3.0.0'>\n{contents}\n</scene>\n");
    let at =
        |x: usize| format!("<transform name='to_world'><translate x='{x}' y='0.25'/></transform>");
    let sphere = |k: usize| {
        let (x, y) = (k % 1000, k / 1000);
        format!(
            "<shape type='sphere'><point name='center' x='{x}.25' y='{y}.5' z='0.1'/><float name='radius' value='0.4'/></shape>"
        )
    };
    let ellipsoid = |k: usize| {
        format!(
            "<shape type='sphere'><transform name='to_world'><scale x='1' y='2' z='3'/><translate x='{}'/></transform></shape>",
            9 * k
        )
    };
    let instance = |k: usize| {
        let name = "<string name='filename' value='small.obj'/>";
        format!("<shape type='obj'>{name}{}</shape>", at(10 * k))
    };
    let difference = |k: usize| {
        let operation = "<string name='operation' value='difference'/>";
        let operands = "<shape type='cube'/><shape type='sphere'/>";
        format!(
            "<shape type='csg'>{operation}{operands}{}</shape>",
            at(4 * k)
        )
    };
    let union = format!(
        "<shape type='csg'><string name='operation' value='union'/>{}</shape>",
        repeated(30_000, &|k| format!(
            "<shape type='sphere'>{}</shape>",
            at(3 * k)
        ))
    );
    vec![
        ("spheres", scene(&repeated(300_000, &sphere))),
        ("ellipsoids", scene(&repeated(150_000, &ellipsoid))),
        ("instances", scene(&repeated(4_000, &instance))),
        ("solids", scene(&repeated(20_000, &difference))),
        ("one solid", scene(&union)),
    ]
}

fn grid(side: usize, face: impl Fn([usize; 4]) -> String) -> String {
    let mut text = String::new();
    for k in 0..(side + 1) * (side + 1) {
        let (x, y) = (k % (side + 1), k / (side + 1));
        let height = (k * 7919 % 1000) as f64 / 1000.0;
        writeln!(text, "v {x}.000000 {y}.000000 {height:.6}\nvn 0 0 1").expect("memory");
    }
    for k in 0..side * side {
        let a = k % side + k / side * (side + 1) + 1;
        text += &face([a, a + 1, a + side + 1, a + side + 2]);
    }
    text
}

fn soup(triangles: usize) -> String {
    let mut text = String::new();
    for k in 0..triangles {
        writeln!(text, "v {k} 0 0\nv {k} 1 0\nv {k} 0 1\nf -3 -2 -1").expect("memory");
    }
    text
}

fn star(corners: usize) -> String {
    let (mut text, mut face) = (String::new(), String::from("f"));
    for k in 0..corners {
        let angle = k as f64 / corners as f64 * std::f64::consts::TAU;
        let radius = if k % 2 == 0 { 1.0 } else { 0.7 };
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        writeln!(text, "v {x:.9} {y:.9} 0").expect("memory");
        write!(face, " {}", k + 1).expect("memory");
    }
    text + &face + "\n"
}

#[expect(
    clippy::print_stdout,
    reason = "the parent process reads this program's output"
)]
fn out(line: &str) {
    println!("{line}");
}
