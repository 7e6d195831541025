//! Textures: images mapped onto surfaces.

use super::{Encoding, Filter, Sampling};
use crate::brightness::MAX_BRIGHTNESS;
use crate::srgb::from_texel;
use glam::{DVec3, IVec2, UVec2, Vec2, Vec3};

/// An image. Its lower left corner is at (0, 0), its upper right corner at (1, 1).
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The name in the file; empty for checkerboards.
    pub name: String,
    size: UVec2,
    texels: Texels,
    /// The alpha channel, a byte per texel; empty if all texels are opaque.
    alpha: Vec<u8>,
}

/// Values row by row from the top.
#[derive(Clone, Debug, PartialEq)]
enum Texels {
    /// Three bytes per texel.
    Bytes(Vec<u8>),
    /// Linear values, which may exceed 1.
    Linear(Vec<Vec3>),
    /// The two values of a checkerboard.
    Checkers([Vec3; 2]),
}

impl Texture {
    /// Creates a texture from texels, three bytes each, row by row from the top. `None` if their number doesn't match
    /// `size` (width and height in texels) or is 0.
    pub fn new(name: &str, size: UVec2, texels: Vec<u8>) -> Option<Self> {
        let count = 3 * size.x as usize * size.y as usize;
        (count > 0 && texels.len() == count).then(|| Self {
            name: name.to_owned(),
            size,
            texels: Texels::Bytes(texels),
            alpha: Vec::new(),
        })
    }

    /// Creates a texture from linear values, row by row from the top, and returns how many numbers were
    /// replaced: negative numbers and NaN become 0, and numbers above [`MAX_BRIGHTNESS`] become that limit. `None` as
    /// for [`new`](Self::new).
    pub fn linear(name: &str, size: UVec2, mut texels: Vec<Vec3>) -> Option<(Self, usize)> {
        let count = size.x as usize * size.y as usize;
        if count == 0 || texels.len() != count {
            return None;
        }
        let mut replaced = 0;
        for texel in &mut texels {
            // In this order NaN becomes 0.
            let valid = texel.max(Vec3::ZERO).min(Vec3::splat(MAX_BRIGHTNESS));
            replaced += valid.cmpne(*texel).bitmask().count_ones() as usize;
            *texel = valid;
        }
        let texture = Self {
            name: name.to_owned(),
            size,
            texels: Texels::Linear(texels),
            alpha: Vec::new(),
        };
        Some((texture, replaced))
    }

    /// A checkerboard of four fields: the first value where both coordinates are in the same half of 0…1.
    pub fn checkerboard(values: [Vec3; 2]) -> Self {
        Self {
            name: String::new(),
            size: UVec2::splat(2),
            texels: Texels::Checkers(values),
            alpha: Vec::new(),
        }
    }

    /// The texture with an alpha channel, a byte per texel in the same order. Without effect if their number doesn't match.
    pub fn with_alpha(mut self, alpha: Vec<u8>) -> Self {
        if let Texels::Bytes(texels) = &self.texels
            && (alpha.is_empty() || 3 * alpha.len() == texels.len())
        {
            self.alpha = alpha;
        }
        self
    }

    /// Whether the texture has an alpha channel.
    pub fn has_alpha(&self) -> bool {
        !self.alpha.is_empty()
    }

    /// A dark and pink pattern, the replacement for a missing image.
    pub fn checker() -> Self {
        // Eight fields per side. Several texels per field give sharp edges.
        const SIDE: u32 = 64;
        const FIELD: u32 = 8;
        let texel = |k: u32| {
            let is_dark = (k % SIDE / FIELD + k / SIDE / FIELD).is_multiple_of(2);
            if is_dark {
                [60, 60, 60]
            } else {
                [230, 60, 200]
            }
        };
        Self {
            name: String::new(),
            size: UVec2::splat(SIDE),
            texels: Texels::Bytes((0..SIDE * SIDE).flat_map(texel).collect()),
            alpha: Vec::new(),
        }
    }

    /// Width and height in texels.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The value at `uv`; from 0 to 1 if texels are bytes. A coordinate that isn't finite counts as 0.
    pub fn value(&self, uv: Vec2, sampling: Sampling) -> Vec3 {
        match &self.texels {
            Texels::Checkers(values) => values[usize::from(is_odd_field(uv))],
            Texels::Linear(texels) => self.between(uv, sampling, |k| texels[k]),
            Texels::Bytes(texels) => {
                let texel = |k: usize| [0, 1, 2].map(|channel| texels[3 * k + channel]);
                match sampling.encoding {
                    Encoding::Srgb => self.between(uv, sampling, |k| from_texel(texel(k))),
                    Encoding::Linear => self.between(uv, sampling, |k| {
                        Vec3::from_array(texel(k).map(f32::from)) / 255.0
                    }),
                }
            }
        }
    }

    /// The alpha channel at `uv`, from 0 to 1; `None` if there is none.
    pub fn alpha(&self, uv: Vec2, sampling: Sampling) -> Option<f32> {
        let texel = |k: usize| Vec3::splat(f32::from(self.alpha[k]) / 255.0);
        self.has_alpha()
            .then(|| self.between(uv, sampling, texel).x)
    }

    /// Whether the image looks like one of normals: coloured, and on average near (½, ½, 1).
    pub fn looks_like_normals(&self) -> bool {
        /// As bytes. Flat images have 128 and 255; those of rough surfaces deviate by less.
        const RANGE: [std::ops::Range<f64>; 3] = [96.0..160.0, 96.0..160.0, 192.0..256.0];
        let count = f64::from(self.size.x) * f64::from(self.size.y);
        let means = match &self.texels {
            Texels::Bytes(texels) => [0, 1, 2].map(|channel| {
                let values = texels.iter().skip(channel).step_by(3);
                values.map(|&value| u64::from(value)).sum::<u64>() as f64 / count
            }),
            Texels::Linear(texels) => {
                let sum: DVec3 = texels.iter().map(|texel| texel.as_dvec3()).sum();
                (sum / count * 255.0).to_array()
            }
            Texels::Checkers(_) => return false,
        };
        means
            .iter()
            .zip(RANGE)
            .all(|(mean, range)| range.contains(mean))
    }

    /// The values of texels, by their index, filtered at `uv`.
    fn between(&self, uv: Vec2, sampling: Sampling, value: impl Fn(usize) -> Vec3) -> Vec3 {
        let uv = uv.map(|x| if x.is_finite() { x } else { 0.0 });
        // Rows are counted from the top.
        let at =
            Vec2::new(uv.x, 1.0 - uv.y).map(|x| sampling.wrap.reduced(x)) * self.size.as_vec2();
        let texel = |at: IVec2| {
            let x = sampling.wrap.texel(at.x, self.size.x);
            let y = sampling.wrap.texel(at.y, self.size.y);
            value(y * self.size.x as usize + x)
        };
        if sampling.filter == Filter::Nearest {
            return texel(at.floor().as_ivec2());
        }
        // Texel centres are at half-integers.
        let at = at - 0.5;
        let (corner, part) = (at.floor().as_ivec2(), at - at.floor());
        let above = texel(corner).lerp(texel(corner + IVec2::X), part.x);
        let below = texel(corner + IVec2::Y).lerp(texel(corner + IVec2::ONE), part.x);
        above.lerp(below, part.y)
    }

    /// Size in bytes.
    pub fn bytes(&self) -> usize {
        let texels = match &self.texels {
            Texels::Bytes(texels) => size_of_val(&texels[..]),
            Texels::Linear(texels) => size_of_val(&texels[..]),
            Texels::Checkers(_) => 0,
        };
        texels + size_of_val(&self.alpha[..])
    }
}

/// Whether a point is in a field of the second value of a checkerboard, as in Mitsuba: rows are counted from the top, and
/// the middle belongs to the first half.
fn is_odd_field(uv: Vec2) -> bool {
    let in_second_half = |x: f32| x - x.floor() > 0.5;
    in_second_half(uv.x) != in_second_half(1.0 - uv.y)
}

#[cfg(test)]
mod tests {
    use super::super::Wrap;
    use super::*;

    /// Red and green above, blue and white below.
    fn texture() -> Texture {
        let texels = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]];
        Texture::new("t", UVec2::splat(2), texels.as_flattened().to_vec()).expect("four texels")
    }

    #[test]
    fn the_origin_is_the_lower_left_corner_and_the_image_repeats() {
        let texture = texture();
        for (uv, colour) in [
            ([0.25, 0.25], Vec3::Z),
            ([0.75, 0.25], Vec3::ONE),
            ([0.25, 0.75], Vec3::X),
            ([1.75, -0.25], Vec3::Y),
            ([0.5, 0.25], Vec3::new(0.5, 0.5, 1.0)),
        ] {
            let found = texture.value(Vec2::from(uv), Sampling::default());
            assert!((found - colour).length() < 1e-5, "{uv:?}: {found}");
        }
        for wrap in [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp] {
            let sampling = Sampling {
                wrap,
                ..Sampling::default()
            };
            for uv in [Vec2::NAN, Vec2::splat(f32::MAX), Vec2::splat(f32::MIN)] {
                assert!(texture.value(uv, sampling).is_finite());
            }
        }
    }

    #[test]
    fn the_alpha_channel_is_interpolated_and_values_are_not_decoded() {
        let texture = texture().with_alpha(vec![0, 255, 51, 255]);
        let alpha = |texture: &Texture, u, v| texture.alpha(Vec2::new(u, v), Sampling::default());
        assert_eq!(alpha(&texture, 0.25, 0.75), Some(0.0));
        assert_eq!(alpha(&texture, 0.25, 0.25), Some(0.2));
        let grey = Texture::new("t", UVec2::ONE, vec![51; 3]).expect("a texel");
        let linear = Sampling {
            encoding: Encoding::Linear,
            ..Sampling::default()
        };
        assert_eq!(grey.value(Vec2::ZERO, linear), Vec3::splat(0.2));
        assert!(!grey.has_alpha() && alpha(&grey, 0.0, 0.0).is_none());
    }

    #[test]
    fn filters_and_borders_are_those_of_mitsuba() {
        // Texels of Mitsuba 3.9.1's `bitmap`, times 255: the first channel is 20, 80, 140, 200 from left to right, the
        // second one the same from top to bottom.
        let texel = |k: u8| [60 * (k % 4) + 20, 60 * (k / 4) + 20, 100];
        let texels: Vec<u8> = (0..16).flat_map(texel).collect();
        let texture = Texture::new("t", UVec2::splat(4), texels).expect("16 texels");
        for (filter, wrap, at, expected) in [
            (Filter::Bilinear, Wrap::Repeat, [0.3, 0.2], [62.0, 38.0]),
            (Filter::Bilinear, Wrap::Repeat, [0.01, 0.5], [102.8, 110.0]),
            (Filter::Bilinear, Wrap::Repeat, [1.1, -0.2], [38.0, 182.0]),
            (Filter::Nearest, Wrap::Repeat, [0.3, 0.2], [80.0, 20.0]),
            (Filter::Nearest, Wrap::Repeat, [-0.3, 1.4], [140.0, 80.0]),
            (Filter::Bilinear, Wrap::Clamp, [0.01, 0.5], [20.0, 110.0]),
            (Filter::Bilinear, Wrap::Clamp, [1.1, -0.2], [200.0, 20.0]),
            (Filter::Bilinear, Wrap::Mirror, [1.1, -0.2], [200.0, 38.0]),
            (Filter::Bilinear, Wrap::Mirror, [-0.3, 1.4], [62.0, 134.0]),
        ] {
            let sampling = Sampling {
                filter,
                wrap,
                encoding: Encoding::Linear,
            };
            // Mitsuba's second coordinate points down.
            let found = 255.0 * texture.value(Vec2::new(at[0], 1.0 - at[1]), sampling);
            let expected = Vec3::new(expected[0], expected[1], 100.0);
            // The coordinates' rounding, some 2⁻²², times the slope, 240 per unit.
            assert!(
                (found - expected).length() < 1e-3,
                "{wrap:?} {at:?}: {found}"
            );
        }
    }

    #[test]
    fn a_checkerboard_has_the_first_value_where_both_coordinates_are_in_the_same_half() {
        let board = Texture::checkerboard([Vec3::X, Vec3::splat(7.0)]);
        for (u, v, is_first) in [
            (0.2, 0.2, true),
            (0.7, 0.2, false),
            (0.7, 0.7, true),
            (0.2, 0.7, false),
            (-0.2, 0.2, false),
            (0.5, 0.2, true),
        ] {
            // Mitsuba's second coordinate points down.
            let value = board.value(Vec2::new(u, 1.0 - v), Sampling::default());
            assert_eq!(value == Vec3::X, is_first, "{u} {v}");
        }
        assert!(!board.looks_like_normals());
    }

    #[test]
    fn images_of_normals_are_told_from_heights_by_their_colour() {
        let even = |texel: [u8; 3]| Texture::new("t", UVec2::ONE, texel.to_vec()).expect("a texel");
        assert!(even([128, 128, 255]).looks_like_normals());
        for texel in [[128; 3], [255; 3], [0, 128, 255]] {
            assert!(!even(texel).looks_like_normals(), "{texel:?}");
        }
    }

    #[test]
    fn linear_texels_are_not_decoded_and_may_exceed_1() {
        let texels = vec![Vec3::new(0.5, 8.0, -1.0), Vec3::new(f32::NAN, 1e30, 0.0)];
        let made = Texture::linear("t", UVec2::new(2, 1), texels);
        let (texture, replaced) = made.expect("two texels");
        assert_eq!((replaced, texture.bytes()), (3, 24));
        for encoding in [Encoding::Srgb, Encoding::Linear] {
            let sampling = Sampling {
                encoding,
                ..Sampling::default()
            };
            let at = |u: f32| texture.value(Vec2::new(u, 0.5), sampling);
            assert_eq!(at(0.25), Vec3::new(0.5, 8.0, 0.0));
            assert_eq!(at(0.75), Vec3::new(0.0, MAX_BRIGHTNESS, 0.0));
        }
        let normals = Texture::linear("t", UVec2::ONE, vec![Vec3::new(0.5, 0.5, 1.0)]);
        assert!(normals.is_some_and(|(texture, _)| texture.looks_like_normals()));
        assert_eq!(Texture::linear("t", UVec2::ONE, Vec::new()), None);
    }

    #[test]
    fn the_number_of_texels_must_match_the_size() {
        assert_eq!(Texture::new("t", UVec2::new(2, 1), vec![0; 3]), None);
        assert_eq!(Texture::new("t", UVec2::ZERO, Vec::new()), None);
    }
}
