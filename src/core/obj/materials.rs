//! Looks up the materials that faces use, and reads their textures.

use super::Warning;
use super::contents::Contents;
use super::error::Problem;
use super::mtl::{self, Definition, MapFile, MaterialLibrary};
use super::picture::{Picture, decoded};
use super::referenced_files::ReferencedFiles;
use super::tally::shortened;
use super::words::before_comment;
use crate::counts::{counted, grouped};
use crate::mesh::{Material, Texture, TextureMap};
use crate::progress::Progress;
use std::collections::{HashMap, HashSet};
use std::io;
use std::path::{Path, PathBuf};

/// The materials that faces use, in the order of their names, and their textures.
pub(super) struct MaterialResolver {
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    /// Missing files first, then skipped statements.
    pub warnings: Vec<Warning>,
}

/// Looks up every material that faces use, and reads its texture.
pub(super) fn look_up(
    contents: &Contents,
    files: &dyn ReferencedFiles,
    max_memory: u64,
    progress: &Progress,
) -> Result<MaterialResolver, Problem> {
    let libraries = Libraries::of(contents, files, max_memory, progress)?;
    let mut textures = Textures {
        files,
        max_memory,
        list: Vec::new(),
        by_name: HashMap::new(),
        by_path: HashMap::new(),
        checker: None,
        odd: LimitedWarnings::default(),
    };
    let mut unknown: Vec<&str> = Vec::new();
    let mut materials = Vec::with_capacity(contents.materials.names.len());
    let mut is_by_transparency = Vec::with_capacity(contents.materials.names.len());
    for name in &contents.materials.names {
        progress.check()?;
        let Some((folder, definition)) = libraries.find(name) else {
            if !name.is_empty() {
                unknown.push(name);
            }
            materials.push(Material::named(name));
            is_by_transparency.push(false);
            continue;
        };
        let mut material = Material {
            name: name.clone(),
            ..definition.material.clone()
        };
        let map = definition.diffuse_map.as_ref();
        material.diffuse_map = map.map(|map| textures.map(map, folder));
        materials.push(material);
        is_by_transparency.push(definition.is_invisible_by_transparency());
    }
    let unseen = make_visible(contents, &mut materials, &is_by_transparency);
    let mut warnings = libraries.missing.warnings("material libraries");
    warnings.extend(textures.odd.warnings("textures"));
    warnings.extend(unknown.first().map(|first| {
        let message = format!(
            "{} without a definition, the first is “{}”",
            counted(unknown.len(), "material"),
            shortened(first)
        );
        Warning::of_file(message)
    }));
    warnings.extend(
        libraries
            .oddities
            .warnings("oddities of material libraries"),
    );
    warnings.extend(unseen);
    Ok(MaterialResolver {
        materials,
        textures: textures.list,
        warnings,
    })
}

/// If no face can be seen, takes those as opaque that only a `Tr 1` makes invisible. Returns the warning.
fn make_visible(
    contents: &Contents,
    materials: &mut [Material],
    is_by_transparency: &[bool],
) -> Option<Warning> {
    let runs = &contents.materials.runs;
    let before = runs
        .first()
        .is_none_or(|(first, _)| *first > 0)
        .then_some(0);
    let numbers = runs.iter().map(|(_, number)| *number as usize);
    let used: HashSet<usize> = before.into_iter().chain(numbers).collect();
    if used.iter().any(|&number| materials[number].opacity > 0.0) {
        return None;
    }
    let mut is_visible = false;
    for &number in used.iter().filter(|&&number| is_by_transparency[number]) {
        materials[number].opacity = 1.0;
        is_visible = true;
    }
    let message = if is_visible {
        "nothing would be visible: “Tr 1” taken as opaque"
    } else {
        "nothing is visible: the materials of all faces have the opacity 0"
    };
    Some(Warning::of_file(message.to_owned()))
}

/// Warnings of one kind; keeps the first ones and counts the rest.
#[derive(Default)]
struct LimitedWarnings {
    told: Vec<Warning>,
    unlisted: usize,
}

impl LimitedWarnings {
    fn add(&mut self, warning: Warning) {
        /// As many as a panel shows at once.
        const MOST_LISTED: usize = 20;
        if self.told.len() < MOST_LISTED {
            self.told.push(warning);
        } else {
            self.unlisted += 1;
        }
    }

    fn warnings(self, what: &str) -> Vec<Warning> {
        let more = (self.unlisted > 0).then(|| {
            Warning::of_file(format!("{} more {what} like these", grouped(self.unlisted)))
        });
        self.told.into_iter().chain(more).collect()
    }
}

/// Definitions of the materials that faces use.
struct Libraries<'a> {
    files: &'a dyn ReferencedFiles,
    max_memory: u64,
    /// Names that faces use, with and without a possible comment, in lower case.
    wanted: HashSet<String>,
    progress: &'a Progress,
    /// Each material with its library's folder. The first of several definitions counts.
    known: HashMap<String, (String, Definition)>,
    /// The first of the known names with each lower case.
    in_lower_case: HashMap<String, String>,
    /// Paths of libraries, and whether they could be read.
    seen: HashMap<PathBuf, bool>,
    missing: LimitedWarnings,
    oddities: LimitedWarnings,
}

impl<'a> Libraries<'a> {
    /// The material that a `usemtl` names: with a possible comment or without, and failing that in another case.
    fn find(&self, name: &str) -> Option<&(String, Definition)> {
        let exact = |name: &str| self.known.get(name);
        let any_case = |name: &str| exact(self.in_lower_case.get(&name.to_lowercase())?);
        let plain = before_comment(name);
        exact(name)
            .or_else(|| exact(plain?))
            .or_else(|| any_case(name))
            .or_else(|| any_case(plain?))
    }

    /// Reads all libraries of a file.
    fn of(
        contents: &'a Contents,
        files: &'a dyn ReferencedFiles,
        max_memory: u64,
        progress: &'a Progress,
    ) -> Result<Self, Problem> {
        let names = contents.materials.names.iter();
        let spellings = names.flat_map(|name| [Some(name.as_str()), before_comment(name)]);
        let mut libraries = Self {
            files,
            max_memory,
            wanted: spellings.flatten().map(str::to_lowercase).collect(),
            progress,
            known: HashMap::new(),
            in_lower_case: HashMap::new(),
            seen: HashMap::new(),
            missing: LimitedWarnings::default(),
            oddities: LimitedWarnings::default(),
        };
        for (line, names) in &contents.libraries.names {
            libraries.read(*line, names)?;
        }
        Ok(libraries)
    }

    /// Reads the libraries of a `mtllib` statement: one, whose name may contain spaces, or several.
    fn read(&mut self, line: usize, names: &str) -> Result<(), Problem> {
        let whole = names.trim_matches('"').replace('\\', "/");
        let Err(error) = self.read_one(&whole)? else {
            return Ok(());
        };
        let mut is_one_there = false;
        let mut missing = Vec::new();
        let several = before_comment(&whole).unwrap_or(&whole);
        for library in names_in(several).filter(|library| *library != whole) {
            match self.read_one(&library)? {
                Ok(()) => is_one_there = true,
                Err(error) => missing.push((library, error)),
            }
        }
        if !is_one_there {
            missing = vec![(whole, error)];
        }
        for (library, error) in missing {
            let message = format!("material library “{}”: {error}", shortened(&library));
            self.missing.add(Warning::at(line, message));
        }
        Ok(())
    }

    /// Reads a library unless it was read before.
    fn read_one(&mut self, library: &str) -> Result<Result<(), String>, Problem> {
        /// More than any real file has, yet few enough to look up.
        const MOST: usize = 10_000;
        self.progress.check()?;
        if library.is_empty() {
            return Ok(Err("a name is missing".to_owned()));
        }
        let path = self.files.find(library);
        match self.seen.get(&path) {
            Some(true) => return Ok(Ok(())),
            Some(false) => return Ok(Err("can't be read either".to_owned())),
            None if self.seen.len() >= MOST => return Ok(Err(format!("one of more than {MOST}"))),
            None => {}
        }
        let read = self.read_file(library, &path)?;
        self.seen.insert(path, read.is_ok());
        Ok(read)
    }

    /// Reads a library's file.
    fn read_file(&mut self, library: &str, path: &Path) -> Result<Result<(), String>, Problem> {
        let bytes = match self.files.read(path, self.max_memory) {
            Ok(bytes) => bytes,
            Err(error) => return Ok(Err(reason(&error))),
        };
        let is_wanted = |name: &str| self.wanted.contains(&name.to_lowercase());
        let Some(MaterialLibrary {
            definitions,
            warnings,
        }) = mtl::parse(&bytes, library, is_wanted, self.progress)?
        else {
            return Ok(Err("not a material library".to_owned()));
        };
        for warning in warnings {
            self.oddities.add(warning);
        }
        let folder = library.rsplit_once('/').map_or("", |(folder, _)| folder);
        for definition in definitions {
            let name = definition.material.name.clone();
            let found = (folder.to_owned(), definition);
            let lower_case = self.in_lower_case.entry(name.to_lowercase());
            lower_case.or_insert_with(|| name.clone());
            self.known.entry(name).or_insert(found);
        }
        Ok(Ok(()))
    }
}

/// The names of several libraries. Each ends with a word in `.mtl`; without such a word, each word is a name.
fn names_in(several: &str) -> impl Iterator<Item = String> {
    /// The longest path on Linux.
    const LONGEST_NAME: usize = 4096;
    let is_end = |word: &str| word.trim_end_matches('"').to_lowercase().ends_with(".mtl");
    let has_ends = several.split_whitespace().any(is_end);
    let mut words = several.split_whitespace();
    std::iter::from_fn(move || {
        let mut word = words.next()?;
        let mut name = word.to_owned();
        while has_ends && !is_end(word) && name.len() < LONGEST_NAME {
            let Some(next) = words.next() else { break };
            word = next;
            name.push(' ');
            name.push_str(word);
        }
        Some(name.trim_matches('"').to_owned())
    })
}

/// The reason why a file can't be read, for messages.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "not found".to_owned(),
        _ => error.to_string(),
    }
}

/// State of reading textures.
struct Textures<'a> {
    files: &'a dyn ReferencedFiles,
    /// Memory in bytes that further textures may use.
    max_memory: u64,
    list: Vec<Texture>,
    /// The texture of each name looked up.
    by_name: HashMap<String, u32>,
    /// The texture of each file read.
    by_path: HashMap<PathBuf, u32>,
    /// Checkerboard in place of all textures that can't be read.
    checker: Option<u32>,
    odd: LimitedWarnings,
}

impl Textures<'_> {
    /// A map whose picture is in the library's folder or the mesh's, or a checker if it can't be read.
    fn map(&mut self, map: &MapFile, folder: &str) -> TextureMap {
        let in_folder = if folder.is_empty() {
            map.name.clone()
        } else {
            format!("{folder}/{}", map.name)
        };
        let texture = match self.by_name.get(&in_folder) {
            Some(&texture) => texture,
            None => {
                let texture = self.texture(&map.name, &in_folder, folder);
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

    /// The texture of a name that wasn't looked up before.
    fn texture(&mut self, name: &str, in_folder: &str, folder: &str) -> u32 {
        let mut why = String::new();
        let mut names = vec![in_folder.to_owned(), name.to_owned()];
        // A name may contain a #, but a comment may also follow it.
        if let Some(plain) = before_comment(name) {
            names.extend([format!("{folder}/{plain}"), plain.to_owned()]);
        }
        if folder.is_empty() {
            names = names.into_iter().skip(1).step_by(2).collect();
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
            is_cut_short,
            is_transparent,
        } = match decoded(name, bytes, left) {
            Ok(picture) => picture,
            Err(why) => return self.checker(name, &why),
        };
        if is_transparent {
            self.warn(name, "transparent places are shown opaque");
        }
        if is_cut_short {
            self.warn(name, "the file ends early: part of the picture is missing");
        }
        self.max_memory = self.max_memory.saturating_sub(texture.bytes() as u64);
        self.push(texture)
    }

    /// The checkerboard shown in place of a texture that can't be read.
    fn checker(&mut self, name: &str, why: &str) -> u32 {
        self.warn(name, &format!("{why}; shown as a checker"));
        let checker = self.checker;
        let checker = checker.unwrap_or_else(|| self.push(Texture::checker()));
        self.checker = Some(checker);
        checker
    }

    fn warn(&mut self, name: &str, what: &str) {
        let name = shortened(name);
        let message = format!("texture “{name}”: {what}");
        self.odd.add(Warning::of_file(message));
    }

    fn push(&mut self, texture: Texture) -> u32 {
        self.list.push(texture);
        self.list.len() as u32 - 1
    }
}
