//! Saved scenes: loaded again they have the same contents, and the sensor shows what the camera showed.

use glam::{DVec2, DVec3, UVec2};
use hitscope_core::Camera;
use hitscope_core::camera::Projection;
use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::loading::{LoadedScene, StartView, scene_text};
use hitscope_core::obj::LoadOptions;
use hitscope_core::progress::Progress;
use hitscope_core::scene::SceneOptions;
use std::path::Path;

fn load(path: &Path) -> LoadedScene {
    let (load_options, options) = (LoadOptions::default(), SceneOptions::default());
    LoadedScene::load(path, load_options, options, &Progress::default()).expect("a scene")
}

fn camera(scene: &LoadedScene, eye: DVec3, projection: Projection) -> Camera {
    let origin = scene.scene.mesh().origin();
    let centre = scene.scene.bounds().centre().as_dvec3();
    let up = DVec3::new(0.1, 1.0, 0.2);
    Camera::look_at(eye - origin, centre, up, projection, UVec2::new(40, 30)).expect("a camera")
}

fn camera_of(scene: &LoadedScene) -> Camera {
    let view = scene.view.expect("a sensor");
    let eye = view.eye - scene.scene.mesh().origin();
    let target = eye + view.forward;
    Camera::look_at(
        eye,
        target,
        view.up,
        view.projection_in(view.size),
        view.size,
    )
    .expect("a camera")
}

/// What the ray of each pixel hits.
fn picture(scene: &LoadedScene, camera: &Camera) -> Vec<Option<u32>> {
    let intersector = scene.scene.intersector(default_triangle_kernel());
    let UVec2 { x, y } = camera.resolution();
    let pixels = (0..y).flat_map(|y| (0..x).map(move |x| DVec2::new(x.into(), y.into())));
    let hit = |pixel: DVec2| intersector.closest_hit(&camera.ray_through(pixel + 0.5));
    pixels.map(|pixel| Some(hit(pixel)?.primitive)).collect()
}

/// Saves what was loaded from a file to another folder, loads it again and compares.
fn is_the_same_again(path: &Path, eye: DVec3) {
    let scene = load(path);
    let elsewhere = tempfile::tempdir().expect("a folder");
    for projection in [
        Projection::Perspective { fov_y_radians: 0.6 },
        Projection::Orthographic { height: 3.0 },
    ] {
        let camera = camera(&scene, eye, projection);
        let view = StartView::of_camera(&camera, scene.scene.mesh().origin());
        let text = scene_text(&scene, path, &view, elsewhere.path()).expect("text");
        let saved = elsewhere.path().join("saved.xml");
        std::fs::write(&saved, text).expect("written");
        let again = load(&saved);
        let camera_again = camera_of(&again);
        for (a, b) in [
            (camera_again.right(), camera.right()),
            (camera_again.up(), camera.up()),
            (camera_again.back(), camera.back()),
            (camera_again.exact_eye(), camera.exact_eye()),
        ] {
            // A few roundings of numbers around 1, and of the origin.
            assert!((a - b).length() < 1e-14 * (1.0 + eye.length()), "{a} {b}");
        }
        let picture_before = picture(&scene, &camera);
        assert!(picture_before.iter().flatten().count() > 20);
        assert_eq!(picture(&again, &camera_again), picture_before);
    }
}

#[test]
fn an_obj_file_becomes_a_scene_with_the_camera() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, at) in [("near.obj", 0.0), ("far.obj", 4e6)] {
        let path = folder.path().join(name);
        let [a, b] = [at - 1.0, at + 1.0];
        let text = format!("v {a} -1 0\nv {b} -1 0\nv {b} 1 0.5\nv {a} 1 0\nf 1 2 3\nf 1 3 4\n");
        std::fs::write(&path, text).expect("written");
        is_the_same_again(&path, DVec3::new(at + 1.0, 2.0, 5.0));
    }
}

#[test]
fn a_scene_file_keeps_its_contents_and_its_files_are_found_from_another_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = "v -3 -1 0\nv -2 -1 0\nv -2 1 0\nf 1 2 3\n";
    std::fs::write(folder.path().join("mesh.obj"), mesh).expect("written");
    // White above and black below.
    let mut sky = b"#?RADIANCE\n\n-Y 2 +X 1\n".to_vec();
    sky.extend([128, 128, 128, 129, 0, 0, 0, 0]);
    std::fs::write(folder.path().join("sky.hdr"), sky).expect("written");
    let path = folder.path().join("scene.xml");
    let text = r#"<scene version="3.0.0">
        <sensor type="perspective" id="first"><sampler type="independent"><integer name="sample_count" value="32"/></sampler></sensor>
        <sensor type="orthographic" id="second"/>
        <emitter type="envmap"><string name="filename" value="sky.hdr"/></emitter>
        <shape type="obj"><string name="filename" value="mesh.obj"/></shape>
        <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.1, 0.1"/></bsdf></shape>
        <shape type="cube"><transform name="to_world"><rotate y="1" angle="30"/><translate x="2"/></transform></shape>
    </scene>"#;
    std::fs::write(&path, text).expect("written");
    is_the_same_again(&path, DVec3::new(1.0, 2.0, 6.0));

    // The view replaces the first sensor only.
    let scene = load(&path);
    let eye = DVec3::new(0.0, 0.0, 9.0);
    let camera = camera(&scene, eye, Projection::Perspective { fov_y_radians: 1.0 });
    let view = StartView::of_camera(&camera, DVec3::ZERO);
    let text = scene_text(&scene, &path, &view, folder.path()).expect("text");
    assert!(text.contains(r#"value="mesh.obj""#), "relative: {text}");
    let saved = folder.path().join("saved.xml");
    std::fs::write(&saved, text).expect("written");
    let again = load(&saved).description.expect("a scene file");
    let sensors: Vec<_> = again
        .sensors
        .iter()
        .map(|sensor| sensor.id.as_deref())
        .collect();
    assert_eq!(sensors, [Some("first"), Some("second")]);
    assert_eq!(again.sensors[0].sample_count, 32);
    let xml = std::fs::read_to_string(&saved).expect("written");
    assert!(xml.contains(r#"value="sky.hdr""#), "relative: {xml}");
    let elsewhere = scene_text(&scene, &path, &view, Path::new("/other"));
    let sky = folder.path().join("sky.hdr");
    let elsewhere = elsewhere.expect("text");
    assert!(
        elsewhere.contains(sky.to_str().expect("UTF-8")),
        "{elsewhere}"
    );
}
