//! Pointer bindings: what a drag or the wheel does on the picture, as tables that the user chooses from.

use egui::{Modifiers, PointerButton};
use serde::{Deserialize, Serialize};

/// What the pointer does on the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verb {
    /// Rotates about the pivot.
    Orbit,
    /// Moves across the view.
    Pan,
    /// Moves towards the pivot or away from it.
    Zoom,
    /// Rotates the environment.
    RotateEnvironment,
}

impl Verb {
    const ALL: [Self; 4] = [Self::Orbit, Self::Pan, Self::Zoom, Self::RotateEnvironment];

    /// The effect in a few words.
    fn about(self) -> &'static str {
        match self {
            Self::Orbit => "Orbit",
            Self::Pan => "Pan",
            Self::Zoom => "Zoom",
            Self::RotateEnvironment => {
                "Rotate the environment, if it is a picture and the view shows its light"
            }
        }
    }
}

/// A drag and its effect.
pub struct DragBinding {
    modifiers: Modifiers,
    button: PointerButton,
    verb: Verb,
}

const fn drag(modifiers: Modifiers, button: PointerButton, verb: Verb) -> DragBinding {
    DragBinding {
        modifiers,
        button,
        verb,
    }
}

/// A set of bindings.
pub struct Preset {
    /// The name in the settings.
    pub name: &'static str,
    /// The title in menus.
    pub title: &'static str,
    /// A sentence for the tooltip.
    pub about: &'static str,
    /// Drags. The first one whose modifiers are all pressed applies.
    drags: &'static [DragBinding],
}

use PointerButton::{Middle, Primary, Secondary};

/// All sets of bindings; the first is the default.
pub static PRESETS: &[Preset] = &[
    Preset {
        name: "default",
        title: "Default mouse",
        about: "The left button orbits, the others and Shift pan",
        drags: &[
            drag(Modifiers::COMMAND, Primary, Verb::RotateEnvironment),
            drag(Modifiers::SHIFT, Primary, Verb::Pan),
            drag(Modifiers::NONE, Primary, Verb::Orbit),
            drag(Modifiers::NONE, Middle, Verb::Pan),
            drag(Modifiers::NONE, Secondary, Verb::Pan),
        ],
    },
    Preset {
        name: "blender",
        title: "Mouse as in Blender",
        about: "The middle button orbits, with Shift it pans, with Ctrl it zooms",
        drags: &[
            drag(Modifiers::SHIFT, Middle, Verb::Pan),
            drag(Modifiers::COMMAND, Middle, Verb::Zoom),
            drag(Modifiers::NONE, Middle, Verb::Orbit),
            drag(Modifiers::COMMAND, Primary, Verb::RotateEnvironment),
            drag(Modifiers::NONE, Primary, Verb::Orbit),
            drag(Modifiers::NONE, Secondary, Verb::Pan),
        ],
    },
    Preset {
        name: "meshlab",
        title: "Mouse as in MeshLab",
        about: "The left button orbits, with Ctrl it pans, with Shift it zooms",
        drags: &[
            drag(
                Modifiers::COMMAND.plus(Modifiers::SHIFT),
                Primary,
                Verb::RotateEnvironment,
            ),
            drag(Modifiers::COMMAND, Primary, Verb::Pan),
            drag(Modifiers::SHIFT, Primary, Verb::Zoom),
            drag(Modifiers::NONE, Primary, Verb::Orbit),
            drag(Modifiers::NONE, Middle, Verb::Pan),
            drag(Modifiers::NONE, Secondary, Verb::Pan),
        ],
    },
];

/// A gesture of two fingers on a trackpad, and its effect. Ctrl and a pinch zoom, as egui reports them.
static TWO_FINGERS: &[(Modifiers, Verb)] = &[
    (Modifiers::SHIFT, Verb::Pan),
    (Modifiers::NONE, Verb::Orbit),
];

/// Settings of navigation. An unknown name of a preset stands for the default one.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct NavigationSettings {
    /// Name of the preset of pointer bindings.
    pub preset: String,
    /// Whether scrolling is that of a trackpad: two fingers orbit.
    pub is_trackpad: bool,
    /// Whether orbiting may tilt the horizon.
    pub is_trackball: bool,
    /// Whether a drag orbits about the surface where it starts, instead of the pivot.
    pub orbits_about_cursor: bool,
    /// Whether the view changes at once instead of moving there.
    pub reduces_motion: bool,
    /// Whether the axis gizmo is shown.
    pub shows_gizmo: bool,
}

impl Default for NavigationSettings {
    fn default() -> Self {
        Self {
            preset: PRESETS[0].name.to_owned(),
            is_trackpad: false,
            is_trackball: false,
            orbits_about_cursor: false,
            reduces_motion: false,
            shows_gizmo: true,
        }
    }
}

impl NavigationSettings {
    /// The set of bindings.
    pub fn preset(&self) -> &'static Preset {
        let chosen = PRESETS.iter().find(|preset| preset.name == self.preset);
        chosen.unwrap_or(&PRESETS[0])
    }

    /// The effect of a drag. Without an environment that can be rotated, the drag does what it does without its modifiers.
    pub fn dragged(
        &self,
        button: PointerButton,
        pressed: Modifiers,
        has_environment: bool,
    ) -> Option<Verb> {
        let applies = |row: &&DragBinding| {
            row.button == button
                && pressed.contains(row.modifiers)
                && (has_environment || row.verb != Verb::RotateEnvironment)
        };
        let row = self.preset().drags.iter().find(applies)?;
        Some(row.verb)
    }

    /// The effect of moving two fingers on a trackpad; `None` for a mouse, and with Ctrl, which zooms.
    pub fn two_fingers(&self, pressed: Modifiers) -> Option<Verb> {
        if !self.is_trackpad || pressed.command || pressed.ctrl {
            return None;
        }
        let row = TWO_FINGERS.iter().find(|row| pressed.contains(row.0))?;
        Some(row.1)
    }

    /// The lines of the help sheet: gestures, and their effects.
    pub fn help(&self) -> Vec<(String, &'static str)> {
        let of_verb = |verb: Verb| {
            let drags = self.preset().drags.iter().filter(|row| row.verb == verb);
            let drags = drags.map(|row| gesture(row.modifiers, button_name(row.button)));
            let fingers = TWO_FINGERS
                .iter()
                .filter(|row| self.is_trackpad && row.1 == verb);
            let fingers = fingers.map(|row| gesture(row.0, "two fingers"));
            let gestures: Vec<String> = drags.chain(fingers).collect();
            (!gestures.is_empty()).then(|| (capitalized(&gestures.join(", ")), verb.about()))
        };
        let zoom = if self.is_trackpad {
            "Ctrl+two fingers or pinch"
        } else {
            "Scroll or pinch"
        };
        let others = [
            (zoom, "Zoom to the cursor"),
            (
                "Right drag+W A S D Q E",
                "Fly: ahead, left, back, right, down, up; the drag looks around, scrolling sets the speed",
            ),
            (
                "Ctrl+Shift+scroll",
                "Magnify the picture; Esc shows the whole picture",
            ),
            ("Click", "Inspect the pixel"),
            ("Ctrl+click", "Inspect the pixel and keep the other picks"),
            ("Double-click", "Set the pivot"),
            (
                "Drop a file",
                "Open it, or light the scene by a picture in HDR or EXR",
            ),
        ];
        let others = others.map(|(gesture, about)| (gesture.to_owned(), about));
        Verb::ALL
            .into_iter()
            .filter_map(of_verb)
            .chain(others)
            .collect()
    }
}

fn button_name(button: PointerButton) -> &'static str {
    match button {
        Middle => "middle drag",
        Secondary => "right drag",
        _ => "drag",
    }
}

fn gesture(modifiers: Modifiers, name: &str) -> String {
    let ctrl = if modifiers.command { "Ctrl+" } else { "" };
    let shift = if modifiers.shift { "Shift+" } else { "" };
    format!("{ctrl}{shift}{name}")
}

fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_preset(name: &str) -> NavigationSettings {
        NavigationSettings {
            preset: name.to_owned(),
            ..NavigationSettings::default()
        }
    }

    #[test]
    fn drags_do_what_the_programs_of_the_presets_do() {
        let (none, shift, ctrl) = (
            Modifiers::NONE,
            Modifiers::SHIFT,
            Modifiers::CTRL | Modifiers::COMMAND,
        );
        for (preset, button, pressed, verb) in [
            ("default", Primary, none, Verb::Orbit),
            ("default", Primary, shift, Verb::Pan),
            ("default", Middle, none, Verb::Pan),
            ("blender", Middle, none, Verb::Orbit),
            ("blender", Middle, shift, Verb::Pan),
            ("blender", Middle, ctrl, Verb::Zoom),
            ("meshlab", Primary, none, Verb::Orbit),
            ("meshlab", Primary, ctrl, Verb::Pan),
            ("meshlab", Primary, shift, Verb::Zoom),
            ("of another version", Primary, none, Verb::Orbit),
        ] {
            let found = with_preset(preset).dragged(button, pressed, false);
            assert_eq!(found, Some(verb), "{preset} {button:?} {pressed:?}");
        }
        let default = with_preset("default");
        let rotated = default.dragged(Primary, ctrl, true);
        assert_eq!(rotated, Some(Verb::RotateEnvironment));
        assert_eq!(default.dragged(Primary, ctrl, false), Some(Verb::Orbit));
    }

    #[test]
    fn two_fingers_orbit_and_pan_on_a_trackpad_only() {
        let mut settings = NavigationSettings::default();
        assert_eq!(settings.two_fingers(Modifiers::NONE), None);
        settings.is_trackpad = true;
        assert_eq!(settings.two_fingers(Modifiers::NONE), Some(Verb::Orbit));
        assert_eq!(settings.two_fingers(Modifiers::SHIFT), Some(Verb::Pan));
        assert_eq!(settings.two_fingers(Modifiers::COMMAND), None);
    }

    #[test]
    fn the_help_names_each_gesture_once() {
        for preset in PRESETS {
            let settings = NavigationSettings {
                is_trackpad: true,
                ..with_preset(preset.name)
            };
            let lines = settings.help();
            let names: std::collections::HashSet<&String> =
                lines.iter().map(|line| &line.0).collect();
            assert_eq!(names.len(), lines.len(), "{}", preset.name);
            assert!(
                lines
                    .iter()
                    .any(|line| line.0.contains("two fingers") && line.1 == "Orbit")
            );
        }
    }
}
