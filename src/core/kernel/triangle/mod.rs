//! Ray–triangle kernels, and the table of them.

mod moller_trumbore;
mod watertight;

use super::{Kernel, KernelInfo};
use crate::bvh::Bvh;
use crate::intersector::{Intersector, MeshIntersector};
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use glam::Vec3;
use std::sync::Arc;

/// A row of the table: one kernel, behind functions that don't name its type.
pub struct TriangleKernel {
    /// What the kernel says of itself.
    pub info: KernelInfo,
    intersector: fn(&TriangleMesh, Arc<Bvh>) -> Box<dyn Intersector>,
    scalar: fn(&Ray, [Vec3; 3]) -> Option<Hit>,
}

impl TriangleKernel {
    const fn of<K: Kernel>() -> Self {
        Self {
            info: K::INFO,
            intersector: |mesh, bvh| Box::new(MeshIntersector::<K>::new(mesh, bvh)),
            scalar: intersect_one::<K>,
        }
    }

    /// Packs a mesh for this kernel.
    pub fn intersector(&self, mesh: &TriangleMesh, bvh: Arc<Bvh>) -> Box<dyn Intersector> {
        (self.intersector)(mesh, bvh)
    }

    /// Tests one triangle in scalar f32, with the bits that the SIMD lanes give. The hit's
    /// `primitive` is 0.
    pub fn intersect(&self, ray: &Ray, corners: [Vec3; 3]) -> Option<Hit> {
        (self.scalar)(ray, corners)
    }
}

/// Every triangle kernel, from fast to accurate.
pub static TRIANGLE_KERNELS: &[TriangleKernel] = &[
    TriangleKernel::of::<moller_trumbore::MollerTrumbore>(),
    TriangleKernel::of::<watertight::Watertight>(),
];

/// The kernel of this name, or the one that serves the tier of this name.
pub fn triangle_kernel(name: &str) -> Option<&'static TriangleKernel> {
    TRIANGLE_KERNELS.iter().find(|kernel| {
        kernel.info.name == name || kernel.info.tier.is_some_and(|tier| tier.name() == name)
    })
}

/// What is used where nobody chose: watertight.
pub fn default_triangle_kernel() -> &'static TriangleKernel {
    triangle_kernel(watertight::Watertight::INFO.name).expect("the default is in the table")
}

fn intersect_one<K: Kernel>(ray: &Ray, corners: [Vec3; 3]) -> Option<Hit> {
    let prepared = K::prepare::<f32>((), ray);
    let hit = K::intersect(&prepared, &corners, ray.t_min, ray.t_max)?;
    (hit.mask && hit.t < ray.t_max).then_some(Hit {
        t: hit.t,
        u: hit.u,
        v: hit.v,
        primitive: 0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_tiers_find_their_kernel_and_are_unique() {
        for kernel in TRIANGLE_KERNELS {
            let named = |name| triangle_kernel(name).expect("found").info.name;
            assert_eq!(named(kernel.info.name), kernel.info.name);
            if let Some(tier) = kernel.info.tier {
                assert_eq!(named(tier.name()), kernel.info.name);
            }
        }
        assert!(triangle_kernel("no such kernel").is_none());
    }
}
