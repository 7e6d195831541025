//! Tests of flaws, reloading and creases of the open mesh.

use crate::harness::{Window, app, click, in_picture, press, wait, write};
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use hitscope::app::App;
use hitscope_core::camera::Turntable;
use hitscope_core::mesh::{Crease, Flaw};

/// The window with an open mesh, and the folder with its file; `None` if the test is skipped.
fn opened(text: &str) -> Option<(Window, tempfile::TempDir)> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = write(&folder, "mesh.obj", text);
    let mut window = app(Some(file))?;
    wait(&mut window, "the file", |app| {
        app.document().name() == "mesh.obj"
    });
    Some((window, folder))
}

/// A square and a face with an invalid index.
const FLAWED: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\nf 1 2 9\n";

#[test]
fn flaws_are_marked_and_listed_and_a_bad_face_gives_a_warning() {
    let Some((mut window, _folder)) = opened(FLAWED) else {
        return;
    };
    let notice = window.state().notice().expect("a warning").to_owned();
    assert!(notice.contains("line 7: 1 face dropped"), "{notice}");
    window.get_by_label("Mesh").click();
    // The tab appears in one of the next frames; the check begins in that one.
    let is_checking = (0..3).any(|_| {
        window.step();
        window.query_by_label("Checking…").is_some()
    });
    assert!(is_checking);
    wait(&mut window, "the check of the mesh", |app| {
        app.document().known_findings().is_some()
    });
    window.run_steps(3);
    window.get_by_label("Open edges  4").click();
    let require_shown = |window: &mut Window, index: usize| {
        window.run_steps(3);
        wait(window, "the flaw", |app| {
            let place = app.flaw();
            place.is_some_and(|place| (place.flaw, place.index) == (Flaw::OpenEdge, index))
        });
        window.run_steps(2);
    };
    require_shown(&mut window, 0);
    // Each edge is a side of the square and of a face on one of two lines.
    let point = window.state().flaw().expect("a flaw").point.truncate();
    assert_eq!((point - 0.5).abs().max_element(), 0.5);
    window.get_by_label("1 of 4");
    let has_line = |line: usize| window.query_by_label(&format!("line {line}")).is_some();
    assert!(has_line(5) || has_line(6));
    for (button, index) in [("Next", 1), ("Previous", 0), ("Previous", 3)] {
        window.get_by_label(button).click();
        require_shown(&mut window, index);
    }
    window.get_by_label("Open edges  4").click();
    window.run_steps(3);
    assert!(window.state().flaw().is_none());
    // The button of a kind without flaws is disabled.
    assert!(
        window
            .get_by_label("Slivers  0")
            .accesskit_node()
            .is_disabled()
    );
}

#[test]
fn reloading_a_watched_file_keeps_the_camera_and_the_pick() {
    let Some((mut window, folder)) = opened(FLAWED) else {
        return;
    };
    let at = in_picture(&window, 0.5, 0.5);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    window.key_press_modifiers(Modifiers::COMMAND, Key::R);
    window.run_steps(3);
    assert!(window.state().preferences().watches);
    let before = *window.state().turntable();
    let raised = FLAWED.replace(" 0\n", " 0.25\n");
    write(&folder, "mesh.obj", &raised);
    wait(&mut window, "the new file", |app| {
        app.document().loaded.scene.bounds().min.z == 0.25
    });
    wait(&mut window, "the pick in it", |app| {
        let hit = app
            .inspection()
            .and_then(|inspection| inspection.hit.as_ref());
        hit.is_some_and(|hit| hit.position[2] == 0.25)
    });
    let after = *window.state().turntable();
    let of = |t: Turntable| (t.pivot, t.distance, t.yaw_radians, t.pitch_radians);
    assert_eq!(of(after), of(before));
}

/// A mesh far away is stored relative to an origin that depends on its bounds.
#[test]
fn the_camera_keeps_its_place_in_the_file_when_the_origin_moves() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = |x: u32| format!("v 500000 0 0\nv {x} 0 0\nv 500000 1 0\nf 1 2 3\n");
    let file = write(&folder, "mesh.obj", &text(500_001));
    let Some(mut window) = app(Some(file)) else {
        return;
    };
    let origin = |app: &App| app.document().loaded.scene.mesh().origin();
    wait(&mut window, "the file", |app| origin(app).x > 0.0);
    let at = in_picture(&window, 0.5, 0.5);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    let in_file = |app: &App| app.turntable().pivot + origin(app);
    let (before, pivot) = (origin(window.state()), in_file(window.state()));
    let ray = |app: &App| app.inspection().map(|inspection| inspection.ray.origin);
    let eye = ray(window.state()).expect("a ray");
    write(&folder, "mesh.obj", &text(500_019));
    press(&mut window, Key::F5);
    wait(&mut window, "the new file", |app| origin(app) != before);
    assert_eq!(in_file(window.state()), pivot);
    wait(&mut window, "the pick in it", |app| ray(app).is_some());
    let eye_again = ray(window.state()).expect("a ray");
    let moved = (0..3).map(|axis| (eye[axis] - eye_again[axis]).abs());
    // The ray's origin is an f32 relative to the mesh's origin, some 20 units away.
    assert!(moved.fold(0.0, f64::max) < 1e-5, "{eye:?}, {eye_again:?}");
}

#[test]
fn the_crease_angle_changes_the_scene_and_keeps_its_tree() {
    let Some((mut window, _folder)) = opened(FLAWED) else {
        return;
    };
    let tree = window.state().document().loaded.scene.groups()[0].bvh();
    window.get_by_label("Crease above").click();
    wait(&mut window, "another crease", |app| {
        let scene = &app.document().loaded.scene;
        scene.crease() == Crease::Above(30f32.to_radians())
    });
    wait(&mut window, "the picture", App::is_settled);
    let scene = &window.state().document().loaded.scene;
    assert!(std::sync::Arc::ptr_eq(&tree, &scene.groups()[0].bvh()));
}
