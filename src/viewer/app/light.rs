//! Light in the picture: the lights of a scene, and how the film is shown.

use super::App;
use super::scene_lights::SceneLights;
use crate::look::Look;
use crate::settings::Settings;
use crate::tracer::Limits;
use hitscope_core::integrator::Lighting;
use hitscope_core::loading::LoadedScene;

impl App {
    /// The lights of a scene and the options of light transport; `None` while the view needs lights that aren't ready.
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

    /// Collects the lights of the scene once they are made.
    pub(super) fn poll_lights(&mut self) {
        if let Err(panicked) = self.traced.lights.poll() {
            self.error(panicked);
        }
    }

    /// Rotates the environment by a drag to the right, in points.
    pub(super) fn rotate_environment(&mut self, drag: f32) {
        const DEGREES_PER_POINT: f32 = 0.5;
        // Counter-clockwise as seen from above moves the far side to the left.
        let degrees = self.seen.settings.environment_degrees - DEGREES_PER_POINT * drag;
        self.seen.settings.environment_degrees = degrees.rem_euclid(360.0);
    }

    /// The conditions that end refinement.
    pub(super) fn limits(&self) -> Limits {
        let settings = &self.seen.settings;
        let noise = f64::from(settings.noise_limit_percent) / 100.0;
        Limits {
            secs: settings
                .has_time_limit
                .then_some(settings.time_limit_s.into()),
            noise: settings.has_noise_limit.then_some(noise),
        }
    }

    /// How the film is shown.
    pub(super) fn look(&self) -> Look {
        Look::of(&self.seen.settings, &self.traced.tracer)
    }
}
