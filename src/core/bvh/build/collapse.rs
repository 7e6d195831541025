//! Collapse of a binary tree to nodes with eight children.

use super::binary::BinaryTree;
use super::{BLOCK_SIZE, Child, Item, LEAF_BLOCKS, NO_PRIMITIVE, Node, Part, Subtree};
use rayon::prelude::*;

/// Creates the nodes, and frees the binary tree as it goes. The functions return `None` if a node would be deeper than
/// `max_depth`.
pub(super) struct Collapse<'a> {
    pub items: &'a [Item],
    /// Trees of at most this many primitives are collapsed by one thread.
    pub job_size: usize,
    /// The largest depth of a node; the root has depth 1.
    pub max_depth: usize,
}

impl Collapse<'_> {
    /// Creates the root. It is a node even if the tree has one leaf, so that its box is tested.
    pub fn root(&self, tree: BinaryTree) -> Option<Part> {
        let children = tree.into_node_children().unwrap_or_else(|tree| vec![tree]);
        self.node(children, 1)
    }

    /// Creates a node above these trees.
    fn node(&self, children: Vec<BinaryTree>, depth: usize) -> Option<Part> {
        if depth > self.max_depth {
            return None;
        }
        let node = Box::new(Node::around(&children));
        let parts = children.into_par_iter().with_max_len(1);
        let parts = parts.map(|tree| self.part(tree, depth + 1));
        Some(Part::Node(node, parts.collect::<Option<_>>()?))
    }

    fn part(&self, mut tree: BinaryTree, depth: usize) -> Option<Part> {
        if tree.count() > self.job_size {
            tree = match tree.into_node_children() {
                Ok(children) => return self.node(children, depth),
                Err(leaf) => leaf,
            };
        }
        let mut subtree = Subtree::default();
        let root = subtree.add(tree, self, depth)?;
        subtree.nodes.shrink_to_fit();
        subtree.blocks.shrink_to_fit();
        Some(Part::Subtree(root, subtree))
    }
}

impl Subtree {
    /// Adds a tree as a node or a leaf.
    fn add(&mut self, tree: BinaryTree, collapse: &Collapse, depth: usize) -> Option<Child> {
        let children = match tree.into_node_children() {
            Ok(children) => children,
            Err(leaf) => return Some(self.add_leaf(leaf.items(collapse.items))),
        };
        if depth > collapse.max_depth {
            return None;
        }
        let index = self.nodes.len();
        self.nodes.push(Node::around(&children));
        for (slot, tree) in children.into_iter().enumerate() {
            self.nodes[index].child[slot] = self.add(tree, collapse, depth + 1)?;
        }
        Some(Child::node(index))
    }

    fn add_leaf(&mut self, items: &[Item]) -> Child {
        debug_assert!(items.len() <= LEAF_BLOCKS * BLOCK_SIZE);
        let first = self.blocks.len();
        for part in items.chunks(BLOCK_SIZE) {
            let mut block = [NO_PRIMITIVE; BLOCK_SIZE];
            for (lane, item) in block.iter_mut().zip(part) {
                *lane = item.index();
            }
            self.blocks.push(block);
        }
        Child::leaf(first, self.blocks.len() - first)
    }
}

impl Node {
    /// A node with the trees' boxes.
    fn around(trees: &[BinaryTree]) -> Self {
        let mut node = Self::EMPTY;
        for (slot, tree) in trees.iter().enumerate() {
            node.set_bounds(slot, tree.bounds);
        }
        node
    }
}
