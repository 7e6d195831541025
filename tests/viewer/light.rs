//! Tests of views that need lights: their options, noise and limits.

use crate::app::drop_file;
use crate::harness::{Window, app, app_with, bare_with, in_picture, pointer, settle, wait, write};
use egui::{Event, Modifiers, PointerButton};
use egui_kittest::kittest::Queryable as _;
use glam::UVec2;
use hitscope::app::App;
use hitscope::look::noise_legend;
use hitscope::settings::{EnvironmentSource, Settings};
use hitscope_core::brightness::{EXPOSURES, MAX_BRIGHTNESS};
use hitscope_core::tone::Display;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The view *Ambient occlusion*, which needs little time, without the side panel.
fn ambient_occlusion(samples: u32) -> Settings {
    Settings {
        view: "ao".to_owned(),
        samples,
        ..Settings::default()
    }
}

/// Whether the window has a control or text with this label.
fn shows(window: &Window, label: &str) -> bool {
    window.query_all_by_label(label).next().is_some()
}

#[test]
fn each_view_shows_the_options_that_it_uses() {
    let Some(mut window) = app(None) else { return };
    let options = [
        "Spawn policy",
        "Depth limit",
        "Distance",
        "Exposure",
        "Open environment…",
        "Stop after",
        "Stop at noise",
        "Terminator repair (not exact)",
    ];
    for (view, expected) in [
        (
            "Path tracing",
            [true, true, false, true, true, true, true, true],
        ),
        (
            "Recursive",
            [true, true, false, true, true, true, true, true],
        ),
        (
            "Direct light",
            [true, false, false, true, true, true, true, true],
        ),
        (
            "Ambient occlusion",
            [true, false, true, false, false, true, true, false],
        ),
        ("Normal", [false; 8]),
    ] {
        window.get_by_label(view).click();
        window.run_steps(3);
        assert_eq!(window.state().settings().view().title, view);
        let shown = options.map(|option| shows(&window, option));
        assert_eq!(shown, expected, "{view}: {options:?}");
    }
}

#[test]
fn the_status_line_shows_samples_and_noise() {
    let Some(mut window) = bare_with(ambient_occlusion(16)) else {
        return;
    };
    wait(&mut window, "all samples", App::is_settled);
    window.run_steps(2);
    window.get_by_label_contains("16 of 16 samples, noise ");
    window.get_by_label_contains(" % (worst ");
}

/// Draws frames until none is requested.
fn wait_for_rest(window: &mut Window) {
    let start = Instant::now();
    loop {
        window.run_steps(2);
        // Longer than a tile takes.
        std::thread::sleep(Duration::from_millis(500));
        if !window.ctx.has_requested_repaint() && window.state().is_settled() {
            return;
        }
        assert!(start.elapsed() < Duration::from_secs(300), "it never rests");
    }
}

#[test]
fn at_the_wanted_noise_nothing_is_traced_and_no_frame_is_drawn() {
    let settings = Settings {
        has_noise_limit: true,
        // The noise of numbers from 0 to 1 is less, and 16 samples are enough.
        noise_limit_percent: 50.0,
        ..ambient_occlusion(65536)
    };
    let Some(mut window) = bare_with(settings) else {
        return;
    };
    wait(&mut window, "the limit", App::is_settled);
    wait_for_rest(&mut window);
    let film = window.state().film();
    assert!(film.samples() >= 16 && !film.is_complete());
    let passes = film.passes_done();
    std::thread::sleep(Duration::from_millis(500));
    window.step();
    assert_eq!(window.state().film().passes_done(), passes);
    window.get_by_label_contains(", stopped at the noise limit");
}

/// The pixels of the picture on the screen, with the pointer elsewhere: it would show a tooltip or a read-out.
fn on_screen(window: &mut Window) -> Vec<[u8; 4]> {
    let rect = window.get_by_label("Rendered picture").rect();
    window.event(Event::PointerGone);
    window.run_steps(60);
    let image = window.render().expect("an image");
    let is_inside = |x: u32, y: u32| rect.contains(egui::pos2(x as f32 + 0.5, y as f32 + 0.5));
    let inside = image
        .enumerate_pixels()
        .filter(|(x, y, _)| is_inside(*x, *y));
    inside.map(|(_, _, pixel)| pixel.0).collect()
}

#[test]
fn noise_is_shown_without_new_samples() {
    let Some(mut window) = bare_with(ambient_occlusion(4)) else {
        return;
    };
    wait(&mut window, "all samples", App::is_settled);
    let picture = on_screen(&mut window);
    window.get_by_label("Noise").click();
    window.run_steps(2);
    assert!(window.state().settings().shows_noise && window.state().is_settled());
    let noise = on_screen(&mut window);
    // Where all samples agree, the colour is the lowest of the legend.
    let (least, _) = noise_legend()[0][0].clone();
    let least = Display::default().encode(least);
    let calm = noise.iter().filter(|&&pixel| pixel == least).count();
    assert!(calm > picture.len() / 100 && calm < picture.len(), "{calm}");
    window.get_by_label("Noise").click();
    window.run_steps(2);
    assert!(on_screen(&mut window) == picture);
}

#[test]
fn a_drag_with_ctrl_rotates_the_environment_of_views_with_light() {
    for (view, rotates) in [("direct", true), ("shaded", false)] {
        let settings = Settings {
            view: view.to_owned(),
            environment: EnvironmentSource::Studio,
            ..ambient_occlusion(1)
        };
        let Some(mut window) = bare_with(settings) else {
            return;
        };
        let camera = *window.state().turntable();
        let from = in_picture(&window, 0.5, 0.5);
        let ctrl = Modifiers::COMMAND;
        window.event(Event::PointerMoved(from));
        pointer(&window, from, PointerButton::Primary, true, ctrl);
        window.step();
        let to = from + egui::vec2(60.0, 0.0);
        window.event_modifiers(Event::PointerMoved(to), ctrl);
        window.step();
        pointer(&window, to, PointerButton::Primary, false, ctrl);
        window.run_steps(2);
        let app = window.state();
        assert_eq!(app.settings().environment_degrees > 0.0, rotates, "{view}");
        assert_eq!(*app.turntable() == camera, rotates, "{view}");
    }
}

#[test]
fn a_dropped_environment_lights_the_scene_and_does_not_replace_it() {
    let settings = Settings {
        view: "direct".to_owned(),
        ..ambient_occlusion(1)
    };
    let Some(mut window) = bare_with(settings) else {
        return;
    };
    wait(&mut window, "the picture", App::is_settled);
    let document = window.state().document().name().to_owned();
    let white = window.state().film().pixels().to_vec();
    let sky = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/studio.hdr");
    drop_file(&mut window, sky.clone());
    wait(&mut window, "the sky", |app| {
        app.is_settled() && app.film().pixels() != white
    });
    let app = window.state();
    assert_eq!(app.notice(), None);
    assert_eq!(app.settings().environment, EnvironmentSource::File);
    assert_eq!(app.settings().environment_file.as_ref(), Some(&sky));
    // One that can't be read is reported, and the light stays as it is.
    let lit = app.film().pixels().to_vec();
    let folder = tempfile::tempdir().expect("a folder");
    let broken = folder.path().join("broken.hdr");
    std::fs::write(&broken, b"#?RADIANCE\n\n-Y 64 +X 64\n").expect("written");
    for (path, name) in [
        (PathBuf::from("none.HDR"), "none.HDR"),
        (broken, "broken.hdr"),
    ] {
        drop_file(&mut window, path);
        wait(&mut window, "the error", |app| {
            app.notice().is_some_and(|text| text.contains(name))
        });
        wait(&mut window, "the picture", App::is_settled);
        let app = window.state();
        assert_eq!(app.settings().environment, EnvironmentSource::File);
        assert_eq!(app.settings().environment_file.as_ref(), Some(&sky));
        assert!(app.film().pixels() == lit);
        assert_eq!(app.document().name(), document);
    }
}

#[test]
fn a_kept_environment_that_cannot_be_read_gives_way_to_that_of_the_scene() {
    let settings = Settings {
        view: "direct".to_owned(),
        environment: EnvironmentSource::File,
        environment_file: Some("none.hdr".into()),
        ..ambient_occlusion(1)
    };
    let Some(mut window) = bare_with(settings) else {
        return;
    };
    wait(&mut window, "the error", |app| app.notice().is_some());
    let settings = window.state().settings();
    assert_eq!(settings.environment(), EnvironmentSource::Scene);
    assert_eq!(settings.environment_file, None);
}

/// A scene file with a sphere and these lights.
fn sphere(folder: &tempfile::TempDir, name: &str, lights: &str) -> PathBuf {
    let text = format!("<scene version='3.0.0'><shape type='sphere'/>{lights}</scene>");
    write(folder, name, &text)
}

#[test]
fn a_scene_with_an_environment_of_its_own_is_opened_in_it_and_others_in_the_chosen_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let own = sphere(&folder, "own.xml", "<emitter type='constant'/>");
    let dark = sphere(&folder, "dark.xml", "<emitter type='point'/>");
    let settings = Settings {
        view: "direct".to_owned(),
        environment: EnvironmentSource::Studio,
        ..ambient_occlusion(1)
    };
    let Some(mut window) = bare_with(settings) else {
        return;
    };
    let chosen = |window: &Window| window.state().settings().environment();
    drop_file(&mut window, own);
    let told = "This scene has an environment of its own, which is used instead of the studio";
    wait(&mut window, "the toast", |app| app.toasts() == [told]);
    settle(&mut window, "own.xml");
    assert_eq!(chosen(&window), EnvironmentSource::Scene);
    drop_file(&mut window, dark);
    settle(&mut window, "dark.xml");
    assert_eq!(chosen(&window), EnvironmentSource::Studio);
}

#[test]
fn another_picture_of_an_environment_is_not_rotated_by_the_angle_of_the_last_one() {
    let mut settings = Settings::default();
    settings.keep_environment_file(Path::new("a.hdr"));
    settings.environment_degrees = 30.0;
    settings.keep_environment_file(Path::new("a.hdr"));
    assert_eq!(settings.environment_degrees, 30.0);
    settings.keep_environment_file(Path::new("b.hdr"));
    assert_eq!(settings.environment_degrees, 0.0);
}

#[test]
fn an_offset_moves_scene_and_camera_while_spawn_policies_are_compared() {
    let settings = Settings {
        view: "spawning".to_owned(),
        spawn_offset: 1e6,
        ..ambient_occlusion(1)
    };
    let Some(mut window) = app_with(settings) else {
        return;
    };
    wait(&mut window, "the offset", |app| {
        app.document().origin().max_element() < -9e5 && app.is_settled()
    });
    let in_file = |app: &App| app.turntable().pivot + app.document().origin();
    assert!(in_file(window.state()).length() < 1e3);
    let film = window.state().film();
    let UVec2 { x, y } = film.size();
    let mut pixels = (0..y).flat_map(|y| (0..x).map(move |x| UVec2::new(x, y)));
    assert!(
        pixels.any(|at| film.shows_surface(at)),
        "the camera follows"
    );
    // Other views show the scene as it is in the file.
    window.get_by_label("Normal").click();
    wait(&mut window, "no offset", |app| {
        app.document().origin().min_element() > -9e5 && app.is_settled()
    });
    assert!(in_file(window.state()).length() < 1e3);
}

#[test]
fn an_offset_of_a_scene_with_other_shapes_is_refused_with_a_message() {
    let folder = tempfile::tempdir().expect("a folder");
    let settings = Settings {
        view: "spawning".to_owned(),
        spawn_offset: 1e6,
        ..ambient_occlusion(1)
    };
    let Some(mut window) = bare_with(settings) else {
        return;
    };
    drop_file(&mut window, sphere(&folder, "sphere.xml", ""));
    wait(&mut window, "the message", |app| {
        app.toasts()
            .iter()
            .any(|text| text.starts_with("Only the coordinates of triangle meshes"))
    });
    settle(&mut window, "sphere.xml");
    assert!(window.state().document().origin().length() < 1e3);
}

#[test]
fn brightness_and_exposure_stay_within_the_films_range() {
    let folder = tempfile::tempdir().expect("a folder");
    let sky = folder.path().join("sky.hdr");
    let mut bytes = b"#?RADIANCE\n\n-Y 2 +X 1\n".to_vec();
    // 128/256 · 2⁴⁷, a quarter of the film's limit.
    bytes.extend([128, 128, 128, 175, 0, 0, 0, 0]);
    std::fs::write(&sky, bytes).expect("written");
    let settings = Settings {
        view: "direct".to_owned(),
        environment: EnvironmentSource::File,
        environment_file: Some(sky),
        environment_brightness: 100.0,
        exposure_stops: -100.0,
        ..ambient_occlusion(1)
    };
    let Some(mut window) = app_with(settings) else {
        return;
    };
    wait(&mut window, "the picture", App::is_settled);
    window.run_steps(2);
    let settings = window.state().settings();
    assert_eq!(settings.environment_brightness, 4.0);
    assert_eq!(settings.exposure_stops, *EXPOSURES.start());
    let brightest = 2f32.powi(46) * settings.environment_brightness;
    assert_eq!(brightest, MAX_BRIGHTNESS);
}
