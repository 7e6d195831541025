//! Light in the picture: the lights of a scene, the environment, and how the film is shown.

use super::App;
use crate::look::Look;
use crate::settings::Settings;
use crate::tracer::Limits;
use glam::Vec3;
use hitscope_core::Scene;
use hitscope_core::integrator::Lighting;
use hitscope_core::light::{Environment, Light, Lights};
use hitscope_core::srgb::from_texel;
use std::path::Path;
use std::sync::Arc;

/// The lights of a scene, and what they were made from.
pub(super) struct SceneLights {
    scene: Arc<Scene>,
    environment: Vec3,
    lights: Arc<Lights>,
}

/// Whether a file's name is that of a picture of an environment.
pub(super) fn is_environment(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    ["hdr", "exr"]
        .iter()
        .any(|known| extension.eq_ignore_ascii_case(known))
}

/// The radiance of the environment.
fn environment(settings: &Settings) -> Vec3 {
    settings.environment_brightness * from_texel(settings.environment_colour)
}

impl App {
    /// The lights of the scene and the options of light transport.
    pub(super) fn lighting(&mut self) -> Lighting {
        let settings = &self.settings;
        if !settings.view().needs.lights {
            return Lighting::default();
        }
        let scene = &self.document.loaded.scene;
        let environment = environment(settings);
        let is_current = |lights: &SceneLights| {
            Arc::ptr_eq(&lights.scene, scene) && lights.environment == environment
        };
        let kept = self.lights.take().filter(is_current);
        let lights = kept.unwrap_or_else(|| {
            let others = vec![Light::Environment(Environment::Constant(environment))];
            SceneLights {
                scene: Arc::clone(scene),
                environment,
                lights: Arc::new(Lights::new(scene, others)),
            }
        });
        let lighting = Lighting {
            lights: Arc::clone(&lights.lights),
            spawn: settings.spawn(),
            ao_distance: settings.ao_distance,
            depth_limit: settings.depth_limit(),
        };
        self.lights = Some(lights);
        lighting
    }

    /// Lights the scene by a picture of an environment.
    pub fn set_environment(&mut self, path: &Path) {
        self.error(format!(
            "{}: environments can't be read from files yet",
            path.display()
        ));
    }

    /// Rotates the environment by a drag to the right, in points.
    pub(super) fn rotate_environment(&mut self, drag: f32) {
        const DEGREES_PER_POINT: f32 = 0.5;
        let degrees = self.settings.environment_degrees + DEGREES_PER_POINT * drag;
        self.settings.environment_degrees = degrees.rem_euclid(360.0);
    }

    /// The conditions that end refinement. Noise is that of the picture as it is exposed.
    pub(super) fn limits(&self) -> Limits {
        let settings = &self.settings;
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
        let settings = &self.settings;
        if !self.tracer.shows_lit() {
            Look::PLAIN
        } else if settings.shows_noise {
            Look::Noise(settings.exposure())
        } else {
            Look::Picture(settings.exposure(), settings.tone_curve())
        }
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
