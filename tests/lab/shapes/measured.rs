//! The lab's cases of solids.

use hitscope_core::group::{CSG_KERNELS, SOLID_INFO};
use hitscope_lab::measure::shapes::shape_cases;

#[test]
fn the_cases_of_solids_show_wrong_decisions_of_the_fast_kernel_and_none_of_the_exact_one() {
    let prefix = format!("shape-{}-", SOLID_INFO.name);
    let cases = shape_cases().into_iter();
    let cases: Vec<_> = cases
        .filter(|case| case.name.starts_with(&prefix))
        .collect();
    assert_eq!(cases.len(), 8);
    let mut wrong_of_fast = 0;
    for case in cases {
        let cells = case.measure(400, 1);
        let kernels: Vec<&str> = cells.iter().map(|cell| cell.kernel).collect();
        assert_eq!(kernels, CSG_KERNELS.map(|info| info.name), "{}", case.name);
        let (fast, exact) = (&cells[0], &cells[3]);
        assert_eq!((exact.shape, exact.n), (SOLID_INFO.name, 100));
        assert!(exact.hits > 0, "{}", case.name);
        assert_eq!(exact.wrong(), 0, "{}", case.name);
        // t is rounded once.
        let error = exact.t_ulps.expect("hits").max;
        assert!(error <= 0.5, "{}: {error}", case.name);
        wrong_of_fast += fast.wrong();
    }
    assert!(wrong_of_fast > 0);
}
