//! The kinds of shapes: a file per kind or per pair of similar kinds, and a row of the table per kind.
//!
//! A file holds the parameters of its kind, their defaults, and how they are read and written. A new kind needs such a
//! file, a row of the table, and a file in `loading/placed` that transforms it.

mod axial;
mod csg;
mod cuboid;
mod flat;
mod obj;
mod plane;
mod quadric;
mod sphere;
mod torus;

pub use axial::{Cone, Cylinder};
pub use csg::Csg;
pub use cuboid::{Cube, Cuboid};
pub use flat::{Disk, Rectangle};
pub use obj::Obj;
pub(super) use obj::name_of;
pub use plane::Plane;
pub use quadric::Quadric;
pub use sphere::Sphere;
pub use torus::Torus;

use super::problem::Problem;
use super::reader::Reader;
use super::shapes::Parts;
use super::writer::Writer;
use super::xml::WriteError;

/// Passes the table of kinds to a macro: Mitsuba's, then our own.
macro_rules! with_kinds {
    ($callback:ident) => {
        $callback! {
            /// The mesh of an OBJ file.
            Obj,
            /// A sphere.
            Sphere,
            /// A cylinder.
            Cylinder,
            /// A disk.
            Disk,
            /// A rectangle.
            Rectangle,
            /// A cube.
            Cube,
            /// An infinite plane.
            Plane,
            /// A box with edges along the axes.
            Cuboid,
            /// A cone.
            Cone,
            /// A torus.
            Torus,
            /// A quadric, cut by a box.
            Quadric,
            /// A solid made of others.
            Csg,
        }
    };
}
pub(crate) use with_kinds;

/// The parameters of a kind of shape.
pub(super) trait Kind: Sized {
    /// The `type` attribute.
    const NAME: &'static str;
    /// Whether shapes are nested in it.
    const HAS_CHILDREN: bool = false;

    /// Takes the parameters, or their defaults, from the parts of an element.
    ///
    /// # Errors
    /// A parameter is missing or isn't valid.
    fn read(parts: &mut Parts, reader: &mut Reader) -> Result<Self, Problem>;

    /// Writes the parameters.
    ///
    /// # Errors
    /// A name has no form in the format.
    fn write(&self, writer: &mut Writer) -> Result<(), WriteError>;
}

/// How a kind of shape is read.
pub(super) struct KindReader {
    /// The `type` attribute.
    pub name: &'static str,
    /// See [`Kind::HAS_CHILDREN`].
    pub has_children: bool,
    /// See [`Kind::read`].
    pub read: fn(&mut Parts, &mut Reader) -> Result<ShapeKind, Problem>,
}

macro_rules! shape_kinds {
    ($($(#[$doc:meta])* $kind:ident,)*) => {
        /// A kind of shape with its parameters.
        #[derive(Clone, Debug, PartialEq)]
        pub enum ShapeKind {
            $($(#[$doc])* $kind($kind),)*
        }

        /// All kinds.
        pub(super) const KINDS: &[KindReader] = &[$(KindReader {
            name: $kind::NAME,
            has_children: $kind::HAS_CHILDREN,
            read: |parts, reader| Ok(ShapeKind::$kind($kind::read(parts, reader)?)),
        },)*];

        impl ShapeKind {
            /// The `type` attribute.
            pub(crate) fn name(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => $kind::NAME,)*
                }
            }

            /// See [`Kind::write`].
            pub(super) fn write(&self, writer: &mut Writer) -> Result<(), WriteError> {
                match self {
                    $(Self::$kind(kind) => kind.write(writer),)*
                }
            }
        }
    };
}

with_kinds!(shape_kinds);
