//! The textures of materials.

use super::map_file::MapFile;
use super::picture::{self, Picture};
use super::referenced_files::ReferencedFiles;
use super::{LimitedWarnings, reason};
use crate::mesh::{Texture, TextureMap};
use crate::obj::error::Warning;
use crate::obj::tally::shortened;
use crate::obj::words::before_comment;
use std::collections::HashMap;
use std::path::PathBuf;

/// The textures read so far.
pub(super) struct Textures<'a> {
    files: &'a dyn ReferencedFiles,
    /// The memory left for further textures, in bytes.
    max_memory: u64,
    pub list: Vec<Texture>,
    /// Texture indices by the library's folder and the name.
    by_name: HashMap<(String, String), u32>,
    /// Texture indices by path.
    by_path: HashMap<PathBuf, u32>,
    /// The checkerboard that replaces every unreadable texture.
    checker: Option<u32>,
    pub warnings: LimitedWarnings,
}

impl<'a> Textures<'a> {
    pub(super) fn new(files: &'a dyn ReferencedFiles, max_memory: u64) -> Self {
        Self {
            files,
            max_memory,
            list: Vec::new(),
            by_name: HashMap::new(),
            by_path: HashMap::new(),
            checker: None,
            warnings: LimitedWarnings::default(),
        }
    }

    /// The map of a file in the library's folder or in the OBJ's, or the checkerboard if the file can't be read.
    pub(super) fn map(&mut self, map: &MapFile, folder: &str) -> TextureMap {
        let key = (folder.to_owned(), map.name.clone());
        let texture = match self.by_name.get(&key) {
            Some(&texture) => texture,
            None => {
                let texture = self.texture(&map.name, folder);
                self.by_name.insert(key, texture);
                texture
            }
        };
        TextureMap {
            texture,
            scale: map.scale,
            offset: map.offset,
        }
    }

    /// Looks up the texture of a new name.
    fn texture(&mut self, name: &str, folder: &str) -> u32 {
        let mut why = String::new();
        let mut names = Vec::new();
        // A # is part of the name or starts a comment.
        for name in [Some(name), before_comment(name)].into_iter().flatten() {
            if !folder.is_empty() {
                names.push(format!("{folder}/{name}"));
            }
            names.push(name.to_owned());
        }
        for name_in_folder in &names {
            let path = self.files.find(name_in_folder);
            if let Some(&texture) = self.by_path.get(&path) {
                return texture;
            }
            match self.files.read(&path, self.max_memory) {
                Ok(bytes) => {
                    let texture = self.decode(name, &bytes);
                    self.by_path.insert(path, texture);
                    return texture;
                }
                Err(error) => why = reason(&error),
            }
        }
        self.checker(name, &why)
    }

    fn decode(&mut self, name: &str, bytes: &[u8]) -> u32 {
        let left = self.max_memory.saturating_sub(bytes.len() as u64);
        let Picture {
            texture,
            is_truncated,
            is_transparent,
        } = match picture::decode(name, bytes, left) {
            Ok(picture) => picture,
            Err(why) => return self.checker(name, &why),
        };
        if is_transparent {
            self.warn(name, "transparent pixels are shown opaque");
        }
        if is_truncated {
            self.warn(name, "truncated file: part of the picture is missing");
        }
        self.max_memory = self.max_memory.saturating_sub(texture.bytes() as u64);
        self.push(texture)
    }

    /// The checkerboard that replaces an unreadable texture; adds a warning with the reason.
    fn checker(&mut self, name: &str, why: &str) -> u32 {
        self.warn(name, &format!("{why}; shown as a checkerboard"));
        if let Some(checker) = self.checker {
            return checker;
        }
        let checker = self.push(Texture::checker());
        self.checker = Some(checker);
        checker
    }

    fn warn(&mut self, name: &str, reason: &str) {
        let name = shortened(name);
        let message = format!("texture “{name}”: {reason}");
        self.warnings.add(Warning::of_file(message));
    }

    fn push(&mut self, texture: Texture) -> u32 {
        self.list.push(texture);
        self.list.len() as u32 - 1
    }
}
