//! Navigation: drags and scrolling on the picture, flying, and animated changes of the view.

use super::App;
use super::canvas::Canvas;
use crate::bindings::Verb;
use egui::{Event, Key, MouseWheelUnit, PointerButton, Pos2, Response};
use glam::{DVec2, DVec3, UVec2};
use hitscope_core::camera::{StandardView, Turntable};
use std::f64::consts::FRAC_PI_2;

/// Time that a change of the view takes.
const TRANSITION_SECS: f64 = 0.25;

/// Scrolling by this zooms by a factor of e. A notch of the wheel, about 50 points, zooms by a fifth.
pub(super) const POINTS_PER_E: f32 = 220.0;

/// The keys of flying, and the directions to the right, up and back.
const FLIGHT_KEYS: [(Key, DVec3); 6] = [
    (Key::W, DVec3::NEG_Z),
    (Key::S, DVec3::Z),
    (Key::A, DVec3::NEG_X),
    (Key::D, DVec3::X),
    (Key::Q, DVec3::NEG_Y),
    (Key::E, DVec3::Y),
];

/// The state of navigation with the pointer.
#[derive(Default)]
pub(crate) struct Navigation {
    /// Where the drag in progress orbits about, if that isn't the pivot.
    centre: Option<DVec3>,
    flight: Flight,
    transition: Option<Transition>,
}

/// Flying with the right button held.
struct Flight {
    /// Whether the right button was pressed on the picture and is held.
    is_held: bool,
    /// Whether a key of flying was pressed since.
    is_flying: bool,
    /// Radii of the scene per second.
    speed: f64,
}

impl Default for Flight {
    fn default() -> Self {
        Self {
            is_held: false,
            is_flying: false,
            speed: 0.5,
        }
    }
}

/// A change of the view in progress.
struct Transition {
    from: Turntable,
    to: Turntable,
    /// By egui's clock.
    start_secs: f64,
    /// The state in the last frame. If the camera's state differs, something else has moved the camera.
    last: Turntable,
}

impl Navigation {
    /// Ends drags and flying.
    pub fn rest(&mut self) {
        self.centre = None;
        (self.flight.is_held, self.flight.is_flying) = (false, false);
    }

    /// Ends a change of the view: the camera is at its destination.
    pub fn end_transition(&mut self, turntable: &mut Turntable) {
        if let Some(transition) = self.transition.take() {
            *turntable = transition.to;
        }
    }

    /// Whether a change of the view is in progress.
    pub fn is_changing_view(&self) -> bool {
        self.transition.is_some()
    }
}

impl App {
    /// Changes the view by a short movement of the camera; at once with reduced motion, and before the first picture.
    pub(crate) fn animated(&mut self, ctx: &egui::Context, change: impl FnOnce(&mut Self)) {
        let from = self.seen.turntable;
        let last = self.navigation.transition.take();
        if let Some(last) = last.filter(|last| last.last == from) {
            self.seen.turntable = last.to;
        }
        change(self);
        let is_at_once =
            self.preferences.navigation.reduces_motion || self.traced.on_screen.is_none();
        if is_at_once || self.seen.turntable == from {
            return;
        }
        let to = self.seen.turntable;
        let from = from.towards(&to, 0.0);
        self.seen.turntable = from;
        self.navigation.transition = Some(Transition {
            from,
            to,
            start_secs: ctx.input(|input| input.time),
            last: from,
        });
        ctx.request_repaint();
    }

    /// Moves the camera on its way. Any other movement of the camera ends the transition where it is.
    pub(super) fn step_transition(&mut self, ctx: &egui::Context) {
        let Some(transition) = &mut self.navigation.transition else {
            return;
        };
        // It lasts one frame longer than the movement, so that all of it is one step of undo.
        let has_arrived = transition.last == transition.to;
        if has_arrived || transition.last != self.seen.turntable {
            self.navigation.transition = None;
            return;
        }
        let now = ctx.input(|input| input.time);
        let part = ((now - transition.start_secs) / TRANSITION_SECS).clamp(0.0, 1.0);
        let eased = part * part * (3.0 - 2.0 * part);
        self.seen.turntable = transition.from.towards(&transition.to, eased);
        transition.last = self.seen.turntable;
        ctx.request_repaint();
    }

    /// Looks along an axis.
    pub(crate) fn look_from(&mut self, view: StandardView, ctx: &egui::Context) {
        self.animated(ctx, |app| app.seen.turntable.look_from(view));
    }

    /// Orbits by angles in degrees, to the right and upwards. The pitch is limited to straight above and straight
    /// below.
    pub(crate) fn orbit_by(&mut self, right: f64, up: f64, ctx: &egui::Context) {
        self.animated(ctx, |app| {
            let turntable = &mut app.seen.turntable;
            turntable.turn(right.to_radians());
            let pitch = turntable.pitch_radians + up.to_radians();
            turntable.pitch_radians = pitch.clamp(-FRAC_PI_2, FRAC_PI_2);
        });
    }

    /// Switches between a turntable and a trackball. A turntable has a level horizon.
    pub(crate) fn toggle_trackball(&mut self, ctx: &egui::Context) {
        self.preferences.navigation.is_trackball ^= true;
        if !self.preferences.navigation.is_trackball {
            self.animated(ctx, |app| app.seen.turntable.roll_radians = 0.0);
        }
    }

    /// Handles drags, scrolling and flying.
    pub(super) fn navigate(&mut self, ui: &egui::Ui, response: &Response, canvas: Canvas) {
        self.drag(ui, response, canvas);
        if let Some(pos) = response.hover_pos() {
            self.scroll(ui, pos, canvas);
        }
        self.fly(ui, response);
    }

    fn drag(&mut self, ui: &egui::Ui, response: &Response, canvas: Canvas) {
        use PointerButton::{Middle, Primary, Secondary};
        let is_dragged = |button: &PointerButton| response.dragged_by(*button);
        let button = [Primary, Middle, Secondary].into_iter().find(is_dragged);
        let Some(button) = button else {
            self.navigation.centre = None;
            return;
        };
        if response.drag_started() {
            self.navigation.centre = self.centre_under_pointer(ui, canvas);
        }
        let points = response.drag_delta();
        if self.navigation.flight.is_flying {
            let drag = in_pixels(points, canvas);
            self.seen.turntable.look_around(drag, canvas.resolution);
            return;
        }
        let modifiers = ui.input(|input| input.modifiers);
        let (settings, has_map) = (&self.preferences.navigation, self.seen.settings.has_map());
        if let Some(verb) = settings.dragged(button, modifiers, has_map) {
            self.perform(verb, points, canvas);
        }
    }

    /// The surface where a drag starts, if drags orbit about it.
    fn centre_under_pointer(&self, ui: &egui::Ui, canvas: Canvas) -> Option<DVec3> {
        if !self.preferences.navigation.orbits_about_cursor {
            return None;
        }
        let start = ui.input(|input| input.pointer.press_origin())?;
        self.surface_along(&self.shown_at(start, canvas)?.ray())
    }

    /// Moves the camera by a movement on the screen.
    fn perform(&mut self, verb: Verb, points: egui::Vec2, canvas: Canvas) {
        /// A drag across the height of the picture zooms by e to this power.
        const E_PER_HEIGHT: f64 = 4.0;
        let (drag, resolution) = (in_pixels(points, canvas), canvas.resolution);
        match verb {
            Verb::Orbit => self.orbit(drag, resolution),
            Verb::Pan => self.seen.turntable.pan(drag, resolution),
            Verb::Zoom => {
                let part = drag.y / f64::from(resolution.y);
                let pivot = self.seen.turntable.pivot;
                self.seen.turntable.zoom((E_PER_HEIGHT * part).exp(), pivot);
            }
            Verb::RotateEnvironment => self.rotate_environment(points.x),
        }
    }

    fn orbit(&mut self, drag: DVec2, resolution: UVec2) {
        let is_free = self.preferences.navigation.is_trackball;
        let turn = |turntable: &mut Turntable| {
            if is_free {
                turntable.orbit_freely(drag, resolution);
            } else {
                turntable.orbit(drag, resolution);
            }
        };
        match self.navigation.centre {
            Some(centre) => self.seen.turntable.turn_about(centre, turn),
            None => turn(&mut self.seen.turntable),
        }
    }

    /// Zooms, moves as two fingers on a trackpad do, or sets the speed of flying.
    fn scroll(&mut self, ui: &egui::Ui, pos: Pos2, canvas: Canvas) {
        let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta(), input.zoom_delta()));
        let scrolled = (-(scroll.y + scroll.x) / POINTS_PER_E).exp();
        if self.navigation.flight.is_held {
            /// Radii of the scene per second.
            const SPEEDS: [f64; 2] = [1e-3, 1e2];
            let speed = self.navigation.flight.speed / f64::from(scrolled);
            self.navigation.flight.speed = speed.clamp(SPEEDS[0], SPEEDS[1]);
            return;
        }
        if self.preferences.navigation.is_trackpad {
            for (verb, points) in self.finger_movements(ui) {
                self.perform(verb, points, canvas);
            }
            self.zoom_at(pos, 1.0 / pinch, canvas);
        } else {
            self.zoom_at(pos, scrolled / pinch, canvas);
        }
    }

    /// The movements of two fingers since the last frame.
    fn finger_movements(&self, ui: &egui::Ui) -> Vec<(Verb, egui::Vec2)> {
        let line = ui
            .ctx()
            .options(|options| options.input_options.line_scroll_speed);
        let movement = |event: &Event| match *event {
            Event::MouseWheel {
                unit,
                delta,
                modifiers,
                ..
            } => {
                let points = match unit {
                    MouseWheelUnit::Point => delta,
                    MouseWheelUnit::Line | MouseWheelUnit::Page => line * delta,
                };
                let verb = self.preferences.navigation.two_fingers(modifiers)?;
                Some((verb, points))
            }
            _ => None,
        };
        ui.input(|input| input.events.iter().filter_map(movement).collect())
    }

    /// Zooms to the point under the pointer.
    fn zoom_at(&mut self, pos: Pos2, factor: f32, canvas: Canvas) {
        if factor == 1.0 {
            return;
        }
        let newest = self.seen.turntable.camera(canvas.resolution);
        let at = canvas.pixel_of(pos, &newest);
        // The view may have passed what the picture on the screen shows.
        let is_ahead = |point: &DVec3| newest.depth_of(*point) > 0.0;
        let shown = self.shown_at(pos, canvas);
        let on_pivots_plane = || newest.on_plane_through(self.seen.turntable.pivot, at);
        let anchor = shown
            .and_then(|shown| self.surface_along(&shown.ray()))
            .filter(is_ahead)
            .or_else(|| self.surface_along(&newest.ray_through(at)))
            .unwrap_or_else(on_pivots_plane);
        self.seen.turntable.zoom(factor.into(), anchor);
    }

    /// Takes the keys of flying from the commands while the right button is held on the picture.
    pub(super) fn take_flight_keys(&self, ctx: &egui::Context) {
        let is_of_flight = |event: &Event| match event {
            Event::Key { key, modifiers, .. } => {
                !modifiers.command && FLIGHT_KEYS.iter().any(|(flight, _)| flight == key)
            }
            _ => false,
        };
        if self.navigation.flight.is_held {
            ctx.input_mut(|input| input.events.retain(|event| !is_of_flight(event)));
        }
    }

    /// Moves the camera while the right button and keys of flying are held.
    fn fly(&mut self, ui: &egui::Ui, response: &Response) {
        /// A frame that takes longer counts as that long.
        const LONGEST_S: f64 = 0.1;
        let is_down = ui.input(|input| input.pointer.secondary_down());
        let flight = &mut self.navigation.flight;
        flight.is_held = is_down && response.is_pointer_button_down_on();
        if !flight.is_held {
            flight.is_flying = false;
            return;
        }
        let (direction, secs) = ui.input(|input| {
            let held = FLIGHT_KEYS.iter().filter(|(key, _)| input.key_down(*key));
            let direction: DVec3 = held.map(|(_, direction)| *direction).sum();
            (direction, f64::from(input.unstable_dt).min(LONGEST_S))
        });
        let Some(direction) = direction.try_normalize() else {
            return;
        };
        flight.is_flying = true;
        let length = flight.speed * self.seen.turntable.scene_radius() * secs;
        self.seen.turntable.fly(length * direction);
        ui.ctx().request_repaint();
    }
}

/// A movement on the screen in pixels of the picture.
fn in_pixels(points: egui::Vec2, canvas: Canvas) -> DVec2 {
    let pixels = points * canvas.pixels_per_point;
    DVec2::new(pixels.x.into(), pixels.y.into())
}
