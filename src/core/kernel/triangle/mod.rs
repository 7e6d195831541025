//! Ray–triangle kernels and their table.

mod baldwin_weber;
mod bounds;
mod dominant_axis;
mod edge_planes;
pub(crate) mod exact;
mod moller_trumbore;
mod parametric;
mod plane_projection;
mod shear;
mod watertight;

pub use bounds::{bounds_in, triangle_bounds};
pub(crate) use shear::ShearedRay;

use super::{Kernel, KernelInfo, MAX_VALUES, OneTriangle, RayLanes};
use crate::bvh::Bvh;
use crate::intersector::exact::ExactIntersector;
use crate::intersector::mesh::MeshIntersector;
use crate::intersector::{Intersector, Packing};
use crate::lane::Number;
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use crate::simd::SimdLevel;
use baldwin_weber::BaldwinWeber;
use edge_planes::EdgePlanes;
use glam::Vec3;
use moller_trumbore::MollerTrumbore;
use parametric::Parametric;
use plane_projection::PlaneProjection;
use std::sync::Arc;
use watertight::Watertight;

/// A row of the table: a kernel behind type-erased functions.
pub struct TriangleKernel {
    /// The kernel's description.
    pub info: &'static KernelInfo,
    intersector: fn(&TriangleMesh, Arc<Bvh>, SimdLevel, Packing) -> Box<dyn Intersector>,
    one: fn(&Ray, [Vec3; 3]) -> Option<Hit>,
}

impl TriangleKernel {
    const fn in_f32<K: Kernel>() -> Self {
        Self {
            info: &K::IN_F32,
            intersector: |mesh, bvh, level, packing| {
                let new = MeshIntersector::<K, f32>::new;
                Box::new(new(&K::IN_F32, mesh, bvh, level, packing))
            },
            one: intersect_one::<K, f32>,
        }
    }

    /// As [`in_f32`](Self::in_f32), and traces coherent rays as packets.
    const fn in_f32_with_packets<K: Kernel>() -> Self {
        Self {
            intersector: |mesh, bvh, level, packing| {
                let new = MeshIntersector::<K, f32>::new;
                Box::new(new(&K::IN_F32, mesh, bvh, level, packing).with_packets())
            },
            ..Self::in_f32::<K>()
        }
    }

    const fn in_f64<K: Kernel>() -> Self {
        Self {
            info: &K::IN_F64,
            intersector: |mesh, bvh, level, packing| {
                let new = MeshIntersector::<K, f64>::new;
                Box::new(new(&K::IN_F64, mesh, bvh, level, packing))
            },
            one: intersect_one::<K, f64>,
        }
    }

    const fn exact() -> Self {
        Self {
            info: &exact::INFO,
            intersector: |mesh, bvh, level, packing| {
                Box::new(ExactIntersector::new(mesh, bvh, level, packing))
            },
            one: exact::intersect_one,
        }
    }

    /// Packs a mesh for this kernel and returns its intersector.
    pub fn intersector(
        &self,
        mesh: &TriangleMesh,
        bvh: Arc<Bvh>,
        level: SimdLevel,
        packing: Packing,
    ) -> Box<dyn Intersector> {
        (self.intersector)(mesh, bvh, level, packing)
    }

    /// Tests one triangle in scalar arithmetic, bit for bit as the SIMD lanes do.
    ///
    /// The hit's `primitive` is 0. The ray's `exclude` and the triangle's box are ignored.
    pub fn intersect(&self, ray: &Ray, corners: [Vec3; 3]) -> Option<Hit> {
        (self.one)(ray, corners)
    }
}

/// All triangle kernels, ordered by algorithm, the tiers last.
pub static TRIANGLE_KERNELS: &[TriangleKernel] = &[
    TriangleKernel::in_f32::<PlaneProjection>(),
    TriangleKernel::in_f64::<PlaneProjection>(),
    TriangleKernel::in_f32::<Parametric>(),
    TriangleKernel::in_f64::<Parametric>(),
    TriangleKernel::in_f32::<EdgePlanes>(),
    TriangleKernel::in_f64::<EdgePlanes>(),
    TriangleKernel::in_f32::<BaldwinWeber>(),
    TriangleKernel::in_f64::<BaldwinWeber>(),
    TriangleKernel::in_f32_with_packets::<MollerTrumbore>(),
    TriangleKernel::in_f64::<MollerTrumbore>(),
    TriangleKernel::in_f32_with_packets::<Watertight>(),
    TriangleKernel::in_f64::<Watertight>(),
    TriangleKernel::exact(),
];

/// The kernel with this name, or the one that serves the tier with this name.
pub fn triangle_kernel(name: &str) -> Option<&'static TriangleKernel> {
    let by_tier = |kernel: &TriangleKernel| kernel.info.tier.is_some_and(|t| t.name() == name);
    let by_name = |kernel: &TriangleKernel| kernel.info.name == name;
    TRIANGLE_KERNELS
        .iter()
        .find(|kernel| by_name(kernel) || by_tier(kernel))
}

/// The default kernel: watertight.
pub fn default_triangle_kernel() -> &'static TriangleKernel {
    triangle_kernel(Watertight::IN_F32.name).expect("the default is in the table")
}

/// The kernel whose decisions match exact arithmetic.
pub fn exact_triangle_kernel() -> &'static TriangleKernel {
    triangle_kernel(exact::INFO.name).expect("the exact kernel is in the table")
}

fn intersect_one<K: Kernel, N: Number>(ray: &Ray, corners: [Vec3; 3]) -> Option<Hit> {
    let mut values = [K::Stored::<N>::default(); MAX_VALUES];
    K::pack::<N>(corners, &mut values[..K::VALUES]);
    let prepared = K::prepare::<N>(&RayLanes::of((), ray));
    let [t_min, t_max] = [ray.t_min, ray.t_max].map(N::from);
    let hit = K::intersect(&prepared, &OneTriangle(&values[..K::VALUES]), t_min, t_max)?;
    let [t, u, v] = if hit.doubtful {
        K::decide(ray, corners)?
    } else {
        [hit.t, hit.u, hit.v]
    };
    let is_hit = (hit.mask || hit.doubtful) && t < t_max && t.to_f32().is_finite();
    is_hit.then_some(Hit {
        t: t.to_f32(),
        u: u.to_f32(),
        v: v.to_f32(),
        primitive: 0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::Tier;

    #[test]
    fn kernels_are_found_by_name_and_tier_and_both_are_unique() {
        let answers = |kernel: &TriangleKernel, name: &str| {
            kernel.info.name == name || kernel.info.tier.is_some_and(|tier| tier.name() == name)
        };
        for kernel in TRIANGLE_KERNELS {
            let tier = kernel.info.tier.map(Tier::name);
            for name in [Some(kernel.info.name), tier].into_iter().flatten() {
                let found = triangle_kernel(name).expect("in the table");
                assert!(std::ptr::eq(found, kernel), "{name}");
                let count = TRIANGLE_KERNELS.iter().filter(|k| answers(k, name)).count();
                assert_eq!(count, 1, "{name}");
            }
        }
        assert!(triangle_kernel("no such kernel").is_none());
    }
}
