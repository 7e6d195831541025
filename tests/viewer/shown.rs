//! Tests of the part of the scene that is shown, by clip and by parts, and of the legend in the picture.

use crate::harness::{Window, app_started, click, in_picture, wait};
use crate::pointer::on_the_knot;
use egui::{Event, Key};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec3, UVec2};
use hitscope::app::{App, StartOptions};
use hitscope::preferences::Preferences;
use hitscope::settings::Settings;
use hitscope::tab::Tab;
use hitscope_core::Hit;
use hitscope_core::plan::Plan;

/// The built-in scene in a view with one sample per pixel, with a tab of the side panel.
fn window(view: &str, tab: Tab) -> Option<Window> {
    let start = StartOptions {
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
    };
    let mut window = app_started(start)?;
    settle(&mut window);
    Some(window)
}

fn settle(window: &mut Window) {
    window.run_steps(3);
    wait(window, "the picture", App::is_settled);
}

fn press_button(window: &mut Window, label: &str) {
    window.get_by_label(label).scroll_to_me();
    window.run_steps(10);
    window.get_by_label(label).click();
    settle(window);
}

/// Replaces the number in a field.
fn type_number(window: &mut Window, label: &str, text: &str) {
    window.get_by_label(label).scroll_to_me();
    window.run_steps(10);
    window.get_by_label(label).click();
    window.run_steps(2);
    window.event(Event::Text(text.to_owned()));
    window.run_steps(2);
    window.key_press(Key::Enter);
    window.run_steps(3);
}

fn pixels(window: &Window) -> Vec<[u8; 4]> {
    window.state().film().pixels().to_vec()
}

/// The hit of each pixel's ray.
fn hits(window: &Window) -> Vec<Option<Hit>> {
    let app = window.state();
    let camera = app.shown_camera().expect("a picture");
    let size = camera.resolution();
    let pixels = (0..size.y).flat_map(|y| (0..size.x).map(move |x| UVec2::new(x, y)));
    let hit = |pixel| {
        let ray = camera.ray(pixel, Plan::position(pixel, 0));
        app.document().intersector().closest_hit(&ray)
    };
    pixels.map(hit).collect()
}

/// The number of pixels that show a surface.
fn count(hits: &[Option<Hit>]) -> usize {
    hits.iter().flatten().count()
}

#[test]
fn a_plane_removes_a_part_of_the_picture_and_picks_obey_it() {
    let Some(mut window) = window("triangle", Tab::Display) else {
        return;
    };
    let (before, whole) = (hits(&window), pixels(&window));
    press_button(&mut window, "By a plane");
    let after = hits(&window);
    let part = count(&after) as f64 / count(&before) as f64;
    assert!((0.2..0.8).contains(&part), "{part}");
    let clipped = pixels(&window);
    assert!(clipped != whole);

    // A pixel whose surface is removed.
    let camera = window.state().shown_camera().expect("a picture");
    let size = camera.resolution();
    let removed = (0..before.len()).filter(|&k| before[k] != after[k]);
    let middle = removed.clone().nth(removed.count() / 2).expect("removed");
    let pixel = UVec2::new(middle as u32 % size.x, middle as u32 / size.x);
    let at = (pixel.as_vec2() + 0.5) / size.as_vec2();
    let at = in_picture(&window, at.x, at.y);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    let app = window.state();
    let clip = &app.settings().clip;
    let inspection = app.inspection().expect("a pick");
    for crossing in &inspection.crossings {
        // Positions are rounded.
        let beyond = clip.normal.dot(DVec3::from_array(crossing.position)) - clip.offset;
        assert!(beyond < 1e-5, "{beyond}");
    }
    let hit = inspection.hit.as_ref().map(|hit| hit.primitive);
    assert_ne!(hit, before[middle].map(|hit| hit.primitive));

    window.get_by_label("Display").click();
    window.run_steps(2);
    press_button(&mut window, "Flip the plane");
    let other = count(&hits(&window)) as f64 / count(&before) as f64;
    assert!((0.2..0.9).contains(&other), "{other}");
    press_button(&mut window, "By a plane");
    assert!(pixels(&window) == whole);
}

#[test]
fn a_number_that_gives_no_clip_leaves_the_old_one() {
    let Some(mut window) = window("triangle", Tab::Display) else {
        return;
    };
    press_button(&mut window, "By a plane");
    let before = window.state().settings().clip.clone();
    for (field, text) in [
        ("Exact offset", "nan"),
        ("Exact offset", "1e400"),
        ("Exact offset", "-inf"),
        ("Normal: x", "0"),
        ("Normal: x", "nan"),
        ("Normal: y", "inf"),
    ] {
        type_number(&mut window, field, text);
        let app = window.state();
        assert_eq!(app.settings().clip, before, "{field}: {text}");
        assert_eq!(app.notice(), None, "{field}: {text}");
    }
    // Begins with a zero.
    type_number(&mut window, "Normal: x", "0.5");
    assert_eq!(window.state().settings().clip.normal, DVec3::X * 0.5);
    type_number(&mut window, "Exact offset", "0.25");
    assert_eq!(window.state().settings().clip.offset, 0.25);
}

#[test]
fn the_plane_at_a_pick_removes_the_side_of_the_camera() {
    let Some(mut window) = window("triangle", Tab::Display) else {
        return;
    };
    let (x, y) = on_the_knot(&window);
    let at = in_picture(&window, x, y);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    let inspection = window.state().inspection().expect("a pick").clone();
    let point = DVec3::from_array(inspection.hit.expect("the middle shows the mesh").position);
    window.get_by_label("Display").click();
    window.run_steps(2);
    press_button(&mut window, "Clip at the pick");
    let app = window.state();
    let clip = app.settings().clip.clone();
    let kept = clip.clip().expect("a clip").expect("a plane");
    let eye = app.turntable().camera(UVec2::new(4, 3)).exact_eye();
    let origin = app.document().loaded.scene.mesh().origin();
    assert!(!kept.keeps(eye + origin));
    // The surface itself stays.
    assert!(kept.keeps(point));
    assert!((clip.normal.dot(point) - clip.offset).abs() < 1e-5);
}

#[test]
fn only_pictures_of_numbers_have_a_legend() {
    for (view, has_legend) in [("depth", true), ("normal", false), ("cost", true)] {
        let Some(mut window) = window(view, Tab::Display) else {
            return;
        };
        let legend = |window: &Window| window.query_by_label_contains("Legend: ").is_some();
        assert_eq!(legend(&window), has_legend, "{view}");
        assert_eq!(window.state().legend().is_some(), has_legend, "{view}");
        if has_legend {
            press_button(&mut window, "Legend in the picture");
            assert!(!legend(&window), "{view}");
        }
    }
}

#[test]
fn the_range_of_the_numbers_in_the_picture_and_a_colour_map_change_the_scale() {
    let Some(mut window) = window("depth", Tab::Display) else {
        return;
    };
    let (of_view, before) = (window.state().legend(), pixels(&window));
    window.get_by_label("Fit range").scroll_to_me();
    window.run_steps(10);
    window.get_by_label("Fit range").click();
    wait(&mut window, "the range", |app| {
        !app.settings().colours.scales.is_empty()
    });
    settle(&mut window);
    let fitted = window.state().legend();
    assert_ne!(fitted, of_view);
    assert!(pixels(&window) != before);
    press_button(&mut window, "Own range");
    assert_eq!(window.state().legend(), of_view);
    assert!(pixels(&window) == before);
}

#[test]
fn a_hidden_part_is_in_no_pixel_and_the_others_keep_theirs() {
    let Some(mut window) = window("triangle", Tab::Parts) else {
        return;
    };
    let is_knot = |window: &Window, hit: Option<Hit>| {
        let mesh = window.state().document().loaded.scene.mesh();
        let group = hit.and_then(|hit| mesh.attributes().groups.of(hit.primitive));
        group.is_some_and(|group| group == "knot")
    };
    let (before, whole) = (hits(&window), pixels(&window));
    let knots = before.iter().filter(|&&hit| is_knot(&window, hit)).count();
    assert!(knots > 100, "{knots}");
    press_button(&mut window, "Show knot");
    let (after, part) = (hits(&window), pixels(&window));
    assert!(!after.iter().any(|&hit| is_knot(&window, hit)));
    for (k, &hit) in before.iter().enumerate() {
        if is_knot(&window, hit) {
            assert_ne!(whole[k], part[k], "{k}");
        } else {
            assert_eq!(hit, after[k], "all bits of {k}");
            assert_eq!(whole[k], part[k], "{k}");
        }
    }
    press_button(&mut window, "Show all parts");
    assert!(pixels(&window) == whole);
    assert_eq!(hits(&window), before);
}

#[test]
fn a_part_is_shown_alone_and_a_search_shortens_the_list() {
    let Some(mut window) = window("triangle", Tab::Parts) else {
        return;
    };
    press_button(&mut window, "Show only gem");
    let groups = |window: &Window| {
        let mesh = window.state().document().loaded.scene.mesh();
        let group = |hit: Hit| mesh.attributes().groups.of(hit.primitive).cloned();
        let mut groups: Vec<_> = hits(window).into_iter().flatten().map(group).collect();
        groups.sort();
        groups.dedup();
        groups
    };
    assert_eq!(groups(&window), [Some("gem".to_owned())]);
    press_button(&mut window, "Invert shown parts");
    assert!(!groups(&window).contains(&Some("gem".to_owned())));
    window.get_by_label("Search for a part").focus();
    window.run_steps(2);
    window.get_by_label("Search for a part").type_text("KNO");
    // A background task searches.
    for _ in 0..1000 {
        window.step();
        if window.query_by_label("floor").is_none() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(window.query_by_label("knot").is_some());
    assert!(window.query_by_label("floor").is_none());
}

#[test]
fn the_picked_part_is_hidden_by_a_command() {
    let Some(mut window) = window("triangle", Tab::Parts) else {
        return;
    };
    let (x, y) = on_the_knot(&window);
    let at = in_picture(&window, x, y);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    let group = |window: &Window| {
        let hit = window.state().inspection()?.hit.as_ref()?;
        Some(hit.group.clone())
    };
    let picked = group(&window).expect("the middle shows the mesh");
    window.get_by_label("Parts").click();
    window.run_steps(2);
    assert!(window.query_by_label("picked").is_some());
    press_button(&mut window, "Hide the picked part");
    wait(&mut window, "the next pick", |app| {
        let hit = app.inspection().and_then(|pick| pick.hit.as_ref());
        hit.is_none_or(|hit| hit.group != picked)
    });
}

#[test]
fn an_empty_picture_offers_to_show_what_was_hidden() {
    let Some(mut window) = window("triangle", Tab::Parts) else {
        return;
    };
    let whole = pixels(&window);
    for part in ["floor", "knot", "gem", "shell"] {
        press_button(&mut window, &format!("Show {part}"));
    }
    assert_eq!(count(&hits(&window)), 0);
    wait(&mut window, "the hint", App::shows_nothing);
    window.run_steps(3);
    press_button(&mut window, "Show everything");
    assert!(pixels(&window) == whole);
}
