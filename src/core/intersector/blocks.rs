//! The primitives of the tree's blocks in a kernel's packed layout, one primitive per lane.

use crate::aabb::Planes;
use crate::bvh::{BLOCK_SIZE, Bvh, LentStack, NO_PRIMITIVE, SlabRay, Visitor};
use crate::kernel::{Kernel, MAX_VALUES, RayLanes};
use crate::lane::{LaneMask, Number, Stored, Values};
use crate::ray::Ray;
use crate::shape::{BLOCKS_AT_ONCE, CompactBlocks, EmptyLanes, Primitives, Shape};
use crate::simd::{baseline, prefetch};
use fearless_simd::{Simd, SimdBase, f32x8, f32x16};
use rayon::prelude::*;
use std::marker::PhantomData;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Storage of primitives for tracing. The results are the same, bit for bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Packing {
    /// In the kernel's layout: the fastest.
    #[default]
    Full,
    /// In the least memory.
    Compact,
}

/// One value of each primitive in a block. Aligned so that no row of f32 spans two cache lines.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
pub(super) struct Row<T>([T; BLOCK_SIZE]);

/// The tree and the kernel's packed values of its primitives.
pub(super) struct Blocks<S: Shape, T> {
    pub bvh: Arc<Bvh>,
    /// A fixed number of rows per block; empty if primitives are stored instead.
    rows: Vec<Row<T>>,
    /// Primitives from which rows are packed on demand.
    compact: Option<S::Compact>,
}

/// Buffer for rows packed on demand. Reused for many rays: zeroing it takes as long as a test.
pub(super) struct Scratch<T>([Row<T>; MAX_VALUES]);

impl<T: Copy + Default> Scratch<T> {
    #[inline(always)]
    pub fn new() -> Self {
        Self([Row([T::default(); BLOCK_SIZE]); MAX_VALUES])
    }

    /// The rows.
    #[inline(always)]
    pub fn rows(&mut self) -> &mut [Row<T>] {
        &mut self.0
    }
}

/// Packs the primitives of a block.
fn fill<S: Shape, T: Copy + Default>(
    rows: &mut [Row<T>],
    compact: &S::Compact,
    block: usize,
    pack: impl Fn(&S, &mut [T]),
) {
    let mut one = [T::default(); MAX_VALUES];
    for lane in 0..BLOCK_SIZE {
        pack(&compact.primitive(block, lane), &mut one[..rows.len()]);
        for (row, value) in rows.iter_mut().zip(one) {
            row.0[lane] = value;
        }
    }
}

/// The values of one lane of a block, broadcast to all lanes of a vector.
pub(super) struct LaneValues<'a, T, S> {
    token: S,
    rows: &'a [Row<T>],
    lane: usize,
}

/// The values of a block as vectors of `N`.
pub(super) struct BlockValues<'a, N, S, T> {
    token: S,
    rows: &'a [Row<T>],
    number: PhantomData<N>,
}

impl<'a, N: Number, S: Simd, T: Stored<N>> BlockValues<'a, N, S, T> {
    #[inline(always)]
    pub fn new(token: S, rows: &'a [Row<T>]) -> Self {
        Self {
            token,
            rows,
            number: PhantomData,
        }
    }
}

impl<N: Number, S: Simd, T: Stored<N>> Values<N::Lanes<S>> for BlockValues<'_, N, S, T> {
    #[inline(always)]
    fn value(&self, index: usize) -> N::Lanes<S> {
        T::lanes(self.token, &self.rows[index].0)
    }
}

impl<'a, T: Stored<f32>, S: Simd> LaneValues<'a, T, S> {
    /// The values of a lane, which must be below [`BLOCK_SIZE`].
    #[inline(always)]
    pub fn new(token: S, rows: &'a [Row<T>], lane: usize) -> Self {
        Self { token, rows, lane }
    }
}

impl<T: Stored<f32>, S: Simd> Values<f32x16<S>> for LaneValues<'_, T, S> {
    #[inline(always)]
    fn value(&self, index: usize) -> f32x16<S> {
        let value = self.rows[index].0[self.lane % BLOCK_SIZE];
        SimdBase::splat(self.token, value.number())
    }
}

/// The values of one lane of a block.
pub(super) struct LaneOf<'a, T> {
    pub rows: &'a [Row<T>],
    pub lane: usize,
}

impl<T: Stored<f32>> Values<f32> for LaneOf<'_, T> {
    #[inline(always)]
    fn value(&self, index: usize) -> f32 {
        self.rows[index].0[self.lane % BLOCK_SIZE].number()
    }
}

impl<S: Shape, T: Copy + Default + Send + Sync> Blocks<S, T> {
    /// Packs the primitives of all blocks. `pack` writes `rows_per_block` values per primitive; those of
    /// [`Shape::nowhere`] must be a miss for the kernel.
    pub fn new(
        primitives: &dyn Primitives<S>,
        bvh: Arc<Bvh>,
        packing: Packing,
        rows_per_block: usize,
        empty: EmptyLanes,
        pack: fn(&S, &mut [T]),
    ) -> Self {
        let (rows, compact) = match packing {
            Packing::Full => (rows_of(primitives, &bvh, rows_per_block, empty, pack), None),
            Packing::Compact => (Vec::new(), Some(S::Compact::of(primitives, &bvh, empty))),
        };
        Self { bvh, rows, compact }
    }

    /// Whether rows are packed on demand.
    pub fn are_compact(&self) -> bool {
        self.compact.is_some()
    }

    /// The primitives, if rows are packed on demand.
    pub fn compact(&self) -> Option<&S::Compact> {
        self.compact.as_ref()
    }

    /// The packed rows of a block, if rows aren't packed on demand.
    #[inline(always)]
    pub fn packed(&self, block: usize, count: usize) -> &[Row<T>] {
        &self.rows[block * count..][..count]
    }

    /// The rows of a block; `count` is their number, known at compile time. If `MAYBE_COMPACT` is
    /// false, the check for compact packing is omitted, which slows a walk by 2 to 5 % (bunny, 2026-11).
    #[inline(always)]
    pub fn rows<'a, const MAYBE_COMPACT: bool>(
        &'a self,
        block: usize,
        count: usize,
        scratch: &'a mut [Row<T>],
        pack: impl Fn(&S, &mut [T]),
    ) -> &'a [Row<T>] {
        match &self.compact {
            Some(compact) if MAYBE_COMPACT => {
                let rows = &mut scratch[..count];
                fill::<S, T>(rows, compact, block, pack);
                rows
            }
            _ => self.packed(block, count),
        }
    }

    /// Prefetches a block and its primitives.
    #[inline(always)]
    pub fn announce<const MAYBE_COMPACT: bool, I: Simd>(
        &self,
        token: I,
        block: usize,
        count: usize,
    ) {
        self.bvh.announce_lanes(token, block);
        match &self.compact {
            Some(compact) if MAYBE_COMPACT => compact.announce(token, block),
            _ => {
                let bytes = count * size_of::<Row<T>>();
                prefetch(token, &self.rows, block * count, bytes);
            }
        }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.rows[..]) + self.compact.as_ref().map_or(0, CompactBlocks::bytes)
    }
}

/// The box around each of a block's primitives, as the kernel `K` computes them.
#[inline(always)]
pub(super) fn boxes<K: Kernel, N: Number, S: Simd>(
    token: S,
    rows: &[Row<K::Stored<N>>],
) -> Planes<[f32; BLOCK_SIZE]> {
    let values = BlockValues::<f32, S, K::Stored<N>>::new(token, rows);
    stored(K::bounds::<N, f32x8<S>>(&values))
}

/// The boxes in memory.
#[inline(always)]
pub(super) fn stored<S: Simd>([a, b, c, d, e, f]: Planes<f32x8<S>>) -> Planes<[f32; BLOCK_SIZE]> {
    [
        a.to_array(),
        b.to_array(),
        c.to_array(),
        d.to_array(),
        e.to_array(),
        f.to_array(),
    ]
}

/// A bit per lane of a block whose primitive the ray's line may meet; see [`Shape::may_meet`]. The rows begin with the
/// primitives' parameters.
#[inline(always)]
pub(super) fn may_meet<P: Shape, T: Stored<f32>, S: Simd>(
    token: S,
    rows: &[Row<T>],
    ray: &Ray,
) -> u32 {
    let values = BlockValues::<f32, S, T>::new(token, rows);
    let RayLanes { origin, dir, .. } = RayLanes::<f32x8<S>>::of(token, ray);
    P::may_meet([&origin, &dir], &values).map_or(u32::MAX, LaneMask::bits)
}

/// Packs the rows of all blocks.
fn rows_of<S: Shape, T: Copy + Default + Send + Sync>(
    primitives: &dyn Primitives<S>,
    bvh: &Bvh,
    rows_per_block: usize,
    empty: EmptyLanes,
    pack: fn(&S, &mut [T]),
) -> Vec<Row<T>> {
    let mut rows = vec![Row([T::default(); BLOCK_SIZE]); bvh.block_count() * rows_per_block];
    fill_blocks(&mut rows, rows_per_block, &|block, rows| {
        let indices = bvh.block(block);
        let mut one = [T::default(); MAX_VALUES];
        for lane in 0..BLOCK_SIZE {
            let primitive = match (indices.get(lane), empty) {
                (Some(&index), _) => primitives.primitive(index),
                (None, EmptyLanes::First) => primitives.primitive(indices[0]),
                (None, EmptyLanes::Nowhere) => S::nowhere(),
            };
            pack(&primitive, &mut one[..rows.len()]);
            for (value, row) in one.iter().zip(&mut *rows) {
                row.0[lane] = *value;
            }
        }
    });
    rows
}

/// Fills the rows of all blocks by several threads.
// Compiled once per type of value, not per kernel.
fn fill_blocks<T: Send>(
    rows: &mut [Row<T>],
    rows_per_block: usize,
    fill: &(dyn Fn(usize, &mut [Row<T>]) + Sync),
) {
    let chunks = rows.par_chunks_mut(rows_per_block * BLOCKS_AT_ONCE);
    chunks.enumerate().for_each(|(chunk, rows)| {
        for (index, rows) in rows.chunks_exact_mut(rows_per_block).enumerate() {
            fill(chunk * BLOCKS_AT_ONCE + index, rows);
        }
    });
}

/// The primitives in all blocks that the ray meets.
pub(crate) fn candidates(bvh: &Bvh, ray: &Ray) -> Vec<u32> {
    struct Gathered<'a> {
        bvh: &'a Bvh,
        t_max: f32,
        found: Vec<u32>,
    }
    impl<S: Simd> Visitor<S> for Gathered<'_> {
        const IS_BEHIND: bool = true;
        const NEEDS_BOX_TEST: bool = true;
        fn visit(&mut self, block: usize, _: &SlabRay<S>) -> ControlFlow<(), f32> {
            self.found.extend_from_slice(self.bvh.block(block));
            ControlFlow::Continue(self.t_max)
        }
        fn announce(&self, _: usize) {}
        fn open(&mut self, _: usize) {}
    }
    let mut gathered = Gathered {
        bvh,
        t_max: ray.t_max,
        found: Vec::new(),
    };
    bvh.walk(baseline(), ray, LentStack::new().get(), &mut gathered);
    gathered.found
}

/// Whether a lane holds a primitive that the ray doesn't exclude.
#[inline(always)]
pub(super) fn can_be_hit(primitive: u32, exclude: Option<u32>) -> bool {
    primitive != NO_PRIMITIVE && Some(primitive) != exclude
}
