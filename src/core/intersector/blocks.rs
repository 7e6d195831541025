//! The triangles of each block of the tree as a kernel keeps them, one a lane.

use crate::aabb::Planes;
use crate::bvh::{BLOCK_SIZE, Bvh, NO_PRIMITIVE, SlabRay, Visitor, with_stack};
use crate::kernel::{Kernel, Values};
use crate::lane::{Number, Stored};
use crate::mesh::TriangleMesh;
use crate::ray::Ray;
use crate::simd::{baseline, prefetch};
use fearless_simd::{Simd, SimdBase, f32x8, f32x16};
use glam::Vec3;
use rayon::prelude::*;
use std::marker::PhantomData;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Blocks that a thread packs at a time.
const BLOCKS_AT_ONCE: usize = 1024;

/// A value of the triangles in a block. Aligned, so that no row of f32 lies in two cache lines.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct Row<T>([T; BLOCK_SIZE]);

/// What a kernel keeps of the tree's triangles, and the tree.
pub(super) struct Blocks<T> {
    pub bvh: Arc<Bvh>,
    /// So many rows a block.
    rows: Vec<Row<T>>,
    rows_per_block: usize,
}

/// A block's values of one lane, in every lane of a vector.
pub(super) struct LaneValues<'a, T, S> {
    token: S,
    one: OneLane<'a, T>,
}

/// A block's values as vectors of `N`.
pub(super) struct BlockValues<'a, N, S, T> {
    token: S,
    rows: &'a [Row<T>],
    number: PhantomData<N>,
}

impl<N: Number, S: Simd, T: Stored<N>> Values<N::Lanes<S>> for BlockValues<'_, N, S, T> {
    #[inline(always)]
    fn value(&self, index: usize) -> N::Lanes<S> {
        T::lanes(self.token, &self.rows[index].0)
    }
}

impl<T: Stored<f32>, S: Simd> Values<f32x16<S>> for LaneValues<'_, T, S> {
    #[inline(always)]
    fn value(&self, index: usize) -> f32x16<S> {
        SimdBase::splat(self.token, self.one.value(index).number())
    }
}

/// The values of one lane.
pub(super) struct OneLane<'a, T> {
    rows: &'a [Row<T>],
    lane: usize,
}

impl<T: Copy> OneLane<'_, T> {
    #[inline(always)]
    fn value(&self, index: usize) -> T {
        self.rows[index].0[self.lane % BLOCK_SIZE]
    }
}

impl OneLane<'_, f32> {
    /// Three in a row.
    #[inline(always)]
    pub fn vector(&self, first: usize) -> Vec3 {
        let [x, y, z] = [first, first + 1, first + 2];
        Vec3::new(self.value(x), self.value(y), self.value(z))
    }
}

impl<T: Copy + Default + Send + Sync> Blocks<T> {
    /// `pack` makes so many values of a triangle; lanes without one hold `empty`, or the block's first
    /// triangle again.
    pub fn new(
        mesh: &TriangleMesh,
        bvh: Arc<Bvh>,
        rows_per_block: usize,
        empty: Option<T>,
        pack: impl Fn([Vec3; 3], &mut [T]) + Sync,
    ) -> Self {
        let mut rows = vec![Row([T::default(); BLOCK_SIZE]); bvh.block_count() * rows_per_block];
        let pack_block = |block: usize, rows: &mut [Row<T>], one: &mut [T]| {
            for (lane, &primitive) in bvh.block(block).iter().enumerate() {
                pack(mesh.corners(primitive), one);
                for (value, row) in one.iter().zip(&mut *rows) {
                    if lane == 0 {
                        row.0 = [empty.unwrap_or(*value); BLOCK_SIZE];
                    }
                    row.0[lane] = *value;
                }
            }
        };
        let chunks = rows.par_chunks_mut(rows_per_block * BLOCKS_AT_ONCE);
        chunks.enumerate().for_each(|(chunk, rows)| {
            let mut one = vec![T::default(); rows_per_block];
            for (index, rows) in rows.chunks_exact_mut(rows_per_block).enumerate() {
                pack_block(chunk * BLOCKS_AT_ONCE + index, rows, &mut one);
            }
        });
        Self {
            bvh,
            rows,
            rows_per_block,
        }
    }

    /// The values of a block; `count` is their number, known to the compiler.
    #[inline(always)]
    pub fn values<N, S: Simd>(
        &self,
        token: S,
        block: usize,
        count: usize,
    ) -> BlockValues<'_, N, S, T> {
        debug_assert_eq!(count, self.rows_per_block);
        BlockValues {
            token,
            rows: &self.rows[block * count..][..count],
            number: PhantomData,
        }
    }

    /// The values of one lane of a block, below [`BLOCK_SIZE`].
    #[inline(always)]
    pub fn lane_values<S: Simd>(
        &self,
        token: S,
        block: usize,
        count: usize,
        lane: usize,
    ) -> LaneValues<'_, T, S> {
        LaneValues {
            token,
            one: self.lane(block, lane, count),
        }
    }

    /// The box around each of a block's triangles, as the kernel `K` takes their corners to be.
    #[inline(always)]
    pub fn boxes<K: Kernel<Stored<N> = T>, N: Number, S: Simd>(
        &self,
        token: S,
        block: usize,
    ) -> Planes<[f32; BLOCK_SIZE]>
    where
        T: Stored<f32>,
    {
        let values = self.values::<f32, S>(token, block, K::VALUES);
        let [a, b, c, d, e, f] = K::bounds::<N, f32x8<S>>(&values);
        [
            a.to_array(),
            b.to_array(),
            c.to_array(),
            d.to_array(),
            e.to_array(),
            f.to_array(),
        ]
    }

    /// Asks the cache for a block and its primitives.
    #[inline(always)]
    pub fn announce<S: Simd>(&self, token: S, block: usize, count: usize) {
        self.bvh.announce_lanes(token, block);
        prefetch(
            token,
            &self.rows,
            block * count,
            count * size_of::<Row<T>>(),
        );
    }

    /// A lane's values, to be looked at one by one; `count` is their number, known to the compiler.
    #[inline(always)]
    pub fn lane(&self, block: usize, lane: usize, count: usize) -> OneLane<'_, T> {
        OneLane {
            rows: &self.rows[block * count..][..count],
            lane,
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.rows[..])
    }
}

/// The primitives in all blocks that the ray meets.
pub(super) fn candidates(bvh: &Bvh, ray: &Ray) -> Vec<u32> {
    struct Gathered<'a> {
        bvh: &'a Bvh,
        t_max: f32,
        found: Vec<u32>,
    }
    impl<S: Simd> Visitor<S> for Gathered<'_> {
        const IS_ORDERED: bool = false;
        const IS_BEHIND: bool = true;
        fn visit(&mut self, block: usize, _: &SlabRay<S>) -> ControlFlow<(), f32> {
            self.found.extend_from_slice(self.bvh.block(block));
            ControlFlow::Continue(self.t_max)
        }
        fn announce(&self, _: usize) {}
        fn count_boxes(&mut self, _: u32) {}
    }
    let mut gathered = Gathered {
        bvh,
        t_max: ray.t_max,
        found: Vec::new(),
    };
    with_stack(|stack| bvh.walk(baseline(), ray, stack, &mut gathered));
    gathered.found
}

/// Whether a lane holds a triangle that the ray may hit.
#[inline(always)]
pub(super) fn is_asked(primitive: u32, exclude: Option<u32>) -> bool {
    primitive != NO_PRIMITIVE && Some(primitive) != exclude
}
