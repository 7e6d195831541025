//! Commands of the clip, in the menus *View* and *Pick*.

use super::{Command, Menu, Place, lacks_scene};
use crate::app::App;
use crate::clip_choice::ClipShape;
use glam::DVec3;

const CLIP: Place = Place::submenu(Menu::View, 5, "Clip");
const AT_PICK: Place = Place::new(Menu::Pick, 4);

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "clip-plane",
        keys: &[],
        title: "By a plane",
        tooltip: "Shows only what lies on one side of a plane",
        place: CLIP,
        is_on: Some(|app| app.seen.settings.clip.shape == ClipShape::Plane),
        obstacle: lacks_scene,
        run: |app, _, _| app.toggle_clip(ClipShape::Plane),
    },
    Command {
        name: "clip-box",
        keys: &[],
        title: "By a box",
        tooltip: "Shows only the inside of a box",
        place: CLIP,
        is_on: Some(|app| app.seen.settings.clip.shape == ClipShape::Box),
        obstacle: lacks_scene,
        run: |app, _, _| app.toggle_clip(ClipShape::Box),
    },
    Command {
        name: "clip-x",
        keys: &[],
        title: "Across x",
        tooltip: "Turns the plane's normal to the x axis",
        place: CLIP,
        is_on: None,
        obstacle: App::lacks_clip_plane,
        run: |app, _, _| app.turn_clip(DVec3::X),
    },
    Command {
        name: "clip-y",
        keys: &[],
        title: "Across y",
        tooltip: "Turns the plane's normal to the y axis",
        place: CLIP,
        is_on: None,
        obstacle: App::lacks_clip_plane,
        run: |app, _, _| app.turn_clip(DVec3::Y),
    },
    Command {
        name: "clip-z",
        keys: &[],
        title: "Across z",
        tooltip: "Turns the plane's normal to the z axis",
        place: CLIP,
        is_on: None,
        obstacle: App::lacks_clip_plane,
        run: |app, _, _| app.turn_clip(DVec3::Z),
    },
    Command {
        name: "clip-view",
        keys: &[],
        title: "Across the view",
        tooltip: "Turns the plane's normal to the camera, so that the plane removes what is in front of it",
        place: CLIP,
        is_on: None,
        obstacle: App::lacks_clip_plane,
        run: |app, _, _| app.turn_clip_to_view(),
    },
    Command {
        name: "clip-flip",
        keys: &[],
        title: "Flip the plane",
        tooltip: "Shows the other side of the plane",
        place: CLIP,
        is_on: None,
        obstacle: App::lacks_clip_plane,
        run: |app, _, _| app.seen.settings.clip.flip(),
    },
    Command {
        name: "clip-fit",
        keys: &[],
        title: "Fit the box to the scene",
        tooltip: "Makes the box as large as the scene",
        place: CLIP,
        is_on: None,
        obstacle: App::lacks_clip_box,
        run: |app, _, _| app.fit_clip_box(),
    },
];

pub(super) const PICK_ROWS: &[Command] = &[Command {
    name: "clip-at-pick",
    keys: &[],
    title: "Clip at the pick",
    tooltip: "Clips by the plane that touches the surface at the picked point, and removes the side of the camera",
    place: AT_PICK,
    is_on: None,
    obstacle: App::lacks_hit,
    run: |app, _, _| app.clip_at_pick(),
}];
