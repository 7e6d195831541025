//! Shapes other than triangles: the exact kernels against the oracle.
//!
//! `HITSCOPE_SHAPE_RAYS=1000000` tests that many rays of each kind. By default it is 20 000.

// Decisions and t of the exact kernel of each shape.
mod decisions;
// Tangents, edges and corners in integers.
mod constructed;
// Coordinates that are integers times a power of two.
mod frame;
// The nearest of primitives of several shapes that touch or coincide.
mod order;
// Combined solids of random shapes and operations.
mod solids;
// The lab's cases of solids.
mod measured;
// Rays that leave a primitive.
mod spawned;
// Spheres of extreme size.
mod spheres;
// Tori that are thin or far away.
mod tori;

fn ray_count() -> u64 {
    let count = std::env::var("HITSCOPE_SHAPE_RAYS").ok();
    count.and_then(|count| count.parse().ok()).unwrap_or(20_000)
}

/// Calls `check` with numbers from 0 up to the count, on all threads, and adds the results.
fn sum_over(count: u64, check: impl Fn(u64) -> u64 + Send + Sync) -> u64 {
    use rayon::prelude::*;
    (0..count).into_par_iter().map(check).sum()
}
