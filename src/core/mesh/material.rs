//! Materials of faces: colours, highlights and textures.

use super::Texture;
use glam::{Vec2, Vec3};

/// A material of the MTL format. Colours are linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the file.
    pub name: String,
    /// Diffuse reflectance (`Kd`); `None` if the material library has none.
    pub diffuse: Option<Vec3>,
    /// Specular reflectance (`Ks`).
    pub specular: Vec3,
    /// Specular exponent (`Ns`): larger values give smaller highlights.
    pub shininess: f32,
    /// Emitted light (`Ke`).
    pub emission: Vec3,
    /// Whether the back emits light, too.
    pub emits_on_back: bool,
    /// Whether the back reflects as the front does; if not, it is black.
    pub is_two_sided: bool,
    /// Opacity (`d`, or 1 − `Tr`): 1 is opaque, 0 is invisible.
    pub opacity: f32,
    /// Shading terms in use (`illum`).
    pub illumination: Illumination,
    /// Texture that multiplies the diffuse reflectance (`map_Kd`).
    pub diffuse_map: Option<TextureMap>,
}

/// The shading terms of a material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Illumination {
    /// Unshaded diffuse colour.
    Constant,
    /// Diffuse reflection only.
    Diffuse,
    /// Diffuse reflection and highlights.
    #[default]
    Highlights,
}

/// A texture and its mapping: the texture is sampled at `scale`·(u, v) + `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureMap {
    /// Index into the mesh's textures.
    pub texture: u32,
    /// Repetitions per unit of the texture coordinates.
    pub scale: Vec2,
    /// Offset, added to the scaled texture coordinates.
    pub offset: Vec2,
}

impl TextureMap {
    /// The colour at texture coordinates `uv`, in linear RGB; white if `textures` lacks the texture. A coordinate that
    /// isn't finite counts as 0.
    pub fn colour(&self, textures: &[Texture], uv: Vec2) -> Vec3 {
        let texture = textures.get(self.texture as usize);
        texture.map_or(Vec3::ONE, |texture| {
            texture.colour(self.scale * uv + self.offset)
        })
    }
}

impl Material {
    /// A material with this name and default properties.
    pub fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default()
        }
    }
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: String::new(),
            diffuse: None,
            specular: Vec3::ZERO,
            // Without highlights the value doesn't matter; 10 gives soft ones.
            shininess: 10.0,
            emission: Vec3::ZERO,
            emits_on_back: true,
            is_two_sided: true,
            opacity: 1.0,
            illumination: Illumination::default(),
            diffuse_map: None,
        }
    }
}
