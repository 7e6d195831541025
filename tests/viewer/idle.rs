//! Tests that an unchanged window with a complete picture requests no frames.

use crate::harness::{Window, app_started, click, in_picture, press, run_command, wait};
use egui::{Event, Pos2};
use egui_kittest::kittest::Queryable as _;
use hitscope::app::{App, StartOptions};
use hitscope::preferences::Preferences;
use hitscope::settings::Settings;
use hitscope::tab::Tab;
use hitscope::trade::{Trade, TradeState};
use std::time::Duration;

/// Waits until the picture is complete and the tab has its contents. Then requires that nothing requests a frame.
fn require_idle(window: &mut Window, moment: &str) {
    wait(window, moment, |app| {
        app.is_settled() && app.trade().map(Trade::state) != Some(TradeState::Measuring)
    });
    // Animations, tooltips and toasts of the last action end.
    for _ in 0..400 {
        window.step();
    }
    let causes = window.ctx.repaint_causes();
    let delay = delay(window);
    assert_eq!(delay, Duration::MAX, "{moment}: {causes:?}");
    // Nor does a thread.
    std::thread::sleep(Duration::from_millis(200));
    let causes = window.ctx.repaint_causes();
    assert!(!window.ctx.has_requested_repaint(), "{moment}: {causes:?}");
}

/// The time after which the last frame requested another one.
fn delay(window: &Window) -> Duration {
    window.output().viewport_output[&egui::ViewportId::ROOT].repaint_delay
}

fn window(tab: Tab, view: &str) -> Option<Window> {
    app_started(StartOptions {
        settings: Settings {
            view: view.to_owned(),
            samples: 1,
            ..Settings::default()
        },
        preferences: Preferences {
            tab,
            ..Preferences::default()
        },
        ..StartOptions::default()
    })
}

#[test]
fn a_window_with_a_complete_picture_requests_no_frames_in_any_tab() {
    for tab in Tab::ALL {
        let Some(mut window) = window(tab, "shaded") else {
            return;
        };
        require_idle(&mut window, tab.title());
        window.event(Event::PointerMoved(in_picture(&window, 0.5, 0.5)));
        require_idle(
            &mut window,
            &format!("{}, pointer over the picture", tab.title()),
        );
        let at = in_picture(&window, 0.5, 0.5);
        click(&mut window, at);
        wait(&mut window, "the pick", |app| app.inspection().is_some());
        require_idle(&mut window, &format!("{}, with a pick", tab.title()));
        // The panel with the pointer over it.
        window.event(Event::PointerMoved(Pos2::new(700.0, 300.0)));
        require_idle(
            &mut window,
            &format!("{}, pointer over the panel", tab.title()),
        );
    }
}

#[test]
fn a_window_is_idle_after_lines_and_toasts_and_once_light_has_converged() {
    let Some(mut window) = window(Tab::Display, "path") else {
        return;
    };
    require_idle(&mut window, "light");
    for key in [egui::Key::W, egui::Key::N, egui::Key::G, egui::Key::X] {
        press(&mut window, key);
    }
    require_idle(&mut window, "lines");
    // The picture on the clipboard gives a toast.
    run_command(&mut window, "copy picture");
    wait(&mut window, "the toast", |app| !app.toasts().is_empty());
    require_idle(&mut window, "after the toast");
    assert_eq!(window.state().toasts(), [""; 0]);
    assert!(window.query_by_label("Rendered picture").is_some());
}

#[test]
fn a_paused_window_is_idle() {
    let Some(mut window) = app_started(StartOptions::default()) else {
        return;
    };
    press(&mut window, egui::Key::P);
    assert!(window.state().is_paused());
    wait(&mut window, "the tree", |app| {
        app.document().has_last_tree()
    });
    window.run_steps(200);
    std::thread::sleep(Duration::from_millis(300));
    window.run_steps(60);
    let delay = delay(&window);
    assert_eq!(delay, Duration::MAX, "{:?}", window.ctx.repaint_causes());
    assert!(!App::is_settled(window.state()));
}
