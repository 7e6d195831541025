//! Visiting the leaves that a ray meets, nearest first.

use super::slab::SlabRay;
use super::{Bvh, Child, MAX_DEPTH};
use crate::ray::Ray;

/// How much farther than the nearest hit boxes are visited, relatively: 16 ulp.
///
/// A kernel's t is rounded some nine times and a box's entry three, so that a hit may be reported
/// before its box is entered. Measured on overlapping triangles in one plane, where that shows: of
/// 5 M rays the lowest triangle lost 15 with 3 ulp, 9 with 4, 5 with 8, none with 16 (2026-11).
const SLACK: f32 = 16.0 * f32::EPSILON;

impl Bvh {
    /// Hands each leaf that the ray meets to `visit`, the nearer child first.
    ///
    /// `visit` gets the leaf's index and returns up to which t the ray is still of interest: the
    /// nearest hit so far, or `ray.t_max`. A negative infinity ends the walk. Boxes at exactly that
    /// distance are still visited, and those a little behind it, so that of two hits at equal t the
    /// caller sees both. `box_tested` is called once for each box tested.
    #[inline(always)]
    pub fn traverse(
        &self,
        ray: &Ray,
        mut visit: impl FnMut(usize) -> f32,
        mut box_tested: impl FnMut(),
    ) {
        let slabs = SlabRay::new(ray);
        let mut t_max = ray.t_max;
        let mut stack = [(0.0f32, Child(0)); MAX_DEPTH + 1];
        let mut depth = 0;

        let Some(root) = self.root else { return };
        box_tested();
        if slabs.enter(&self.bounds, t_max).is_none() {
            return;
        }
        let mut current = root;
        loop {
            if let Some(leaf) = current.as_leaf() {
                let limit = visit(leaf);
                t_max = limit + limit.abs() * SLACK;
            } else {
                let node = &self.nodes[current.index()];
                box_tested();
                box_tested();
                let enter = [
                    slabs.enter(&node.bounds[0], t_max),
                    slabs.enter(&node.bounds[1], t_max),
                ];
                match enter {
                    [Some(first), Some(second)] => {
                        // The nearer child now, the other one later.
                        let (near, far) = if second < first { (1, 0) } else { (0, 1) };
                        stack[depth] = (first.max(second), node.child[far]);
                        depth += 1;
                        current = node.child[near];
                        continue;
                    }
                    [Some(_), None] => {
                        current = node.child[0];
                        continue;
                    }
                    [None, Some(_)] => {
                        current = node.child[1];
                        continue;
                    }
                    [None, None] => {}
                }
            }

            // Back to what was put off, but for what has since turned out to lie behind the hit.
            loop {
                if depth == 0 {
                    return;
                }
                depth -= 1;
                let (enter, child) = stack[depth];
                if enter <= t_max {
                    current = child;
                    break;
                }
            }
        }
    }
}
