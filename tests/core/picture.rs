//! Pictures for other programs: what is written is read back.

use exr::prelude::{FlatSamples, MetaData, ReadChannels, ReadLayers, Text, read};
use glam::{DVec3, UVec2, Vec2, Vec3};
use hitscope_core::camera::{Camera, Projection};
use hitscope_core::integrator::{Context, Lighting, ViewOptions, integrator};
use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::light::Lights;
use hitscope_core::mesh::shapes::soup;
use hitscope_core::mesh::{Assigned, Attributes, Material, Runs};
use hitscope_core::picture::{
    Alpha, NO_PRIMITIVE, PictureError, TraceError, VisibleSurfaces, guides, write_depth, write_exr,
    write_ids,
};
use hitscope_core::plan::Plan;
use hitscope_core::progress::Progress;
use hitscope_core::render::{Job, render};
use hitscope_core::scene::{Shading, scene};
use hitscope_core::{Film, Intersector};
use std::collections::HashMap;
use std::io::Cursor;
use std::sync::Arc;

const SIZE: UVec2 = UVec2::new(40, 30);
const ALBEDO: Vec3 = Vec3::new(0.5, 0.25, 0.125);

/// Two triangles of a square of side 2 at the origin, seen from 4 units above.
fn square() -> Context {
    let [a, b, c, d] =
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0));
    let material = Material {
        name: "clay".to_owned(),
        diffuse: Some(ALBEDO),
        ..Material::default()
    };
    let attributes = Attributes {
        materials: Assigned::new(vec![material], Runs::default()),
        ..Attributes::default()
    };
    let scene = Arc::new(scene(
        soup(&[[a, b, c], [a, c, d]]).with_attributes(attributes),
    ));
    let intersector: Arc<dyn Intersector> = scene.intersector(default_triangle_kernel()).into();
    let projection = Projection::Orthographic { height: 4.0 };
    let eye = DVec3::new(0.0, 0.0, 4.0);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, SIZE);
    Context {
        second: Arc::clone(&intersector),
        scene,
        intersector,
        camera: camera.expect("a camera"),
        shading: Shading::Flat,
        background: Vec3::new(0.1, 0.2, 0.3),
        lighting: Lighting::default(),
        options: ViewOptions::default(),
    }
}

/// The channels of a file by their names.
fn channels(bytes: Vec<u8>) -> HashMap<String, FlatSamples> {
    let reader = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes();
    let image = reader.from_buffered(Cursor::new(bytes)).expect("a picture");
    assert_eq!(image.layer_data.size.0, SIZE.x as usize);
    let channels = image.layer_data.channel_data.list.into_iter();
    channels
        .map(|channel| (channel.name.to_string(), channel.sample_data))
        .collect()
}

fn floats(channels: &HashMap<String, FlatSamples>, name: &str) -> Vec<f32> {
    match &channels[name] {
        FlatSamples::F32(values) => values.clone(),
        other => panic!("{name} is {other:?}"),
    }
}

fn integers(channels: &HashMap<String, FlatSamples>, name: &str) -> Vec<u32> {
    match &channels[name] {
        FlatSamples::U32(values) => values.clone(),
        other => panic!("{name} is {other:?}"),
    }
}

fn index(x: u32, y: u32) -> usize {
    (y * SIZE.x + x) as usize
}

#[test]
fn a_transparent_background_has_no_colour_and_edges_have_the_part_that_is_covered() {
    for view in ["shaded", "path"] {
        let plan = Plan::new(SIZE, 1, 16);
        let opaque = square();
        let mut context = square();
        context.background = Vec3::ZERO;
        context.options.has_transparent_background = true;
        let lights = Lights::or_white(&context.scene, Vec::new());
        context.lighting.lights = Arc::new(lights);
        let (camera, intersector) = (context.camera, Arc::clone(&context.intersector));
        let progress = Progress::default();
        let alpha = Alpha::trace(&camera, &*intersector, &plan, 2, &progress).expect("traced");
        let integrator = integrator(view).expect("a view");
        let job = Job {
            context,
            integrator,
            plan: plan.clone(),
        };
        let film = render(job, 2).expect("no panic");
        let (mut outside, mut edge, mut inside) = (0, 0, 0);
        let shown = alpha.shown(&film);
        for y in 0..SIZE.y {
            for x in 0..SIZE.x {
                let (pixel, a) = (UVec2::new(x, y), alpha.pixels()[index(x, y)]);
                let hits = (0..16).filter(|&sample| {
                    let ray = camera.ray(pixel, Plan::position(pixel, sample));
                    opaque.intersector.closest_hit(&ray).is_some()
                });
                assert_eq!(a, hits.count() as f32 / 16.0, "{pixel}");
                let colour = film.radiance(pixel).expect("a sample");
                let [.., alpha_byte] = shown[index(x, y)];
                assert_eq!(alpha_byte, (255.0 * a).round() as u8);
                match a {
                    0.0 => {
                        outside += 1;
                        assert_eq!((colour, shown[index(x, y)]), (Vec3::ZERO, [0; 4]));
                    }
                    1.0 => inside += 1,
                    _ => edge += 1,
                }
            }
        }
        assert!(
            outside > 100 && edge > 10 && inside > 50,
            "{outside} {edge} {inside}"
        );
        // The straight colour of an edge is that of the inside: the light is the same everywhere.
        if view == "shaded" {
            let middle = shown[index(SIZE.x / 2, SIZE.y / 2)];
            for (pixel, a) in shown.iter().zip(alpha.pixels()).filter(|(_, a)| **a > 0.0) {
                let differs = (0..3).any(|k| pixel[k].abs_diff(middle[k]) > 1);
                assert!(!differs, "{pixel:?} {middle:?} {a}");
            }
        }
        let mut bytes = Cursor::new(Vec::new());
        write_exr(&film, None, Some(&alpha), &mut bytes).expect("written");
        assert_eq!(floats(&channels(bytes.into_inner()), "A"), alpha.pixels());
    }
}

#[test]
fn an_exr_file_has_the_film_and_its_guides() {
    let (context, plan) = (square(), Plan::new(SIZE, 1, 4));
    let guides = guides(&context, &plan, 2, &Progress::default()).expect("guides");
    let job = Job {
        context,
        integrator: integrator("shaded").expect("a view"),
        plan,
    };
    let film = render(job, 2).expect("no panic");
    let mut bytes = Cursor::new(Vec::new());
    write_exr(&film, Some(&guides), None, &mut bytes).expect("written");
    let channels = channels(bytes.into_inner());
    let mut names: Vec<&str> = channels.keys().map(String::as_str).collect();
    names.sort_unstable();
    let expected = [
        "B",
        "G",
        "R",
        "Z",
        "albedo.B",
        "albedo.G",
        "albedo.R",
        "id",
        "normal.X",
        "normal.Y",
        "normal.Z",
        "sampleCount",
        "variance",
    ];
    assert_eq!(names, expected);
    let colours = ["R", "G", "B"].map(|name| floats(&channels, name));
    let albedo = ["albedo.R", "albedo.G", "albedo.B"].map(|name| floats(&channels, name));
    let normal = ["normal.X", "normal.Y", "normal.Z"].map(|name| floats(&channels, name));
    let at = |planes: &[Vec<f32>; 3], k: usize| Vec3::from_array([0, 1, 2].map(|a| planes[a][k]));
    let (variance, counts) = (
        floats(&channels, "variance"),
        integers(&channels, "sampleCount"),
    );
    for (x, y) in (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y))) {
        let (pixel, k) = (UVec2::new(x, y), index(x, y));
        assert_eq!(Some(at(&colours, k)), film.radiance(pixel));
        assert_eq!(counts[k], 4);
        let error = film.standard_error(pixel).expect("four samples");
        assert_eq!(variance[k], (error * error) as f32);
    }
    // Left above the middle is the second triangle, right below it the first. A corner of the picture is empty.
    let (depth, ids) = (floats(&channels, "Z"), integers(&channels, "id"));
    for (pixel, id) in [(index(15, 10), 1), (index(24, 19), 0)] {
        assert_eq!(ids[pixel], id);
        assert_eq!(at(&albedo, pixel), ALBEDO);
        assert_eq!(at(&normal, pixel), Vec3::Z);
        // Rounding of the eye, the direction and t.
        assert!((depth[pixel] - 4.0).abs() < 1e-5);
    }
    let corner = index(0, 0);
    assert_eq!(ids[corner], NO_PRIMITIVE);
    assert_eq!(depth[corner], f32::INFINITY);
    assert_eq!(at(&albedo, corner), Vec3::ZERO);
    assert_eq!(at(&normal, corner), Vec3::ZERO);
}

#[test]
fn guides_are_means_over_the_samples_and_the_same_on_any_number_of_threads() {
    let (context, progress) = (square(), Progress::default());
    let plan = Plan::new(SIZE, 4, 64);
    let one = guides(&context, &plan, 1, &progress).expect("guides");
    let many = guides(&context, &plan, 5, &progress).expect("guides");
    assert!(one == many);
    // The square ends in the middle of the pixels at x = 12.5 of 40: 4 units are 30 pixels high.
    let borders = [12, 27].map(|x| one.pixels()[index(x, 15)]);
    for border in borders {
        assert!((0.3..0.7).contains(&border.normal.z), "{border:?}");
        assert!((border.albedo - border.normal.z * ALBEDO).length() < 1e-6);
        assert!((border.depth - 4.0).abs() < 1e-5);
    }
}

#[test]
fn a_film_without_guides_or_samples_is_written() {
    let film = Film::new(Plan::new(SIZE, 1, 1), Vec3::ONE);
    let mut bytes = Cursor::new(Vec::new());
    write_exr(&film, None, None, &mut bytes).expect("written");
    let channels = channels(bytes.into_inner());
    assert_eq!(channels.len(), 5);
    assert!(floats(&channels, "G").iter().all(|&x| x == 0.0));
    assert!(integers(&channels, "sampleCount").iter().all(|&n| n == 0));
}

#[test]
fn guides_of_another_size_and_cancelled_ones_are_errors() {
    let progress = Progress::default();
    let context = square();
    let other = guides(&context, &Plan::new(SIZE, 1, 1), 1, &progress).expect("guides");
    let film = Film::new(Plan::new(UVec2::ONE, 1, 1), Vec3::ONE);
    let error = write_exr(&film, Some(&other), None, Cursor::new(Vec::new()));
    assert!(matches!(error, Err(PictureError::Size { .. })));
    progress.cancel();
    let cancelled = guides(&context, &Plan::new(SIZE, 1, 1), 1, &progress);
    assert!(matches!(cancelled, Err(TraceError::Cancelled)));
}

#[test]
fn distances_and_numbers_of_surfaces_are_written_with_names() {
    let mut context = square();
    // From aside, so that t and z differ.
    let projection = Projection::Perspective { fov_y_radians: 1.0 };
    let eye = DVec3::new(0.5, 0.25, 4.0);
    let camera = Camera::look_at(eye, DVec3::new(0.5, 0.25, 0.0), DVec3::Y, projection, SIZE);
    context.camera = camera.expect("a camera");
    let progress = Progress::default();
    let surfaces = VisibleSurfaces::trace(&context, 2, &progress).expect("traced");
    let alone = VisibleSurfaces::trace(&context, 1, &progress).expect("traced");
    assert_eq!(surfaces, alone);
    let mut bytes = Cursor::new(Vec::new());
    write_depth(&surfaces, &mut bytes).expect("written");
    let distances = channels(bytes.into_inner());
    assert_eq!(distances.len(), 2);
    let (t, z) = (floats(&distances, "t"), floats(&distances, "Z"));
    let mut bytes = Cursor::new(Vec::new());
    let names = context.scene.mesh().attributes();
    write_ids(&surfaces, names, &mut bytes).expect("written");
    let bytes = bytes.into_inner();
    let ids = channels(bytes.clone());
    assert_eq!(ids.len(), 3);
    let [primitives, groups, materials] =
        ["primitive", "group", "material"].map(|name| integers(&ids, name));
    let mut hit_count = 0;
    for (x, y) in (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y))) {
        let k = index(x, y);
        let ray = context.camera.ray(UVec2::new(x, y), Vec2::splat(0.5));
        let Some(hit) = context.intersector.closest_hit(&ray) else {
            assert_eq!([t[k], z[k]], [f32::INFINITY; 2]);
            assert_eq!([primitives[k], groups[k], materials[k]], [NO_PRIMITIVE; 3]);
            continue;
        };
        hit_count += 1;
        assert_eq!(t[k], hit.t);
        // Rounding of t.
        assert!((z[k] - 4.0).abs() < 1e-5, "{}", z[k]);
        assert_eq!(
            [primitives[k], groups[k], materials[k]],
            [hit.primitive, 0, 0]
        );
    }
    assert!((100..SIZE.element_product()).contains(&hit_count));
    assert_eq!(text_attribute(bytes, "materials"), "clay");
}

/// A text in the header of a file's first part.
fn text_attribute(bytes: Vec<u8>, name: &str) -> String {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).expect("a header");
    let attributes = &meta.headers[0].own_attributes.other;
    let value = attributes.get(&Text::from(name)).expect("the attribute");
    value.clone().into_text().expect("a text").to_string()
}
