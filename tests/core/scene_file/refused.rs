//! Refused files: each message names the line and the problem.

use super::{message, parse, scene};

/// Contents of a scene from line 2, and the message after the file's name.
const CONTENTS: &[(&str, &str)] = &[
    // Elements and types.
    (
        "<shap type='disk'/>",
        "2: unknown element “shap”; the nearest known one is “shape”",
    ),
    (
        "\n<shape type='spher'/>",
        "3: unknown shape “spher”; the nearest known one is “sphere”",
    ),
    ("<shape type='ply'/>", "2: shape “ply” isn't supported"),
    ("<shape/>", "2: <shape> has no attribute “type”"),
    (
        "<shape type='disk' idd='a'/>",
        "2: unknown attribute of <shape>: “idd”; the nearest known one is “id”",
    ),
    (
        "<sensor type='perspectiv'/>",
        "2: unknown sensor “perspectiv”; the nearest known one is “perspective”",
    ),
    (
        "<emitter type='dot'/>",
        "2: unknown emitter “dot”; expected “area”, “constant”, “directional”, “directionalarea”, “envmap”, “point”, “projector”, “spot”, “sunsky” or “timed_sunsky”",
    ),
    (
        "<integrator type='paths'/>",
        "2: unknown integrator “paths”; the nearest known one is “path”",
    ),
    (
        "<integrator type='path'/>\n<integrator type='direct'/>",
        "3: the scene has a second integrator",
    ),
    (
        "<bsdf type='difuse' id='a'/>",
        "2: unknown bsdf “difuse”; the nearest known one is “diffuse”",
    ),
    (
        "<float name='a' value='1'/>",
        "2: <float> can't stand in <scene>",
    ),
    (
        "<translate x='1'/>",
        "2: <translate> can't stand in <scene>",
    ),
    ("<alias id='a' as='b'/>", "2: <alias> isn't supported"),
    (
        "<scene version='3.0.0'/>",
        "2: <scene> can't stand in <scene>",
    ),
    // Parameters.
    (
        "<shape type='plane'><vector name='v' x='1' y='0' z='0'/>\n<vector name='normal' z='1' x='0' y='0'/></shape>",
        "3: a plane is described by “p0”, “p1” and “p2”, by “a”, “b”, “c” and “d”, by “point”, “v” and “w”, or by “point” and “normal”, not by both “v” and “normal”",
    ),
    (
        "<shape type='sphere'>\n<float name='radios' value='1'/></shape>",
        "3: unknown parameter of shape “sphere”: “radios”; the nearest known one is “radius”",
    ),
    (
        "<shape type='disk'><float name='radius' value='1'/></shape>",
        "2: unknown parameter of shape “disk”: “radius”; expected “flip_normals”, “silhouette_sampling_weight” or “to_world”",
    ),
    (
        "<shape type='sphere'><string name='radius' value='1'/></shape>",
        "2: “radius” must be <float>, not <string>",
    ),
    (
        "<shape type='sphere'><float name='center' value='1'/></shape>",
        "2: “center” must be <point>, not <float>",
    ),
    (
        "<shape type='sphere'><float name='radius' value='1'/>\n<float name='radius' value='1'/></shape>",
        "3: parameter “radius” is given twice",
    ),
    (
        "<shape type='sphere'><float name='radius'/></shape>",
        "2: <float> has no attribute “value”",
    ),
    (
        "<shape type='sphere'><float value='1'/></shape>",
        "2: <float> has no attribute “name”",
    ),
    (
        "<shape type='sphere'><point name='center' x='1'/></shape>",
        "2: <point> has no attribute “y”",
    ),
    (
        "<shape type='sphere'><point name='center' value='1 2'/></shape>",
        "2: “1 2” isn't one number or three",
    ),
    (
        "<shape type='sphere'><float name='radius' value='nan'/></shape>",
        "2: “nan” isn't a finite number",
    ),
    (
        "<shape type='sphere'><float name='radius' value='1e999'/></shape>",
        "2: “1e999” is too large: numbers end at 1.8e308",
    ),
    (
        "<shape type='sphere'><float name='radius' value='1,5'/></shape>",
        "2: “1,5” isn't a number",
    ),
    (
        "<shape type='sphere'><float name='radius' value='0'/></shape>",
        "2: “radius” must be greater than 0",
    ),
    (
        "<shape type='sphere'><float name='radius' value='-1'/></shape>",
        "2: “radius” must be greater than 0",
    ),
    (
        "<shape type='disk'><boolean name='flip_normals' value='1'/></shape>",
        "2: “1” isn't “true” or “false”",
    ),
    (
        "<shape type='sphere'><float name='radius' value='1'>\n<rgb/></float></shape>",
        "3: <float> contains an element",
    ),
    (
        "<shape type='sphere'><float name='radius' value='$r'/></shape>",
        "2: parameter “r” isn't defined",
    ),
    // Shapes.
    (
        "<shape type='obj'/>",
        "2: shape “obj”: parameter “filename” is missing",
    ),
    (
        "<shape type='obj'><string name='filename' value=''/></shape>",
        "2: the file name is empty",
    ),
    (
        "<shape type='obj'><string name='filename' value='//host/a'/></shape>",
        "2: “//host/a”: network paths aren't opened",
    ),
    (
        "<shape type='cone'><point name='p1' value='0'/></shape>",
        "2: shape “cone”: p0 and p1 are the same point",
    ),
    (
        "<shape type='plane'><vector name='normal' value='0'/></shape>",
        "2: shape “plane”: “normal” is zero",
    ),
    (
        "<shape type='box'><point name='max' value='1 1 -1'/></shape>",
        "2: shape “box”: “min” must be less than “max” in each coordinate",
    ),
    (
        "<shape type='quadric'><float name='j' value='1'/></shape>",
        "2: shape “quadric”: the coefficients “a” to “i” are all zero",
    ),
    (
        "<shape type='csg'/>",
        "2: shape “csg”: parameter “operation” is missing",
    ),
    (
        "<shape type='csg'><string name='operation' value='minus'/></shape>",
        "2: unknown operation “minus”; expected “union”, “intersection” or “difference”",
    ),
    (
        "<shape type='csg'><string name='operation' value='union'/><shape type='disk'/></shape>",
        "2: shape “csg”: at least two nested shapes are needed",
    ),
    (
        "<shape type='disk'>\n<shape type='disk'/></shape>",
        "3: a shape can only be nested in a csg",
    ),
    // Identifiers and materials.
    (
        "<shape type='disk' id='a'/>\n<sensor type='perspective' id='a'/>",
        "3: id “a” is in use since line 2",
    ),
    (
        "<shape type='disk'>\n<ref id='m'/></shape>",
        "3: unknown id of a bsdf: “m”",
    ),
    (
        "<bsdf type='diffuse' id='wood'/><shape type='disk'>\n<ref id='wod'/></shape>",
        "3: unknown id of a bsdf: “wod”; the nearest known one is “wood”",
    ),
    (
        "<shape type='disk'><ref id='s'/></shape><emitter type='sky' id='t'/>",
        "2: unknown emitter “sky”; expected “area”, “constant”, “directional”, “directionalarea”, “envmap”, “point”, “projector”, “spot”, “sunsky” or “timed_sunsky”",
    ),
    (
        "<shape type='disk'><ref id='s'/></shape><emitter type='point' id='s'/>",
        "2: “s” is <emitter>, not <bsdf>",
    ),
    (
        "<shape type='disk'><bsdf type='diffuse'/>\n<ref id='m'/></shape>",
        "3: shape “disk” has a second bsdf",
    ),
    (
        "<shape type='disk'><emitter type='area'/>\n<emitter type='area'/></shape>",
        "3: shape “disk” has a second emitter",
    ),
    (
        "<bsdf type='diffuse' id='a'><rgb name='reflectance' value='1.5 0 0'/></bsdf>",
        "2: “reflectance” must be from 0 to 1",
    ),
    (
        "<bsdf type='diffuse' id='a'><string name='reflectance' value='red'/></bsdf>",
        "2: “reflectance” must be <rgb>, not <string>",
    ),
    (
        "<bsdf type='diffuse' id='a'><rgb name='reflectance' value='#ff8000'/></bsdf>",
        "2: “#ff8000” isn't a number",
    ),
    (
        "<bsdf type='diffuse' id='a'><spectrum name='reflectance' value='400:0.5, 700:1'/></bsdf>",
        "2: “400:0.5, 700:1” isn't a constant; spectra by wavelength aren't supported, use <rgb>",
    ),
    (
        "<bsdf type='twosided' id='a'/>",
        "2: bsdf “twosided”: a nested bsdf is missing",
    ),
    (
        "<bsdf type='twosided' id='a'><ref id='b'/></bsdf>",
        "2: no bsdf “b” is defined before this line",
    ),
    (
        "<bsdf type='twosided' id='a'>\n<bsdf type='dielectric'/></bsdf>",
        "3: light passes through this bsdf, so it can't stand in “twosided”: use it alone, it has both sides",
    ),
    // Transforms.
    (
        "<shape type='disk'><transform><scale/></transform></shape>",
        "2: <transform> has no attribute “name”",
    ),
    (
        "<shape type='disk'><transform name='to_world'><look_at/></transform></shape>",
        "2: unknown operation “look_at”; the nearest known one is “lookat”",
    ),
    (
        "<shape type='disk'><transform name='to_world'><rotate x='1'/></transform></shape>",
        "2: <rotate> has no attribute “angle”",
    ),
    (
        "<shape type='disk'><transform name='to_world'><rotate angle='1'/></transform></shape>",
        "2: the rotation axis is zero",
    ),
    (
        "<shape type='disk'><transform name='to_world'><scale value='1' x='1'/></transform></shape>",
        "2: “value” and “x”, “y”, “z” exclude each other",
    ),
    (
        "<shape type='disk'><transform name='to_world'>\n<scale value='1e200'/><scale value='1e200'/></transform></shape>",
        "3: the transform isn't finite",
    ),
    (
        "<shape type='disk'><transform name='to_world'><matrix value='1 2 3'/></transform></shape>",
        "2: “1 2 3” isn't a list of 9 or 16 numbers",
    ),
    (
        "<shape type='disk'><transform name='to_world'>\n<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0.5 0 0 1'/></transform></shape>",
        "3: the last row of the matrix must be 0 0 0 1, not 0.5 0 0 1; other transforms aren't affine",
    ),
    (
        "<shape type='disk'><transform name='to_world'><matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2'/></transform></shape>",
        "2: the last row of the matrix must be 0 0 0 1, not 0 0 0 2; other transforms aren't affine",
    ),
    (
        "<shape type='disk'><transform name='to_world'><lookat origin='0,0,0' target='0,0,0'/></transform></shape>",
        "2: origin and target are the same point",
    ),
    (
        "<shape type='disk'><transform name='to_world'><lookat origin='0,0,0' target='0,1,0' up='0,1,0'/></transform></shape>",
        "2: the up vector is zero or points towards the target",
    ),
    (
        "<shape type='disk'><transform name='to_world'><lookat target='0,1,0'/></transform></shape>",
        "2: <lookat> has no attribute “origin”",
    ),
    (
        "<shape type='disk'><transform name='to_world'><lookat origin='1' target='0,1,0'/></transform></shape>",
        "2: “1” isn't three numbers",
    ),
    // Sensors.
    (
        "<sensor type='perspective'><float name='fov' value='180'/></sensor>",
        "2: “fov” must be between 0 and 180",
    ),
    (
        "<sensor type='perspective'><string name='fov_axis' value='z'/></sensor>",
        "2: unknown axis “z”; expected “x”, “y”, “diagonal”, “smaller” or “larger”",
    ),
    (
        "<sensor type='perspective'><string name='focal_length' value='5cm'/></sensor>",
        "2: “5cm” isn't a focal length such as “50mm”",
    ),
    (
        "<sensor type='perspective'><float name='fov' value='9'/>\n<string name='focal_length' value='5mm'/></sensor>",
        "3: “fov” and “focal_length” exclude each other",
    ),
    (
        "<sensor type='thinlens'/>",
        "2: sensor “thinlens”: parameter “aperture_radius” is missing",
    ),
    (
        "<sensor type='orthographic'><float name='fov' value='9'/></sensor>",
        "2: unknown parameter of sensor “orthographic”: “fov”; expected “far_clip”, “near_clip”, “principal_point_offset_x”, “principal_point_offset_y”, “shutter_close”, “shutter_open” or “to_world”",
    ),
    (
        "<sensor type='perspective'><film type='hdrfilm'>\n<integer name='width' value='0'/></film></sensor>",
        "3: “width” must be from 1 to 16384",
    ),
    (
        "<sensor type='perspective'><film type='hdrfilm'>\n<integer name='height' value='16385'/></film></sensor>",
        "3: “height” must be from 1 to 16384",
    ),
    (
        "<sensor type='perspective'><film type='hdrfilm'><float name='width' value='9'/></film></sensor>",
        "2: “width” must be <integer>, not <float>",
    ),
    (
        "<sensor type='perspective'><film type='hdrfilm'/>\n<film type='hdrfilm'/></sensor>",
        "3: sensor “perspective” has a second film",
    ),
    (
        "<sensor type='perspective'><film type='hdrfilm'><integer name='crop_width' value='999'/></film></sensor>",
        "2: film “hdrfilm”: the crop window exceeds the film",
    ),
    (
        "<sensor type='perspective'><sampler type='independant'/></sensor>",
        "2: unknown sampler “independant”; the nearest known one is “independent”",
    ),
];

#[test]
fn each_error_has_its_line_and_reason() {
    for (contents, expected) in CONTENTS {
        let found = message(parse(&scene(contents)));
        assert_eq!(found, format!("x.xml:{expected}"), "{contents}");
    }
}

#[test]
fn files_that_are_not_scenes_are_refused() {
    for (text, expected) in [
        ("", "x.xml:1:1: the document does not have a root node"),
        ("v 1 2 3", "x.xml:1:1: unknown token"),
        (
            "<scene version='3.0.0'>\n  <a></b>\n</scene>",
            "x.xml:2:6: expected 'a' tag, not 'b'",
        ),
        (
            "<scene version='3.0.0'>\n",
            "x.xml:1:1: the root node was opened but never closed",
        ),
        (
            "<scene version='3.0.0' version='3.0.0'/>",
            "x.xml:1:24: attribute 'version' is already defined",
        ),
        (
            "<scene version='3.0.0'><a b='&c;'/></scene>",
            "x.xml:1:30: unknown entity reference 'c'",
        ),
        (
            "\n<html/>",
            "x.xml:2: the root element is “html”, not “scene”",
        ),
        (
            "<scene/>",
            "x.xml:1: <scene> has no attribute “version”, such as “3.0.0”",
        ),
        (
            "<scene version='3'/>",
            "x.xml:1: “3” isn't a version such as “3.0.0”",
        ),
        (
            "<scene version='0.6.0'/>",
            "x.xml:1: version “0.6.0” of the format isn't supported: 2.0.0 is the first",
        ),
        (
            "<scene version='3.0.0' xmlns='a'/>",
            "x.xml:1: XML namespaces aren't supported",
        ),
        (
            "<scene version='3.0.0' a='b'/>",
            "x.xml:1: unknown attribute of <scene>: “a”; expected “version”",
        ),
    ] {
        assert_eq!(message(parse(text)), expected, "{text}");
    }
}
