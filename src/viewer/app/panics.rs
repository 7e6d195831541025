//! Tests: a panic in a background task shows a message, and the window continues to work.

use super::App;
use crate::harness::{Window, app, click, in_picture, press, wait};
use crate::overlay::wireframe::WIREFRAME;
use crate::settings::Settings;
use crate::task::sabotage;
use crate::trade::{Axis, Trade, TradeState};
use egui::Key;
use glam::UVec2;

const MESSAGE: &str = "internal error; see the terminal for details";

fn wait_for_message(window: &mut Window) {
    wait(window, "the message", |app| app.notice() == Some(MESSAGE));
    press(window, Key::Escape);
    assert_eq!(window.state().notice(), None);
}

#[test]
fn a_panic_while_picking_is_reported_and_the_next_pick_works() {
    let Some(mut window) = app(None) else { return };
    let at = in_picture(&window, 0.5, 0.5);
    sabotage::next("inspect");
    click(&mut window, at);
    wait_for_message(&mut window);
    assert!(window.state().inspection().is_none());
    // Two clicks within 0.3 s would be a double-click.
    window.run_steps(30);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
}

#[test]
fn a_panic_in_the_overlay_is_reported_and_lines_are_turned_off_and_can_be_turned_on_again() {
    let Some(mut window) = app(None) else { return };
    for task in ["overlay upload", "overlay"] {
        sabotage::next(task);
        press(&mut window, Key::W);
        // The overlay is drawn in the background only on a software GPU.
        if task == "overlay" && !window.state().traced.overlay.is_software() {
            continue;
        }
        wait_for_message(&mut window);
        assert!(
            !window.state().settings().overlays.is_on(&WIREFRAME),
            "{task}"
        );
    }
    press(&mut window, Key::N);
    wait(&mut window, "the normals", App::is_settled);
    assert!(window.state().settings().shows_normals());
}

#[test]
fn a_panic_while_packing_a_kernel_is_reported_and_the_previous_kernel_stays() {
    let Some(mut window) = app(None) else { return };
    sabotage::next("pack");
    window
        .state_mut()
        .seen
        .settings
        .use_for_session("moller-trumbore");
    wait_for_message(&mut window);
    assert_eq!(window.state().settings().kernel().info.name, "exact");
    assert_eq!(
        window.state().document().intersector().kernel().name,
        "exact"
    );
    window
        .state_mut()
        .seen
        .settings
        .use_for_session("moller-trumbore");
    wait(&mut window, "the kernel", |app| {
        app.document().intersector().kernel().name == "moller-trumbore"
    });
}

#[test]
fn a_panic_while_packing_for_a_comparing_view_is_reported_and_the_default_view_is_restored() {
    let Some(mut window) = app(None) else { return };
    sabotage::next("pack");
    window.state_mut().seen.settings.view = "disagreement".to_owned();
    assert!(window.state().settings().second_kernel().is_some());
    wait_for_message(&mut window);
    assert_eq!(window.state().settings().view, Settings::default().view);
}

#[test]
fn a_panic_while_loading_is_reported_and_the_old_file_stays() {
    let Some(mut window) = app(None) else { return };
    let name = window.state().document().name();
    let ctx = window.ctx.clone();
    sabotage::next("load");
    window.state_mut().load("mesh.obj".into(), &ctx);
    wait(&mut window, "the message", |app| {
        app.notice() == Some(format!("mesh.obj: {MESSAGE}").as_str())
    });
    assert_eq!(window.state().document().name(), name);
}

#[test]
fn a_measurement_that_panics_is_reported_as_failed() {
    let Some(mut window) = app(None) else { return };
    let ctx = window.ctx.clone();
    let camera = window.state().turntable().camera(UVec2::new(64, 64));
    let scene = std::sync::Arc::clone(&window.state().document().loaded.scene);
    sabotage::next("trade");
    window.state_mut().open.trade = Some(Trade::start(&scene, camera, Axis::default(), &ctx));
    wait(&mut window, "the end", |_| true);
    while window.state().trade().map(Trade::state) == Some(TradeState::Measuring) {
        if let Some(trade) = &mut window.state_mut().open.trade {
            trade.poll();
        }
    }
    assert_eq!(
        window.state().trade().map(Trade::state),
        Some(TradeState::Failed)
    );
}
