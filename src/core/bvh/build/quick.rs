//! Fast tree builder: primitives in the order of a space-filling curve, eight per block, eight blocks or
//! nodes per node. Its trees are slower to trace than those of the surface-area heuristic.
//!
//! Source: C. Lauterbach, M. Garland, S. Sengupta, D. Luebke, D. Manocha, "Fast BVH Construction on GPUs",
//! Computer Graphics Forum 28(2), 2009 (primitives by Morton code). Differs from it: ranges are split by
//! count, not where codes differ, so that every block and node but the last ones is full.

use super::split::around;
use super::{Bounds, BoundsOf, KeepGoing, items_of};
use crate::bvh::{BLOCK_SIZE, Bvh, Child, NO_PRIMITIVE, Node, WIDTH};
use crate::progress::Cancelled;
use glam::Vec3A;
use rayon::prelude::*;

/// Bits of a Morton code along each axis.
const BITS: u32 = 10;

impl Bvh {
    /// Builds a tree in a fraction of the time of [`build`](Self::build); rays take longer.
    ///
    /// # Errors
    /// [`Cancelled`] if `keep_going` returned it.
    pub fn build_quickly(
        count: usize,
        bounds_of: BoundsOf,
        keep_going: KeepGoing,
    ) -> Result<Self, Cancelled> {
        keep_going()?;
        let items = items_of(count, bounds_of);
        let bounds = around(&items);
        let grid = Grid::over(bounds);
        // The code in the upper half, the index in the lower half, so that one number can be sorted.
        let key = |at: usize| u64::from(grid.code(items[at].bounds())) << 32 | at as u64;
        let mut order: Vec<u64> = (0..items.len()).into_par_iter().map(key).collect();
        keep_going()?;
        order.par_sort_unstable();
        keep_going()?;

        let block = |part: &[u64]| {
            let mut primitives = [NO_PRIMITIVE; BLOCK_SIZE];
            let mut bounds = Bounds::EMPTY;
            for (lane, &key) in primitives.iter_mut().zip(part) {
                let item = &items[key as u32 as usize];
                *lane = item.index();
                bounds.grow(item.bounds());
            }
            (primitives, bounds)
        };
        let (blocks, boxes) = order.par_chunks(BLOCK_SIZE).map(block).unzip();
        Ok(Self {
            nodes: nodes(boxes),
            blocks,
            bounds: bounds.into(),
        })
    }
}

/// The nodes over blocks with these boxes: level by level, the root first.
fn nodes(boxes: Vec<Bounds>) -> Vec<Node> {
    if boxes.is_empty() {
        return Vec::new();
    }
    // Bottom-up: the boxes of each level are the children of the next one.
    let mut levels: Vec<Vec<Bounds>> = vec![boxes];
    while levels.len() == 1 || levels[levels.len() - 1].len() > 1 {
        let below = &levels[levels.len() - 1];
        let union = |part: &[Bounds]| {
            let mut bounds = Bounds::EMPTY;
            part.iter().for_each(|&child| bounds.grow(child));
            bounds
        };
        levels.push(below.par_chunks(WIDTH).map(union).collect());
    }
    let mut nodes: Vec<Node> = Vec::new();
    for (height, children) in levels[..levels.len() - 1].iter().enumerate().rev() {
        // The nodes of the level below follow those of this level.
        let next = nodes.len() + children.len().div_ceil(WIDTH);
        let node = |(k, part): (usize, &[Bounds])| {
            let mut node = Node::EMPTY;
            for (slot, &bounds) in part.iter().enumerate() {
                let index = k * WIDTH + slot;
                node.set_bounds(slot, bounds.into());
                node.child[slot] = match height {
                    0 => Child::leaf(index, 1),
                    _ => Child::node(next + index),
                };
            }
            node
        };
        let level: Vec<Node> = children.par_chunks(WIDTH).enumerate().map(node).collect();
        nodes.extend(level);
    }
    nodes
}

/// A grid whose cells are numbered along the curve.
struct Grid {
    lower: Vec3A,
    per_length: Vec3A,
}

impl Grid {
    fn over(bounds: Bounds) -> Self {
        let cells = (1 << BITS) as f32;
        // Computed from halves, as the extent may overflow f32.
        let half = 0.5 * bounds.upper - 0.5 * bounds.lower;
        let per_length = Vec3A::splat(0.5 * cells) / half;
        Self {
            lower: bounds.lower,
            per_length: Vec3A::select(per_length.is_finite_mask(), per_length, Vec3A::ZERO),
        }
    }

    /// The position of a box's centre on the curve.
    fn code(&self, bounds: Bounds) -> u32 {
        let from_lower =
            (0.5 * bounds.lower - 0.5 * self.lower) + (0.5 * bounds.upper - 0.5 * self.lower);
        let cell = from_lower * self.per_length;
        let most = ((1 << BITS) - 1) as f32;
        // A NaN becomes 0.
        let [x, y, z] = cell.clamp(Vec3A::ZERO, Vec3A::splat(most)).to_array();
        spread(x as u32) | spread(y as u32) << 1 | spread(z as u32) << 2
    }
}

/// Inserts two zeros between the bits of a ten-bit number.
fn spread(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00ff;
    let x = (x | x << 8) & 0x0300_f00f;
    let x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spread_inserts_two_zeros_between_bits() {
        for bit in 0..BITS {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(spread(0b11_1111_1111), 0o1_111_111_111);
    }
}
