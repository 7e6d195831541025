//! Materials of faces: colours, highlights and textures.

use super::{Relief, Texture, TextureMap};
use crate::bsdf::{Bsdf, Slot};
use glam::Vec3;

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
    /// Texture that tilts the shading normal (`norm`, `bump`).
    pub relief: Option<Relief>,
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
    pub front: Side,
    /// The back; `None` if it is black.
    pub back: Option<Side>,
}

/// How a side of a surface scatters light.
#[derive(Clone, Debug, PartialEq)]
pub struct Side {
    /// The model. Where the surface has no texture coordinates, all its parameters count.
    pub bsdf: Bsdf,
    /// Textures that replace parameters of the model.
    pub maps: Vec<(Slot, TextureMap)>,
    /// Texture that tilts the shading normal.
    pub relief: Option<Relief>,
}

impl From<Bsdf> for Side {
    fn from(bsdf: Bsdf) -> Self {
        Self {
            bsdf,
            maps: Vec::new(),
            relief: None,
        }
    }
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

impl Side {
    fn maps_mut(&mut self) -> impl Iterator<Item = &mut TextureMap> {
        let relief = self.relief.iter_mut().map(|relief| &mut relief.map);
        self.maps.iter_mut().map(|(_, map)| map).chain(relief)
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

    /// Whether some side emits light.
    pub fn emits(&self) -> bool {
        self.emission.max_element() > 0.0
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
        let relief = self.relief.iter_mut().map(|relief| &mut relief.map);
        let sides = self.sides.iter_mut().flat_map(|sides| {
            let Sides { front, back } = &mut **sides;
            std::iter::once(front).chain(back).flat_map(Side::maps_mut)
        });
        let maps = self.diffuse_map.iter_mut().chain(further);
        maps.chain(relief).chain(sides)
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
            relief: None,
            sides: None,
        }
    }
}
