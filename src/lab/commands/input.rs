//! Loads the scene of a command from a file or from standard input.

use super::CommandError;
use super::stderr::{print_line, print_on_terminal};
use crate::measure::scene::counted_primitives;
use crate::progress::ProgressBar;
use hitscope_core::loading::LoadedScene;
use hitscope_core::obj::{self, LoadError, LoadOptions, shown};
use hitscope_core::progress::Progress;
use hitscope_core::scene::SceneOptions;
use std::io;
use std::path::Path;

/// The name of standard input on the command line.
const STDIN: &str = "-";

/// Whether an argument names standard input.
pub fn is_stdin(path: &Path) -> bool {
    path == Path::new(STDIN)
}

/// Loads a scene from a file, or from standard input if `path` is `-`, and prints the time it took to stderr.
///
/// # Errors
/// [`CommandError::Load`].
pub(super) fn load(
    path: &Path,
    load_options: LoadOptions,
    options: SceneOptions,
) -> Result<LoadedScene, CommandError> {
    let name = name_of(path);
    let progress = Progress::default();
    let bar = ProgressBar::of_load(&progress);
    let loaded = if is_stdin(path) {
        load_stdin(name, load_options, options, &progress)?
    } else {
        LoadedScene::load(path, load_options, options, &progress)?
    };
    drop(bar);
    let contents = counted_primitives(&loaded.scene);
    let ms = (loaded.report.duration + loaded.scene.build_time()).as_secs_f64() * 1e3;
    print_on_terminal(format_args!("{}: {contents} in {ms:.0} ms", shown(name)));
    Ok(loaded)
}

/// Prints the warnings of a loaded file.
pub fn print_warnings(path: &Path, loaded: &LoadedScene) {
    for warning in &loaded.report.warnings {
        print_line(format_args!("{}: warning: {warning}", shown(name_of(path))));
    }
}

/// The name of an input in messages.
pub(super) fn name_of(path: &Path) -> &Path {
    if is_stdin(path) {
        Path::new("standard input")
    } else {
        path
    }
}

fn load_stdin(
    name: &Path,
    load_options: LoadOptions,
    options: SceneOptions,
    progress: &Progress,
) -> Result<LoadedScene, LoadError> {
    let no_folder = |_: &str| Err(io::Error::other("standard input has no folder to look in"));
    let loaded = obj::parse(io::stdin(), name, load_options, &no_folder, progress)?;
    Ok(LoadedScene::of(loaded, options, progress).expect("never cancelled"))
}
