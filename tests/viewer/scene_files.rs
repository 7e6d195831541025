//! The window with scene files: the sensor's view, crossings of the picked ray, saving, and kernels by shape.

use crate::harness::{Window, app, click, in_picture, press, say, settle, wait};
use egui::{Key, Modifiers};
use egui_kittest::kittest::{By, Queryable as _};
use glam::DVec3;
use hitscope::app::App;
use hitscope::trade::{Trade, TradeState};
use hitscope_core::Camera;
use hitscope_core::camera::{Turntable, UpAxis};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tempfile::TempDir;

/// A sphere in front of a box, and a sensor that looks at them along −z. Its film is narrower than the window's picture.
const SCENE: &str = r#"<scene version="3.0.0">
<sensor type="perspective"><float name="fov" value="30"/><string name="fov_axis" value="y"/>
  <film type="hdrfilm"><integer name="width" value="300"/><integer name="height" value="600"/></film>
  <transform name="to_world"><lookat origin="0,0,10" target="0,0,0" up="0,1,0"/></transform></sensor>
<shape type="sphere"><float name="radius" value="2"/></shape>
<shape type="cube"><transform name="to_world"><translate z="-5"/></transform></shape>
</scene>"#;

/// The window with a file of this name and text, once its picture is complete; `None` if the test is skipped.
fn opened(name: &'static str, text: &str) -> Option<(Window, TempDir)> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("written");
    let mut window = app(Some(path))?;
    settle(&mut window, name);
    Some((window, folder))
}

fn camera(window: &Window) -> Camera {
    let app = window.state();
    app.turntable().camera(app.film().size())
}

fn eye(window: &Window) -> DVec3 {
    camera(window).exact_eye()
}

#[test]
fn the_window_opens_in_the_sensors_view_and_home_returns_to_it() {
    let Some((mut window, _folder)) = opened("scene.xml", SCENE) else {
        return;
    };
    let expected = DVec3::new(0.0, 0.0, 10.0);
    assert!((eye(&window) - expected).length() < 1e-12);
    assert!((camera(&window).back() - DVec3::Z).length() < 1e-12);
    let fov = window.state().turntable().fov_y_radians;
    assert!((fov.to_degrees() - 30.0).abs() < 1e-12, "{fov}");
    press(&mut window, Key::Num3);
    assert!((eye(&window) - expected).length() > 1.0);
    press(&mut window, Key::Home);
    assert!((eye(&window) - expected).length() < 1e-12);
    // In the sensor's view, the key frames the whole scene.
    press(&mut window, Key::Home);
    assert!((eye(&window) - expected).length() > 1.0);
    assert!((camera(&window).back() - DVec3::Z).length() < 1e-12);
}

#[test]
fn the_window_shows_the_whole_film_of_a_sensor_that_is_wider() {
    let text = SCENE.replace(r#"value="300""#, r#"value="2400""#);
    let Some((window, _folder)) = opened("wide.xml", &text) else {
        return;
    };
    let size = window.state().film().size().as_dvec2();
    let half_height = (0.5 * window.state().turntable().fov_y_radians).tan();
    let half_width = half_height * size.x / size.y;
    let of_film = 4.0 * 15_f64.to_radians().tan();
    assert!((half_width - of_film).abs() < 1e-12, "{half_width}");
}

#[test]
fn a_sensor_with_z_up_turns_about_z_without_changing_the_setting() {
    let text = SCENE.replace(
        r#"origin="0,0,10" target="0,0,0" up="0,1,0""#,
        r#"origin="0,-9,3" target="0,0,0" up="0,0,1""#,
    );
    let Some((mut window, folder)) = opened("z.xml", &text) else {
        return;
    };
    let settings = window.state().settings();
    assert_eq!((settings.up_axis(), settings.is_z_up), (UpAxis::Z, false));
    assert!((eye(&window) - DVec3::new(0.0, -9.0, 3.0)).length() < 1e-12);
    assert!(window.state().turntable().roll_radians.abs() < 1e-12);
    let path = folder.path().join("flat.obj");
    std::fs::write(&path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    crate::app::drop_file(&mut window, path);
    settle(&mut window, "flat.obj");
    assert_eq!(window.state().settings().up_axis(), UpAxis::Y);
    let fov = window.state().turntable().fov_y_radians;
    assert_eq!(
        fov,
        Turntable::FOV_Y_RADIANS,
        "the sensor's was for its file"
    );
}

#[test]
fn keys_and_a_slider_step_through_the_crossings_of_the_picked_ray() {
    let Some((mut window, _folder)) = opened("scene.xml", SCENE) else {
        return;
    };
    let middle = in_picture(&window, 0.5, 0.5);
    click(&mut window, middle);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    window.run_steps(2);
    let state = |window: &Window| {
        let app = window.state();
        let point = app.marked_point().expect("a mark");
        (app.crossing().expect("a crossing"), point.z)
    };
    let crossings = &window.state().inspection().expect("picked").crossings;
    let shapes: Vec<_> = crossings.iter().map(|crossing| crossing.shape).collect();
    assert_eq!(
        shapes,
        ["sphere", "sphere", "axis-aligned box", "axis-aligned box"]
    );
    // The picked pixel is within half a pixel of the middle.
    let is_near = |(index, z): (usize, f64), (expected, at): (usize, f64)| {
        assert!(index == expected && (z - at).abs() < 0.02, "{index} {z}");
    };
    is_near(state(&window), (0, 2.0));
    press(&mut window, Key::OpenBracket);
    is_near(state(&window), (0, 2.0));
    for expected in [(1, -2.0), (2, -4.0), (3, -6.0), (3, -6.0)] {
        press(&mut window, Key::CloseBracket);
        is_near(state(&window), expected);
    }
    window.get_by_label("4 of 4");
    window.get_by_label("axis-aligned box 1, back");
    press(&mut window, Key::OpenBracket);
    is_near(state(&window), (2, -4.0));
    // The tooltip appears at the heading: at the slider it would cover the rows that change.
    let tooltip = "The slider moves the mark along the ray";
    window.get_by_role(egui::accesskit::Role::Slider).hover();
    window.run_steps(60);
    assert!(window.query_by_label_contains(tooltip).is_none());
    let heading = By::new()
        .include_labels()
        .role(egui::accesskit::Role::Label)
        .label("Crossings");
    window.get(heading).hover();
    window.run_steps(60);
    assert!(window.query_by_label_contains(tooltip).is_some());
    // Another kernel keeps the crossing; another click doesn't.
    window.run_steps(2);
    click(&mut window, middle);
    wait(&mut window, "the hit", |app| app.crossing() == Some(0));
    window.get_by_label("radius r");
}

/// A cube with a dent in the side that faces the sensor.
const DENTED: &str = r#"<scene version="3.0.0">
<sensor type="perspective"><float name="fov" value="30"/><string name="fov_axis" value="y"/>
  <film type="hdrfilm"><integer name="width" value="300"/><integer name="height" value="600"/></film>
  <transform name="to_world"><lookat origin="0,0,10" target="0,0,0" up="0,1,0"/></transform></sensor>
<shape type="csg"><string name="operation" value="difference"/><shape type="cube"/>
  <shape type="sphere"><point name="center" x="0" y="0" z="1"/><float name="radius" value="0.5"/></shape></shape>
</scene>"#;

#[test]
fn a_picked_solid_shows_the_operand_that_is_hit_and_the_tree_of_operations() {
    let Some((mut window, _folder)) = opened("dented.xml", DENTED) else {
        return;
    };
    let middle = in_picture(&window, 0.5, 0.5);
    click(&mut window, middle);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    window.run_steps(2);
    window.get_by_label("1 (0-based), sphere");
    window.get_by_label("reversed: the operand is subtracted");
    window.get_by_label("radius r");
    window.get_by_label_contains("difference of: ");
}

#[test]
fn a_scene_of_one_shape_is_packed_once_for_a_kernel_that_its_table_lacks() {
    let sphere = r#"<scene version="3.0.0"><shape type="sphere"/></scene>"#;
    let Some((mut window, _folder)) = opened("sphere.xml", sphere) else {
        return;
    };
    window.get_by_label("Draft").click();
    wait(&mut window, "the kernel for spheres", |app| {
        app.document().intersector().kernel().name == "sphere-geometric"
    });
    let intersector = Arc::clone(window.state().document().intersector());
    assert_ne!(intersector.kernel().name, window.state().settings().kernel);
    window.run_steps(20);
    let after = window.state().document().intersector();
    assert!(Arc::ptr_eq(after, &intersector));
}

/// Saves under the suggested name; `None` if this machine has a file dialog.
fn save(window: &mut Window, button: &str) -> Option<()> {
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    for _ in 0..400 {
        window.step();
        if window.query_by_label("Path").is_some() {
            // The tool bar has a button of the same name.
            let button = window.get_all_by_label(button).last();
            button.expect("in the dialog").click();
            return Some(());
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    say("SKIPPED: this machine has a file dialog");
    None
}

fn wait_for_file(window: &mut Window, path: &Path) {
    let text = path.to_str().expect("UTF-8").to_owned();
    wait(window, "the file", |app| {
        app.toasts().iter().any(|toast| toast.contains(&text))
    });
}

fn opens_the_same_again(window: &mut Window, path: PathBuf) {
    wait(window, "the picture", App::is_settled);
    let (before, film) = (camera(window), window.state().film().pixels().to_vec());
    let name = path
        .file_name()
        .expect("a name")
        .to_string_lossy()
        .into_owned();
    // Away from the saved view.
    press(window, Key::Num7);
    if window.state().document().name() == name {
        press(window, Key::Home);
    } else {
        crate::app::drop_file(window, path);
    }
    settle(window, &name);
    let after = camera(window);
    for (a, b) in [
        (after.exact_eye(), before.exact_eye()),
        (after.back(), before.back()),
        (after.up(), before.up()),
    ] {
        assert!((a - b).length() < 1e-9, "{a} {b}");
    }
    let pixels = window.state().film().pixels();
    let different = pixels.iter().zip(&film).filter(|(a, b)| a != b).count();
    // The cameras differ by the rounding of the angles in f64, which moves few rays in f32.
    assert!(
        different < pixels.len() / 100,
        "{different} of {}",
        pixels.len()
    );
}

#[test]
fn an_obj_is_saved_as_a_scene_that_opens_in_the_same_view() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    let Some((mut window, folder)) = opened("mesh.obj", text) else {
        return;
    };
    press(&mut window, Key::Num1);
    let Some(()) = save(&mut window, "Save") else {
        return;
    };
    let path = folder.path().join("mesh.xml");
    wait_for_file(&mut window, &path);
    let saved = std::fs::read_to_string(&path).expect("written");
    assert!(saved.contains(r#"value="mesh.obj""#), "{saved}");
    opens_the_same_again(&mut window, path);
}

#[test]
fn a_scene_file_is_replaced_only_by_a_button_that_says_so_and_gets_the_camera() {
    let Some((mut window, folder)) = opened("scene.xml", SCENE) else {
        return;
    };
    let path = folder.path().join("scene.xml");
    // The file on the disk is gone; what is open can still be saved.
    std::fs::remove_file(&path).expect("removed");
    press(&mut window, Key::Num3);
    let Some(()) = save(&mut window, "Save") else {
        return;
    };
    wait_for_file(&mut window, &path);
    press(&mut window, Key::Num1);
    save(&mut window, "Replace").expect("no dialog");
    wait_for_file(&mut window, &path);
    wait(&mut window, "the picture", App::is_settled);
    let before = camera(&window);
    let old = window.state().document().began;
    press(&mut window, Key::F5);
    wait(&mut window, "the file again", |app| {
        app.document().began > old && app.is_settled()
    });
    // Reloading keeps the camera; the key shows the file's view, which is the same.
    press(&mut window, Key::Num7);
    press(&mut window, Key::Home);
    assert!((eye(&window) - before.exact_eye()).length() < 1e-9);
    assert!((camera(&window).back() - before.back()).length() < 1e-9);
}

#[test]
fn the_built_in_scene_cannot_be_saved() {
    let Some(mut window) = app(None) else { return };
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::S);
    window.run_steps(2);
    let notice = window.state().notice().expect("an error");
    assert!(notice.contains("built-in scene"), "{notice}");
    assert!(!window.state().settings().is_smooth, "not the key S");
}

#[test]
fn the_trade_tab_and_the_menu_list_the_kernels_of_the_scenes_shapes() {
    let Some((mut window, _folder)) = opened("scene.xml", SCENE) else {
        return;
    };
    window.get_by_label("Trade").click();
    wait(&mut window, "the measurement", |app| {
        app.trade().map(Trade::state) == Some(TradeState::Done)
    });
    let rows = window.state().trade().expect("measured").rows();
    let shapes: Vec<_> = rows.iter().map(|row| row.shape).collect();
    assert!(
        shapes.is_sorted_by_key(|shape| *shape != "sphere"),
        "{shapes:?}"
    );
    let kernels: Vec<_> = rows.iter().map(|row| row.kernel).collect();
    assert!(kernels.contains(&"sphere-geometric-f64") && kernels.contains(&"axis-box-slabs-f64"));
    assert!(!kernels.contains(&"edge-planes"), "{kernels:?}");
    window.run_steps(2);
    window.get_by_label("Spheres");
    window.get_by_label("Axis-aligned boxes");
    window
        .get_by_label_contains("sphere-algebraic-f64 ")
        .click();
    wait(&mut window, "the kernel", |app| {
        app.document().intersector().kernel().name == "sphere-algebraic-f64"
    });

    window.get_by_label("Mesh").click();
    window.run_steps(3);
    window.get_by_label("spheres");
    window.get_by_label("axis-aligned boxes");
}

#[test]
fn views_of_barycentric_coordinates_are_defined_or_grey_on_a_sphere() {
    let sphere = r#"<scene version="3.0.0"><shape type="sphere"/></scene>"#;
    let Some((mut window, _folder)) = opened("sphere.xml", sphere) else {
        return;
    };
    let middle = |app: &App| {
        let film = app.film();
        let at = film.size() / 2;
        film.pixels()[(at.y * film.size().x + at.x) as usize]
    };
    // Neither clay nor the background is without blue or grey.
    window.get_by_label("Barycentric").click();
    wait(&mut window, "u and v as red and green", |app| {
        let [_, _, blue, _] = middle(app);
        blue == 0
    });
    window.get_by_label("v of other shapes");
    window.get_by_label("Barycentric error").click();
    wait(&mut window, "grey", |app| {
        let [red, green, blue, _] = middle(app);
        red == green && green == blue && red > 0
    });
    window.get_by_label("not a triangle: undefined");
}
