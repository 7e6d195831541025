//! The path of a sample of the picked pixel.

use crate::harness::{Window, app_with, click, in_picture, wait};
use crate::pointer::on_the_mesh;
use egui::OutputCommand;
use egui_kittest::kittest::Queryable as _;
use glam::UVec2;
use hitscope::app::App;
use hitscope::settings::Settings;

/// A window with the finished picture of a view, of which a pixel that shows the scene is picked.
fn picked(view: &str, samples: u32) -> Option<Window> {
    let mut window = app_with(Settings {
        view: view.to_owned(),
        samples,
        ..Settings::default()
    })?;
    wait(&mut window, "all samples", App::is_settled);
    let (x, y) = on_the_mesh(&window);
    let at = in_picture(&window, x, y);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    Some(window)
}

#[test]
fn the_path_of_the_only_sample_has_the_colour_of_the_pixel() {
    let Some(mut window) = picked("path", 1) else {
        return;
    };
    wait(&mut window, "the path", |app| app.path().is_some());
    let app = window.state();
    let pixel = app.inspection().expect("a pick").pixel;
    let path = app.path().expect("a path");
    assert_eq!((path.view, path.sample), ("path", 0));
    assert!(!path.vertices.is_empty(), "the pixel shows the scene");
    let in_picture = app.film().radiance(UVec2::from_array(pixel));
    assert_eq!(
        Some(path.radiance),
        in_picture.map(|light| light.to_array())
    );
}

#[test]
fn another_sample_is_selected_by_a_button() {
    let Some(mut window) = picked("path", 4) else {
        return;
    };
    wait(&mut window, "the path", |app| app.path().is_some());
    window.run_steps(2);
    window.get_by_label("of 0 to 3");
    // One table has all columns.
    let of_all_columns = |node: &egui_kittest::kittest::AccessKitNode<'_>| {
        let text = node.value().or(node.label()).unwrap_or_default();
        let columns = ["primitive", "from lights", "emitted", "throughput"];
        columns.iter().all(|column| text.contains(column))
    };
    window.get_by(of_all_columns);
    let first = window.state().path().expect("a path").clone();
    window.get_by_label("Next").click_accesskit();
    wait(&mut window, "the next path", |app| {
        app.path().is_some_and(|path| path.sample == 1)
    });
    window.run_steps(2);
    window.get_by_label("Previous").click_accesskit();
    wait(&mut window, "the first path", |app| {
        app.path() == Some(&first)
    });
    wait(&mut window, "the path's lines", App::is_settled);
}

#[test]
fn a_view_that_follows_no_paths_shows_none() {
    let Some(mut window) = picked("normal", 1) else {
        return;
    };
    window.run_steps(5);
    assert!(window.state().path().is_none());
    assert!(window.query_by_label("Paths").is_none());
}

/// The text that the button *Copy as JSON* copies.
fn copied(window: &mut Window) -> serde_json::Value {
    window.get_by_label("Copy as JSON").click_accesskit();
    for _ in 0..1000 {
        window.step();
        let commands = &window.output().platform_output.commands;
        let text = commands.iter().find_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        });
        if let Some(text) = text {
            return parsed(&text);
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("nothing was copied");
}

fn parsed(text: &str) -> serde_json::Value {
    serde_json::from_str(text).expect("JSON")
}

#[test]
fn the_copied_inspection_contains_the_path_of_the_selected_sample() {
    let Some(mut window) = picked("path", 4) else {
        return;
    };
    wait(&mut window, "the path", |app| app.path().is_some());
    window.run_steps(2);
    window.get_by_label("Next").click_accesskit();
    wait(&mut window, "the next path", |app| {
        app.path().is_some_and(|path| path.sample == 1)
    });
    window.run_steps(2);
    let copied = copied(&mut window);
    let app = window.state();
    let mut expected = app.inspection().expect("a pick").clone();
    expected.path = app.path().cloned();
    assert_eq!(copied.to_string(), parsed(&expected.to_json()).to_string());
    assert_eq!(copied["path"]["sample"], 1);
    for name in ["t", "position", "throughput", "emission", "direct"] {
        assert!(copied["path"]["vertices"][0].get(name).is_some(), "{name}");
    }
}

#[test]
fn the_copied_inspection_of_a_view_without_paths_has_none() {
    let Some(mut window) = picked("normal", 1) else {
        return;
    };
    window.run_steps(5);
    assert!(copied(&mut window)["path"].is_null());
}
