//! Options of light, and the lights of a picture.

use super::CommandError;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use glam::Vec3;
use hitscope_core::Camera;
use hitscope_core::integrator::{INTEGRATORS, Integrator, Lighting, Setting};
use hitscope_core::light::{Environment, Light, Lights, studio};
use hitscope_core::loading::LoadedScene;
use hitscope_core::obj::shown;
use hitscope_core::spawn::{SPAWN_POLICIES, default_spawn_policy, spawn_policy};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Options of light
#[derive(Args, Clone, Debug)]
pub struct LightArgs {
    /// Light from all directions, in place of the scene file's: constant:R,G,B (linear), or studio: the lamps of the
    /// view “shaded”, with shadows [default: the scene file's; constant:1,1,1 if nothing emits light]
    #[arg(long, value_name = "FILE|constant:R,G,B|studio", value_parser = parse_environment)]
    pub environment: Option<EnvironmentSource>,
    /// Turn the environment about the y axis, counter-clockwise as seen from above
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = parse_rotation)]
    pub rotation: Option<f32>,
    /// Rule for the origin of rays that leave a surface
    #[arg(long, value_name = "POLICY", value_parser = policy_names())]
    pub spawn: Option<String>,
    /// Most surfaces on a path: 0 shows emitters alone, 1 adds light that one surface reflects
    /// [default: the scene file's, or no limit]
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub depth: Option<u32>,
    /// Distance to which surfaces occlude in the view “ao”, in radii of the scene's bounding sphere [default: 1]
    #[arg(long, value_name = "RADII", allow_negative_numbers = true, value_parser = parse_distance)]
    pub ao_distance: Option<f32>,
    /// Brighten the picture by a factor of 2 per stop
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = parse_stops)]
    pub exposure: Option<f32>,
}

/// Where light from all directions comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum EnvironmentSource {
    /// The lamps of the view *Shaded*.
    Studio,
    /// The same radiance from all directions.
    Constant(Vec3),
    /// A picture of all directions.
    File(PathBuf),
}

impl LightArgs {
    /// Refuses options that don't change the picture of a view.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub fn check(&self, view: &Integrator) -> Result<(), CommandError> {
        let given = [
            ("--environment", self.environment.is_some(), Setting::Lights),
            ("--rotation", self.rotation.is_some(), Setting::Lights),
            ("--spawn", self.spawn.is_some(), Setting::Spawn),
            ("--depth", self.depth.is_some(), Setting::Depth),
            (
                "--ao-distance",
                self.ao_distance.is_some(),
                Setting::OcclusionDistance,
            ),
            ("--exposure", self.exposure.is_some(), Setting::Exposure),
        ];
        for (option, is_given, setting) in given {
            if is_given && !view.needs.uses(setting) {
                let message = format!(
                    "{option} has no effect on the view “{}”: it needs --view {}",
                    view.name,
                    views_with(setting)
                );
                return Err(CommandError::Usage(message));
            }
        }
        let is_even = matches!(
            self.environment,
            Some(EnvironmentSource::Studio | EnvironmentSource::Constant(_))
        );
        if self.rotation.is_some() && is_even {
            let message = "--rotation has no effect on constant light and on the studio: it needs --environment FILE";
            return Err(CommandError::Usage(message.to_owned()));
        }
        Ok(())
    }

    /// What light transport depends on in a picture of a scene.
    ///
    /// # Errors
    /// [`CommandError::Usage`] if there is no environment to turn, and errors of the environment's file.
    pub fn lighting(
        &self,
        loaded: &LoadedScene,
        camera: &Camera,
    ) -> Result<Lighting, CommandError> {
        let default = Lighting::default();
        let named = self.spawn.as_deref();
        let spawn = named.map_or(default_spawn_policy(), |name| {
            spawn_policy(name).expect("clap accepts only names in the table")
        });
        Ok(Lighting {
            lights: Arc::new(Lights::or_white(
                &loaded.scene,
                self.lights(loaded, camera)?,
            )),
            spawn,
            ao_distance: self.ao_distance.unwrap_or(default.ao_distance),
            depth_limit: self.depth.or(loaded.depth_limit()),
        })
    }

    /// The lights of the file and the chosen environment, which replaces the file's.
    fn lights(&self, loaded: &LoadedScene, camera: &Camera) -> Result<Vec<Light>, CommandError> {
        let mut lights = loaded.lights.clone();
        match &self.environment {
            None if self.rotation.is_some() => {
                let message = "--rotation has no effect: the scene has no environment map";
                return Err(CommandError::Usage(message.to_owned()));
            }
            None => {}
            Some(EnvironmentSource::Studio) => lights.extend(studio(camera)),
            Some(EnvironmentSource::Constant(radiance)) => {
                lights.push(Light::Environment(Environment::Constant(*radiance)));
            }
            Some(EnvironmentSource::File(path)) => {
                let degrees = self.rotation.unwrap_or(0.0);
                lights.push(Light::Environment(environment_map(path, degrees)?));
            }
        }
        Ok(lights)
    }
}

/// The environment in a picture file, turned about the y axis. No format is read yet.
fn environment_map(path: &Path, _degrees: f32) -> Result<Environment, CommandError> {
    let message = format!(
        "--environment {}: no picture format is read yet; use constant:R,G,B or studio",
        shown(path)
    );
    Err(CommandError::Usage(message))
}

/// The names of the views that depend on a setting, as alternatives.
fn views_with(setting: Setting) -> String {
    let views = INTEGRATORS.iter().filter(|view| view.needs.uses(setting));
    let names: Vec<&str> = views.map(|view| view.name).collect();
    names.join(" or ")
}

fn policy_names() -> impl clap::builder::TypedValueParser<Value = String> {
    PossibleValuesParser::new(SPAWN_POLICIES.iter().map(|policy| policy.name)).map(|name| name)
}

/// `studio`, `constant:0.5`, `constant:1,0.9,0.8`, or a path.
fn parse_environment(text: &str) -> Result<EnvironmentSource, String> {
    if text == "studio" {
        return Ok(EnvironmentSource::Studio);
    }
    let Some(colour) = text.strip_prefix("constant:") else {
        return Ok(EnvironmentSource::File(PathBuf::from(text)));
    };
    let numbers: Result<Vec<f32>, _> = colour.split(',').map(|word| word.trim().parse()).collect();
    let radiance = match numbers.as_deref() {
        Ok([all]) => Vec3::splat(*all),
        Ok([r, g, b]) => Vec3::new(*r, *g, *b),
        _ => return Err("expected constant:R,G,B, as in constant:1,0.9,0.8".to_owned()),
    };
    if radiance.is_finite() && radiance.min_element() >= 0.0 {
        Ok(EnvironmentSource::Constant(radiance))
    } else {
        Err("the radiance must be finite and not negative".to_owned())
    }
}

/// `-90`.
fn parse_rotation(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(degrees) if (-360.0..=360.0).contains(&degrees) => Ok(degrees),
        _ => Err("expected degrees from -360 to 360".to_owned()),
    }
}

/// `0.5`.
fn parse_distance(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(radii) if radii > 0.0 => Ok(radii),
        _ => Err("expected a distance above 0, or inf".to_owned()),
    }
}

/// `-1.5`.
fn parse_stops(text: &str) -> Result<f32, String> {
    /// The film holds sums from 2⁻⁶⁴ to 2⁶⁴.
    const MOST: f32 = 64.0;
    match text.parse() {
        Ok(stops) if (-MOST..=MOST).contains(&stops) => Ok(stops),
        _ => Err(format!("expected stops from -{MOST} to {MOST}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn environments_are_read_or_refused_with_a_reason() {
        let constant = |radiance| Ok(EnvironmentSource::Constant(radiance));
        assert_eq!(parse_environment("studio"), Ok(EnvironmentSource::Studio));
        assert_eq!(
            parse_environment("constant:0.5"),
            constant(Vec3::splat(0.5))
        );
        assert_eq!(
            parse_environment("constant:1,0.5,2"),
            constant(Vec3::new(1.0, 0.5, 2.0))
        );
        let file = EnvironmentSource::File("sky.hdr".into());
        assert_eq!(parse_environment("sky.hdr"), Ok(file));
        for bad in [
            "constant:",
            "constant:1,2",
            "constant:-1",
            "constant:1,nan,1",
        ] {
            assert!(parse_environment(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn numbers_are_read_or_refused_with_a_reason() {
        assert_eq!(parse_rotation("-90"), Ok(-90.0));
        assert_eq!(parse_distance("0.5"), Ok(0.5));
        assert_eq!(parse_stops("-1.5"), Ok(-1.5));
        for bad in ["361", "nan", ""] {
            assert!(parse_rotation(bad).is_err(), "{bad}");
        }
        for bad in ["0", "-1", "nan", ""] {
            assert!(parse_distance(bad).is_err(), "{bad}");
        }
        for bad in ["65", "nan", ""] {
            assert!(parse_stops(bad).is_err(), "{bad}");
        }
    }
}
