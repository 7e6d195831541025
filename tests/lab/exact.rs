//! Tests of kernels' promises against the oracle: all cases, and the order of hits.

use hitscope_core::kernel::{TRIANGLE_KERNELS, TriangleKernel};
use hitscope_lab::measure::cases::{Case, triangle_cases};
use hitscope_lab::measure::contestants::Contestant;
use hitscope_lab::measure::order::ORDER_CASES;
use hitscope_lab::measure::triangles::{self, TriangleCell};
use rayon::prelude::*;

/// Rays per case, for a few seconds of tests; `hitscope lab` uses 100 000.
const RAYS: u64 = 4_000;
const SEED: u64 = 7;

fn promising(is_promised: impl Fn(&TriangleKernel) -> bool) -> Vec<Contestant> {
    let kernels = TRIANGLE_KERNELS.iter().filter(|kernel| is_promised(kernel));
    kernels.map(Contestant::Kernel).collect()
}

fn measured(contestants: &[Contestant], is_wanted: impl Fn(&Case) -> bool) -> Vec<TriangleCell> {
    let cases: Vec<Case> = triangle_cases().into_iter().filter(is_wanted).collect();
    let cells = cases
        .par_iter()
        .flat_map(|case| triangles::measure(case, contestants, RAYS, SEED));
    cells.collect()
}

#[test]
fn exact_kernels_agree_with_the_oracle_and_t_is_within_half_an_ulp_in_every_case() {
    let cells = measured(&promising(|kernel| kernel.info.promises.is_exact), |_| true);
    assert!(cells.len() > 100);
    for cell in &cells {
        assert_eq!(cell.wrong(), 0, "{cell:?}");
        assert_eq!(cell.non_finite, 0, "{cell:?}");
        // Half an ulp, plus the 2⁻⁷ that is accepted for f64.
        assert!(cell.t_ulps.is_none_or(|t| t.max <= 0.51), "{cell:?}");
        // u and v have errors of 2⁻²⁵, 1 − u − v of twice that.
        let bound = 2.0 / f64::from(1 << 25) * 1.01;
        assert!(
            cell.barycentric_error.is_none_or(|w| w.max <= bound),
            "{cell:?}"
        );
    }
    // The cases aren't all misses.
    assert!(cells.iter().map(|cell| cell.hits).sum::<u64>() > 100_000);
}

#[test]
fn accurate_kernels_decide_correctly_and_t_is_within_an_ulp_in_every_case() {
    let accurate = promising(|kernel| kernel.info.promises.is_accurate);
    let cells = measured(&accurate, |_| true);
    assert!(cells.len() > 100, "{}", cells.len());
    for cell in &cells {
        assert_eq!((cell.wrong(), cell.non_finite), (0, 0), "{cell:?}");
        assert!(cell.t_ulps.is_none_or(|t| t.max <= 0.51), "{cell:?}");
    }
}

#[test]
fn watertight_kernels_decide_correctly_in_every_case() {
    let watertight = promising(|kernel| kernel.info.promises.is_watertight);
    for cell in &measured(&watertight, |_| true) {
        assert_eq!((cell.wrong(), cell.non_finite), (0, 0), "{cell:?}");
        // 513u, where an ulp is u to 2u of t; at subnormal t, an ulp is the spacing of f32.
        assert!(cell.t_ulps.is_none_or(|t| t.max <= 513.0), "{cell:?}");
    }
}

#[test]
fn the_nearest_triangle_and_all_crossings_agree_with_the_oracle() {
    let exact = TRIANGLE_KERNELS
        .iter()
        .filter(|kernel| kernel.info.promises.is_exact);
    let exact: Vec<&TriangleKernel> = exact.collect();
    let cells: Vec<_> = ORDER_CASES
        .par_iter()
        .flat_map(|case| case.measure(&exact, RAYS, SEED))
        .collect();
    for cell in &cells {
        assert_eq!(
            (cell.wrong_nearest, cell.wrong_crossings),
            (0, 0),
            "{cell:?}"
        );
    }
    assert!(cells.iter().map(|cell| cell.ties).sum::<u64>() > 1_000);
}
