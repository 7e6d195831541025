//! Binary tree built by the surface-area heuristic, before it is collapsed.

use super::forest::{Decision, ForestCosts};
use super::split::Splitter;
use super::{BLOCK_SIZE, Build, Item, Range, WIDTH};
use crate::aabb::Aabb;
use crate::progress::Cancelled;

/// Ranges with fewer primitives are built without a check for cancellation.
const CANCELLABLE_FROM: usize = 1024;

/// A binary tree over a run of primitives.
pub(super) struct BinaryTree {
    pub bounds: Aabb,
    /// The run's first primitive, as an index of the items.
    first: u32,
    count: u32,
    /// `None` for a leaf: a run of at most one block.
    inner: Option<Box<Inner>>,
}

struct Inner {
    decision: Decision,
    children: [BinaryTree; 2],
}

impl BinaryTree {
    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// The tree's primitives.
    pub fn items<'a>(&self, items: &'a [Item]) -> &'a [Item] {
        &items[self.first as usize..][..self.count()]
    }

    /// Splits the tree into the subtrees that become its node's children. Returns the tree itself if it becomes a leaf.
    pub fn into_node_children(self) -> Result<Vec<Self>, Self> {
        let is_node = |inner: &Inner| !inner.decision.is_leaf();
        if !self.inner.as_deref().is_some_and(is_node) {
            return Err(self);
        }
        let mut children = Vec::with_capacity(WIDTH);
        self.push_forest(WIDTH, &mut children);
        Ok(children)
    }

    /// Appends the subtrees, at most `most`, that replace this one.
    fn push_forest(mut self, most: usize, trees: &mut Vec<Self>) {
        let distribution = |inner: &Inner| inner.decision.distribution(most);
        match (
            self.inner.as_deref().and_then(distribution),
            self.inner.take(),
        ) {
            (Some([of_first, of_second]), Some(inner)) => {
                let [first, second] = inner.children;
                first.push_forest(of_first, trees);
                second.push_forest(of_second, trees);
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
    ) -> Result<(BinaryTree, ForestCosts), Cancelled> {
        let count = range.items.len();
        // Neither 0 nor NaN, so that few nodes cost less than many even where boxes have no area.
        let half_area = (self.build.scale.half_area(range.bounds)).max(f32::MIN_POSITIVE);
        let mut tree = BinaryTree {
            bounds: range.bounds.into(),
            first: first as u32,
            count: count as u32,
            inner: None,
        };
        if count <= BLOCK_SIZE {
            let costs = ForestCosts::of_leaf(half_area, tree.count);
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
        let (costs, decision) = ForestCosts::of_inner(half_area, tree.count, [&of_a, &of_b]);
        tree.inner = Some(Box::new(Inner {
            decision,
            children: [a, b],
        }));
        Ok((tree, costs))
    }
}
