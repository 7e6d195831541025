//! How far the mesh deviates from the decimals in the file, computed in exact arithmetic.

use super::{STRICT, parse};
use dashu_int::IBig;
use hitscope_core::obj::Loaded;
use hitscope_core::random::Random;

/// Decimals and binary fractions as multiples of 10⁻⁶⁰·2⁻²⁰⁰.
const DECIMALS: usize = 60;
const BITS: i32 = 200;

fn of_decimal(word: &str) -> IBig {
    let (mantissa, exponent) = word.split_once('e').unwrap_or((word, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: IBig = format!("{whole}{fraction}").parse().expect("digits");
    let exponent: isize = exponent.parse().expect("an exponent");
    let power = DECIMALS as isize + exponent - fraction.len() as isize;
    digits
        * IBig::from(10).pow(usize::try_from(power).expect("few decimals"))
        * (IBig::ONE << BITS as usize)
}

fn of_f64(x: f64) -> IBig {
    let bits = x.abs().to_bits();
    let exponent = ((bits >> 52) as i32).max(1);
    let hidden = u64::from(bits >> 52 > 0) << 52;
    let whole = IBig::from(bits & ((1 << 52) - 1) | hidden);
    let shift = exponent - 1075 + BITS;
    let value = if x == 0.0 {
        IBig::ZERO
    } else {
        whole << usize::try_from(shift).expect("not that small")
    };
    let value = value * IBig::from(10).pow(DECIMALS);
    if x < 0.0 { -value } else { value }
}

/// The largest error of a coordinate relative to its decimal.
fn exact_rounding(loaded: &Loaded, vertices: &[[String; 3]]) -> IBig {
    let mesh = &loaded.mesh;
    let mut most = IBig::ZERO;
    for (position, words) in mesh.positions().iter().zip(vertices) {
        for axis in 0..3 {
            let used = of_f64(f64::from(position[axis])) + of_f64(mesh.origin()[axis]);
            let distance = used - of_decimal(&words[axis]);
            most = most.max(if distance < IBig::ZERO {
                -distance
            } else {
                distance
            });
        }
    }
    most
}

fn load(vertices: &[[String; 3]]) -> Loaded {
    let mut text: String = vertices
        .iter()
        .map(|words| format!("v {}\n", words.join(" ")))
        .collect();
    text += "f 1 2 3\n";
    parse(text.as_bytes(), STRICT).unwrap_or_else(|error| panic!("{text}{error}"))
}

fn words(vertices: [[&str; 3]; 3]) -> Vec<[String; 3]> {
    vertices.map(|words| words.map(str::to_owned)).to_vec()
}

#[test]
fn exact_coordinates_have_a_rounding_of_zero() {
    let exact = words([
        ["1", "-2.5", "0.0"],
        ["4096.125", "3e2", "1"],
        ["0", "0.0009765625", "12"],
    ]);
    assert_eq!(load(&exact).report.max_rounding, 0.0);
}

#[test]
fn rounding_includes_the_error_of_parsing_decimals() {
    for vertices in [
        words([
            ["1000000000000000.3", "0", "0"],
            ["1000000000000001", "0", "0"],
            ["1000000000000000", "1", "0"],
        ]),
        words([
            ["1.00000000000000011", "0", "0"],
            ["0", "1", "0"],
            ["0", "0", "1"],
        ]),
        words([["0.1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]),
    ] {
        let loaded = load(&vertices);
        let (bound, exact) = (
            of_f64(loaded.report.max_rounding),
            exact_rounding(&loaded, &vertices),
        );
        assert!(
            exact > IBig::ZERO && bound >= exact,
            "{vertices:?}: {}",
            loaded.report.max_rounding
        );
    }
}

#[test]
fn the_bound_holds_for_random_decimals_and_is_tight() {
    let mut random = Random::new(17);
    for _ in 0..2000 {
        let (digits, places) = (1 + random.index(20), random.index(20));
        let far = ["", "1000000", "-987654321"][random.index(3)];
        let mut word = || {
            let digits: String = (0..digits)
                .map(|_| char::from(b'0' + random.index(10) as u8))
                .collect();
            let fraction: String = (0..places)
                .map(|_| char::from(b'0' + random.index(10) as u8))
                .collect();
            format!("{far}{digits}.{fraction}")
        };
        let vertices: Vec<[String; 3]> = (0..3).map(|_| [word(), word(), word()]).collect();
        let text: String = vertices
            .iter()
            .map(|words| format!("v {}\n", words.join(" ")))
            .collect();
        let Ok(loaded) = parse(format!("{text}f 1 2 3\n").as_bytes(), STRICT) else {
            // The triangle's area is zero.
            continue;
        };
        let exact = exact_rounding(&loaded, &vertices);
        let bound = of_f64(loaded.report.max_rounding);
        assert!(
            bound >= exact,
            "{vertices:?}: {}",
            loaded.report.max_rounding
        );
        // The bound exceeds the exact value by at most two ulps of the largest coordinate and the rounding of
        // the sum.
        let largest = loaded
            .mesh
            .positions()
            .iter()
            .map(|p| (p.as_dvec3() + loaded.mesh.origin()).abs().max_element());
        let slack = largest.fold(0.0, f64::max) * 2.0 * f64::EPSILON
            + loaded.report.max_rounding * 8.0 * f64::EPSILON;
        assert!(
            bound - exact <= of_f64(slack),
            "{vertices:?}: {}",
            loaded.report.max_rounding
        );
    }
}
