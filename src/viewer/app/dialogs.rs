//! The file dialogs: a row of [`DIALOGS`] for each.

use super::App;
use crate::dialog::{DialogSpec, FileDialog};
use crate::saving::suggested_path;
use crate::session;
use std::path::PathBuf;

/// The purpose of a file dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Purpose {
    /// Choose a file to open.
    Open,
    /// Choose the name of a scene file to write.
    Save,
    /// Choose a picture of an environment to open.
    Environment,
    /// Choose a session to open.
    OpenSession,
    /// Choose the name of a session file to write.
    SaveSession,
    /// Choose the name of a file to write picks to.
    Picks,
    /// Choose a mesh or scene to compare with.
    CompareMesh,
    /// Choose a picture to compare with.
    ComparePicture,
}

/// A file dialog, and the use of the chosen file.
struct Row {
    purpose: Purpose,
    spec: DialogSpec,
    /// The path that it starts with: the folder, and for saving also the name.
    suggested: fn(&App) -> Option<PathBuf>,
    /// Uses the chosen file.
    chosen: fn(&mut App, PathBuf, &egui::Context),
}

static DIALOGS: [Row; 8] = [
    Row {
        purpose: Purpose::Open,
        spec: DialogSpec {
            title: "Open a mesh",
            example: "/path/to/mesh.obj",
            is_saving: false,
            filters: &[
                (
                    "Meshes and scenes",
                    &["obj", "OBJ", "obj.gz", "gz", "xml", "XML", "hitscope"],
                ),
                ("All files", &["*"]),
            ],
        },
        suggested: own_path,
        chosen: App::load,
    },
    Row {
        purpose: Purpose::Save,
        spec: DialogSpec {
            title: "Save as a scene file",
            example: "/path/to/scene.xml",
            is_saving: true,
            filters: &[("Scene files", &["xml"])],
        },
        suggested: |app| suggested_path(&app.open.document),
        chosen: |app, path, ctx| app.save_as(&path, ctx),
    },
    Row {
        purpose: Purpose::Environment,
        spec: DialogSpec {
            title: "Open an environment",
            example: "/path/to/sky.hdr",
            is_saving: false,
            filters: &[
                ("Environments", &["hdr", "HDR", "exr", "EXR"]),
                ("All files", &["*"]),
            ],
        },
        suggested: own_path,
        chosen: |app, path, ctx| app.open_environment(&path, ctx),
    },
    Row {
        purpose: Purpose::OpenSession,
        spec: DialogSpec {
            title: "Open a session",
            example: "/path/to/view.hitscope",
            is_saving: false,
            filters: &[("Sessions", &["hitscope"])],
        },
        suggested: own_path,
        chosen: App::load,
    },
    Row {
        purpose: Purpose::SaveSession,
        spec: DialogSpec {
            title: "Save the session",
            example: "/path/to/view.hitscope",
            is_saving: true,
            filters: &[("Sessions", &["hitscope"])],
        },
        suggested: |app| Some(own_path(app)?.with_extension(session::EXTENSION)),
        chosen: |app, path, ctx| app.save_session(&path, ctx),
    },
    Row {
        purpose: Purpose::Picks,
        spec: DialogSpec {
            title: "Export picks",
            example: "/path/to/picks.csv or .json",
            is_saving: true,
            filters: &[("JSON", &["json"]), ("Comma-separated values", &["csv"])],
        },
        suggested: |app| Some(own_path(app)?.with_extension("picks.json")),
        chosen: |app, path, ctx| app.export_picks(&path, ctx),
    },
    Row {
        purpose: Purpose::CompareMesh,
        spec: DialogSpec {
            title: "Compare with a file",
            example: "/path/to/mesh.obj",
            is_saving: false,
            filters: &[
                (
                    "Meshes and scenes",
                    &["obj", "OBJ", "obj.gz", "gz", "xml", "XML"],
                ),
                ("All files", &["*"]),
            ],
        },
        suggested: own_path,
        chosen: |app, path, _| app.compare_with_mesh(path),
    },
    Row {
        purpose: Purpose::ComparePicture,
        spec: DialogSpec {
            title: "Compare with a picture",
            example: "/path/to/reference.exr",
            is_saving: false,
            filters: &[
                ("Pictures", &["png", "PNG", "exr", "EXR", "hdr", "HDR"]),
                ("All files", &["*"]),
            ],
        },
        suggested: own_path,
        chosen: |app, path, _| app.compare_with_picture(path),
    },
];

fn own_path(app: &App) -> Option<PathBuf> {
    app.open.document.path.clone()
}

/// The dialogs of all rows.
pub(crate) struct Dialogs([FileDialog; DIALOGS.len()]);

impl Default for Dialogs {
    fn default() -> Self {
        Self(DIALOGS.each_ref().map(|row| FileDialog::new(&row.spec)))
    }
}

impl Dialogs {
    /// Closes the first path field that is open. Returns whether there was one.
    pub fn dismiss(&mut self) -> bool {
        self.0.iter_mut().any(FileDialog::dismiss)
    }

    /// The first file for which `chosen` returns a path, and its row.
    fn chosen(
        &mut self,
        chosen: impl Fn(&mut FileDialog) -> Option<PathBuf>,
    ) -> Option<(&'static Row, PathBuf)> {
        let mut rows = DIALOGS.iter().zip(&mut self.0);
        rows.find_map(|(row, dialog)| Some((row, chosen(dialog)?)))
    }
}

impl App {
    /// Shows a file dialog.
    pub(crate) fn show_dialog(
        &mut self,
        purpose: Purpose,
        ctx: &egui::Context,
        frame: &eframe::Frame,
    ) {
        let index = DIALOGS.iter().position(|row| row.purpose == purpose);
        let index = index.expect("a test finds a row for each purpose");
        let suggested = (DIALOGS[index].suggested)(self);
        self.open.dialogs.0[index].open(ctx, frame, suggested.as_deref());
    }

    /// Uses the file that was chosen in a dialog of the system.
    pub(super) fn poll_dialogs(&mut self, ctx: &egui::Context) {
        if let Some((row, path)) = self.open.dialogs.chosen(FileDialog::poll) {
            (row.chosen)(self, path, ctx);
        }
    }

    /// Shows the path fields that are open, and uses the file that was entered.
    pub(super) fn path_fields_ui(&mut self, ctx: &egui::Context) {
        if let Some((row, path)) = self.open.dialogs.chosen(|dialog| dialog.field_ui(ctx)) {
            (row.chosen)(self, path, ctx);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_purpose_has_one_row_and_each_title_is_used_once() {
        for purpose in [
            Purpose::Open,
            Purpose::Save,
            Purpose::Environment,
            Purpose::OpenSession,
            Purpose::SaveSession,
            Purpose::Picks,
            Purpose::CompareMesh,
            Purpose::ComparePicture,
        ] {
            let rows = DIALOGS.iter().filter(|row| row.purpose == purpose);
            assert_eq!(rows.count(), 1, "{purpose:?}");
        }
        for row in &DIALOGS {
            let same = DIALOGS
                .iter()
                .filter(|other| other.spec.title == row.spec.title);
            assert_eq!(same.count(), 1, "{}", row.spec.title);
        }
    }
}
