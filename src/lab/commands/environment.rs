//! Values of the environment's options: its source, and the orientation of its picture.

use super::CommandError;
use super::stderr::print_line;
use glam::{DVec3, Vec3};
use hitscope_core::brightness::check_brightness;
use hitscope_core::camera::UpAxis;
use hitscope_core::light::{
    Environment, EnvironmentMap, Light, LoadedMap, MapPlacement, PlacedMap,
};
use hitscope_core::names::nearest;
use hitscope_core::obj::shown;
use hitscope_core::progress::Progress;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The source of light from all directions.
#[derive(Clone, Debug, PartialEq)]
pub enum EnvironmentSource {
    /// The lamps of the view *Shaded*.
    Studio,
    /// The same radiance from all directions.
    Constant(Vec3),
    /// The built-in picture of a studio.
    BuiltIn,
    /// A picture of all directions.
    File(PathBuf),
}

/// Loads the picture of an environment, and prints its warnings.
pub(super) fn load_map(path: &Path, max_memory: u64) -> Result<Arc<EnvironmentMap>, CommandError> {
    let LoadedMap { map, warnings } = EnvironmentMap::load(path, max_memory, &Progress::default())?;
    for warning in warnings {
        print_line(format_args!("{}: warning: {warning}", shown(path)));
    }
    Ok(map)
}

/// Turns the last environment about its vertical axis, and returns whether it is a picture.
pub(super) fn turn(lights: &mut [Light], degrees: f32) -> bool {
    let mut environments = lights.iter_mut().rev().filter_map(|light| match light {
        Light::Environment(environment) => Some(environment),
        _ => None,
    });
    let Some(Environment::Map(placed)) = environments.next() else {
        return false;
    };
    let placement = *placed.placement();
    let turned = MapPlacement {
        rotation_radians: placement.rotation_radians + degrees.to_radians(),
        ..placement
    };
    *placed = PlacedMap::new(Arc::clone(placed.map()), turned);
    true
}

/// Parses `studio`, `built-in`, `constant:0.5`, `constant:1,0.9,0.8`, or a path.
pub(super) fn parse_environment(text: &str) -> Result<EnvironmentSource, String> {
    match text {
        "" => return Err("expected a file, constant:R,G,B, studio or built-in".to_owned()),
        "studio" => return Ok(EnvironmentSource::Studio),
        "built-in" => return Ok(EnvironmentSource::BuiltIn),
        _ => {}
    }
    let Some(colour) = text.strip_prefix("constant:") else {
        let path = PathBuf::from(text);
        let kind = text.split_once(':').map_or(text, |(kind, _)| kind);
        return match nearest(kind, ["studio", "built-in", "constant"]) {
            Some(name) if !path.exists() => {
                let meant = match name {
                    "constant" => "constant:R,G,B",
                    name => name,
                };
                let file = shown(&path);
                Err(format!(
                    "there is no file “{file}”; did you mean “{meant}”?"
                ))
            }
            _ => Ok(EnvironmentSource::File(path)),
        };
    };
    let numbers: Result<Vec<f64>, _> = colour.split(',').map(|word| word.trim().parse()).collect();
    let radiance = match numbers.as_deref() {
        Ok([all]) => DVec3::splat(*all),
        Ok([r, g, b]) => DVec3::new(*r, *g, *b),
        _ => return Err("expected constant:R,G,B, as in constant:1,0.9,0.8".to_owned()),
    };
    check_brightness(radiance).map_err(|fault| format!("the radiance {fault}"))?;
    Ok(EnvironmentSource::Constant(radiance.as_vec3()))
}

/// Parses an axis, such as `z`.
pub(super) fn parse_up_axis(text: &str) -> Result<UpAxis, String> {
    match text {
        "y" => Ok(UpAxis::Y),
        "z" => Ok(UpAxis::Z),
        _ => Err("expected y or z".to_owned()),
    }
}

/// Parses an angle in degrees, such as `-90`.
pub(super) fn parse_rotation(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(degrees) if (-360.0..=360.0).contains(&degrees) => Ok(degrees),
        _ => Err("expected degrees from -360 to 360".to_owned()),
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
        for (bad, reason) in [
            ("", "expected a file, constant:R,G,B, studio or built-in"),
            ("constant:", "expected constant:R,G,B"),
            ("constant:1,2", "expected constant:R,G,B"),
            ("constant:-1", "the radiance must not be negative"),
            ("constant:1,nan,1", "the radiance isn't a number"),
            (
                "constant:3e38,1,1",
                "the radiance is too bright: a picture holds at most 2.8e14",
            ),
            ("constant:1e39", "the radiance is too bright"),
            (
                "studoi",
                "there is no file “studoi”; did you mean “studio”?",
            ),
            (
                "constnat:1",
                "there is no file “constnat:1”; did you mean “constant:R,G,B”?",
            ),
            (
                "constant",
                "there is no file “constant”; did you mean “constant:R,G,B”?",
            ),
        ] {
            let message = parse_environment(bad).expect_err(bad);
            assert!(message.starts_with(reason), "{bad}: {message}");
        }
    }

    #[test]
    fn axes_and_angles_are_read_or_refused_with_a_reason() {
        assert_eq!(parse_up_axis("z"), Ok(UpAxis::Z));
        assert!(parse_up_axis("x").is_err());
        assert_eq!(parse_rotation("-90"), Ok(-90.0));
        for bad in ["361", "nan", ""] {
            assert!(parse_rotation(bad).is_err(), "{bad}");
        }
    }
}
