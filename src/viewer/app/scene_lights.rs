//! The lights of a scene. If surfaces emit light, a background task makes them, because that visits every primitive.

use crate::task::{Task, TaskPanicked};
use hitscope_core::Scene;
use hitscope_core::light::{Environment, Light, Lights};
use hitscope_core::loading::LoadedScene;
use std::sync::Arc;

/// The inputs from which lights are made.
#[derive(Clone)]
struct Basis {
    scene: Arc<Scene>,
    /// `None` for that of the scene's file.
    environment: Option<Environment>,
}

impl PartialEq for Basis {
    fn eq(&self, other: &Self) -> bool {
        self.scene.has_shapes_of(&other.scene) && self.environment == other.environment
    }
}

/// The lights of a scene, and the task that makes them.
#[derive(Default)]
pub(crate) struct SceneLights {
    made: Option<(Basis, Arc<Lights>)>,
    running: Option<(Basis, Task<Arc<Lights>>)>,
    /// The inputs of the lights that couldn't be made.
    failed: Option<Basis>,
}

impl SceneLights {
    /// The lights of a scene with an environment. While they are being made, the previous lights of the scene, or
    /// `None` if it has none yet.
    pub fn get(
        &mut self,
        loaded: &LoadedScene,
        environment: Option<Environment>,
        ctx: &egui::Context,
    ) -> Option<Arc<Lights>> {
        self.forget_others(&loaded.scene);
        let scene = Arc::clone(&loaded.scene);
        let wanted = Basis { scene, environment };
        let is_made = |(basis, _): &(Basis, _)| *basis == wanted;
        let is_known = self.made.as_ref().is_some_and(is_made);
        // A running task isn't replaced, so that the picture changes while a slider is dragged.
        if !is_known && self.running.is_none() && self.failed.as_ref() != Some(&wanted) {
            let (basis, others) = (wanted.clone(), loaded.lights.clone());
            if wanted.scene.mesh().attributes().emits() {
                let make = move || Arc::new(made_of(&basis, others));
                self.running = Some((wanted, Task::spawn("lights", ctx, make)));
            } else {
                let lights = Arc::new(made_of(&basis, others));
                self.made = Some((wanted, lights));
            }
        }
        self.made.as_ref().map(|(_, lights)| Arc::clone(lights))
    }

    /// Collects the lights once they are made.
    ///
    /// # Errors
    /// [`TaskPanicked`], once, if making them failed.
    pub fn poll(&mut self) -> Result<(), TaskPanicked> {
        let Some((basis, task)) = self.running.take() else {
            return Ok(());
        };
        match task.poll() {
            Ok(None) => self.running = Some((basis, task)),
            Ok(Some(lights)) => self.made = Some((basis, lights)),
            Err(panicked) => {
                self.failed = Some(basis);
                return Err(panicked);
            }
        }
        Ok(())
    }

    /// Drops the lights of other scenes. Lights of the same scene with another clip are kept for this scene.
    pub fn forget_others(&mut self, scene: &Arc<Scene>) {
        let is_other = |basis: &Basis| !basis.scene.has_shapes_of(scene);
        self.made.take_if(|(basis, _)| is_other(basis));
        self.running.take_if(|(basis, _)| is_other(basis));
        self.failed.take_if(|basis| is_other(basis));
        // The lights must not keep the old scene in memory.
        if let Some((basis, _)) = &mut self.made {
            basis.scene = Arc::clone(scene);
        }
    }

    /// Whether lights are being made.
    pub fn is_pending(&self) -> bool {
        self.running.is_some()
    }
}

/// Makes the lights. `others` are those of the scene's file.
fn made_of(basis: &Basis, mut others: Vec<Light>) -> Lights {
    match basis.environment.clone() {
        None => Lights::or_white(&basis.scene, others),
        Some(environment) => {
            others.push(Light::Environment(environment));
            Lights::new(&basis.scene, others)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::{App, StartOptions};
    use crate::harness::{app_started, wait};
    use crate::settings::Settings;
    use crate::task::sabotage;
    use hitscope_core::integrator::INTEGRATORS;

    /// A square lamp.
    const LAMP: &str =
        "mtllib lamp.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl lamp\nf 1 2 3 4\n";

    #[test]
    fn until_the_lights_are_made_the_preview_is_shown() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("lamp.obj");
        std::fs::write(&file, LAMP).expect("written");
        let material = "newmtl lamp\nKe 1 1 1\n";
        std::fs::write(folder.path().join("lamp.mtl"), material).expect("written");
        let hold = sabotage::hold("lights");
        let Some(mut window) = app_started(StartOptions {
            file: Some(file),
            settings: Settings {
                view: "path".to_owned(),
                samples: 1,
                ..Settings::default()
            },
            ..StartOptions::default()
        }) else {
            return;
        };
        let view = |app: &App| {
            app.traced
                .tracer
                .posted()
                .map(|posted| posted.integrator.name)
        };
        wait(&mut window, "the preview", |app| {
            app.document().name() == "lamp.obj" && app.film().is_complete()
        });
        assert!(window.state().traced.lights.is_pending());
        assert_eq!(view(window.state()), Some(INTEGRATORS[0].name));
        assert!(!window.state().is_settled());
        drop(hold);
        wait(&mut window, "the view", App::is_settled);
        assert_eq!(view(window.state()), Some("path"));
        // A clip changes neither the lamps nor their numbers.
        let lights = |app: &App| {
            let made = app.traced.lights.made.as_ref();
            made.map(|(_, lights)| Arc::as_ptr(lights))
        };
        let before = lights(window.state());
        window.state_mut().seen.settings.clip.shape = crate::clip_choice::ClipShape::Plane;
        window.run_steps(2);
        wait(&mut window, "the clipped view", App::is_settled);
        assert_eq!(lights(window.state()), before);
    }
}
