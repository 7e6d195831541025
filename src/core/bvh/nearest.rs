//! Search of the primitives nearest to a point, by the distances of the tree's boxes.
//!
//! Source: Roussopoulos, Kelley, Vincent, "Nearest Neighbor Queries", SIGMOD 1995 (branch and bound; of a node's
//!   children the nearest first).
//!
//! A tree's box encloses the boxes of the primitives below it, and each operation of [`Aabb::distance_squared`] is
//! monotone in the box, rounded or not. So a primitive whose rank is at least the square of its own box's distance is
//! never lost, and the search gives the answer of a search through all primitives, bit for bit.

use super::{Bvh, Child, WIDTH};
use crate::aabb::Aabb;
use glam::DVec3;

impl Bvh {
    /// Passes blocks of primitives to `visit`, those with near boxes first. `visit` returns the square of the distance up
    /// to which primitives still matter. Boxes at exactly that distance are still visited.
    pub(crate) fn visit_nearest(&self, point: DVec3, mut visit: impl FnMut(usize) -> f64) {
        if self.nodes.is_empty() {
            return;
        }
        let mut limit = f64::INFINITY;
        let mut waiting: Vec<(f64, Child)> = Vec::with_capacity(USUAL_DEPTH * WIDTH);
        waiting.push((0.0, Child::node(0)));
        while let Some((squared, child)) = waiting.pop() {
            if squared > limit {
                continue;
            }
            if child.is_leaf() {
                let first = child.first_block();
                for block in first..first + child.block_count() {
                    limit = visit(block);
                }
                continue;
            }
            let node = &self.nodes[child.node_index()];
            let start = waiting.len();
            for (lane, &child) in node.child.iter().enumerate() {
                let bounds = Aabb::from_planes(node.planes.map(|plane| plane[lane]));
                let squared = bounds.distance_squared(point);
                if child != Child::NONE && squared <= limit {
                    waiting.push((squared, child));
                }
            }
            // The nearest child is taken first.
            waiting[start..].sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
        }
    }
}

/// The levels of a tree of ten million primitives.
const USUAL_DEPTH: usize = 9;
