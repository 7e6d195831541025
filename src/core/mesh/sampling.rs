//! Sampling of textures: filters between texels, and values beyond the image.

/// How a texture is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sampling {
    /// Between texels.
    pub filter: Filter,
    /// Beyond the image.
    pub wrap: Wrap,
    /// The meaning of bytes.
    pub encoding: Encoding,
}

/// Values between texel centres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Filter {
    /// Bilinear interpolation.
    #[default]
    Bilinear,
    /// The value of the nearest texel.
    Nearest,
}

/// Values beyond the image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wrap {
    /// The image repeats.
    #[default]
    Repeat,
    /// The image repeats, each time mirrored.
    Mirror,
    /// The texels of the border continue.
    Clamp,
}

/// The meaning of bytes. Texels that aren't bytes are linear.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// sRGB, for colours.
    #[default]
    Srgb,
    /// Proportional to the value, for all else.
    Linear,
}

impl Wrap {
    /// The texel that stands for one of `count` texels in a row or column, of which there may be none at `index`.
    pub(super) fn texel(self, index: i32, count: u32) -> usize {
        // In 64 bits, where twice the count can't overflow.
        let (index, count) = (i64::from(index), i64::from(count));
        let inside = match self {
            Self::Repeat => index.rem_euclid(count),
            Self::Clamp => index.clamp(0, count - 1),
            Self::Mirror => {
                let in_pair = index.rem_euclid(2 * count);
                in_pair.min(2 * count - 1 - in_pair)
            }
        };
        inside as usize
    }

    /// A coordinate from which the texels' indices fit into 32 bits: the same by period, or by clamping.
    pub(super) fn reduced(self, x: f32) -> f32 {
        match self {
            Self::Repeat => x - x.floor(),
            Self::Mirror => x - 2.0 * (0.5 * x).floor(),
            Self::Clamp => x.clamp(-1.0, 2.0),
        }
    }
}
