//! Every element and parameter that is read, and its default.

use super::{parse, parse_bytes, scene, warnings};
use glam::{DMat4, DVec2, DVec3};
use hitscope_core::bsdf::Slot;
use hitscope_core::mesh::{Filter, Wrap};
use hitscope_core::scene_file::{
    Bsdf, Checkerboard, Cone, Csg, CsgOperation, Cube, Cuboid, Cylinder, Disk, Obj, Place, Plane,
    Rectangle, ReliefKind, SceneFile, ShapeKind, Side, Sphere, TextureKind, Torus,
};
use std::path::PathBuf;

pub(super) fn read(contents: &str) -> SceneFile {
    parse(&scene(contents)).unwrap_or_else(|error| panic!("{error}"))
}

fn kind(contents: &str) -> ShapeKind {
    let scene = read(contents);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    scene.shapes[0].kind.clone()
}

const fn at(line: u32) -> Place {
    Place { file: 0, line }
}

#[test]
fn shapes_have_mitsubas_defaults() {
    for (name, expected) in [
        (
            "sphere",
            ShapeKind::Sphere(Sphere {
                center: DVec3::ZERO,
                radius: 1.0,
            }),
        ),
        (
            "cylinder",
            ShapeKind::Cylinder(Cylinder {
                p0: DVec3::ZERO,
                p1: DVec3::Z,
                radius: 1.0,
                is_capped: false,
            }),
        ),
        ("disk", ShapeKind::Disk(Disk)),
        ("rectangle", ShapeKind::Rectangle(Rectangle)),
        ("cube", ShapeKind::Cube(Cube)),
    ] {
        let scene = read(&format!("<shape type='{name}'/>"));
        let shape = &scene.shapes[0];
        assert_eq!(shape.kind, expected);
        assert_eq!(shape.to_world, DMat4::IDENTITY);
        assert_eq!((shape.flip_normals, shape.material), (false, None));
        assert_eq!((&shape.id, &shape.name, shape.place), (&None, &None, at(2)));
        assert!(shape.emitter.is_none());
    }
}

#[test]
fn shapes_of_our_own_have_defaults() {
    let (zero, z) = (DVec3::ZERO, DVec3::Z);
    let (min, max) = (DVec3::NEG_ONE, DVec3::ONE);
    for (name, expected) in [
        (
            "plane",
            ShapeKind::Plane(Plane {
                point: zero,
                normal: z,
            }),
        ),
        ("box", ShapeKind::Cuboid(Cuboid { min, max })),
        (
            "cone",
            ShapeKind::Cone(Cone {
                p0: zero,
                p1: z,
                radius: 1.0,
                is_capped: false,
            }),
        ),
        (
            "torus",
            ShapeKind::Torus(Torus {
                center: zero,
                axis: z,
                major: 1.0,
                minor: 0.25,
            }),
        ),
    ] {
        assert_eq!(kind(&format!("<shape type='{name}'/>")), expected);
    }
}

#[test]
fn parameters_of_shapes_are_read() {
    let cylinder = kind(
        "<shape type='cylinder'><point name='p0' value='1,2,3'/><vector name='p1' x='4' y='5' z='6'/>
         <integer name='radius' value='2'/><boolean name='capped' value='true'/></shape>",
    );
    let expected = ShapeKind::Cylinder(Cylinder {
        p0: DVec3::new(1.0, 2.0, 3.0),
        p1: DVec3::new(4.0, 5.0, 6.0),
        radius: 2.0,
        is_capped: true,
    });
    assert_eq!(cylinder, expected);
    let torus = kind(
        "<shape type='torus'><point name='center' value='1 2 3'/><vector name='axis' value='0,2,0'/>
         <float name='major' value='3.5'/><float name='minor' value='1e-1'/></shape>",
    );
    let expected = ShapeKind::Torus(Torus {
        center: DVec3::new(1.0, 2.0, 3.0),
        axis: DVec3::new(0.0, 2.0, 0.0),
        major: 3.5,
        minor: 0.1,
    });
    assert_eq!(torus, expected);
    let quadric = kind(
        "<shape type='quadric'><float name='a' value='1'/><float name='d' value='2'/>
         <float name='j' value='-1'/><point name='min' value='-2'/><point name='max' value='3'/></shape>",
    );
    let ShapeKind::Quadric(quadric) = quadric else {
        panic!("{quadric:?}");
    };
    let coefficients = [1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0];
    assert_eq!(*quadric.coefficients, coefficients);
    assert_eq!(
        (quadric.min, quadric.max),
        (DVec3::splat(-2.0), DVec3::splat(3.0))
    );
    let obj = kind(
        "<shape type='obj'><string name='filename' value=' sub/a b.obj '/>
         <boolean name='face_normals' value='True'/></shape>",
    );
    let expected = ShapeKind::Obj(Obj {
        file: PathBuf::from("sub/a b.obj"),
        face_normals: true,
        flip_tex_coords: true,
    });
    assert_eq!(obj, expected);
}

#[test]
fn solids_are_nested_in_csg() {
    let scene = read(
        "<shape type='csg' id='c' name='n'>
         <string name='operation' value='difference'/>
         <shape type='cube'><bsdf type='diffuse'/></shape>
         <shape type='csg'><string name='operation' value='union'/>
         <shape type='sphere'><boolean name='flip_normals' value='true'/></shape><shape type='disk'/>
         </shape>
         <transform name='to_world'><scale value='2'/></transform>
         </shape>",
    );
    let shape = &scene.shapes[0];
    assert_eq!(
        (shape.id.as_deref(), shape.name.as_deref()),
        (Some("c"), Some("n"))
    );
    assert_eq!(shape.to_world, DMat4::from_scale(DVec3::splat(2.0)));
    let ShapeKind::Csg(Csg {
        operation,
        children,
    }) = &shape.kind
    else {
        panic!("{shape:?}");
    };
    assert_eq!((*operation, children.len()), (CsgOperation::Difference, 2));
    assert_eq!(
        (&children[0].kind, children[0].material),
        (&ShapeKind::Cube(Cube), Some(0))
    );
    let ShapeKind::Csg(Csg {
        operation,
        children,
    }) = &children[1].kind
    else {
        panic!("{children:?}");
    };
    assert_eq!((*operation, children.len()), (CsgOperation::Union, 2));
    assert!(children[0].flip_normals && !children[1].flip_normals);
    assert_eq!(children[0].place, at(6));
}

#[test]
fn what_has_no_effect_in_a_nested_shape_gives_a_warning() {
    let solid = |own: &str, nested: &str| {
        let scene = read(&format!(
            "<bsdf type='diffuse' id='a'/><bsdf type='diffuse' id='b'/>
             <shape type='csg'><string name='operation' value='union'/>{own}
             <shape type='cube'/>
             <shape type='sphere'>{nested}</shape></shape>"
        ));
        warnings(&scene)
    };
    let (a, b) = ("<ref id='a'/>", "<ref id='b'/>");
    let flipped = "<boolean name='flip_normals' value='true'/>";
    for (own, nested, expected) in [
        ("", "", None),
        (a, "", None),
        (a, a, None),
        (flipped, "", None),
        (a, b, Some("the bsdf")),
        ("", a, Some("the bsdf")),
        (flipped, flipped, Some("flip_normals")),
    ] {
        let expected = expected.map(|what| {
            format!("line 5: {what} of a shape in a csg isn't used: the csg's own applies")
        });
        let found = solid(own, nested);
        assert_eq!(found, Vec::from_iter(expected), "{own} {nested}");
    }
}

#[test]
fn materials_are_found_before_and_after_their_definition() {
    let scene = read(
        "<shape type='disk'><ref id='late'/></shape>
         <bsdf type='diffuse' id='early'><rgb name='reflectance' value='0.1, 0.2 0.3'/></bsdf>
         <shape type='disk'><ref name='bsdf' id='early'/></shape>
         <shape type='disk'><bsdf type='diffuse'><spectrum name='reflectance' value='0.25'/></bsdf></shape>
         <bsdf type='twosided' id='late'><bsdf type='diffuse'><float name='reflectance' value='1'/></bsdf></bsdf>
         <shape type='disk'><bsdf type='twosided'><bsdf type='diffuse'/><ref id='early'/></bsdf></shape>
         <shape type='disk'><bsdf type='diffuse' id='inner'/></shape>
         <shape type='disk'><ref id='inner'/></shape>",
    );
    assert_eq!(warnings(&scene), [""; 0]);
    let materials = scene.materials.iter();
    let materials: Vec<_> = materials
        .map(|m| (m.id.as_deref(), m.front.clone(), m.back.clone()))
        .collect();
    let (half, early) = (DVec3::splat(0.5), DVec3::new(0.1, 0.2, 0.3));
    let of = |reflectance| Side::from(Bsdf::Diffuse { reflectance });
    let expected = [
        (Some("late"), of(DVec3::ONE), Some(of(DVec3::ONE))),
        (Some("early"), of(early), None),
        (Some("inner"), of(half), None),
        (None, of(DVec3::splat(0.25)), None),
        (None, of(half), Some(of(early))),
    ];
    assert_eq!(materials, expected);
    let used: Vec<_> = scene.shapes.iter().map(|shape| shape.material).collect();
    assert_eq!(used, [0, 1, 3, 4, 2, 2].map(Some));
}

#[test]
fn other_bsdfs_and_textures_are_replaced_with_a_warning() {
    let scene = read(
        "<bsdf type='principled' id='a'><float name='roughness' value='0.1'/></bsdf>
         <texture type='volume' id='t'/>
         <shape type='disk'><bsdf type='diffuse'><ref name='reflectance' id='t'/></bsdf></shape>
         <shape type='disk'><bsdf type='conductor'><texture name='eta' type='checkerboard'/></bsdf></shape>
         <bsdf type='diffuse'/>
         <shape type='disk'><medium type='homogeneous'/><ref id='a'/></shape>
         words",
    );
    assert_eq!(
        (&scene.materials[0].front, &scene.materials[0].back),
        (&Bsdf::GREY.into(), &Some(Bsdf::GREY.into()))
    );
    let expected = [
        "line 2: bsdf “principled” isn't supported; a diffuse reflectance of 0.5 is used; the most similar one that is supported is “roughplastic”",
        "line 3: texture “volume” isn't supported",
        "line 4: bsdf “diffuse”: the texture of “reflectance” isn't supported; the default is used",
        "line 5: bsdf “conductor”: a texture for “eta” isn't supported; the default is used",
        "line 6: bsdf “diffuse” in scene without id isn't used",
        "line 7: medium “homogeneous” in shape “disk” isn't used",
        "line 8: text “words” isn't used",
    ];
    assert_eq!(warnings(&scene), expected);
}

#[test]
fn textures_replace_parameters_and_reliefs_wrap_both_sides() {
    let scene = read(
        "<texture type='bitmap' id='t'><string name='filename' value='t.png'/><boolean name='raw' value='true'/>
           <string name='filter_type' value='nearest'/><string name='wrap_mode' value='mirror'/>
           <transform name='to_uv'><scale x='2' y='3'/><translate x='0.5'/></transform></texture>
         <shape type='disk'><bsdf type='mask'><ref name='opacity' id='t'/><bsdf type='twosided'>
           <bsdf type='roughconductor'><ref name='alpha' id='t'/></bsdf>
           <bsdf type='plastic'><texture type='checkerboard' name='diffuse_reflectance'>
             <rgb name='color0' value='0.1 0.2 0.3'/></texture></bsdf></bsdf></bsdf></shape>
         <shape type='disk'><bsdf type='bumpmap'><float name='scale' value='2'/><ref id='t'/>
           <bsdf type='twosided'><bsdf type='diffuse'/></bsdf></bsdf></shape>
         <shape type='disk'><bsdf type='normalmap'><ref name='normalmap' id='t'/>
           <boolean name='use_shadowing_function' value='false'/><bsdf type='diffuse'/></bsdf></shape>",
    );
    let warning = "line 12: bsdf “normalmap”: “use_shadowing_function” is always true here";
    assert_eq!(warnings(&scene), [warning]);
    let [masked, bumpy, normal] = &scene.materials[..] else {
        panic!("three materials");
    };
    let bitmap = masked.opacity_texture.as_ref().expect("a texture");
    let TextureKind::Bitmap(picture) = &bitmap.kind else {
        panic!("a picture");
    };
    assert!(picture.is_raw && picture.file.ends_with("t.png"));
    assert_eq!(
        (picture.filter, picture.wrap),
        (Filter::Nearest, Wrap::Mirror)
    );
    assert_eq!(
        bitmap.to_uv.transform_point2(DVec2::ONE),
        DVec2::new(2.5, 3.0)
    );
    assert_eq!(masked.opacity, 1.0);
    assert_eq!(masked.front.texture(Slot::Roughness), Some(bitmap));
    let back = masked.back.as_ref().expect("a back");
    let board = Checkerboard {
        colours: [DVec3::new(0.1, 0.2, 0.3), DVec3::splat(0.2)],
    };
    let kind = back.texture(Slot::Diffuse).map(|texture| &texture.kind);
    assert_eq!(kind, Some(&TextureKind::Checkerboard(board)));
    for (side, kind) in [
        (Some(&bumpy.front), ReliefKind::Heights { scale: 2.0 }),
        (bumpy.back.as_ref(), ReliefKind::Heights { scale: 2.0 }),
        (Some(&normal.front), ReliefKind::Normals),
    ] {
        let relief = side
            .and_then(|side| side.relief.as_ref())
            .expect("a relief");
        assert_eq!((relief.kind, &relief.texture), (kind, bitmap));
    }
    assert_eq!(normal.back, None);
}

#[test]
fn defaults_are_inserted_into_any_attribute() {
    let scene = read(
        "<default name='kind' value='sphere'/><default name='kind' value='disk'/>
         <default name='r' value='2'/><default name='twice' value='$r, $r'/>
         <shape type='$kind' id='s$r'><float name='radius' value='$r.5'/>
         <transform name='to_world'><translate value='$twice 1'/></transform></shape>",
    );
    let shape = &scene.shapes[0];
    let expected = ShapeKind::Sphere(Sphere {
        center: DVec3::ZERO,
        radius: 2.5,
    });
    assert_eq!((&shape.kind, shape.id.as_deref()), (&expected, Some("s2")));
    assert_eq!(
        shape.to_world,
        DMat4::from_translation(DVec3::new(2.0, 2.0, 1.0))
    );
}

#[test]
fn a_rotation_axis_that_is_not_a_unit_vector_gives_a_warning() {
    let rotated = |axis: &str| {
        read(&format!(
            "<shape type='disk'><transform name='to_world'><rotate {axis} angle='9'/></transform></shape>"
        ))
    };
    let expected = [
        "line 2: the rotation axis has length 1.4142, not 1: Mitsuba then also scales, and so does this",
    ];
    assert_eq!(warnings(&rotated("x='1' y='1'")), expected);
    assert_eq!(warnings(&rotated("value='0.7071 0.7071 0'")), [""; 0]);
}

#[test]
fn utf_16_with_a_byte_order_mark_is_read() {
    let text = format!("\u{FEFF}{}", scene("<shape type='disk' id='é'/>"));
    let bytes: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let scene = parse_bytes(&bytes, 1 << 20).expect("good");
    assert_eq!(scene.shapes[0].id.as_deref(), Some("é"));
}
