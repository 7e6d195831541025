//! What scenes can't hold is refused or told with its line.

use super::{Files, loaded};

/// The message about a scene file that is refused, after its path.
fn refusal(contents: &str) -> String {
    let files = Files::new(contents);
    let message = files.load().err().map(|error| error.to_string());
    let message = message.unwrap_or_else(|| panic!("accepted: {contents}"));
    let path = files.path().display().to_string();
    let rest = message.strip_prefix(&path).map(str::to_owned);
    rest.unwrap_or_else(|| panic!("{message} doesn't name {path}"))
}

#[test]
fn a_shape_that_does_not_fit_in_f32_is_refused_with_the_line() {
    let moved = |shape: &str, operation: &str| {
        let file = match shape {
            "obj" => "<string name='filename' value='mesh.obj'/>",
            _ => "",
        };
        let transform = format!("<transform name='to_world'>{operation}</transform>");
        format!("\n<shape type='{shape}'>{transform}{file}</shape>")
    };
    for contents in [
        "\n<shape type='sphere'><float name='radius' value='1e300'/></shape>".to_owned(),
        "\n<shape type='sphere'><float name='radius' value='3e38'/><point name='center' value='1e38'/></shape>\
         <shape type='sphere'><point name='center' value='-1e38'/></shape>"
            .to_owned(),
        "\n<shape type='plane'><point name='point' value='0 0 1e39'/></shape><shape type='disk'/>".to_owned(),
        moved("cube", "<scale value='1e39'/>"),
        moved("cube", "<scale value='1e-60'/>"),
        moved("torus", "<scale value='1e39'/>"),
        moved("cylinder", "<scale value='1e39'/>"),
        moved("sphere", "<scale x='1e39'/>"),
        moved("sphere", "<scale x='1e25' y='2e25' z='1e25'/>"),
        moved("sphere", "<scale x='1e-25' y='2e-25' z='1e-25'/>"),
        moved("obj", "<scale value='1e39'/>"),
        moved("obj", "<scale value='1e-60'/>"),
        "\n<shape type='csg'><string name='operation' value='union'/><shape type='sphere'/>\
         <shape type='sphere'><float name='radius' value='1e300'/></shape></shape>"
            .to_owned(),
    ] {
        let found = refusal(&contents);
        let expected = ":3: the shape doesn't fit in 32-bit numbers";
        assert!(found.starts_with(expected), "{contents}: {found}");
    }
    let lamp = "<emitter type='point'><point name='position' value='0 1e39 0'/></emitter>";
    let found = refusal(&format!("<shape type='disk'/>\n{lamp}"));
    assert!(found.starts_with(":3: the light is too far"), "{found}");
    // Far away is possible for a single shape: the origin is near it.
    let far = loaded("<shape type='sphere'><point name='center' value='1e39 0 0'/></shape>");
    assert!(!far.scene.bounds().is_empty());
}

#[test]
fn a_missing_or_broken_file_is_reported_with_the_line_that_names_it() {
    let found = refusal("\n<shape type='obj'><string name='filename' value='none.obj'/></shape>");
    assert!(
        found.starts_with(":3: shape “obj”: “filename”: "),
        "{found}"
    );
    assert!(
        found.contains("none.obj: ") && found.ends_with(": not found"),
        "{found}"
    );
    let sky = "<emitter type='envmap'><string name='filename' value='none.hdr'/></emitter>";
    let found = refusal(sky);
    assert!(
        found.starts_with(":2: emitter “envmap”: “filename”: "),
        "{found}"
    );
    assert!(
        found.contains("none.hdr: ") && found.ends_with(": not found"),
        "{found}"
    );
    let files = Files::new("<shape type='obj'><string name='filename' value='bad.obj'/></shape>");
    std::fs::write(files.folder.path().join("bad.obj"), "v 0 0 0\nf 1 2 3\n").expect("written");
    let found = files.load().expect_err("refused").to_string();
    assert!(
        found.contains("scene.xml:2: shape “obj”: “filename”: ") && found.contains("bad.obj:2:"),
        "{found}"
    );
}

#[test]
fn scenes_without_size_have_no_warning_about_it() {
    let warnings = |contents: &str| -> Vec<String> {
        let warnings = loaded(contents).report.warnings.clone();
        warnings.iter().map(ToString::to_string).collect()
    };
    assert!(warnings("<shape type='plane'/>").is_empty());
    assert_eq!(warnings(""), ["the scene is empty"]);
}

#[test]
fn a_picture_whose_scale_makes_it_too_bright_is_refused_with_the_line() {
    let sky = |scale: &str| {
        let files = Files::new(&format!(
            "<shape type='disk'/>\n<emitter type='envmap'>\
             <string name='filename' value='sky.hdr'/><float name='scale' value='{scale}'/></emitter>"
        ));
        // Two pixels of radiance 1024: 128·2^(139 − 136).
        let mut hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 1\n".to_vec();
        hdr.extend([128, 128, 128, 139, 128, 128, 128, 139]);
        std::fs::write(files.folder.path().join("sky.hdr"), hdr).expect("written");
        files.load().map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(sky("1e11"), Ok(()));
    let error = sky("1e12").expect_err("refused");
    let expected = "scene.xml:3: the picture times “scale” is too bright";
    assert!(error.contains(expected), "{error}");
}

#[test]
fn a_mirrored_light_gives_a_warning_and_its_side_is_told() {
    let light = "<emitter type='area'/>";
    let mirror = "<transform name='to_world'><scale x='-1'/></transform>";
    let flip = "<boolean name='flip_normals' value='true'/>";
    let file = "<string name='filename' value='mesh.obj'/>";
    for (shape, parts, is_warned, is_flipped) in [
        ("sphere", [light, mirror, ""], true, true),
        ("sphere", [light, mirror, flip], false, false),
        ("sphere", [light, "", ""], false, false),
        ("sphere", [light, flip, ""], false, true),
        ("cube", [light, mirror, ""], false, false),
        ("obj", [light, mirror, file], true, false),
        ("obj", [light, file, ""], false, false),
    ] {
        let scene = loaded(&format!(
            "<shape type='{shape}'>\n{}</shape>",
            parts.concat()
        ));
        let warnings = &scene.report.warnings;
        let told: Vec<_> = warnings
            .iter()
            .map(|w| (w.line, w.message.as_str()))
            .collect();
        let expected = "the transform mirrors the shape, so that its light shines from the other side, as in Mitsuba; “flip_normals” turns it back";
        let expected = is_warned.then_some((Some(3), expected));
        assert_eq!(told, Vec::from_iter(expected), "{shape} {parts:?}");
        assert_eq!(
            scene.scene.groups()[0].is_flipped(0),
            is_flipped,
            "{shape} {parts:?}"
        );
    }
}
