//! Tests that no ray leaves a closed mesh, that boxes lose no hit, and that spawned rays don't hit their surface.

use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::spawn::default_spawn_policy;
use hitscope_lab::measure::boxes::BOX_CASES;
use hitscope_lab::measure::meshes::mesh_cases;
use hitscope_lab::measure::spawning::spawn_cases;
use rayon::prelude::*;

/// Rays per case and kernel: more than 10⁷ per kernel over all cases. `hitscope lab --case closed` traces 10⁸.
const RAYS: u64 = 200_000;

#[test]
fn no_ray_leaves_a_closed_mesh_with_a_watertight_kernel() {
    let watertight = TRIANGLE_KERNELS
        .iter()
        .filter(|kernel| kernel.info.promises.is_watertight);
    let cases = mesh_cases();
    assert!(cases.len() as u64 * RAYS > 10_000_000, "{}", cases.len());
    let pairs: Vec<_> = watertight
        .flat_map(|k| cases.iter().map(move |case| (k, case)))
        .collect();
    let cells: Vec<_> = pairs
        .par_iter()
        .map(|(kernel, case)| case.measure(kernel, RAYS, 3))
        .collect();
    for cell in cells {
        assert_eq!((cell.n, cell.missed), (RAYS, 0), "{cell:?}");
    }
}

#[test]
fn no_box_test_loses_a_hit() {
    BOX_CASES.par_iter().for_each(|case| {
        let cell = case.measure(10_000, 5);
        assert!(cell.n >= 10_000, "{cell:?}");
        assert_eq!(cell.lost, 0, "{cell:?}");
    });
}

#[test]
fn no_ray_spawned_by_the_default_policy_hits_its_own_surface() {
    spawn_cases().par_iter().for_each(|case| {
        for kernel in TRIANGLE_KERNELS
            .iter()
            .filter(|k| k.info.promises.is_watertight)
        {
            for cell in case.measure(kernel, 50_000, 5) {
                if cell.policy == default_spawn_policy().name {
                    assert_eq!(cell.self_hits, 0, "{cell:?}");
                }
            }
        }
    });
}
