//! A ray that the default policy spawns on a primitive doesn't hit the surface that it leaves.
//!
//! `HITSCOPE_SPAWN_RAYS=1000000` spawns that many rays for each kernel, size and offset. By default it is 2000.

use hitscope_core::group::CSG_KERNELS;
use hitscope_core::kernel::{KernelInfo, KernelRow, Tier};
use hitscope_core::shape::{
    AxisBox, AxisPlane, Cone, Cuboid, Cylinder, Disk, Plane, Quadric, Rectangle, Sphere, Torus,
    Triangle,
};
use hitscope_lab::measure::shapes::{
    Sampled, ShapeSpawnCell, SpawnPlace, measure_solid_spawning, measure_spawning, spawn_places,
};
use rayon::prelude::*;

fn ray_count() -> u64 {
    let count = std::env::var("HITSCOPE_SPAWN_RAYS").ok();
    count.and_then(|count| count.parse().ok()).unwrap_or(2_000)
}

fn spawned_rays_leave<S: Sampled>() {
    let kernels: Vec<&KernelRow<S>> = TIERS.iter().map(|&tier| S::kernel_of(tier)).collect();
    check(|case, place, seed| measure_spawning(case, &kernels, place, ray_count(), seed));
}

const TIERS: [Tier; 3] = [Tier::Watertight, Tier::Precise, Tier::Exact];

/// Measures at every place, prints the results, and fails if there are self-hits.
fn check(measure: impl Fn(&str, SpawnPlace, u64) -> Vec<ShapeSpawnCell> + Send + Sync) {
    let places: Vec<_> = spawn_places().into_iter().enumerate().collect();
    let cells = places.into_par_iter().flat_map_iter(|(seed, place)| {
        let case = format!("size {:e}, offset {:e}", place.size, place.offset);
        measure(&case, place, seed as u64)
    });
    let cells: Vec<_> = cells.collect();
    let mut failures = Vec::new();
    for cell in &cells {
        let line = format!(
            "{}, {}, {}: {} self-hits of {}, {} beyond edges, heights {:.1e}, {:.1e}",
            cell.shape,
            cell.kernel,
            cell.case,
            cell.self_hits,
            cell.n,
            cell.edge_hits,
            cell.height_p50,
            cell.height_max
        );
        eprintln!("{line}");
        if cell.self_hits > 0 {
            failures.push(line);
        }
    }
    assert!(cells.iter().map(|cell| cell.n).sum::<u64>() > 10 * ray_count());
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn rays_that_leave_a_solid_miss_its_surface() {
    let of_tier = |info: &&&KernelInfo| info.tier.is_some_and(|tier| TIERS.contains(&tier));
    let kernels: Vec<&KernelInfo> = CSG_KERNELS.iter().filter(of_tier).copied().collect();
    check(|case, place, seed| measure_solid_spawning(case, &kernels, place, ray_count(), seed));
}

macro_rules! shapes_leave {
    ($($test:ident: $shape:ty),*) => {
        $(#[test]
        fn $test() {
            spawned_rays_leave::<$shape>();
        })*
    };
}

shapes_leave!(
    rays_that_leave_a_triangle_miss_it: Triangle,
    rays_that_leave_a_sphere_miss_its_surface: Sphere,
    rays_that_leave_a_plane_miss_it: Plane,
    rays_that_leave_a_disk_miss_it: Disk,
    rays_that_leave_a_rectangle_miss_it: Rectangle,
    rays_that_leave_a_box_miss_its_surface: Cuboid,
    rays_that_leave_an_aligned_plane_miss_it: AxisPlane,
    rays_that_leave_an_aligned_box_miss_its_surface: AxisBox,
    rays_that_leave_a_cylinder_miss_its_surface: Cylinder,
    rays_that_leave_a_cone_miss_its_surface: Cone,
    rays_that_leave_a_quadric_miss_its_surface: Quadric,
    rays_that_leave_a_torus_miss_its_surface: Torus
);
