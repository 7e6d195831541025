//! The binary tree that nodes are made of, by the surface-area heuristic.

use super::collapse::{Choice, Costs};
use super::split::Splitter;
use super::{BLOCK_SIZE, Build, Item, Range, WIDTH};
use crate::aabb::Aabb;
use crate::progress::Cancelled;

/// Ranges with fewer primitives are built without a check for cancellation.
const CANCELLABLE_FROM: usize = 1024;

/// A binary tree over a run of primitives.
pub(super) struct Tree {
    pub bounds: Aabb,
    /// The run's first primitive, as an index of the items.
    first: u32,
    count: u32,
    /// Of a run that needs more than one block.
    inner: Option<Box<Inner>>,
}

struct Inner {
    choice: Choice,
    halves: [Tree; 2],
}

impl Tree {
    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// The tree's primitives.
    pub fn items<'a>(&self, items: &'a [Item]) -> &'a [Item] {
        &items[self.first as usize..][..self.count()]
    }

    /// Half the surface of the box.
    fn half_area(&self) -> f64 {
        let e = self.bounds.max.as_dvec3() - self.bounds.min.as_dvec3();
        e.x * (e.y + e.z) + e.y * e.z
    }

    /// Takes the tree apart into those that the children of its node are made of, the largest last. Returns it if it
    /// becomes a leaf.
    pub fn into_children(self) -> Result<Vec<Self>, Self> {
        let is_node = |inner: &Inner| !inner.choice.is_leaf();
        if !self.inner.as_deref().is_some_and(is_node) {
            return Err(self);
        }
        let mut children = Vec::with_capacity(WIDTH);
        self.replace(WIDTH, &mut children);
        children.sort_by(|a, b| a.half_area().total_cmp(&b.half_area()));
        Ok(children)
    }

    /// Adds the trees, at most `most`, that replace this one.
    fn replace(mut self, most: usize, trees: &mut Vec<Self>) {
        let shares = |inner: &Inner| inner.choice.shares(most);
        match (self.inner.as_deref().and_then(shares), self.inner.take()) {
            (Some([of_first, of_second]), Some(inner)) => {
                let [first, second] = inner.halves;
                first.replace(of_first, trees);
                second.replace(of_second, trees);
            }
            (_, inner) => trees.push(Self { inner, ..self }),
        }
    }
}

/// Builds a binary tree.
pub(super) struct Builder<'k> {
    splitter: Splitter,
    build: Build<'k>,
    levels: usize,
}

impl<'k> Builder<'k> {
    /// A builder of trees of at most `levels` levels.
    pub fn new(build: Build<'k>, levels: usize) -> Self {
        Self {
            splitter: Splitter::new(build.scale),
            build,
            levels,
        }
    }

    /// Builds the tree over a range that begins at item `first`; returns it with the costs of collapsing it.
    pub fn tree(
        &mut self,
        range: Range,
        first: usize,
        depth: usize,
    ) -> Result<(Tree, Costs), Cancelled> {
        let count = range.items.len();
        let half_area = self.build.scale.half_area(range.bounds);
        let mut tree = Tree {
            bounds: range.bounds.into(),
            first: first as u32,
            count: count as u32,
            inner: None,
        };
        if count <= BLOCK_SIZE {
            let costs = Costs::of_leaf(half_area, tree.count);
            return Ok((tree, costs));
        }
        if count >= CANCELLABLE_FROM {
            (self.build.keep_going)()?;
        }
        // Halving by index keeps depth + log₂(count) within the limit for any input.
        let [a, b] = if depth + count.ilog2() as usize + 2 > self.levels {
            self.splitter.halve(range)
        } else {
            self.splitter.split(range)
        };
        let (middle, depth) = (first + a.items.len(), depth + 1);
        let (a, b) = if count > self.build.job_size {
            let (build, levels) = (self.build, self.levels);
            rayon::join(
                || Self::new(build, levels).tree(a, first, depth),
                || Self::new(build, levels).tree(b, middle, depth),
            )
        } else {
            (self.tree(a, first, depth), self.tree(b, middle, depth))
        };
        let ((a, of_a), (b, of_b)) = (a?, b?);
        let (costs, choice) = Costs::of_inner(half_area, tree.count, [&of_a, &of_b]);
        let halves = [a, b];
        tree.inner = Some(Box::new(Inner { choice, halves }));
        Ok((tree, costs))
    }
}
