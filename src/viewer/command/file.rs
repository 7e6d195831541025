//! The menu *File*: opening, reloading and saving; sessions.

use super::keys::{ctrl, ctrl_shift, key, shift};
use super::{Command, Entry, Menu, Place, lacks_file, lacks_scene, none};
use crate::app::{App, Purpose};
use crate::folder::Direction;
use egui::Key;
use hitscope_core::obj::shown;
use std::path::{Path, PathBuf};

const OPEN: Place = Place::new(Menu::File, 0);
const RECENT: Place = Place::submenu(Menu::File, 0, "Open recent");
const FOLDER: Place = Place::new(Menu::File, 1);
const RELOAD: Place = Place::new(Menu::File, 2);
const SAVE: Place = Place::new(Menu::File, 3);
const SESSION: Place = Place::new(Menu::File, 4);
const QUIT: Place = Place::new(Menu::File, 5);

pub(super) const ROWS: &[Command] = &[
    Command {
        name: "open",
        keys: &[ctrl(Key::O)],
        title: "Open…",
        tooltip: "Opens a mesh or a scene file",
        place: OPEN,
        is_on: None,
        obstacle: none,
        run: |app, ctx, frame| app.show_dialog(Purpose::Open, ctx, frame),
    },
    Command {
        name: "open-environment",
        keys: &[],
        title: "Open environment…",
        tooltip: "Lights the scene by an HDR or EXR picture, as dropping one on the window does",
        place: OPEN,
        is_on: None,
        obstacle: none,
        run: |app, ctx, frame| app.show_dialog(Purpose::Environment, ctx, frame),
    },
    Command {
        name: "next-file",
        keys: &[ctrl(Key::ArrowRight)],
        title: "Next file",
        tooltip: "Opens the next mesh or scene file of the folder",
        place: FOLDER,
        is_on: None,
        obstacle: lacks_file,
        run: |app, ctx, _| app.open_neighbour(Direction::Next, ctx),
    },
    Command {
        name: "previous-file",
        keys: &[ctrl(Key::ArrowLeft)],
        title: "Previous file",
        tooltip: "Opens the previous mesh or scene file of the folder",
        place: FOLDER,
        is_on: None,
        obstacle: lacks_file,
        run: |app, ctx, _| app.open_neighbour(Direction::Previous, ctx),
    },
    Command {
        name: "reload",
        keys: &[key(Key::F5)],
        title: "Reload",
        tooltip: "Loads the file again and keeps the camera and the picked pixel",
        place: RELOAD,
        is_on: None,
        obstacle: lacks_file,
        run: |app, ctx, _| app.reload(ctx),
    },
    Command {
        name: "auto-reload",
        keys: &[ctrl(Key::R)],
        title: "Auto-reload",
        tooltip: "Reloads the file when it, its materials or its textures change",
        place: RELOAD,
        is_on: Some(|app| app.preferences.watches),
        obstacle: lacks_file,
        run: |app, _, _| app.preferences.watches ^= true,
    },
    Command {
        name: "compact",
        keys: &[],
        title: "Compact triangles",
        tooltip: "Reloads the file with tree and triangles in a third less memory; tracing is slower",
        place: RELOAD,
        is_on: Some(|app| app.preferences.is_compact),
        obstacle: lacks_file,
        run: |app, ctx, _| {
            app.preferences.is_compact ^= true;
            app.reload(ctx);
        },
    },
    Command {
        name: "save-as",
        keys: &[ctrl_shift(Key::S)],
        title: "Save as…",
        tooltip: "Saves what is open as a scene file, with this camera",
        place: SAVE,
        is_on: None,
        obstacle: lacks_file,
        run: |app, ctx, frame| app.show_dialog(Purpose::Save, ctx, frame),
    },
    Command {
        name: "save-picture",
        keys: &[key(Key::F12)],
        title: "Save picture",
        tooltip: "Saves the picture and its lines, without labels, as a PNG file beside the open file",
        place: SAVE,
        is_on: None,
        obstacle: lacks_scene,
        run: |app, ctx, frame| app.save_picture(true, ctx, frame),
    },
    Command {
        name: "save-plain-picture",
        keys: &[shift(Key::F12)],
        title: "Save picture without overlay",
        tooltip: "Saves the picture without its overlay as a PNG file beside the open file",
        place: SAVE,
        is_on: None,
        obstacle: lacks_scene,
        run: |app, ctx, frame| app.save_picture(false, ctx, frame),
    },
    Command {
        name: "render-picture",
        keys: &[ctrl(Key::F12)],
        title: "Render picture…",
        tooltip: "Renders a picture of any size and saves it beside the open file",
        place: SAVE,
        is_on: None,
        obstacle: lacks_scene,
        run: |app, _, _| app.toggle_picture_dialog(),
    },
    Command {
        name: "open-session",
        keys: &[],
        title: "Open session…",
        tooltip: "Opens the file of a session and shows it as it was seen",
        place: SESSION,
        is_on: None,
        obstacle: none,
        run: |app, ctx, frame| app.show_dialog(Purpose::OpenSession, ctx, frame),
    },
    Command {
        name: "save-session",
        keys: &[ctrl(Key::S)],
        title: "Save session…",
        tooltip: "Saves the camera, what is shown and the picked pixel, with the name of the open file",
        place: SESSION,
        is_on: None,
        obstacle: lacks_scene,
        run: |app, ctx, frame| app.show_dialog(Purpose::SaveSession, ctx, frame),
    },
    Command {
        name: "quit",
        keys: &[ctrl(Key::Q)],
        title: "Quit",
        tooltip: "Closes the window",
        place: QUIT,
        is_on: None,
        obstacle: none,
        run: |_, ctx, _| ctx.send_viewport_cmd(egui::ViewportCommand::Close),
    },
];

/// The files that were opened last.
pub(super) fn recent_files(app: &App) -> Vec<Entry> {
    let paths = app.preferences.recent.paths();
    let entry = |path: &PathBuf| {
        let file = path.clone();
        let open = move |app: &mut App, ctx: &egui::Context| app.load(file.clone(), ctx);
        Entry::action(RECENT, short_name(path, paths), shown(path), open)
    };
    paths.iter().map(entry).collect()
}

/// The name of a file, with its folders if another file has the same name.
fn short_name(path: &Path, all: &[PathBuf]) -> String {
    let name = path.file_name().unwrap_or_default();
    let same = all.iter().filter(|other| other.file_name() == Some(name));
    if same.count() > 1 {
        shown(path)
    } else {
        shown(Path::new(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recent_files_of_the_same_name_are_shown_with_their_folders() {
        let all = ["/a/mesh.obj", "/b/mesh.obj", "/b/scene.xml"].map(PathBuf::from);
        let names = all.each_ref().map(|path| short_name(path, &all));
        assert_eq!(names, ["/a/mesh.obj", "/b/mesh.obj", "scene.xml"]);
    }
}
