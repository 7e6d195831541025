//! Meshes in solids. Other meshes are loaded and merged; see `merge`.

use super::{Placeable, Placed, Refusal};
use crate::scene_file::{self, Place};
use glam::DMat4;

impl Placeable for scene_file::Obj {
    /// # Errors
    /// Always.
    fn placed(&self, place: Place, _: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        Err(Refusal::new(place, "a mesh can't be part of a csg"))
    }
}
