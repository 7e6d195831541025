//! Light in the picture: the lights of a scene, the environment, and how the film is shown.

use super::App;
use super::scene_lights::SceneLights;
use crate::look::Look;
use crate::settings::{EnvironmentSource, Settings};
use crate::task::{Task, TaskPanicked};
use crate::tracer::Limits;
use glam::{Mat3, Vec3};
use hitscope_core::camera::UpAxis;
use hitscope_core::integrator::Lighting;
use hitscope_core::light::{Environment, EnvironmentMap, LoadedMap, MapPlacement, PlacedMap};
use hitscope_core::loading::LoadedScene;
use hitscope_core::obj::LoadError;
use hitscope_core::progress::Progress;
use hitscope_core::srgb::from_texel;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The picture of an environment in a file.
#[derive(Default)]
pub(crate) enum EnvironmentFile {
    #[default]
    None,
    Loading(PathBuf, Task<Result<LoadedMap, LoadError>>),
    Loaded(PathBuf, Arc<EnvironmentMap>),
}

impl EnvironmentFile {
    fn path(&self) -> Option<&Path> {
        match self {
            Self::None => None,
            Self::Loading(path, _) | Self::Loaded(path, _) => Some(path),
        }
    }
}

/// Whether a file's name is that of a picture of an environment.
pub(super) fn is_environment(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["hdr", "exr"]
        .iter()
        .any(|known| extension.eq_ignore_ascii_case(known))
}

impl App {
    /// The lights of a scene and the options of light transport; `None` while the view needs lights that are being made.
    pub(super) fn lighting(
        &self,
        settings: &Settings,
        loaded: &LoadedScene,
        lights: &mut SceneLights,
        ctx: &egui::Context,
    ) -> Option<Lighting> {
        if !settings.view().needs.lights {
            lights.forget_others(&loaded.scene);
            return Some(Lighting::default());
        }
        let lights = lights.get(loaded, self.environment(), ctx)?;
        let default = loaded.lighting();
        Some(Lighting {
            lights,
            spawn: settings.spawn(),
            second_spawn: settings.second_spawn(),
            ao_distance: settings.ao_distance,
            depth_limit: settings.depth_limit().or(default.depth_limit),
            terminator: settings.terminator(),
            ..default
        })
    }

    /// The environment that replaces that of the scene's file; `None` also while it is being loaded.
    fn environment(&self) -> Option<Environment> {
        let settings = &self.seen.settings;
        let brightness = settings.environment_brightness;
        let map = match settings.environment {
            EnvironmentSource::Scene => return None,
            EnvironmentSource::Colour => {
                let colour = from_texel(settings.environment_colour);
                return Some(Environment::Constant(brightness * colour));
            }
            EnvironmentSource::Studio => EnvironmentMap::built_in(),
            EnvironmentSource::File => match &self.traced.environment_file {
                EnvironmentFile::Loaded(_, map) => Arc::clone(map),
                _ => return None,
            },
        };
        let placement = MapPlacement {
            orientation: match settings.up_axis() {
                UpAxis::Y => Mat3::IDENTITY,
                UpAxis::Z => Mat3::from_cols(Vec3::X, Vec3::Z, Vec3::NEG_Y),
            },
            rotation_radians: settings.environment_degrees.to_radians(),
            scale: brightness,
        };
        Some(Environment::Map(PlacedMap::new(map, placement)))
    }

    /// Lights the scene by a picture of an environment, once it is loaded.
    pub fn set_environment(&mut self, path: &Path) {
        self.seen.settings.environment_file = Some(path.to_owned());
        self.seen.settings.environment = EnvironmentSource::File;
        // Also loads a file again that has changed.
        self.traced.environment_file = EnvironmentFile::None;
    }

    /// Collects the lights of the scene once they are made.
    pub(super) fn poll_lights(&mut self) {
        if let Err(panicked) = self.traced.lights.poll() {
            self.error(panicked);
        }
    }

    /// Loads the file of the environment if it is wanted, and limits its brightness to the film's range.
    pub(super) fn poll_environment(&mut self, ctx: &egui::Context) {
        self.load_environment(ctx);
        let settings = &mut self.seen.settings;
        if let EnvironmentFile::Loaded(_, map) = &self.traced.environment_file
            && settings.environment == EnvironmentSource::File
        {
            settings.environment_brightness =
                settings.environment_brightness.min(map.largest_scale());
        }
    }

    /// Loads the file of the environment if it is wanted. If that fails, the environment is that of the scene again.
    fn load_environment(&mut self, ctx: &egui::Context) {
        let is_wanted = self.seen.settings.environment == EnvironmentSource::File
            && (self.seen.settings.view().needs.lights
                || self.other_settings().view().needs.lights);
        let Some(path) = self
            .seen
            .settings
            .environment_file
            .clone()
            .filter(|_| is_wanted)
        else {
            return;
        };
        if self.traced.environment_file.path() != Some(&path) {
            let (file, limit) = (path.clone(), self.open.load_options.max_memory);
            let load = move || EnvironmentMap::load(&file, limit, &Progress::default());
            let task = Task::spawn("environment", ctx, load);
            self.traced.environment_file = EnvironmentFile::Loading(path.clone(), task);
        }
        let EnvironmentFile::Loading(_, task) = &self.traced.environment_file else {
            return;
        };
        let result = match task.poll() {
            Ok(None) => return,
            Ok(Some(result)) => result.map_err(|error| error.to_string()),
            Err(broken @ TaskPanicked) => Err(format!("{}: {broken}", path.display())),
        };
        match result {
            Ok(loaded) => {
                if let Some(warning) = loaded.warnings.first() {
                    self.warn(&format!("{}: {warning}", path.display()));
                }
                self.traced.environment_file = EnvironmentFile::Loaded(path, loaded.map);
            }
            Err(message) => {
                self.seen.settings.environment = EnvironmentSource::Scene;
                self.seen.settings.environment_file = None;
                self.traced.environment_file = EnvironmentFile::None;
                self.error(message);
            }
        }
    }

    /// Whether an environment is being loaded.
    pub(super) fn is_loading_environment(&self) -> bool {
        matches!(self.traced.environment_file, EnvironmentFile::Loading(..))
    }

    /// Rotates the environment by a drag to the right, in points.
    pub(super) fn rotate_environment(&mut self, drag: f32) {
        const DEGREES_PER_POINT: f32 = 0.5;
        // Counter-clockwise as seen from above moves the far side to the left.
        let degrees = self.seen.settings.environment_degrees - DEGREES_PER_POINT * drag;
        self.seen.settings.environment_degrees = degrees.rem_euclid(360.0);
    }

    /// The conditions that end refinement. Noise is that of the picture as it is exposed.
    pub(super) fn limits(&self) -> Limits {
        let settings = &self.seen.settings;
        let noise = f64::from(settings.noise_limit_percent / settings.exposure()) / 100.0;
        Limits {
            secs: settings
                .has_time_limit
                .then_some(settings.time_limit_s.into()),
            noise: settings.has_noise_limit.then_some(noise),
        }
    }

    /// What is shown of the film.
    pub(super) fn look(&self) -> Look {
        Look::of(&self.seen.settings, self.traced.tracer.shows_lit())
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
