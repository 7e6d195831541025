//! The core's integration tests: what a user of the crate may rely on.
//!
//! Every kernel in the table is tested here without being named, by what its `INFO` promises.

// Every kernel: the easy cases, one triangle at a time.
mod conformance;

// The tree with its SIMD lanes against each triangle asked alone.
mod intersector;
mod interval;

// Every SIMD level, rays one by one and together: the same bits.
mod simd;

// Kernels that round t past a triangle's box, at the start of an interval.
mod rounded_t;

// Rays together: the same bits.
mod packets;

// Every tree: the same bits.
mod trees;

// Kernels that promise it: no ray leaves a closed mesh.
mod watertight;

// The exact kernel in edge cases.
mod exact;

// A ray that leaves a surface doesn't meet it again.
mod reintersect;

// Where each policy starts such a ray.
mod spawn_policies;

// What holds for any triangle and ray: scaling, permuting, reversing.
mod properties;
// Any file that people have is a mesh or a clear error.
mod obj;

// 64×64 pictures, compared exactly.
mod golden;

// One thread or many, coarse first or not: the same picture.
mod determinism;

// Stopping: stale jobs, dropped renderers, pauses, cancelled loads, panics.
mod cancellation;
