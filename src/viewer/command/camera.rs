//! The menu *Camera*.

use super::keys::{ctrl, key, shift};
use super::{Command, Menu, Place, lacks_scene, none};
use crate::app::App;
use egui::Key;
use hitscope_core::camera::{StandardView, UpAxis};

const FRAME: Place = Place::new(Menu::Camera, 0);
const DIRECTION: Place = Place::new(Menu::Camera, 1);
const PROJECTION: Place = Place::new(Menu::Camera, 2);
const UP_AXIS: Place = Place::new(Menu::Camera, 3);

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "frame",
        keys: &[key(Key::Home)],
        title: "Frame",
        tooltip: "Frames the whole scene; for a scene file, returns to the view of its sensor first",
        place: FRAME,
        is_on: None,
        obstacle: none,
        run: |app, _, _| app.frame(),
    },
    Command {
        name: "frame-pick",
        keys: &[key(Key::Period)],
        title: "Frame pick",
        tooltip: "Frames the triangle or shape that is picked",
        place: FRAME,
        is_on: None,
        obstacle: App::lacks_hit,
        run: |app, _, _| app.frame_pick(),
    },
    Command {
        name: "go-to",
        keys: &[ctrl(Key::G)],
        title: "Go to element",
        tooltip: "Frames and picks a triangle, a face, a vertex, a line of the file or a point by its number or coordinates",
        place: FRAME,
        is_on: None,
        obstacle: lacks_scene,
        run: |app, _, _| app.show_go_to(),
    },
    Command {
        name: "first-view",
        keys: &[shift(Key::Home)],
        title: "First view",
        tooltip: "Returns to the view in which the file was opened",
        place: FRAME,
        is_on: None,
        obstacle: none,
        run: |app, _, _| app.use_first_camera(),
    },
    look_from(
        "front",
        &[key(Key::Num1)],
        "Front",
        "Looks from the front",
        |app, _, _| app.seen.turntable.look_from(StandardView::Front),
    ),
    look_from(
        "back",
        &[ctrl(Key::Num1)],
        "Back",
        "Looks from behind",
        |app, _, _| app.seen.turntable.look_from(StandardView::Back),
    ),
    look_from(
        "right",
        &[key(Key::Num3)],
        "Right",
        "Looks from the right",
        |app, _, _| app.seen.turntable.look_from(StandardView::Right),
    ),
    look_from(
        "left",
        &[ctrl(Key::Num3)],
        "Left",
        "Looks from the left",
        |app, _, _| app.seen.turntable.look_from(StandardView::Left),
    ),
    look_from(
        "top",
        &[key(Key::Num7)],
        "Top",
        "Looks from above",
        |app, _, _| app.seen.turntable.look_from(StandardView::Top),
    ),
    look_from(
        "bottom",
        &[ctrl(Key::Num7)],
        "Bottom",
        "Looks from below",
        |app, _, _| app.seen.turntable.look_from(StandardView::Bottom),
    ),
    Command {
        name: "orthographic",
        keys: &[key(Key::Num5)],
        title: "Orthographic",
        tooltip: "Projects along parallel rays instead of in perspective",
        place: PROJECTION,
        is_on: Some(|app| app.seen.turntable.is_orthographic),
        obstacle: none,
        run: |app, _, _| app.seen.turntable.is_orthographic ^= true,
    },
    Command {
        name: "auto-rotation",
        keys: &[key(Key::T)],
        title: "Auto-rotation",
        tooltip: "Rotates the camera around the scene",
        place: PROJECTION,
        is_on: Some(App::is_rotating),
        obstacle: none,
        run: |app, _, _| app.seen.is_rotating ^= true,
    },
    Command {
        name: "y-up",
        keys: &[],
        title: "Y up",
        tooltip: "Turns the y axis of the file up",
        place: UP_AXIS,
        is_on: Some(|app| app.seen.settings.up_axis() == UpAxis::Y),
        obstacle: none,
        run: |app, _, _| app.seen.turn_up(UpAxis::Y),
    },
    Command {
        name: "z-up",
        keys: &[],
        title: "Z up",
        tooltip: "Turns the z axis of the file up",
        place: UP_AXIS,
        is_on: Some(|app| app.seen.settings.up_axis() == UpAxis::Z),
        obstacle: none,
        run: |app, _, _| app.seen.turn_up(UpAxis::Z),
    },
];

/// A command that looks along an axis.
const fn look_from(
    name: &'static str,
    keys: &'static [egui::KeyboardShortcut],
    title: &'static str,
    tooltip: &'static str,
    run: fn(&mut App, &egui::Context, &eframe::Frame),
) -> Command {
    Command {
        name,
        keys,
        title,
        tooltip,
        place: DIRECTION,
        is_on: None,
        obstacle: none,
        run,
    }
}
