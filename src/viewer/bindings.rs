//! Which key does what. The help sheet is made from these tables, so it can't be wrong.

use egui::{Key, KeyboardShortcut, Modifiers};
use hitscope_core::camera::StandardView;
use hitscope_core::mesh::Flaw;

/// What a key, a button or a menu entry asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// Show the dialog that opens a file.
    Open,
    /// Load the open file again.
    Reload,
    /// Show the whole mesh.
    Frame,
    /// Mark where flaws of a kind are and show them, or mark none.
    ShowFlaw(Option<Flaw>),
    /// Load the file again whenever it changes, or don't.
    ToggleWatch,
    /// Look along an axis.
    LookFrom(StandardView),
    /// Go round the mesh or stand still.
    ToggleTurning,
    /// Perspective or parallel rays.
    ToggleOrthographic,
    /// Edges on or off.
    ToggleWireframe,
    /// Normals on or off.
    ToggleNormals,
    /// Flat or smooth shading.
    ToggleSmooth,
    /// Refine the picture or not.
    TogglePause,
    /// The side panel on or off.
    TogglePanel,
    /// The help sheet on or off.
    ToggleHelp,
    /// Close what is open: help, message, pick.
    Dismiss,
}

/// A row of the table.
pub struct Binding {
    /// Any of these.
    pub keys: &'static [KeyboardShortcut],
    /// What they do.
    pub action: Action,
    /// The same in words.
    pub about: &'static str,
}

const fn key(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
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

/// Every key. Those with Ctrl come before the same keys without it.
pub static KEYS: &[Binding] = &[
    binding(&[ctrl(Key::O)], Action::Open, "Open a file"),
    binding(&[key(Key::F5)], Action::Reload, "Load the file again"),
    binding(&[key(Key::Home)], Action::Frame, "Show the whole mesh"),
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
        "Perspective or parallel rays",
    ),
    binding(
        &[key(Key::T)],
        Action::ToggleTurning,
        "Go round and round the mesh",
    ),
    binding(&[key(Key::W)], Action::ToggleWireframe, "Wireframe"),
    binding(
        &[key(Key::N)],
        Action::ToggleNormals,
        "Normals: of faces if flat, of vertices if smooth",
    ),
    binding(
        &[key(Key::S)],
        Action::ToggleSmooth,
        "Flat or smooth shading",
    ),
    binding(
        &[key(Key::P)],
        Action::TogglePause,
        "Pause or resume refinement",
    ),
    binding(
        &[ctrl(Key::R)],
        Action::ToggleWatch,
        "Load the file again whenever it changes",
    ),
    binding(&[key(Key::I)], Action::TogglePanel, "Side panel"),
    binding(
        &[key(Key::H), key(Key::Questionmark)],
        Action::ToggleHelp,
        "This help",
    ),
    binding(
        &[key(Key::Escape)],
        Action::Dismiss,
        "Cancel loading, close help or message, or clear the pick",
    ),
];

/// What the pointer does in the picture.
pub static POINTER: &[(&str, &str)] = &[
    ("Left drag", "Orbit"),
    ("Shift, middle or right drag", "Pan"),
    ("Wheel, pinch", "Zoom to the cursor"),
    ("Click", "Inspect the pixel"),
    ("Double click", "Turn about that point"),
    ("Drop a file", "Open it"),
];

/// What egui itself does.
pub static SYSTEM: &[(&str, &str)] = &[
    ("Ctrl+Plus, Minus, 0", "Larger, smaller, normal text"),
    ("Ctrl+Q", "Quit"),
];

impl Binding {
    /// The keys in words, as `Ctrl+O`.
    pub fn key_text(&self, ctx: &egui::Context) -> String {
        let texts = self.keys.iter().map(|shortcut| match shortcut.logical_key {
            Key::Questionmark => "?".to_owned(),
            _ => ctx.format_shortcut(shortcut),
        });
        texts.collect::<Vec<_>>().join(" or ")
    }
}

/// What the keys pressed since the last frame ask for; nothing while a text is typed.
pub fn pressed(ctx: &egui::Context) -> Vec<Action> {
    if ctx.egui_wants_keyboard_input() {
        return Vec::new();
    }
    ctx.input_mut(|input| {
        let is_pressed = |binding: &&Binding| {
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
    fn no_key_does_two_things_and_ctrl_comes_first() {
        let all: Vec<&KeyboardShortcut> = KEYS.iter().flat_map(|b| b.keys).collect();
        for (i, a) in all.iter().enumerate() {
            for b in &all[i + 1..] {
                assert_ne!(a, b);
                let is_shadowed = a.logical_key == b.logical_key && a.modifiers.is_none();
                assert!(!is_shadowed, "{a:?} would take what is meant for {b:?}");
            }
        }
    }
}
