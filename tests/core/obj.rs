//! Any bytes are a mesh or an error, never a panic.

use hitscope_core::obj::{LoadOptions, parse};
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use std::io;
use std::path::Path;

/// Words that OBJ files are made of, legal and not.
const WORDS: [&str; 40] = [
    "v",
    "vn",
    "vt",
    "f",
    "o",
    "g",
    "usemtl",
    "mtllib",
    "s",
    "l",
    "#",
    "\\",
    "\n",
    "\n",
    "\n",
    "\r\n",
    "0",
    "1",
    "2",
    "3",
    "-1",
    "-3",
    "1e400",
    "nan",
    "-inf",
    "1.5",
    "1e-45",
    "3e38",
    "1//1",
    "2//1",
    "3//1",
    "1/1/1",
    "/",
    "4294967296",
    "6148914691236517206",
    "x",
    "1,5",
    "\u{feff}",
    "\0",
    "é",
];

fn parse_without_panic(bytes: &[u8]) {
    let library = |_: &str| Err(io::ErrorKind::NotFound.into());
    let progress = Progress::default();
    let (path, options) = (Path::new("x.obj"), LoadOptions::default());
    if let Ok(loaded) = parse(|| Ok(bytes), path, options, &library, &progress) {
        let mesh = loaded.mesh;
        assert!(!mesh.triangles.is_empty());
        for triangle in 0..mesh.triangles.len() as u32 {
            assert!(mesh.corners(triangle).iter().all(|p| p.is_finite()));
            assert!(mesh.geometric_normal(triangle).is_normalized());
        }
    }
}

#[test]
fn random_words_are_a_mesh_or_an_error() {
    let mut random = Random::new(1);
    let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1 2 3\n";
    for _ in 0..5000 {
        let mut text = start.to_owned();
        for _ in 0..30 {
            text += WORDS[(random.unit() * WORDS.len() as f64) as usize % WORDS.len()];
            text.push(' ');
        }
        parse_without_panic(text.as_bytes());
    }
}

#[test]
fn random_bytes_are_a_mesh_or_an_error() {
    let mut random = Random::new(2);
    let start = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1//1 2 3\nusemtl a\n";
    for _ in 0..5000 {
        let mut bytes = start.to_vec();
        for _ in 0..4 {
            let at = (random.unit() * bytes.len() as f64) as usize % bytes.len();
            bytes[at] = (random.unit() * 256.0) as u8;
        }
        parse_without_panic(&bytes);
    }
}

#[test]
fn a_polygon_of_many_corners_and_a_line_without_end_are_read() {
    let corners = 20_000;
    let mut text = String::new();
    for i in 0..corners {
        let angle = f64::from(i) / f64::from(corners) * std::f64::consts::TAU;
        text += &format!("v {} {} 0\n", angle.cos(), angle.sin());
    }
    text += "f";
    for i in 1..=corners {
        text += &format!(" {i}");
    }
    parse_without_panic(text.as_bytes());
    parse_without_panic("v 1 ".repeat(1_000_000).as_bytes());
}
