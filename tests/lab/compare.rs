//! `compare`: distances between surfaces, and differences of pictures.

use crate::folder::{CUBE, Folder};
use hitscope_lab::commands::{CommandError, CompareArgs};
use image::{Rgb, RgbImage};
use serde_json::{Value, json};

fn compared(folder: &Folder, line: &str) -> Value {
    folder.json(|f, out| f.args::<CompareArgs>(&format!("{line} --json")).run(out))
}

fn error(folder: &Folder, line: &str) -> CommandError {
    let args: CompareArgs = folder.args(line);
    args.run(&mut Vec::new()).expect_err(line)
}

/// The cube with its upper vertices raised by a quarter, and other names.
fn taller() -> String {
    let raised = |line: &str| match line.split(' ').collect::<Vec<_>>()[..] {
        ["v", x, "1", z] => format!("v {x} 1.25 {z}\n"),
        _ => format!("{line}\n"),
    };
    let text: String = CUBE.lines().map(raised).collect();
    text.replace("g front", "g door")
        .replace("f 5 6 7 8", "f 5 6 7\nf 5 7 8")
}

#[test]
fn a_raised_cube_differs_by_the_height() {
    let folder = Folder::new();
    folder.write("tall.obj", &taller());
    let found = compared(&folder, "@cube.obj @tall.obj --points 4000");
    for (side, at) in [("a_to_b", 1.0), ("b_to_a", 1.25)] {
        let side = &found[side];
        assert_eq!(
            (&side["max"], &side["samples"]),
            (&0.25.into(), &4000.into())
        );
        assert_eq!(side["worst"]["position"][1], at, "{side}");
        assert!(side["worst"]["line"].as_u64().is_some_and(|line| line > 8));
    }
    assert_eq!(found["two_sided"]["max"], 0.25);
    // From the top of A, a sixth of its area, all points are 0.25 or less from B's sides or top.
    let mean = found["a_to_b"]["mean"].as_f64().expect("a number");
    assert!(mean > 0.01 && mean < 0.25 / 6.0, "{mean}");
    let diagonal = found["diagonal"].as_f64().expect("a number");
    assert!((diagonal - (2.0f64 + 1.25 * 1.25).sqrt()).abs() < 1e-12);
    let relative = found["relative_to_diagonal"]["two_sided"]["max"].as_f64();
    assert!((relative.expect("a number") * diagonal - 0.25).abs() < 1e-12);
    // Contents.
    assert_eq!(
        (&found["a"]["faces"], &found["b"]["faces"]),
        (&6.into(), &7.into())
    );
    assert_eq!(found["a"]["triangles"], found["b"]["triangles"]);
    assert_eq!(
        found["only_in_a"],
        json!({ "parts": ["front"], "materials": [] })
    );
    assert_eq!(
        found["only_in_b"],
        json!({ "parts": ["door"], "materials": [] })
    );
}

#[test]
fn one_side_and_equal_files_and_the_text() {
    let folder = Folder::new();
    let same = compared(&folder, "@cube.obj @cube.obj --points 500");
    assert!(same["two_sided"]["max"].as_f64().expect("a number") < 1e-15);
    let one = compared(&folder, "@cube.obj @cube.obj --points 500 --one-sided");
    assert_eq!(
        (&one["b_to_a"], &one["two_sided"]),
        (&Value::Null, &Value::Null)
    );
    folder.write("tall.obj", &taller());
    let line = "@cube.obj @tall.obj --points 500";
    let text = folder.text(|f, out| f.args::<CompareArgs>(line).run(out));
    let lines: Vec<Vec<&str>> = text
        .lines()
        .map(|line| line.split_whitespace().collect())
        .collect();
    for line in [
        "faces 6 7 +1",
        "only in A part front",
        "from A to B, from 8 vertices and 500 points",
        "max 0.250000, 0.1325 of the diagonal",
        "both ways",
    ] {
        let words: Vec<&str> = line.split(' ').collect();
        assert!(lines.contains(&words), "{line}: {text}");
    }
}

#[test]
fn the_picture_of_the_distances_shows_where_they_are() {
    let folder = Folder::new();
    folder.write("tall.obj", &taller());
    let draw = |options: &str| {
        let line = format!(
            "@cube.obj @tall.obj --points 100 -o @out.png --size 40x40 --samples 1 --ortho 1.2 {options}"
        );
        folder.text(|f, out| f.args::<CompareArgs>(&line).run(out));
        image::open(folder.path("out.png"))
            .expect("a picture")
            .to_rgb8()
    };
    let sum = |pixel: &Rgb<u8>| pixel.0.iter().map(|&x| u32::from(x)).sum::<u32>();
    // From above, all is 0.25 away but near the edges; from below, nothing.
    let above = draw("--eye 0.5,5,0.5 --up 0,0,1");
    let below = draw("--eye 0.5,-5,0.5 --up 0,0,1");
    let middle = |picture: &RgbImage| sum(picture.get_pixel(20, 20));
    assert!(middle(&above) > middle(&below) + 100);
    assert_eq!(sum(above.get_pixel(0, 0)), sum(below.get_pixel(0, 0)));
    let clipped = draw("--eye 0.5,5,0.5 --up 0,0,1 --limit 100");
    assert!(middle(&clipped) < middle(&above));
    let wide = draw("--eye 0.5,5,0.5 --up 0,0,1 --legend --colour-map grey");
    assert!(wide.width() > 40 && wide.height() == 40);
}

#[test]
fn only_meshes_are_compared() {
    let folder = Folder::new();
    folder.write(
        "ball.xml",
        r#"<scene version="3.0.0"><shape type="sphere"/><shape type="obj"><string name="filename" value="cube.obj"/></shape></scene>"#,
    );
    folder.write(
        "mesh.xml",
        r#"<scene version="3.0.0"><shape type="obj"><string name="filename" value="cube.obj"/></shape></scene>"#,
    );
    let found = error(&folder, "@cube.obj @ball.xml");
    assert!(!found.is_usage());
    let message = found.to_string();
    assert!(
        message.ends_with("ball.xml: only meshes are compared, but the file has 1 sphere"),
        "{message}"
    );
    let same = compared(&folder, "@mesh.xml @cube.obj --points 100");
    assert!(same["two_sided"]["max"].as_f64().expect("a number") < 1e-15);
}

#[test]
fn the_differences_of_two_pictures_are_counted_and_drawn() {
    let folder = Folder::new();
    let write = |name: &str, changed: [u8; 3]| {
        let grey = Rgb([100, 100, 100]);
        let picture = RgbImage::from_fn(
            4,
            5,
            |x, y| {
                if (x, y) == (3, 1) { Rgb(changed) } else { grey }
            },
        );
        picture.save(folder.path(name)).expect("written");
    };
    write("a.png", [100, 151, 100]);
    write("b.png", [100; 3]);
    let found = compared(
        &folder,
        "@a.png @b.png -o @difference.png --gain 2 --tolerance 0.1",
    );
    assert_eq!(found["worst"]["pixel"], json!([3, 1]));
    assert_eq!(found["worst"]["channel"], "G");
    assert!((found["worst"]["difference"].as_f64().expect("a number") - 0.2).abs() < 1e-6);
    assert!((found["mse"].as_f64().expect("a number") - 0.04 / 60.0).abs() < 1e-8);
    assert_eq!(found["percent_over_tolerance"], 5.0);
    assert_eq!(found["relative_mse"], Value::Null);
    let shown = image::open(folder.path("difference.png"))
        .expect("a picture")
        .to_rgb8();
    assert_eq!(shown.get_pixel(3, 1), &Rgb([0, 102, 0]));
    assert_eq!(shown.get_pixel(0, 0), &Rgb([0, 0, 0]));
    let same = compared(&folder, "@b.png @b.png");
    assert_eq!(
        (&same["mse"], &same["psnr_db"]),
        (&0.0.into(), &Value::Null)
    );
}

#[test]
fn files_that_cannot_be_compared_are_refused() {
    let folder = Folder::new();
    RgbImage::new(4, 5)
        .save(folder.path("a.png"))
        .expect("written");
    RgbImage::new(5, 4)
        .save(folder.path("b.png"))
        .expect("written");
    let sizes = error(&folder, "@a.png @b.png");
    assert!(!sizes.is_usage());
    assert!(
        sizes
            .to_string()
            .ends_with("a.png: the pictures differ in size: 4x5 and 5x4 pixels"),
        "{sizes}"
    );
    for (line, reason) in [
        (
            "@a.png @cube.obj",
            "a picture can't be compared with a mesh",
        ),
        ("- @cube.obj", "not standard input"),
        ("@a.png @b.png -o @a.png", "the output is one of the files"),
    ] {
        let found = error(&folder, line);
        assert!(found.is_usage(), "{line}");
        assert!(found.to_string().contains(reason), "{line}: {found}");
    }
    folder.write("text.png", "v 1 2 3");
    let text = error(&folder, "@text.png @a.png");
    assert!(text.to_string().contains("neither a PNG nor"), "{text}");
}
