//! Integration tests of the core's public API.
//!
//! Tests loop over the table of kernels and check what each kernel's `INFO` promises; they name no kernel.

// Easy cases for every kernel, one triangle at a time.
mod conformance;

// The tree with its SIMD lanes against testing every triangle on its own.
mod intersector;
mod interval;

// Every SIMD level, single rays and packets: bit-identical results.
mod simd;

// Kernels that round t past a triangle's box, at the start of an interval.
mod rounded_t;

// Packets and single rays: bit-identical results.
mod packets;

// Pictures rendered in strips: bit-identical to those rendered whole.
mod strips;

// Every tree: bit-identical results.
mod trees;

// Interleaved rays: bit-identical to single rays.
mod interleaved;

// The record of the boxes that a ray opens.
mod opened_boxes;

// Clipped scenes against crossings filtered one by one.
mod clip;

// Watertight kernels: no ray leaves a closed mesh.
mod watertight;

// Edge cases of the exact kernel.
mod exact;

// A spawned ray doesn't hit the surface that it leaves.
mod reintersect;

// Where each spawn policy puts the ray's origin.
mod spawn_policies;

// Properties of any triangle and ray: scaling, permuting vertices, reversing the ray.
mod properties;
// Every OBJ file gives a mesh or a clear error.
mod obj;

// Every scene file gives a description or a clear error.
mod scene_file;

// Scene files become scenes.
mod loading;

// Normals that `flip_normals` or a mirroring transform reverses.
mod sides;

// Saved scenes are the same when they are loaded again.
mod saving;

// Shapes other than triangles.
mod shapes;

// Light transport against closed forms.
mod light;

// Files for other programs, with what denoisers need.
mod picture;

// Scales of views of numbers.
mod scales;

// 64×64 pictures, compared exactly.
mod golden;

// The picture depends neither on the number of threads nor on coarse passes.
mod determinism;

// Stopping: stale jobs, dropped renderers, pauses, cancelled loads, panics.
mod cancellation;
