//! The description of an emitter.

use super::description::Place;
use super::plugin::Plugin;
use super::textures::Texture;
use glam::{DMat4, DVec3};
use std::path::PathBuf;

/// An emitter. Its light is linear RGB.
#[derive(Clone, Debug, PartialEq)]
pub struct Emitter {
    /// The start of its element.
    pub place: Place,
    /// The `id` attribute.
    pub id: Option<String>,
    /// The `name` attribute.
    pub name: Option<String>,
    /// The kind of emitter with its parameters.
    pub kind: EmitterKind,
}

/// A kind of emitter with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum EmitterKind {
    /// The front of the shape that contains the emitter.
    Area {
        /// The radiance of every point to every direction.
        radiance: DVec3,
        /// A texture in place of the radiance.
        texture: Option<Box<Texture>>,
    },
    /// Light from infinitely far away, the same from all directions.
    Constant {
        /// The radiance.
        radiance: DVec3,
    },
    /// A point.
    Point {
        /// Its position in the world.
        position: DVec3,
        /// Power per solid angle.
        intensity: DVec3,
    },
    /// Light from infinitely far away, from one direction.
    Directional {
        /// The direction in which the light travels, of any length except 0.
        direction: DVec3,
        /// The irradiance of a surface that faces the light.
        irradiance: DVec3,
    },
    /// Light from infinitely far away: a picture of all directions.
    Envmap {
        /// The path of the picture, as seen from the directory of the program.
        file: PathBuf,
        /// The factor of the picture's radiance.
        scale: f64,
        /// From the picture's directions to the world's: a rotation.
        to_world: DMat4,
    },
    /// One of Mitsuba's that isn't supported and gives no light.
    Other(Box<Plugin>),
}

impl EmitterKind {
    /// The texture of an `area` emitter.
    pub fn texture(&self) -> Option<&Texture> {
        match self {
            Self::Area { texture, .. } => texture.as_deref(),
            _ => None,
        }
    }

    /// Whether it gives light to rays that leave the scene in any direction. A scene has at most one of these.
    pub fn is_environment(&self) -> bool {
        matches!(self, Self::Constant { .. } | Self::Envmap { .. })
    }
}
