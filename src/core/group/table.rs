//! The table of shapes that scenes can hold.

use super::{Appearance, CSG_KERNELS, Group, SceneOptions, ShapeGroup, csg};
use crate::kernel::{KernelChoice, KernelInfo, KernelTable};
use crate::progress::{Cancelled, Progress};
use crate::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Disk, Plane, Quadric, Rectangle, Shape as _,
    ShapeInfo, Sphere, Torus, Triangle,
};
use std::sync::Arc;

/// A shape that scenes can hold.
///
/// Its methods aren't generic, so that the code of all kernels is compiled once, in this crate.
pub trait Grouped: KernelTable {
    /// A group of primitives with their materials and sides.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    fn group(
        primitives: Vec<Self>,
        appearance: Appearance,
        options: SceneOptions,
        progress: &Progress,
    ) -> Result<Arc<dyn Group>, Cancelled>;
}

/// A shape and its kernels.
pub struct ShapeKernels {
    /// The shape.
    pub shape: ShapeInfo,
    /// The kernels of its table, in the same order.
    pub kernels: Vec<&'static KernelInfo>,
}

/// The kernel with this name or of the tier with this name, in any shape's table.
pub fn kernel_named(name: &str) -> Option<KernelChoice> {
    let kernels = all_kernels().into_iter().flat_map(|shape| shape.kernels);
    let mut kernels = kernels.filter(|kernel| kernel.answers_to(name));
    kernels.next().map(|info| KernelChoice { info })
}

macro_rules! shapes {
    ($($shape:ident),*) => {
    /// All shapes and their kernels.
    pub fn all_kernels() -> Vec<ShapeKernels> {
        vec![$(ShapeKernels {
            shape: $shape::INFO,
            kernels: $shape::kernels().iter().map(|row| row.info).collect(),
        },)* ShapeKernels {
            shape: csg::INFO,
            kernels: CSG_KERNELS.to_vec(),
        }]
    }
    $(
        impl Grouped for $shape {
            fn group(
                primitives: Vec<Self>,
                appearance: Appearance,
                options: SceneOptions,
                progress: &Progress,
            ) -> Result<Arc<dyn Group>, Cancelled> {
                let group = ShapeGroup::<Self>::new(Arc::new(primitives), options, progress)?;
                Ok(Arc::new(group.with_appearance(appearance)))
            }
        }
    )*};
}

shapes!(
    Triangle, Sphere, Plane, AxisPlane, Disk, Rectangle, Cuboid, AxisBox, Cylinder, Cone, Torus,
    Quadric
);
