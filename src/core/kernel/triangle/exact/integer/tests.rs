//! Tests of the integer predicates.

use super::*;
use crate::random::Random;

const TRIANGLE: [Vec3; 3] = [
    Vec3::new(0.0, 0.0, 0.0),
    Vec3::new(4.0, 0.0, 0.0),
    Vec3::new(0.0, 4.0, 0.0),
];

fn ray(origin: [f32; 3], dir: [f32; 3]) -> Ray {
    Ray::new(origin.into(), dir.into()).expect("a ray")
}

#[test]
fn t_u_and_v_of_a_known_hit_are_correct_from_both_sides() {
    for z in [3.0, -3.0] {
        let ray = ray([1.0, 2.0, z], [0.0, 0.0, -z]);
        assert!(is_inside(&ray, TRIANGLE));
        assert_eq!(rounded(&ray, TRIANGLE), [1.0, 0.25, 0.5]);
        assert_eq!(compare_with(&ray, TRIANGLE, 1.0), Ordering::Equal);
        assert_eq!(
            compare_with(&ray, TRIANGLE, 1.0f32.next_up()),
            Ordering::Less
        );
        assert_eq!(compare_with(&ray, TRIANGLE, -1e-45), Ordering::Greater);
    }
    assert!(
        is_inside(&ray([2.0, 2.0, 1.0], [0.0, 0.0, -1.0]), TRIANGLE),
        "on BC"
    );
    let outside = ray([2.0, 2.0f32.next_up(), 1.0], [0.0, 0.0, -1.0]);
    assert!(!is_inside(&outside, TRIANGLE));
    assert!(
        !is_inside(&ray([-1.0, 1.0, 0.0], [1.0, 0.0, 0.0]), TRIANGLE),
        "in its plane"
    );
}

#[test]
fn quotients_keep_sign_and_exponent_at_the_ends_of_the_range() {
    let whole = |x: i32| IBig::from(x);
    assert_eq!(quotient(&whole(-3), &whole(4), 0), -0.75);
    assert_eq!(quotient(&whole(3), &whole(-4), 2), -3.0);
    assert_eq!(quotient(&whole(0), &whole(7), 5), 0.0);
    for exponent in [-800, -301, 300, 801] {
        let expected = 2f64.powi(exponent / 2) * 2f64.powi(exponent - exponent / 2);
        assert_eq!(quotient(&whole(5), &whole(5), exponent), expected);
    }
    assert_eq!(quotient(&whole(1), &whole(3), 0), 1.0 / 3.0);
}

#[test]
fn mantissa_and_exponent_recover_the_number() {
    for x in [
        0.0,
        -0.0,
        1.0,
        -1.5,
        f32::MAX,
        f32::MIN_POSITIVE,
        1e-45,
        -1e-40,
    ] {
        let (mantissa, exponent) = decode(x);
        assert_eq!(f64::from(mantissa) * 2f64.powi(exponent), f64::from(x));
    }
}

#[test]
fn integers_of_128_bits_decide_like_those_of_any_size() {
    let mut random = Random::new(1);
    let (mut narrow, mut inside) = (0, 0);
    for _ in 0..20_000 {
        // Mantissas of up to 24 bits; exponents as far apart as just fits.
        let spread = random.index(18) as i32;
        let mut point = || {
            let number = |random: &mut Random| {
                let exponent = random.index(spread as usize + 1) as i32;
                (random.signed() * 2f64.powi(exponent)) as f32
            };
            Vec3::from_array([(); 3].map(|()| number(&mut random)))
        };
        let corners = [point(), point(), point()];
        let target = (corners[0] + corners[1] + corners[2]) / 3.0;
        let origin = point();
        let Ok(ray) = Ray::new(origin, target - origin) else {
            continue;
        };
        let lengths = Span::of(&[ray.origin, corners[0], corners[1], corners[2]]);
        let dirs = Span::of(&[ray.dir]);
        if dirs.bits + 2 * lengths.bits + 7 <= 127 {
            let in_128 = is_inside_in::<i128>(&ray, corners, lengths, dirs);
            assert_eq!(in_128, is_inside_in::<IBig>(&ray, corners, lengths, dirs));
            narrow += 1;
            inside += u32::from(in_128);
        }
    }
    assert!(narrow > 5_000 && inside > 1_000, "{narrow} {inside}");
}

/// A point with whole coordinates of up to `bits` bits, with the last bit set now and then.
fn whole_point(random: &mut Random, bits: usize) -> Vec3 {
    Vec3::from_array([(); 3].map(|()| {
        let exponent = [bits - 24, random.index(bits - 23), 0][random.index(3)];
        (random.signed() * 2f64.powi(24)) as i32 as f32 * 2f32.powi(exponent as i32)
    }))
}

#[test]
fn the_choice_of_integer_size_changes_no_decision() {
    // Bit lengths on both sides of what 128 bits hold; an overflow would panic or flip a sign.
    let mut random = Random::new(2);
    let (mut near_limit, mut nearly_compared) = (0, 0);
    for _ in 0..20_000 {
        let (long, short) = (24 + random.index(40), 24 + random.index(20));
        let first = [(); 3].map(|()| whole_point(&mut random, long));
        let origin = whole_point(&mut random, long);
        let dir = whole_point(&mut random, short) * 2f32.powi(-30);
        let Ok(ray) = Ray::new(origin, dir) else {
            continue;
        };
        let [a, b, c] = first;
        let lengths = Span::of(&[ray.origin, a, b, c]);
        let dirs = Span::of(&[ray.dir]);
        let expected = is_inside_in::<IBig>(&ray, first, lengths, dirs);
        assert_eq!(is_inside(&ray, first), expected, "{ray:?} {first:?}");
        near_limit += u32::from((128..=137).contains(&(dirs.bits + 2 * lengths.bits + 7)));

        let short = 24 - random.index(6);
        let exponent = 2f32.powi(-(short as i32));
        let [first, second] =
            [(); 2].map(|()| [(); 3].map(|()| (random.in_cube_f32() / exponent).round()));
        let ray = Ray::new(Vec3::ZERO, dir).expect("a ray");
        let points = [first, second].concat();
        let lengths = Span::of(&points);
        let expected = compare_in::<IBig>(&ray, first, second, lengths, dirs);
        assert_eq!(compare(&ray, first, second), expected, "{ray:?} {points:?}");
        nearly_compared += u32::from((128..=145).contains(&(5 * lengths.bits + dirs.bits + 15)));
    }
    assert!(near_limit > 500, "{near_limit}");
    assert!(nearly_compared > 500, "{nearly_compared}");
}
