//! The textures of materials.

use super::LimitedWarnings;
use super::map_file::MapFile;
use super::map_statements::ReliefStatement;
use super::picture::{self, Picture};
use super::referenced_files::ReferencedFiles;
use crate::mesh::{Bitangent, Encoding, HeightUnit, Relief, ReliefKind, Texture, TextureMap};
use crate::obj::error::{Warning, reason};
use crate::obj::tally::shortened;
use crate::obj::words::before_comment;
use crate::progress::Progress;
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

/// The textures read so far.
pub(super) struct Textures<'a> {
    files: &'a dyn ReferencedFiles,
    /// The memory left for further textures, in bytes.
    max_memory: u64,
    progress: &'a Progress,
    pub list: Vec<Texture>,
    /// Texture indices by the library's folder and the name; `None` for an unreadable one.
    by_name: HashMap<(String, String), Option<u32>>,
    /// Texture indices by path.
    by_path: HashMap<PathBuf, u32>,
    /// Textures of bump statements that were found to hold normals.
    normal_maps: HashSet<u32>,
    /// The checkerboard that replaces every unreadable texture.
    checker: Option<u32>,
    pub warnings: LimitedWarnings,
}

impl<'a> Textures<'a> {
    pub(super) fn new(
        files: &'a dyn ReferencedFiles,
        max_memory: u64,
        progress: &'a Progress,
    ) -> Self {
        Self {
            files,
            max_memory,
            progress,
            list: Vec::new(),
            by_name: HashMap::new(),
            by_path: HashMap::new(),
            normal_maps: HashSet::new(),
            checker: None,
            warnings: LimitedWarnings::default(),
        }
    }

    /// The map of a file in the library's folder or in the OBJ's, or the checkerboard if the file can't be read.
    pub(super) fn map(&mut self, map: &MapFile, folder: &str) -> TextureMap {
        let found = self.texture(map, folder, "shown as a checkerboard");
        placed(map, found.unwrap_or_else(|| self.checker()))
    }

    /// The map of a file in the library's folder or in the OBJ's, or `None` if the file can't be read.
    pub(super) fn optional_map(&mut self, map: &MapFile, folder: &str) -> Option<TextureMap> {
        let found = self.texture(map, folder, "ignored");
        found.map(|texture| placed(map, texture))
    }

    /// The relief of a file in the library's folder or in the OBJ's, or `None` if the file can't be read. Heights are in
    /// widths of a texel. Some programs write normal maps as heights.
    pub(super) fn relief(
        &mut self,
        statement: ReliefStatement,
        map: &MapFile,
        folder: &str,
    ) -> Option<Relief> {
        let placed = self.optional_map(map, folder)?.encoded(Encoding::Linear);
        let is_normal_map = self.list[placed.texture as usize].looks_like_normals();
        if statement == ReliefStatement::Bump
            && is_normal_map
            && self.normal_maps.insert(placed.texture)
        {
            let message = "looks like a normal map, and is used as one instead of as a bump map";
            self.warn(&map.name, message);
        }
        let kind = if statement == ReliefStatement::Normals || is_normal_map {
            ReliefKind::Normals {
                strength: map.multiplier,
                bitangent: Bitangent::AlongTexture,
            }
        } else {
            ReliefKind::Heights {
                scale: map.multiplier,
                unit: HeightUnit::Texel,
            }
        };
        Some(Relief { map: placed, kind })
    }

    /// A texture; `None` if it can't be read, with a warning that names the `consequence`, at the first look-up.
    fn texture(&mut self, map: &MapFile, folder: &str, consequence: &str) -> Option<u32> {
        let key = (folder.to_owned(), map.name.clone());
        if let Some(&known) = self.by_name.get(&key) {
            return known;
        }
        let found = self.new_texture(&map.name, folder);
        if let Err(why) = &found {
            self.warn(&map.name, &format!("{why}; {consequence}"));
        }
        let found = found.ok();
        self.by_name.insert(key, found);
        found
    }

    /// Looks up the texture of a new name.
    ///
    /// # Errors
    /// Why it can't be read.
    fn new_texture(&mut self, name: &str, folder: &str) -> Result<u32, String> {
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
                return Ok(texture);
            }
            match self.files.read(&path, self.max_memory) {
                Ok(bytes) => {
                    let texture = self.decode(name, &bytes)?;
                    self.by_path.insert(path, texture);
                    return Ok(texture);
                }
                Err(error) => why = reason(&error),
            }
        }
        Err(why)
    }

    fn decode(&mut self, name: &str, bytes: &[u8]) -> Result<u32, String> {
        let left = self.max_memory.saturating_sub(bytes.len() as u64);
        let Picture { texture, fault } = picture::decode(name, bytes, left, self.progress)?;
        if let Some(fault) = fault {
            self.warn(name, &fault);
        }
        self.max_memory = self.max_memory.saturating_sub(texture.bytes() as u64);
        Ok(self.push(texture))
    }

    /// The checkerboard that replaces an unreadable texture.
    fn checker(&mut self) -> u32 {
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

fn placed(map: &MapFile, texture: u32) -> TextureMap {
    TextureMap::of(texture).placed(map.scale, map.offset)
}
