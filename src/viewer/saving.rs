//! Saving of the open document as a scene file, in the background.

use crate::document::Document;
use crate::task::{Task, TaskPanicked};
use hitscope_core::Camera;
use hitscope_core::loading::{StartView, is_scene_file, scene_text};
use hitscope_core::obj::shown;
use hitscope_lab::commands::Output;
use std::path::{Path, PathBuf};

/// A scene file that is being written.
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
        let file = with_extension(path);
        if file != path && file.exists() {
            return Err(NotSaved::Exists(file));
        }
        let loaded = &document.loaded;
        let view = StartView::of_camera(camera, loaded.scene.mesh().origin());
        let description = loaded.description.clone();
        let path = file.clone();
        let write = move || {
            let folder = file.parent().unwrap_or(Path::new(""));
            let text = scene_text(description.as_deref(), &own, &view, folder);
            let text = text.map_err(|error| error.to_string())?;
            let output = Output::create(&file);
            output
                .and_then(|output| output.write(|out| out.write_all(text.as_bytes())))
                .map_err(|error| error.to_string())
        };
        let task = Task::spawn("save", ctx, write);
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

/// The path with `.xml` at its end.
fn with_extension(path: &Path) -> PathBuf {
    if is_scene_file(path) {
        return path.to_owned();
    }
    let mut name = path.as_os_str().to_owned();
    name.push(".xml");
    name.into()
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
            assert_eq!(with_extension(Path::new(given)), Path::new(expected));
        }
    }
}
