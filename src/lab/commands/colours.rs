//! Options of the colours of numbers and of back faces.

use super::CommandError;
use super::light::refuse_without_effect;
use super::numbers::numbers;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use clap::{Args, ValueEnum};
use glam::Vec3;
use hitscope_core::colour::{COLOUR_MAPS, colour_map};
use hitscope_core::integrator::{Context, Integrator, ScaleOptions, Setting, ViewOptions};
use hitscope_core::srgb::from_texel;

/// Colours
#[derive(Args, Clone, Debug)]
pub struct ColourArgs {
    /// Colour map of a view of numbers [default: the view's own]
    #[arg(long, value_name = "NAME", value_parser = map_names())]
    pub colour_map: Option<String>,
    /// Numbers with the first and the last colour, or auto: the least and the largest number in the picture
    /// [default: the view's own]
    #[arg(long, value_name = "A,B|auto", allow_hyphen_values = true, value_parser = parse_range)]
    pub range: Option<RangeArg>,
    /// Spacing of the numbers' colours [default: the view's own]
    #[arg(long, value_name = "SPACING")]
    pub scale: Option<SpacingArg>,
    /// Mix a colour into back faces in the view “shaded”; without a value, vermilion, as for the back faces that a clip
    /// opens
    #[arg(long, value_name = "#RRGGBB", num_args = 0..=1, require_equals = true, default_missing_value = "#d55e00", value_parser = parse_colour)]
    pub back_face_tint: Option<Vec3>,
}

/// The range of a scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RangeArg {
    /// That of the numbers in the picture.
    Automatic,
    /// The user's own.
    Own([f64; 2]),
}

/// The spacing of a scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SpacingArg {
    /// Equal differences are equally far apart
    Linear,
    /// Equal factors are equally far apart
    Log,
}

impl ColourArgs {
    /// Refuses options that don't change the picture of any of the views.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub(super) fn check(&self, views: &[&Integrator]) -> Result<(), CommandError> {
        let given = [
            ("--colour-map", self.colour_map.is_some(), Setting::Scale),
            ("--range", self.range.is_some(), Setting::Scale),
            ("--scale", self.scale.is_some(), Setting::Scale),
            (
                "--back-face-tint",
                self.back_face_tint.is_some(),
                Setting::BackFaces,
            ),
        ];
        refuse_without_effect(views, &given)
    }

    /// The context with these choices about a view. An automatic range is measured.
    ///
    /// # Errors
    /// [`CommandError::Usage`] if the view has no such scale.
    pub(super) fn apply(
        &self,
        mut context: Context,
        view: &Integrator,
    ) -> Result<Context, CommandError> {
        let map = self.colour_map.as_deref();
        context.options = ViewOptions {
            back_face_tint: self.back_face_tint,
            scale: ScaleOptions {
                map: map
                    .map(|name| colour_map(name).expect("clap accepts only names in the table")),
                range: None,
                is_logarithmic: self.scale.map(|scale| scale == SpacingArg::Log),
            },
            ..ViewOptions::default()
        };
        context.options.scale.range = match self.range {
            None => None,
            Some(RangeArg::Own(range)) => Some(range),
            Some(RangeArg::Automatic) => view.measured_range(&context),
        };
        let refuse = |error: String| {
            let name = view.name;
            CommandError::Usage(format!("the scale of the view “{name}”: {error} (--range)"))
        };
        view.scale(&context)
            .map_err(|error| refuse(error.to_string()))?;
        Ok(context)
    }
}

pub(super) fn map_names() -> impl clap::builder::TypedValueParser<Value = String> {
    PossibleValuesParser::new(COLOUR_MAPS.iter().map(|map| map.name)).map(|name| name)
}

/// `0.5,20` or `auto`.
fn parse_range(text: &str) -> Result<RangeArg, String> {
    if text == "auto" {
        return Ok(RangeArg::Automatic);
    }
    let [first, last] = numbers(text, "expected two numbers, as in 0.5,20, or auto")?;
    if first == last {
        return Err("the numbers must differ".to_owned());
    }
    Ok(RangeArg::Own([first, last]))
}

/// `#d55e00`, to linear RGB.
fn parse_colour(text: &str) -> Result<Vec3, String> {
    let digits = text.strip_prefix('#').unwrap_or(text);
    let is_hexadecimal = digits.len() == 6 && digits.bytes().all(|b| b.is_ascii_hexdigit());
    match u32::from_str_radix(digits, 16) {
        Ok(number) if is_hexadecimal => {
            let [_, r, g, b] = number.to_be_bytes();
            Ok(from_texel([r, g, b]))
        }
        _ => Err("expected a colour in sRGB, as in #d55e00".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_and_colours_are_read_or_refused_with_a_reason() {
        assert_eq!(parse_range("auto"), Ok(RangeArg::Automatic));
        assert_eq!(parse_range("-1, 5e3"), Ok(RangeArg::Own([-1.0, 5e3])));
        for bad in ["", "1", "1,2,3", "1,1", "1,inf", "automatic"] {
            assert!(parse_range(bad).is_err(), "{bad}");
        }
        assert_eq!(parse_colour("#ff0000"), Ok(Vec3::X));
        assert_eq!(parse_colour("00FF00"), Ok(Vec3::Y));
        for bad in ["", "#fff", "red", "#+12345", "#gg0000"] {
            assert!(parse_colour(bad).is_err(), "{bad}");
        }
    }
}
