//! Arguments that several commands share.

use super::CommandError;
use super::input::{load, print_warnings};
use clap::Args;
use clap::builder::PossibleValuesParser;
use clap::builder::TypedValueParser as _;
use hitscope_core::Scene;
use hitscope_core::integrator::{INTEGRATORS, Integrator, integrator};
use hitscope_core::intersector::Packing;
use hitscope_core::loading::{LoadedScene, is_scene_file};
use hitscope_core::obj::{FaultPolicy, LoadOptions, Recentre};
use hitscope_core::scene::{FirstTree, SceneOptions};
use std::path::Path;

/// How a mesh is loaded and stored for tracing.
#[derive(Args, Clone, Copy, Debug)]
pub struct MeshArgs {
    /// Drop faces with invalid indices, with a warning, instead of refusing the file
    #[arg(long)]
    pub lenient: bool,
    /// Memory limit.
    #[command(flatten)]
    pub memory: MemoryArg,
    /// Store triangles and tree in a third less memory; tracing is slower
    #[arg(long)]
    pub compact: bool,
}

impl MeshArgs {
    /// Loads a scene and prints the file's warnings.
    ///
    /// # Errors
    /// [`CommandError::Load`].
    pub fn load(self, path: &Path, recentre: Recentre) -> Result<LoadedScene, CommandError> {
        self.load_with_tree(path, recentre, FirstTree::Best)
    }

    /// The same as [`load`](Self::load), with a choice of the first tree.
    ///
    /// # Errors
    /// [`CommandError::Load`].
    pub(super) fn load_with_tree(
        self,
        path: &Path,
        recentre: Recentre,
        first_tree: FirstTree,
    ) -> Result<LoadedScene, CommandError> {
        let load_options = LoadOptions {
            recentre,
            faults: if self.lenient {
                FaultPolicy::Lenient
            } else {
                FaultPolicy::Strict
            },
            max_memory: self.memory.bytes(),
            ..LoadOptions::default()
        };
        let options = SceneOptions {
            packing: if self.compact {
                Packing::Compact
            } else {
                Packing::Full
            },
            first_tree,
        };
        let loaded = load(path, load_options, options)?;
        print_warnings(path, &loaded);
        Ok(loaded)
    }
}

/// Memory limit for a mesh, its textures and tree, and a picture of it.
#[derive(Args, Clone, Copy, Debug)]
pub struct MemoryArg {
    /// Refuse a file or a picture that needs more memory than this
    #[arg(long, value_name = "MB", allow_negative_numbers = true, default_value_t = LoadOptions::default().max_memory >> 20, value_parser = parse_megabytes)]
    pub max_memory: u64,
}

impl MemoryArg {
    /// The limit in bytes.
    pub fn bytes(self) -> u64 {
        self.max_memory << 20
    }

    /// The bytes that remain of the limit beside a scene whose packed primitives take `packed_bytes`.
    pub(super) fn left(self, scene: &Scene, packed_bytes: usize) -> u64 {
        self.bytes().saturating_sub(held_bytes(scene, packed_bytes))
    }

    /// Fails if `bytes` of work exceed the limit together with a scene whose packed primitives take `packed_bytes`.
    ///
    /// # Errors
    /// [`CommandError::Other`].
    pub(super) fn require(
        self,
        bytes: u64,
        scene: &Scene,
        packed_bytes: usize,
        what: std::fmt::Arguments,
    ) -> Result<(), CommandError> {
        let held = held_bytes(scene, packed_bytes);
        if held.saturating_add(bytes) <= self.bytes() {
            return Ok(());
        }
        let [bytes, held] = [bytes, held].map(|bytes| bytes.div_ceil(1 << 20));
        let limit = self.max_memory;
        Err(CommandError::Other(format!(
            "{what} takes {bytes} MB in addition to the scene's {held} MB; the limit is {limit} MB (--max-memory)"
        )))
    }
}

/// The memory of a scene and its packed primitives.
fn held_bytes(scene: &Scene, packed_bytes: usize) -> u64 {
    let mesh: usize = scene.mesh().bytes().iter().map(|(_, bytes)| bytes).sum();
    (mesh + scene.tree_bytes() + packed_bytes) as u64
}

/// The views of a picture.
#[derive(Args, Clone, Debug)]
pub struct ViewArg {
    /// View: the meaning of the colours; may be given more than once, for a picture each
    /// [default: the scene file's integrator, or shaded]
    #[arg(long, visible_alias = "integrator", value_name = "NAME", value_parser = view_names())]
    pub view: Vec<String>,
}

impl ViewArg {
    /// The views for a loaded scene, at least one.
    pub fn views(&self, loaded: &LoadedScene) -> Vec<&'static Integrator> {
        let of_file = || loaded.integrator().unwrap_or(INTEGRATORS[0]);
        self.given().unwrap_or_else(|| vec![of_file()])
    }

    /// The views, if they don't depend on the contents of the file.
    pub fn known(&self, file: &Path) -> Option<Vec<&'static Integrator>> {
        let of_mesh = || (!is_scene_file(file)).then(|| vec![INTEGRATORS[0]]);
        self.given().or_else(of_mesh)
    }

    fn given(&self) -> Option<Vec<&'static Integrator>> {
        let named = |name: &String| integrator(name).expect("clap accepts only names in the table");
        let views: Vec<_> = self.view.iter().map(named).collect();
        (!views.is_empty()).then_some(views)
    }
}

fn view_names() -> impl clap::builder::TypedValueParser<Value = String> {
    PossibleValuesParser::new(INTEGRATORS.iter().map(|view| view.name)).map(|name| name)
}

/// `4096`.
fn parse_megabytes(text: &str) -> Result<u64, String> {
    /// More bytes than this don't fit in 64 bits.
    const MOST: u64 = u64::MAX >> 20;
    match text.parse() {
        Ok(megabytes @ 1..=MOST) => Ok(megabytes),
        _ => Err(format!("expected an integer from 1 to {MOST}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_limits_are_read_or_refused_with_a_reason() {
        assert_eq!(parse_megabytes("4096"), Ok(4096));
        for bad in ["0", "-5", "17592186044416", "x", ""] {
            assert!(parse_megabytes(bad).is_err(), "{bad}");
        }
    }
}
