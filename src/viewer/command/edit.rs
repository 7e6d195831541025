//! The menu *Edit*: undo and redo, the clipboard, and cancelling.

use super::keys::{ctrl, ctrl_shift, key};
use super::{Command, Menu, Place, lacks_scene, none};
use crate::app::App;
use egui::Key;

const STEPS: Place = Place::new(Menu::Edit, 0);
const VIEW_TEXT: Place = Place::new(Menu::Edit, 1);
const CANCEL: Place = Place::new(Menu::Edit, 2);

/// The name of the command that an open drop-down takes the key of.
pub(super) const DISMISS: &str = "dismiss";

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "undo",
        keys: &[ctrl(Key::Z)],
        title: "Undo",
        tooltip: "Undoes the last change of the camera, of what is shown, or of the picked pixel",
        place: STEPS,
        is_on: None,
        obstacle: App::lacks_undo,
        run: |app, ctx, _| app.undo(ctx),
    },
    Command {
        name: "redo",
        keys: &[ctrl(Key::Y), ctrl_shift(Key::Z)],
        title: "Redo",
        tooltip: "Makes the change that was undone last again",
        place: STEPS,
        is_on: None,
        obstacle: App::lacks_redo,
        run: |app, ctx, _| app.redo(ctx),
    },
    Command {
        name: "copy-view",
        keys: &[ctrl_shift(Key::C)],
        title: "Copy view",
        tooltip: "Copies the camera as command-line arguments, which hitscope render and Paste view read",
        place: VIEW_TEXT,
        is_on: None,
        obstacle: lacks_scene,
        run: |app, ctx, _| {
            ctx.copy_text(app.view_text());
            app.tell("Copied the view");
        },
    },
    Command {
        name: "paste-view",
        keys: &[ctrl_shift(Key::V), ctrl(Key::V)],
        title: "Paste view",
        tooltip: "Moves the camera to the place that the clipboard holds as command-line arguments",
        place: VIEW_TEXT,
        is_on: None,
        obstacle: lacks_scene,
        // The text arrives as an event; see `keys::pasted`.
        run: |_, ctx, _| ctx.send_viewport_cmd(egui::ViewportCommand::RequestPaste),
    },
    Command {
        name: "copy-picture",
        keys: &[],
        title: "Copy picture",
        tooltip: "Copies the picture with the overlay",
        place: VIEW_TEXT,
        is_on: None,
        obstacle: lacks_scene,
        run: App::copy_picture,
    },
    Command {
        name: DISMISS,
        keys: &[key(Key::Escape)],
        title: "Cancel or clear",
        tooltip: "Cancels loading, closes a window or a message, or clears the picked pixel",
        place: CANCEL,
        is_on: None,
        obstacle: none,
        run: |app, _, _| app.dismiss(),
    },
];
