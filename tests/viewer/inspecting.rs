//! Tests of inspecting: the list of picks, measuring, the walk of a ray, the read-out, going to elements.

use crate::harness::{Window, app, bare_with, click, pointer, press, wait};
use crate::pointer::on_the_mesh;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2};
use egui_kittest::kittest::Queryable as _;
use glam::UVec2;
use hitscope::app::App;
use hitscope::settings::Settings;

/// The pixel of the window with the picture's top left corner.
pub fn corner(window: &Window) -> UVec2 {
    let corner = window.get_by_label("Rendered picture").rect().min;
    UVec2::new(corner.x as u32, corner.y as u32)
}

/// The middle of a pixel of the picture.
pub fn middle(window: &Window, pixel: UVec2) -> Pos2 {
    let at = (corner(window) + pixel).as_vec2() + 0.5;
    egui::pos2(at.x, at.y)
}

/// Pixels of the picture, one for each of some triangles.
pub fn pixels_on_triangles(window: &Window, count: usize) -> Vec<UVec2> {
    let app = window.state();
    let size = app.film().size();
    let camera = app.turntable().camera(size);
    let mut seen = Vec::new();
    let mut pixels = Vec::new();
    for y in (size.y / 4..3 * size.y / 4).step_by(7) {
        for x in (size.x / 4..3 * size.x / 4).step_by(7) {
            let pixel = UVec2::new(x, y);
            let ray = camera.ray_through(pixel.as_dvec2() + 0.5);
            if let Some(hit) = app.document().intersector().closest_hit(&ray)
                && !seen.contains(&hit.primitive)
            {
                seen.push(hit.primitive);
                pixels.push(pixel);
            }
        }
    }
    // Spread over the picture, so that clicks aren't double clicks.
    let step = pixels.len() / count;
    assert!(step > 0, "{} triangles", pixels.len());
    pixels.into_iter().step_by(step).take(count).collect()
}

/// The app with a sample in each pixel.
pub fn ready() -> Option<Window> {
    let mut window = app(None)?;
    wait(&mut window, "the picture", App::is_settled);
    Some(window)
}

pub fn pick(window: &mut Window, pixel: UVec2) {
    let at = middle(window, pixel);
    click(window, at);
    // A click waits for the second one of a double click.
    window.run_steps(30);
    wait(window, "the pick", |app| {
        let found = app.inspection();
        found.is_some_and(|found| found.pixel == pixel.to_array())
    });
    window.run_steps(3);
}

/// Ctrl+click.
pub fn add_pick(window: &mut Window, pixel: UVec2) {
    let at = middle(window, pixel);
    let ctrl = Modifiers::COMMAND | Modifiers::CTRL;
    window.event(Event::PointerMoved(at));
    window.step();
    for pressed in [true, false] {
        pointer(window, at, PointerButton::Primary, pressed, ctrl);
        window.step();
    }
    wait(window, "the pick", |app| {
        let found = app.inspection();
        found.is_some_and(|found| found.pixel == pixel.to_array())
    });
    window.run_steps(3);
}

/// Waits until a label contains a text.
pub fn wait_for_label(window: &mut Window, text: &str) {
    for _ in 0..400 {
        if window.query_all_by_label_contains(text).next().is_some() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
        window.step();
    }
    panic!("no label contains “{text}”");
}

pub fn has(window: &Window, label: &str) -> bool {
    window.query_all_by_label(label).next().is_some()
}

#[test]
fn ctrl_click_adds_picks_that_are_numbered_measured_pinned_and_removed() {
    let Some(mut window) = ready() else { return };
    let pixels = pixels_on_triangles(&window, 4);
    pick(&mut window, pixels[0]);
    add_pick(&mut window, pixels[1]);
    wait_for_label(&mut window, "#2");
    assert!(has(&window, "#1") && has(&window, "Pick 1") && has(&window, "Pick 2"));
    wait_for_label(&mut window, "distance 1 to 2");
    wait_for_label(&mut window, "angle of normals 1 and 2");
    add_pick(&mut window, pixels[2]);
    wait_for_label(&mut window, "angle at 2");
    wait_for_label(&mut window, "circle 1, 2, 3");

    let table = window.state().picks_as_csv();
    assert_eq!(table.lines().count(), 4);
    let json: serde_json::Value =
        serde_json::from_str(&window.state().picks_as_json()).expect("JSON");
    let found = window.state().inspection().expect("the third").clone();
    let hit = found.hit.expect("on a triangle");
    let third = &json["picks"][2]["hit"];
    assert_eq!(third["primitive"], hit.primitive);
    assert_eq!(third["t"].as_f64(), Some(f64::from(hit.t)));

    window.get_by_label("Pin 1").click();
    window.run_steps(2);
    window.get_by_label("Remove 2").click();
    window.run_steps(2);
    assert!(!has(&window, "Pick 2") && has(&window, "Pick 3"));
    pick(&mut window, pixels[3]);
    assert!(has(&window, "Pick 1") && has(&window, "Pick 4"));
    assert!(!has(&window, "Pick 3"), "only pinned picks stay");
    window.get_by_label("Pick 1").click();
    wait(&mut window, "the first pick", |app| {
        let found = app.inspection();
        found.is_some_and(|found| found.pixel == pixels[0].to_array())
    });
    window.get_by_label("Remove all picks").click();
    window.run_steps(2);
    assert!(window.state().inspection().is_none());
    assert!(!has(&window, "Pick 1"));
}

#[test]
fn picks_snap_as_the_mode_says_and_the_wall_behind_the_pick_is_measured() {
    let Some(mut window) = ready() else { return };
    let pixels = pixels_on_triangles(&window, 2);
    pick(&mut window, pixels[0]);
    add_pick(&mut window, pixels[1]);
    for (mode, kind) in [("Vertex", "vertex"), ("Edge", "edge"), ("Face", "face")] {
        window.get_by_label(mode).click();
        window.run_steps(2);
        wait(&mut window, mode, |app| {
            let table = app.picks_as_csv();
            let mut picks = table.lines().skip(1);
            picks.all(|pick| pick.contains(&format!(",{kind},")))
        });
    }
    window.get_by_label("Wall thickness").click();
    wait_for_label(&mut window, "thickness ");
    wait_for_label(&mut window, "clearance ");
}

#[test]
fn the_walk_of_a_ray_is_listed_box_by_box() {
    let Some(mut window) = ready() else { return };
    let pixel = pixels_on_triangles(&window, 1)[0];
    pick(&mut window, pixel);
    window.get_by_label("Picks and measurements").click();
    window.run_steps(20);
    window.get_by_label("Walk of the ray").click();
    wait_for_label(&mut window, "number in order");
    let cost = window.state().inspection().expect("a pick").cost;
    let boxes = format!("{} boxes, ", cost.boxes);
    let all = window.query_all_by_label_contains(&boxes);
    assert!(all.count() > 0, "all {boxes}are counted");
    wait_for_label(&mut window, "1 of ");
}

#[test]
fn the_read_out_shows_what_is_under_the_pointer_but_not_while_dragging() {
    let mut settings = Settings::default();
    settings.keep_view("depth");
    let Some(mut window) = bare_with(settings) else {
        return;
    };
    wait(&mut window, "the picture", App::is_settled);
    let (x, y) = on_the_mesh(&window);
    let size = window.state().film().size().as_vec2();
    let pixel = UVec2::new((size.x * x) as u32, (size.y * y) as u32);
    let at = middle(&window, pixel);
    let reads = |window: &Window, text: &str| {
        let mut labels = window.query_all_by_label_contains(text);
        labels.next().is_some()
    };
    window.event(Event::PointerMoved(at));
    window.run_steps(2);
    assert!(reads(&window, "  ·  triangle ") && reads(&window, "Depth "));
    window.event(Event::PointerMoved(middle(&window, UVec2::splat(3))));
    window.run_steps(2);
    assert!(reads(&window, "no hit"));
    window.event(Event::PointerMoved(at));
    pointer(&window, at, PointerButton::Primary, true, Modifiers::NONE);
    window.step();
    window.event(Event::PointerMoved(at + egui::vec2(30.0, 0.0)));
    window.run_steps(2);
    assert!(!reads(&window, "Depth ") && !reads(&window, "no hit"));
}

/// Opens the box and enters a text.
fn go_to(window: &mut Window, text: &str) {
    if window.query_by_label("Go").is_none() {
        window.key_press_modifiers(Modifiers::COMMAND, Key::G);
        window.run_steps(4);
    }
    let field = window.get_by_role_and_label(Role::TextInput, "Go to element");
    field.focus();
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.run_steps(2);
    window
        .get_by_role_and_label(Role::TextInput, "Go to element")
        .type_text(text);
    window.run_steps(2);
    press(window, Key::Enter);
}

#[test]
fn going_to_a_triangle_picks_it_and_a_wrong_number_is_refused_with_the_range() {
    let Some(mut window) = ready() else { return };
    go_to(&mut window, "triangle 5");
    wait(&mut window, "the triangle", |app| {
        let crossing = app
            .inspection()
            .zip(app.crossing())
            .and_then(|(found, marked)| found.crossings.get(marked));
        crossing.is_some_and(|crossing| crossing.primitive == 5)
    });
    let app = window.state();
    let mesh = app.document().loaded.scene.mesh();
    let place = mesh.place_of_triangle(5).expect("a triangle");
    assert!((app.turntable().pivot - place.centre).length() < 1e-5 * place.bounds.diagonal());
    let last = mesh.triangles().len() - 1;
    go_to(&mut window, "triangle 99999999");
    wait_for_label(&mut window, &format!("they are numbered from 0 to {last}"));
    press(&mut window, Key::Escape);
    go_to(&mut window, "nothing");
    wait_for_label(&mut window, "is no element");
    press(&mut window, Key::Escape);
    assert!(!has(&window, "Go"));
}
