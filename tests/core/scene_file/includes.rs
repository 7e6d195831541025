//! Files that a scene includes.

use super::{message, parse_files, scene, warnings};
use hitscope_core::progress::Progress;
use hitscope_core::scene_file::{self, Cube, Place, ShapeKind, Sphere};
use std::io;
use std::path::{Path, PathBuf};

#[test]
fn names_are_relative_to_the_file_with_the_name() {
    let main = scene(
        "<default name='q' value='2'/>\n<include filename='sub/a.xml'/>\n<shape type='$last'/>",
    );
    let a = scene(
        "<include filename='./b.xml'/>\n<shape type='obj'><string name='filename' value='m.obj'/></shape>",
    );
    let b = scene(
        "<shape type='sphere' name='b'><float name='radius' value='$q'/></shape>
         <default name='last' value='cube'/><texture type='bitmap'/>",
    );
    let scene = parse_files(&[
        ("dir/x.xml", &main),
        ("dir/sub/a.xml", &a),
        ("dir/sub/./b.xml", &b),
    ])
    .unwrap_or_else(|error| panic!("{error}"));
    let [sphere, obj, cube] = &scene.shapes[..] else {
        panic!("{:?}", scene.shapes);
    };
    assert!(matches!(
        sphere.kind,
        ShapeKind::Sphere(Sphere { radius: 2.0, .. })
    ));
    let ShapeKind::Obj(mesh) = &obj.kind else {
        panic!("{obj:?}");
    };
    assert_eq!(mesh.file, Path::new("dir/sub/m.obj"));
    assert_eq!(cube.kind, ShapeKind::Cube(Cube));
    let files = ["dir/x.xml", "dir/sub/a.xml", "dir/sub/./b.xml"].map(PathBuf::from);
    assert_eq!(scene.files, files);
    assert_eq!(obj.place, Place { file: 1, line: 3 });
    assert_eq!(scene.path_of(sphere.place), files[2]);
    let expected = [
        "dir/sub/./b.xml:3: texture “bitmap” in scene isn't used",
        "dir/sub/a.xml:3: Mitsuba looks for “m.obj” in the folder of the main file, not of this one",
    ];
    assert_eq!(warnings(&scene), expected);
}

#[test]
fn a_part_of_a_shape_can_be_included() {
    let main = scene("<shape type='sphere'><include filename='a.xml'/></shape>");
    let part = scene("<float name='radius' value='3'/>");
    let scene = parse_files(&[("x.xml", &main), ("a.xml", &part)]).expect("good");
    assert!(matches!(
        scene.shapes[0].kind,
        ShapeKind::Sphere(Sphere { radius: 3.0, .. })
    ));
}

#[test]
fn files_that_include_themselves_are_refused() {
    let include = |name: &str| scene(&format!("\n<include filename='{name}'/>"));
    let own = include("../d/./x.xml");
    assert_eq!(
        message(parse_files(&[("d/x.xml", &own)])),
        "d/x.xml:3: the file includes itself: d/x.xml → d/x.xml"
    );
    let files = [
        ("x.xml", &*include("a.xml")),
        ("a.xml", &include("b.xml")),
        ("b.xml", &include("a.xml")),
    ];
    assert_eq!(
        message(parse_files(&files)),
        "b.xml:3: the file includes itself: a.xml → b.xml → a.xml"
    );
}

#[test]
fn endless_chains_and_trees_of_files_are_refused() {
    // Each file includes a new one in a new folder.
    let parse_endless = |contents: &str| {
        let bytes = scene(contents).into_bytes();
        let read = |_: &Path, _: u64| Ok(bytes.clone());
        let path = Path::new("x.xml");
        message(scene_file::parse(
            &bytes,
            path,
            1 << 20,
            &read,
            &Progress::default(),
        ))
    };
    let chain: Vec<String> = (0..=16).map(|k| "d/".repeat(k) + "x.xml").collect();
    assert_eq!(
        parse_endless("<include filename='d/x.xml'/>"),
        format!(
            "{}:2: files are included more than 15 deep: {}",
            chain[15],
            chain.join(" → ")
        )
    );
    // Eleven levels, each with two or more of the next.
    let tree = |path: &Path, _: u64| {
        let depth = path.components().count();
        let next = "<include filename='d/x.xml'/>".repeat(if depth < 15 { 4 } else { 0 });
        Ok(scene(&next).into_bytes())
    };
    let path = Path::new("x.xml");
    let main = scene(&"<include filename='d/x.xml'/>".repeat(4));
    let result = scene_file::parse(main.as_bytes(), path, 1 << 30, &tree, &Progress::default());
    let error = message(result);
    assert!(
        error.ends_with(":2: more than 10000 files are included"),
        "{error}"
    );
}

#[test]
fn files_that_cannot_be_read_are_named() {
    for (name, expected) in [
        ("none.xml", "x.xml:2: included file “none.xml”: not found"),
        (
            "//host/a.xml",
            "x.xml:2: “//host/a.xml”: network paths aren't opened",
        ),
    ] {
        let main = scene(&format!("<include filename='{name}'/>"));
        assert_eq!(message(parse_files(&[("x.xml", &main)])), expected);
    }
    let main = scene("<include filename='a.xml'/>");
    let broken = parse_files(&[
        ("x.xml", &main),
        ("a.xml", "<scene version='3.0.0'>\n<a></scene>"),
    ]);
    assert_eq!(message(broken), "a.xml:2:4: expected 'a' tag, not 'scene'");
}

#[test]
fn files_are_read_from_the_disk() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let write = |name: &str, text: &str| std::fs::write(at(name), text).expect("written");
    std::fs::create_dir(at("sub")).expect("created");
    write("x.xml", &scene("<include filename='sub/a.xml'/>"));
    write(
        "sub/a.xml",
        &scene("<shape type='obj'><string name='filename' value='m.obj'/></shape>"),
    );
    write("folder.xml", &scene("<include filename='sub'/>"));
    let load = |name: &str| scene_file::load(&at(name), 1 << 20, &Progress::default());
    let scene = load("x.xml").expect("good");
    let ShapeKind::Obj(mesh) = &scene.shapes[0].kind else {
        panic!("{:?}", scene.shapes);
    };
    assert_eq!(mesh.file, at("sub/m.obj"));
    let shown = |name: &str| at(name).display().to_string();
    let directory = "this is a directory, not a scene file";
    assert_eq!(
        message(load("sub")),
        format!("{}: {directory}", shown("sub"))
    );
    assert_eq!(
        message(load("folder.xml")),
        format!(
            "{}:2: included file “sub”: {directory}",
            shown("folder.xml")
        )
    );
    let missing = load("none.xml").expect_err("missing").to_string();
    assert!(missing.starts_with(&shown("none.xml")), "{missing}");
}

#[cfg(target_os = "linux")]
#[test]
fn pipes_and_devices_are_not_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("pipe.xml");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|status| status.success()));
    let load = |path: &Path| message(scene_file::load(path, 1 << 20, &Progress::default()));
    assert_eq!(
        load(&pipe),
        format!("{}: not a regular file", pipe.display())
    );
    assert_eq!(
        load(Path::new("/dev/zero")),
        "/dev/zero: not a regular file"
    );
}

#[test]
fn a_cancelled_load_stops() {
    let progress = Progress::default();
    progress.cancel();
    let none = |_: &Path, _: u64| Err(io::ErrorKind::NotFound.into());
    let text = scene("<shape type='disk'/>");
    let result = scene_file::parse(
        text.as_bytes(),
        Path::new("x.xml"),
        1 << 20,
        &none,
        &progress,
    );
    assert_eq!(message(result), "x.xml: loading was cancelled");
}
