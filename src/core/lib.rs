//! The headless core of hitscope: intersection of rays with meshes, and rendering.
//!
//! The modules, in the order in which data flows:
//!
//! | module | contents |
//! |---|---|
//! | [`obj`] | OBJ and MTL reader |
//! | [`scene_file`] | scene files: reader and writer |
//! | [`shape`] | shapes of primitives, one file per shape |
//! | [`mesh`] | triangle mesh, its origin, and checks of its quality |
//! | `polygon` | triangulation of polygons |
//! | [`group`] | primitives of one shape with their tree |
//! | [`scene`] | the scene: groups and their bounds |
//! | [`loading`] | loading of scenes from files |
//! | [`clip`] | the part of the scene that is shown |
//! | [`camera`] | camera rays and navigation |
//! | `algebra` | exact roots of polynomials, for shapes other than triangles |
//! | [`bvh`] | bounding volume hierarchy: building and traversal |
//! | [`kernel`] | **ray–primitive intersection**, one folder per shape, one file per algorithm |
//! | [`closest_point`] | the point of a mesh nearest to a point |
//! | [`measure`] | distances, angles and circles between picked points |
//! | [`intersector`] | ray–scene intersection: the tree and one kernel combined |
//! | [`barycentric`] | barycentric coordinates and interpolation |
//! | [`interaction`] | the surface at a hit: normals, material, texture coordinates |
//! | `appearance` | the material at a hit, with textures and vertex colours |
//! | `statements` | the BSDF that the statements of a material library describe |
//! | [`bsdf`] | how surfaces scatter light, one file per model |
//! | [`light`] | lights, one file per kind |
//! | [`colour`] | colour maps and scales of numbers |
//! | [`integrator`] | the views: from a hit to a colour |
//! | [`spawn`] | origins of rays that leave a surface |
//! | [`terminator`] | repairs of the shadow terminator |
//! | [`plan`] | the order in which pixels and samples are traced |
//! | [`film`] | accumulation of samples |
//! | [`tone`] | exposure and tone curves |
//! | [`picture`] | pictures for other programs |
//! | [`render`] | progressive rendering on several threads |
//! | [`ray`], [`aabb`], `lane`, [`simd`], [`srgb`], [`sampler`], [`random`], [`progress`], [`counts`], [`names`], [`brightness`] | shared types |
//!
//! Meshes and rays consist of f32 numbers; a mesh is stored relative to an f64 origin. Nothing here
//! depends on a scene's size, position or units.

pub mod aabb;
mod algebra;
mod appearance;
pub mod barycentric;
pub mod brightness;
pub mod bsdf;
pub mod bvh;
pub mod camera;
pub mod clip;
pub mod closest_point;
pub mod colour;
pub mod counts;
pub mod film;
pub mod group;
pub mod integrator;
pub mod interaction;
pub mod intersector;
pub mod kernel;
mod lane;
pub mod light;
pub mod loading;
pub mod measure;
pub mod mesh;
pub mod names;
pub mod obj;
pub mod picture;
pub mod plan;
mod polygon;
pub mod progress;
pub mod random;
pub mod ray;
pub mod render;
pub mod sampler;
pub mod scene;
pub mod scene_file;
pub mod shape;
pub mod simd;
pub mod spawn;
pub mod srgb;
mod statements;
pub mod terminator;
pub mod tone;

pub use aabb::Aabb;
pub use camera::Camera;
pub use clip::Clip;
pub use film::Film;
pub use intersector::Intersector;
pub use mesh::TriangleMesh;
pub use ray::{Hit, Ray};
pub use scene::Scene;
