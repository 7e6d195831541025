//! Errors about objects of a scene file, with their lines.

use crate::obj::LoadError;
use crate::scene_file::{Place, SceneFile, Shape, quoted};
use std::fmt::Display;

/// Why a scene can't hold an object of a file, and the object's place.
#[derive(Debug)]
pub(super) struct Refusal {
    pub place: Place,
    pub message: String,
}

impl Refusal {
    pub fn new(place: Place, message: impl Into<String>) -> Self {
        Self {
            place,
            message: message.into(),
        }
    }

    /// The refusal of a shape. The message begins with its type, and its identifier if it has one.
    pub fn of_shape(shape: &Shape, message: impl Display) -> Self {
        let mut name = format!("shape {}", quoted(shape.kind.name()));
        if let Some(id) = &shape.id {
            name += &format!(" with the id {}", quoted(id));
        }
        Self::new(shape.place, format!("{name}: {message}"))
    }

    pub fn in_file(self, file: &SceneFile) -> LoadError {
        LoadError::Line {
            path: file.path_of(self.place).to_owned(),
            line: self.place.line as usize,
            column: None,
            message: self.message,
        }
    }
}

/// The error about a file that an object names in its parameter “filename”.
pub(super) fn in_object(
    file: &SceneFile,
    place: Place,
    object: &str,
    error: LoadError,
) -> LoadError {
    match error {
        LoadError::Cancelled { .. } => error,
        error => Refusal::new(place, format!("{object}: “filename”: {error}")).in_file(file),
    }
}
