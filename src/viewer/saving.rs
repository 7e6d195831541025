//! Saving of the open document as a scene file and of sessions, in the background.

use crate::document::Document;
use crate::session::{EXTENSION, Session};
use crate::task::{Task, TaskPanicked};
use hitscope_core::Camera;
use hitscope_core::loading::{StartView, scene_text};
use hitscope_core::obj::shown;
use hitscope_lab::commands::Output;
use std::path::{Path, PathBuf};

/// A file that is being written.
pub struct Saving {
    path: PathBuf,
    task: Task<Result<(), String>>,
}

/// Why a document can't be saved.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotSaved {
    /// The document has no file that a scene file could name.
    #[error("the built-in scene isn't in a file that a scene file could name")]
    BuiltIn,
    /// Another file has the name with the extension.
    #[error("{} exists; enter this name to replace it", shown(.0))]
    Exists(PathBuf),
}

impl Saving {
    /// Starts to write what is open, with a camera, to a path. A name without the extension `.xml` gets it.
    ///
    /// # Errors
    /// See [`NotSaved`].
    pub fn start(
        document: &Document,
        camera: &Camera,
        path: &Path,
        ctx: &egui::Context,
    ) -> Result<Self, NotSaved> {
        let Some(own) = document.path.clone() else {
            return Err(NotSaved::BuiltIn);
        };
        let file = free_path(path, "xml")?;
        let loaded = &document.loaded;
        let view = StartView::of_camera(camera, loaded.scene.mesh().origin());
        let loaded = loaded.clone();
        let path = file.clone();
        let write_scene = move || {
            let folder = file.parent().unwrap_or(Path::new(""));
            let text = scene_text(&loaded, &own, &view, folder);
            let text = text.map_err(|error| error.to_string())?;
            write(&file, &text)
        };
        let task = Task::spawn("save", ctx, write_scene);
        Ok(Self { path, task })
    }

    /// Starts to write a session to a path. A name without the extension `.hitscope` gets it.
    ///
    /// # Errors
    /// [`NotSaved::Exists`].
    pub fn start_session(
        session: Session,
        path: &Path,
        ctx: &egui::Context,
    ) -> Result<Self, NotSaved> {
        let file = free_path(path, EXTENSION)?;
        let path = file.clone();
        let write_session = move || write(&file, &session.text_at(&file)?);
        let task = Task::spawn("save", ctx, write_session);
        Ok(Self { path, task })
    }

    /// The path once it is written, or the error.
    pub fn poll(&self) -> Option<Result<&Path, String>> {
        match self.task.poll() {
            Ok(None) => None,
            Ok(Some(result)) => Some(result.map(|()| &*self.path)),
            Err(broken @ TaskPanicked) => Some(Err(broken.to_string())),
        }
    }
}

/// The name that is suggested for a document: its own, with the extension `.xml`.
pub fn suggested_path(document: &Document) -> Option<PathBuf> {
    let path = document.path.as_ref()?;
    // Both extensions of `mesh.obj.gz` are replaced.
    let plain = if path.extension().is_some_and(|extension| extension == "gz") {
        path.with_extension("")
    } else {
        path.clone()
    };
    Some(plain.with_extension("xml"))
}

/// The path with the extension, which must not be that of a file unless it was asked for.
fn free_path(path: &Path, extension: &str) -> Result<PathBuf, NotSaved> {
    let file = with_extension(path, extension);
    if file != path && file.exists() {
        return Err(NotSaved::Exists(file));
    }
    Ok(file)
}

/// The path with the extension at its end.
fn with_extension(path: &Path, extension: &str) -> PathBuf {
    if path
        .extension()
        .is_some_and(|own| own.eq_ignore_ascii_case(extension))
    {
        return path.to_owned();
    }
    let mut name = path.as_os_str().to_owned();
    name.push(".");
    name.push(extension);
    name.into()
}

/// Writes a text to a file, which appears when it is whole.
fn write(file: &Path, text: &str) -> Result<(), String> {
    let output = Output::create(file);
    output
        .and_then(|output| output.write(|out| out.write_all(text.as_bytes())))
        .map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_without_the_extension_get_it() {
        for (given, expected) in [
            ("a.xml", "a.xml"),
            ("b/c.XML", "b/c.XML"),
            ("mesh.obj", "mesh.obj.xml"),
            ("scene", "scene.xml"),
        ] {
            assert_eq!(with_extension(Path::new(given), "xml"), Path::new(expected));
        }
    }
}
