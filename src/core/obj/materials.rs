//! From the names that faces use to materials and textures.

use super::error::Problem;
use super::facts::Facts;
use super::fence::fenced;
use super::mtl::{self, Definition, MapFile};
use super::{Beside, Warning};
use crate::mesh::{Material, Texture, TextureMap};
use crate::progress::Progress;
use glam::UVec2;
use image::{ImageReader, Limits};
use std::collections::{HashMap, HashSet};
use std::io::{self, Cursor};

/// What faces look like: for each name that they use, in order, and the textures of these.
#[derive(Default)]
pub(super) struct Looks {
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    /// What is missing, then what was skipped.
    pub warnings: Vec<Warning>,
}

/// Looks up every material that faces name, and reads the pictures of those.
pub(super) fn look_up(
    facts: &Facts,
    beside: Beside,
    max_memory: u64,
    progress: &Progress,
) -> Result<Looks, Problem> {
    let mut libraries = Libraries::default();
    libraries.read_all(facts, beside, progress)?;
    let mut textures = Textures {
        beside,
        max_memory,
        list: Vec::new(),
        by_name: HashMap::new(),
        checker: None,
        missing: Missing::default(),
    };
    let mut unknown: Vec<&str> = Vec::new();
    let mut materials = Vec::with_capacity(facts.materials.names.len());
    for name in &facts.materials.names {
        progress.check()?;
        let Some((folder, definition)) = libraries.known.get(name.as_str()) else {
            if !name.is_empty() {
                unknown.push(name);
            }
            materials.push(Material::named(name));
            continue;
        };
        let mut material = definition.material.clone();
        let map = definition.diffuse_map.as_ref();
        material.diffuse_map = map.map(|map| textures.map(map, folder));
        materials.push(material);
    }
    let mut warnings = libraries.missing.warnings("material libraries");
    warnings.extend(textures.missing.warnings("textures"));
    warnings.extend(unknown.first().map(|first| {
        let count = unknown.len();
        let message = format!("{count} material(s) without a definition, “{first}” first");
        Warning::of_file(message)
    }));
    warnings.extend(
        libraries
            .oddities
            .warnings("oddities of material libraries"),
    );
    Ok(Looks {
        materials,
        textures: textures.list,
        warnings,
    })
}

/// Warnings of one kind, of which only so many are told one by one.
#[derive(Default)]
struct Missing {
    told: Vec<Warning>,
    untold: usize,
}

impl Missing {
    fn add(&mut self, warning: Warning) {
        const MOST_TOLD: usize = 20;
        if self.told.len() < MOST_TOLD {
            self.told.push(warning);
        } else {
            self.untold += 1;
        }
    }

    fn warnings(self, what: &str) -> Vec<Warning> {
        let more = (self.untold > 0)
            .then(|| Warning::of_file(format!("{} more {what} like these", self.untold)));
        self.told.into_iter().chain(more).collect()
    }
}

/// What the libraries say of the materials that faces name.
#[derive(Default)]
struct Libraries {
    /// Each material with its library's folder. Of several by one name the first one counts.
    known: HashMap<String, (String, Definition)>,
    seen: HashSet<String>,
    missing: Missing,
    oddities: Missing,
}

impl Libraries {
    fn read_all(
        &mut self,
        facts: &Facts,
        beside: Beside,
        progress: &Progress,
    ) -> Result<(), Problem> {
        let wanted: HashSet<&str> = facts.materials.names.iter().map(String::as_str).collect();
        for (line, names) in &facts.libraries {
            progress.check()?;
            for (library, bytes) in self.bytes_of(names, beside) {
                let bytes = match bytes {
                    Ok(bytes) => bytes,
                    Err(error) => {
                        let message = format!("material library “{library}”: {error}");
                        self.missing.add(Warning::at(*line, message));
                        continue;
                    }
                };
                let is_wanted = |name: &str| wanted.contains(name);
                let (definitions, oddities) = mtl::parse(&bytes, &library, is_wanted, progress)?;
                oddities
                    .into_iter()
                    .for_each(|oddity| self.oddities.add(oddity));
                let folder = library.rsplit_once('/').map_or("", |(folder, _)| folder);
                for definition in definitions {
                    let name = definition.material.name.clone();
                    let found = (folder.to_owned(), definition);
                    self.known.entry(name).or_insert(found);
                }
            }
        }
        Ok(())
    }

    /// The libraries that a `mtllib` names and that weren't read before: one whose name has spaces, or
    /// several.
    fn bytes_of(&mut self, names: &str, beside: Beside) -> Vec<(String, io::Result<Vec<u8>>)> {
        let plain = |name: &str| name.trim_matches('"').replace('\\', "/");
        let whole = plain(names);
        if !self.seen.insert(whole.clone()) {
            return Vec::new();
        }
        let bytes = beside(&whole);
        if bytes.is_ok() || !names.contains(char::is_whitespace) {
            return vec![(whole, bytes)];
        }
        let words = names.split_whitespace().map(plain);
        let mut is_one_there = false;
        let mut each = Vec::new();
        for word in words.filter(|word| self.seen.insert(word.clone())) {
            let bytes = beside(&word);
            is_one_there |= bytes.is_ok();
            each.push((word, bytes));
        }
        if is_one_there {
            each
        } else {
            vec![(whole, bytes)]
        }
    }
}

/// The textures so far.
struct Textures<'a> {
    beside: Beside<'a>,
    /// Bytes that may be taken by those that are still to come.
    max_memory: u64,
    list: Vec<Texture>,
    by_name: HashMap<String, u32>,
    /// Stands in for all that are missing.
    checker: Option<u32>,
    missing: Missing,
}

impl Textures<'_> {
    /// A map whose picture lies in the library's folder or in the mesh's; a checker where it can't be read.
    fn map(&mut self, map: &MapFile, folder: &str) -> TextureMap {
        let in_folder = if folder.is_empty() {
            map.name.clone()
        } else {
            format!("{folder}/{}", map.name)
        };
        let texture = match self.by_name.get(&in_folder) {
            Some(&texture) => texture,
            None => {
                let texture = self.read(&map.name, &in_folder);
                self.by_name.insert(in_folder, texture);
                texture
            }
        };
        TextureMap {
            texture,
            scale: map.scale,
            offset: map.offset,
        }
    }

    fn read(&mut self, name: &str, in_folder: &str) -> u32 {
        let bytes = (self.beside)(in_folder).or_else(|error| {
            if in_folder == name {
                Err(error)
            } else {
                (self.beside)(name)
            }
        });
        let picture = bytes
            .map_err(|error| error.to_string())
            .and_then(|bytes| decoded(name, &bytes, self.max_memory));
        match picture {
            Ok(texture) => {
                self.max_memory = self.max_memory.saturating_sub(texture.bytes() as u64);
                self.push(texture)
            }
            Err(error) => {
                let message = format!("texture “{name}”: {error}; shown as a checker");
                self.missing.add(Warning::of_file(message));
                let checker = self.checker;
                let checker = checker.unwrap_or_else(|| self.push(Texture::checker()));
                self.checker = Some(checker);
                checker
            }
        }
    }

    fn push(&mut self, texture: Texture) -> u32 {
        self.list.push(texture);
        self.list.len() as u32 - 1
    }
}

/// A PNG or JPEG of at most so many bytes unpacked.
fn decoded(name: &str, bytes: &[u8], max_bytes: u64) -> Result<Texture, String> {
    let decode = || -> Result<image::RgbImage, image::ImageError> {
        let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format()?;
        let mut limits = Limits::default();
        limits.max_alloc = Some(max_bytes.min(limits.max_alloc.unwrap_or(u64::MAX)));
        reader.limits(limits);
        Ok(reader.decode()?.into_rgb8())
    };
    let picture = match fenced("decoding", decode) {
        Ok(decoded) => decoded.map_err(|error| error.to_string())?,
        Err(problem) => return Err(problem.in_file(name.as_ref()).to_string()),
    };
    let size = UVec2::new(picture.width(), picture.height());
    let texels = picture.pixels().map(|pixel| pixel.0).collect();
    Texture::new(name, size, texels).ok_or_else(|| "an empty picture".to_owned())
}
