//! Compact storage of triangles in half the memory: each block's corners once, and indices of its triangles
//! into them.
//!
//! A block's values are packed again for every test.

use crate::bvh::{BLOCK_SIZE, Bvh};
use crate::mesh::TriangleMesh;
use crate::simd::prefetch;
use fearless_simd::Simd;
use glam::Vec3;
use rayon::prelude::*;

/// Storage of triangles for tracing. The results are the same, bit for bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Packing {
    /// In the kernel's layout: the fastest.
    #[default]
    Full,
    /// In the least memory.
    Compact,
}

/// Contents of lanes without a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EmptyLanes {
    /// Values that no kernel hits.
    Nothing,
    /// A copy of the block's first triangle.
    First,
}

/// Blocks per chunk that a thread packs.
pub(super) const BLOCKS_AT_ONCE: usize = 1024;

/// A block's triangles: per lane, the indices of A, B and C among the block's corners.
struct CornerSlots {
    first: u32,
    corners: [[u8; BLOCK_SIZE]; 3],
}

/// See the [module](self).
pub(super) struct SharedCorners {
    corners: Vec<Vec3>,
    blocks: Vec<CornerSlots>,
}

impl SharedCorners {
    pub fn of(mesh: &TriangleMesh, bvh: &Bvh, empty: EmptyLanes) -> Self {
        let count = bvh.block_count();
        let parts: Vec<Self> = (0..count.div_ceil(BLOCKS_AT_ONCE))
            .into_par_iter()
            .map(|part| {
                let first = part * BLOCKS_AT_ONCE;
                let mut shared = Self {
                    corners: Vec::new(),
                    blocks: Vec::with_capacity(BLOCKS_AT_ONCE),
                };
                for block in first..count.min(first + BLOCKS_AT_ONCE) {
                    shared.push(mesh, bvh.block(block), empty);
                }
                shared
            })
            .collect();
        let mut all = Self {
            corners: Vec::with_capacity(parts.iter().map(|part| part.corners.len()).sum()),
            blocks: Vec::with_capacity(count),
        };
        for part in parts {
            let before = all.corners.len() as u32;
            all.corners.extend(part.corners);
            all.blocks
                .extend(part.blocks.into_iter().map(|block| CornerSlots {
                    first: before + block.first,
                    ..block
                }));
        }
        all
    }

    /// Appends a block of triangles.
    fn push(&mut self, mesh: &TriangleMesh, triangles: &[u32], empty: EmptyLanes) {
        let first = self.corners.len();
        let mut vertices: Vec<u32> = Vec::with_capacity(3 * BLOCK_SIZE);
        let mut corners = [[0; BLOCK_SIZE]; 3];
        for (lane, &triangle) in triangles.iter().enumerate() {
            for (k, vertex) in mesh.triangles()[triangle as usize].into_iter().enumerate() {
                let known = vertices.iter().position(|&v| v == vertex);
                corners[k][lane] = known.unwrap_or_else(|| {
                    vertices.push(vertex);
                    self.corners.push(mesh.positions()[vertex as usize]);
                    vertices.len() - 1
                }) as u8;
            }
        }
        if triangles.len() < BLOCK_SIZE {
            let nothing = vertices.len() as u8;
            for picks in &mut corners {
                let pick = match empty {
                    EmptyLanes::Nothing => nothing,
                    EmptyLanes::First => picks[0],
                };
                picks[triangles.len()..].fill(pick);
            }
            if empty == EmptyLanes::Nothing {
                self.corners.push(Vec3::NAN);
            }
        }
        self.blocks.push(CornerSlots {
            first: first as u32,
            corners,
        });
    }

    /// The corners of the triangle in a lane of a block.
    #[inline(always)]
    pub fn corners(&self, block: usize, lane: usize) -> [Vec3; 3] {
        let picks = &self.blocks[block];
        let corner =
            |k: usize| self.corners[picks.first as usize + usize::from(picks.corners[k][lane])];
        [corner(0), corner(1), corner(2)]
    }

    /// Prefetches a block.
    #[inline(always)]
    pub fn announce<S: Simd>(&self, token: S, block: usize) {
        /// A block of a closed mesh has about as many corners as triangles.
        const USUAL: usize = (BLOCK_SIZE + 2) * size_of::<Vec3>();
        let first = self.blocks[block].first as usize;
        prefetch(token, &self.corners, first, USUAL);
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.corners[..]) + size_of_val(&self.blocks[..])
    }
}
