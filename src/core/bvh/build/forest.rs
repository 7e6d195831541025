//! Cost of the forests that may replace a binary subtree when nodes with eight children are made of it.
//!
//! Source: H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
//!   HPG 2017 (dynamic programming over binary nodes and the sizes of forests). Differs from it: the cost of a leaf counts
//!   blocks, and a node counts as much as a block. Counting it as two thirds of a block made no workload faster.
//!
//! Splitting the child of largest area until there are eight gave the bunny (69 k triangles) 3434 nodes; this gives 1634.
//! Rays take 5 to 10 % less time, packets 1 to 3 % (`hitscope bench`, 1 thread, AMD Zen 4, 2026-11).

use super::split::blocks;
use super::{BLOCK_SIZE, LEAF_BLOCKS, WIDTH};

/// The most trees that may replace one of two children, as the other needs at least one.
const MAX_FOREST: usize = WIDTH - 1;

/// The least cost of forests of at most 1, 2, …, [`MAX_FOREST`] trees that replace a binary subtree. Each tree is a
/// leaf or a node with eight children. Costs are in blocks times area.
#[derive(Clone, Copy)]
pub(super) struct ForestCosts([f32; MAX_FOREST]);

/// How an inner binary node is replaced by the cheapest forests.
#[derive(Clone, Copy)]
pub(super) struct Decision {
    /// Whether a forest of one tree is a leaf rather than a node.
    is_leaf: bool,
    /// Entry k: how many of at most k + 2 trees replace the first child; the others replace the second. 0 if fewer trees
    /// cost no more. The last entry holds for the node's own children and is never 0.
    of_first: [u8; MAX_FOREST],
}

fn leaf_cost(half_area: f32, count: u32) -> f32 {
    half_area * blocks(count)
}

impl ForestCosts {
    /// The costs of a binary leaf.
    pub fn of_leaf(half_area: f32, count: u32) -> Self {
        Self([leaf_cost(half_area, count); MAX_FOREST])
    }

    /// The costs of an inner binary node with `count` primitives, given those of its children.
    pub fn of_inner(half_area: f32, count: u32, children: [&Self; 2]) -> (Self, Decision) {
        let (of_children, of_first) = Self::cheapest(children, WIDTH);
        let node = half_area + of_children;
        let mut decision = Decision {
            is_leaf: false,
            of_first: [0; MAX_FOREST],
        };
        decision.of_first[WIDTH - 2] = of_first;
        let mut costs = [node; MAX_FOREST];
        if count as usize <= LEAF_BLOCKS * BLOCK_SIZE {
            let leaf = leaf_cost(half_area, count);
            decision.is_leaf = leaf <= node;
            costs[0] = leaf.min(node);
        }
        for most in 2..=MAX_FOREST {
            let (cost, of_first) = Self::cheapest(children, most);
            costs[most - 1] = costs[most - 2];
            if cost < costs[most - 2] {
                costs[most - 1] = cost;
                decision.of_first[most - 2] = of_first;
            }
        }
        (Self(costs), decision)
    }

    /// The cheapest way to replace two children by at most `most` trees: its cost, and the number of trees for the first.
    fn cheapest([first, second]: [&Self; 2], most: usize) -> (f32, u8) {
        let mut best = (f32::INFINITY, 1);
        for of_first in most.saturating_sub(MAX_FOREST).max(1)..=MAX_FOREST.min(most - 1) {
            let cost = first.0[of_first - 1] + second.0[most - of_first - 1];
            if cost < best.0 {
                best = (cost, of_first as u8);
            }
        }
        best
    }
}

impl Decision {
    /// Whether the node becomes a leaf if one tree replaces it.
    pub fn is_leaf(&self) -> bool {
        self.is_leaf
    }

    /// How many of at most `most` trees replace each child; `None` if one tree replaces the node.
    pub fn distribution(&self, most: usize) -> Option<[usize; 2]> {
        let most = (2..=most).rev().find(|most| self.of_first[most - 2] != 0)?;
        let of_first = usize::from(self.of_first[most - 2]);
        Some([of_first, most - of_first])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// A binary tree with the area of each node and the number of primitives in each leaf.
    enum Binary {
        Leaf(f32, u32),
        Inner(f32, Box<[Binary; 2]>),
    }

    impl Binary {
        /// Areas are whole numbers, so that sums of costs are exact.
        fn random(leaves: usize, areas: usize, random: &mut Random) -> Self {
            let area = random.index(areas) as f32;
            if leaves == 1 {
                return Self::Leaf(area, 1 + random.index(BLOCK_SIZE) as u32);
            }
            let first = 1 + random.index(leaves - 1);
            let children =
                [first, leaves - first].map(|leaves| Self::random(leaves, areas, random));
            Self::Inner(area, Box::new(children))
        }

        fn count(&self) -> u32 {
            match self {
                Self::Leaf(_, count) => *count,
                Self::Inner(_, children) => children.iter().map(Self::count).sum(),
            }
        }

        fn costs(&self) -> (ForestCosts, Option<Decision>) {
            match self {
                Self::Leaf(area, count) => (ForestCosts::of_leaf(*area, *count), None),
                Self::Inner(area, children) => {
                    let [first, second] = [children[0].costs().0, children[1].costs().0];
                    let (costs, decision) =
                        ForestCosts::of_inner(*area, self.count(), [&first, &second]);
                    (costs, Some(decision))
                }
            }
        }

        /// The number of trees and their cost, for every forest that can replace this tree.
        fn forests(&self) -> Vec<(usize, f32)> {
            let Self::Inner(area, children) = self else {
                return vec![(1, self.costs().0.0[0])];
            };
            let [first, second] = [children[0].forests(), children[1].forests()];
            let pairs = |&(a, cost_a)| {
                second
                    .iter()
                    .map(move |(b, cost_b)| (a + b, cost_a + cost_b))
            };
            let mut forests: Vec<(usize, f32)> = first.iter().flat_map(pairs).collect();
            let nodes = forests.iter().filter(|(trees, _)| *trees <= WIDTH);
            let nodes: Vec<(usize, f32)> = nodes.map(|(_, cost)| (1, area + cost)).collect();
            forests.extend(nodes);
            if self.count() as usize <= LEAF_BLOCKS * BLOCK_SIZE {
                forests.push((1, leaf_cost(*area, self.count())));
            }
            forests
        }

        /// The cost of the forest of at most `most` trees that the decisions make.
        fn decided(&self, most: usize) -> f32 {
            let (Self::Inner(area, children), Some(decision)) = (self, self.costs().1) else {
                return self.costs().0.0[0];
            };
            let both = |[a, b]: [usize; 2]| children[0].decided(a) + children[1].decided(b);
            match decision.distribution(most) {
                Some(distribution) => both(distribution),
                None if decision.is_leaf() => leaf_cost(*area, self.count()),
                None => area + decision.distribution(WIDTH).map_or(f32::INFINITY, both),
            }
        }
    }

    #[test]
    fn no_forest_is_cheaper_and_the_decisions_make_the_cheapest() {
        let mut random = Random::new(1);
        for leaves in (2..=11).flat_map(|leaves| [leaves; 20]) {
            // Also trees whose boxes have no area.
            for areas in [1, 2, 1 << 10] {
                let tree = Binary::random(leaves, areas, &mut random);
                let (forests, costs) = (tree.forests(), tree.costs().0);
                for most in 1..=MAX_FOREST {
                    let small = forests.iter().filter(|(trees, _)| *trees <= most);
                    let least = small.map(|(_, cost)| *cost).fold(f32::INFINITY, f32::min);
                    assert_eq!(costs.0[most - 1], least, "{leaves} leaves, {most} trees");
                    assert_eq!(tree.decided(most), least, "{leaves} leaves, {most} trees");
                }
            }
        }
    }
}
