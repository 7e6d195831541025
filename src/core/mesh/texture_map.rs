//! Textures with their place on surfaces.

use super::{Encoding, Sampling, Texture};
use glam::{Affine2, Mat2, Vec2, Vec3};

/// A texture and its mapping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureMap {
    /// Index into the mesh's textures.
    pub texture: u32,
    /// From the surface's texture coordinates to the texture's.
    pub transform: Affine2,
    /// How the texture is read.
    pub sampling: Sampling,
}

impl TextureMap {
    /// The map of an index into the mesh's textures, without a transform.
    pub fn of(texture: u32) -> Self {
        Self {
            texture,
            transform: Affine2::IDENTITY,
            sampling: Sampling::default(),
        }
    }

    /// The map that samples at `scale`·(u, v) + `offset`.
    pub fn placed(self, scale: Vec2, offset: Vec2) -> Self {
        let transform = Affine2::from_mat2_translation(Mat2::from_diagonal(scale), offset);
        Self { transform, ..self }
    }

    /// The map with another meaning of texels.
    pub fn encoded(mut self, encoding: Encoding) -> Self {
        self.sampling.encoding = encoding;
        self
    }

    /// The value at texture coordinates `uv`; 1 if `textures` lacks the texture. A coordinate that isn't finite counts as
    /// 0.
    pub fn value(&self, textures: &[Texture], uv: Vec2) -> Vec3 {
        let texture = textures.get(self.texture as usize);
        texture.map_or(Vec3::ONE, |texture| {
            texture.value(self.transform.transform_point2(uv), self.sampling)
        })
    }

    /// The alpha channel at texture coordinates `uv`; `None` if the texture has none.
    pub fn alpha(&self, textures: &[Texture], uv: Vec2) -> Option<f32> {
        let texture = textures.get(self.texture as usize)?;
        texture.alpha(self.transform.transform_point2(uv), self.sampling)
    }
}
