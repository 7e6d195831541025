//! Materials: colours, highlights and textures of faces.

use super::Texture;
use glam::{Vec2, Vec3};

/// A material. Colours are linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the file.
    pub name: String,
    /// Diffuse reflectance (`Kd`), if the material library has one.
    pub diffuse: Option<Vec3>,
    /// Reflectance of highlights (`Ks`).
    pub specular: Vec3,
    /// Exponent of the highlights (`Ns`): larger values give smaller highlights.
    pub shininess: f32,
    /// Emitted light (`Ke`).
    pub emission: Vec3,
    /// 1 is opaque, 0 is invisible (`d`, or 1 − `Tr`).
    pub opacity: f32,
    /// The shading terms in use (`illum`).
    pub illumination: Illumination,
    /// Texture that the diffuse reflectance is multiplied by (`map_Kd`).
    pub diffuse_map: Option<TextureMap>,
}

/// The shading terms of a material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Illumination {
    /// The diffuse colour without shading.
    Constant,
    /// Diffuse reflection only.
    Diffuse,
    /// Diffuse reflection and highlights.
    #[default]
    Highlights,
}

/// A texture and its mapping: it is sampled at `scale`·(u, v) + `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureMap {
    /// Index into the mesh's textures.
    pub texture: u32,
    /// Number of repetitions per unit.
    pub scale: Vec2,
    /// Offset of the texture coordinates.
    pub offset: Vec2,
}

impl TextureMap {
    /// The colour at texture coordinates `uv`, in linear RGB; white if there is no such texture. A coordinate
    /// that isn't finite counts as 0.
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
            opacity: 1.0,
            illumination: Illumination::default(),
            diffuse_map: None,
        }
    }
}
