//! The scene that is changed, and the pieces that are inserted into it.

/// A scene with one element on each line, so that changes of lines keep many files well-formed.
pub const SCENE: &str = r#"<scene version="3.0.0">
<default name="q" value="2"/>
<default name="r" value="$q $q 1"/>
<integrator type="path"><integer name="max_depth" value="3"/></integrator>
<sensor type="perspective" id="s"><float name="fov" value="40"/><string name="fov_axis" value="y"/></sensor>
<sensor type="thinlens"><float name="aperture_radius" value="0.1"/><film type="hdrfilm"><integer name="width" value="9"/></film></sensor>
<sensor type="orthographic"><transform name="to_world"><scale value="$q"/></transform></sensor>
<emitter type="point" id="e"><point name="position" value="1 2 3"/><rgb name="intensity" value="1 2 3"/></emitter>
<emitter type="spot"><boolean name="b" value="true"/></emitter>
<emitter type="directional"><vector name="direction" value="0 0 -1"/></emitter>
<emitter type="constant"><spectrum name="radiance" value="0.5"/><texture type="bitmap"><ref id="t"/></texture></emitter>
<include filename="part.xml"/>
<bsdf type="twosided" id="m"><bsdf type="diffuse"><rgb name="reflectance" value="0.1,0.2,0.3"/></bsdf></bsdf>
<bsdf type="plastic" id="n"/>
<shape type="obj"><string name="filename" value="a &amp; b.obj"/><ref id="m"/></shape>
<shape type="sphere"><point name="center" x="1" y="$q" z="3"/><float name="radius" value="2"/></shape>
<shape type="cylinder"><bsdf type="diffuse"/><point name="p0" value="5"/></shape>
<shape type="rectangle"><transform name="to_world"><rotate y="1" angle="37"/><translate value="$r"/></transform></shape>
<shape type="disk"><transform name="to_world"><lookat origin="1,2,3" target="4,5,7" up="0,1,0"/></transform></shape>
<shape type="cube"><emitter type="area"><rgb name="radiance" value="3"/></emitter><boolean name="flip_normals" value="true"/></shape>
<shape type="cube"><transform name="to_world"><matrix value="1 2 3 4 5 6 7 8 9"/></transform><ref id="late"/></shape>
<shape type="plane"><vector name="normal" value="1 0 1"/></shape>
<shape type="box"><point name="max" value="2"/></shape>
<shape type="cone"><boolean name="capped" value="true"/></shape>
<shape type="torus"><float name="minor" value="0.1"/></shape>
<shape type="quadric"><float name="a" value="1"/><float name="j" value="-1"/></shape>
<shape type="csg"><string name="operation" value="difference"/>
<bsdf type="diffuse"/>
<shape type="sphere"/>
<shape type="cube"><bsdf type="diffuse"/></shape>
</shape>
<bsdf type="diffuse" id="late"><float name="reflectance" value="0.25"/></bsdf>
</scene>
"#;

/// The file that the scene includes.
pub const PART: &str = r#"<scene version="3.0.0">
<!-- A part. -->
<default name="p" value="1e3"/>
<shape type="sphere"><float name="radius" value="$p"/><ref id="m"/></shape>
<medium type="homogeneous"/>
</scene>
"#;

/// Pieces of scene files, valid and invalid.
pub const WORDS: [&str; 56] = [
    "<",
    ">",
    "/>",
    "</",
    "\"",
    "'",
    "=",
    "&",
    ";",
    "&amp;",
    "&#36;",
    "&#1;",
    "<!--",
    "-->",
    "<![CDATA[",
    "]]>",
    "<?",
    "?>",
    "<!DOCTYPE a [<!ENTITY b 'c'>]>",
    "&b;",
    "xmlns:a='b' ",
    "\0",
    "\u{FEFF}",
    "é",
    "\n",
    "$",
    "$q",
    "$r",
    "$$",
    "nan",
    "inf",
    "1e400",
    "1e308",
    "-1",
    "0",
    "1 2 3",
    "0.1",
    "1e-320",
    "99999999999999999999",
    "<include filename=\"part.xml\"/>\n",
    "<include filename=\"x.xml\"/>\n",
    "<default name=\"q\" value=\"$q$q\"/>\n",
    "<shape type=\"sphere\"/>\n",
    "<shape type=\"csg\">\n",
    "</shape>\n",
    "<bsdf type=\"twosided\">\n",
    "</bsdf>\n",
    "<ref id=\"m\"/>\n",
    "<transform name=\"to_world\">\n",
    "</transform>\n",
    "<rotate x=\"1\" angle=\"90\"/>\n",
    "id=\"m\" ",
    "name=\"radius\" ",
    "type=\"box\" ",
    "value=\"3\" ",
    "<scene version=\"3.0.0\">",
];

/// Lines whose copies have identifiers and names of their own, written as `ID`.
pub const NUMBERED: [&str; 6] = [
    "<default name='ID' value='1'/>",
    "<shape type='disk' id='ID' name='ID'/>",
    "<bsdf type='twosided' id='ID'><bsdf type='diffuse' id='inner_ID'/></bsdf>",
    "<shape type='disk'><ref id='ID'/></shape><bsdf type='plastic' id='ID'/>",
    "<emitter type='spot' id='ID'><float name='ID' value='1'/></emitter>",
    "<sensor type='orthographic' id='ID'/>",
];
