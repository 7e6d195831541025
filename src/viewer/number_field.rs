//! Fields and sliders for numbers. If a text isn't a finite number, the number doesn't change.

use egui::emath::Numeric;
use egui::{DragValue, Slider};
use std::ops::RangeInclusive;

/// A field for a number.
#[expect(clippy::disallowed_methods, reason = "the only use")]
pub fn number_field<N: Numeric>(value: &mut N) -> DragValue<'_> {
    DragValue::new(value).custom_parser(finite::<N>)
}

/// A slider with a field for its number.
#[expect(clippy::disallowed_methods, reason = "the only use")]
pub fn number_slider<N: Numeric>(value: &mut N, range: RangeInclusive<N>) -> Slider<'_> {
    Slider::new(value, range).custom_parser(finite::<N>)
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
}
