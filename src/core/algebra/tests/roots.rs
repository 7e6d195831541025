//! Tests of roots: products of known factors, against the factors.

use super::super::algebraic::{Algebraic, Root};
use super::super::dyadic::Dyadic;
use super::super::interval::Interval;
use super::super::interval_roots::isolated_roots;
use super::super::polynomial::Polynomial;
use super::super::ring::Ring;
use crate::random::Random;
use std::cmp::Ordering;

type Exact = Polynomial<Dyadic>;

fn line(root: f64) -> Exact {
    Polynomial::new([-Dyadic::from(root), Dyadic::from(1)])
}

fn product(factors: &[Exact]) -> Exact {
    let one = Polynomial::constant(Dyadic::from(1));
    factors.iter().fold(one, |p, factor| p.times(factor))
}

fn with_roots(roots: &[f64]) -> Exact {
    product(&roots.iter().map(|x| line(*x)).collect::<Vec<_>>())
}

fn integers<const N: usize>(coefficients: [i32; N]) -> Exact {
    Polynomial::new(coefficients.map(Dyadic::from))
}

/// Checks values, order and multiplicities of the roots of a polynomial with the given roots.
fn check(roots: &[f64], p: &Exact) {
    let mut sorted = roots.to_vec();
    sorted.sort_by(f64::total_cmp);
    let mut distinct = sorted.clone();
    distinct.dedup();
    let mut found = Root::all(p);
    assert_eq!(found.len(), distinct.len(), "{sorted:?}");
    for (root, x) in found.iter_mut().zip(&distinct) {
        assert_eq!(
            root.value.compare_with(&Dyadic::from(*x)),
            Ordering::Equal,
            "{sorted:?}"
        );
        assert_eq!(root.value.nearest_f64(), *x, "{sorted:?}");
        assert_eq!(root.value.nearest_f32(), *x as f32, "{sorted:?}");
        assert_eq!(root.value.enclosure(), Interval::point(*x), "{sorted:?}");
        let multiplicity = sorted.iter().filter(|y| *y == x).count();
        assert_eq!(root.multiplicity, multiplicity, "{sorted:?}");
        assert_eq!(root.value.sign_of(p), Ordering::Equal);
        assert_eq!(root.value.sign_of(&line(x.next_down())), Ordering::Greater);
        assert_eq!(root.value.sign_of(&line(x.next_up())), Ordering::Less);
    }
    // Intervals may refuse, but must not contradict.
    if let Some(intervals) = isolated_roots(&p.enclosure()) {
        assert_eq!(intervals.len(), sorted.len(), "{sorted:?}");
        assert!(
            intervals.iter().zip(&sorted).all(|(i, x)| i.contains(*x)),
            "{sorted:?}"
        );
    }
}

#[test]
fn products_of_known_factors_have_their_roots() {
    let mut random = Random::new(1);
    for case in 0..4000 {
        let count = 1 + case % 4;
        let scale = 2f64.powi(random.index(200) as i32 - 100);
        let mut pick = |previous: &[f64]| match (random.index(6), previous) {
            (0, [.., last]) => *last,
            (1, [.., last]) => last.next_up(),
            (2, [.., last]) => last * (1.0 + 1e-12),
            (3, _) => random.signed() * scale * 1e-20,
            (4, _) => (random.index(9) as f64) - 4.0,
            _ => random.signed() * scale,
        };
        let mut roots = Vec::new();
        for _ in 0..count {
            let root = pick(&roots);
            roots.push(root);
        }
        // A factor without real roots changes nothing.
        let p = with_roots(&roots).scaled(&Dyadic::from(-3.7e-40 * scale));
        check(&roots, &p);
        if count <= 2 {
            check(&roots, &p.times(&integers([5, -2, 1])));
        }
    }
}

#[test]
fn multiple_roots_and_clusters_are_told_apart() {
    let close = 1.0 + 1e-12;
    for roots in [
        [0.0; 4],
        [1.5; 4],
        [1.0, 1.0, 1.0, close],
        [1.0, 1.0, close, close],
        [1.0, close, 1.0 + 2e-12, 1.0 + 3e-12],
        [-1e30, 1e-30, 2e-30, 1e30],
        [0.0, 0.0, 1e-300, 1e300],
        [-1.0, 0.0, 1.0, 1.0f64.next_up()],
    ] {
        check(&roots, &with_roots(&roots));
        check(&roots[1..], &with_roots(&roots[1..]));
    }
}

#[test]
fn polynomials_without_real_roots_have_none() {
    for p in [
        integers([0]),
        integers([0, 0, 0]),
        integers([7]),
        integers([1, 0, 1]),
        integers([-1, 0, -1]),
        integers([1, 0, 0, 0, 1]),
        integers([1, 0, 2, 0, 1]),
        integers([5, 0, 0]),
    ] {
        assert!(Root::all(&p).is_empty(), "{p:?}");
        if let Some(roots) = isolated_roots(&p.enclosure()) {
            assert!(roots.is_empty(), "{p:?}");
        }
    }
}

#[test]
fn the_intervals_decide_well_conditioned_polynomials_with_narrow_bounds() {
    let mut random = Random::new(2);
    let mut refused = 0;
    let case_count = 20_000;
    for case in 0..case_count {
        let roots: Vec<f64> = (0..1 + case % 4).map(|_| random.signed()).collect();
        let p = with_roots(&roots).enclosure();
        let Some(found) = isolated_roots(&p) else {
            refused += 1;
            continue;
        };
        let mut sorted = roots;
        sorted.sort_by(f64::total_cmp);
        assert_eq!(found.len(), sorted.len(), "{sorted:?}");
        for (i, (interval, x)) in found.iter().zip(&sorted).enumerate() {
            assert!(interval.contains(*x), "{sorted:?}");
            let others = sorted.iter().enumerate().filter(|(j, _)| *j != i);
            let condition: f64 = others.map(|(_, y)| 2.0 / (x - y).abs()).product();
            // Horner's rule errs by a few ulps of the sum of the terms' sizes, which is at most 16.
            let bound = 256.0 * f64::EPSILON * condition;
            assert!(
                interval.hi - interval.lo <= bound,
                "{sorted:?} {interval:?}"
            );
        }
    }
    assert!(
        refused * 200 < case_count,
        "{refused} of {case_count} refused"
    );
}

#[test]
fn square_roots_are_rounded_as_the_processor_rounds_them() {
    let mut random = Random::new(3);
    for _ in 0..2000 {
        let x = random.unit() * 2f64.powi(random.index(200) as i32 - 100);
        let p = Polynomial::new([-Dyadic::from(x), Dyadic::zero(), Dyadic::from(1)]);
        let [negative, positive] = &mut Root::all(&p)[..] else {
            panic!("two roots of t² = {x:e}");
        };
        assert_eq!(positive.value.nearest_f64(), x.sqrt());
        assert_eq!(negative.value.nearest_f64(), -x.sqrt());
        let narrow = (x as f32).sqrt();
        let p = Polynomial::new([-Dyadic::from(x as f32), Dyadic::zero(), Dyadic::from(1)]);
        assert_eq!(Root::all(&p)[1].value.nearest_f32(), narrow);
    }
}

#[test]
fn quotients_are_rounded_as_the_processor_rounds_them() {
    let mut random = Random::new(4);
    for _ in 0..5000 {
        let mut number = || random.signed() * 2f64.powi(random.index(1000) as i32 - 500);
        let (a, b) = (number(), number());
        let mut quotient = Algebraic::ratio(&a.into(), &b.into()).unwrap();
        assert_eq!(quotient.nearest_f64(), a / b, "{a:e}/{b:e}");
        // An f32 that under- or overflows asks another question.
        let (a, b) = (a as f32, b as f32);
        if !(a.is_finite() && b.is_finite()) {
            continue;
        }
        if let Some(mut quotient) = Algebraic::ratio(&a.into(), &b.into()) {
            assert_eq!(quotient.nearest_f32(), a / b, "{a:e}/{b:e}");
        }
    }
    assert!(Algebraic::ratio(&Dyadic::from(1), &Dyadic::zero()).is_none());
}

#[test]
fn roots_halfway_between_two_floats_are_rounded_to_the_even_one() {
    for (x, next) in [
        (1.0f64, 1.0f64.next_up()),
        (3.5, 3.5f64.next_up()),
        (5e-324, 1e-323),
    ] {
        let middle = Dyadic::from(x).plus(&next.into()).halved();
        let line = Polynomial::new([-middle, Dyadic::from(1)]);
        let even = if x.to_bits() & 1 == 0 { x } else { next };
        for p in [
            line.clone(),
            line.times(&integers([-2, 0, 1])),
            line.times(&line),
        ] {
            let mut roots = Root::all(&p);
            assert!(
                roots
                    .iter_mut()
                    .any(|root| root.value.nearest_f64() == even),
                "{x:e}"
            );
        }
    }
}

#[test]
fn equal_roots_of_different_polynomials_are_equal() {
    // √2 + √3 is a root of t⁴ − 10t² + 1, and of t⁴ − 10t² + 1 times anything; √2 of t² − 2 and of others.
    let sum = integers([1, 0, -10, 0, 1]);
    let root_of = |p: &Exact, i: usize| Root::all(p).swap_remove(i).value;
    let square = integers([-2, 0, 1]);
    let sqrt_2 = root_of(&square, 1);
    let quartic = square.times(&integers([-3, 0, 1]));
    let cubic = square.times(&integers([-1, 1]));
    assert_eq!(sqrt_2.compare(&root_of(&quartic, 2)), Ordering::Equal);
    assert_eq!(
        root_of(&quartic, 2).compare(&root_of(&cubic, 2)),
        Ordering::Equal
    );
    assert_eq!(sqrt_2.compare(&root_of(&quartic, 3)), Ordering::Less);
    assert_eq!(sqrt_2.compare(&root_of(&cubic, 1)), Ordering::Greater);
    assert_eq!(sqrt_2.sign_of(&quartic), Ordering::Equal);
    assert_eq!(sqrt_2.sign_of(&sum), Ordering::Less);
    assert_eq!(
        root_of(&sum, 3).compare(&root_of(&sum.scaled(&Dyadic::from(7)), 3)),
        Ordering::Equal
    );
    // (√2 + √3)² = 5 + 2√6 lies in none of these, but its neighbours tell the order.
    let expected = 2f64.sqrt() + 3f64.sqrt();
    let sum = root_of(&sum, 3);
    assert_eq!(
        sum.compare_with(&(expected - 1e-15).into()),
        Ordering::Greater
    );
    assert_eq!(sum.compare_with(&(expected + 1e-15).into()), Ordering::Less);
}

#[test]
fn irrational_roots_closer_than_any_float_are_ordered() {
    // √2 and √(2 + 2⁻³⁰⁰), as roots of polynomials of degrees 2 and 4.
    let shifted = Dyadic::from(2).plus(&Dyadic::power(-300));
    let near = integers([-2, 0, 1]);
    let far = Polynomial::new([-shifted, Dyadic::zero(), Dyadic::from(1)]);
    let far_4 = far.times(&integers([-3, 0, 1]));
    let positive = |p: &Exact| {
        Root::all(p)
            .into_iter()
            .map(|root| root.value)
            .find(|x| x.compare_with(&Dyadic::from(1)) == Ordering::Greater)
    };
    let [near, far, far_4] = [near, far, far_4].map(|p| positive(&p).unwrap());
    assert_eq!(near.compare(&far), Ordering::Less);
    assert_eq!(far.compare(&near), Ordering::Greater);
    assert_eq!(near.compare(&far_4), Ordering::Less);
    assert_eq!(far_4.compare(&far), Ordering::Equal);
    let product = with_roots(&[1.0]).times(&integers([-2, 0, 1]));
    assert_eq!(far.sign_of(&product), Ordering::Greater);
    assert_eq!(near.sign_of(&product), Ordering::Equal);
}

#[test]
fn intervals_hold_for_all_members_of_wide_coefficients() {
    let mut random = Random::new(5);
    let mut decided_count = 0;
    for case in 0..10_000 {
        let roots: Vec<f64> = (0..1 + case % 4).map(|_| random.signed()).collect();
        let width = 10f64.powi(-(random.index(8) as i32));
        let wide = with_roots(&roots).enclosure();
        let mut end = |c: Interval| c.lo + width * random.signed();
        let coefficients: [Interval; 5] =
            std::array::from_fn(|i| match wide.coefficients().get(i) {
                Some(c) => {
                    let (a, b) = (end(*c), end(*c));
                    Interval {
                        lo: a.min(b),
                        hi: a.max(b),
                    }
                }
                None => Interval::ZERO,
            });
        let Some(found) = isolated_roots(&Polynomial::new(coefficients)) else {
            continue;
        };
        decided_count += 1;
        for corner in 0..32 {
            let member = |i: usize| match corner >> i & 1 {
                0 => Dyadic::from(coefficients[i].lo),
                _ => Dyadic::from(coefficients[i].hi),
            };
            let exact = Root::all(&Polynomial::new(std::array::from_fn::<_, 5, _>(member)));
            assert_eq!(found.len(), exact.len(), "{coefficients:?}");
            for (interval, root) in found.iter().zip(&exact) {
                let [lo, hi] = [interval.lo, interval.hi].map(Dyadic::from);
                assert_ne!(
                    root.value.compare_with(&lo),
                    Ordering::Less,
                    "{coefficients:?}"
                );
                assert_ne!(
                    root.value.compare_with(&hi),
                    Ordering::Greater,
                    "{coefficients:?}"
                );
            }
        }
    }
    assert!(decided_count > 3000, "{decided_count}");
}
