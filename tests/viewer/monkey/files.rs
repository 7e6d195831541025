//! Files that the monkey opens: good ones, and broken ones of all kinds.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

const SCENE: &str = r#"<scene version="3.0.0">
<bsdf type="diffuse" id="red"><rgb name="reflectance" value="0.6, 0.1, 0.1"/></bsdf>
<sensor type="perspective"><transform name="to_world"><lookat origin="3,3,3" target="0,0,0" up="0,1,0"/></transform></sensor>
<shape type="sphere"><point name="center" x="2" y="0" z="0"/><float name="radius" value="0.5"/><ref id="red"/></shape>
<shape type="cube"><transform name="to_world"><rotate y="1" angle="30"/><translate x="-2"/></transform></shape>
<shape type="torus"><emitter type="area"><rgb name="radiance" value="1,1,1"/></emitter></shape>
<emitter type="constant"/>
</scene>"#;

/// Writes the files; some names don't exist.
pub fn all(folder: &Path) -> Vec<PathBuf> {
    let huge = "v 1e30 0 0\nv 0 1e30 0\nv 0 0 1e30\nf 1 2 3\n";
    let tiny = "v 1e-30 0 0\nv 0 1e-30 0\nv 0 0 0\nf 1 2 3\n";
    let odd =
        "mtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nf 1 1 2\nl 1 2\np 3\n";
    let texts: [(&str, &str); 14] = [
        ("triangle.obj", TRIANGLE),
        ("scene.xml", SCENE),
        ("huge.obj", huge),
        ("tiny.obj", tiny),
        ("odd.obj", odd),
        ("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n"),
        ("empty.obj", ""),
        ("points.obj", "v 0 0 0\nv 1 2 3\np 1 2\n"),
        ("bad.obj", "v 0 0 0\nf 1 2 9\n"),
        ("words.obj", "not an obj\n\u{0}\u{1}\u{7f}"),
        (
            "bad.xml",
            "<scene version=\"3.0.0\"><shape type=\"sphere\">",
        ),
        ("empty.xml", "<scene version=\"3.0.0\"/>"),
        ("bad.hitscope", "{\"hitscope\": 1}"),
        ("bad.hdr", "#?RADIANCE\n\n-Y 1 +X 1\n"),
    ];
    let mut files: Vec<PathBuf> = texts
        .iter()
        .map(|(name, text)| {
            let path = folder.join(name);
            std::fs::write(&path, text).expect("written");
            path
        })
        .collect();
    files.push(grid(folder, "grid.obj", 40));
    let cut = std::fs::read(folder.join("grid.obj")).expect("there");
    std::fs::write(folder.join("cut.obj.gz"), &cut[..200]).expect("written");
    let more = ["cut.obj.gz", "none.obj", "view.hitscope", "saved.xml", "."];
    files.extend(more.map(|name| folder.join(name)));
    files
}

/// An OBJ file of a wavy square with this many quads per side, in groups.
pub fn grid(folder: &Path, name: &str, side: usize) -> PathBuf {
    let mut text = String::new();
    for (x, y) in (0..=side).flat_map(|y| (0..=side).map(move |x| (x, y))) {
        let z = 0.1 * side as f64 * ((0.3 * x as f64).sin() + (0.2 * y as f64).cos());
        writeln!(text, "v {x} {y} {z:.4}").expect("to a string");
    }
    for y in 0..side {
        writeln!(text, "g row{y}").expect("to a string");
        for x in 0..side {
            let a = y * (side + 1) + x + 1;
            let c = a + side + 1;
            writeln!(text, "f {a} {} {} {c}", a + 1, c + 1).expect("to a string");
        }
    }
    let path = folder.join(name);
    std::fs::write(&path, text).expect("written");
    path
}
