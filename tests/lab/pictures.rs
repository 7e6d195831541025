//! Pictures of several views, with scales, legends, distances and numbers.

use crate::folder::Folder;
use hitscope_lab::commands::{CommandError, OverlayPen, RenderArgs, Rendered};

/// The PNG file and the figures of a picture of 67 × 131 pixels, rendered in strips of this memory.
fn in_strips(options: &str, strip_bytes: u64) -> (Vec<u8>, String) {
    let folder = Folder::new();
    let line = format!("@cube.obj --size 67x131 --eye 3,2,4 -o @out.png {options}");
    let mut args: RenderArgs = folder.args(&line);
    args.strip_bytes = strip_bytes;
    // Draws the number of each row over its first pixel.
    let pen = || {
        let draw = |pixels: &mut [[u8; 4]], rendered: &Rendered| {
            for (y, row) in rendered.rows.clone().zip(pixels.chunks_mut(67)) {
                row[0] = [y as u8; 4];
            }
            Ok(())
        };
        Ok(Box::new(draw) as OverlayPen<'_>)
    };
    let mut figures = Vec::new();
    args.run(pen, &mut figures).expect("rendered");
    let picture = std::fs::read(folder.path("out.png")).expect("written");
    (picture, String::from_utf8(figures).expect("text"))
}

#[test]
fn a_picture_in_strips_is_the_same_file_with_the_same_figures() {
    for options in [
        "--samples 4",
        "--samples 4 --view path --noise --exposure 1",
        "--samples 4 --view depth --noise --legend",
        "--transparent --samples 4",
        "--wireframe",
    ] {
        let whole = in_strips(options, u64::MAX);
        assert_eq!(in_strips(options, 0), whole, "{options}");
        assert_eq!(whole.1.is_empty(), !options.contains("--noise"));
    }
}

/// The cube from a corner.
const CUBE: &str = "@cube.obj --size 32x24 --samples 1 --eye 3,2,4 --target 0.5,0.5,0.5";

fn usage_error(line: &str) -> String {
    let folder = Folder::new();
    let args: RenderArgs = folder.args(line);
    match args.check() {
        Err(CommandError::Usage(message)) => message,
        other => panic!("{line}: {other:?}"),
    }
}

#[test]
fn several_views_are_rendered_of_one_scene() {
    let folder = Folder::new();
    let views = "--view depth --view orientation --view path";
    let no_overlay = || {
        Err(CommandError::Other(
            "nothing can draw overlays here".to_owned(),
        ))
    };
    let args: RenderArgs = folder.args(&format!("{CUBE} -o @out-{{view}}.png {views}"));
    args.run(no_overlay, &mut Vec::new()).expect("rendered");
    for view in ["depth", "orientation", "path"] {
        let line = format!("{CUBE} -o @one.png --view {view}");
        let alone = folder.args::<RenderArgs>(&line).trace().expect("rendered");
        let file = image::open(folder.path(&format!("out-{view}.png"))).expect("written");
        let pixels: Vec<[u8; 4]> = file.to_rgba8().pixels().map(|pixel| pixel.0).collect();
        assert_eq!(pixels, alone.film.pixels(), "{view}");
    }
}

#[test]
fn a_legend_is_drawn_beside_a_picture_of_numbers() {
    let folder = Folder::new();
    let line = format!("{CUBE} -o @out.png --view depth --range 2,6 --colour-map viridis --legend");
    let rendered = folder.args::<RenderArgs>(&line).trace().expect("rendered");
    let scale = rendered.scale.expect("numbers");
    assert_eq!(
        scale.to_string(),
        "Distance from the eye: 2 to 6, linear, viridis"
    );
    let (size, pixels) = rendered
        .with_legend(rendered.film.pixels())
        .expect("a legend");
    assert!(size.x > 32 && size.y == 24);
    for (row, own) in pixels
        .chunks(size.x as usize)
        .zip(rendered.film.pixels().chunks(32))
    {
        assert_eq!(&row[..32], own);
    }
    let line = format!("{CUBE} -o @out.png --view depth --range auto");
    let rendered = folder.args::<RenderArgs>(&line).trace().expect("rendered");
    let [far, near] = rendered.scale.expect("numbers").range();
    // The cube's corners are about 4 and 5.5 away.
    assert!(
        (3.5..4.5).contains(&near) && (4.5..6.0).contains(&far),
        "{near} {far}"
    );
    let line = format!("{CUBE} -o @out.png --view triangle");
    let rendered = folder.args::<RenderArgs>(&line).trace().expect("rendered");
    assert!(rendered.with_legend(rendered.film.pixels()).is_none());
}

#[test]
fn options_without_effect_and_outputs_that_replace_each_other_are_refused() {
    for (options, message) in [
        (
            "-o a.png --view depth --view cost",
            "several views need {view}",
        ),
        (
            "-o {view}.png",
            "{view} in the name of the output needs --view",
        ),
        (
            "-o {view}.png --view cost --view cost",
            "two outputs have the name cost.png",
        ),
        (
            "-o a.png --depth-map x.exr --ids x.exr",
            "two outputs have the name x.exr",
        ),
        ("-o x.exr --ids x.exr", "two outputs have the name x.exr"),
        (
            "-o a.png --colour-map viridis",
            "--colour-map has no effect on the view “shaded”",
        ),
        (
            "-o a.png --view path --legend",
            "--legend has no effect on the view “path”",
        ),
        (
            "-o a.png --view depth --back-face-tint",
            "--back-face-tint has no effect",
        ),
        (
            "-o {view}.png --view path --view normal --scale log",
            "--scale has no effect on the views “path”, “normal”: it needs --view depth",
        ),
        (
            "-o a.exr --view depth --legend",
            "legends are drawn beside PNG pictures only",
        ),
    ] {
        let found = usage_error(&format!("@cube.obj {options}"));
        assert!(found.starts_with(message), "{options}: {found}");
    }
    let planes = " --clip-plane 1,0,0,0".repeat(17);
    let found = usage_error(&format!("@cube.obj -o a.png --wireframe{planes}"));
    assert!(
        found.starts_with("overlays are clipped by at most 16 planes"),
        "{found}"
    );
    // An option that one of the views needs.
    let folder = Folder::new();
    let line =
        "@cube.obj -o {view}.png --view shaded --view depth --range 0,1 --back-face-tint=#ff0000";
    assert!(folder.args::<RenderArgs>(line).check().is_ok());
    // The range is wrong for one view of numbers only once its spacing is known.
    let line = format!("{CUBE} -o @out.png --view error-t --range 0,1");
    let error = folder
        .args::<RenderArgs>(&line)
        .trace()
        .err()
        .expect("refused");
    assert!(
        error.is_usage() && error.to_string().contains("must be positive"),
        "{error}"
    );
}
