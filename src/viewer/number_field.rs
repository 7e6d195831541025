//! Fields and sliders for numbers. If a text isn't a finite number, the number doesn't change.

use egui::emath::{Numeric, format_with_decimals_in_range};
use egui::{DragValue, Slider};
use std::ops::RangeInclusive;

/// A field for a number.
#[expect(clippy::disallowed_methods, reason = "the only use")]
pub fn number_field<N: Numeric>(value: &mut N) -> DragValue<'_> {
    DragValue::new(value)
        .custom_formatter(text)
        .custom_parser(finite::<N>)
}

/// A slider with a field for its number.
#[expect(clippy::disallowed_methods, reason = "the only use")]
pub fn number_slider<N: Numeric>(value: &mut N, range: RangeInclusive<N>) -> Slider<'_> {
    Slider::new(value, range)
        .custom_formatter(text)
        .custom_parser(finite::<N>)
}

/// The text of a number with this many decimals. A number that is too long for a field has an exponent.
fn text(number: f64, decimals: RangeInclusive<usize>) -> String {
    /// Has 13 digits.
    const LONGEST: f64 = 1e12;
    if number.abs() < LONGEST {
        // Adding zero turns −0 into 0.
        format_with_decimals_in_range(number + 0.0, decimals)
    } else {
        format!("{number:e}")
    }
}

/// The number that a text holds, if it is finite as an `N`. Spaces are ignored, and a minus sign may be U+2212.
pub fn finite<N: Numeric>(text: &str) -> Option<f64> {
    let plain = text.chars().filter(|c| !c.is_whitespace());
    let plain: String = plain.map(|c| if c == '−' { '-' } else { c }).collect();
    let number: f64 = plain.parse().ok()?;
    let is_finite = number.is_finite() && N::from_f64(number).to_f64().is_finite();
    is_finite.then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_that_are_not_finite_in_the_type_of_the_field_are_no_numbers() {
        for text in ["nan", "-NaN", "inf", "-infinity", "1e400", "", "x", "1,5"] {
            assert_eq!(finite::<f64>(text), None, "{text}");
            assert_eq!(finite::<u32>(text), None, "{text}");
        }
        assert_eq!(finite::<f32>("1e39"), None);
        assert_eq!(finite::<f64>("1e39"), Some(1e39));
        assert_eq!(finite::<f64>(" −1 000.5 "), Some(-1000.5));
    }

    #[test]
    fn texts_of_large_numbers_are_short_and_hold_the_number() {
        assert_eq!(text(1234.5, 0..=2), "1234.5");
        assert_eq!(text(-0.0, 2..=2), "0.00");
        for number in [1e300, -1.25e12, f64::MAX] {
            let text = text(number, 2..=6);
            assert!(text.len() < 25, "{text}");
            assert_eq!(finite::<f64>(&text), Some(number));
        }
    }
}
