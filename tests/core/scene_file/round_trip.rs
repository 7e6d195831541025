//! What is written reads back to the same description.

use super::{parse, parse_files, scene};
use glam::{DMat4, DVec3};
use hitscope_core::scene_file::{
    self, Emitter, EmitterKind, Material, Obj, Place, Plugin, SceneFile, Shape, ShapeKind,
};
use std::path::{Path, PathBuf};

/// Everything that a scene can contain.
const ALL: &str = r##"
<integrator type="aov"><integer name="max_depth" value="-1"/><string name="s" value="a &amp; &lt;b&gt; &quot;c&quot;&#10;d"/></integrator>
<sensor type="perspective" id="p"><float name="fov" value="33.3"/><string name="fov_axis" value="larger"/>
  <transform name="to_world"><lookat origin="1,2,3" target="4,5,7" up="0,1,0"/></transform></sensor>
<sensor type="perspective"/>
<sensor type="orthographic"><transform name="to_world"><scale value="0.1"/></transform>
  <film type="hdrfilm"><integer name="width" value="7"/><integer name="height" value="9"/>
  <integer name="crop_offset_x" value="1"/><integer name="crop_offset_y" value="2"/>
  <integer name="crop_width" value="3"/><integer name="crop_height" value="4"/></film>
  <sampler type="independent"><integer name="sample_count" value="64"/></sampler></sensor>
<sensor type="thinlens"><float name="aperture_radius" value="0.3"/></sensor>
<emitter type="envmap" id="e"><string name="filename" value="a.exr"/><float name="scale" value="0.1"/>
  <transform name="to_world"><rotate x="1" angle="33"/></transform></emitter>
<emitter type="point" name="n"><point name="position" value="1 2 3"/><float name="intensity" value="0.1"/></emitter>
<emitter type="point"><transform name="to_world"><translate x="0.1"/></transform></emitter>
<emitter type="directional"><vector name="direction" value="0.1 0.2 -0.3"/><spectrum name="irradiance" value="1e-9"/></emitter>
<emitter type="spot" name="n"><point name="position" value="1 2 3"/><vector name="v" value="1e300"/>
  <boolean name="b" value="true"/><spectrum name="i" value="1e-300"/><texture type="bitmap"><ref id="q"/><ref name="r" id="q"/></texture></emitter>
<shape type="obj" id="o" name="m"><string name="filename" value="sub/mesh's.obj"/><ref id="late"/></shape>
<shape type="obj"><string name="filename" value="/abs/a.obj"/><boolean name="flip_tex_coords" value="false"/></shape>
<bsdf type="twosided" id="early"><bsdf type="diffuse"/><bsdf type="diffuse"><rgb name="reflectance" value="0.1 0.2 0.3"/></bsdf></bsdf>
<shape type="sphere"><point name="center" value="0.1 0.2 0.3"/><float name="radius" value="1e-9"/><ref id="early"/></shape>
<shape type="cylinder"><boolean name="capped" value="true"/><bsdf type="diffuse"><rgb name="reflectance" value="0.7"/></bsdf></shape>
<shape type="cylinder"><point name="p0" value="5"/></shape>
<shape type="disk"><boolean name="flip_normals" value="true"/><ref id="early"/></shape>
<shape type="rectangle"><transform name="to_world"><rotate value="0.6 0.8 0" angle="17"/><translate x="0.1"/></transform>
  <emitter type="area"><rgb name="radiance" value="1 2 3"/></emitter></shape>
<shape type="cube"><bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>
<texture type="bitmap" id="wood"><string name="filename" value="sub/wood.png"/><boolean name="raw" value="true"/>
  <string name="filter_type" value="nearest"/><string name="wrap_mode" value="clamp"/>
  <transform name="to_uv"><rotate z="1" angle="33"/><scale x="2" y="3"/><translate x="0.1" y="0.7"/></transform></texture>
<bsdf type="normalmap" id="wooden"><ref name="normalmap" id="wood"/><bsdf type="roughplastic">
  <texture name="diffuse_reflectance" type="checkerboard"><rgb name="color1" value="0.1 0.2 0.3"/></texture>
  <ref name="specular_reflectance" id="wood"/></bsdf></bsdf>
<shape type="cube"><ref id="wooden"/></shape>
<shape type="cube"><emitter type="area"><ref name="radiance" id="wood"/></emitter></shape>
<shape type="cube"><bsdf type="twosided"><bsdf type="bumpmap"><float name="scale" value="-0.3"/><ref id="wood"/><bsdf type="diffuse"/></bsdf>
  <bsdf type="roughconductor"><ref name="alpha" id="wood"/></bsdf></bsdf></shape>
<shape type="cube"><bsdf type="mask"><ref name="opacity" id="wood"/><bsdf type="mask"><float name="opacity" value="0.3"/>
  <bsdf type="dielectric"><ref name="specular_transmittance" id="wood"/></bsdf></bsdf></bsdf></shape>
<shape type="cube"><bsdf type="twosided"><bsdf type="conductor"><string name="material" value="Au"/></bsdf><bsdf type="plastic"/></bsdf></shape>
<shape type="cube"><bsdf type="roughconductor"><rgb name="eta" value="0.1 1 2"/><float name="k" value="3"/><string name="distribution" value="ggx"/>
  <float name="alpha" value="0.3"/><rgb name="specular_reflectance" value="0.9"/></bsdf></shape>
<shape type="cube"><bsdf type="dielectric"><string name="int_ior" value="diamond"/><rgb name="specular_transmittance" value="0.1 1 1"/></bsdf></shape>
<shape type="cube"><bsdf type="thindielectric"/></shape><shape type="cube"><bsdf type="roughdielectric"><float name="int_ior" value="1.7"/></bsdf></shape>
<shape type="cube"><bsdf type="mask" id="half"><bsdf type="roughplastic"><boolean name="nonlinear" value="true"/></bsdf></bsdf></shape>
<shape type="cube"><bsdf type="mask"><float name="opacity" value="0.1"/><bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf></shape>
<shape type="plane"><point name="point" value="1"/><vector name="normal" value="1 1 0"/></shape>
<shape type="box"><point name="max" value="2"/></shape>
<shape type="cone"><boolean name="capped" value="true"/></shape>
<shape type="torus"><float name="major" value="3"/></shape>
<shape type="quadric"><float name="a" value="1"/><float name="i" value="-0.3333333333333333"/><point name="min" value="-9"/></shape>
<shape type="csg"><string name="operation" value="intersection"/>
  <shape type="sphere"><bsdf type="diffuse"/></shape>
  <shape type="csg"><string name="operation" value="difference"/><shape type="cube"/><shape type="box"><ref id="late"/></shape></shape>
</shape>
<bsdf type="diffuse" id="late"><rgb name="reflectance" value="0 0.5 1"/></bsdf>
"##;

/// A description without places, files and warnings.
fn without_places(mut scene: SceneFile) -> SceneFile {
    fn of_plugin(plugin: &mut Plugin) {
        plugin.place = Place::default();
        plugin
            .parameters
            .iter_mut()
            .for_each(|p| p.place = Place::default());
        plugin.children.iter_mut().for_each(of_plugin);
    }
    fn of_emitter(emitter: &mut Emitter) {
        emitter.place = Place::default();
        if let EmitterKind::Area {
            texture: Some(texture),
            ..
        } = &mut emitter.kind
        {
            texture.place = Place::default();
        }
        if let EmitterKind::Other(plugin) = &mut emitter.kind {
            of_plugin(plugin);
        }
    }
    fn of_shape(shape: &mut Shape) {
        shape.place = Place::default();
        shape
            .emitter
            .iter_mut()
            .for_each(|emitter| of_emitter(emitter));
        if let ShapeKind::Csg(csg) = &mut shape.kind {
            csg.children.iter_mut().for_each(of_shape);
        }
    }
    fn of_material(material: &mut Material) {
        material.place = Place::default();
        for side in std::iter::once(&mut material.front).chain(&mut material.back) {
            let relief = side.relief.iter_mut().map(|relief| &mut relief.texture);
            let textures = side.textures.iter_mut().map(|(_, texture)| texture);
            textures
                .chain(relief)
                .for_each(|texture| texture.place = Place::default());
        }
        let opacity = material.opacity_texture.iter_mut();
        opacity.for_each(|texture| texture.place = Place::default());
    }
    scene.shapes.iter_mut().for_each(of_shape);
    scene.materials.iter_mut().for_each(of_material);
    scene
        .sensors
        .iter_mut()
        .for_each(|s| s.place = Place::default());
    scene.emitters.iter_mut().for_each(of_emitter);
    let integrator = scene.integrator.iter_mut();
    integrator.for_each(|integrator| of_plugin(&mut integrator.plugin));
    scene.files.clear();
    scene.warnings.clear();
    scene
}

#[test]
fn everything_reads_back() {
    let read = parse(&scene(ALL)).unwrap_or_else(|error| panic!("{error}"));
    let text = scene_file::to_xml(&read, Path::new("")).expect("written");
    let again = parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(without_places(again.clone()), without_places(read));
    // Written again, the text is the same.
    assert_eq!(
        scene_file::to_xml(&again, Path::new("")).as_deref(),
        Ok(&*text)
    );
}

#[test]
fn a_mesh_and_a_camera_are_written_as_a_scene() {
    let sensor = "<sensor type='perspective'><float name='fov' value='40'/></sensor>";
    let mut described = parse(&scene(sensor)).expect("good");
    described.shapes.push(Shape {
        place: Place::default(),
        id: None,
        name: None,
        kind: ShapeKind::Obj(Obj {
            file: PathBuf::from("scenes/mesh.obj"),
            face_normals: false,
            flip_tex_coords: true,
        }),
        to_world: DMat4::from_translation(DVec3::X),
        flip_normals: false,
        material: None,
        emitter: None,
    });
    let text = scene_file::to_xml(&described, Path::new("scenes")).expect("written");
    let expected = r#"<scene version="3.0.0">
    <sensor type="perspective">
        <float name="fov" value="40"/>
        <string name="fov_axis" value="x"/>
        <film type="hdrfilm">
            <integer name="width" value="768"/>
            <integer name="height" value="576"/>
            <rfilter type="box"/>
        </film>
        <sampler type="independent">
            <integer name="sample_count" value="4"/>
        </sampler>
    </sensor>
    <shape type="obj">
        <string name="filename" value="mesh.obj"/>
        <boolean name="face_normals" value="false"/>
        <boolean name="flip_tex_coords" value="true"/>
        <transform name="to_world">
            <matrix value="1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1"/>
        </transform>
    </shape>
</scene>
"#;
    assert_eq!(text, expected);
    let again = parse_files(&[("scenes/x.xml", &text)]).expect("good");
    assert_eq!(without_places(again), without_places(described));
}

#[test]
fn materials_that_several_shapes_share_get_an_identifier() {
    let shape = "<shape type='disk' id='material-1'><bsdf type='diffuse'/></shape>";
    let mut described = parse(&scene(shape)).expect("good");
    let mut second = described.shapes[0].clone();
    second.id = None;
    described.shapes.push(second);
    let text = scene_file::to_xml(&described, Path::new("")).expect("written");
    let again = parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(again.materials.len(), 1);
    assert_eq!(again.materials[0].id.as_deref(), Some("material-2"));
    assert!(again.shapes.iter().all(|shape| shape.material == Some(0)));
}

#[test]
fn names_without_a_form_are_refused() {
    let described = |id: &str, file: &str| {
        let text = "<shape type='obj' id='a'><string name='filename' value='b'/></shape>";
        let mut described = parse(&scene(text)).expect("good");
        let shape = &mut described.shapes[0];
        shape.id = Some(id.to_owned());
        let ShapeKind::Obj(obj) = &mut shape.kind else {
            panic!("{shape:?}");
        };
        obj.file = PathBuf::from(file);
        described
    };
    for (id, file, expected) in [
        ("a", "b.obj", None),
        (" a", "b.obj", None),
        (
            "a$b",
            "b.obj",
            Some("“a$b” can't be written to a scene file: “$” starts the name of a parameter"),
        ),
        (
            "a",
            "b.obj ",
            Some("“b.obj ” can't be written to a scene file: spaces at its ends are ignored"),
        ),
    ] {
        let written = scene_file::to_xml(&described(id, file), Path::new(""));
        let error = written.err().map(|error| error.to_string());
        assert_eq!(error.as_deref(), expected);
    }
}
