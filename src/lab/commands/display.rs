//! Options of exposure and tone.

use super::CommandError;
use super::light::refuse_without_effect;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use hitscope_core::integrator::{Integrator, Setting};
use hitscope_core::tone::{Display, TONE_CURVES, tone_curve};

/// Exposure and tone
#[derive(Args, Clone, Debug)]
pub struct DisplayArgs {
    /// Brighten the picture by a factor of 2 per stop
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, value_parser = parse_stops)]
    pub exposure: Option<f32>,
    /// Curve that limits brightness to that of the screen [default: clip]
    #[arg(long, value_name = "CURVE", value_parser = curve_names())]
    pub tone: Option<String>,
}

impl DisplayArgs {
    /// Refuses options that don't change the picture of any of the views.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub fn check(&self, views: &[&Integrator]) -> Result<(), CommandError> {
        let given = [
            ("--exposure", self.exposure.is_some(), Setting::Exposure),
            ("--tone", self.tone.is_some(), Setting::Exposure),
        ];
        refuse_without_effect(views, &given)
    }

    /// Exposure and tone curve of a view; the default ones unless its colours are light.
    pub fn display(&self, view: &Integrator) -> Display {
        if !view.needs.uses(Setting::Exposure) {
            return Display::default();
        }
        let curve = self.tone.as_deref().map_or(TONE_CURVES[0], |name| {
            tone_curve(name).expect("clap accepts only names in the table")
        });
        Display::new(self.exposure.unwrap_or(0.0), curve)
    }
}

fn curve_names() -> impl clap::builder::TypedValueParser<Value = String> {
    PossibleValuesParser::new(TONE_CURVES.iter().map(|curve| curve.name)).map(|name| name)
}

/// `-1.5`.
fn parse_stops(text: &str) -> Result<f32, String> {
    const MOST: f32 = Display::MAX_STOPS;
    match text.parse() {
        Ok(stops) if (-MOST..=MOST).contains(&stops) => Ok(stops),
        _ => Err(format!("expected stops from -{MOST} to {MOST}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stops_are_read_or_refused_with_a_reason() {
        assert_eq!(parse_stops("-1.5"), Ok(-1.5));
        for bad in ["101", "nan", ""] {
            assert!(parse_stops(bad).is_err(), "{bad}");
        }
    }
}
