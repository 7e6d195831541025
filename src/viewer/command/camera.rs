//! The menu *Camera*.

use super::keys::{ctrl, key, shift};
use super::{Command, Entry, Menu, Place, lacks_scene, none};
use crate::app::App;
use crate::bindings::{PRESETS, Preset};
use egui::Key;
use hitscope_core::camera::{StandardView, UpAxis};

const FRAME: Place = Place::new(Menu::Camera, 0);
const DIRECTION: Place = Place::submenu(Menu::Camera, 1, "Look from");
const ORBIT: Place = Place::submenu(Menu::Camera, 1, "Orbit");
const PROJECTION: Place = Place::new(Menu::Camera, 2);
const UP_AXIS: Place = Place::new(Menu::Camera, 3);
const NAVIGATION: Place = Place::new(Menu::Camera, 4);
/// The sets of pointer bindings.
pub const BINDINGS: Place = Place::submenu(Menu::Camera, 4, "Mouse");

/// The step of the keys that orbit, in degrees.
const ORBIT_STEP: f64 = 15.0;

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "frame",
        keys: &[key(Key::Home), key(Key::Enter)],
        title: "Frame",
        tooltip: "Frames the whole scene; for a scene file, returns to the view of its sensor first",
        place: FRAME,
        is_on: None,
        obstacle: none,
        run: |app, ctx, _| app.animated(ctx, App::frame),
    },
    Command {
        name: "frame-pick",
        keys: &[key(Key::Period)],
        title: "Frame pick",
        tooltip: "Frames the triangle or shape that is picked",
        place: FRAME,
        is_on: None,
        obstacle: App::lacks_hit,
        run: |app, ctx, _| app.animated(ctx, App::frame_pick),
    },
    Command {
        name: "frame-part",
        keys: &[shift(Key::Period)],
        title: "Frame part",
        tooltip: "Frames the group or object of the triangle that is picked",
        place: FRAME,
        is_on: None,
        obstacle: App::lacks_hit,
        run: |app, ctx, _| app.frame_part(ctx),
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
        run: |app, ctx, _| app.animated(ctx, App::use_first_camera),
    },
    look_from(
        "front",
        &[key(Key::Num1)],
        "Front",
        "Looks from the front",
        |app, ctx, _| app.look_from(StandardView::Front, ctx),
    ),
    look_from(
        "back",
        &[ctrl(Key::Num1)],
        "Back",
        "Looks from behind",
        |app, ctx, _| app.look_from(StandardView::Back, ctx),
    ),
    look_from(
        "right",
        &[key(Key::Num3)],
        "Right",
        "Looks from the right",
        |app, ctx, _| app.look_from(StandardView::Right, ctx),
    ),
    look_from(
        "left",
        &[ctrl(Key::Num3)],
        "Left",
        "Looks from the left",
        |app, ctx, _| app.look_from(StandardView::Left, ctx),
    ),
    look_from(
        "top",
        &[key(Key::Num7)],
        "Top",
        "Looks from above",
        |app, ctx, _| app.look_from(StandardView::Top, ctx),
    ),
    look_from(
        "bottom",
        &[ctrl(Key::Num7)],
        "Bottom",
        "Looks from below",
        |app, ctx, _| app.look_from(StandardView::Bottom, ctx),
    ),
    look_from(
        "isometric",
        &[key(Key::Num9)],
        "Isometric",
        "Looks from above, the front and the right",
        |app, ctx, _| app.look_from(StandardView::Isometric, ctx),
    ),
    orbit(
        "orbit-left",
        &[key(Key::Num4)],
        "Orbit left",
        "Orbits 15° to the left",
        |app, ctx, _| app.orbit_by(-ORBIT_STEP, 0.0, ctx),
    ),
    orbit(
        "orbit-right",
        &[key(Key::Num6)],
        "Orbit right",
        "Orbits 15° to the right",
        |app, ctx, _| app.orbit_by(ORBIT_STEP, 0.0, ctx),
    ),
    orbit(
        "orbit-up",
        &[key(Key::Num8)],
        "Orbit up",
        "Orbits 15° upwards",
        |app, ctx, _| app.orbit_by(0.0, ORBIT_STEP, ctx),
    ),
    orbit(
        "orbit-down",
        &[key(Key::Num2)],
        "Orbit down",
        "Orbits 15° downwards",
        |app, ctx, _| app.orbit_by(0.0, -ORBIT_STEP, ctx),
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
    switch(
        "trackball",
        "Trackball",
        "Orbits freely over the poles; otherwise the horizon stays level",
        |app| app.preferences.navigation.is_trackball,
        |app, ctx, _| app.toggle_trackball(ctx),
    ),
    switch(
        "orbit-about-cursor",
        "Orbit about the cursor",
        "Orbits about the surface where the drag starts instead of the pivot",
        |app| app.preferences.navigation.orbits_about_cursor,
        |app, _, _| app.preferences.navigation.orbits_about_cursor ^= true,
    ),
    switch(
        "trackpad",
        "Trackpad",
        "Two fingers orbit, with Shift they pan, with Ctrl they zoom",
        |app| app.preferences.navigation.is_trackpad,
        |app, _, _| app.preferences.navigation.is_trackpad ^= true,
    ),
    switch(
        "reduced-motion",
        "Reduced motion",
        "Changes the view at once instead of moving the camera there",
        |app| app.preferences.navigation.reduces_motion,
        |app, _, _| app.preferences.navigation.reduces_motion ^= true,
    ),
    switch(
        "gizmo",
        "Axis gizmo",
        "Shows the axes in a corner of the picture; a click on an end looks from there",
        |app| app.preferences.navigation.shows_gizmo,
        |app, _, _| app.preferences.navigation.shows_gizmo ^= true,
    ),
];

/// The sets of pointer bindings.
pub(super) fn presets(app: &App) -> Vec<Entry> {
    let current = app.preferences.navigation.preset().name;
    let entry = |preset: &'static Preset| {
        let choose = move |app: &mut App, _: &egui::Context| {
            preset
                .name
                .clone_into(&mut app.preferences.navigation.preset);
        };
        let is_chosen = preset.name == current;
        Entry::choice(BINDINGS, preset.title, preset.about, is_chosen, choose)
    };
    PRESETS.iter().map(entry).collect()
}

/// A command that turns an option of navigation on and off.
const fn switch(
    name: &'static str,
    title: &'static str,
    tooltip: &'static str,
    is_on: fn(&App) -> bool,
    run: fn(&mut App, &egui::Context, &eframe::Frame),
) -> Command {
    Command {
        name,
        keys: &[],
        title,
        tooltip,
        place: NAVIGATION,
        is_on: Some(is_on),
        obstacle: none,
        run,
    }
}

/// A command that orbits by a step.
const fn orbit(
    name: &'static str,
    keys: &'static [egui::KeyboardShortcut],
    title: &'static str,
    tooltip: &'static str,
    run: fn(&mut App, &egui::Context, &eframe::Frame),
) -> Command {
    Command {
        place: ORBIT,
        ..look_from(name, keys, title, tooltip, run)
    }
}

/// A command that looks from another direction.
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
