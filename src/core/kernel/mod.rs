//! Ray–primitive tests: one folder per shape, one algorithm per file, written once and generic over the lane
//! type.
//!
//! To add a kernel, add its file to the folder of its shape, and to the folder's `mod.rs` the module and a row
//! of the table for each precision.

pub(crate) mod algebraic;
mod algorithm;
mod axis_box;
mod axis_plane;
mod choice;
mod cone;
mod crossings;
mod cuboid;
mod cylinder;
mod flat;
mod info;
mod plane;
mod quadric;
mod ray_lanes;
mod slabs;
mod sphere;
mod table;
mod torus;
mod triangle;

pub use crate::algebra::{LineEquation, LineRoot};
pub(crate) use algorithm::{Kernel, LaneHit, MAX_VALUES};
pub use choice::KernelChoice;
pub use info::{KernelInfo, Precision, Promises, Tier};
pub(crate) use ray_lanes::{RayLanes, axes_of};
pub use sphere::SPHERE_KERNELS;
pub(crate) use table::{KernelList, KernelVisitor};
pub use table::{KernelRow, KernelTable, equations_along, exact_answer};
pub(crate) use triangle::{ShearedRay, exact};
pub use triangle::{
    TRIANGLE_KERNELS, TriangleKernel, default_triangle_kernel, exact_triangle_kernel,
    triangle_kernel,
};
