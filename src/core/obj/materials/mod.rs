//! Materials: libraries, their definitions, and textures.

mod keywords;
mod libraries;
pub(crate) mod linear_picture;
mod map_file;
mod map_statements;
mod mtl;
mod picture;
mod referenced_files;
mod stored_file;
mod textures;

pub(crate) use picture::{Picture, read as read_picture};
pub use referenced_files::ReadFile;
pub(super) use referenced_files::{Folder, NamedFiles, ReferencedFiles};
pub(crate) use stored_file::read_past;

use super::Warning;
use super::contents::Contents;
use super::error::Problem;
use super::tally::shortened;
use crate::counts::{counted, grouped};
use crate::mesh::{Encoding, Material, Property, Texture};
use crate::progress::Progress;
use libraries::Libraries;
use std::collections::HashSet;
use textures::Textures;

/// The materials that faces use, in the order of their names, with their textures.
pub(super) struct ResolvedMaterials {
    pub materials: Vec<Material>,
    pub textures: Vec<Texture>,
    /// Warnings about files, then about undefined materials and skipped statements.
    pub warnings: Vec<Warning>,
}

/// Looks up every material that faces use and reads its texture.
pub(super) fn resolve(
    contents: &Contents,
    files: &dyn ReferencedFiles,
    max_memory: u64,
    progress: &Progress,
) -> Result<ResolvedMaterials, Problem> {
    let libraries = Libraries::of(contents, files, max_memory, progress)?;
    let mut textures = Textures::new(files, max_memory, progress);
    let mut unknown: Vec<&str> = Vec::new();
    let mut materials = Vec::with_capacity(contents.materials.names.len());
    let mut is_invisible_by_tr = Vec::with_capacity(contents.materials.names.len());
    for name in &contents.materials.names {
        progress.check()?;
        let Some((folder, definition)) = libraries.find(name) else {
            if !name.is_empty() {
                unknown.push(name);
            }
            materials.push(Material::named(name));
            is_invisible_by_tr.push(false);
            continue;
        };
        let mut material = Material {
            name: name.clone(),
            ..definition.material.clone()
        };
        let map = definition.diffuse_map.as_ref();
        material.diffuse_map = map.map(|map| textures.map(map, folder));
        for (property, map) in &definition.further_maps {
            let map = textures.optional_map(map, folder);
            material
                .further_maps
                .extend(map.map(|map| (*property, map.encoded(encoding(*property)))));
        }
        let relief = definition.relief.as_ref();
        material.relief = relief.and_then(|(kind, map)| textures.relief(*kind, map, folder));
        materials.push(material);
        is_invisible_by_tr.push(definition.is_invisible_only_by_tr());
    }
    let invisible = make_visible(contents, &mut materials, &is_invisible_by_tr);
    let mut warnings = libraries
        .unreadable
        .into_warnings("unreadable material libraries");
    warnings.extend(textures.warnings.into_warnings("textures"));
    warnings.extend(unknown.first().map(|first| {
        let message = format!(
            "{}, the first is “{}”",
            counted(unknown.len(), "undefined material"),
            shortened(first)
        );
        Warning::of_file(message)
    }));
    warnings.extend(libraries.warnings.into_warnings("material libraries"));
    warnings.extend(invisible);
    Ok(ResolvedMaterials {
        materials,
        textures: textures.list,
        warnings,
    })
}

/// The meaning of texels that give a property.
fn encoding(property: Property) -> Encoding {
    match property {
        Property::Specular | Property::Emission => Encoding::Srgb,
        Property::Opacity | Property::Roughness | Property::Metalness => Encoding::Linear,
    }
}

/// If every face is invisible, makes the materials opaque that only `Tr 1` makes invisible. Returns a warning.
fn make_visible(
    contents: &Contents,
    materials: &mut [Material],
    is_invisible_by_tr: &[bool],
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
    for &number in used.iter().filter(|&&number| is_invisible_by_tr[number]) {
        materials[number].opacity = 1.0;
        is_visible = true;
    }
    let message = if is_visible {
        "nothing would be visible; “Tr 1” treated as opaque"
    } else {
        "nothing is visible: the material of every face has opacity 0"
    };
    Some(Warning::of_file(message.to_owned()))
}

/// The number of warnings about one subject that are listed: as many as fit in the panel.
const MAX_LISTED: usize = 20;

/// Warnings about one subject. Keeps the first few and counts the rest.
#[derive(Default)]
struct LimitedWarnings {
    listed: Vec<Warning>,
    unlisted_count: usize,
}

impl LimitedWarnings {
    fn add(&mut self, warning: Warning) {
        if self.listed.len() < MAX_LISTED {
            self.listed.push(warning);
        } else {
            self.unlisted_count += 1;
        }
    }

    /// Counts a warning that is too late to be listed.
    fn count_only(&mut self) {
        self.unlisted_count += 1;
    }

    fn into_warnings(self, subject: &str) -> Vec<Warning> {
        let more = (self.unlisted_count > 0).then(|| {
            let count = grouped(self.unlisted_count);
            Warning::of_file(format!("{count} more warnings about {subject}"))
        });
        self.listed.into_iter().chain(more).collect()
    }
}
