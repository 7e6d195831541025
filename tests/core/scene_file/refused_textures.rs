//! Refused textures, normal maps and bump maps: each message names the line and the problem.

use super::{message, parse, scene};

/// Contents of a scene from line 2, and the message after the file's name.
const CONTENTS: &[(&str, &str)] = &[
    (
        "<texture type='bitmpa' id='a'/>",
        "2: unknown texture “bitmpa”; the nearest known one is “bitmap”",
    ),
    (
        "<texture type='bitmap' id='a'/>",
        "2: texture “bitmap”: parameter “filename” is missing",
    ),
    (
        "<bsdf type='diffuse' id='a'>\n<ref name='reflectance' id='t'/></bsdf>",
        "3: no texture “t” is defined before this line",
    ),
    (
        "<bsdf type='diffuse' id='a'><float name='reflectance' value='1'/>\n<texture name='reflectance' type='checkerboard'/></bsdf>",
        "3: parameter “reflectance” is given twice",
    ),
    (
        "<bsdf type='bumpmap' id='a'><bsdf type='diffuse'/></bsdf>",
        "2: bsdf “bumpmap”: a nested texture is missing",
    ),
    (
        "<bsdf type='normalmap' id='a'><texture name='normalmap' type='checkerboard'/></bsdf>",
        "2: bsdf “normalmap”: a nested bsdf is missing",
    ),
    (
        "<shape type='disk'><emitter type='area'><float name='radiance' value='1'/>\n<texture name='radiance' type='checkerboard'/></emitter></shape>",
        "3: parameter “radiance” is given twice",
    ),
];

#[test]
fn each_error_about_a_texture_has_its_line_and_reason() {
    for (contents, expected) in CONTENTS {
        let found = message(parse(&scene(contents)));
        assert_eq!(found, format!("x.xml:{expected}"), "{contents}");
    }
}
