//! Tests of intervals and dyadic numbers.

use super::super::dyadic::{Dyadic, F32, F64};
use super::super::interval::Interval;
use super::super::ring::Ring;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::cmp::Ordering;

/// Any finite f64: uniform bits, small numbers, and numbers close to a limit of the format.
fn number() -> impl Strategy<Value = f64> {
    let finite = |bits: u64| {
        let x = f64::from_bits(bits);
        if x.is_finite() { x } else { f64::MAX }
    };
    prop_oneof![
        any::<u64>().prop_map(finite),
        (-1e3..1e3f64),
        (-8i32..8).prop_map(f64::from),
        (0u64..1 << 54).prop_map(f64::from_bits),
        (0u64..1 << 54).prop_map(move |bits| -f64::from_bits(bits)),
        (0u64..1 << 54).prop_map(move |bits| finite(f64::MAX.to_bits() - bits)),
        any::<f32>().prop_map(move |x| finite(f64::from(x).to_bits())),
    ]
}

/// Whether the interval contains the exact number.
fn encloses(interval: Interval, exact: &Dyadic) -> bool {
    let Interval { lo, hi } = interval;
    let is_above = lo.is_nan() || lo == f64::NEG_INFINITY || Dyadic::from(lo) <= *exact;
    let is_below = hi.is_nan() || hi == f64::INFINITY || *exact <= Dyadic::from(hi);
    is_above && is_below && lo != f64::INFINITY && hi != f64::NEG_INFINITY
}

fn interval(a: f64, b: f64) -> Interval {
    Interval {
        lo: a.min(b),
        hi: a.max(b),
    }
}

proptest! {
    // The message of a failure has the numbers; no file is needed.
    #![proptest_config(ProptestConfig {
        cases: 20_000,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    #[test]
    fn intervals_enclose_the_exact_results_of_all_operations(
        a in number(), b in number(), c in number(), d in number(),
    ) {
        let (x, y) = (interval(a, b), interval(c, d));
        for a in [a, b].map(Dyadic::from) {
            prop_assert!(encloses(x.square(), &a.square()));
            for b in [c, d].map(Dyadic::from) {
                prop_assert!(encloses(x + y, &(a.clone() + b.clone())));
                prop_assert!(encloses(x - y, &(a.clone() - b.clone())));
                prop_assert!(encloses(x * y, &(a.clone() * b.clone())));
            }
        }
        prop_assert!(x.square().lo >= 0.0 || x.square() == Interval::WHOLE);
        prop_assert!(!x.contains(0.0) || encloses(x.square(), &Dyadic::from(0)));
    }

    #[test]
    fn quotients_and_square_roots_enclose_the_exact_ones(a in number(), b in number()) {
        let quotient = Interval::point(a) / Interval::point(b);
        let exact = [a, b].map(Dyadic::from);
        if b != 0.0 {
            // lo ≤ a/b ≤ hi, times |b|.
            let size = Dyadic::from(b.abs());
            let a = if b < 0.0 { -exact[0].clone() } else { exact[0].clone() };
            let lo = quotient.lo == f64::NEG_INFINITY || size.times(&quotient.lo.into()) <= a;
            let hi = quotient.hi == f64::INFINITY || a <= size.times(&quotient.hi.into());
            prop_assert!(lo && hi);
        } else {
            prop_assert_eq!(quotient, Interval::WHOLE);
        }
        if a >= 0.0 {
            let root = Interval::point(a).sqrt();
            prop_assert!(Dyadic::from(root.lo).square() <= exact[0]);
            prop_assert!(exact[0] <= Dyadic::from(root.hi).square());
        }
    }

    #[test]
    fn intervals_of_ordinary_numbers_stay_narrow(a in 1e-3..1e3f64, b in 1e-3..1e3f64) {
        let (a, b) = (Interval::point(a), Interval::point(b));
        for x in [a + b, a * b, a / b, a.square(), a.sqrt()] {
            prop_assert!(x.hi - x.lo <= 8.0 * f64::EPSILON * x.lo);
        }
    }

    #[test]
    fn dyadic_numbers_are_rounded_as_ieee_754_rounds(a in number(), b in number()) {
        let [x, y] = [a, b].map(Dyadic::from);
        prop_assert_eq!(x.rounded(F64), a);
        prop_assert_eq!((x.clone() + y.clone()).rounded(F64), a + b);
        prop_assert_eq!((x.clone() - y.clone()).rounded(F64), a - b);
        prop_assert_eq!((x.clone() * y.clone()).rounded(F64), a * b);
        prop_assert_eq!(x.rounded(F32), f64::from(a as f32));
        prop_assert_eq!(x.cmp(&y), a.partial_cmp(&b).unwrap());
        let sum = x.plus(&y);
        if (a + b).is_finite() {
            let enclosure = sum.enclosure();
            prop_assert!(encloses(enclosure, &sum));
            prop_assert!(enclosure.hi <= enclosure.lo.next_up());
        }
    }
}

#[test]
fn halfway_cases_are_rounded_to_the_even_neighbour() {
    for (x, next) in [
        (1.0, 1.0f64.next_up()),
        (1.0f64.next_up(), 1.0 + 2.0 * f64::EPSILON),
        (0.0, 5e-324),
        (5e-324, 1e-323),
        (-1.0, -(1.0f64.next_down())),
        (f64::MAX, f64::INFINITY),
    ] {
        let middle = F64.middle(x, next);
        let even = if x.to_bits() & 1 == 0 { x } else { next };
        assert_eq!(middle.rounded(F64), even, "{x:e}");
        let slightly = Dyadic::power(-3000);
        let (lower, upper) = if x < next { (x, next) } else { (next, x) };
        assert_eq!(middle.minus(&slightly).rounded(F64), lower, "{x:e}");
        assert_eq!(middle.plus(&slightly).rounded(F64), upper, "{x:e}");
    }
}

#[test]
fn exact_zeros_stay_exact_and_overflow_is_unbounded() {
    let (zero, one, huge) = (
        Interval::ZERO,
        Interval::point(0.1),
        Interval::point(f64::MAX),
    );
    assert!((zero * one).is_zero() && (one - one).is_zero() && (zero / one).is_zero());
    assert!((zero + zero.square() + zero.sqrt()).is_zero());
    assert_eq!(huge * huge, Interval::WHOLE);
    assert_eq!(Interval::WHOLE * zero, Interval::ZERO);
    assert_eq!(Interval::WHOLE - Interval::WHOLE, Interval::WHOLE);
    assert_eq!((huge + huge).without_nan(), Interval::WHOLE);
    assert_eq!((huge + huge - huge).sign(), None);
    assert_eq!((huge + huge).square(), Interval::WHOLE);
    assert_eq!((huge + huge).sqrt().sign(), None);
    assert_eq!(Interval::from(f64::NAN), Interval::WHOLE);
    assert_eq!(Interval::from(f32::INFINITY), Interval::WHOLE);
    assert_eq!(Interval::WHOLE.sign(), None);
    assert_eq!(
        (one - Interval::point(0.05)).sign(),
        Some(Ordering::Greater)
    );
}
