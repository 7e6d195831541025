//! Emitters and integrators, and their defaults.

use super::features::read;
use super::{message, parse, scene, warnings};
use glam::{DMat4, DVec3};
use hitscope_core::scene_file::{self, EmitterKind, SceneFile, Value};
use std::path::{Path, PathBuf};

/// The emitters of a file without warnings.
fn kinds(contents: &str) -> Vec<EmitterKind> {
    let scene = read(contents);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let emitters = scene.emitters.iter();
    emitters.map(|emitter| emitter.kind.clone()).collect()
}

#[test]
fn emitters_have_mitsubas_defaults() {
    for (contents, expected) in [
        (
            "<emitter type='constant'/>",
            EmitterKind::Constant {
                radiance: DVec3::ONE,
            },
        ),
        (
            "<emitter type='point'/>",
            EmitterKind::Point {
                position: DVec3::ZERO,
                intensity: DVec3::ONE,
            },
        ),
        (
            "<emitter type='directional'/>",
            EmitterKind::Directional {
                direction: DVec3::Z,
                irradiance: DVec3::ONE,
            },
        ),
        (
            "<emitter type='envmap'><string name='filename' value='sky.exr'/></emitter>",
            EmitterKind::Envmap {
                file: PathBuf::from("sky.exr"),
                scale: 1.0,
                to_world: DMat4::IDENTITY,
            },
        ),
    ] {
        assert_eq!(kinds(contents), [expected], "{contents}");
    }
    let lamp = read("<shape type='disk'><emitter type='area'/></shape>");
    let emitter = lamp.shapes[0].emitter.as_ref().expect("an emitter");
    let expected = EmitterKind::Area {
        radiance: DVec3::ONE,
        texture: None,
    };
    assert_eq!(emitter.kind, expected);
}

#[test]
fn light_is_a_colour_or_a_number() {
    let light = DVec3::new(1.0, 2.0, 3.0);
    for (property, expected) in [
        ("<rgb name='radiance' value='1 2 3'/>", light),
        ("<spectrum name='radiance' value='5'/>", DVec3::splat(5.0)),
        ("<float name='radiance' value='5'/>", DVec3::splat(5.0)),
    ] {
        let contents = format!("<emitter type='constant'>{property}</emitter>");
        let expected = EmitterKind::Constant { radiance: expected };
        assert_eq!(kinds(&contents), [expected], "{property}");
    }
}

#[test]
fn a_transform_moves_points_and_turns_directions() {
    let moved =
        "<transform name='to_world'><rotate y='1' angle='90'/><translate x='5'/></transform>";
    let file = format!(
        "<emitter type='point'>{moved}</emitter><emitter type='directional'>{moved}</emitter>"
    );
    let expected = [
        EmitterKind::Point {
            position: DVec3::new(5.0, 0.0, 0.0),
            intensity: DVec3::ONE,
        },
        EmitterKind::Directional {
            direction: DVec3::X,
            irradiance: DVec3::ONE,
        },
    ];
    assert_eq!(kinds(&file), expected);
}

#[test]
fn emitters_that_are_not_supported_are_kept_and_the_warning_names_a_similar_one() {
    let scene = read(
        "<emitter type='spot' id='s'><float name='cutoff_angle' value='20'/></emitter>
         <emitter type='sunsky'/>
         <shape type='disk'><emitter type='directionalarea'/></shape>
         <emitter type='constant'><texture type='bitmap' name='radiance'/><float name='sampling_weight' value='2'/></emitter>",
    );
    let expected = [
        "line 2: emitter “spot” isn't supported and gives no light; the most similar one that is supported is “point”",
        "line 3: emitter “sunsky” isn't supported and gives no light; the most similar one that is supported is “envmap”",
        "line 4: emitter “directionalarea” isn't supported and gives no light; the most similar one that is supported is “area”",
        "line 5: emitter “constant”: textures aren't supported; a constant of 1 is used",
        "line 5: emitter “constant”: parameter “sampling_weight” isn't used",
    ];
    assert_eq!(warnings(&scene), expected);
    assert_eq!(scene.emitters[0].id.as_deref(), Some("s"));
    let EmitterKind::Other(plugin) = &scene.emitters[0].kind else {
        panic!("{:?}", scene.emitters[0]);
    };
    assert_eq!(plugin.parameters[0].value, Value::Float(20.0));
}

#[test]
fn emitters_are_written_as_they_are_read() {
    let text = r#"<emitter type="envmap" id="sky"><string name="filename" value="sub/sky.exr"/></emitter>
        <emitter type="spot"><point name="position" value="1 2 3"/></emitter>
        <emitter type="directional"><vector name="direction" value="1 2 3"/></emitter>
        <shape type="disk"><emitter type="area" name="lamp"><spectrum name="radiance" value="5"/></emitter></shape>"#;
    let written = scene_file::to_xml(&read(text), Path::new("")).expect("written");
    for part in [
        r#"<emitter type="envmap" id="sky">"#,
        r#"<string name="filename" value="sub/sky.exr"/>"#,
        r#"<emitter type="spot">"#,
        r#"<point name="position" value="1, 2, 3"/>"#,
        r#"<vector name="direction" value="1, 2, 3"/>"#,
        r#"<emitter type="area" name="lamp">"#,
        r#"<rgb name="radiance" value="5, 5, 5"/>"#,
    ] {
        assert!(written.contains(part), "{part} in {written}");
    }
}

/// Contents of a scene from line 2, and the message after the file's name.
const REFUSED: &[(&str, &str)] = &[
    (
        "<emitter type='area'/>",
        "2: emitter “area” must stand in a shape",
    ),
    (
        "<shape type='disk'>\n<emitter type='point'/></shape>",
        "3: emitter “point” can't stand in a shape, only “area” can",
    ),
    (
        "<shape type='disk'><emitter type='area'>\n<rgb name='radiance' value='1 -1 1'/></emitter></shape>",
        "3: “radiance” must not be negative",
    ),
    (
        "<emitter type='point'>\n<float name='intensity' value='1e39'/></emitter>",
        "3: “intensity” is too large for 32-bit numbers, which end at 3.4e38",
    ),
    (
        "<emitter type='point'>\n<point name='intensity' value='1'/></emitter>",
        "3: “intensity” must be <rgb>, not <point>",
    ),
    (
        "<emitter type='point'>\n<float name='intensty' value='1'/></emitter>",
        "3: unknown parameter of emitter “point”: “intensty”; the nearest known one is “intensity”",
    ),
    (
        "<emitter type='point'><point name='position' value='1'/><transform name='to_world'/></emitter>",
        "2: emitter “point”: “position” and “to_world” exclude each other",
    ),
    (
        "<emitter type='directional'><vector name='direction' value='1'/><transform name='to_world'/></emitter>",
        "2: emitter “directional”: “direction” and “to_world” exclude each other",
    ),
    (
        "<emitter type='directional'><vector name='direction' value='0'/></emitter>",
        "2: emitter “directional”: “direction” is zero",
    ),
    (
        "<shape type='disk'><emitter type='area'><transform name='to_world'/></emitter></shape>",
        "2: emitter “area”: “to_world” isn't allowed: the light is where the shape is",
    ),
    (
        "<shape type='disk'><emitter type='area'>\n<rgb name='radiance' value='1 3e14 1'/></emitter></shape>",
        "3: “radiance” is too bright: a picture holds at most 2.8e14 per colour channel",
    ),
    (
        "<emitter type='envmap'><string name='filename' value='a.exr'/>\n<float name='scale' value='1e15'/></emitter>",
        "3: “scale” is too bright: a picture holds at most 2.8e14 per colour channel",
    ),
    (
        "<emitter type='envmap'/>",
        "2: emitter “envmap”: parameter “filename” is missing",
    ),
    (
        "<emitter type='envmap'><string name='filename' value='a.exr'/><transform name='to_world'><scale value='2'/></transform></emitter>",
        "2: emitter “envmap”: “to_world” must be a rotation",
    ),
    (
        "<emitter type='constant'/>\n<emitter type='envmap'><string name='filename' value='a.exr'/></emitter>",
        "3: the scene has a second environment",
    ),
    (
        "<integrator type='path'>\n<integer name='max_depth' value='-2'/></integrator>",
        "3: “max_depth” must be -1 or more",
    ),
    (
        "<integrator type='path'>\n<integer name='max_dept' value='2'/></integrator>",
        "3: unknown parameter of integrator “path”: “max_dept”; the nearest known one is “max_depth”",
    ),
];

#[test]
fn refused_emitters_and_integrators_are_reported_with_the_line() {
    for (contents, expected) in REFUSED {
        let found = message(parse(&scene(contents)));
        assert_eq!(found, format!("x.xml:{expected}"), "{contents}");
    }
}

/// The view and the depth limit of an integrator.
fn view(file: &SceneFile) -> (Option<&'static str>, Option<u32>) {
    let integrator = file.integrator.as_ref().expect("an integrator");
    (integrator.view, integrator.depth_limit)
}

#[test]
fn the_depth_limit_does_not_count_the_emitter() {
    for (depth, limit) in [(-1, None), (1, Some(0)), (2, Some(1)), (9, Some(8))] {
        let file = read(&format!(
            "<integrator type='path'><integer name='max_depth' value='{depth}'/></integrator>"
        ));
        assert_eq!(view(&file), (Some("path"), limit), "{depth}");
        assert!(file.warnings.is_empty(), "{:?}", file.warnings);
    }
}

#[test]
fn integrators_name_views_or_what_is_shown_instead() {
    for (kind, name, message) in [
        ("path", Some("path"), None),
        ("direct", Some("direct"), None),
        ("depth", Some("depth"), None),
        ("ao", Some("ao"), None),
        (
            "volpath",
            Some("path"),
            Some("line 2: integrator “volpath” isn't supported; the view “path” is shown instead"),
        ),
        (
            "aov",
            None,
            Some("line 2: integrator “aov” isn't supported"),
        ),
    ] {
        let file = read(&format!("<integrator type='{kind}'/>"));
        assert_eq!(view(&file), (name, None));
        assert_eq!(warnings(&file), Vec::from_iter(message), "{kind}");
    }
    let file = parse(&scene(
        "<integrator type='path'>
         <integer name='max_depth' value='0'/><integer name='rr_depth' value='9'/>
         <boolean name='hide_emitters' value='true'/></integrator>",
    ));
    let file = file.expect("good");
    assert_eq!(view(&file), (Some("path"), Some(0)));
    let integrator = file.integrator.as_ref().expect("an integrator");
    assert_eq!(
        (integrator.roulette_depth, integrator.hides_emitters),
        (9, true)
    );
    let expected = ["line 3: “max_depth” 0 is black in Mitsuba; here, emitters are visible"];
    assert_eq!(warnings(&file), expected);
}
