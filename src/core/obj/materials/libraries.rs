//! The material libraries that an OBJ names.

use super::mtl::{self, Definition, MaterialLibrary};
use super::referenced_files::ReferencedFiles;
use super::{LimitedWarnings, MAX_LISTED};
use crate::obj::contents::Contents;
use crate::obj::error::{Problem, Warning, reason};
use crate::obj::tally::shortened;
use crate::obj::words::before_comment;
use crate::progress::Progress;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// The definitions of the materials that faces use, read from the OBJ's libraries.
pub(super) struct Libraries<'a> {
    files: &'a dyn ReferencedFiles,
    max_memory: u64,
    /// The material names that faces use, in lower case, with and without a trailing comment.
    wanted: HashSet<String>,
    progress: &'a Progress,
    /// The first definition of each material, with its library's folder.
    known: HashMap<String, (String, Definition)>,
    /// The first known name per lower-case form.
    in_lower_case: HashMap<String, String>,
    /// The paths of the libraries opened so far, and whether each could be read.
    is_readable: HashMap<PathBuf, bool>,
    /// The number of names looked up so far.
    lookup_count: usize,
    /// Warnings about libraries that can't be read, and about the content of others.
    pub unreadable: LimitedWarnings,
    pub warnings: LimitedWarnings,
}

impl<'a> Libraries<'a> {
    /// The material named by a `usemtl` statement, with or without a trailing comment, and else ignoring case.
    pub(super) fn find(&self, name: &str) -> Option<&(String, Definition)> {
        let exact = |name: &str| self.known.get(name);
        let any_case = |name: &str| exact(self.in_lower_case.get(&name.to_lowercase())?);
        let plain = before_comment(name);
        exact(name)
            .or_else(|| exact(plain?))
            .or_else(|| any_case(name))
            .or_else(|| any_case(plain?))
    }

    /// Reads all libraries that an OBJ names.
    pub(super) fn of(
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
            is_readable: HashMap::new(),
            lookup_count: 0,
            unreadable: LimitedWarnings::default(),
            warnings: LimitedWarnings::default(),
        };
        for (line, names) in &contents.libraries.names {
            libraries.read(*line, names)?;
        }
        Ok(libraries)
    }

    /// Reads the libraries of a `mtllib` statement: one library whose name may contain spaces, or several.
    fn read(&mut self, line: usize, names: &str) -> Result<(), Problem> {
        let whole = names.trim_matches('"').replace('\\', "/");
        let Err(error) = self.read_one(&whole)? else {
            return Ok(());
        };
        let mut is_any_readable = false;
        let mut missing = Vec::new();
        let several = before_comment(&whole).unwrap_or(&whole);
        for library in names_in(several).filter(|library| *library != whole) {
            match self.read_one(&library)? {
                Ok(()) => is_any_readable = true,
                Err(error) if missing.len() < MAX_LISTED => missing.push((library, error)),
                Err(_) => self.unreadable.count_only(),
            }
        }
        if !is_any_readable {
            missing = vec![(whole, error)];
        }
        for (library, error) in missing {
            let message = format!("material library “{}”: {error}", shortened(&library));
            self.unreadable.add(Warning::at(line, message));
        }
        Ok(())
    }

    /// Reads a library, unless it was read before. The inner error is the reason why it can't be read.
    fn read_one(&mut self, library: &str) -> Result<Result<(), String>, Problem> {
        /// More libraries than any real OBJ names, but few enough to look up.
        const MAX_LOOKUPS: usize = 10_000;
        self.progress.check()?;
        if library.is_empty() {
            return Ok(Err("the name is missing".to_owned()));
        }
        if self.lookup_count >= MAX_LOOKUPS {
            return Ok(Err(format!("beyond the first {MAX_LOOKUPS}")));
        }
        self.lookup_count += 1;
        let path = self.files.find(library);
        match self.is_readable.get(&path) {
            Some(true) => return Ok(Ok(())),
            Some(false) => return Ok(Err("can't be read".to_owned())),
            None => {}
        }
        let read = self.read_file(library, &path)?;
        self.is_readable.insert(path, read.is_ok());
        Ok(read)
    }

    /// Reads a library from a path. The inner error is the reason why it can't be read.
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
            self.warnings.add(warning);
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

/// Splits a list of libraries. A name ends with a word in `.mtl`; if there is none, each word is a name.
fn names_in(several: &str) -> impl Iterator<Item = String> {
    /// `PATH_MAX` on Linux.
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
