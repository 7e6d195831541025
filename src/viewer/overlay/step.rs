//! Round numbers for the spacing of a grid and the length of a scale bar.

use crate::numbers::number;
use hitscope_core::colour::{decimal, exponent_of};

/// 1, 2 or 5 times a power of ten.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    digit: u8,
    exponent: i32,
}

impl Step {
    /// The least step that isn't below `x`; `None` unless both are positive and finite.
    pub fn at_least(x: f64) -> Option<Self> {
        Self::near(x)?.into_iter().find(|step| step.value() >= x)
    }

    /// The largest step that isn't above `x`; `None` unless both are positive and finite.
    pub fn at_most(x: f64) -> Option<Self> {
        let steps = Self::near(x)?.into_iter();
        steps.rev().find(|step| step.value() <= x)
    }

    /// The number nearest to the step in f64.
    pub fn value(self) -> f64 {
        decimal(self.digit.into(), self.exponent)
    }

    /// The step with its unit, such as `0.5 units`.
    pub fn in_units(self) -> String {
        let is_one = self.digit == 1 && self.exponent == 0;
        let unit = if is_one { "unit" } else { "units" };
        format!("{} {unit}", number(self.value()))
    }

    /// The positive and finite steps around `x`, ascending.
    fn near(x: f64) -> Option<Vec<Self>> {
        if !(x > 0.0 && x.is_finite()) {
            return None;
        }
        let exponent = exponent_of(x);
        let exponents = exponent..=exponent + 1;
        let steps = exponents.flat_map(|exponent| [1, 2, 5].map(|digit| Self { digit, exponent }));
        let is_usable = |step: &Self| step.value() > 0.0 && step.value().is_finite();
        Some(steps.filter(is_usable).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_one_two_or_five_times_a_power_of_ten() {
        for (x, above, below) in [
            (1.0, 1.0, 1.0),
            (1.01, 2.0, 1.0),
            (2.0, 2.0, 2.0),
            (3.0, 5.0, 2.0),
            (5.1, 10.0, 5.0),
            (0.999, 1.0, 0.5),
            (0.2, 0.2, 0.2),
            (0.012, 0.02, 0.01),
            (1000.0, 1000.0, 1000.0),
            (6.5e-31, 1e-30, 5e-31),
            (4e300, 5e300, 2e300),
        ] {
            assert_eq!(Step::at_least(x).map(Step::value), Some(above), "{x}");
            assert_eq!(Step::at_most(x).map(Step::value), Some(below), "{x}");
        }
    }

    #[test]
    fn every_power_of_ten_is_its_own_step() {
        for exponent in -300..300 {
            let x: f64 = format!("1e{exponent}").parse().expect("a number");
            assert_eq!(Step::at_least(x).map(Step::value), Some(x), "{x:e}");
            assert_eq!(Step::at_most(x).map(Step::value), Some(x), "{x:e}");
        }
    }

    #[test]
    fn no_step_is_near_zero_infinity_nan_or_a_negative_number() {
        for x in [0.0, -1.0, f64::INFINITY, f64::NAN, f64::NEG_INFINITY] {
            assert_eq!((Step::at_least(x), Step::at_most(x)), (None, None), "{x}");
        }
        // The next step would be infinite.
        assert_eq!(Step::at_least(f64::MAX), None);
        assert_eq!(Step::at_most(f64::MAX).map(Step::value), Some(1e308));
    }

    #[test]
    fn one_is_a_unit_and_other_numbers_are_units() {
        let text = |x| Step::at_least(x).expect("a step").in_units();
        assert_eq!(text(1.0), "1 unit");
        assert_eq!(text(0.05), "0.05 units");
        assert_eq!(text(1e9), "1e9 units");
    }
}
