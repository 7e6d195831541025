//! Tests of the pixels that `render --wireframe` and `--normals` change.

use crate::harness::gpu;
use glam::DVec2;
use hitscope::settings::Settings;
use image::RgbaImage;
use std::fmt::Write as _;
use std::process::Command;

/// A square that faces the camera, and to its right an edge-on triangle whose normal points to the right. A unit is
/// 50 pixels; edges run through the centres of pixels.
fn mesh() -> String {
    let mut text = String::new();
    for (x, y, z) in [
        (50.5, 150.5, 0),
        (150.5, 150.5, 0),
        (150.5, 50.5, 0),
        (50.5, 50.5, 0),
        (170.5, 130.5, 0),
        (170.5, 100.5, -1),
        (170.5, 70.5, 0),
    ] {
        let (x, y) = ((x - 100.0) / 50.0, (100.0 - y) / 50.0);
        writeln!(text, "v {x} {y} {z}").expect("to a string");
    }
    text + "f 1 2 3 4\nf 5 6 7\n"
}

/// Renders the picture with these options.
fn render(folder: &tempfile::TempDir, overlay: &[&str]) -> RgbaImage {
    let line = "render mesh.obj -o out.png --size 200x200 --samples 1 --eye 0,0,5 --target 0,0,0 --ortho 4";
    let output = Command::new(env!("CARGO_BIN_EXE_hitscope"))
        .args(line.split(' '))
        .args(overlay)
        .current_dir(folder.path())
        .output()
        .expect("the program runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    image::open(folder.path().join("out.png"))
        .expect("a PNG")
        .to_rgba8()
}

/// A segment in pixels.
type Segment = [DVec2; 2];

fn distance(p: DVec2, [a, b]: Segment) -> f64 {
    let along = b - a;
    let part = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (a + part * along - p).length()
}

/// A colour with alpha over an opaque pixel.
fn over(under: [u8; 4], colour: [f32; 3], alpha: f32) -> [u8; 4] {
    let channel = |k: usize| {
        let under = f32::from(under[k]) / 255.0;
        (255.0 * (colour[k] * alpha + under * (1.0 - alpha))).round() as u8
    };
    [channel(0), channel(1), channel(2), 255]
}

/// Checks that lines set the pixels on these segments to their colour and change no pixel beyond their reach: half a
/// line's width plus half a pixel of soft edge.
fn assert_lines(
    plain: &RgbaImage,
    drawn: &RgbaImage,
    segments: &[Segment],
    look: Option<([f32; 3], f32)>,
) {
    const REACH_PX: f64 = 1.0;
    let mut on_a_line = 0;
    for ((x, y, before), after) in plain.enumerate_pixels().zip(drawn.pixels()) {
        let centre = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let distances = segments.iter().map(|&segment| distance(centre, segment));
        let near: Vec<f64> = distances.filter(|d| *d <= REACH_PX + 0.01).collect();
        if near.is_empty() {
            assert_eq!(before, after, "pixel {x}, {y} is beside the lines");
        } else if near.len() == 1 && near[0] < 0.01 {
            on_a_line += 1;
            assert_ne!(before, after, "pixel {x}, {y} is on a line");
            let Some((colour, alpha)) = look else {
                continue;
            };
            let expected = over(before.0, colour, alpha);
            // Colour, alpha and blend are each rounded to a byte, and so is the expected value.
            let off = (0..4).map(|k| after.0[k].abs_diff(expected[k])).max();
            assert!(off <= Some(2), "pixel {x}, {y}: {after:?} for {expected:?}");
        }
    }
    assert!(on_a_line > 0, "no line");
}

#[test]
fn edges_and_normals_are_drawn_over_the_picture_and_nothing_else_changes() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("mesh.obj"), mesh()).expect("written");
    let plain = render(&folder, &[]);
    let at = |x: f64, y: f64| DVec2::new(x, y);
    let corners = [
        at(50.5, 150.5),
        at(150.5, 150.5),
        at(150.5, 50.5),
        at(50.5, 50.5),
    ];
    let square = (0..4).map(|k| [corners[k], corners[(k + 1) % 4]]);
    let edge_on = [at(170.5, 70.5), at(170.5, 130.5)];
    // The three edges of the edge-on triangle coincide; two of them are drawn over the third.
    let edges: Vec<Segment> = square.chain([edge_on, edge_on]).collect();
    let settings = Settings::default();
    let wire = settings.wire_colour.map(|c| f32::from(c) / 255.0);
    let drawn = render(&folder, &["--wireframe"]);
    assert_lines(&plain, &drawn, &edges, Some((wire, 0.85)));

    // The normals' length is a fraction of the radius of the bounds.
    let radius = 0.5 * DVec2::new(2.4, 2.0).extend(1.0).length();
    let length_px = 50.0 * radius * f64::from(settings.normal_length);
    let normal = [at(170.5, 100.5), at(170.5 + length_px, 100.5)];
    let drawn = render(&folder, &["--normals"]);
    assert!((2.0..20.0).contains(&length_px), "{length_px} of 29 pixels");
    // Such a short line fades.
    assert_lines(&plain, &drawn, &[normal], None);
}
