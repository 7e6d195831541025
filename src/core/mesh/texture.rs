//! Textures: images mapped onto surfaces.

use crate::srgb::from_texel;
use glam::{UVec2, Vec2, Vec3};

/// An image that repeats over the plane. Its lower left corner is at (0, 0), its upper right corner at (1, 1).
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The name in the file; empty for the checkerboard.
    pub name: String,
    size: UVec2,
    /// sRGB, three bytes per texel, row by row from the top.
    texels: Vec<u8>,
    /// The alpha channel, a byte per texel; empty if all texels are opaque.
    alpha: Vec<u8>,
}

impl Texture {
    /// Creates a texture from sRGB texels, three bytes each, row by row from the top. `None` if their number doesn't
    /// match `size` (width and height in texels) or is 0.
    pub fn new(name: &str, size: UVec2, texels: Vec<u8>) -> Option<Self> {
        let count = 3 * size.x as usize * size.y as usize;
        (count > 0 && texels.len() == count).then(|| Self {
            name: name.to_owned(),
            size,
            texels,
            alpha: Vec::new(),
        })
    }

    /// The texture with an alpha channel, a byte per texel in the same order. Without effect if their number doesn't match.
    pub fn with_alpha(mut self, alpha: Vec<u8>) -> Self {
        if 3 * alpha.len() == self.texels.len() {
            self.alpha = alpha;
        }
        self
    }

    /// Whether the texture has an alpha channel.
    pub fn has_alpha(&self) -> bool {
        !self.alpha.is_empty()
    }

    /// A checkerboard, the replacement for a missing image.
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
            texels: (0..SIDE * SIDE).flat_map(texel).collect(),
            alpha: Vec::new(),
        }
    }

    /// The colour at `uv` in linear RGB, bilinearly interpolated. A coordinate that isn't finite counts as 0.
    pub fn colour(&self, uv: Vec2) -> Vec3 {
        self.interpolated(uv, |k| from_texel(self.texel(k)))
    }

    /// The values at `uv`, from 0 to 1, without conversion from sRGB; otherwise as [`colour`](Self::colour).
    pub fn values(&self, uv: Vec2) -> Vec3 {
        self.interpolated(uv, |k| {
            Vec3::from_array(self.texel(k).map(f32::from)) / 255.0
        })
    }

    /// The alpha channel at `uv`, from 0 to 1; `None` if there is none.
    pub fn alpha(&self, uv: Vec2) -> Option<f32> {
        let texel = |k: usize| Vec3::splat(f32::from(self.alpha[k]) / 255.0);
        self.has_alpha().then(|| self.interpolated(uv, texel).x)
    }

    fn texel(&self, index: usize) -> [u8; 3] {
        [0, 1, 2].map(|channel| self.texels[3 * index + channel])
    }

    /// The values of texels, by their index, interpolated at `uv`.
    fn interpolated(&self, uv: Vec2, value: impl Fn(usize) -> Vec3) -> Vec3 {
        let size = self.size.as_vec2();
        // Texel centres are at half-integers; rows are counted from the top.
        let uv = uv.map(|x| if x.is_finite() { x } else { 0.0 });
        let at = Vec2::new(uv.x, 1.0 - uv.y);
        let at = (at - at.floor()) * size - 0.5;
        let (corner, part) = (at.floor(), at - at.floor());
        let texel = |dx: i32, dy: i32| {
            let x = (corner.x as i32 + dx).rem_euclid(self.size.x as i32);
            let y = (corner.y as i32 + dy).rem_euclid(self.size.y as i32);
            value(y as usize * self.size.x as usize + x as usize)
        };
        let above = texel(0, 0).lerp(texel(1, 0), part.x);
        let below = texel(0, 1).lerp(texel(1, 1), part.x);
        above.lerp(below, part.y)
    }

    /// Size in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.texels[..]) + size_of_val(&self.alpha[..])
    }
}

#[cfg(test)]
mod tests {
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
            let found = texture.colour(Vec2::from(uv));
            assert!((found - colour).length() < 1e-5, "{uv:?}: {found}");
        }
        let (nan, huge) = (Vec2::NAN, Vec2::splat(f32::MAX));
        assert!(texture.colour(nan).is_finite() && texture.colour(huge).is_finite());
    }

    #[test]
    fn the_alpha_channel_is_interpolated_and_values_are_not_decoded() {
        let texture = texture().with_alpha(vec![0, 255, 51, 255]);
        assert_eq!(texture.alpha(Vec2::new(0.25, 0.75)), Some(0.0));
        assert_eq!(texture.alpha(Vec2::new(0.25, 0.25)), Some(0.2));
        let grey = Texture::new("t", UVec2::ONE, vec![51; 3]).expect("a texel");
        assert_eq!(grey.values(Vec2::ZERO), Vec3::splat(0.2));
        assert!(!grey.has_alpha() && grey.alpha(Vec2::ZERO).is_none());
    }

    #[test]
    fn the_number_of_texels_must_match_the_size() {
        assert_eq!(Texture::new("t", UVec2::new(2, 1), vec![0; 3]), None);
        assert_eq!(Texture::new("t", UVec2::ZERO, Vec::new()), None);
    }
}
