//! From linear radiance to the colours of a screen: exposure, a tone curve, and sRGB.

use crate::srgb::to_display;
use glam::Vec3;
use std::sync::LazyLock;

/// A curve from linear RGB, which has no upper end, to linear RGB from 0 to 1.
pub struct ToneCurve {
    /// The name, as in `--tone`.
    pub name: &'static str,
    /// The title in menus.
    pub title: &'static str,
    /// What it does, in one sentence.
    pub about: &'static str,
    /// Where it is defined; empty for the obvious.
    pub source: &'static str,
    map: fn(Vec3) -> Vec3,
}

impl ToneCurve {
    /// The colour for a colour. Numbers that are negative or NaN count as 0.
    pub fn map(&self, linear: Vec3) -> Vec3 {
        /// Far below the end of f32, so that nothing overflows.
        const LARGEST: f32 = 1e30;
        let valid = |x: f32| if x > 0.0 { x.min(LARGEST) } else { 0.0 };
        (self.map)(linear.map(valid))
    }
}

impl std::fmt::Debug for ToneCurve {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

/// All curves, in the order of the menu. The first one is the default.
pub static TONE_CURVES: &[&ToneCurve] = &[&CLIP, &NEUTRAL];

/// The curve of this name.
pub fn tone_curve(name: &str) -> Option<&'static ToneCurve> {
    TONE_CURVES.iter().copied().find(|curve| curve.name == name)
}

static CLIP: ToneCurve = ToneCurve {
    name: "clip",
    title: "Clip",
    about: "Colours stay as they are; what is brighter than white is cut off.",
    source: "",
    map: |linear| linear.min(Vec3::ONE),
};

static NEUTRAL: ToneCurve = ToneCurve {
    name: "neutral",
    title: "Khronos PBR Neutral",
    about: "Colours below 0.8 keep hue and saturation; brighter ones are compressed and fade to white.",
    source: "Khronos Group, PBR Neutral Tone Mapper, 2024, https://github.com/KhronosGroup/ToneMapping/tree/main/PBR_Neutral",
    map: neutral,
};

/// Names as in the specification: F₉₀ is the Fresnel reflection at normal incidence that is subtracted, Kₛ is where
/// compression begins, K_d is how fast colours fade.
fn neutral(linear: Vec3) -> Vec3 {
    const F90: f32 = 0.04;
    const K_S: f32 = 0.8 - F90;
    const K_D: f32 = 0.15;
    // Subtract the reflection.
    let least = linear.min_element();
    let offset = if least < 2.0 * F90 {
        least - least * least / (4.0 * F90)
    } else {
        F90
    };
    let colour = linear - offset;
    let peak = colour.max_element();
    if peak <= K_S {
        return colour;
    }
    // Compress the peak.
    let room = 1.0 - K_S;
    let compressed = 1.0 - room * room / (peak + 1.0 - 2.0 * K_S);
    // Fade to white.
    let kept = 1.0 / (K_D * (peak - compressed) + 1.0);
    (colour * (compressed / peak)).lerp(Vec3::splat(compressed), 1.0 - kept)
}

/// How radiance is shown: exposure and tone curve.
#[derive(Clone, Copy, Debug)]
pub struct Display {
    exposure_stops: f32,
    curve: &'static ToneCurve,
    /// 2 to the power of the stops.
    factor: f32,
}

impl Display {
    /// The most stops of exposure in either direction; beyond, f32 ends.
    pub const MAX_STOPS: f32 = 100.0;

    /// A display with an exposure in stops: each doubles the brightness. Stops are limited to ±[`MAX_STOPS`](Self::MAX_STOPS);
    /// NaN counts as 0.
    pub fn new(exposure_stops: f32, curve: &'static ToneCurve) -> Self {
        let stops = if exposure_stops.is_nan() {
            0.0
        } else {
            exposure_stops.clamp(-Self::MAX_STOPS, Self::MAX_STOPS)
        };
        Self {
            exposure_stops: stops,
            curve,
            factor: libm::exp2f(stops),
        }
    }

    /// The exposure in stops.
    pub fn exposure_stops(&self) -> f32 {
        self.exposure_stops
    }

    /// The tone curve.
    pub fn curve(&self) -> &'static ToneCurve {
        self.curve
    }

    /// A linear colour as 8-bit sRGB with alpha 255. NaN counts as 0.
    pub fn encode(&self, linear: Vec3) -> [u8; 4] {
        encoded(self.shown(linear))
    }

    /// The colour of a pixel of which a part, from 0 to 1, shows the background, as 8-bit sRGB with alpha 255.
    ///
    /// `light` and `background` are linear; `light` is the sum of the other parts. Exposure and tone curve don't change
    /// the background.
    pub fn encode_over(&self, light: Vec3, part: f32, background: Vec3) -> [u8; 4] {
        let rest = 1.0 - part;
        if rest <= 0.0 {
            return encoded(background);
        }
        encoded(rest * self.shown(light / rest) + part * background)
    }

    /// The linear colour after exposure and tone curve.
    fn shown(&self, linear: Vec3) -> Vec3 {
        self.curve.map(self.factor * linear)
    }
}

/// A linear colour as 8-bit sRGB with alpha 255. NaN counts as 0.
fn encoded(linear: Vec3) -> [u8; 4] {
    /// Steps of the table from 0 to 1, finer than 8-bit sRGB.
    const STEPS: f32 = 65536.0;
    /// sRGB for each step. A table, because `powf` per pixel is too slow for the UI thread.
    static SRGB: LazyLock<Vec<u8>> = LazyLock::new(|| {
        let encoded = |i: u32| (255.0 * to_display(i as f32 / STEPS)).round() as u8;
        (0..=STEPS as u32).map(encoded).collect()
    });
    // Rounded by truncation: `round` calls a function on CPUs without SSE 4.1. NaN is 0.
    let channel = |x: f32| SRGB[(x.clamp(0.0, 1.0) * STEPS + 0.5) as usize];
    let [r, g, b] = linear.to_array().map(channel);
    [r, g, b, 255]
}

impl Default for Display {
    /// No exposure, and the first curve: the picture's own colours.
    fn default() -> Self {
        Self::new(0.0, TONE_CURVES[0])
    }
}

impl PartialEq for Display {
    fn eq(&self, other: &Self) -> bool {
        self.exposure_stops == other.exposure_stops && std::ptr::eq(self.curve, other.curve)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_stays_black_and_no_colour_leaves_the_range() {
        for curve in TONE_CURVES {
            assert_eq!(curve.map(Vec3::ZERO), Vec3::ZERO, "{curve:?}");
            let extremes = [
                0.0,
                f32::MIN_POSITIVE,
                0.5,
                f32::MAX,
                f32::INFINITY,
                f32::NAN,
                -1.0,
            ];
            for colour in extremes
                .map(|x| [Vec3::splat(x), Vec3::new(x, 0.0, 1.0)])
                .as_flattened()
            {
                let mapped = curve.map(*colour);
                assert!(
                    mapped.min_element() >= 0.0 && mapped.max_element() <= 1.0,
                    "{curve:?}, {colour}: {mapped}"
                );
            }
        }
    }

    #[test]
    fn brighter_light_never_gives_a_darker_colour() {
        // The largest component, and all components of grey; others fade to white, which isn't darker either.
        let colours = [
            Vec3::ONE,
            Vec3::X,
            Vec3::new(0.1, 0.9, 1.0),
            Vec3::new(1.0, 0.9, 0.5),
        ];
        for curve in TONE_CURVES {
            for colour in colours {
                let mut last = Vec3::ZERO;
                for k in 0..4000 {
                    let mapped = curve.map(0.002 * k as f32 * colour);
                    // Rounding of a few operations near 1.
                    assert!(
                        (mapped - last).min_element() >= -1e-6,
                        "{curve:?}, {colour}, {k}"
                    );
                    last = mapped;
                }
            }
        }
    }

    #[test]
    fn the_neutral_curve_has_the_values_of_its_specification() {
        let neutral = tone_curve("neutral").expect("a curve");
        // Computed by hand from the specification's formula.
        for (colour, expected) in [
            // 0.04 − (0.04 − 6.25·0.04²)
            ([0.04, 0.04, 0.04], [0.01, 0.01, 0.01]),
            ([0.5, 0.3, 0.08], [0.46, 0.26, 0.04]),
            ([0.8, 0.8, 0.8], [0.76, 0.76, 0.76]),
            // 1 − 0.24²/(0.96 + 0.24 − 0.76)
            ([1.0, 1.0, 1.0], [0.869_091, 0.869_091, 0.869_091]),
            // Peak 1.96 → 0.96, kept 1/1.15
            ([2.0, 1.0, 0.5], [0.96, 0.534_090, 0.321_136]),
        ] {
            let mapped = neutral.map(Vec3::from(colour));
            // Numbers of six digits.
            assert!(
                (mapped - Vec3::from(expected)).abs().max_element() < 1e-6,
                "{mapped}"
            );
        }
    }

    #[test]
    fn colours_are_encoded_as_srgb_after_exposure() {
        let display = Display::default();
        // 128/255 through the transfer function.
        let grey = Vec3::splat(0.215_861);
        assert_eq!(display.encode(grey), [128, 128, 128, 255]);
        assert_eq!(display.encode(Vec3::splat(1e30)), [255; 4]);
        let darker = Display::new(-2.0, tone_curve("clip").expect("a curve"));
        assert_eq!(darker.encode(4.0 * grey), [128, 128, 128, 255]);
        assert_eq!(Display::new(f32::NAN, TONE_CURVES[0]), display);
        let brightest = Display::new(f32::INFINITY, TONE_CURVES[1]);
        assert_eq!(brightest.encode(Vec3::splat(f32::MAX)), [255; 4]);
        assert_eq!(brightest.encode(Vec3::ZERO), [0, 0, 0, 255]);
    }
}
