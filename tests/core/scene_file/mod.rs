//! Reading and writing scene files.

// Transforms as Mitsuba computes them.
mod mitsuba;

// Fields of view as Mitsuba computes them.
mod fields_of_view;

// Emitters and integrators.
mod emitters;

// Sensors, with their films and samplers.
mod sensors;

// Every element and parameter, and its default.
mod features;

// Refused files and their messages.
mod refused;

// Refused textures and their messages.
mod refused_textures;

// Malicious files.
mod hostile;

// Files that a scene includes.
mod includes;

// What is written reads back.
mod round_trip;

use hitscope_core::obj::LoadError;
use hitscope_core::progress::Progress;
use hitscope_core::scene_file::{self, SceneFile};
use std::io;
use std::path::Path;

const MAX_MEMORY: u64 = 1 << 30;

/// Parses a text that includes no other file.
fn parse(text: &str) -> Result<SceneFile, LoadError> {
    parse_bytes(text.as_bytes(), MAX_MEMORY)
}

fn parse_bytes(bytes: &[u8], max_memory: u64) -> Result<SceneFile, LoadError> {
    let none = |_: &Path, _: u64| Err(io::ErrorKind::NotFound.into());
    let path = Path::new("x.xml");
    scene_file::parse(bytes, path, max_memory, &none, &Progress::default())
}

/// Parses the first of some files, which may include the others.
fn parse_files(files: &[(&str, &str)]) -> Result<SceneFile, LoadError> {
    let read = |path: &Path, _: u64| {
        let file = files.iter().find(|(name, _)| Path::new(name) == path);
        let missing = || io::ErrorKind::NotFound.into();
        file.map(|(_, text)| text.as_bytes().to_vec())
            .ok_or_else(missing)
    };
    let (path, text) = (Path::new(files[0].0), files[0].1.as_bytes());
    scene_file::parse(text, path, MAX_MEMORY, &read, &Progress::default())
}

/// A scene with the given contents, which start on line 2.
fn scene(contents: &str) -> String {
    format!("<scene version='3.0.0'>\n{contents}\n</scene>\n")
}

/// The error's message, or “read”.
fn message(result: Result<SceneFile, LoadError>) -> String {
    match result {
        Ok(_) => "read".to_owned(),
        Err(error) => error.to_string(),
    }
}

/// The warnings as text.
fn warnings(scene: &SceneFile) -> Vec<String> {
    scene.warnings.iter().map(ToString::to_string).collect()
}
