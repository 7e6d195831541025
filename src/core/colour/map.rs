//! Colour maps: colours in an order that the eye sees, also with a colour vision deficiency.

use super::stops;
use crate::srgb::from_display;
use glam::Vec3;

/// A colour for each number from 0 to 1.
pub struct ColourMap {
    /// The name, as in `--colour-map`.
    pub name: &'static str,
    /// The title in menus.
    pub title: &'static str,
    /// Its colours, in a sentence.
    pub about: &'static str,
    /// Where it is published.
    pub source: &'static str,
    /// The order of its colours.
    pub kind: MapKind,
    /// Colours at equal distances, as 0xRRGGBB in sRGB; linear in sRGB between them.
    stops: &'static [u32],
}

/// The order of a map's colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapKind {
    /// Lighter for larger numbers.
    Sequential,
    /// Lightest in the middle, with a hue for either side.
    Diverging,
}

/// The colour of what isn't a number, in linear RGB: magenta, which is in none of the maps.
pub const NO_NUMBER: Vec3 = Vec3::new(1.0, 0.0, 1.0);

/// All maps, in the order of the menu.
pub static COLOUR_MAPS: &[&ColourMap] = &[&VIRIDIS, &CIVIDIS, &DUSK, &GREY, &VIK];

/// The map of this name.
pub fn colour_map(name: &str) -> Option<&'static ColourMap> {
    COLOUR_MAPS.iter().copied().find(|map| map.name == name)
}

pub(crate) static VIRIDIS: ColourMap = ColourMap {
    name: "viridis",
    title: "Viridis",
    about: "Violet, blue, green, yellow.",
    source: "Smith, van der Walt, A Better Default Colormap for Matplotlib, SciPy 2015; CC0",
    kind: MapKind::Sequential,
    stops: &stops::VIRIDIS,
};

static CIVIDIS: ColourMap = ColourMap {
    name: "cividis",
    title: "Cividis",
    about: "Blue, grey, yellow; looks almost the same with red-green deficiencies.",
    source: "Nuñez, Anderton, Renslow, Optimizing Colormaps with Consideration for Color Vision Deficiency, PLOS ONE 13(7), 2018",
    kind: MapKind::Sequential,
    stops: &stops::CIVIDIS,
};

pub(crate) static DUSK: ColourMap = ColourMap {
    name: "dusk",
    title: "Dusk",
    about: "Blue, pink, gold, white; all of them are readable on a dark background.",
    source: "Equal steps of the lightness L* of CIE 1976 from 58 to 100",
    kind: MapKind::Sequential,
    stops: &stops::DUSK,
};

pub(crate) static GREY: ColourMap = ColourMap {
    name: "grey",
    title: "Grey",
    about: "Dark grey to white.",
    source: "",
    kind: MapKind::Sequential,
    stops: &stops::GREY,
};

static VIK: ColourMap = ColourMap {
    name: "vik",
    title: "Vik",
    about: "Blue, white, brown, for numbers on both sides of a middle.",
    source: "Crameri, Scientific Colour Maps, 2018, doi 10.5281/zenodo.1243862; MIT",
    kind: MapKind::Diverging,
    stops: &stops::VIK,
};

impl ColourMap {
    /// The linear colour of a number, which is clamped to 0…1; [`NO_NUMBER`] for NaN.
    pub fn colour(&self, part: f32) -> Vec3 {
        if part.is_nan() {
            return NO_NUMBER;
        }
        let at = part.clamp(0.0, 1.0) * (self.stops.len() - 1) as f32;
        let first = (at as usize).min(self.stops.len() - 2);
        let stop = |index: usize| {
            let [_, r, g, b] = self.stops[index].to_be_bytes().map(f32::from);
            Vec3::new(r, g, b) / 255.0
        };
        from_display(stop(first).lerp(stop(first + 1), at - first as f32))
    }
}

impl PartialEq for ColourMap {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl std::fmt::Debug for ColourMap {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::srgb::luminance;

    /// CIE 1976 L* of a linear colour.
    fn lightness(linear: Vec3) -> f32 {
        let y = luminance(linear);
        if y > 216.0 / 24389.0 {
            116.0 * y.cbrt() - 16.0
        } else {
            y * 24389.0 / 27.0
        }
    }

    /// What people without one kind of cones see, in linear RGB.
    ///
    /// Source: Machado, Oliveira, Fernandes, "A Physiologically-based Model for Simulation of Color Vision Deficiency",
    /// IEEE TVCG 15(6), 2009, table 1, severity 1.
    fn deficient(linear: Vec3, [r, g, b]: [[f32; 3]; 3]) -> Vec3 {
        let seen = [r, g, b].map(|row| Vec3::from_array(row).dot(linear));
        Vec3::from_array(seen).clamp(Vec3::ZERO, Vec3::ONE)
    }

    const PROTANOPIA: [[f32; 3]; 3] = [
        [0.152_286, 1.052_583, -0.204_868],
        [0.114_503, 0.786_281, 0.099_216],
        [-0.003_882, -0.048_116, 1.051_998],
    ];
    const DEUTERANOPIA: [[f32; 3]; 3] = [
        [0.367_322, 0.860_646, -0.227_968],
        [0.280_085, 0.672_501, 0.047_413],
        [-0.011_820, 0.042_940, 0.968_881],
    ];
    const NORMAL: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    /// The lightness of 257 colours of a map.
    fn lightnesses(map: &ColourMap, vision: [[f32; 3]; 3]) -> Vec<f32> {
        let colour = |k: u16| deficient(map.colour(f32::from(k) / 256.0), vision);
        (0..=256).map(|k| lightness(colour(k))).collect()
    }

    #[test]
    fn larger_numbers_are_lighter_in_sequential_maps_also_with_red_green_deficiencies() {
        for map in COLOUR_MAPS {
            for vision in [NORMAL, PROTANOPIA, DEUTERANOPIA] {
                let all = lightnesses(map, vision);
                let rises = |pair: &[f32]| pair[0] < pair[1];
                match map.kind {
                    MapKind::Sequential => {
                        assert!(all.windows(2).all(rises), "{map:?}: {all:?}");
                        assert!(all[256] - all[0] > 35.0, "{map:?}: a range of lightness");
                    }
                    MapKind::Diverging => {
                        let middle = all[128];
                        let ends = [all[0], all[256]];
                        // The published map is lightest near its middle.
                        assert!(all.iter().all(|&l| l < middle + 2.0), "{map:?}: {all:?}");
                        assert!(ends.iter().all(|&end| middle - end > 60.0), "{map:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn steps_of_the_map_dusk_are_equally_light_and_all_of_it_stands_out_on_dark_grey() {
        let all = lightnesses(&DUSK, NORMAL);
        for (k, pair) in all.windows(2).enumerate() {
            // 42 in 256 steps, with stops rounded to 8 bits: half a unit is up to 0.2 of L*, in 16 steps of 0.164.
            let step = pair[1] - pair[0];
            assert!((0.12..0.21).contains(&step), "{k}: {step}");
        }
        // The dark theme's background.
        let background = luminance(from_display(Vec3::new(0.13, 0.14, 0.16)));
        for k in 0..=256u16 {
            let colour = luminance(DUSK.colour(f32::from(k) / 256.0));
            assert!((colour + 0.05) / (background + 0.05) >= 4.5, "{k}");
        }
    }

    #[test]
    fn ends_are_the_published_colours_and_numbers_outside_are_clamped() {
        for (name, first, last) in [
            ("viridis", [0x44, 0x01, 0x54], [0xfd, 0xe7, 0x25]),
            ("cividis", [0x00, 0x22, 0x4e], [0xfe, 0xe8, 0x38]),
            ("vik", [0x00, 0x12, 0x61], [0x59, 0x00, 0x08]),
        ] {
            let map = colour_map(name).expect("in the table");
            let colour = |rgb: [u8; 3]| from_display(Vec3::from_array(rgb.map(f32::from)) / 255.0);
            for (part, expected) in [
                (0.0, colour(first)),
                (-1.0, colour(first)),
                (f32::NEG_INFINITY, colour(first)),
                (1.0, colour(last)),
                (f32::INFINITY, colour(last)),
                (f32::NAN, NO_NUMBER),
            ] {
                assert_eq!(map.colour(part), expected, "{name} {part}");
            }
        }
        assert!(colour_map("jet").is_none());
    }

    #[test]
    fn no_map_contains_the_colour_of_what_is_not_a_number() {
        for map in COLOUR_MAPS {
            for k in 0..=256u16 {
                let colour = map.colour(f32::from(k) / 256.0);
                // A fifth of the way from black to white.
                assert!((colour - NO_NUMBER).length() > 0.35, "{map:?} {k}");
            }
        }
    }
}
