//! Colours of decisions and of ids.

use crate::sampler::mix;
use crate::srgb::from_display;
use glam::Vec3;

/// A colour for an id; consecutive ids get different colours.
pub fn id_colour(id: u32) -> Vec3 {
    let bits = mix(u64::from(id) + 1);
    let channel = |shift: u32| 0.25 + 0.7 * (bits >> shift & 0xff) as f32 / 255.0;
    from_display(Vec3::new(channel(0), channel(8), channel(16)))
}

// Colours that differ from those of the map “dusk”, and from a dark background by a contrast of at least 4.5:1.

/// The kernel misses, the other one hits.
pub const MISSED: Vec3 = Vec3::new(0.0, 0.80, 0.90);
/// The kernel hits, the other one misses.
pub const FALSE_HIT: Vec3 = Vec3::new(0.20, 0.90, 0.05);
/// Both hit, but different triangles.
pub const OTHER_TRIANGLE: Vec3 = Vec3::new(0.90, 0.02, 0.75);
/// The view isn't defined for this shape. Grey, which is neither in that map nor above.
pub const UNDEFINED: Vec3 = Vec3::new(0.3, 0.3, 0.3);

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
