//! From the names that faces use to materials and textures.

use super::facts::Facts;
use super::fence::fenced;
use super::mtl::{self, Definition, MapFile};
use super::{Beside, Warning};
use crate::mesh::{Material, Texture, TextureMap};
use glam::UVec2;
use image::{ImageReader, Limits};
use std::collections::{HashMap, HashSet};
use std::io::{self, Cursor};

/// What faces look like: for each name that they use, in order, and the textures of these.
#[derive(Default)]
pub(super) struct Looks {
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
}

/// Looks up every material that faces name, and reads the pictures of those.
pub(super) fn look_up(
    facts: &Facts,
    beside: Beside,
    max_memory: u64,
    warnings: &mut Vec<Warning>,
) -> Looks {
    let mut oddities = Vec::new();
    let known = definitions(facts, beside, warnings, &mut oddities);
    let mut unknown: Vec<&str> = Vec::new();
    let mut textures = Textures {
        beside,
        max_memory,
        list: Vec::new(),
        by_name: HashMap::new(),
    };
    let materials = facts.materials.names.iter().map(|name| {
        let Some((folder, definition)) = known.get(name.as_str()) else {
            if !name.is_empty() {
                unknown.push(name);
            }
            return Material::named(name);
        };
        let mut material = definition.material.clone();
        let map = definition.diffuse_map.as_ref();
        material.diffuse_map = map.map(|map| textures.map(map, folder, warnings));
        material
    });
    let materials = materials.collect();
    if let Some(first) = unknown.first() {
        warnings.push(Warning::of_file(format!(
            "{} material(s) without a definition, “{first}” first",
            unknown.len()
        )));
    }
    warnings.extend(oddities);
    Looks {
        materials,
        textures: textures.list,
    }
}

/// Every material of every library, with the library's folder. Of several by one name the first one counts.
/// What is missing goes to the warnings, what was skipped to the oddities.
fn definitions(
    facts: &Facts,
    beside: Beside,
    warnings: &mut Vec<Warning>,
    oddities: &mut Vec<Warning>,
) -> HashMap<String, (String, Definition)> {
    let (mut known, mut seen) = (HashMap::new(), HashSet::new());
    for (line, names) in &facts.libraries {
        if !seen.insert(names) {
            continue;
        }
        for (library, read) in libraries(names, beside) {
            let bytes = match read {
                Ok(bytes) => bytes,
                Err(error) => {
                    let message = format!("material library “{library}”: {error}");
                    warnings.push(Warning::at(*line, message));
                    continue;
                }
            };
            let (materials, skipped) = mtl::parse(&bytes, &library);
            oddities.extend(skipped);
            let folder = library.rsplit_once('/').map_or("", |(folder, _)| folder);
            for definition in materials {
                let name = definition.material.name.clone();
                let found = (folder.to_owned(), definition);
                known.entry(name).or_insert(found);
            }
        }
    }
    known
}

/// The libraries that a `mtllib` names: one whose name has spaces, or several.
fn libraries(names: &str, beside: Beside) -> Vec<(String, io::Result<Vec<u8>>)> {
    let read = |name: &str| {
        let name = name.trim_matches('"').replace('\\', "/");
        let bytes = beside(&name);
        (name, bytes)
    };
    let whole = read(names);
    let words: Vec<&str> = names.split_whitespace().collect();
    if whole.1.is_ok() || words.len() < 2 {
        return vec![whole];
    }
    let each: Vec<_> = words.into_iter().map(read).collect();
    if each.iter().any(|(_, bytes)| bytes.is_ok()) {
        each
    } else {
        vec![whole]
    }
}

/// The textures so far.
struct Textures<'a> {
    beside: Beside<'a>,
    max_memory: u64,
    list: Vec<Texture>,
    by_name: HashMap<String, u32>,
}

impl Textures<'_> {
    /// A map whose picture lies in the library's folder or in the mesh's; a checker where it can't be read.
    fn map(&mut self, map: &MapFile, folder: &str, warnings: &mut Vec<Warning>) -> TextureMap {
        let in_folder = if folder.is_empty() {
            map.name.clone()
        } else {
            format!("{folder}/{}", map.name)
        };
        let texture = match self.by_name.get(&in_folder) {
            Some(&texture) => texture,
            None => {
                let bytes = (self.beside)(&in_folder).or_else(|error| match folder {
                    "" => Err(error),
                    _ => (self.beside)(&map.name),
                });
                let used: usize = self.list.iter().map(Texture::bytes).sum();
                let left = self.max_memory.saturating_sub(used as u64);
                let texture = bytes
                    .map_err(|error| error.to_string())
                    .and_then(|bytes| decoded(&map.name, &bytes, left));
                self.list.push(texture.unwrap_or_else(|error| {
                    let message = format!("texture “{}”: {error}; shown as a checker", map.name);
                    warnings.push(Warning::of_file(message));
                    Texture::checker(&map.name)
                }));
                let texture = self.list.len() as u32 - 1;
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
