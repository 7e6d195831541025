//! Tables of key and pointer bindings, which the help sheet lists.

use egui::{Key, KeyboardShortcut, Modifiers};
use hitscope_core::camera::{StandardView, UpAxis};
use hitscope_core::mesh::Flaw;

/// The action of a key, button or menu entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Show the dialog that opens a file.
    Open,
    /// Show the dialog that saves a scene file.
    Save,
    /// Show the dialog that opens a picture of an environment.
    OpenEnvironment,
    /// Reload the open file.
    Reload,
    /// Show the scene file's view, or frame the mesh.
    Frame,
    /// Mark the next (1) or the previous (-1) crossing of the picked ray.
    StepCrossing(i8),
    /// Mark the flaws of a kind and show one of them, counted from 0; or mark none.
    ShowFlaw(Option<(Flaw, usize)>),
    /// Turn auto-reload on or off.
    ToggleWatch,
    /// Look along an axis.
    LookFrom(StandardView),
    /// Set the axis of the file that points up.
    SetUpAxis(UpAxis),
    /// Turn auto-rotation on or off.
    ToggleRotation,
    /// Toggle orthographic projection.
    ToggleOrthographic,
    /// Show or hide the wireframe.
    ToggleWireframe,
    /// Show or hide normals.
    ToggleNormals,
    /// Toggle smooth shading.
    ToggleSmooth,
    /// Show or hide the noise of a view that needs lights.
    ToggleNoise,
    /// Pause or resume refinement.
    TogglePause,
    /// Show or hide the side panel.
    TogglePanel,
    /// Show or hide the help sheet.
    ToggleHelp,
    /// Cancel loading, or close the help sheet or a message, or clear the pick.
    Dismiss,
}

/// Keys and their action.
pub struct Binding {
    /// Alternative keys.
    pub keys: &'static [KeyboardShortcut],
    /// The action that each key performs.
    pub action: Action,
    /// Description for the help sheet.
    pub about: &'static str,
}

const fn key(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

const fn binding(
    keys: &'static [KeyboardShortcut],
    action: Action,
    about: &'static str,
) -> Binding {
    Binding {
        keys,
        action,
        about,
    }
}

/// All key bindings. A binding with Ctrl comes before the one of the same key without it.
pub static KEYS: &[Binding] = &[
    binding(&[ctrl(Key::O)], Action::Open, "Open a file"),
    binding(
        &[ctrl_shift(Key::S)],
        Action::Save,
        "Save what is open as a scene file",
    ),
    binding(&[key(Key::F5)], Action::Reload, "Reload the file"),
    binding(
        &[key(Key::Home)],
        Action::Frame,
        "Show the scene file's view, or frame the mesh",
    ),
    binding(
        &[key(Key::OpenBracket)],
        Action::StepCrossing(-1),
        "Mark the previous crossing of the picked ray",
    ),
    binding(
        &[key(Key::CloseBracket)],
        Action::StepCrossing(1),
        "Mark the next crossing of the picked ray",
    ),
    binding(
        &[ctrl(Key::Num1)],
        Action::LookFrom(StandardView::Back),
        "Look from behind",
    ),
    binding(
        &[ctrl(Key::Num3)],
        Action::LookFrom(StandardView::Left),
        "Look from the left",
    ),
    binding(
        &[ctrl(Key::Num7)],
        Action::LookFrom(StandardView::Bottom),
        "Look from below",
    ),
    binding(
        &[key(Key::Num1)],
        Action::LookFrom(StandardView::Front),
        "Look from the front",
    ),
    binding(
        &[key(Key::Num3)],
        Action::LookFrom(StandardView::Right),
        "Look from the right",
    ),
    binding(
        &[key(Key::Num7)],
        Action::LookFrom(StandardView::Top),
        "Look from above",
    ),
    binding(
        &[key(Key::Num5)],
        Action::ToggleOrthographic,
        "Toggle orthographic projection",
    ),
    binding(
        &[ctrl(Key::Y)],
        Action::SetUpAxis(UpAxis::Y),
        "Set Y as the up axis",
    ),
    binding(
        &[ctrl(Key::Z)],
        Action::SetUpAxis(UpAxis::Z),
        "Set Z as the up axis",
    ),
    binding(
        &[key(Key::T)],
        Action::ToggleRotation,
        "Toggle auto-rotation",
    ),
    binding(
        &[key(Key::W)],
        Action::ToggleWireframe,
        "Toggle the wireframe",
    ),
    binding(
        &[key(Key::N)],
        Action::ToggleNormals,
        "Toggle normals: of faces (flat) or of vertices (smooth)",
    ),
    binding(
        &[key(Key::S)],
        Action::ToggleSmooth,
        "Toggle smooth shading",
    ),
    binding(
        &[key(Key::P)],
        Action::TogglePause,
        "Pause or resume refinement",
    ),
    binding(&[ctrl(Key::R)], Action::ToggleWatch, "Toggle auto-reload"),
    binding(&[key(Key::I)], Action::TogglePanel, "Toggle the side panel"),
    binding(
        &[key(Key::H), key(Key::Questionmark)],
        Action::ToggleHelp,
        "Toggle this help",
    ),
    binding(
        &[key(Key::Escape)],
        Action::Dismiss,
        "Cancel loading, close help or a message, or clear the picked pixel",
    ),
];

/// Pointer bindings in the picture.
pub static POINTER: &[(&str, &str)] = &[
    ("Drag", "Orbit"),
    ("Shift+drag, middle drag or right drag", "Pan"),
    (
        "Ctrl+drag",
        "Rotate the environment, in views with its light",
    ),
    ("Scroll or pinch", "Zoom to the cursor"),
    ("Click", "Inspect the pixel"),
    ("Double-click", "Set the pivot"),
    (
        "Drop a file",
        "Open it, or light the scene by a picture in HDR or EXR",
    ),
];

/// Keys that egui handles itself.
pub static SYSTEM: &[(&str, &str)] = &[
    (
        "Ctrl+Plus, Ctrl+Minus, Ctrl+0",
        "Enlarge, shrink or reset the user interface",
    ),
    ("Ctrl+Q", "Quit"),
];

impl Binding {
    /// The names of the keys, such as `Ctrl+O`.
    pub fn key_text(&self, ctx: &egui::Context) -> String {
        let texts = self.keys.iter().map(|shortcut| match shortcut.logical_key {
            Key::Questionmark => "?".to_owned(),
            _ => ctx.format_shortcut(shortcut),
        });
        texts.collect::<Vec<_>>().join(" or ")
    }
}

/// The actions of the keys pressed since the last frame; none while a text field has the focus. Escape is left
/// to an open drop-down, which egui then closes.
pub fn pressed(ctx: &egui::Context) -> Vec<Action> {
    if ctx.egui_wants_keyboard_input() {
        return Vec::new();
    }
    let is_popup_open = egui::Popup::is_any_open(ctx);
    ctx.input_mut(|input| {
        let is_pressed = |binding: &&Binding| {
            if is_popup_open && binding.action == Action::Dismiss {
                return false;
            }
            let mut keys = binding.keys.iter();
            keys.any(|shortcut| input.consume_shortcut(shortcut))
        };
        KEYS.iter()
            .filter(is_pressed)
            .map(|binding| binding.action)
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_unique_and_ctrl_bindings_come_first() {
        let all: Vec<&KeyboardShortcut> = KEYS.iter().flat_map(|b| b.keys).collect();
        for (i, a) in all.iter().enumerate() {
            for b in &all[i + 1..] {
                assert_ne!(a, b);
                let is_shadowed = a.logical_key == b.logical_key && a.modifiers.is_none();
                assert!(!is_shadowed, "{a:?} shadows {b:?}");
            }
        }
    }
}
