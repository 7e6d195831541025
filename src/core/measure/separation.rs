//! The distance of two points.

use glam::DVec3;

/// The way from one point to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// The differences of the coordinates: dx, dy and dz.
    pub delta: DVec3,
    /// The distance.
    pub length: f64,
}

impl Separation {
    /// The way from `from` to `to`. The length is finite if the differences are.
    pub fn new(from: DVec3, to: DVec3) -> Self {
        let delta = to - from;
        let largest = delta.abs().max_element();
        // Scaled, so that squares neither over- nor underflow.
        let length = if largest > 0.0 && largest.is_finite() {
            largest * (delta / largest).length()
        } else {
            largest
        };
        Self { delta, length }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_length_is_right_at_every_scale() {
        for scale in [1e-300, 1e-12, 1.0, 1e12, 1e300] {
            let from = scale * DVec3::ONE;
            let found = Separation::new(from, from + scale * DVec3::new(2.0, -3.0, 6.0));
            assert!((found.length / scale - 7.0).abs() < 1e-14, "{scale}");
            assert!((found.delta.y / scale + 3.0).abs() < 1e-14, "{scale}");
        }
        assert_eq!(Separation::new(DVec3::ONE, DVec3::ONE).length, 0.0);
    }
}
