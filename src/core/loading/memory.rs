//! Estimate of the memory that the shapes of a scene file take, besides the file's description.
//!
//! | phase | lists |
//! |---|---|
//! | merging | the meshes of the OBJ files, their vertices in the world, and the merged mesh |
//! | building trees, and tracing | the merged mesh, the trees, and the builder's lists or packed blocks |
//! | both | the placed shapes, and the core's shapes |
//!
//! Placed shapes are freed before, but the allocator keeps such small pieces of memory.
//!
//! After a tree is built, the builder's lists are freed, so that there is room for packed blocks: a kernel's numbers of a
//! shape in f32 take less.

use crate::bvh;

/// What an allocation takes besides its contents: the allocator's header, and rounding to a multiple of 16 bytes.
pub(super) const BYTES_PER_ALLOCATION: usize = 16;

/// The memory of some shapes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Needs {
    /// The meshes of OBJ files, and their vertices in the world.
    pub loaded: u64,
    /// Placed shapes.
    pub placed: u64,
    /// The core's shapes.
    pub shapes: u64,
    /// The merged mesh.
    pub merged: u64,
    /// The number of primitives in trees.
    pub primitive_count: u64,
}

impl Needs {
    /// Adds the needs of another shape.
    pub fn add(&mut self, other: Self) {
        self.loaded += other.loaded;
        self.placed += other.placed;
        self.shapes += other.shapes;
        self.merged += other.merged;
        self.primitive_count += other.primitive_count;
    }

    /// The bytes in the phase that needs most.
    pub fn bytes(&self) -> u64 {
        let merging = self.loaded + self.merged;
        let building = self.merged + bvh::BYTES_WHILE_BUILDING as u64 * self.primitive_count;
        self.placed + self.shapes + merging.max(building)
    }
}
