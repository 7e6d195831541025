//! Tests of the pixels that `render --overlay`, `--wireframe` and `--normals` change.

use crate::harness::gpu;
use glam::DVec2;
use hitscope::overlay::normals::LENGTH;
use hitscope::overlay::wireframe::WIREFRAME;
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

/// The position from which most pictures are taken.
const ON_Z: &str = "0,0,5";

/// Renders a file with these options, seen from a position.
fn render(folder: &tempfile::TempDir, file: &str, eye: &str, overlay: &[&str]) -> RgbaImage {
    let line = "-o out.png --size 200x200 --samples 1 --target 0,0,0 --ortho 4";
    let output = Command::new(env!("CARGO_BIN_EXE_hitscope"))
        .args(["render", file])
        .args(line.split(' '))
        .args(["--eye", eye])
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
    let plain = render(&folder, "mesh.obj", ON_Z, &[]);
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
    let wire = WIREFRAME.style.colour.map(|c| f32::from(c) / 255.0);
    let drawn = render(&folder, "mesh.obj", ON_Z, &["--wireframe"]);
    let look = (wire, WIREFRAME.style.opacity);
    assert_lines(&plain, &drawn, &edges, Some(look));

    // The normals' length is a fraction of the radius of the bounds.
    let radius = 0.5 * DVec2::new(2.4, 2.0).extend(1.0).length();
    let length_px = 50.0 * radius * f64::from(LENGTH.default);
    let normal = [at(170.5, 100.5), at(170.5 + length_px, 100.5)];
    let drawn = render(&folder, "mesh.obj", ON_Z, &["--normals"]);
    assert!((2.0..20.0).contains(&length_px), "{length_px} of 29 pixels");
    // Such a short line fades.
    assert_lines(&plain, &drawn, &[normal], None);
}

#[test]
fn the_older_options_name_overlays_and_several_can_be_drawn() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("mesh.obj"), mesh()).expect("written");
    let drawn = |options: &[&str]| render(&folder, "mesh.obj", ON_Z, options);
    let wireframe = drawn(&["--wireframe"]);
    assert!(wireframe == drawn(&["--overlay", "wireframe"]));
    let faces = drawn(&["--normals"]);
    assert!(faces == drawn(&["--overlay", "face-normals"]));
    let smooth = ["--shading", "smooth"];
    let vertices = drawn(&[&smooth[..], &["--normals"]].concat());
    assert!(vertices == drawn(&[&smooth[..], &["--overlay", "vertex-normals"]].concat()));
    let both = drawn(&["--overlay", "wireframe", "--overlay", "face-normals"]);
    assert!(both == drawn(&["--wireframe", "--normals"]));
    assert!(both != wireframe && both != faces);
}

/// The pixels that an overlay changes.
fn changed(shapes: &str, overlay: &str) -> Vec<DVec2> {
    changed_from(ON_Z, shapes, overlay)
}

/// The pixels that an overlay changes, seen from a position.
fn changed_from(eye: &str, shapes: &str, overlay: &str) -> Vec<DVec2> {
    let folder = tempfile::tempdir().expect("a folder");
    let xml = format!("<scene version=\"3.0.0\">{shapes}</scene>");
    std::fs::write(folder.path().join("mesh.obj"), mesh()).expect("written");
    std::fs::write(folder.path().join("scene.xml"), xml).expect("written");
    let plain = render(&folder, "scene.xml", eye, &[]);
    let drawn = render(&folder, "scene.xml", eye, &[overlay]);
    let pairs = plain.enumerate_pixels().zip(drawn.pixels());
    let differing = pairs.filter(|((_, _, before), after)| before != after);
    differing
        .map(|((x, y, _), _)| DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5))
        .collect()
}

/// The unit ball. Seen along z, its equator is its silhouette.
const BALL: &str = r#"<shape type="sphere"/>"#;

#[test]
fn a_sphere_has_an_outline_and_no_lines_beyond_it() {
    let Some(_) = gpu() else { return };
    // Meridians and the equator are silhouettes only if seen at right angles to the axis or along it.
    let pixels = changed_from("3,1,2", BALL, "--wireframe");
    let from_centre = |p: &DVec2| (*p - DVec2::splat(100.0)).length();
    assert!(pixels.iter().all(|p| from_centre(p) < 51.0));
    // Pixels of the outline in every direction.
    for degrees in 0..360 {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let at = DVec2::splat(100.0) + 49.5 * DVec2::new(cos, sin);
        assert!(pixels.iter().any(|p| (*p - at).length() < 1.5), "{degrees}");
    }
}

#[test]
fn lines_of_a_sphere_are_unbroken_from_near() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let xml = format!("<scene version=\"3.0.0\">{BALL}</scene>");
    std::fs::write(folder.path().join("scene.xml"), xml).expect("written");
    // The equator and a meridian cross in the middle of the picture. The eye is beside their planes: lavapipe drops parts
    // of lines through the exact centre that cross the border.
    for (distance, fov) in [("1.3", "40"), ("1.01", "40"), ("4", "0.5")] {
        let eye = format!("{distance},0.0007,0.0011");
        let view = ["--target", "1,0,0", "--up", "0,0,1", "--fov", fov];
        let picture = |overlay: &[&str]| {
            let mut line = vec!["render", "scene.xml", "-o", "out.png", "--samples", "1"];
            line.extend(["--size", "300x300", "--eye", &eye]);
            line.extend(view);
            line.extend(overlay);
            let output = Command::new(env!("CARGO_BIN_EXE_hitscope"))
                .args(&line)
                .current_dir(folder.path())
                .output()
                .expect("the program runs");
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{said}");
            let path = folder.path().join("out.png");
            image::open(path).expect("a PNG").to_rgba8()
        };
        let (plain, drawn) = (picture(&[]), picture(&["--wireframe"]));
        let is_drawn = |x: u32, y: u32| plain.get_pixel(x, y) != drawn.get_pixel(x, y);
        // Away from the other line.
        for k in (0..120).chain(180..300) {
            let row = (125..175).any(|y| is_drawn(k, y));
            let column = (125..175).any(|x| is_drawn(x, k));
            assert!(row && column, "{k} from {distance}");
        }
    }
}

/// A torus before itself: the near part of its tube covers the far part.
#[test]
fn a_shape_in_front_of_itself_has_an_outline() {
    let Some(_) = gpu() else { return };
    let torus = r#"<shape type="torus"><float name="major" value="1.2"/><float name="minor" value="0.8"/></shape>"#;
    // From 22.5° above the plane of the torus: the border is between two of its lines, three pixels from each.
    let pixels = changed_from("0,-4.62,1.914", torus, "--wireframe");
    let border = 0.8 - 1.2 * 22.5_f64.to_radians().sin();
    for x in 88..112 {
        // The border falls by less than half a pixel beside the middle.
        let at = DVec2::new(f64::from(x) + 0.5, 100.0 - 50.0 * border);
        let is_near = |p: &DVec2| p.x == at.x && (p.y - at.y).abs() < 1.6;
        assert!(pixels.iter().any(is_near), "{x}");
    }
}

#[test]
fn a_flat_shape_hides_the_lines_behind_it() {
    let Some(_) = gpu() else { return };
    let flat = r#"<shape type="rectangle"><transform name="to_world"><scale value="1.5"/><translate z="2"/></transform></shape>"#;
    let both = changed(&format!("{BALL}{flat}"), "--wireframe");
    assert!(!both.is_empty());
    assert_eq!(both, changed(flat, "--wireframe"));
}

#[test]
fn a_mesh_hides_the_lines_of_shapes_and_shapes_those_of_a_mesh() {
    let Some(_) = gpu() else { return };
    let mesh = r#"<shape type="obj"><string name="filename" value="mesh.obj"/></shape>"#;
    let ball = |z: f64| {
        format!(
            r#"<shape type="sphere"><float name="radius" value="0.5"/><point name="center" x="0" y="0" z="{z}"/></shape>"#
        )
    };
    let alone = changed(mesh, "--wireframe");
    // Behind the square nothing of the ball is drawn.
    assert_eq!(
        changed(&format!("{mesh}{}", ball(-2.0)), "--wireframe"),
        alone
    );
    let in_front = changed(&format!("{mesh}{}", ball(2.0)), "--wireframe");
    assert!(in_front.len() > alone.len() + 200);
    // A wide ball hides the whole mesh.
    let wide = r#"<shape type="sphere"><float name="radius" value="1.9"/><point name="center" x="0" y="0" z="2.5"/></shape>"#;
    let both = changed(&format!("{mesh}{wide}"), "--wireframe");
    assert!(!both.is_empty());
    assert_eq!(both, changed(wide, "--wireframe"));
}

#[test]
fn normals_of_shapes_point_outwards() {
    let Some(_) = gpu() else { return };
    let pixels = changed(BALL, "--normals");
    let beyond = pixels
        .iter()
        .filter(|p| (**p - DVec2::splat(100.0)).length() > 50.5);
    assert!(beyond.count() > 20);
}

#[test]
fn a_clip_cuts_lines() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("mesh.obj"), mesh()).expect("written");
    let clip = ["--clip-plane", "1,0,0,0"];
    let plain = render(&folder, "mesh.obj", ON_Z, &clip);
    let with_lines = [&clip[..], &["--wireframe"]].concat();
    let drawn = render(&folder, "mesh.obj", ON_Z, &with_lines);
    let pixels = plain.enumerate_pixels().zip(drawn.pixels());
    let changed = pixels.filter(|((.., before), after)| before != after);
    let columns: Vec<u32> = changed.map(|((x, ..), _)| x).collect();
    assert!(columns.iter().any(|&x| x < 60));
    // The plane lies between the columns 99 and 100.
    assert!(columns.iter().all(|&x| x <= 100), "{columns:?}");
}

#[test]
fn a_surface_that_the_clip_removes_hides_no_line() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut text = String::new();
    // A square before another one, whose edges run through the centres of pixels.
    for (half, z) in [(0.49, 0), (1.5, 1)] {
        for (x, y) in [(-half, -half), (half, -half), (half, half), (-half, half)] {
            writeln!(text, "v {x} {y} {z}").expect("to a string");
        }
    }
    text += "f 1 2 3 4\nf 5 6 7 8\n";
    std::fs::write(folder.path().join("mesh.obj"), text).expect("written");
    let has_edge = |clip: &[&str]| {
        let plain = render(&folder, "mesh.obj", ON_Z, clip);
        let with_lines = [clip, &["--wireframe"]].concat();
        let drawn = render(&folder, "mesh.obj", ON_Z, &with_lines);
        plain.get_pixel(75, 100) != drawn.get_pixel(75, 100)
    };
    assert!(!has_edge(&[]));
    assert!(has_edge(&["--clip-plane", "0,0,1,0.5"]));
}
