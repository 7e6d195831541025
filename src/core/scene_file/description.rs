//! The contents of a scene file, as plain f64 numbers: no mesh is loaded and no shape is built.

use super::emitter::Emitter;
use super::integrators::Integrator;
use super::kinds::ShapeKind;
use super::sensor::Sensor;
use super::side::Side;
use super::textures::Texture;
use crate::obj::Warning;
use glam::DMat4;
use std::path::{Path, PathBuf};

/// The description of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneFile {
    /// The scene file, then the files that it includes.
    pub files: Vec<PathBuf>,
    /// The shapes in the order of the file.
    pub shapes: Vec<Shape>,
    /// The materials: those with an identifier first.
    pub materials: Vec<Material>,
    /// The sensors in the order of the file.
    pub sensors: Vec<Sensor>,
    /// The integrator.
    pub integrator: Option<Integrator>,
    /// The emitters that aren't attached to a shape.
    pub emitters: Vec<Emitter>,
    /// What isn't used, with the line.
    pub warnings: Vec<Warning>,
}

impl SceneFile {
    /// The path of the file in which something stands; empty if there is no such file.
    pub fn path_of(&self, place: Place) -> &Path {
        let path = self.files.get(place.file as usize);
        path.map_or(Path::new(""), PathBuf::as_path)
    }

    /// The textures of all materials and emitters.
    pub fn textures(&self) -> impl Iterator<Item = &Texture> {
        let of_emitters = self.shapes.iter().filter_map(Shape::emitted_texture);
        let of_materials = self.materials.iter().flat_map(Material::textures);
        of_materials.chain(of_emitters)
    }

    /// Whether a shape's material or emitter has a texture.
    pub fn is_textured(&self, shape: &Shape) -> bool {
        let material = shape
            .material
            .and_then(|index| self.materials.get(index as usize));
        let mut textures = material.into_iter().flat_map(Material::textures);
        textures.next().is_some() || shape.emitted_texture().is_some()
    }
}

/// The file and the line in which something stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// Index into [`SceneFile::files`].
    pub file: u32,
    /// The line, counted from 1.
    pub line: u32,
}

/// A shape with its transform.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The start of its element.
    pub place: Place,
    /// The `id` attribute.
    pub id: Option<String>,
    /// The `name` attribute.
    pub name: Option<String>,
    /// The shape in its own coordinates.
    pub kind: ShapeKind,
    /// From the shape's coordinates to those of the enclosing `csg`, or else of the world.
    pub to_world: DMat4,
    /// Whether the normals point to the other side.
    pub flip_normals: bool,
    /// Index into [`SceneFile::materials`]. Without one, Mitsuba uses a diffuse reflectance of 0.5, or of 0 if there
    /// is an emitter.
    pub material: Option<u32>,
    /// The attached emitter.
    pub emitter: Option<Box<Emitter>>,
}

impl Shape {
    /// The texture of its emitter.
    pub fn emitted_texture(&self) -> Option<&Texture> {
        self.emitter.as_ref()?.kind.texture()
    }
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The start of its element.
    pub place: Place,
    /// The `id` attribute.
    pub id: Option<String>,
    /// The front, the side of the normal.
    pub front: Side,
    /// The back; `None` outside `twosided`: then it is black, unless light passes through the front.
    pub back: Option<Side>,
    /// The part of the surface that is there, from 0 to 1: `mask`.
    pub opacity: f64,
    /// A texture that multiplies the opacity.
    pub opacity_texture: Option<Texture>,
}

impl Material {
    /// Its textures.
    pub fn textures(&self) -> impl Iterator<Item = &Texture> {
        let sides = std::iter::once(&self.front).chain(&self.back);
        sides.flat_map(Side::textures).chain(&self.opacity_texture)
    }
}
