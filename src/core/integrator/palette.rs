//! Colour maps.

use crate::sampler::mix;
use crate::srgb::from_display;
use glam::Vec3;

/// A colour for an id; consecutive ids get different colours.
pub fn id_colour(id: u32) -> Vec3 {
    let bits = mix(u64::from(id) + 1);
    let channel = |shift: u32| 0.25 + 0.7 * (bits >> shift & 0xff) as f32 / 255.0;
    from_display(Vec3::new(channel(0), channel(8), channel(16)))
}

/// Number of tests at the upper end of [`cost_colour`]'s scale: an expensive ray in a good tree.
pub const COST_SCALE: u32 = 1024;

/// A colour for a number of tests: [`ramp`] on a logarithmic scale from 0 to [`COST_SCALE`].
pub fn cost_colour(tests: u32) -> Vec3 {
    ramp((1.0 + tests as f32).log2() / (1.0 + COST_SCALE as f32).log2())
}

/// The colour map: black at 0, then blue, red and yellow, white at 1; clamped outside.
pub fn ramp(part: f32) -> Vec3 {
    const STOPS: [Vec3; 6] = [
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(0.10, 0.10, 0.45),
        Vec3::new(0.45, 0.10, 0.55),
        Vec3::new(0.90, 0.25, 0.25),
        Vec3::new(1.0, 0.75, 0.20),
        Vec3::new(1.0, 1.0, 1.0),
    ];
    between(&STOPS, part)
}

/// The colour map for errors: blue at 0, then salmon and yellow, white at 1; clamped outside. On a dark
/// background, every colour has a contrast of at least 4.5:1.
pub fn error_ramp(part: f32) -> Vec3 {
    const STOPS: [Vec3; 5] = [
        Vec3::new(0.42, 0.56, 0.90),
        Vec3::new(0.70, 0.55, 0.75),
        Vec3::new(0.95, 0.55, 0.45),
        Vec3::new(1.0, 0.78, 0.25),
        Vec3::new(1.0, 1.0, 1.0),
    ];
    between(&STOPS, part)
}

/// The colour at a part of the way along stops in sRGB.
fn between(stops: &[Vec3], part: f32) -> Vec3 {
    let at = part.clamp(0.0, 1.0) * (stops.len() - 1) as f32;
    let stop = (at as usize).min(stops.len() - 2);
    from_display(stops[stop].lerp(stops[stop + 1], at - stop as f32))
}

// Colours that differ from the ramps, and from a dark background by a contrast of at least 4.5:1.

/// The kernel misses, the other one hits.
pub const MISSED: Vec3 = Vec3::new(0.0, 0.80, 0.90);
/// The kernel hits, the other one misses.
pub const FALSE_HIT: Vec3 = Vec3::new(0.20, 0.90, 0.05);
/// Both hit, but different triangles.
pub const OTHER_TRIANGLE: Vec3 = Vec3::new(0.90, 0.02, 0.75);
/// The view isn't defined for this shape. Grey, which neither the ramps nor the colours above contain.
pub const UNDEFINED: Vec3 = Vec3::new(0.3, 0.3, 0.3);

/// The ramp's colour for a number, on a logarithmic scale over a range.
pub fn log_colour(x: f64, [least, most]: [f64; 2]) -> Vec3 {
    // 0 has no logarithm; it gets the colour of the lower end.
    let part = (x.max(least) / least).ln() / (most / least).ln();
    error_ramp(part as f32)
}

/// The colour of two decisions about one ray: where only one is true, or of another brightness where they agree.
pub(super) fn decision(first: bool, second: bool, is_bright: bool) -> Vec3 {
    match (first, second) {
        (true, false) => FALSE_HIT,
        (false, true) => MISSED,
        _ => Vec3::splat(if is_bright { 0.12 } else { 0.02 }),
    }
}

/// An entry of a legend.
pub(super) fn named(colour: Vec3, text: &str) -> (Vec3, String) {
    (colour, text.to_owned())
}

/// The legend of the colours of wrong decisions.
pub(super) fn decisions() -> Vec<(Vec3, String)> {
    vec![
        named(MISSED, "missed"),
        named(FALSE_HIT, "false hit"),
        named(OTHER_TRIANGLE, "other primitive"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_higher_cost_has_a_brighter_colour() {
        let brightness = |tests| cost_colour(tests).element_sum();
        for (less, more) in [(0, 1), (1, 10), (10, 100), (100, COST_SCALE)] {
            assert!(brightness(less) < brightness(more));
        }
        assert_eq!(cost_colour(u32::MAX), Vec3::ONE);
    }
}
