//! Warnings about the contents of a scene file.

use super::Contents;
use crate::counts::grouped;
use crate::obj::{Warning, shown};
use crate::scene_file::{Place, SceneFile, Shape, ShapeKind};
use std::path::{Path, PathBuf};

impl Contents {
    /// Warns about the first shape of a kind that has a texture, but no texture coordinates.
    pub(super) fn warn_without_coordinates(&mut self, file: &SceneFile, shape: &Shape) {
        let kind = shape.kind.name();
        if self.without_coordinates.insert(kind) {
            let message = format!(
                "a shape “{kind}” has a texture, but no texture coordinates; the parameter's default is used"
            );
            self.warn(file, shape.place, message);
        }
    }

    /// Warns about parts of a shape that have no effect.
    pub(super) fn warn_about(&mut self, file: &SceneFile, shape: &Shape) {
        if let ShapeKind::Csg(csg) = &shape.kind {
            for child in &csg.children {
                if let Some(emitter) = &child.emitter {
                    let message = "an emitter of a part of a csg has no effect".to_owned();
                    self.warn(file, emitter.place, message);
                }
                self.warn_about(file, child);
            }
        }
    }

    /// Warns about a light whose sides a mirroring transform exchanges.
    pub(super) fn warn_about_mirrored_light(&mut self, file: &SceneFile, shape: &Shape) {
        if let Some(emitter) = shape.emitter.as_ref().filter(|_| !shape.flip_normals) {
            let message = "the transform mirrors the shape, so that its light shines from the other side, as in Mitsuba; “flip_normals” turns it back";
            self.warn(file, emitter.place, message.to_owned());
        }
    }

    /// Warns about solids at these places, which are empty.
    pub(super) fn warn_about_empty_solids(&mut self, file: &SceneFile, places: &[Place]) {
        let Some((first, others)) = places.split_first() else {
            return;
        };
        let others = match others.len() {
            0 => String::new(),
            1 => "; so is another one".to_owned(),
            count => format!("; so are {} others", grouped(count)),
        };
        let message = format!("the csg is empty: the boxes around its parts don't overlap{others}");
        self.warn(file, *first, message);
    }

    pub(super) fn warn(&mut self, file: &SceneFile, place: Place, message: String) {
        // Lines of included files are told with the file.
        let message = if place.file == 0 {
            message
        } else {
            format!("{}: {message}", shown(file.path_of(place)))
        };
        self.report.warnings.push(Warning {
            line: Some(place.line as usize),
            message,
        });
    }

    /// Adds the warnings about an OBJ file, and the files that it names.
    pub(super) fn take_messages(
        &mut self,
        path: &Path,
        warnings: Vec<Warning>,
        files: Vec<PathBuf>,
    ) {
        let told = warnings.into_iter().map(|warning| {
            let line = warning
                .line
                .map_or(String::new(), |line| format!(":{line}"));
            Warning {
                line: None,
                message: format!("{}{line}: {}", shown(path), warning.message),
            }
        });
        self.report.warnings.extend(told);
        self.report.files.push(path.to_owned());
        self.report.files.extend(files);
    }
}
