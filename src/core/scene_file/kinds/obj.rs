//! Meshes of OBJ files.

use super::Kind;
use crate::scene_file::problem::{Problem, quoted};
use crate::scene_file::reader::Reader;
use crate::scene_file::shapes::Parts;
use crate::scene_file::writer::Writer;
use crate::scene_file::xml::WriteError;
use std::path::{Path, PathBuf};

/// The mesh of an OBJ file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Obj {
    /// The path of the file, as seen from the directory of the program: relative names are resolved against the
    /// folder of the scene file with the name.
    pub file: PathBuf,
    /// Whether the file's normals are ignored.
    pub face_normals: bool,
    /// Whether the picture of a texture is upright for second texture coordinates that increase upwards, as in OBJ files;
    /// otherwise they increase downwards.
    pub flip_tex_coords: bool,
}

impl Kind for Obj {
    const NAME: &'static str = "obj";

    fn read(parts: &mut Parts, reader: &mut Reader) -> Result<Self, Problem> {
        let parameters = &mut parts.parameters;
        let Some((name, place)) = parameters.text("filename")? else {
            return Err(parameters.problem("parameter “filename” is missing"));
        };
        let file = reader.named_file(&name, parts.folder, place)?;
        let length = file.as_os_str().len();
        reader.memory.take(length as u64, place)?;
        let main_folder = reader.scene.files[0].parent().unwrap_or(parts.folder);
        if main_folder.join(&name) != file {
            let name = quoted(&name);
            let message =
                format!("Mitsuba looks for {name} in the folder of the main file, not of this one");
            reader.warnings.add(place, message);
        }
        Ok(Self {
            file,
            face_normals: parameters.boolean("face_normals", false)?,
            flip_tex_coords: parameters.boolean("flip_tex_coords", true)?,
        })
    }

    fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
        writer.text("filename", &name_of(&self.file, writer.folder)?)?;
        writer.boolean("face_normals", self.face_normals)?;
        writer.boolean("flip_tex_coords", self.flip_tex_coords)
    }
}

/// The name by which a scene file in `folder` refers to a file.
pub(in crate::scene_file) fn name_of(file: &Path, folder: &Path) -> Result<String, WriteError> {
    // Fails only for an empty path.
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let folder = absolute(&folder.join("."));
    let path = absolute(file);
    let path = path
        .strip_prefix(folder)
        .map_or(path.clone(), Path::to_owned);
    let error = || WriteError::new(&path.to_string_lossy(), "it isn't valid Unicode");
    path.to_str().map(str::to_owned).ok_or_else(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_in_the_folder_of_the_scene_are_named_relative_to_it() {
        let name = |file: &str, folder: &str| name_of(Path::new(file), Path::new(folder));
        assert_eq!(name("s/m/a.obj", "s").as_deref(), Ok("m/a.obj"));
        assert_eq!(name("a.obj", "").as_deref(), Ok("a.obj"));
        let elsewhere = name("a.obj", "s").expect("Unicode");
        assert!(Path::new(&elsewhere).is_absolute(), "{elsewhere}");
    }

    #[cfg(unix)]
    #[test]
    fn a_name_that_is_not_unicode_is_refused() {
        use std::os::unix::ffi::OsStrExt as _;
        let name = std::ffi::OsStr::from_bytes(b"a\xFF.obj");
        let error = name_of(Path::new(name), Path::new("")).expect_err("refused");
        assert_eq!(
            error.to_string(),
            "“a\u{FFFD}.obj” can't be written to a scene file: it isn't valid Unicode"
        );
    }
}
