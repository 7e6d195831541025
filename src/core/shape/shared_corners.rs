//! Compact storage of triangles in half the memory: each block's corners once, and indices of its triangles
//! into them.

use super::compact::{BLOCKS_AT_ONCE, CompactBlocks, EmptyLanes};
use super::{Primitives, Triangle};
use crate::bvh::{BLOCK_SIZE, Bvh};
use crate::simd::prefetch;
use fearless_simd::Simd;
use glam::Vec3;
use rayon::prelude::*;

/// A block's triangles: per lane, the indices of A, B and C among the block's corners.
struct CornerSlots {
    first: u32,
    corners: [[u8; BLOCK_SIZE]; 3],
}

/// See the [module](self).
pub struct SharedCorners {
    corners: Vec<Vec3>,
    blocks: Vec<CornerSlots>,
}

impl CompactBlocks<Triangle> for SharedCorners {
    fn of(mesh: &dyn Primitives<Triangle>, bvh: &Bvh, empty: EmptyLanes) -> Self {
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

    #[inline(always)]
    fn primitive(&self, block: usize, lane: usize) -> Triangle {
        let picks = &self.blocks[block];
        let corner =
            |k: usize| self.corners[picks.first as usize + usize::from(picks.corners[k][lane])];
        Triangle([corner(0), corner(1), corner(2)])
    }

    #[inline(always)]
    fn announce<S: Simd>(&self, token: S, block: usize) {
        /// A block of a closed mesh has about as many corners as triangles.
        const USUAL: usize = (BLOCK_SIZE + 2) * size_of::<Vec3>();
        let first = self.blocks[block].first as usize;
        prefetch(token, &self.corners, first, USUAL);
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.corners[..]) + size_of_val(&self.blocks[..])
    }
}

impl SharedCorners {
    /// Appends a block of triangles.
    fn push(&mut self, mesh: &dyn Primitives<Triangle>, triangles: &[u32], empty: EmptyLanes) {
        let first = self.corners.len();
        let mut corners = [[0; BLOCK_SIZE]; 3];
        for (lane, &triangle) in triangles.iter().enumerate() {
            for (k, corner) in mesh.primitive(triangle).0.into_iter().enumerate() {
                // Bits, because −0 equals 0.
                let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
                let mut known = self.corners[first..].iter();
                let known = known.position(|p| bits(p) == bits(&corner));
                corners[k][lane] = known.unwrap_or_else(|| {
                    self.corners.push(corner);
                    self.corners.len() - 1 - first
                }) as u8;
            }
        }
        if triangles.len() < BLOCK_SIZE {
            let nothing = (self.corners.len() - first) as u8;
            for picks in &mut corners {
                let pick = match empty {
                    EmptyLanes::Nowhere => nothing,
                    EmptyLanes::First => picks[0],
                };
                picks[triangles.len()..].fill(pick);
            }
            if empty == EmptyLanes::Nowhere {
                self.corners.push(Vec3::NAN);
            }
        }
        self.blocks.push(CornerSlots {
            first: first as u32,
            corners,
        });
    }
}
