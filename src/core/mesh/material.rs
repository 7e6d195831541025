//! Materials of faces: colours, highlights and textures.

use super::Texture;
use crate::bsdf::Bsdf;
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
    /// Index of refraction (`Ni`).
    pub refraction: f32,
    /// The colour that glass gives to light that passes (`Tf`); `None` if the material library has none: white.
    pub filter: Option<Vec3>,
    /// Roughness from 0 to 1 (`Pr`).
    pub roughness: Option<f32>,
    /// Metalness from 0 to 1 (`Pm`).
    pub metalness: Option<f32>,
    /// Texture that multiplies the diffuse reflectance (`map_Kd`); its alpha channel multiplies the opacity.
    pub diffuse_map: Option<TextureMap>,
    /// Textures that multiply other properties, at most one a property.
    pub further_maps: Vec<(Property, TextureMap)>,
    /// How both sides scatter light, if a scene file says so instead of the statements above. Views without global light
    /// use those.
    pub sides: Option<Box<Sides>>,
}

/// A property that a texture multiplies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// Specular reflectance (`map_Ks`).
    Specular,
    /// Emitted light (`map_Ke`).
    Emission,
    /// Opacity (`map_d`): the alpha channel, or the brightness of pictures without one.
    Opacity,
    /// Roughness (`map_Pr`).
    Roughness,
    /// Metalness (`map_Pm`).
    Metalness,
}

/// How both sides of a surface scatter light.
#[derive(Clone, Debug, PartialEq)]
pub struct Sides {
    /// The front, the side of the normal. If light passes through it, it is the back, too.
    pub front: Bsdf,
    /// The back; `None` if it is black.
    pub back: Option<Bsdf>,
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
    /// Diffuse reflection and a mirror.
    Mirror,
    /// Diffuse reflection and a mirror that reflects more at grazing angles.
    FresnelMirror,
    /// Glass.
    Glass,
}

impl Illumination {
    /// Whether there are highlights, or reflections in place of them.
    pub fn has_highlights(self) -> bool {
        !matches!(self, Self::Constant | Self::Diffuse)
    }
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

    /// The values at texture coordinates `uv`, from 0 to 1, without conversion from sRGB; otherwise as
    /// [`colour`](Self::colour).
    pub fn values(&self, textures: &[Texture], uv: Vec2) -> Vec3 {
        let texture = textures.get(self.texture as usize);
        texture.map_or(Vec3::ONE, |texture| {
            texture.values(self.scale * uv + self.offset)
        })
    }

    /// The alpha channel at texture coordinates `uv`; `None` if the texture has none.
    pub fn alpha(&self, textures: &[Texture], uv: Vec2) -> Option<f32> {
        let texture = textures.get(self.texture as usize)?;
        texture.alpha(self.scale * uv + self.offset)
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

    /// The texture that multiplies a property.
    pub fn further_map(&self, property: Property) -> Option<&TextureMap> {
        let found = self
            .further_maps
            .iter()
            .find(|(other, _)| *other == property);
        found.map(|(_, map)| map)
    }

    /// All textures.
    pub fn maps_mut(&mut self) -> impl Iterator<Item = &mut TextureMap> {
        let further = self.further_maps.iter_mut().map(|(_, map)| map);
        self.diffuse_map.iter_mut().chain(further)
    }

    /// Whether light may pass through parts of a surface of this material without being scattered.
    pub fn has_coverage(&self, textures: &[Texture]) -> bool {
        let has_alpha = |map: &TextureMap| {
            let texture = textures.get(map.texture as usize);
            texture.is_some_and(Texture::has_alpha)
        };
        self.opacity < 1.0
            || self.further_map(Property::Opacity).is_some()
            || self.diffuse_map.as_ref().is_some_and(has_alpha)
    }

    /// Whether light is refracted. Many programs write an `illum` of glass for all materials, and an index of 1, or they
    /// describe transparency by `d` alone; such materials aren't glass.
    pub fn is_glass(&self) -> bool {
        self.illumination == Illumination::Glass
            && self.refraction != 1.0
            && (self.opacity >= 1.0 || self.filter.is_some())
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
            refraction: 1.0,
            filter: None,
            roughness: None,
            metalness: None,
            diffuse_map: None,
            further_maps: Vec::new(),
            sides: None,
        }
    }
}
