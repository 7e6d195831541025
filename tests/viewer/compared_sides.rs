//! Tests of the sides of a comparison: clicks on side B and its picks, and rasterized sides.

use crate::comparing::{SQUARE, button, choose, colour, compare, opened, settled};
use crate::harness::{Window, app, click, in_picture, pointer, press, settle, wait, write};
use egui::{Event, Key, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable as _;
use hitscope::app::App;
use hitscope::comparison::{Side, Source};

#[test]
fn a_click_on_side_b_inspects_with_its_kernel() {
    let Some((mut window, _folder)) = opened(SQUARE) else {
        return;
    };
    compare(&mut window);
    choose(
        &mut window,
        "Kernel of B",
        "watertight – Watertight (Woop et al.)",
    );
    for (x, kernel) in [(0.55, "watertight"), (0.45, "exact")] {
        let at = in_picture(&window, x, 0.5);
        click(&mut window, at);
        wait(&mut window, kernel, |app| {
            app.inspection().is_some_and(|found| found.kernel == kernel)
        });
    }
}

#[test]
fn rasterized_and_traced_triangles_hardly_differ() {
    let Some(mut window) = app(None) else { return };
    wait(&mut window, "all samples", App::is_settled);
    compare(&mut window);
    choose(&mut window, "Source", Source::Rasterized.title());
    for view in ["Shaded", "Normal", "Depth", "Triangle"] {
        choose(&mut window, "View of B", view);
        let figures = window.state().figures().expect("counted");
        let seen = figures.visibility.expect("of triangles");
        let all = window.state().film().size().element_product() as usize;
        assert!(seen.covered > all / 10, "{view}: {seen:?}");
        // As in the comparison of triangle numbers: only centres on edges differ.
        assert!(seen.different * 1000 <= seen.covered, "{view}: {seen:?}");
    }
    // The same view on both sides differs at edges only, which rays sample more than once.
    choose(&mut window, "View of B", "same as A");
    let figures = window.state().figures().expect("counted").picture.clone();
    assert!(figures.percent_over_tolerance > 0.0, "{figures:?}");
    let psnr = figures.psnr_db.expect("a difference");
    assert!(psnr > 20.0, "{figures:?}");
}

#[test]
fn both_sides_can_be_rasterized() {
    let Some((mut window, _folder)) = opened(SQUARE) else {
        return;
    };
    compare(&mut window);
    button(&mut window, "Rasterize side A");
    let seen = |window: &Window| {
        let figures = window.state().figures().expect("counted");
        let different = figures.picture.pixels_over_tolerance;
        let triangles = figures.visibility.expect("of triangles");
        assert!(triangles.covered > 0);
        (different, triangles.different)
    };
    // Side B is traced with several samples per pixel, so that its edges differ.
    assert!(seen(&window).0 > 0);
    choose(&mut window, "Source", Source::Rasterized.title());
    assert_eq!(seen(&window), (0, 0));
    let before = colour(&mut window, 0.45, 0.5);
    choose(&mut window, "View of A", "Normal");
    assert_ne!(colour(&mut window, 0.45, 0.5), before);
    choose(&mut window, "View of B", "Triangle");
    let (different, triangles) = seen(&window);
    assert!(different > 0);
    assert_eq!(triangles, 0, "the same triangles in other colours");
    window.get_by_label("A: Normal, rasterized, flat");
    // Swapped, both are still rasterized.
    window.key_press_modifiers(Modifiers::SHIFT, Key::X);
    settled(&mut window);
    let comparison = window.state().comparison();
    assert!(comparison.is_a_rasterized && comparison.source == Source::Rasterized);
    assert_eq!(window.state().settings().view().name, "triangle");
    button(&mut window, "Rasterize side A");
    assert!(
        window
            .query_by_label_contains("A: Triangle, rasterized")
            .is_none()
    );
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settled(&mut window);
    assert!(window.state().comparison().is_a_rasterized);
}

#[test]
fn shapes_that_are_not_rasterized_are_named() {
    let scene = r#"<scene version="3.0.0"><shape type="sphere"/></scene>"#;
    let folder = tempfile::tempdir().expect("a folder");
    let path = write(&folder, "scene.xml", scene);
    let Some(mut window) = app(Some(path)) else {
        return;
    };
    settle(&mut window, "scene.xml");
    compare(&mut window);
    choose(&mut window, "Source", Source::Rasterized.title());
    window.get_by_label("Not rasterized, because they aren't triangles: 1 sphere");
}

/// The window with a comparison of two kernels, the second one on side B.
fn with_two_kernels() -> Option<(Window, tempfile::TempDir)> {
    let (mut window, folder) = opened(SQUARE)?;
    compare(&mut window);
    let kernel = "watertight – Watertight (Woop et al.)";
    choose(&mut window, "Kernel of B", kernel);
    Some((window, folder))
}

fn is_inspected_by(app: &App, kernel: &str) -> bool {
    app.inspection().is_some_and(|found| found.kernel == kernel)
}

/// Side and kernel of each pick; no kernel if the side isn't traced.
fn picks(app: &App) -> Vec<(String, Option<String>)> {
    let text = app.picks_as_json();
    let json: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let picks = json["picks"].as_array().expect("a list");
    let text = |value: &serde_json::Value| value.as_str().map(str::to_owned);
    let pick = |pick: &serde_json::Value| {
        let side = text(&pick["side"]).expect("a side");
        (side, text(&pick["hit"]["kernel"]))
    };
    picks.iter().map(pick).collect()
}

#[test]
fn picks_of_both_sides_are_listed_and_measured() {
    let Some((mut window, _folder)) = with_two_kernels() else {
        return;
    };
    let at = in_picture(&window, 0.45, 0.5);
    click(&mut window, at);
    wait(&mut window, "side A", |app| is_inspected_by(app, "exact"));
    let at = in_picture(&window, 0.55, 0.5);
    let ctrl = Modifiers::COMMAND | Modifiers::CTRL;
    window.event(Event::PointerMoved(at));
    window.step();
    for pressed in [true, false] {
        pointer(&window, at, PointerButton::Primary, pressed, ctrl);
        window.step();
    }
    let pick = |side: &str, kernel: Option<&str>| (side.to_owned(), kernel.map(str::to_owned));
    let both = [pick("A", Some("exact")), pick("B", Some("watertight"))];
    wait(&mut window, "both picks", |app| {
        picks(app) == both && is_inspected_by(app, "watertight")
    });
    window.run_steps(20);
    window.get_by_label("Pick 2 on B");
    assert!(
        window
            .query_by_label("Distances need two picks that hit a surface.")
            .is_none()
    );
    // The pick stays while there is no side B.
    press(&mut window, Key::C);
    wait(&mut window, "no side B", |app| {
        picks(app) == [both[0].clone(), pick("B", None)]
    });
    press(&mut window, Key::C);
    settled(&mut window);
    wait(&mut window, "both picks", |app| picks(app) == both);
    // The selected pick is the one that is inspected, on its own side.
    button(&mut window, "Inspect");
    for (label, kernel) in [("Pick 1", "exact"), ("Pick 2 on B", "watertight")] {
        window.get_by_label(label).click();
        window.run_steps(3);
        wait(&mut window, label, |app| is_inspected_by(app, kernel));
        window.run_steps(3);
    }
}

#[test]
fn undo_and_sessions_know_the_side_of_a_pick() {
    let Some((mut window, _folder)) = with_two_kernels() else {
        return;
    };
    for (x, kernel) in [(0.55, "watertight"), (0.45, "exact")] {
        let at = in_picture(&window, x, 0.5);
        click(&mut window, at);
        wait(&mut window, kernel, |app| is_inspected_by(app, kernel));
        window.run_steps(3);
    }
    let side = |window: &Window| window.state().sight().picks.first().map(|pick| pick.side);
    assert_eq!(side(&window), Some(Side::A));
    window.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    window.run_steps(3);
    wait(&mut window, "side B", |app| {
        is_inspected_by(app, "watertight")
    });
    assert_eq!(side(&window), Some(Side::B));
    let text = serde_json::to_string(&window.state().sight()).expect("plain data");
    let read: hitscope::session::Sight = serde_json::from_str(&text).expect("what was written");
    assert_eq!(read, window.state().sight());
}
