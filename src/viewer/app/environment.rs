//! The environment that lights the scene in place of its own: a colour, the built-in studio, or a picture in a file.

use super::App;
use crate::settings::EnvironmentSource;
use crate::task::{Task, TaskPanicked};
use hitscope_core::light::{
    Environment, EnvironmentMap, Light, LoadedMap, MapPlacement, PlacedMap,
};
use hitscope_core::obj::{LoadError, shown};
use hitscope_core::progress::Progress;
use hitscope_core::srgb::from_texel;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The environment pictures in files: the one that is loaded, and the one that is being loaded.
#[derive(Default)]
pub(crate) struct EnvironmentFiles {
    /// The picture that was loaded last.
    loaded: Option<(PathBuf, Arc<EnvironmentMap>)>,
    loading: Option<LoadingFile>,
}

/// A picture of an environment that is being loaded.
struct LoadingFile {
    path: PathBuf,
    task: Task<Result<LoadedMap, LoadError>>,
    /// Whether the user opened the file, so that it is used once it is loaded.
    is_opened: bool,
}

impl EnvironmentFiles {
    /// The picture in a file, if it is loaded.
    fn map(&self, path: &Path) -> Option<&Arc<EnvironmentMap>> {
        let (loaded, map) = self.loaded.as_ref()?;
        (loaded == path).then_some(map)
    }
}

/// Whether a path has the extension of an environment picture.
pub(super) fn is_environment(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["hdr", "exr"]
        .iter()
        .any(|known| extension.eq_ignore_ascii_case(known))
}

impl App {
    /// The environment that replaces that of the scene's file; `None` if none does, and while it is being loaded.
    pub(super) fn environment(&self) -> Option<Environment> {
        let settings = &self.seen.settings;
        let brightness = settings.environment_brightness;
        let map = match settings.environment() {
            EnvironmentSource::Scene => return None,
            EnvironmentSource::Colour => {
                let colour = from_texel(settings.environment_colour);
                return Some(Environment::Constant(brightness * colour));
            }
            EnvironmentSource::Studio => EnvironmentMap::built_in(),
            EnvironmentSource::File => {
                let path = settings.environment_file.as_ref()?;
                Arc::clone(self.traced.environment_files.map(path)?)
            }
        };
        let placement = MapPlacement {
            rotation_radians: settings.environment_degrees.to_radians(),
            scale: brightness,
            ..MapPlacement::upright(settings.up_axis())
        };
        Some(Environment::Map(PlacedMap::new(map, placement)))
    }

    /// Lights the scene with the environment picture in a file, once it is loaded. Until then, and if loading fails,
    /// the lighting doesn't change. A file that is already loaded is loaded again, because it may have changed.
    pub(super) fn open_environment(&mut self, path: &Path, ctx: &egui::Context) {
        self.load_environment(path.to_owned(), true, ctx);
    }

    fn load_environment(&mut self, path: PathBuf, is_opened: bool, ctx: &egui::Context) {
        let (file, limit) = (path.clone(), self.open.load_options.max_memory);
        let load = move || EnvironmentMap::load(&file, limit, &Progress::default());
        self.traced.environment_files.loading = Some(LoadingFile {
            path,
            task: Task::spawn("environment", ctx, load),
            is_opened,
        });
    }

    /// Loads the file of the environment if the settings name one that isn't loaded, and limits its brightness to the
    /// film's range.
    pub(super) fn poll_environment(&mut self, ctx: &egui::Context) {
        self.load_wanted_environment(ctx);
        self.take_loaded_environment();
        let settings = &mut self.seen.settings;
        if settings.environment() == EnvironmentSource::File
            && let Some(path) = &settings.environment_file
            && let Some(map) = self.traced.environment_files.map(path)
        {
            settings.environment_brightness =
                settings.environment_brightness.min(map.largest_scale());
        }
    }

    fn load_wanted_environment(&mut self, ctx: &egui::Context) {
        let is_wanted = self.seen.settings.environment() == EnvironmentSource::File
            && (self.seen.settings.view().needs.lights
                || self.other_settings().view().needs.lights);
        let files = &self.traced.environment_files;
        if let Some(path) = &self.seen.settings.environment_file
            && is_wanted
            && files.loading.is_none()
            && files.map(path).is_none()
        {
            self.load_environment(path.clone(), false, ctx);
        }
    }

    fn take_loaded_environment(&mut self) {
        let Some(loading) = &self.traced.environment_files.loading else {
            return;
        };
        let (path, is_opened) = (loading.path.clone(), loading.is_opened);
        let result = match loading.task.poll() {
            Ok(None) => return,
            Ok(Some(result)) => result.map_err(|error| error.to_string()),
            Err(broken @ TaskPanicked) => Err(format!("{}: {broken}", path.display())),
        };
        self.traced.environment_files.loading = None;
        match result {
            Ok(loaded) => {
                if let Some(warning) = loaded.warnings.first() {
                    self.warn(&format!("{}: {warning}", path.display()));
                }
                if is_opened {
                    self.seen.settings.keep_environment_file(&path);
                }
                self.traced.environment_files.loaded = Some((path, loaded.map));
            }
            Err(message) => {
                let settings = &mut self.seen.settings;
                // A file that the user opened isn't in the settings yet. Otherwise the settings name a file that can't
                // be loaded.
                if !is_opened && settings.environment_file.as_ref() == Some(&path) {
                    settings.keep_environment(EnvironmentSource::Scene);
                    settings.environment_file = None;
                }
                self.error(message);
            }
        }
    }

    /// Whether an environment is being loaded.
    pub(super) fn is_loading_environment(&self) -> bool {
        self.traced.environment_files.loading.is_some()
    }

    /// Uses the environment of the opened file, if it has one, instead of the chosen one, and shows a message about
    /// that. Other lights of the file are combined with the chosen environment.
    pub(super) fn use_environment_of_file(&mut self) {
        let lights = &self.open.document.loaded.lights;
        let has_environment = lights
            .iter()
            .any(|light| matches!(light, Light::Environment(_)));
        let settings = &mut self.seen.settings;
        settings.has_file_environment = has_environment;
        let chosen = match settings.environment {
            _ if !has_environment => return,
            EnvironmentSource::Scene => return,
            EnvironmentSource::Colour => "the chosen colour".to_owned(),
            EnvironmentSource::Studio => "the studio".to_owned(),
            EnvironmentSource::File => {
                let path = settings.environment_file.as_deref();
                let name = path.and_then(Path::file_name).unwrap_or_default();
                format!("“{}”", shown(Path::new(name)))
            }
        };
        self.tell(format!(
            "This scene has an environment of its own, which is used instead of {chosen}"
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn environments_are_recognized_by_their_extension() {
        for (name, expected) in [
            ("sky.hdr", true),
            ("a/SKY.EXR", true),
            ("hdr", false),
            ("sky.hdr.obj", false),
        ] {
            assert_eq!(is_environment(Path::new(name)), expected, "{name}");
        }
    }
}
