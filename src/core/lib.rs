//! hitscope's headless core: what a ray meets in a mesh, and the picture that follows from it.
//!
//! A map, in the order in which data flows:
//!
//! | module | answers |
//! |---|---|
//! | [`obj`] | what does this OBJ file hold? |
//! | [`mesh`] | which triangles, about which origin, and are they healthy? |
//! | [`scene`] | what is there to be seen? |
//! | [`camera`] | which ray belongs to a pixel? |
//! | [`bvh`] | which boxes does a ray meet, nearest first? |
//! | [`kernel`] | **where does a ray meet a triangle?** One file an algorithm |
//! | [`intersector`] | where does a ray meet the scene: the tree and one kernel together |
//! | [`interaction`] | what is the surface like at a hit? |
//! | [`integrator`] | which colour does a ray bring back? |
//! | [`spawn`] | where does a ray begin that leaves a surface? |
//! | [`film`] | what does the picture look like so far? |
//! | [`render`] | which pixel is traced when, and by which thread? |
//! | [`ray`], [`aabb`], `lane`, [`srgb`], [`sampler`], [`random`], [`progress`] | what the others speak in |
//!
//! The question is always put in f32: a mesh of f32 positions about an f64 origin, and f32 rays.
//! Nothing here depends on a scene's size, place or units.

pub mod aabb;
pub mod bvh;
pub mod camera;
pub mod film;
pub mod integrator;
pub mod interaction;
pub mod intersector;
pub mod kernel;
mod lane;
pub mod mesh;
pub mod obj;
pub mod progress;
pub mod random;
pub mod ray;
pub mod render;
pub mod sampler;
pub mod scene;
pub mod simd;
pub mod spawn;
pub mod srgb;

pub use aabb::Aabb;
pub use camera::Camera;
pub use film::Film;
pub use intersector::Intersector;
pub use mesh::TriangleMesh;
pub use ray::{Hit, Ray};
pub use scene::Scene;
