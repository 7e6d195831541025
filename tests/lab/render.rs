//! `render`: several pictures from one load, formats, and cameras that look at elements.

use crate::folder::Folder;
use glam::DVec2;
use hitscope_core::kernel::exact_triangle_kernel;
use hitscope_lab::commands::{CommandError, RenderArgs};

/// Small and quick; each triangle has its own colour.
const SMALL: &str = "--size 24x20 --samples 1 --view triangle";

fn run(folder: &Folder, line: &str) -> Result<(), CommandError> {
    let no_overlay = || {
        Err(CommandError::Other(
            "nothing can draw overlays here".to_owned(),
        ))
    };
    folder
        .args::<RenderArgs>(line)
        .run(no_overlay, &mut Vec::new())
}

fn error(folder: &Folder, line: &str) -> CommandError {
    run(folder, line).expect_err(line)
}

fn picture(folder: &Folder, name: &str) -> image::RgbaImage {
    image::open(folder.path(name)).expect(name).to_rgba8()
}

#[test]
fn a_turntable_shows_all_sides_beginning_with_the_usual_view() {
    let folder = Folder::new();
    run(
        &folder,
        &format!("@cube.obj -o @{{index}}.png --turntable 12 {SMALL}"),
    )
    .expect("done");
    run(&folder, &format!("@cube.obj -o @plain.png {SMALL}")).expect("done");
    let frames: Vec<_> = (0..12)
        .map(|k| picture(&folder, &format!("{k:02}.png")))
        .collect();
    assert_eq!(frames[0], picture(&folder, "plain.png"));
    for (k, frame) in frames.iter().enumerate() {
        let same = frames.iter().filter(|other| *other == frame);
        assert_eq!(same.count(), 1, "{k}");
    }
    assert!(!folder.path("12.png").exists());
    // About a tilted axis: the camera of a half turn is on the other side.
    let line =
        format!("@cube.obj -o @t{{index}}.png --turntable 2 --eye 5,0.4,0.3 --up 0,0,1 {SMALL}");
    run(&folder, &line).expect("done");
    let line = format!("@cube.obj -o @back.png --eye -4,0.6,0.3 --up 0,0,1 {SMALL}");
    run(&folder, &line).expect("done");
    assert_eq!(picture(&folder, "t1.png"), picture(&folder, "back.png"));
}

#[test]
fn a_picture_of_few_rays_is_traced_through_the_quick_tree() {
    let folder = Folder::new();
    let mut text = String::new();
    for k in 0..400 {
        text += &format!("v {k} 0 0\nv {k} 1 0\nv {k} 0 1\nf -3 -2 -1\n");
    }
    folder.write("many.obj", &text);
    let has_best_tree = |options: &str| {
        let line = format!("@many.obj -o @out.png --size 24x20 {options}");
        let rendered = folder.args::<RenderArgs>(&line).trace().expect("a picture");
        rendered.loaded.scene.has_best_tree()
    };
    assert!(!has_best_tree("--view shaded --samples 1"));
    // 16 times as many rays; a view of the tree; views with more rays than pixels.
    assert!(has_best_tree("--view shaded --samples 16"));
    for view in ["cost", "path", "spawning"] {
        assert!(
            has_best_tree(&format!("--view {view} --samples 1")),
            "{view}"
        );
    }
}

#[test]
fn a_list_of_cameras_gives_the_pictures_of_the_same_options() {
    let folder = Folder::new();
    folder.write(
        "cameras.json",
        r#"[{"name": "side", "eye": [5, 0.5, 0.4], "target": [0, 0.5, 0.5], "fov": 30},
            {"eye": [0.4, 5, 0.5], "up": [0, 0, 1], "ortho": 1.5, "size": [10, 30]},
            {"name": "usual"}]"#,
    );
    let line = format!("@cube.obj --cameras @cameras.json -o @out-{{name}}.png {SMALL}");
    run(&folder, &line).expect("done");
    for (name, options) in [
        (
            "side",
            "--eye 5,0.5,0.4 --target 0,0.5,0.5 --fov 30 --size 24x20",
        ),
        ("1", "--eye 0.4,5,0.5 --up 0,0,1 --ortho 1.5 --size 10x30"),
        ("usual", "--size 24x20"),
    ] {
        let line = format!("@cube.obj -o @one.png --samples 1 --view triangle {options}");
        run(&folder, &line).expect("done");
        let listed = picture(&folder, &format!("out-{name}.png"));
        assert_eq!(listed, picture(&folder, "one.png"), "{name}");
    }
}

#[test]
fn a_broken_list_of_cameras_is_an_error_with_file_line_and_field() {
    let folder = Folder::new();
    folder.write("cameras.json", "[{},\n{\"eye\": [1, 2]}]");
    let line = "@cube.obj --cameras @cameras.json -o @{index}.png";
    let found = error(&folder, line);
    assert!(!found.is_usage());
    let message = found.to_string();
    assert!(
        message
            .contains("cameras.json:2: camera 1: eye: expected a list of 3 values, found 2 values"),
        "{message}"
    );
    let missing = error(&folder, "@cube.obj --cameras @none.json -o @{index}.png");
    assert!(missing.to_string().contains("none.json: "), "{missing}");
}

#[test]
fn several_pictures_need_different_names() {
    let folder = Folder::new();
    folder.write("cameras.json", r#"[{"name": "a"}, {"name": "a"}]"#);
    for line in [
        "@cube.obj -o @out.png --turntable 3",
        "@cube.obj -o @{name}.png --cameras @cameras.json",
        "@cube.obj -o - --turntable 3",
    ] {
        let found = error(&folder, line);
        assert!(found.is_usage(), "{line}: {found}");
    }
    assert!(!folder.path("out.png").exists() && !folder.path("a.png").exists());
    run(
        &folder,
        &format!("@cube.obj -o @{{name}}{{index}}.png --cameras @cameras.json {SMALL}"),
    )
    .expect("done");
    assert!(folder.path("a0.png").exists() && folder.path("a1.png").exists());
}

#[test]
fn each_camera_has_its_views_distances_and_numbers() {
    let folder = Folder::new();
    // A cube looks the same from both sides.
    let wedge = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0.5\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    folder.write("wedge.obj", wedge);
    let line = "@wedge.obj -o @{view}-{index}.png --view depth --view normal --turntable 2 \
        --depth-map @t{index}.exr --ids @id{index}.exr --size 24x20 --samples 1";
    run(&folder, line).expect("done");
    for name in ["depth-0.png", "depth-1.png", "normal-0.png", "normal-1.png"] {
        assert_eq!(picture(&folder, name).dimensions(), (24, 20));
    }
    let bytes = |name: &str| std::fs::read(folder.path(name)).expect(name);
    assert_ne!(bytes("t0.exr"), bytes("t1.exr"));
    assert_ne!(bytes("id0.exr"), bytes("id1.exr"));
    for (line, reason) in [
        (
            "@cube.obj -o @{index}.png --turntable 2 --ids @id.exr",
            "several cameras need {index}",
        ),
        (
            "@cube.obj -o @{view}.png --view depth --view normal --turntable 2",
            "several cameras",
        ),
    ] {
        let found = error(&folder, line);
        assert!(
            found.is_usage() && found.to_string().starts_with(reason),
            "{found}"
        );
    }
}

#[test]
fn the_format_can_be_given_for_any_name_but_the_meshs() {
    let folder = Folder::new();
    run(
        &folder,
        &format!("@cube.obj -o @thumbnail.tmp --format png {SMALL}"),
    )
    .expect("done");
    let bytes = std::fs::read(folder.path("thumbnail.tmp")).expect("written");
    assert!(bytes.starts_with(b"\x89PNG"));
    run(
        &folder,
        &format!("@cube.obj -o @thumbnail --format exr {SMALL}"),
    )
    .expect("done");
    let bytes = std::fs::read(folder.path("thumbnail")).expect("written");
    assert!(bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    for (line, reason) in [
        ("@cube.obj -o @cube.obj --format png", "is the mesh itself"),
        ("@cube.obj -o @cube.obj", "must end in .png or .exr"),
        ("@cube.obj -o @thumbnail", "--format must be given"),
    ] {
        let found = error(&folder, line);
        assert!(found.is_usage(), "{line}");
        assert!(found.to_string().contains(reason), "{line}: {found}");
    }
    let mesh = std::fs::read_to_string(folder.path("cube.obj")).expect("kept");
    assert_eq!(mesh, crate::folder::CUBE);
}

#[test]
fn a_camera_looks_at_each_face_from_its_front() {
    let folder = Folder::new();
    for face in 0..6 {
        for ortho in ["", "--ortho 3"] {
            let line = format!("@cube.obj -o @out.png --look-at face:{face} {ortho} {SMALL}");
            let rendered = folder.args::<RenderArgs>(&line).trace().expect("traced");
            let scene = &rendered.loaded.scene;
            let ray = rendered.camera.ray_through(DVec2::new(12.0, 10.0));
            let hit = scene.intersector(exact_triangle_kernel()).closest_hit(&ray);
            let hit = hit.expect("the face");
            assert_eq!(scene.mesh().face_of(hit.primitive), face, "{ortho}");
            let normal = scene.surface(&ray, &hit).normal.as_vec3();
            assert!(normal.dot(ray.dir) < 0.0, "from behind: {face}");
        }
    }
}

#[test]
fn vertices_lines_and_points_are_in_the_middle_of_the_picture() {
    let folder = Folder::new();
    for (element, p) in [
        ("vertex:7", [1.0, 1.0, 1.0]),
        ("line:7", [1.0, 1.0, 1.0]),
        ("0.25,0.5,-3", [0.25, 0.5, -3.0]),
    ] {
        for eye in ["", "--eye 3,2,4"] {
            let line = format!("@cube.obj -o @out.png --look-at {element} {eye} {SMALL}");
            let camera = folder
                .args::<RenderArgs>(&line)
                .trace()
                .expect("traced")
                .camera;
            let shown = camera.pixel_of(p.into()).expect("in front");
            assert!(
                (shown - DVec2::new(12.0, 10.0)).length() < 1e-3,
                "{element}: {shown}"
            );
        }
    }
    let found = error(&folder, "@cube.obj -o @out.png --look-at triangle:12");
    assert!(found.is_usage());
    assert_eq!(
        found.to_string(),
        "--look-at triangle:12: there is no triangle 12: they are numbered from 0 to 11"
    );
}

#[test]
fn an_element_fits_into_the_picture_and_fills_much_of_it() {
    let folder = Folder::new();
    for triangle in 0..12 {
        let line = format!("@cube.obj -o @out.png --look-at triangle:{triangle} {SMALL}");
        let rendered = folder.args::<RenderArgs>(&line).trace().expect("traced");
        let corners = rendered.loaded.scene.mesh().corners(triangle);
        let shown = corners.map(|p| rendered.camera.pixel_of(p.as_dvec3()).expect("in front"));
        for corner in shown {
            let size = DVec2::new(24.0, 20.0);
            assert!(
                corner.cmpge(DVec2::ZERO).all() && corner.cmple(size).all(),
                "{corner}"
            );
        }
        let [a, b, c] = shown;
        let widest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        assert!(widest > 5.0, "{triangle}: {widest}");
    }
}

#[test]
fn scene_files_have_elements_but_no_lines() {
    let folder = Folder::new();
    folder.write(
        "scene.xml",
        r#"<scene version="3.0.0"><shape type="obj"><string name="filename" value="cube.obj"/></shape></scene>"#,
    );
    let line = format!("@scene.xml -o @out.png --look-at face:3 {SMALL}");
    run(&folder, &line).expect("done");
    assert_eq!(picture(&folder, "out.png").dimensions(), (24, 20));
    let found = error(&folder, "@scene.xml -o @out.png --look-at line:3");
    assert!(
        found.to_string().contains("lines are those of an OBJ file"),
        "{found}"
    );
}

#[test]
fn a_transparent_background_leaves_the_surface_and_nothing_else() {
    let folder = Folder::new();
    let options = "--size 40x40 --samples 16 --view shaded";
    run(
        &folder,
        &format!("@cube.obj -o @cut.png --transparent {options}"),
    )
    .expect("done");
    run(&folder, &format!("@cube.obj -o @whole.png {options}")).expect("done");
    let (cut, whole) = (picture(&folder, "cut.png"), picture(&folder, "whole.png"));
    assert_eq!(cut.get_pixel(0, 0).0, [0; 4]);
    assert_eq!(cut.get_pixel(20, 20), whole.get_pixel(20, 20));
    let has_edge = cut.pixels().any(|pixel| !matches!(pixel.0[3], 0 | 255));
    assert!(has_edge, "edge pixels are partly covered");
    assert!(whole.pixels().all(|pixel| pixel.0[3] == 255));
    let line = "@cube.obj -o @x.png --transparent --view disagreement";
    let error = error(&folder, line);
    assert!(error.to_string().contains("--transparent"), "{error}");
    assert!(matches!(error, CommandError::Usage(_)));
}
