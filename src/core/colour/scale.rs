//! A colour map over a range of a quantity: the colours of a view of numbers, and its legend.

use super::map::ColourMap;
use super::ticks::{Tick, ticks};
use glam::Vec3;

/// A quantity, a range of it, and a colour map over the range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourScale {
    title: &'static str,
    unit: &'static str,
    range: [f64; 2],
    map: &'static ColourMap,
    is_logarithmic: bool,
}

/// Why there is no such scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ScaleError {
    /// An end is infinite or NaN, or the range is too large for f64.
    #[error("the ends of the range must be finite")]
    NotFinite,
    /// The range has a single number.
    #[error("the ends of the range must differ")]
    Empty,
    /// A logarithmic scale needs positive numbers.
    #[error("the ends of a logarithmic range must be positive")]
    NotPositive,
}

impl ColourScale {
    /// A scale. `unit` may be empty. The first end of the range gets the first colour; it may be the larger one.
    ///
    /// # Errors
    /// See [`ScaleError`].
    pub fn new(
        title: &'static str,
        unit: &'static str,
        range: [f64; 2],
        map: &'static ColourMap,
        is_logarithmic: bool,
    ) -> Result<Self, ScaleError> {
        let [first, last] = range;
        if !(first.is_finite() && last.is_finite() && (last - first).is_finite()) {
            return Err(ScaleError::NotFinite);
        } else if first == last {
            return Err(ScaleError::Empty);
        } else if is_logarithmic && first.min(last) <= 0.0 {
            return Err(ScaleError::NotPositive);
        }
        Ok(Self {
            title,
            unit,
            range,
            map,
            is_logarithmic,
        })
    }

    /// The quantity.
    pub fn title(&self) -> &'static str {
        self.title
    }

    /// The unit of its numbers; empty if they have none.
    pub fn unit(&self) -> &'static str {
        self.unit
    }

    /// The numbers with the first and the last colour.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// The colour map.
    pub fn map(&self) -> &'static ColourMap {
        self.map
    }

    /// Whether equal factors, and not equal differences, are equally far apart.
    pub fn is_logarithmic(&self) -> bool {
        self.is_logarithmic
    }

    /// The place of a number: 0 for the first end of the range, 1 for the last, beyond for numbers outside; NaN for NaN.
    pub fn part(&self, x: f64) -> f32 {
        let along = if self.is_logarithmic {
            // Other numbers have no logarithm; they are below all that have.
            |x: f64| if x <= 0.0 { f64::NEG_INFINITY } else { x.ln() }
        } else {
            |x: f64| x
        };
        let [first, last] = self.range.map(along);
        ((along(x) - first) / (last - first)) as f32
    }

    /// The linear colour of a number; that of the nearer end for numbers outside of the range.
    pub fn colour(&self, x: f64) -> Vec3 {
        self.map.colour(self.part(x))
    }

    /// At most so many round numbers in the range, in ascending order.
    pub fn ticks(&self, most: usize) -> Vec<Tick> {
        let [first, last] = self.range;
        let range = [first.min(last), first.max(last)];
        let values = ticks(range, self.is_logarithmic, most).into_iter();
        values
            .map(|(value, label)| Tick {
                value,
                part: self.part(value).clamp(0.0, 1.0),
                label,
            })
            .collect()
    }
}

impl ColourScale {
    /// The colours of at most so many round numbers, with the numbers as text, for a legend without a bar.
    pub fn entries(&self, most: usize) -> Vec<(Vec3, String)> {
        let entry = |tick: Tick| (self.colour(tick.value), tick.label + self.suffix());
        self.ticks(most).into_iter().map(entry).collect()
    }

    /// The unit, if it is a sign that stands at numbers.
    fn suffix(&self) -> &'static str {
        match self.unit {
            "°" => "°",
            "%" => " %",
            _ => "",
        }
    }
}

impl std::fmt::Display for ColourScale {
    /// The scale in a line.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [first, last] = self.range;
        let unit = if self.unit.is_empty() { "" } else { ", " };
        let spacing = if self.is_logarithmic {
            "logarithmic"
        } else {
            "linear"
        };
        let (title, name) = (self.title, self.map.name);
        write!(
            f,
            "{title}{unit}{}: {first} to {last}, {spacing}, {name}",
            self.unit
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::map::{COLOUR_MAPS, NO_NUMBER, VIRIDIS};
    use super::*;

    fn scale(range: [f64; 2], is_logarithmic: bool) -> ColourScale {
        ColourScale::new("height", "m", range, &VIRIDIS, is_logarithmic).expect("a range")
    }

    #[test]
    fn numbers_outside_of_the_range_get_the_colours_of_its_ends() {
        for map in COLOUR_MAPS {
            for is_logarithmic in [false, true] {
                for range in [[2.0, 32.0], [32.0, 2.0]] {
                    let scale = ColourScale::new("", "", range, map, is_logarithmic).expect("good");
                    let [low, high] = if range[0] < range[1] {
                        [0.0, 1.0]
                    } else {
                        [1.0, 0.0]
                    };
                    for x in [2.0, 1.0, 0.0, -5.0, f64::NEG_INFINITY] {
                        assert_eq!(scale.colour(x), map.colour(low), "{scale}: {x}");
                    }
                    for x in [32.0, 33.0, f64::INFINITY] {
                        assert_eq!(scale.colour(x), map.colour(high), "{scale}: {x}");
                    }
                    assert_eq!(scale.colour(f64::NAN), NO_NUMBER);
                }
            }
        }
        assert_eq!(scale([2.0, 32.0], false).part(17.0), 0.5);
        assert!((scale([2.0, 32.0], true).part(8.0) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn impossible_ranges_are_refused() {
        let new = |range, is_logarithmic| ColourScale::new("", "", range, &VIRIDIS, is_logarithmic);
        assert_eq!(new([1.0, 1.0], false), Err(ScaleError::Empty));
        assert_eq!(new([0.0, f64::INFINITY], false), Err(ScaleError::NotFinite));
        assert_eq!(new([f64::NAN, 1.0], true), Err(ScaleError::NotFinite));
        assert_eq!(new([f64::MIN, f64::MAX], false), Err(ScaleError::NotFinite));
        assert_eq!(new([0.0, 1.0], true), Err(ScaleError::NotPositive));
        assert!(new([0.0, 1.0], false).is_ok());
    }

    #[test]
    fn ticks_lie_in_the_range_and_their_parts_follow_the_scale() {
        for range in [
            [0.0, 1.0],
            [5.0, -3.0],
            [1e-8, 0.1],
            [0.05, 5e4],
            [7.0, 7.5],
        ] {
            for is_logarithmic in [false, true] {
                if is_logarithmic && f64::min(range[0], range[1]) <= 0.0 {
                    continue;
                }
                let scale = scale(range, is_logarithmic);
                let ticks = scale.ticks(6);
                assert!((2..=6).contains(&ticks.len()), "{scale}: {ticks:?}");
                for tick in &ticks {
                    let label: f64 = tick.label.parse().expect("a number");
                    assert_eq!(label, tick.value, "{scale}");
                    assert!((0.0..=1.0).contains(&tick.part), "{scale}: {tick:?}");
                    // Rounding of the part to f32.
                    assert!(
                        (tick.part - scale.part(tick.value)).abs() < 1e-6,
                        "{tick:?}"
                    );
                }
                assert!(ticks.is_sorted_by(|a, b| a.value < b.value));
            }
        }
    }

    #[test]
    fn a_scale_says_its_title_unit_range_and_map() {
        let text = scale([0.05, 5e4], true).to_string();
        assert_eq!(text, "height, m: 0.05 to 50000, logarithmic, viridis");
    }
}
