//! The menu *View*: the picture and its overlay.

use super::keys::{key, shift};
use super::{Command, Commands, Entry, Menu, Place, all, lacks_scene, none};
use crate::app::App;
use crate::overlay::grid::GRID;
use crate::overlay::wireframe::WIREFRAME;
use crate::overlay::{OverlaySpec, switches};
use crate::quality::{QUALITY, Quality};
use egui::Key;
use hitscope_core::integrator::{INTEGRATORS, Integrator};
use hitscope_core::kernel::{KernelInfo, TRIANGLE_KERNELS};

/// The views.
pub const VIEWS: Place = Place::submenu(Menu::View, 0, "View as");
const VIEW_STEPS: Place = Place::new(Menu::View, 0);
const SHADING: Place = Place::new(Menu::View, 1);
const LINES: Place = Place::new(Menu::View, 2);
const OVERLAYS: Place = Place::submenu(Menu::View, 2, "Overlay");
const REFINEMENT: Place = Place::new(Menu::View, 3);
/// The quality levels, from a draft to a reference.
pub const QUALITIES: Place = Place::submenu(Menu::View, 4, "Quality");
const KERNELS: Place = Place::submenu(Menu::View, 4, "Kernel");

const MAGNIFIER: Place = Place::new(Menu::View, 8);

/// The commands of the magnifier, after those of the parts.
pub(super) const MAGNIFIER_ROWS: &[Command] = &[
    Command {
        name: "magnify",
        keys: &[key(Key::Z)],
        title: "Magnify the picture",
        tooltip: "Enlarges the pixels at the pointer without moving the camera. Ctrl+Shift+scroll sets the factor",
        place: MAGNIFIER,
        is_on: Some(|app| app.magnification() > 1.0),
        obstacle: lacks_scene,
        run: |app, ctx, _| app.toggle_magnifier(ctx),
    },
    Command {
        name: "pixel-values",
        keys: &[],
        title: "Pixel values",
        tooltip: "Shows the view's numbers in the pixels of the magnified picture",
        place: MAGNIFIER,
        is_on: Some(|app| app.shown.magnifier.values.is_on),
        obstacle: none,
        run: |app, _, _| app.shown.magnifier.values.is_on ^= true,
    },
    Command {
        name: "exact-pixel-values",
        keys: &[],
        title: "Exact pixel values",
        tooltip: "Shows pixel values with all bits, as hexadecimal floats",
        place: MAGNIFIER,
        is_on: Some(|app| app.shown.magnifier.values.is_exact),
        obstacle: none,
        run: |app, _, _| app.shown.magnifier.values.is_exact ^= true,
    },
];

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "next-view",
        keys: &[key(Key::V)],
        title: "Next view",
        tooltip: "Shows the next view of the list",
        place: VIEW_STEPS,
        is_on: None,
        obstacle: none,
        run: |app, _, _| step_view(app, 1),
    },
    Command {
        name: "previous-view",
        keys: &[shift(Key::V)],
        title: "Previous view",
        tooltip: "Shows the previous view of the list",
        place: VIEW_STEPS,
        is_on: None,
        obstacle: none,
        run: |app, _, _| step_view(app, -1),
    },
    Command {
        name: "smooth",
        keys: &[key(Key::S)],
        title: "Smooth shading",
        tooltip: "Interpolates normals over each face; flat shading uses the normals of faces",
        place: SHADING,
        is_on: Some(|app| app.seen.settings.is_smooth),
        obstacle: none,
        run: |app, _, _| app.seen.settings.is_smooth ^= true,
    },
    Command {
        name: "wireframe",
        keys: &[key(Key::W), key(Key::E)],
        title: "Wireframe",
        tooltip: "Draws the edges of faces over the picture",
        place: LINES,
        is_on: Some(|app| app.seen.settings.overlays.is_on(&WIREFRAME)),
        obstacle: none,
        run: |app, _, _| app.seen.settings.overlays.toggle(&WIREFRAME),
    },
    Command {
        name: "normals",
        keys: &[key(Key::N)],
        title: "Normals",
        tooltip: "Draws the normals of faces, or those of vertices with smooth shading",
        place: LINES,
        is_on: Some(|app| app.seen.settings.shows_normals()),
        obstacle: none,
        run: |app, _, _| app.seen.settings.toggle_normals(),
    },
    Command {
        name: "grid",
        keys: &[key(Key::G)],
        title: GRID.title,
        tooltip: GRID.about,
        place: OVERLAYS,
        is_on: Some(|app| app.seen.settings.overlays.is_on(&GRID)),
        obstacle: none,
        run: |app, _, _| app.seen.settings.overlays.toggle(&GRID),
    },
    Command {
        name: "noise",
        keys: &[],
        title: "Noise",
        tooltip: "Shows the standard error of each pixel, in percent of white",
        place: REFINEMENT,
        is_on: Some(|app| app.seen.settings.shows_noise),
        obstacle: |app| {
            let lacks_light = !app.seen.settings.view().needs.lights;
            lacks_light.then_some("Only views that trace light have noise")
        },
        run: |app, _, _| app.seen.settings.shows_noise ^= true,
    },
    Command {
        name: "pause",
        keys: &[key(Key::P)],
        title: "Pause",
        tooltip: "Pauses the refinement of the picture",
        place: REFINEMENT,
        is_on: Some(App::is_paused),
        obstacle: none,
        run: |app, _, _| app.traced.tracer.toggle_pause(),
    },
];

/// Shows the view that is `step` places further down the list. The first view follows the last.
fn step_view(app: &mut App, step: isize) {
    let current = app.seen.settings.view().name;
    let index = INTEGRATORS.iter().position(|view| view.name == current);
    let next = index.unwrap_or(0) as isize + step;
    let next = next.rem_euclid(INTEGRATORS.len() as isize) as usize;
    app.seen.settings.keep_view(INTEGRATORS[next].name);
}

/// All views.
pub(super) fn views(app: &App) -> Vec<Entry> {
    let current = app.seen.settings.view();
    let entry = |view: &&'static Integrator| {
        let name = view.name;
        let is_chosen = name == current.name;
        let choose = move |app: &mut App, _: &egui::Context| app.seen.settings.keep_view(name);
        Entry::choice(VIEWS, view.title, view.about, is_chosen, choose)
    };
    INTEGRATORS.iter().map(entry).collect()
}

/// The overlays that have no row of their own.
pub(super) fn overlays(app: &App) -> Vec<Entry> {
    let has_row = |overlay: &OverlaySpec| all().any(|row| row.name == overlay.name);
    let others = switches().filter(|overlay| !has_row(overlay));
    let entry = |overlay: &'static OverlaySpec| {
        let is_on = app.seen.settings.overlays.is_on(overlay);
        let toggle =
            move |app: &mut App, _: &egui::Context| app.seen.settings.overlays.toggle(overlay);
        Entry::choice(OVERLAYS, overlay.title, overlay.about, is_on, toggle)
    };
    others.map(entry).collect()
}

impl Commands {
    /// The command that turns an overlay on and off; `None` if the overlay has no switch.
    pub fn overlay(&self, overlay: &OverlaySpec) -> Option<&Entry> {
        let is_of_overlay = |entry: &&Entry| match entry.row {
            Some(row) => row.name == overlay.name,
            None => entry.place == OVERLAYS && entry.title == overlay.title,
        };
        self.entries().iter().find(is_of_overlay)
    }
}

/// The quality levels, from a draft to a reference.
pub(super) fn qualities(app: &App) -> Vec<Entry> {
    let current = Quality::of(&app.seen.settings).map(|quality| quality.title);
    let entry = |quality: &'static Quality| {
        let choose = move |app: &mut App, _: &egui::Context| quality.apply(&mut app.seen.settings);
        let is_chosen = current == Some(quality.title);
        Entry::choice(QUALITIES, quality.title, quality.about, is_chosen, choose)
    };
    QUALITY.iter().map(entry).collect()
}

/// The kernels that serve a tier, by the name of the tier.
pub(super) fn kernels(app: &App) -> Vec<Entry> {
    let current = app.seen.settings.kernel();
    let tiers = TRIANGLE_KERNELS.iter().map(|row| row.info);
    let tiers = tiers.filter(|info| info.tier.is_some());
    let entry = |info: &'static KernelInfo| {
        let (title, name) = (info.short_name(), info.name);
        let is_chosen = current.info.short_name() == title;
        let choose = move |app: &mut App, _: &egui::Context| app.seen.settings.keep_kernel(name);
        Entry::choice(KERNELS, title, info.summary, is_chosen, choose)
    };
    tiers.map(entry).collect()
}
