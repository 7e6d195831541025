//! The record of a walk: the boxes that it opened, in order.

use super::{Bvh, Child, WIDTH};
use crate::aabb::Aabb;

/// A box that a walk opened: it tested what the box holds.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenedBox {
    /// The box.
    pub bounds: Aabb,
    /// What was tested.
    pub contents: BoxContents,
}

/// The contents of a box.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BoxContents {
    /// Boxes, of which some may be empty.
    Boxes(u32),
    /// Primitives.
    Primitives(Vec<u32>),
}

/// A step of a walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step {
    /// A node was opened.
    Node(usize),
    /// A block of primitives was visited.
    Block(usize),
}

impl Bvh {
    /// The boxes of a walk's steps. The blocks of one leaf are one box.
    pub(crate) fn opened(&self, steps: &[Step]) -> Vec<OpenedBox> {
        let mut opened: Vec<OpenedBox> = Vec::new();
        let mut nodes = Vec::new();
        let mut last_leaf = None;
        for &step in steps {
            let block = match step {
                Step::Node(node) => {
                    nodes.push(node);
                    last_leaf = None;
                    opened.push(OpenedBox {
                        bounds: self.node_bounds(node),
                        contents: BoxContents::Boxes(WIDTH as u32),
                    });
                    continue;
                }
                Step::Block(block) => block,
            };
            let primitives = self.block(block);
            // The newest node is most likely the leaf's.
            let leaf = nodes.iter().rev().find_map(|&node| self.leaf(node, block));
            if leaf.is_some() && leaf == last_leaf {
                if let Some(OpenedBox {
                    contents: BoxContents::Primitives(of_leaf),
                    ..
                }) = opened.last_mut()
                {
                    of_leaf.extend_from_slice(primitives);
                }
                continue;
            }
            last_leaf = leaf;
            opened.push(OpenedBox {
                bounds: leaf.map_or(Aabb::EMPTY, |(_, bounds)| bounds),
                contents: BoxContents::Primitives(primitives.to_vec()),
            });
        }
        opened
    }

    /// The box around a node's children.
    fn node_bounds(&self, node: usize) -> Aabb {
        let lanes = 0..WIDTH;
        lanes.fold(Aabb::EMPTY, |all, lane| all.union(self.box_of(node, lane)))
    }

    fn box_of(&self, node: usize, lane: usize) -> Aabb {
        Aabb::from_planes(self.nodes[node].planes.map(|plane| plane[lane]))
    }

    /// The first block and the box of the node's leaf that holds a block.
    fn leaf(&self, node: usize, block: usize) -> Option<(usize, Aabb)> {
        let holds = |child: &Child| {
            let first = child.first_block();
            let is_leaf = *child != Child::NONE && child.is_leaf();
            is_leaf && (first..first + child.block_count()).contains(&block)
        };
        let children = &self.nodes[node].child;
        let lane = children.iter().position(holds)?;
        Some((children[lane].first_block(), self.box_of(node, lane)))
    }
}

impl OpenedBox {
    /// The number of boxes that were tested in this box.
    pub fn box_count(&self) -> u32 {
        match self.contents {
            BoxContents::Boxes(count) => count,
            BoxContents::Primitives(_) => 0,
        }
    }

    /// The number of primitives that were tested in this box.
    pub fn primitive_count(&self) -> u32 {
        match &self.contents {
            BoxContents::Boxes(_) => 0,
            BoxContents::Primitives(primitives) => primitives.len() as u32,
        }
    }

    /// The same with primitives numbered from `first`.
    pub(crate) fn numbered_from(mut self, first: u32) -> Self {
        if let BoxContents::Primitives(primitives) = &mut self.contents {
            primitives.iter_mut().for_each(|index| *index += first);
        }
        self
    }
}
