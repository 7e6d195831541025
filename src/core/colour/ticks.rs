//! Round numbers in a range, for legends.

/// A marked number of a scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// The number.
    pub value: f64,
    /// Its place on the scale, from 0 to 1.
    pub part: f32,
    /// The number as text, without a unit.
    pub label: String,
}

/// At most `most` round numbers from `range[0]` to `range[1]`, which must be larger, with their texts. A logarithmic range
/// must be positive.
pub(super) fn ticks(range: [f64; 2], is_logarithmic: bool, most: usize) -> Vec<(f64, String)> {
    if most == 0 {
        return Vec::new();
    }
    if is_logarithmic {
        let ticks = powers(range, most);
        if ticks.len() >= 2 {
            return ticks;
        }
    }
    multiples(range, most)
}

/// The exact decimal `digits`·10^`exponent`, rounded once.
///
/// # Panics
/// If `digits` isn't finite.
pub fn decimal(digits: f64, exponent: i32) -> f64 {
    // Quicker ways round twice.
    let text = format!("{digits}e{exponent}");
    text.parse().expect("a number")
}

/// The exponent of the largest power of ten that isn't above a positive, finite number.
pub fn exponent_of(x: f64) -> i32 {
    let exponent = x.log10().floor() as i32;
    // The logarithm is rounded.
    if decimal(1.0, exponent + 1) <= x {
        exponent + 1
    } else if decimal(1.0, exponent) > x {
        exponent - 1
    } else {
        exponent
    }
}

/// 1, 2 or 5 times powers of ten, powers of ten, or each second one, third one and so on; the densest that aren't too many.
fn powers([low, high]: [f64; 2], most: usize) -> Vec<(f64, String)> {
    /// More decades than f64 has.
    const STEPS: [i32; 10] = [1, 2, 3, 5, 10, 20, 50, 100, 200, 1000];
    let (first, last) = (exponent_of(low), exponent_of(high));
    let of = |digits: &[f64], step: i32| -> Vec<f64> {
        let exponents = (first..=last).filter(|exponent| exponent.rem_euclid(step) == 0);
        let values =
            exponents.flat_map(|exponent| digits.iter().map(move |d| decimal(*d, exponent)));
        values.filter(|x| (low..=high).contains(x)).collect()
    };
    let dense = std::iter::once(of(&[1.0, 2.0, 5.0], 1));
    let mut all = dense.chain(STEPS.map(|step| of(&[1.0], step)));
    let values = all.find(|values| values.len() <= most);
    let values = values.unwrap_or_default().into_iter();
    values.map(|x| (x, text(x))).collect()
}

/// Multiples of 1, 2 or 5 times a power of ten; the densest that aren't too many.
fn multiples([low, high]: [f64; 2], most: usize) -> Vec<(f64, String)> {
    // A tenth of this is certainly too dense.
    let exponent = exponent_of((high - low) / most as f64) - 1;
    let steps = (0..).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| (digit, exponent + power)));
    let values = steps.map(|(digit, exponent)| {
        let step = decimal(digit, exponent);
        // With a neighbour at either end, as quotients are rounded.
        let (first, last) = ((low / step).floor() - 1.0, (high / step).ceil() + 1.0);
        // False for NaN, too.
        let is_sparse = last - first <= most as f64 + 4.0;
        let count = if is_sparse {
            (last - first) as usize
        } else {
            return None;
        };
        // Adding zero turns −0 into 0.
        let value = |k: usize| decimal((first + k as f64) * digit + 0.0, exponent);
        let mut values: Vec<f64> = (0..=count).map(value).collect();
        values.retain(|x| (low..=high).contains(x));
        // A range far from 0 has steps that f64 can't tell apart.
        values.dedup();
        (values.len() <= most).then_some(values)
    });
    let values = values
        .flatten()
        .next()
        .expect("large steps have few multiples");
    values.into_iter().map(|x| (x, text(x))).collect()
}

/// The shortest text that reads back to the number.
fn text(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || (1e-3..1e5).contains(&size) {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(range: [f64; 2], is_logarithmic: bool, most: usize) -> Vec<String> {
        let ticks = ticks(range, is_logarithmic, most);
        ticks.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn linear_ticks_are_the_densest_round_numbers() {
        for (range, most, expected) in [
            ([0.0, 1.0], 6, "0 0.2 0.4 0.6 0.8 1"),
            ([0.0, 1.0], 5, "0 0.5 1"),
            ([0.0, 1.0], 1, "0"),
            ([-1.2, 3.4], 6, "-1 0 1 2 3"),
            ([0.1, 0.7], 7, "0.1 0.2 0.3 0.4 0.5 0.6 0.7"),
            ([1e6, 2e6], 3, "1e6 1.5e6 2e6"),
            ([3e-9, 9e-9], 4, "4e-9 6e-9 8e-9"),
            ([1e5, 100_000.01], 3, "1e5 1.00000005e5 1.0000001e5"),
        ] {
            let found = labels(range, false, most).join(" ");
            assert_eq!(found, expected, "{range:?}");
        }
    }

    #[test]
    fn logarithmic_ticks_are_powers_of_ten_or_the_numbers_between() {
        for (range, most, expected) in [
            ([0.05, 5e4], 7, "0.1 1 10 100 1000 10000"),
            ([0.05, 5e4], 4, "1 100 10000"),
            ([1e-8, 0.1], 8, "1e-8 1e-7 1e-6 1e-5 1e-4 0.001 0.01 0.1"),
            ([1.0, 100.0], 8, "1 2 5 10 20 50 100"),
            ([1.0, 1024.0], 6, "1 10 100 1000"),
            // No power of ten: as in a linear range.
            ([6.0, 9.0], 4, "6 7 8 9"),
            ([1e-300, 1e300], 3, "1e-200 1 1e200"),
        ] {
            let found = labels(range, true, most).join(" ");
            assert_eq!(found, expected, "{range:?}");
        }
    }

    #[test]
    fn extreme_ranges_have_no_more_ticks_than_asked_for() {
        for range in [
            [0.0, 1e308],
            [-1e308, 7e307],
            [0.0, 1e-320],
            [1e17, 1e17 + 64.0],
        ] {
            for most in [0, 1, 2, 10] {
                let found = ticks(range, false, most);
                assert!(found.len() <= most, "{range:?}: {found:?}");
                assert!(found.iter().all(|(x, _)| x.is_finite()));
            }
        }
    }
}
