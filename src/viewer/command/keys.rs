//! The keys of commands: which were pressed, and their names.

use super::{Command, all, edit};
use egui::{Event, Key, KeyboardShortcut, Modifiers};
use std::sync::LazyLock;

/// A key alone.
pub(super) const fn key(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

/// A key with Ctrl; with Cmd on macOS.
pub(super) const fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

/// A key with Shift.
pub(super) const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}

/// A key with Ctrl and Shift.
pub(super) const fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

/// All keys with their commands. Keys with more modifiers come first: egui ignores a modifier that is pressed in
/// addition, so Ctrl+Shift+P would also count as Ctrl+P.
static KEYS: LazyLock<Vec<(KeyboardShortcut, &'static Command)>> = LazyLock::new(|| {
    let mut keys: Vec<_> = all()
        .flat_map(|command| command.keys.iter().map(move |&key| (key, command)))
        .collect();
    keys.sort_by_key(|(key, _)| std::cmp::Reverse(modifier_count(key)));
    keys
});

fn modifier_count(key: &KeyboardShortcut) -> u32 {
    let Modifiers {
        alt,
        ctrl,
        shift,
        mac_cmd,
        command,
    } = key.modifiers;
    u32::from(alt) + u32::from(shift) + u32::from(ctrl || mac_cmd || command)
}

/// The commands of the keys pressed since the last frame; none while a text field has the focus. Any other control with
/// the focus keeps plain keys such as Space. Escape is left to an open drop-down, which egui then closes.
pub fn pressed(ctx: &egui::Context) -> Vec<&'static Command> {
    if ctx.text_edit_focused() {
        return Vec::new();
    }
    let has_focus = ctx.egui_wants_keyboard_input();
    let is_popup_open = egui::Popup::is_any_open(ctx);
    ctx.input_mut(|input| {
        let is_pressed = |(key, command): &&(KeyboardShortcut, &Command)| {
            let is_left_to_popup = is_popup_open && command.name == edit::DISMISS;
            let is_left_to_control = has_focus && is_plain(key);
            !is_left_to_popup && !is_left_to_control && input.consume_shortcut(key)
        };
        KEYS.iter()
            .filter(is_pressed)
            .map(|(_, command)| *command)
            .collect()
    })
}

/// Whether a key has no modifier but Shift and isn't a function key, so that a focused control may use it.
fn is_plain(key: &KeyboardShortcut) -> bool {
    let is_function_key = (Key::F1..=Key::F35).contains(&key.logical_key);
    let without_shift = KeyboardShortcut {
        modifiers: Modifiers {
            shift: false,
            ..key.modifiers
        },
        ..*key
    };
    !is_function_key && modifier_count(&without_shift) == 0
}

/// The text that was pasted since the last frame, unless a text field has the focus.
pub fn pasted(ctx: &egui::Context) -> Option<String> {
    if ctx.text_edit_focused() {
        return None;
    }
    ctx.input(|input| {
        input.events.iter().find_map(|event| match event {
            Event::Paste(text) => Some(text.clone()),
            _ => None,
        })
    })
}

/// The names of keys, such as `Ctrl+O` or `H or ?`; empty if there are none.
pub fn key_text(keys: &[KeyboardShortcut], ctx: &egui::Context) -> String {
    let names = keys.iter().map(|key| key_name(key, ctx));
    names.collect::<Vec<_>>().join(" or ")
}

/// The names of the keys of a command, by the command's name.
///
/// # Panics
/// If there is no such command.
pub fn keys_of(name: &str, ctx: &egui::Context) -> String {
    let command = all().find(|command| command.name == name);
    let command = command.unwrap_or_else(|| panic!("no command is called {name}"));
    key_text(command.keys, ctx)
}

/// The name of a key. Signs are shown as they are, not by egui's names.
fn key_name(key: &KeyboardShortcut, ctx: &egui::Context) -> String {
    let sign = match key.logical_key {
        Key::Questionmark => "?",
        Key::OpenBracket => "[",
        Key::CloseBracket => "]",
        Key::Period => ".",
        _ => return ctx.format_shortcut(key),
    };
    let text = ctx.format_shortcut(key);
    let modifiers = text.strip_suffix(key.logical_key.name());
    format!("{}{sign}", modifiers.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_unique_and_those_with_more_modifiers_come_first() {
        for (i, (a, command)) in KEYS.iter().enumerate() {
            for (b, other) in &KEYS[i + 1..] {
                assert_ne!(a, b, "{} and {}", command.name, other.name);
                // What is pressed for `b` would be taken for `a`.
                let is_shadowed =
                    a.logical_key == b.logical_key && b.modifiers.matches_logically(a.modifiers);
                assert!(!is_shadowed, "{a:?} shadows {b:?}");
            }
        }
    }

    #[test]
    fn a_focused_control_keeps_plain_keys_and_leaves_those_with_ctrl_and_function_keys() {
        for (shortcut, expected) in [
            (key(Key::Space), true),
            (shift(Key::X), true),
            (ctrl(Key::V), false),
            (ctrl_shift(Key::V), false),
            (key(Key::F12), false),
            (key(Key::F), true),
        ] {
            assert_eq!(is_plain(&shortcut), expected, "{shortcut:?}");
        }
    }

    #[test]
    fn undo_and_redo_have_their_usual_keys() {
        for (key, name) in [
            (ctrl(Key::Z), "undo"),
            (ctrl(Key::Y), "redo"),
            (ctrl_shift(Key::Z), "redo"),
        ] {
            let found = KEYS.iter().find(|(used, _)| *used == key);
            assert_eq!(found.map(|(_, command)| command.name), Some(name));
        }
    }

    #[test]
    fn the_names_of_keys_are_signs_or_words() {
        let ctx = egui::Context::default();
        ctx.set_os(egui::os::OperatingSystem::Nix);
        for (key, name) in [
            (ctrl(Key::O), "Ctrl+O"),
            (ctrl_shift(Key::S), "Ctrl+Shift+S"),
            (key(Key::OpenBracket), "["),
            (key(Key::Questionmark), "?"),
            (ctrl(Key::Period), "Ctrl+."),
            (ctrl(Key::ArrowRight), "Ctrl+Right"),
        ] {
            assert_eq!(key_name(&key, &ctx), name);
        }
        assert_eq!(keys_of("help", &ctx), "H or ?");
    }
}
