//! Building the tree: top-down, splitting where the surface-area heuristic says.
//!
//! Source: Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", IRT 2007 (bins
//! over the centroids' box). Differs from it: leaves hold exactly up to [`LEAF_SIZE`] primitives, as
//! one SIMD block costs the same whether it is full or not; large ranges are built in parallel.

use super::{Bvh, Child, LEAF_SIZE, MAX_DEPTH, Node};
use crate::aabb::Aabb;
use crate::progress::Cancelled;
use glam::Vec3;

/// Wald's choice.
const BINS: usize = 16;
/// Smaller ranges are built in well under a millisecond: no work for a thread of its own.
const PARALLEL_FROM: usize = 4096;

/// A primitive while the tree is built.
#[derive(Clone, Copy)]
struct Item {
    bounds: Aabb,
    centre: Vec3,
    index: u32,
}

/// A subtree whose children are numbered from 0, until it is appended to another.
struct Subtree {
    nodes: Vec<Node>,
    leaf_sizes: Vec<u32>,
    root: Child,
}

type KeepGoing<'a> = &'a (dyn Fn() -> Result<(), Cancelled> + Sync);

impl Bvh {
    /// Builds a tree over boxes; primitive `i` is the one with box `i`.
    ///
    /// Boxes that are empty or hold a NaN or an infinity are left out: no ray can meet what is in
    /// them. `keep_going` is asked now and then. The result doesn't depend on the number of threads.
    ///
    /// # Errors
    /// [`Cancelled`] if `keep_going` said so.
    pub fn build(boxes: &[Aabb], keep_going: KeepGoing) -> Result<Self, Cancelled> {
        let mut items: Vec<Item> = boxes
            .iter()
            .enumerate()
            .filter(|(_, b)| !b.is_empty() && b.min.is_finite() && b.max.is_finite())
            .map(|(index, &bounds)| Item {
                bounds,
                centre: bounds.centre(),
                index: index as u32,
            })
            .collect();
        let mut bvh = Self {
            nodes: Vec::new(),
            leaf_starts: vec![0],
            order: Vec::new(),
            bounds: bounds_of(&items),
            root: None,
        };
        if items.is_empty() {
            return Ok(bvh);
        }

        let tree = build_range(&mut items, 0, keep_going)?;
        let mut start = 0;
        bvh.leaf_starts.extend(tree.leaf_sizes.iter().map(|size| {
            start += size;
            start
        }));
        bvh.order = items.iter().map(|item| item.index).collect();
        bvh.nodes = tree.nodes;
        bvh.root = Some(tree.root);
        Ok(bvh)
    }
}

fn build_range(
    items: &mut [Item],
    depth: usize,
    keep_going: KeepGoing,
) -> Result<Subtree, Cancelled> {
    if items.len() <= LEAF_SIZE {
        return Ok(Subtree {
            nodes: Vec::new(),
            leaf_sizes: vec![items.len() as u32],
            root: Child::leaf(0),
        });
    }
    keep_going()?;

    let is_parallel = items.len() >= PARALLEL_FROM;
    let middle = split(items, depth);
    let (left, right) = items.split_at_mut(middle);
    let bounds = [bounds_of(left), bounds_of(right)];
    let (left, right) = if is_parallel {
        rayon::join(
            || build_range(left, depth + 1, keep_going),
            || build_range(right, depth + 1, keep_going),
        )
    } else {
        (
            build_range(left, depth + 1, keep_going),
            build_range(right, depth + 1, keep_going),
        )
    };
    Ok(left?.joined(right?, bounds))
}

impl Subtree {
    /// Both under a new node, which becomes the last one.
    fn joined(mut self, right: Self, bounds: [Aabb; 2]) -> Self {
        let (nodes, leaves) = (self.nodes.len(), self.leaf_sizes.len());
        let moved = |child: Child| match child.as_leaf() {
            Some(leaf) => Child::leaf(leaf + leaves),
            None => Child::node(child.index() + nodes),
        };
        self.nodes.extend(right.nodes.into_iter().map(|node| Node {
            bounds: node.bounds,
            child: node.child.map(moved),
        }));
        self.leaf_sizes.extend(right.leaf_sizes);
        self.nodes.push(Node {
            bounds,
            child: [self.root, moved(right.root)],
        });
        self.root = Child::node(self.nodes.len() - 1);
        self
    }
}

/// Partitions the items and says where the right half begins; both halves hold some.
fn split(items: &mut [Item], depth: usize) -> usize {
    let half = items.len() / 2;
    // Halving by index keeps depth + log₂(n) ≤ MAX_DEPTH, whatever the input.
    let levels_needed = usize::BITS - (items.len() - 1).leading_zeros();
    if depth + levels_needed as usize >= MAX_DEPTH {
        return half;
    }
    let Some(plane) = best_plane(items) else {
        return half;
    };
    let middle = partition(items, |item| plane.bins.of(item.centre) < plane.bin);
    if middle == 0 || middle == items.len() {
        half
    } else {
        middle
    }
}

/// Maps centres to bins along one axis.
#[derive(Clone, Copy)]
struct Bins {
    axis: usize,
    start: f64,
    per_length: f64,
}

impl Bins {
    fn of(&self, centre: Vec3) -> usize {
        let from_start = f64::from(centre[self.axis]) - self.start;
        ((from_start * self.per_length) as usize).min(BINS - 1)
    }
}

struct Plane {
    bins: Bins,
    bin: usize,
}

/// The cheapest of the planes between bins in all axes; `None` if no plane separates the centres.
fn best_plane(items: &[Item]) -> Option<Plane> {
    let centres = Aabb::around(items.iter().map(|item| item.centre));
    let mut best: Option<(f64, Plane)> = None;
    for axis in 0..3 {
        let extent = centres.extent()[axis];
        let per_length = BINS as f64 / extent;
        if !(extent > 0.0 && per_length.is_finite()) {
            continue;
        }
        let bins = Bins {
            axis,
            start: centres.min[axis].into(),
            per_length,
        };
        let mut filled = [(Aabb::EMPTY, 0u32); BINS];
        for item in items {
            let (bounds, count) = &mut filled[bins.of(item.centre)];
            *bounds = bounds.union(item.bounds);
            *count += 1;
        }
        for (bin, cost) in sweep(&filled) {
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, Plane { bins, bin }));
            }
        }
    }
    best.map(|(_, plane)| plane)
}

/// For each plane with something on both sides: its bin and its cost, in blocks times area.
fn sweep(filled: &[(Aabb, u32); BINS]) -> impl Iterator<Item = (usize, f64)> {
    let cost = |(bounds, count): (Aabb, u32)| {
        bounds.half_area() * f64::from(count.div_ceil(LEAF_SIZE as u32))
    };
    let grow = |sum: &mut (Aabb, u32), bin: &(Aabb, u32)| {
        *sum = (sum.0.union(bin.0), sum.1 + bin.1);
        *sum
    };
    let mut sum = (Aabb::EMPTY, 0);
    let mut below = [(Aabb::EMPTY, 0); BINS];
    for (i, bin) in filled.iter().enumerate() {
        below[i] = grow(&mut sum, bin);
    }
    let mut sum = (Aabb::EMPTY, 0);
    let mut costs = [(0, f64::INFINITY); BINS];
    for i in (1..BINS).rev() {
        let above = grow(&mut sum, &filled[i]);
        if above.1 > 0 && below[i - 1].1 > 0 {
            costs[i] = (i, cost(below[i - 1]) + cost(above));
        }
    }
    costs.into_iter().filter(|(bin, _)| *bin > 0)
}

/// Moves the items that satisfy `is_left` to the front, and counts them.
fn partition(items: &mut [Item], is_left: impl Fn(&Item) -> bool) -> usize {
    let mut middle = 0;
    for i in 0..items.len() {
        if is_left(&items[i]) {
            items.swap(i, middle);
            middle += 1;
        }
    }
    middle
}

fn bounds_of(items: &[Item]) -> Aabb {
    items
        .iter()
        .fold(Aabb::EMPTY, |bounds, item| bounds.union(item.bounds))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray::Ray;
    use std::ops::ControlFlow;

    fn build(boxes: &[Aabb]) -> Bvh {
        Bvh::build(boxes, &|| Ok(())).expect("nobody cancels")
    }

    /// Every primitive in exactly one leaf, every leaf within its ancestors' boxes.
    fn assert_sound(bvh: &Bvh, boxes: &[Aabb], expected: usize) {
        let mut seen = vec![0; boxes.len()];
        let mut stack = vec![];
        if let Some(root) = bvh.root {
            stack.push((root, bvh.bounds, 0));
        }
        while let Some((child, bounds, depth)) = stack.pop() {
            assert!(depth <= MAX_DEPTH);
            if let Some(leaf) = child.as_leaf() {
                assert!(bvh.leaf(leaf).len() <= LEAF_SIZE);
                for &primitive in bvh.leaf(leaf) {
                    seen[primitive as usize] += 1;
                    assert_eq!(bounds.union(boxes[primitive as usize]), bounds);
                }
            } else {
                let node = &bvh.nodes[child.index()];
                for side in 0..2 {
                    assert_eq!(bounds.union(node.bounds[side]), bounds);
                    stack.push((node.child[side], node.bounds[side], depth + 1));
                }
            }
        }
        assert!(seen.iter().all(|&n| n <= 1));
        assert_eq!(seen.iter().sum::<usize>(), expected);
    }

    fn scattered(n: u64) -> Vec<Aabb> {
        let at = |i: u64| (crate::sampler::mix(i) >> 40) as f32 / 1e4;
        (0..n)
            .map(|i| {
                let p = Vec3::new(at(3 * i), at(3 * i + 1), at(3 * i + 2));
                Aabb::around([p, p + at(i) * 1e-3])
            })
            .collect()
    }

    #[test]
    fn every_primitive_is_in_one_leaf_and_every_box_holds_what_is_below() {
        for n in [0, 1, 4, 5, 1000, 20_000] {
            let boxes = scattered(n);
            assert_sound(&build(&boxes), &boxes, n as usize);
        }
    }

    #[test]
    fn identical_boxes_and_extreme_extents_build() {
        let point = Aabb::around([Vec3::ONE]);
        let huge = Aabb::around([Vec3::splat(-3e38), Vec3::splat(3e38)]);
        let tiny = Aabb::around([Vec3::ZERO, Vec3::splat(1e-45)]);
        for case in [
            vec![point; 50_000],
            vec![huge; 100],
            vec![tiny, huge, point],
        ] {
            assert_sound(&build(&case), &case, case.len());
        }
        // Centres in a geometric series put all but one into the first bin.
        let series: Vec<Aabb> = (0..250)
            .map(|i| Aabb::around([Vec3::splat(2f32.powi(i - 125))]))
            .collect();
        assert_sound(&build(&series), &series, series.len());
    }

    #[test]
    fn the_tree_does_not_depend_on_the_scenes_size() {
        let boxes = scattered(2000);
        let order = build(&boxes).order;
        for exponent in [-70, 70] {
            let scale = 2f32.powi(exponent);
            let scaled = |b: &Aabb| Aabb::around([b.min * scale, b.max * scale]);
            let boxes: Vec<Aabb> = boxes.iter().map(scaled).collect();
            assert_eq!(build(&boxes).order, order, "2^{exponent}");
        }
    }

    #[test]
    fn boxes_that_no_ray_can_meet_are_left_out() {
        let good = Aabb::around([Vec3::ZERO, Vec3::ONE]);
        let nan = Aabb {
            min: Vec3::splat(f32::NAN),
            max: Vec3::ONE,
        };
        let infinite = Aabb {
            min: Vec3::ZERO,
            max: Vec3::INFINITY,
        };
        let boxes = [nan, good, Aabb::EMPTY, infinite];
        assert_sound(&build(&boxes), &boxes, 1);
    }

    #[test]
    fn a_cancelled_build_says_so() {
        assert!(Bvh::build(&scattered(100), &|| Err(Cancelled)).is_err());
    }

    #[test]
    fn traversal_visits_each_leaf_at_most_once_and_the_nearest_first() {
        let boxes: Vec<Aabb> = (0..64)
            .map(|i| {
                let x = Vec3::X * i as f32 * 2.0;
                Aabb::around([x, x + Vec3::ONE])
            })
            .collect();
        let bvh = build(&boxes);
        let ray = Ray::new(Vec3::new(200.0, 0.5, 0.5), Vec3::NEG_X).expect("a ray");
        let mut visited = vec![];
        bvh.traverse(
            &ray,
            |leaf| {
                visited.push(leaf);
                ControlFlow::Continue(ray.t_max)
            },
            || (),
        );
        assert_eq!(visited.len(), bvh.leaf_count());
        let farthest = bvh.leaf(visited[0]);
        assert!(farthest.contains(&63), "{farthest:?}");
        visited.sort_unstable();
        visited.dedup();
        assert_eq!(visited.len(), bvh.leaf_count());
    }
}
