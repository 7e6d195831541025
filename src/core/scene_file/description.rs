//! The contents of a scene file, as plain f64 numbers: no mesh is loaded and no shape is built.

pub use crate::group::CsgOperation;

use super::bsdf::Bsdf;
use super::emitter::Emitter;
use super::integrators::Integrator;
use super::sensor::Sensor;
use crate::obj::Warning;
use glam::{DMat4, DVec3};
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

/// A kind of shape with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub enum ShapeKind {
    /// The mesh of an OBJ file.
    Obj {
        /// The path of the file, as seen from the directory of the program: relative names are resolved against the
        /// folder of the scene file with the name.
        file: PathBuf,
        /// Whether the file's normals are ignored.
        face_normals: bool,
        /// Whether the second texture coordinate is 1 − v.
        flip_tex_coords: bool,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        center: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// A cylinder, open unless it is capped.
    Cylinder {
        /// The centre of one end.
        p0: DVec3,
        /// The centre of the other end.
        p1: DVec3,
        /// Its radius.
        radius: f64,
        /// Whether disks close its ends.
        is_capped: bool,
    },
    /// The unit disk in the plane z = 0, facing +z.
    Disk,
    /// The square from (−1, −1, 0) to (1, 1, 0), facing +z.
    Rectangle,
    /// The cube from (−1, −1, −1) to (1, 1, 1).
    Cube,
    /// An infinite plane.
    Plane {
        /// A point of the plane.
        point: DVec3,
        /// Its normal, of any length except 0.
        normal: DVec3,
    },
    /// A box with edges along the axes.
    Box {
        /// Its lowest corner.
        min: DVec3,
        /// Its highest corner.
        max: DVec3,
    },
    /// A cone, open unless it is capped.
    Cone {
        /// The centre of its base.
        p0: DVec3,
        /// Its apex.
        p1: DVec3,
        /// The radius of its base.
        radius: f64,
        /// Whether a disk closes its base.
        is_capped: bool,
    },
    /// A torus.
    Torus {
        /// Its centre.
        center: DVec3,
        /// Its axis of revolution, of any length except 0.
        axis: DVec3,
        /// The radius of the circle of revolution.
        major: f64,
        /// The radius of the tube.
        minor: f64,
    },
    /// A quadric, cut by a box.
    Quadric(Box<Quadric>),
    /// A solid made of others.
    Csg {
        /// How the solids are combined.
        operation: CsgOperation,
        /// The solids; at least two.
        children: Vec<Shape>,
    },
}

/// The part inside a box of the surface ax² + by² + cz² + 2dxy + 2eyz + 2fxz + 2gx + 2hy + 2iz + j = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Quadric {
    /// The coefficients a to j.
    pub coefficients: [f64; 10],
    /// The lowest corner of the box.
    pub min: DVec3,
    /// The highest corner of the box.
    pub max: DVec3,
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The start of its element.
    pub place: Place,
    /// The `id` attribute.
    pub id: Option<String>,
    /// The front, the side of the normal.
    pub front: Bsdf,
    /// The back; `None` outside `twosided`: then it is black, unless light passes through the front.
    pub back: Option<Bsdf>,
    /// The part of the surface that is there, from 0 to 1: `mask`.
    pub opacity: f64,
}
