//! The triangles of each leaf as a kernel keeps them, one a lane.

use crate::bvh::{Bvh, LEAF_SIZE};
use crate::kernel::Values;
use crate::lane::{Number, Stored};
use crate::mesh::TriangleMesh;
use crate::ray::Ray;
use fearless_simd::Simd;
use glam::Vec3;
use std::marker::PhantomData;
use std::ops::ControlFlow;
use std::sync::Arc;

/// A block for each leaf of the tree, and the tree.
pub(super) struct Blocks<T> {
    pub bvh: Arc<Bvh>,
    /// So many values a block, each for all lanes.
    values: Vec<[T; LEAF_SIZE]>,
    values_per_block: usize,
    leaves: Vec<Leaf>,
}

/// Which triangles are in a block.
#[derive(Clone, Copy)]
pub(super) struct Leaf {
    pub primitives: [u32; LEAF_SIZE],
    pub count: u32,
}

/// A block's values as vectors of `N`.
pub(super) struct BlockValues<'a, N, S, T> {
    token: S,
    values: &'a [[T; LEAF_SIZE]],
    number: PhantomData<N>,
}

impl<N: Number, S: Simd, T: Stored<N>> Values<N::Lanes<S>> for BlockValues<'_, N, S, T> {
    #[inline(always)]
    fn value(&self, index: usize) -> N::Lanes<S> {
        T::lanes(self.token, &self.values[index])
    }
}

impl<T: Copy + Default> Blocks<T> {
    /// `pack` makes so many values of a triangle; lanes without one hold `empty`, or the leaf's first
    /// triangle again.
    pub fn new(
        mesh: &TriangleMesh,
        bvh: Arc<Bvh>,
        values_per_block: usize,
        empty: Option<T>,
        pack: impl Fn([Vec3; 3], &mut [T]),
    ) -> Self {
        let leaf_count = bvh.leaf_count();
        let mut values = vec![[T::default(); LEAF_SIZE]; leaf_count * values_per_block];
        let mut one = vec![T::default(); values_per_block];
        let mut leaves = Vec::with_capacity(leaf_count);
        for (index, block) in values.chunks_exact_mut(values_per_block).enumerate() {
            let in_leaf = bvh.leaf(index);
            let mut leaf = Leaf {
                primitives: [0; LEAF_SIZE],
                count: in_leaf.len() as u32,
            };
            for (lane, &primitive) in in_leaf.iter().enumerate() {
                leaf.primitives[lane] = primitive;
                pack(mesh.corners(primitive), &mut one);
                for (value, kept) in one.iter().zip(&mut *block) {
                    if lane == 0 {
                        *kept = [empty.unwrap_or(*value); LEAF_SIZE];
                    }
                    kept[lane] = *value;
                }
            }
            leaves.push(leaf);
        }
        Self {
            bvh,
            values,
            values_per_block,
            leaves,
        }
    }

    #[inline(always)]
    pub fn leaf(&self, index: usize) -> &Leaf {
        &self.leaves[index]
    }

    /// The values of a block; `count` is their number, known to the compiler.
    #[inline(always)]
    pub fn values<N, S: Simd>(
        &self,
        token: S,
        index: usize,
        count: usize,
    ) -> BlockValues<'_, N, S, T> {
        debug_assert_eq!(count, self.values_per_block);
        BlockValues {
            token,
            values: &self.values[index * count..][..count],
            number: PhantomData,
        }
    }

    /// One value of one lane.
    #[inline(always)]
    pub fn value(&self, index: usize, lane: usize, value: usize) -> T {
        self.values[index * self.values_per_block + value][lane]
    }

    pub fn candidates(&self, ray: &Ray) -> Vec<u32> {
        let mut found = Vec::new();
        let visit = |leaf: usize| {
            found.extend_from_slice(self.bvh.leaf(leaf));
            ControlFlow::Continue(ray.t_max)
        };
        self.bvh.traverse(ray, visit, || ());
        found
    }

    /// How many blocks there are.
    pub fn len(&self) -> usize {
        self.leaves.len()
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..]) + size_of_val(&self.leaves[..])
    }
}
