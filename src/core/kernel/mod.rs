//! Ray–primitive tests: one folder per shape, one algorithm per file, written once and generic over the lane
//! type.
//!
//! To add a kernel, add its file to the folder of its shape, and to the folder's `mod.rs` the module and a row
//! of the table for each precision.

mod algorithm;
mod info;
mod ray_lanes;
mod table;
mod triangle;

pub(crate) use algorithm::{Kernel, LaneHit, MAX_VALUES, OneValue, Values};
pub use info::{KernelInfo, Precision, Promises, Tier};
pub(crate) use ray_lanes::{RayLanes, axes_of};
pub(crate) use table::{KernelList, KernelVisitor};
pub use table::{KernelRow, KernelTable};
pub use triangle::exact::exact_answer;
pub(crate) use triangle::{ShearedRay, corners_of, exact, pack_corners};
pub use triangle::{
    TRIANGLE_KERNELS, TriangleKernel, default_triangle_kernel, exact_triangle_kernel,
    triangle_kernel,
};
