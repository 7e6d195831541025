//! Meshes in solids. Other meshes are loaded and merged; see `merge`.

use super::{Placeable, Placed, Refusal};
use crate::scene_file::{self, Shape};
use glam::DMat4;

impl Placeable for scene_file::Obj {
    /// # Errors
    /// Always.
    fn placed(&self, shape: &Shape, _: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        Err(Refusal::new(shape.place, "a mesh can't be part of a csg"))
    }
}
