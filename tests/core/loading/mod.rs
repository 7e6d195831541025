//! Scene files become scenes: shapes, transforms, meshes, materials, sensors, and clear errors.

mod limits;
mod solids;
mod textures;
mod transforms;

use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::kernel::{Tier, exact_triangle_kernel};
use hitscope_core::loading::LoadedScene;
use hitscope_core::obj::{LoadError, LoadOptions};
use hitscope_core::progress::Progress;
use hitscope_core::scene::SceneOptions;
use std::path::PathBuf;
use tempfile::TempDir;

/// A folder with a scene file of these contents, and a mesh.
struct Files {
    folder: TempDir,
}

impl Files {
    fn new(contents: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let xml = format!("<scene version=\"3.0.0\">\n{contents}\n</scene>\n");
        std::fs::write(folder.path().join("scene.xml"), xml).expect("written");
        let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        std::fs::write(folder.path().join("mesh.obj"), obj).expect("written");
        Self { folder }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("scene.xml")
    }

    fn load(&self) -> Result<LoadedScene, LoadError> {
        let (load_options, options) = (LoadOptions::default(), SceneOptions::default());
        LoadedScene::load(&self.path(), load_options, options, &Progress::default())
    }
}

fn loaded(contents: &str) -> LoadedScene {
    Files::new(contents).load().expect("a scene")
}

/// The shapes that a ray crosses, with t, in the file's coordinates.
fn crossings(scene: &LoadedScene, origin: [f32; 3], dir: [f32; 3]) -> Vec<(&'static str, f32)> {
    let scene = &scene.scene;
    let from_origin = Vec3::from(origin).as_dvec3() - scene.mesh().origin();
    let ray = Ray::new(from_origin.as_vec3(), dir.into()).expect("a ray");
    let crossings = scene.intersector(exact_triangle_kernel()).all_hits(&ray);
    let shape = |primitive: u32| scene.group_of(primitive).0.shape().name;
    let found = crossings.iter().map(|c| (shape(c.hit.primitive), c.hit.t));
    found.collect()
}

#[test]
fn every_shape_is_hit_where_its_parameters_say() {
    let scene = loaded(
        r#"<shape type="sphere"><point name="center" x="0" y="0" z="0"/><float name="radius" value="2"/></shape>
           <shape type="cylinder"><point name="p0" x="10" y="0" z="-1"/><point name="p1" x="10" y="0" z="1"/></shape>
           <shape type="disk"><transform name="to_world"><translate x="20"/></transform></shape>
           <shape type="rectangle"><transform name="to_world"><translate x="30"/></transform></shape>
           <shape type="cube"><transform name="to_world"><translate x="40"/></transform></shape>
           <shape type="cone"><point name="p0" x="50" y="0" z="0"/><point name="p1" x="50" y="0" z="4"/></shape>
           <shape type="torus"><point name="center" x="60" y="0" z="0"/></shape>
           <shape type="quadric"><float name="a" value="1"/><float name="b" value="1"/><float name="c" value="1"/>
             <float name="j" value="-0.25"/><transform name="to_world"><translate x="70"/></transform></shape>
           <shape type="plane"><point name="point" x="0" y="0" z="-50"/></shape>
           <shape type="obj"><string name="filename" value="mesh.obj"/>
             <transform name="to_world"><translate x="80" z="3"/></transform></shape>"#,
    );
    let below = |x: f32, y: f32| crossings(&scene, [x, y, 10.0], [0.0, 0.0, -1.0]);
    let plane = ("axis-aligned plane", 60.0);
    assert_eq!(below(0.0, 0.0), [("sphere", 8.0), ("sphere", 12.0), plane]);
    // Beside the axis of the open cylinder there is nothing, and its side is met from the side.
    assert_eq!(below(10.5, 0.0), [plane]);
    let side = crossings(&scene, [10.0, 5.0, 0.0], [0.0, -1.0, 0.0]);
    assert_eq!(side, [("cylinder", 4.0), ("cylinder", 6.0)]);
    assert_eq!(below(20.5, 0.5), [("disk", 10.0), plane]);
    assert_eq!(below(20.8, 0.8), [plane]);
    assert_eq!(below(30.8, 0.8), [("rectangle", 10.0), plane]);
    assert_eq!(
        below(40.5, 0.5),
        [("axis-aligned box", 9.0), ("axis-aligned box", 11.0), plane]
    );
    assert_eq!(below(50.5, 0.0), [("cone", 8.0), plane]);
    assert_eq!(below(61.0, 0.0), [("torus", 9.75), ("torus", 10.25), plane]);
    assert_eq!(below(60.0, 0.0), [plane]);
    assert_eq!(
        below(70.0, 0.0),
        [("quadric", 9.5), ("quadric", 10.5), plane]
    );
    assert_eq!(below(80.25, 0.25), [("triangle", 7.0), plane]);
    assert_eq!(scene.scene.groups().len(), 10);
    assert_eq!(scene.scene.primitive_count(), 10);
}

#[test]
fn transforms_change_a_shape_or_its_kind() {
    let scene = loaded(
        r#"<shape type="sphere"><transform name="to_world">
             <rotate y="1" angle="33"/><scale value="3"/><translate x="1"/></transform></shape>
           <shape type="sphere"><transform name="to_world">
             <scale x="1" y="2" z="4"/><translate x="20"/></transform></shape>
           <shape type="cylinder"><boolean name="capped" value="true"/><transform name="to_world">
             <scale x="2" y="2" z="5"/><translate x="40"/></transform></shape>"#,
    );
    let below = |x: f32| crossings(&scene, [x, 0.0, 10.0], [0.0, 0.0, -1.0]);
    assert_eq!(below(1.0), [("sphere", 7.0), ("sphere", 13.0)]);
    // A sphere scaled unequally is a quadric.
    assert_eq!(below(20.0), [("quadric", 6.0), ("quadric", 14.0)]);
    // A cylinder scaled along its axis stays one.
    assert_eq!(below(41.0), [("cylinder", 5.0), ("cylinder", 10.0)]);
    let along_y = crossings(&scene, [20.0, 10.0, 0.0], [0.0, -1.0, 0.0]);
    assert_eq!(along_y, [("quadric", 8.0), ("quadric", 12.0)]);
}

#[test]
fn a_transform_without_a_shape_is_refused_with_the_line() {
    for (contents, line, message) in [
        (
            "<shape type=\"cylinder\">\n<transform name=\"to_world\"><scale x=\"2\"/></transform></shape>",
            2,
            "elliptic",
        ),
        (
            "\n<shape type=\"torus\"><transform name=\"to_world\"><scale x=\"2\"/></transform></shape>",
            3,
            "unequally",
        ),
        (
            "<shape type=\"sphere\"><transform name=\"to_world\"><scale x=\"0\"/></transform></shape>",
            2,
            "singular",
        ),
    ] {
        let files = Files::new(contents);
        match files.load().err() {
            Some(LoadError::Line {
                path,
                line: found,
                message: text,
                ..
            }) => {
                assert_eq!((path, found), (files.path(), line), "{text}");
                assert!(text.contains(message), "{text}");
            }
            other => panic!("{contents}: {other:?}"),
        }
    }
}

#[test]
fn a_missing_mesh_is_an_error_that_names_it() {
    let files =
        Files::new(r#"<shape type="obj"><string name="filename" value="gone.obj"/></shape>"#);
    let error = files.load().expect_err("no such file").to_string();
    assert!(error.contains("gone.obj"), "{error}");
}

#[test]
fn materials_and_the_view_of_the_sensor_are_kept() {
    let scene = loaded(
        r#"<bsdf type="diffuse" id="red"><rgb name="reflectance" value="0.5, 0.25, 0"/></bsdf>
           <shape type="sphere"><ref id="red"/></shape>
           <shape type="sphere"><transform name="to_world"><translate x="5"/></transform></shape>
           <shape type="obj"><string name="filename" value="mesh.obj"/><ref id="red"/></shape>
           <sensor type="perspective"><float name="fov" value="90"/><transform name="to_world">
             <lookat origin="0, 0, 9" target="0, 0, 0" up="0, 1, 0"/></transform>
             <film type="hdrfilm"><integer name="width" value="200"/><integer name="height" value="100"/></film>
           </sensor>"#,
    );
    let materials = &scene.scene.mesh().attributes().materials;
    let diffuse = |primitive: u32| {
        let material = materials.get(scene.scene.material(primitive));
        material.and_then(|material| material.diffuse)
    };
    let red = Some(Vec3::new(0.5, 0.25, 0.0));
    let default = Some(Vec3::splat(0.5));
    assert_eq!([diffuse(0), diffuse(1), diffuse(2)], [red, red, default]);
    let view = scene.view.expect("a sensor");
    assert_eq!(view.eye.to_array(), [0.0, 0.0, 9.0]);
    assert!((view.forward + glam::DVec3::Z).length() < 1e-12);
    // 90° along the width, which is twice the height.
    let tangent = (0.5 * view.fov_y_radians.expect("a perspective")).tan();
    assert!((tangent - 0.5).abs() < 1e-12, "{tangent}");
}

#[test]
fn a_scene_far_from_the_origin_is_stored_relative_to_one_nearby() {
    let scene = loaded(
        r#"<shape type="sphere"><transform name="to_world"><translate x="1e7"/></transform></shape>
           <shape type="obj"><string name="filename" value="mesh.obj"/>
             <transform name="to_world"><translate x="1e7" z="5"/></transform></shape>"#,
    );
    assert!((scene.scene.mesh().origin().x - 1e7).abs() < 10.0);
    assert!(scene.scene.bounds().max.abs().max_element() < 20.0);
    let found = crossings(&scene, [1e7, 0.0, 10.0], [0.0, 0.0, -1.0]);
    assert_eq!(found[1..], [("sphere", 9.0), ("sphere", 11.0)]);
}

#[test]
fn boxes_and_planes_are_axis_aligned_as_long_as_transforms_keep_them_so() {
    let shape = |kind: &str, transform: &str| {
        format!(
            r#"<shape type="{kind}"><transform name="to_world">{transform}</transform></shape>"#
        )
    };
    let name_of = |contents: &str| {
        let scene = loaded(contents).scene;
        scene.group_of(0).0.shape().name
    };
    for (transform, is_aligned) in [
        (r#"<translate x="3"/>"#, true),
        (r#"<scale x="1" y="-2" z="3"/>"#, true),
        (r#"<rotate y="1" angle="30"/>"#, false),
        (r#"<matrix value="0 1 0 0 1 0 0 0 0 0 1 0 0 0 0 1"/>"#, true),
    ] {
        let name = |kind: &str| name_of(&shape(kind, transform));
        let expected = if is_aligned {
            ("axis-aligned box", "axis-aligned plane")
        } else {
            ("box", "plane")
        };
        assert_eq!((name("cube"), name("plane")), expected, "{transform}");
    }
}

#[test]
fn the_four_descriptions_of_a_plane_give_the_same_one() {
    for description in [
        r#"<point name="point" x="0" y="0" z="2"/><vector name="normal" x="0" y="0" z="3"/>"#,
        r#"<point name="point" x="5" y="0" z="2"/><vector name="v" x="1" y="0" z="0"/><vector name="w" x="1" y="1" z="0"/>"#,
        r#"<point name="p0" x="0" y="0" z="2"/><point name="p1" x="1" y="0" z="2"/><point name="p2" x="0" y="1" z="2"/>"#,
        r#"<float name="c" value="2"/><float name="d" value="-4"/>"#,
    ] {
        let scene = loaded(&format!(r#"<shape type="plane">{description}</shape>"#));
        let found = crossings(&scene, [0.5, 0.5, 3.0], [0.0, 0.0, -2.0]);
        assert_eq!(found, [("axis-aligned plane", 0.5)], "{description}");
    }
    for (wrong, expected) in [
        (
            r#"<point name="p1" value="2 2 0"/><point name="p2" value="1 1 0"/>"#,
            "collinear",
        ),
        (
            r#"<vector name="v" value="1 0 0"/><vector name="w" value="2 0 0"/>"#,
            "parallel",
        ),
        (
            r#"<float name="d" value="1"/>"#,
            "“a”, “b” and “c” are zero",
        ),
    ] {
        let error = Files::new(&format!(r#"<shape type="plane">{wrong}</shape>"#)).load();
        let error = error.expect_err("refused").to_string();
        assert!(error.contains(expected), "{error}");
    }
}

#[test]
fn planes_alone_make_a_scene() {
    let scene = loaded(r#"<shape type="plane"/>"#);
    let found = crossings(&scene, [0.5, 0.5, 3.0], [0.0, 0.0, -2.0]);
    assert_eq!(found, [("axis-aligned plane", 1.5)]);
    for tier in [Tier::Fast, Tier::Watertight, Tier::Precise, Tier::Exact] {
        let plane =
            <hitscope_core::shape::Plane as hitscope_core::kernel::KernelTable>::kernel_of(tier);
        let ray = Ray::new(Vec3::new(9.0, 9.0, 3.0), Vec3::NEG_Z).expect("a ray");
        let hit = scene.scene.intersector(plane).closest_hit(&ray);
        assert_eq!(hit.map(|hit| hit.t), Some(3.0), "{tier:?}");
    }
}

#[test]
fn solids_are_combined_and_what_is_no_solid_is_refused_with_its_line() {
    let csg = |operation: &str, second: &str| {
        format!(
            r#"<shape type="csg"><string name="operation" value="{operation}"/>
               <transform name="to_world"><translate x="10"/></transform>
               <shape type="cube"/>
               {second}</shape>"#
        )
    };
    let ball = r#"<shape type="sphere"><float name="radius" value="0.5"/><transform name="to_world"><translate z="1"/></transform></shape>"#;
    let scene = loaded(&csg("difference", ball));
    let down = |x: f32| crossings(&scene, [x, 0.0, 5.0], [0.0, 0.0, -1.0]);
    assert_eq!(down(10.0), [("solid", 4.5), ("solid", 6.0)]);
    assert_eq!(down(10.75), [("solid", 4.0), ("solid", 6.0)]);
    for (second, expected) in [
        (r#"<shape type="disk"/>"#, "a disk isn't a solid"),
        (
            r#"<shape type="cylinder"/>"#,
            "an open cylinder isn't a solid: set “capped” to true",
        ),
        (
            r#"<shape type="obj"><string name="filename" value="mesh.obj"/></shape>"#,
            "a mesh can't be part of a csg",
        ),
    ] {
        let error = Files::new(&csg("union", second)).load();
        let error = error.expect_err("refused").to_string();
        assert!(
            error.ends_with(&format!("scene.xml:5: {expected}")),
            "{error}"
        );
    }
}
