//! `trace`: the lines it reads, the numbers it prints, and rays that are rounded.

// Lines of input, and intervals.
mod input;
// How numbers are written.
mod numbers;
// Rays with more digits than f32 has, and rays from far away.
mod rounding;
// Normals and positions.
mod surfaces;

use crate::folder::Folder;
use hitscope_lab::commands::TraceArgs;
use serde_json::Value;

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
