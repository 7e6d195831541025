//! Choice of the nodes with eight children: of all trees to which a binary tree can be collapsed, the cheapest.
//!
//! Source: H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
//!   HPG 2017 (dynamic programming over the number of trees that take a binary node's place).
//!
//! A node costs as much as a block; with two thirds of that no workload is faster. Relative to a builder that splits the
//! child of largest area until there are eight, this fills the nodes above the leaves: the bunny, 69 k triangles, has 1634
//! nodes instead of 3434, and rays take 5 to 10 % less time (2026-11).

use super::{BLOCK_SIZE, LEAF_BLOCKS, WIDTH};

/// The most trees that take the place of one child: the other child needs at least one.
const MOST: usize = WIDTH - 1;

/// The least cost of replacing a binary node by at most 1, 2, …, [`MOST`] trees, each of them a leaf or a node with eight
/// children. Costs are in blocks times area.
#[derive(Clone, Copy)]
pub(super) struct Costs([f32; MOST]);

/// How the trees that take the place of an inner binary node are made.
#[derive(Clone, Copy)]
pub(super) struct Choice {
    /// Whether one tree is a leaf rather than a node.
    is_leaf: bool,
    /// The number of trees for the first child if there are at most 2, 3, …, [`WIDTH`]; the second child has the rest. 0 if
    /// fewer trees cost no more.
    of_first: [u8; MOST],
}

/// The cost of a leaf.
fn leaf_cost(half_area: f32, count: u32) -> f32 {
    half_area * count.div_ceil(BLOCK_SIZE as u32) as f32
}

impl Costs {
    /// The costs of a binary leaf.
    pub fn of_leaf(half_area: f32, count: u32) -> Self {
        Self([leaf_cost(half_area, count); MOST])
    }

    /// The costs of an inner binary node with `count` primitives, given those of its children.
    pub fn of_inner(half_area: f32, count: u32, children: [&Self; 2]) -> (Self, Choice) {
        let (of_children, of_first) = Self::cheapest(children, WIDTH);
        let node = half_area + of_children;
        let mut choice = Choice {
            is_leaf: false,
            of_first: [0; MOST],
        };
        choice.of_first[WIDTH - 2] = of_first;
        let mut costs = [node; MOST];
        if count as usize <= LEAF_BLOCKS * BLOCK_SIZE {
            let leaf = leaf_cost(half_area, count);
            choice.is_leaf = leaf <= node;
            costs[0] = leaf.min(node);
        }
        for most in 2..=MOST {
            let (cost, of_first) = Self::cheapest(children, most);
            costs[most - 1] = costs[most - 2];
            if cost < costs[most - 2] {
                costs[most - 1] = cost;
                choice.of_first[most - 2] = of_first;
            }
        }
        (Self(costs), choice)
    }

    /// The cheapest way to replace two children by at most `most` trees: its cost, and the number of trees for the first.
    fn cheapest([first, second]: [&Self; 2], most: usize) -> (f32, u8) {
        let mut best = (f32::INFINITY, 1);
        for of_first in most.saturating_sub(MOST).max(1)..=MOST.min(most - 1) {
            let cost = first.0[of_first - 1] + second.0[most - of_first - 1];
            if cost < best.0 {
                best = (cost, of_first as u8);
            }
        }
        best
    }
}

impl Choice {
    /// Whether the node becomes a leaf, if one tree takes its place.
    pub fn is_leaf(&self) -> bool {
        self.is_leaf
    }

    /// How the two children share at most `most` trees; `None` if one tree takes the node's place.
    pub fn shares(&self, most: usize) -> Option<[usize; 2]> {
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
        fn random(leaves: usize, random: &mut Random) -> Self {
            let area = 1.0 + random.index(1 << 10) as f32;
            if leaves == 1 {
                return Self::Leaf(area, 1 + random.index(BLOCK_SIZE) as u32);
            }
            let first = 1 + random.index(leaves - 1);
            let halves = [first, leaves - first].map(|leaves| Self::random(leaves, random));
            Self::Inner(area, Box::new(halves))
        }

        fn count(&self) -> u32 {
            match self {
                Self::Leaf(_, count) => *count,
                Self::Inner(_, halves) => halves.iter().map(Self::count).sum(),
            }
        }

        fn costs(&self) -> Costs {
            match self {
                Self::Leaf(area, count) => Costs::of_leaf(*area, *count),
                Self::Inner(area, halves) => {
                    let [first, second] = [halves[0].costs(), halves[1].costs()];
                    Costs::of_inner(*area, self.count(), [&first, &second]).0
                }
            }
        }

        /// The number of trees and their cost, for every way to replace this one.
        fn ways(&self) -> Vec<(usize, f32)> {
            let Self::Inner(area, halves) = self else {
                return vec![(1, self.costs().0[0])];
            };
            let [first, second] = [halves[0].ways(), halves[1].ways()];
            let pairs = |&(a, cost_a)| {
                second
                    .iter()
                    .map(move |(b, cost_b)| (a + b, cost_a + cost_b))
            };
            let mut ways: Vec<(usize, f32)> = first.iter().flat_map(pairs).collect();
            let nodes = ways.iter().filter(|(trees, _)| *trees <= WIDTH);
            let nodes: Vec<(usize, f32)> = nodes.map(|(_, cost)| (1, area + cost)).collect();
            ways.extend(nodes);
            if self.count() as usize <= LEAF_BLOCKS * BLOCK_SIZE {
                ways.push((1, leaf_cost(*area, self.count())));
            }
            ways
        }
    }

    #[test]
    fn no_way_to_replace_a_tree_is_cheaper() {
        let mut random = Random::new(1);
        for leaves in (2..=11).flat_map(|leaves| [leaves; 20]) {
            let tree = Binary::random(leaves, &mut random);
            let (ways, costs) = (tree.ways(), tree.costs());
            for most in 1..=MOST {
                // Whole numbers below 2²⁴, so that sums are exact.
                let costs_of = ways.iter().filter(|(trees, _)| *trees <= most);
                let least = costs_of
                    .map(|(_, cost)| *cost)
                    .fold(f32::INFINITY, f32::min);
                assert_eq!(costs.0[most - 1], least, "{leaves} leaves, {most} trees");
            }
        }
    }
}
