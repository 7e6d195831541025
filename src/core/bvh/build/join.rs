//! Joins the parts of a tree that several threads built.

use super::{Part, Subtree};
use crate::bvh::{BLOCK_SIZE, Child, Node};
use rayon::prelude::*;

/// Least number of nodes or blocks that a thread copies at once.
const COPIED_AT_ONCE: usize = 1024;

impl Part {
    /// The number of nodes above the subtrees.
    fn upper_nodes(&self) -> usize {
        match self {
            Self::Subtree(..) => 0,
            Self::Node(_, parts) => 1 + parts.iter().map(Self::upper_nodes).sum::<usize>(),
        }
    }
}

/// A subtree with the numbers of its first node and block in the whole tree.
struct Placed {
    tree: Subtree,
    first_node: usize,
    first_block: usize,
}

impl Placed {
    /// A node of the whole tree.
    fn node(&self, index: usize) -> Node {
        let mut node = self.tree.nodes[index - self.first_node].clone();
        let moved = |child: Child| child.moved(self.first_node, self.first_block);
        node.child = node.child.map(moved);
        node
    }

    /// A block of the whole tree.
    fn block(&self, index: usize) -> [u32; BLOCK_SIZE] {
        self.tree.blocks[index - self.first_block]
    }
}

/// The nodes above the subtrees, and the subtrees so far.
struct Joiner {
    nodes: Vec<Node>,
    subtrees: Vec<Placed>,
    node_count: usize,
    block_count: usize,
}

impl Joiner {
    fn add(&mut self, part: Part) -> Child {
        match part {
            Part::Subtree(root, tree) => {
                let (first_node, first_block) = (self.node_count, self.block_count);
                self.node_count += tree.nodes.len();
                self.block_count += tree.blocks.len();
                self.subtrees.push(Placed {
                    tree,
                    first_node,
                    first_block,
                });
                root.moved(first_node, first_block)
            }
            Part::Node(node, parts) => {
                let index = self.nodes.len();
                self.nodes.push(*node);
                for (slot, part) in parts.into_iter().enumerate() {
                    self.nodes[index].child[slot] = self.add(part);
                }
                Child::node(index)
            }
        }
    }
}

/// The whole tree: the nodes above the subtrees, then the subtrees.
pub(super) fn joined(root: Part) -> Subtree {
    let upper_nodes = root.upper_nodes();
    let mut joiner = Joiner {
        nodes: Vec::with_capacity(upper_nodes),
        subtrees: Vec::new(),
        node_count: upper_nodes,
        block_count: 0,
    };
    joiner.add(root);
    let upper = Placed {
        tree: Subtree {
            nodes: joiner.nodes,
            blocks: Vec::new(),
        },
        first_node: 0,
        first_block: 0,
    };
    let mut parts = vec![upper];
    parts.append(&mut joiner.subtrees);
    let joined = Subtree {
        nodes: gathered(
            &parts,
            joiner.node_count,
            |part| part.first_node,
            Placed::node,
        ),
        blocks: gathered(
            &parts,
            joiner.block_count,
            |part| part.first_block,
            Placed::block,
        ),
    };
    parts.into_par_iter().for_each(drop);
    joined
}

/// The elements with the numbers `0..count` of all parts, copied in place by several threads.
fn gathered<T: Send>(
    parts: &[Placed],
    count: usize,
    first: fn(&Placed) -> usize,
    element: fn(&Placed, usize) -> T,
) -> Vec<T> {
    let part_of = |index: usize| parts.partition_point(|part| first(part) <= index) - 1;
    let copy = |part: &mut Option<usize>, index: usize| {
        let is_next = |&part: &usize| parts.get(part + 1).is_some_and(|next| first(next) <= index);
        let part = *part.insert(
            part.filter(|part| !is_next(part))
                .unwrap_or_else(|| part_of(index)),
        );
        element(&parts[part], index)
    };
    let indices = (0..count).into_par_iter().with_min_len(COPIED_AT_ONCE);
    indices.map_init(|| None, copy).collect()
}
