//! The side of normals: `flip_normals`, and transforms that mirror. The expected sides are those of Mitsuba 3.9.1's
//! shading normals.

use glam::{DVec3, Vec3};
use hitscope_core::interaction::SurfaceInteraction;
use hitscope_core::kernel::exact_triangle_kernel;
use hitscope_core::loading::{LoadedScene, StartView, scene_text};
use hitscope_core::obj::LoadOptions;
use hitscope_core::progress::Progress;
use hitscope_core::scene::{SceneOptions, Shading};
use hitscope_core::shape::LineDetail;
use hitscope_core::{Aabb, Hit, Ray};
use tempfile::TempDir;

/// The side of a shape's normal: the outside, or for a flat shape the image of +z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Front,
    Back,
}
use Side::{Back, Front};

impl Side {
    /// The side of a normal that a ray from the front sees.
    fn of(normal: Vec3, ray: &Ray) -> Self {
        if normal.dot(ray.dir) < 0.0 {
            Front
        } else {
            Back
        }
    }

    fn reversed(self) -> Self {
        match self {
            Front => Back,
            Back => Front,
        }
    }
}

/// A folder with a triangle that faces +z, without normals and with them.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (name, faces) in [
        ("bare.obj", "f 1 2 3\n"),
        ("normals.obj", "vn 0 0 1\nf 1//1 2//1 3//1\n"),
    ] {
        let text = format!("{vertices}{faces}");
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    folder
}

fn load(folder: &TempDir, contents: &str) -> LoadedScene {
    let path = folder.path().join("scene.xml");
    let text = format!("<scene version=\"3.0.0\">\n{contents}\n</scene>\n");
    std::fs::write(&path, text).expect("written");
    let (load_options, options) = (LoadOptions::default(), SceneOptions::default());
    LoadedScene::load(&path, load_options, options, &Progress::default()).expect("a scene")
}

fn shape(kind: &str, parameters: &str, scale: DVec3, is_flipped: bool) -> String {
    let [x, y, z] = scale.to_array();
    format!(
        r#"<shape type="{kind}">{parameters}<boolean name="flip_normals" value="{is_flipped}"/>
           <transform name="to_world"><scale x="{x}" y="{y}" z="{z}"/></transform></shape>"#
    )
}

/// Kinds with their parameters, the origin of a ray that meets their front along an axis, the axis, and the side under a
/// mirroring transform.
const CASES: [(&str, &str, [f64; 3], usize, Side); 14] = [
    ("sphere", "", [3.0, 0.1, 0.2], 0, Back),
    ("cylinder", "", [3.0, 0.1, 0.5], 0, Front),
    ("disk", "", [0.1, 0.2, 3.0], 2, Front),
    ("rectangle", "", [0.1, 0.2, 3.0], 2, Front),
    ("cube", "", [0.1, 0.2, 3.0], 2, Front),
    ("cube", "", [3.0, 0.1, 0.2], 0, Front),
    (
        "obj",
        r#"<string name="filename" value="bare.obj"/>"#,
        [0.2, 0.3, 3.0],
        2,
        Back,
    ),
    (
        "obj",
        r#"<string name="filename" value="normals.obj"/>"#,
        [0.2, 0.3, 3.0],
        2,
        Front,
    ),
    (
        "obj",
        r#"<string name="filename" value="normals.obj"/><boolean name="face_normals" value="true"/>"#,
        [0.2, 0.3, 3.0],
        2,
        Back,
    ),
    // Shapes of our own keep their outside.
    ("plane", "", [0.1, 0.2, 3.0], 2, Front),
    ("box", "", [3.0, 0.1, 0.2], 0, Front),
    ("cone", "", [3.0, 0.1, 0.5], 0, Front),
    ("torus", "", [3.0, 0.1, 0.0], 0, Front),
    (
        "csg",
        r#"<string name="operation" value="union"/><shape type="sphere"/><shape type="cube"/>"#,
        [3.0, 0.1, 0.2],
        0,
        Front,
    ),
];

#[test]
fn each_shape_has_the_side_that_mitsuba_gives_it() {
    let folder = folder();
    let mirrors = [
        DVec3::ONE,
        DVec3::new(-1.0, 1.0, 1.0),
        DVec3::new(1.0, -1.0, 1.0),
        DVec3::new(1.0, 1.0, -1.0),
        DVec3::NEG_ONE,
        DVec3::new(-1.0, -1.0, 1.0),
    ];
    for (kind, parameters, origin, axis, mirrored_side) in CASES {
        for scale in mirrors {
            let is_mirroring = scale.element_product() < 0.0;
            let expected = if is_mirroring { mirrored_side } else { Front };
            let mut towards = DVec3::ZERO;
            towards[axis] = -scale[axis];
            let start = (scale * DVec3::from(origin)).as_vec3();
            let ray = Ray::new(start, towards.as_vec3()).expect("a ray");
            let hits = [false, true].map(|is_flipped| {
                let loaded = load(&folder, &shape(kind, parameters, scale, is_flipped));
                let warnings = &loaded.report.warnings;
                let is_told = warnings.iter().any(|w| w.message.contains("flip_normals"));
                assert!(!is_told, "{warnings:?}");
                let scene = &loaded.scene;
                let intersector = scene.intersector(exact_triangle_kernel());
                let hit = intersector.closest_hit(&ray).expect("a hit");
                let surface = SurfaceInteraction::new(scene, &ray, hit, Shading::Smooth);
                let expected = if is_flipped {
                    expected.reversed()
                } else {
                    expected
                };
                let sides = [surface.geometric_normal, surface.shading_normal]
                    .map(|normal| Side::of(normal, &ray));
                let case = format!("{kind} {parameters} {scale} {is_flipped}");
                assert_eq!(sides, [expected; 2], "{case}");
                (hit.t, hit.primitive)
            });
            assert_eq!(hits[0], hits[1], "{kind}: the hit changed");
        }
    }
}

#[test]
fn only_the_flipped_shapes_of_a_group_are_flipped() {
    let sphere = |x: f64, is_flipped: bool| {
        format!(
            r#"<shape type="sphere"><point name="center" x="{x}" y="0" z="0"/>
               <boolean name="flip_normals" value="{is_flipped}"/></shape>"#
        )
    };
    let flipped = [false, true, true, false, true];
    let spheres = flipped.iter().enumerate();
    let contents: String = spheres.map(|(k, &f)| sphere(4.0 * k as f64, f)).collect();
    let scene = load(&folder(), &contents).scene;
    let detail = LineDetail {
        segments: 8,
        around: Aabb::EMPTY,
        view: None,
    };
    for (index, is_flipped) in (0..).zip(flipped) {
        let centre = Vec3::new(4.0 * index as f32, 0.0, 0.0);
        let ray = Ray::new(centre + 3.0 * Vec3::Z, Vec3::NEG_Z).expect("a ray");
        let hit = scene
            .intersector(exact_triangle_kernel())
            .closest_hit(&ray)
            .expect("a hit");
        let z = if is_flipped { -1.0 } else { 1.0 };
        assert!(scene.surface(&ray, &hit).normal.z * z > 0.9);
        let of_one = scene.subset(&[index]);
        let hit = Hit {
            primitive: 0,
            ..hit
        };
        assert!(of_one.surface(&ray, &hit).normal.z * z > 0.9);
        let mut count = 0;
        scene.groups()[0].lines(index, &detail, &mut |points| {
            for point in points {
                let outwards = (point.position - centre.as_dvec3()).dot(point.normal);
                assert!(outwards * z > 0.9, "{index}: {point:?}");
                count += 1;
            }
        });
        assert!(count > 8);
    }
}

#[test]
fn flipped_normals_are_saved() {
    let folder = folder();
    let contents = shape("cone", "", DVec3::ONE, true);
    let loaded = load(&folder, &contents);
    let view = StartView {
        eye: DVec3::Z,
        forward: DVec3::NEG_Z,
        up: DVec3::Y,
        fov_y_radians: Some(1.0),
        height: 0.0,
        size: glam::UVec2::splat(8),
    };
    let path = folder.path();
    let text = scene_text(&loaded, &path.join("scene.xml"), &view, path).expect("text");
    assert!(
        text.contains(r#"<boolean name="flip_normals" value="true"/>"#),
        "{text}"
    );
}
