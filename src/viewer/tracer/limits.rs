//! Conditions that end refinement before all samples are traced.

use hitscope_core::film::Noise;

/// Conditions that end refinement before all samples are traced. They hold for views that need lights.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Wall-clock seconds since the view began, without pauses.
    pub secs: Option<f64>,
    /// The limit on [`Noise::mean`].
    pub noise: Option<f64>,
}

/// The condition that has ended refinement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopReason {
    /// [`Limits::secs`].
    Time,
    /// [`Limits::noise`].
    Noise,
}

/// Samples per pixel from which the noise is reliable enough to end refinement.
pub const LEAST_SAMPLES: u32 = 16;

impl Limits {
    /// The condition that is satisfied after so many seconds and samples per pixel.
    pub fn reached(&self, secs: f64, samples: u32, noise: Option<Noise>) -> Option<StopReason> {
        // The samples of a picture that is still black may not have reached its lights yet.
        let is_calm = |limit: f64| {
            let is_less = |noise: Noise| noise.luminance > 0.0 && noise.mean <= limit;
            samples >= LEAST_SAMPLES && noise.is_some_and(is_less)
        };
        if self.noise.is_some_and(is_calm) {
            return Some(StopReason::Noise);
        }
        let is_late = self.secs.is_some_and(|limit| secs >= limit);
        is_late.then_some(StopReason::Time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refinement_ends_at_the_first_limit_and_not_by_the_noise_of_few_samples() {
        let noise = |mean| {
            Some(Noise {
                mean,
                luminance: 1.0,
                ..Noise::default()
            })
        };
        let limits = Limits {
            secs: Some(10.0),
            noise: Some(0.01),
        };
        assert_eq!(limits.reached(9.9, 64, noise(0.011)), None);
        assert_eq!(limits.reached(10.0, 1, None), Some(StopReason::Time));
        assert_eq!(
            limits.reached(1.0, 16, noise(0.01)),
            Some(StopReason::Noise)
        );
        assert_eq!(limits.reached(1.0, 8, noise(0.001)), None);
        assert_eq!(limits.reached(1.0, 16, Some(Noise::default())), None);
        assert_eq!(Limits::default().reached(1e9, 65536, noise(0.0)), None);
    }
}
