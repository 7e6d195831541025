//! What do the materials look like that faces name?

use super::error::Problem;
use super::facts::{Facts, shortened};
use super::fence::fenced;
use super::mtl::{self, Definition, MapFile};
use super::words::before_comment;
use super::{ReadFile, Warning};
use crate::mesh::{Material, Texture, TextureMap};
use crate::progress::Progress;
use glam::UVec2;
use image::{ImageReader, Limits};
use std::collections::{HashMap, HashSet};
use std::io::{self, Cursor};

/// What faces look like: for each name that they use, in order, and the textures of these.
pub(super) struct MaterialResolver {
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    /// What is missing, then what was skipped.
    pub warnings: Vec<Warning>,
}

/// Looks up every material that faces name, and reads the pictures of those.
pub(super) fn look_up(
    facts: &Facts,
    read_file: ReadFile,
    max_memory: u64,
    progress: &Progress,
) -> Result<MaterialResolver, Problem> {
    let libraries = Libraries::of(facts, read_file, progress)?;
    let mut textures = Textures {
        read_file,
        max_memory,
        list: Vec::new(),
        by_name: HashMap::new(),
        checker: None,
        missing: LimitedWarnings::default(),
    };
    let mut unknown: Vec<&str> = Vec::new();
    let mut materials = Vec::with_capacity(facts.materials.names.len());
    for name in &facts.materials.names {
        progress.check()?;
        let known = |name: &str| libraries.known.get(name);
        let found = known(name).or_else(|| known(before_comment(name)?));
        let Some((folder, definition)) = found else {
            if !name.is_empty() {
                unknown.push(name);
            }
            materials.push(Material::named(name));
            continue;
        };
        let mut material = Material {
            name: name.clone(),
            ..definition.material.clone()
        };
        let map = definition.diffuse_map.as_ref();
        material.diffuse_map = map.map(|map| textures.map(map, folder));
        materials.push(material);
    }
    let mut warnings = libraries.missing.warnings("material libraries");
    warnings.extend(textures.missing.warnings("textures"));
    warnings.extend(unknown.first().map(|first| {
        let count = unknown.len();
        let message = format!(
            "{count} material(s) without a definition, “{}” first",
            shortened(first)
        );
        Warning::of_file(message)
    }));
    warnings.extend(
        libraries
            .oddities
            .warnings("oddities of material libraries"),
    );
    Ok(MaterialResolver {
        materials,
        textures: textures.list,
        warnings,
    })
}

/// Warnings of one kind, of which only so many are told one by one.
#[derive(Default)]
struct LimitedWarnings {
    told: Vec<Warning>,
    untold: usize,
}

impl LimitedWarnings {
    fn add(&mut self, warning: Warning) {
        /// As many as a panel shows at once.
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
struct Libraries<'a> {
    read_file: ReadFile<'a>,
    /// The names that faces use, with and without what may be a comment.
    wanted: HashSet<&'a str>,
    progress: &'a Progress,
    /// Each material with its library's folder. Of several by one name the first one counts.
    known: HashMap<String, (String, Definition)>,
    /// Names that were looked for, and whether they were found.
    seen: HashMap<String, bool>,
    missing: LimitedWarnings,
    oddities: LimitedWarnings,
}

impl<'a> Libraries<'a> {
    /// Reads every library of a file.
    fn of(
        facts: &'a Facts,
        read_file: ReadFile<'a>,
        progress: &'a Progress,
    ) -> Result<Self, Problem> {
        let names = facts.materials.names.iter();
        let spellings = names.flat_map(|name| [Some(name.as_str()), before_comment(name)]);
        let mut libraries = Self {
            read_file,
            wanted: spellings.flatten().collect(),
            progress,
            known: HashMap::new(),
            seen: HashMap::new(),
            missing: LimitedWarnings::default(),
            oddities: LimitedWarnings::default(),
        };
        for (line, names) in &facts.libraries.names {
            libraries.read(*line, names)?;
        }
        Ok(libraries)
    }

    /// What a `mtllib` names: one library whose name may have spaces, or several.
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
        /// Far more than any file has, and few enough to look for.
        const MOST: usize = 10_000;
        self.progress.check()?;
        if library.is_empty() {
            return Ok(Err("a name is missing".to_owned()));
        }
        match self.seen.get(library) {
            Some(true) => return Ok(Ok(())),
            Some(false) => return Ok(Err("can't be read either".to_owned())),
            None if self.seen.len() >= MOST => return Ok(Err(format!("one of more than {MOST}"))),
            None => {}
        }
        let bytes = (self.read_file)(library);
        self.seen.insert(library.to_owned(), bytes.is_ok());
        let bytes = match bytes {
            Ok(bytes) => bytes,
            Err(error) => return Ok(Err(reason(&error))),
        };
        let is_wanted = |name: &str| self.wanted.contains(name);
        let (definitions, odd) = mtl::parse(&bytes, library, is_wanted, self.progress)?;
        odd.into_iter().for_each(|oddity| self.oddities.add(oddity));
        let folder = library.rsplit_once('/').map_or("", |(folder, _)| folder);
        for definition in definitions {
            let name = definition.material.name.clone();
            let found = (folder.to_owned(), definition);
            self.known.entry(name).or_insert(found);
        }
        Ok(Ok(()))
    }
}

/// Several libraries: each goes to where a word ends in `.mtl`; where none does, each is a word.
fn names_in(several: &str) -> impl Iterator<Item = String> {
    /// What Linux takes for a whole path.
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

/// Why a file can't be read.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "not found".to_owned(),
        _ => error.to_string(),
    }
}

/// The textures so far.
struct Textures<'a> {
    read_file: ReadFile<'a>,
    /// Bytes that may be taken by those that are still to come.
    max_memory: u64,
    list: Vec<Texture>,
    by_name: HashMap<String, u32>,
    /// Stands in for all that are missing.
    checker: Option<u32>,
    missing: LimitedWarnings,
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
        let bytes = (self.read_file)(in_folder).or_else(|error| {
            if in_folder == name {
                Err(error)
            } else {
                (self.read_file)(name)
            }
        });
        let picture = bytes
            .map_err(|error| reason(&error))
            .and_then(|bytes| decoded(name, &bytes, self.max_memory));
        match picture {
            Ok(texture) => {
                self.max_memory = self.max_memory.saturating_sub(texture.bytes() as u64);
                self.push(texture)
            }
            Err(error) => {
                let name = shortened(name);
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
        // What the picture has besides red, green and blue of eight bits is converted, which needs both.
        let half = max_bytes / 2;
        limits.max_alloc = Some(limits.max_alloc.map_or(half, |most| most.min(half)));
        reader.limits(limits);
        Ok(reader.decode()?.into_rgb8())
    };
    let picture = match fenced("decoding", decode) {
        Ok(decoded) => decoded.map_err(|error| error.to_string())?,
        Err(Problem::Content(message)) => return Err(message),
        Err(_) => return Err("decoding failed".to_owned()),
    };
    let size = UVec2::new(picture.width(), picture.height());
    Texture::new(name, size, picture.into_raw()).ok_or_else(|| "an empty picture".to_owned())
}
