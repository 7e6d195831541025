//! Planes under single lights have the radiance ρ·E/π.

use super::lit;
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::integrator::{Context, integrator};
use hitscope_core::light::{Environment, Light, Lights, studio};
use hitscope_core::loading::LoadedScene;
use hitscope_core::mesh::shapes::soup;
use hitscope_core::mesh::{Assigned, Attributes, Material, Runs};
use hitscope_core::obj::LoadOptions;
use hitscope_core::progress::Progress;
use hitscope_core::sampler::Sampler;
use hitscope_core::scene::{SceneOptions, scene};
use std::f64::consts::PI;
use std::sync::Arc;

/// Positions, directions, cosines, squared distance, weight and reflectance take fewer than 32 roundings to f32, each of
/// at most 2⁻²⁴.
const RELATIVE_ERROR: f64 = 32.0 / (1u64 << 24) as f64;

/// Scales and offsets, in which the picture must be the same.
const SIZES: [f64; 3] = [1e-12, 1.0, 1e12];
const OFFSET: DVec3 = DVec3::new(1e6, -2e6, 0.5e6);

pub(super) fn loaded(contents: &str) -> LoadedScene {
    let mesh = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
    loaded_with("square.obj", mesh, contents)
}

/// A scene file beside a mesh and the picture `sky.hdr`.
pub(super) fn loaded_with(name: &str, mesh: &str, contents: &str) -> LoadedScene {
    let folder = tempfile::tempdir().expect("a folder");
    // White above and black below.
    let mut sky = b"#?RADIANCE\n\n-Y 2 +X 1\n".to_vec();
    sky.extend([128, 128, 128, 129, 0, 0, 0, 0]);
    std::fs::write(folder.path().join("sky.hdr"), sky).expect("written");
    let path = folder.path().join("scene.xml");
    std::fs::write(folder.path().join(name), mesh).expect("written");
    let text = format!("<scene version=\"3.0.0\">\n{contents}\n</scene>");
    std::fs::write(&path, text).expect("written");
    let (load_options, options) = (LoadOptions::default(), SceneOptions::default());
    let loaded = LoadedScene::load(&path, load_options, options, &Progress::default());
    loaded.unwrap_or_else(|error| panic!("{error}"))
}

/// The radiance of one sample in a view; `None` for a miss.
pub(super) fn radiance(context: &Context, view: &str, ray: &Ray) -> Option<DVec3> {
    let hit = context.intersector.closest_hit(ray)?;
    let mut sampler = Sampler::new(glam::UVec2::ZERO, 0);
    let view = integrator(view).expect("a view");
    let radiance = view.radiance(context, ray, Some(hit), &mut sampler);
    Some(radiance.as_dvec3())
}

/// A square of half size `size` at a distance of [`OFFSET`] sizes, with reflectance 0.5, and the point seen on it.
fn square((kind, parameter): (&str, &str), size: f64, others: &str) -> (Context, DVec3) {
    let centre = size * OFFSET;
    let DVec3 { x, y, z } = centre;
    let loaded = loaded(&format!(
        r#"<shape type="{kind}">{parameter}<transform name="to_world"><scale value="{size:e}"/>
             <translate x="{x:e}" y="{y:e}" z="{z:e}"/></transform>
             <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>
           {others}"#
    ));
    let point = centre + size * DVec3::new(0.25, -0.5, 0.0) - loaded.scene.mesh().origin();
    let scene = Arc::into_inner(loaded.scene).expect("no other owner");
    (lit(scene, loaded.lights), point)
}

/// The square as a rectangle and as a mesh: the type and a parameter.
const KINDS: [(&str, &str); 2] = [
    ("rectangle", ""),
    ("obj", r#"<string name="filename" value="square.obj"/>"#),
];

fn require_near(found: DVec3, expected: DVec3, what: &str) {
    let error = (found - expected).abs() / expected.max(DVec3::splat(f64::MIN_POSITIVE));
    assert!(
        error.max_element() <= RELATIVE_ERROR,
        "{what}: {found}, expected {expected}"
    );
}

#[test]
fn a_plane_under_a_point_light_reflects_what_its_distance_and_angle_say() {
    for kind in KINDS {
        for size in SIZES {
            let above = DVec3::new(1.0, 0.5, 2.0);
            let DVec3 { x, y, z } = size * (OFFSET + above);
            // Twice the size means four times the intensity for the same picture.
            let intensity = DVec3::new(1.0, 2.0, 3.0) * size * size;
            let [r, g, b] = intensity.to_array();
            let light = format!(
                r#"<emitter type="point"><point name="position" x="{x:e}" y="{y:e}" z="{z:e}"/>
                     <rgb name="intensity" value="{r:e} {g:e} {b:e}"/></emitter>"#
            );
            let (context, point) = square(kind, size, &light);
            let eye = point + size * DVec3::new(0.5, 0.0, 1.0);
            let ray = Ray::new(eye.as_vec3(), (point - eye).as_vec3()).expect("a ray");
            let way = above - DVec3::new(0.25, -0.5, 0.0);
            let irradiance = way.z / way.length().powi(3) * DVec3::new(1.0, 2.0, 3.0);
            for view in ["direct", "whitted", "path"] {
                let found = radiance(&context, view, &ray).expect("a hit");
                require_near(found, 0.5 * irradiance / PI, &format!("{size:e} {view}"));
            }
        }
    }
}

#[test]
fn a_plane_under_a_distant_light_reflects_what_its_angle_says() {
    for kind in KINDS {
        for size in SIZES {
            let light = r#"<emitter type="directional"><vector name="direction" value="-3, 0, -4"/>
                 <rgb name="irradiance" value="1 2 3"/></emitter>"#;
            let (context, point) = square(kind, size, light);
            let eye = point + size * DVec3::new(-0.5, 0.0, 1.0);
            let ray = Ray::new(eye.as_vec3(), (point - eye).as_vec3()).expect("a ray");
            let found = radiance(&context, "direct", &ray).expect("a hit");
            let expected = 0.5 * 0.8 / PI * DVec3::new(1.0, 2.0, 3.0);
            require_near(found, expected, &format!("{size:e}"));
        }
    }
}

#[test]
fn shapes_shine_on_the_side_of_their_normal() {
    let lamp = r#"<emitter type="area"><rgb name="radiance" value="1 2 3"/></emitter>"#;
    let flipped = r#"<boolean name="flip_normals" value="true"/>"#;
    let mirrored = r#"<transform name="to_world"><scale x="-1"/></transform>"#;
    let obj = r#"<string name="filename" value="square.obj"/>"#;
    for (kind, more, shines_up) in [
        ("rectangle", "", true),
        ("rectangle", flipped, false),
        ("rectangle", mirrored, true),
        ("disk", "", true),
        ("disk", flipped, false),
        ("obj", obj, true),
        ("obj", &format!("{obj}{flipped}"), false),
        ("sphere", "", true),
    ] {
        let shape = format!(r#"<shape type="{kind}">{more}{lamp}</shape>"#);
        let loaded = loaded(&shape);
        assert_eq!(loaded.report.warnings, [], "{shape}");
        let scene = Arc::into_inner(loaded.scene).expect("no other owner");
        let context = lit(scene, loaded.lights);
        for up in [true, false] {
            // From inside of the sphere, or below the others.
            let (z, dir) = if up {
                (5.0, Vec3::NEG_Z)
            } else {
                (-0.5, Vec3::Z)
            };
            let ray = Ray::new(Vec3::new(0.25, 0.125, z), dir).expect("a ray");
            let expected = if up == shines_up {
                DVec3::new(1.0, 2.0, 3.0)
            } else {
                DVec3::ZERO
            };
            for view in ["direct", "whitted", "path"] {
                let found = radiance(&context, view, &ray);
                assert_eq!(found, Some(expected), "{shape}, from above: {up}");
            }
        }
    }
}

#[test]
fn the_environment_of_a_scene_file_is_seen() {
    let loaded = loaded(
        r#"<emitter type="constant"><rgb name="radiance" value="1 2 3"/></emitter><shape type="disk"/>"#,
    );
    let [Light::Environment(Environment::Constant(radiance))] = loaded.lights[..] else {
        panic!("{:?}", loaded.lights);
    };
    assert_eq!(radiance, Vec3::new(1.0, 2.0, 3.0));
}

#[test]
fn the_environment_map_of_a_scene_file_is_turned_and_scaled() {
    // The map's y axis becomes z.
    let loaded = loaded(
        r#"<emitter type="envmap"><string name="filename" value="sky.hdr"/><float name="scale" value="2"/>
             <transform name="to_world"><rotate x="1" angle="90"/></transform></emitter><shape type="disk"/>"#,
    );
    let [Light::Environment(environment)] = &loaded.lights[..] else {
        panic!("{:?}", loaded.lights);
    };
    let above = environment.radiance(Vec3::Z);
    assert!((above - 2.0).abs().max_element() < 1e-5, "{above}");
    assert!(environment.radiance(Vec3::NEG_Z).max_element() < 1e-5);
    let names: Vec<_> = loaded
        .report
        .files
        .iter()
        .filter_map(|file| file.file_name())
        .collect();
    assert!(
        names.contains(&"sky.hdr".as_ref()),
        "reloaded with the scene: {names:?}"
    );
}

#[test]
fn only_a_scene_without_any_light_gets_white_light() {
    let lamp = r#"<emitter type="area"/>"#;
    for (shape, expected) in [
        ("rectangle", Some(Vec3::ONE)),
        // The area of an infinite plane can't be sampled.
        ("plane", Some(Vec3::ONE)),
    ] {
        let dark = loaded(&format!(r#"<shape type="{shape}"/>"#));
        let white = Lights::or_white(&dark.scene, dark.lights);
        let radiance = white.environment().map(|light| light.radiance(Vec3::Z));
        assert_eq!(radiance, expected);
        let bright = loaded(&format!(r#"<shape type="{shape}">{lamp}</shape>"#));
        let lights = Lights::or_white(&bright.scene, bright.lights);
        assert!(lights.environment().is_none(), "{shape}");
    }
}

#[test]
fn a_shape_without_a_bsdf_is_grey_from_the_front_and_black_from_behind_as_in_mitsuba() {
    let sky = r#"<emitter type="constant"/>"#;
    for (kind, parameter) in KINDS {
        let seen = |bsdf: &str| {
            let loaded = loaded(&format!(
                r#"<shape type="{kind}">{parameter}{bsdf}</shape>{sky}"#
            ));
            let scene = Arc::into_inner(loaded.scene).expect("no other owner");
            let context = lit(scene, loaded.lights);
            [1.0, -1.0].map(|z| {
                let ray = Ray::new(Vec3::new(0.1, 0.2, z), Vec3::new(0.0, 0.0, -z));
                radiance(&context, "path", &ray.expect("a ray")).expect("a hit")
            })
        };
        let [front, back] = seen("");
        assert!(front.min_element() > 0.0, "{kind}: {front}");
        assert_eq!(back, DVec3::ZERO, "{kind}");
        assert_eq!([front, back], seen(r#"<bsdf type="diffuse"/>"#), "{kind}");
    }
}

#[test]
fn the_studio_lights_an_open_plane_as_the_view_shaded_does() {
    let grey = Material {
        diffuse: Some(Vec3::new(0.2, 0.5, 0.8)),
        ..Material::default()
    };
    let corners = [[
        Vec3::NEG_ONE,
        Vec3::new(3.0, -1.0, 0.0),
        Vec3::new(-1.0, 3.0, 1.0),
    ]];
    let mesh = soup(&corners).with_attributes(Attributes {
        materials: Assigned::new(vec![grey], Runs::default()),
        ..Attributes::default()
    });
    let mut context = lit(scene(mesh), Vec::new());
    let eye = DVec3::new(1.0, -2.0, 5.0);
    let projection = context.camera.projection();
    let size = glam::UVec2::ONE;
    let camera = hitscope_core::Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, size);
    context.camera = camera.expect("a camera");
    context.lighting.lights = Arc::new(Lights::new(&context.scene, studio(&context.camera)));
    let ray = Ray::new(eye.as_vec3(), -eye.as_vec3()).expect("a ray");
    let shaded = radiance(&context, "shaded", &ray).expect("a hit");
    // Each sample is of one of the lamps.
    let n = 1 << 14;
    let view = integrator("direct").expect("a view");
    let hit = context.intersector.closest_hit(&ray);
    let sum: DVec3 = (0..n)
        .map(|k| {
            let mut sampler = Sampler::new(glam::UVec2::new(k, 3), 1);
            view.radiance(&context, &ray, hit, &mut sampler).as_dvec3()
        })
        .sum();
    // The standard error is below the mean over √n, 0.8 %; four of them.
    let error = (sum / f64::from(n) - shaded).abs() / shaded;
    assert!(error.max_element() < 0.032, "{sum} / {n}, {shaded}");
}
