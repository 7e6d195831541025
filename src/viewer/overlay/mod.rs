//! Overlays: lines and texts over the traced picture, one row of [`OVERLAYS`] each.
//!
//! A new overlay is a file with its row, the file's `mod` line and the row in the table. Window, `render`, settings and
//! panel loop over the table.
//!
//! | module | contents |
//! |---|---|
//! | [`spec`] | the types of the rows |
//! | [`input`], [`gather`], [`label`] | what rows are drawn from; what they return: lines, texts |
//! | [`state`], `older` | the states of all overlays, which settings keep; those of older versions |
//! | [`wireframe`], [`elements`], [`bounding_box`], [`grid`], [`axes`] | overlays with a switch |
//! | [`face_normals`], [`vertex_normals`] | two more, and [`normals`], which they share |
//! | [`flaws`], [`picked`], [`path`], [`walk`], [`measure`] | marks of what is selected |
//! | [`shapes`], [`shape_normals`], [`traced`] | lines and normals of shapes other than meshes; their depth and outlines |
//! | [`step`] | round numbers |
//! | [`contents`] | the lines of all overlays that are on |
//! | [`layer`] | the overlay of the window's picture |
//! | `uploaded` | gathering and uploading in the background |
//! | `painter` | drawing in the background |

pub mod axes;
pub mod bounding_box;
pub mod contents;
pub mod elements;
pub mod face_normals;
pub mod flaws;
pub mod gather;
pub mod grid;
pub mod input;
pub mod label;
pub mod layer;
pub mod measure;
pub mod normals;
pub(crate) mod older;
mod painter;
pub mod path;
pub mod picked;
pub mod shape_normals;
pub mod shapes;
pub mod spec;
pub mod state;
pub mod step;
pub mod traced;
mod uploaded;
pub mod vertex_normals;
pub mod walk;
pub mod wireframe;

pub use contents::{Contents, labels};
pub use input::{Marks, OverlayInput};
pub use label::{Label, Place};
pub use layer::{OverlayError, OverlayLayer};
pub use spec::{OverlaySpec, Trigger};
pub use state::{OverlayState, Overlays};

/// All overlays, in the order of drawing and of the panel.
pub static OVERLAYS: &[&OverlaySpec] = &[
    &wireframe::WIREFRAME,
    &face_normals::FACE_NORMALS,
    &vertex_normals::VERTEX_NORMALS,
    &elements::ELEMENTS,
    &bounding_box::BOUNDING_BOX,
    &grid::GRID,
    &axes::AXES,
    &flaws::FLAWS,
    &picked::PICKED,
    &path::PATH,
    &walk::WALK,
    &measure::MEASURE,
];

/// The overlay of this name.
pub fn overlay(name: &str) -> Option<&'static OverlaySpec> {
    OVERLAYS
        .iter()
        .copied()
        .find(|overlay| overlay.name == name)
}

/// The overlays that have a switch.
pub fn switches() -> impl Iterator<Item = &'static OverlaySpec> {
    OVERLAYS
        .iter()
        .copied()
        .filter(|overlay| overlay.is_switch())
}

#[cfg(test)]
pub(crate) mod tests;
