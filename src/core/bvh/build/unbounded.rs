//! Trees of primitives without bounds.

use super::super::{BLOCK_SIZE, Bvh, Child, LEAF_BLOCKS, NO_PRIMITIVE, Node, WIDTH};
use crate::aabb::{Aabb, Planes};

/// Boxes that every ray meets.
const EVERYWHERE: Planes<[f32; WIDTH]> = {
    let (lower, upper) = ([f32::NEG_INFINITY; WIDTH], [f32::INFINITY; WIDTH]);
    [lower, upper, lower, upper, lower, upper]
};

impl Bvh {
    /// A tree of primitives without bounds: a ray visits all of them.
    pub fn unbounded(primitives: &[u32]) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            blocks: Vec::new(),
            bounds: Aabb::EMPTY,
        };
        for part in primitives.chunks(BLOCK_SIZE) {
            let lane = |lane: usize| part.get(lane).copied().unwrap_or(NO_PRIMITIVE);
            tree.blocks.push(std::array::from_fn(lane));
        }
        // From the leaves up; the root is moved to the front.
        let mut level: Vec<Child> = (0..tree.blocks.len())
            .step_by(LEAF_BLOCKS)
            .map(|first| Child::leaf(first, LEAF_BLOCKS.min(tree.blocks.len() - first)))
            .collect();
        if level.is_empty() {
            return tree;
        }
        tree.nodes.push(Node::EMPTY);
        loop {
            let is_root = level.len() <= WIDTH;
            let nodes = level.chunks(WIDTH).map(|children| {
                let mut node = Node::EMPTY;
                for (lane, child) in children.iter().enumerate() {
                    node.child[lane] = *child;
                    for (planes, everywhere) in node.planes.iter_mut().zip(&EVERYWHERE) {
                        planes[lane] = everywhere[lane];
                    }
                }
                node
            });
            let nodes: Vec<Node> = nodes.collect();
            if is_root {
                tree.nodes[0] = nodes[0].clone();
                return tree;
            }
            level = (0..nodes.len())
                .map(|k| Child::node(tree.nodes.len() + k))
                .collect();
            tree.nodes.extend(nodes);
        }
    }
}
