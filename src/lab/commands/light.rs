//! Options of light, and the lights of a picture.

use super::CommandError;
use super::environment::{
    EnvironmentSource, load_map, parse_environment, parse_rotation, parse_up_axis, turn,
};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use hitscope_core::camera::UpAxis;
use hitscope_core::integrator::{INTEGRATORS, Integrator, Lighting, Setting};
use hitscope_core::light::{
    Environment, EnvironmentMap, Light, Lights, MapPlacement, PlacedMap, studio,
};
use hitscope_core::loading::LoadedScene;
use hitscope_core::names::alternatives;
use hitscope_core::spawn::{SPAWN_POLICIES, SpawnPolicy, spawn_policy};
use hitscope_core::terminator::{TERMINATOR_REPAIRS, terminator_repair};
use hitscope_core::{Camera, Scene};
use std::sync::Arc;

/// Options of light
#[derive(Args, Clone, Debug)]
pub struct LightArgs {
    /// Light from all directions, in place of the scene file's: a latitude-longitude picture (.hdr or .exr);
    /// constant:R,G,B (linear); studio: the lamps of the view “shaded”, with shadows; or built-in: a picture of a
    /// studio [default: the scene file's; constant:1,1,1 if nothing emits light]
    #[arg(long, value_name = "FILE|constant:R,G,B|studio|built-in", value_parser = parse_environment)]
    pub environment: Option<EnvironmentSource>,
    /// Axis that points up in the environment's picture; that of a scene file stands as its to_world says
    /// [default: the one that points up in the picture]
    #[arg(long, value_name = "y|z", value_parser = parse_up_axis)]
    pub environment_up: Option<UpAxis>,
    /// Turn the environment's picture about its vertical axis, counter-clockwise as seen from above
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = parse_rotation)]
    pub rotation: Option<f32>,
    /// Rule for the origin of rays that leave a surface
    #[arg(long, value_name = "POLICY", value_parser = policy_names())]
    pub spawn: Option<String>,
    /// Rule that the view “spawning” compares with [default: fixed-epsilon]
    #[arg(long, value_name = "POLICY", value_parser = policy_names())]
    pub second_spawn: Option<String>,
    /// Most surfaces on a path: 0 shows emitters alone, 1 adds light that one surface reflects
    /// [default: the scene file's, or no limit]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = parse_depth)]
    pub depth: Option<u32>,
    /// Distance to which surfaces occlude in the view “ao”, in radii of the scene's bounding sphere [default: 1]
    #[arg(long, value_name = "RADII", allow_negative_numbers = true, value_parser = parse_distance)]
    pub ao_distance: Option<f32>,
    /// Repair of the shadow terminator, the hard edge of light on coarse triangles with vertex normals; none of them is
    /// exact [default: none]
    #[arg(long, value_name = "REPAIR", value_parser = repair_names())]
    pub terminator: Option<String>,
}

impl LightArgs {
    /// The options that are given, with the setting that each of them changes.
    fn given(&self) -> [(&'static str, bool, Setting); 8] {
        use Setting::{Depth, Lights, OcclusionDistance, SecondSpawn, Spawn, Terminator};
        [
            ("--environment", self.environment.is_some(), Lights),
            ("--environment-up", self.environment_up.is_some(), Lights),
            ("--rotation", self.rotation.is_some(), Lights),
            ("--spawn", self.spawn.is_some(), Spawn),
            ("--second-spawn", self.second_spawn.is_some(), SecondSpawn),
            ("--depth", self.depth.is_some(), Depth),
            ("--terminator", self.terminator.is_some(), Terminator),
            (
                "--ao-distance",
                self.ao_distance.is_some(),
                OcclusionDistance,
            ),
        ]
    }

    /// Refuses all options, for lack of another one.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub(super) fn refuse_all(&self, lacking: &str) -> Result<(), CommandError> {
        let mut given = self.given().into_iter();
        match given.find(|(_, is_given, _)| *is_given) {
            Some((option, ..)) => Err(CommandError::Usage(format!(
                "{option} has no effect: it needs {lacking}"
            ))),
            None => Ok(()),
        }
    }

    /// Refuses options that don't change the picture of any of the views.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub fn check(&self, views: &[&Integrator]) -> Result<(), CommandError> {
        refuse_without_effect(views, &self.given())?;
        let has_picture = matches!(
            self.environment,
            Some(EnvironmentSource::BuiltIn | EnvironmentSource::File(_))
        );
        if self.environment_up.is_some() && !has_picture {
            let message =
                "--environment-up has no effect: it needs a picture, as in --environment FILE";
            return Err(CommandError::Usage(message.to_owned()));
        }
        let is_even = matches!(
            self.environment,
            Some(EnvironmentSource::Studio | EnvironmentSource::Constant(_))
        );
        if self.rotation.is_some() && is_even {
            let message = "--rotation has no effect on constant light and on the studio: it needs a picture, as in --environment FILE";
            return Err(CommandError::Usage(message.to_owned()));
        }
        Ok(())
    }

    /// The settings of light transport for a picture of a scene in which `up_axis` points up. A picture of an
    /// environment may take `max_memory` bytes.
    ///
    /// # Errors
    /// See [`load`](Self::load).
    pub fn lighting(
        &self,
        loaded: &LoadedScene,
        (camera, up_axis): (&Camera, UpAxis),
        max_memory: u64,
    ) -> Result<Lighting, CommandError> {
        Ok(self.load(loaded, up_axis, max_memory)?.seen_by(camera))
    }

    /// The light of a scene in whose pictures `up_axis` points up, for any camera. A picture of an environment may take
    /// `max_memory` bytes.
    ///
    /// # Errors
    /// [`CommandError::Usage`] if there is no picture to turn, and [`CommandError::Load`].
    pub fn load(
        &self,
        loaded: &LoadedScene,
        up_axis: UpAxis,
        max_memory: u64,
    ) -> Result<SceneLight, CommandError> {
        let default = loaded.lighting();
        let policy = |name: &Option<String>, default: &'static SpawnPolicy| {
            name.as_deref().map_or(default, |name| {
                spawn_policy(name).expect("clap accepts only names in the table")
            })
        };
        let repair = self
            .terminator
            .as_deref()
            .map(|name| terminator_repair(name).expect("clap accepts only names in the table"));
        let placement = MapPlacement::upright(self.environment_up.unwrap_or(up_axis));
        let lights = self.lights(loaded, placement, max_memory)?;
        Ok(SceneLight {
            settings: Lighting {
                lights: Arc::new(Lights::or_white(&loaded.scene, lights.clone())),
                spawn: policy(&self.spawn, default.spawn),
                second_spawn: policy(&self.second_spawn, default.second_spawn),
                ao_distance: self.ao_distance.unwrap_or(default.ao_distance),
                depth_limit: self.depth.or(default.depth_limit),
                terminator: repair.unwrap_or(default.terminator),
                ..default
            },
            scene: Arc::clone(&loaded.scene),
            has_studio: self.environment == Some(EnvironmentSource::Studio),
            lights,
        })
    }

    /// The lights of the file and the chosen environment, which replaces the file's; without the studio, which moves with
    /// the camera.
    fn lights(
        &self,
        loaded: &LoadedScene,
        placement: MapPlacement,
        max_memory: u64,
    ) -> Result<Vec<Light>, CommandError> {
        let mut lights = loaded.lights.clone();
        let placed = |map| Light::Environment(Environment::Map(PlacedMap::new(map, placement)));
        match &self.environment {
            None | Some(EnvironmentSource::Studio) => {}
            Some(EnvironmentSource::Constant(radiance)) => {
                lights.push(Light::Environment(Environment::Constant(*radiance)));
            }
            Some(EnvironmentSource::BuiltIn) => {
                lights.push(placed(EnvironmentMap::built_in()));
            }
            Some(EnvironmentSource::File(path)) => {
                lights.push(placed(load_map(path, max_memory)?));
            }
        }
        if let Some(degrees) = self.rotation
            && !turn(&mut lights, degrees)
        {
            let message = "--rotation has no effect: the scene has no picture of an environment";
            return Err(CommandError::Usage(message.to_owned()));
        }
        Ok(lights)
    }
}

/// The light of a scene, which several cameras see.
pub struct SceneLight {
    scene: Arc<Scene>,
    /// Without the studio.
    lights: Vec<Light>,
    has_studio: bool,
    settings: Lighting,
}

impl SceneLight {
    /// The light in the picture of a camera.
    pub fn seen_by(&self, camera: &Camera) -> Lighting {
        if !self.has_studio {
            return self.settings.clone();
        }
        let lights = self.lights.iter().cloned().chain(studio(camera)).collect();
        Lighting {
            lights: Arc::new(Lights::or_white(&self.scene, lights)),
            ..self.settings.clone()
        }
    }
}

/// Refuses options that are given and don't change the picture of any of the views.
///
/// # Errors
/// [`CommandError::Usage`].
pub(super) fn refuse_without_effect(
    views: &[&Integrator],
    options: &[(&str, bool, Setting)],
) -> Result<(), CommandError> {
    for &(option, is_given, setting) in options {
        let has_effect = views.iter().any(|view| view.needs.uses(setting));
        if is_given && !has_effect {
            return Err(no_effect(option, views, &views_with(setting)));
        }
    }
    Ok(())
}

/// The error for an option without an effect on the views; `needed` names those on which it has one.
pub(super) fn no_effect(option: &str, views: &[&Integrator], needed: &str) -> CommandError {
    let names: Vec<String> = views
        .iter()
        .map(|view| format!("“{}”", view.name))
        .collect();
    let plural = if names.len() == 1 { "" } else { "s" };
    CommandError::Usage(format!(
        "{option} has no effect on the view{plural} {}: it needs --view {needed}",
        names.join(", ")
    ))
}

/// The names of the views that depend on a setting, as alternatives.
fn views_with(setting: Setting) -> String {
    let views = INTEGRATORS.iter().filter(|view| view.needs.uses(setting));
    let names: Vec<&str> = views.map(|view| view.name).collect();
    alternatives(&names)
}

fn repair_names() -> impl clap::builder::TypedValueParser<Value = String> {
    let names = TERMINATOR_REPAIRS.iter().map(|repair| repair.name);
    PossibleValuesParser::new(names).map(|name| name)
}

fn policy_names() -> impl clap::builder::TypedValueParser<Value = String> {
    PossibleValuesParser::new(SPAWN_POLICIES.iter().map(|policy| policy.name)).map(|name| name)
}

/// A number of surfaces, such as `3`.
fn parse_depth(text: &str) -> Result<u32, String> {
    let message = "expected a number of surfaces; --depth-map writes distances to a file";
    text.parse().map_err(|_| message.to_owned())
}

/// `0.5`.
fn parse_distance(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(radii) if radii > 0.0 => Ok(radii),
        _ => Err("expected a distance above 0, or inf".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_and_distances_are_read_or_refused_with_a_reason() {
        assert_eq!(parse_depth("3"), Ok(3));
        let message = parse_depth("depth.exr").expect_err("no number");
        assert!(message.contains("--depth-map"), "{message}");
        assert_eq!(parse_distance("0.5"), Ok(0.5));
        for bad in ["0", "-1", "nan", ""] {
            assert!(parse_distance(bad).is_err(), "{bad}");
        }
    }
}
