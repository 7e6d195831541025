//! Materials: colours, highlights and textures of faces.

use super::Texture;
use glam::{Vec2, Vec3};

/// A material. Colours are linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// As the file calls it.
    pub name: String,
    /// Diffuse reflectance (`Kd`), where the material library gives one.
    pub diffuse: Option<Vec3>,
    /// Reflectance of highlights (`Ks`).
    pub specular: Vec3,
    /// Exponent of the highlights (`Ns`): the larger it is, the smaller they are.
    pub shininess: f32,
    /// Emitted light (`Ke`).
    pub emission: Vec3,
    /// 1 hides what is behind, 0 is invisible (`d`, or 1 − `Tr`).
    pub opacity: f32,
    /// Which lights count (`illum`).
    pub illumination: Illumination,
    /// A picture that the diffuse reflectance is multiplied by (`map_Kd`).
    pub diffuse_map: Option<TextureMap>,
}

/// The parts of shading that a material has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Illumination {
    /// None: its diffuse colour as it is.
    Constant,
    /// Diffuse reflection alone.
    Diffuse,
    /// Highlights, too.
    #[default]
    Highlights,
}

/// A texture, and how it lies on the surface: at `scale`·(u, v) + `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureMap {
    /// Index into the mesh's textures.
    pub texture: u32,
    /// How often it repeats.
    pub scale: Vec2,
    /// Where it begins.
    pub offset: Vec2,
}

impl TextureMap {
    /// The colour at a surface's texture coordinates, in linear RGB; white if there is no such texture. A
    /// coordinate that isn't finite counts as 0.
    pub fn colour(&self, textures: &[Texture], uv: Vec2) -> Vec3 {
        let texture = textures.get(self.texture as usize);
        texture.map_or(Vec3::ONE, |texture| {
            texture.colour(self.scale * uv + self.offset)
        })
    }
}

impl Material {
    /// Of which nothing is known but its name.
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
            // Without a highlight it doesn't matter; 10 is a soft one.
            shininess: 10.0,
            emission: Vec3::ZERO,
            opacity: 1.0,
            illumination: Illumination::default(),
            diffuse_map: None,
        }
    }
}
