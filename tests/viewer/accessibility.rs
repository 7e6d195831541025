//! Tests of the names and roles of controls for assistive technology.

use crate::commands::open_menu;
use crate::harness::{Window, app, app_with, click, in_picture, press, wait};
use crate::pointer::on_the_mesh;
use egui::accesskit::{Action, Role};
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use hitscope::comparison::{Mode, Source};
use hitscope::settings::{EnvironmentSource, Settings};
use hitscope::tab::Tab;
use hitscope::trade::{Trade, TradeState};

/// Requires a name and a role of everything that the keyboard can reach, and of every other control.
fn check(window: &Window, moment: &str) {
    assert_eq!(window.unnamed_widgets(), [""; 0], "{moment}");
    let mut count = 0;
    for node in window.root().children_recursive() {
        let node = node.accesskit_node();
        if !node.data().supports_action(Action::Focus) {
            continue;
        }
        count += 1;
        let name = node.label().or(node.value()).unwrap_or_default();
        let placeholder = node.data().placeholder().unwrap_or_default();
        let has_name = !name.trim().is_empty() || !placeholder.is_empty();
        let bounds = node.raw_bounds();
        let role = node.role();
        assert!(has_name, "{moment}: {role:?} without a name at {bounds:?}");
        assert_ne!(role, Role::Unknown, "{moment}: {name} at {bounds:?}");
    }
    assert!(count > 0, "{moment}");
}

#[test]
fn every_control_of_every_tab_has_a_name_and_a_role() {
    let Some(mut window) = app(None) else { return };
    let (x, y) = on_the_mesh(&window);
    let at = in_picture(&window, x, y);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    for tab in Tab::ALL {
        window.get_by_label(tab.title()).click();
        window.run_steps(3);
        match tab {
            Tab::Mesh => wait(&mut window, "the check", |app| {
                app.document().known_findings().is_some()
            }),
            Tab::Trade => wait(&mut window, "the measurement", |app| {
                app.trade().map(Trade::state) == Some(TradeState::Done)
            }),
            Tab::Inspect | Tab::Display | Tab::Parts | Tab::Compare => {}
        }
        window.run_steps(3);
        check(&window, tab.title());
    }
}

#[test]
fn every_option_of_views_with_light_has_a_name_and_a_role() {
    for view in ["path", "ao", "spawning", "disagreement"] {
        let settings = Settings {
            view: view.to_owned(),
            samples: 1,
            environment: EnvironmentSource::Colour,
            ..Settings::default()
        };
        let Some(mut window) = app_with(settings) else {
            return;
        };
        window.run_steps(3);
        check(&window, view);
    }
}

#[test]
fn every_control_of_clips_and_scales_has_a_name_and_a_role() {
    for button in ["By a plane", "By a box"] {
        let mut settings = Settings {
            view: "depth".to_owned(),
            samples: 1,
            ..Settings::default()
        };
        let view = settings.view();
        settings.colours.scale_mut(view).range = Some([1.0, 2.0]);
        let Some(mut window) = app_with(settings) else {
            return;
        };
        window.get_by_label(button).scroll_to_me();
        window.run_steps(10);
        window.get_by_label(button).click();
        window.run_steps(3);
        check(&window, button);
    }
}

#[test]
fn every_control_of_every_comparison_has_a_name_and_a_role() {
    let Some(mut window) = app(None) else { return };
    press(&mut window, Key::C);
    for source in Source::ALL {
        let combo = window.get_by_role_and_label(Role::ComboBox, "Source");
        combo.click();
        window.run_steps(4);
        let entry = window.get_all_by_label(source.title()).last();
        entry.expect("in the menu").click();
        window.run_steps(4);
        check(&window, source.title());
    }
    for mode in Mode::ALL {
        window.get_by_label(mode.title()).click();
        window.run_steps(4);
        check(&window, mode.title());
    }
}

#[test]
fn every_menu_and_every_window_over_the_picture_has_named_controls() {
    let Some(mut window) = app(None) else { return };
    for menu in ["File", "Edit", "View", "Camera", "Pick", "Window", "Help"] {
        open_menu(&mut window, menu);
        check(&window, menu);
        press(&mut window, Key::Escape);
        window.run_steps(3);
    }
    for (modifiers, key) in [
        (Modifiers::COMMAND, Key::P),
        (Modifiers::NONE, Key::H),
        (Modifiers::NONE, Key::F5),
    ] {
        window.key_press_modifiers(modifiers, key);
        window.run_steps(4);
        check(&window, key.name());
        press(&mut window, Key::Escape);
        window.run_steps(3);
    }
}
