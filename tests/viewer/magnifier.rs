//! Tests of the magnified picture and of the values in its pixels.

use crate::harness::{Window, app_started, click, in_picture, press, wait};
use crate::pointer::on_the_knot;
use egui::{Event, Key, Modifiers, MouseWheelUnit, Pos2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::UVec2;
use hitscope::app::{App, StartOptions};
use hitscope::preferences::Preferences;
use hitscope::settings::Settings;

fn window(view: &str) -> Option<Window> {
    let mut window = app_started(StartOptions {
        settings: Settings {
            view: view.to_owned(),
            samples: 1,
            ..Settings::default()
        },
        preferences: Preferences {
            shows_panel: false,
            ..Preferences::default()
        },
        ..StartOptions::default()
    })?;
    wait(&mut window, "the picture", App::is_settled);
    Some(window)
}

/// Moves the pointer to the knot. Returns its place and the pixel there.
fn point_at_the_knot(window: &mut Window) -> (Pos2, UVec2) {
    let (x, y) = on_the_knot(window);
    // In the middle of a pixel: a point is a pixel here.
    let at = (in_picture(window, x, y).floor()) + egui::vec2(0.5, 0.5);
    window.event(Event::PointerMoved(at));
    window.run_steps(2);
    let within = at - window.get_by_label("Rendered picture").rect().min;
    (at, UVec2::new(within.x as u32, within.y as u32))
}

fn number_in(window: &mut Window, pixel: UVec2) -> String {
    let start = format!("Pixel {}, {}: ", pixel.x, pixel.y);
    for _ in 0..1000 {
        window.step();
        if window.query_by_label_contains(&start).is_some() {
            let node = window.get_by_label_contains(&start);
            let text = node
                .accesskit_node()
                .value()
                .or_else(|| node.accesskit_node().label());
            let text = text.expect("a text");
            return text[start.len()..].to_owned();
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("no number in {pixel}");
}

#[test]
fn a_magnified_pixel_shows_its_primitive_and_a_click_inspects_that_pixel() {
    let Some(mut window) = window("triangle") else {
        return;
    };
    let (at, pixel) = point_at_the_knot(&mut window);
    let camera = window.state().shown_camera();
    press(&mut window, Key::Z);
    assert!(window.state().magnification() >= 48.0);
    let number = number_in(&mut window, pixel);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    let inspection = window.state().inspection().expect("the pick");
    assert_eq!(inspection.pixel, pixel.to_array());
    let hit = inspection.hit.as_ref().expect("the knot");
    assert_eq!(number, hit.primitive.to_string());
    assert_eq!(window.state().shown_camera(), camera);
    press(&mut window, Key::Escape);
    assert_eq!(window.state().magnification(), 1.0);
    assert!(window.state().inspection().is_some(), "the pick stays");
    assert!(window.query_by_label_contains("Pixel ").is_none());
}

#[test]
fn pixel_values_are_decimal_or_exact() {
    let Some(mut window) = window("depth") else {
        return;
    };
    let (_, pixel) = point_at_the_knot(&mut window);
    press(&mut window, Key::Z);
    let decimal: f64 = number_in(&mut window, pixel).parse().expect("a number");
    window.key_press_modifiers(Modifiers::COMMAND, Key::P);
    window.run_steps(3);
    let field = window.get_by_label("Find a command");
    field.type_text("exact pixel values");
    window.run_steps(3);
    press(&mut window, Key::Enter);
    window.run_steps(3);
    let exact = number_in(&mut window, pixel);
    let digits = exact.strip_prefix("0x1").expect("a hexadecimal float");
    let (digits, exponent) = digits.split_once('p').expect("an exponent");
    let digits = digits.trim_start_matches('.');
    let fraction = u64::from_str_radix(&format!("{digits:0<13}"), 16).expect("digits");
    let exponent: i32 = exponent.parse().expect("a number");
    let value = (1.0 + fraction as f64 / 2f64.powi(52)) * 2f64.powi(exponent);
    assert!((value / decimal - 1.0).abs() < 1e-4, "{exact} {decimal}");
}

#[test]
fn ctrl_shift_scroll_magnifies_the_picture_without_moving_the_camera() {
    let Some(mut window) = window("normal") else {
        return;
    };
    point_at_the_knot(&mut window);
    let before = *window.state().turntable();
    let scroll = |window: &mut Window, y: f32| {
        let modifiers = Modifiers::COMMAND | Modifiers::CTRL | Modifiers::SHIFT;
        let wheel = Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: egui::vec2(0.0, y),
            modifiers,
            phase: egui::TouchPhase::Move,
            source: egui::MouseWheelSource::Unknown,
        };
        window.event_modifiers(wheel, modifiers);
        window.run_steps(60);
    };
    scroll(&mut window, 400.0);
    let enlarged = window.state().magnification();
    assert!(enlarged > 1.5, "{enlarged}");
    scroll(&mut window, -1000.0);
    assert_eq!(window.state().magnification(), 1.0);
    assert_eq!(*window.state().turntable(), before);
}
