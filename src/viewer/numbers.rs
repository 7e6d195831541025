//! Number formatting.

pub use hitscope_lab::rounding::significant;

use std::fmt::{Display, LowerExp};
use std::time::Duration;

/// All digits of an f32 or f64, with an exponent instead of many zeros; zero has no sign.
pub fn number(x: impl Into<f64> + Display + LowerExp + Copy) -> String {
    let size = x.into().abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e9).contains(&size) || !size.is_finite() {
        x.to_string()
    } else {
        format!("{x:e}")
    }
}

/// All bits of a number as a hexadecimal float, as C's `%a` writes it: `0x1.8p+1` is 3.
pub fn hexadecimal(x: f64) -> String {
    /// Bits of the fraction of an f64.
    const BITS: u32 = 52;
    if x == 0.0 || !x.is_finite() {
        return number(x);
    }
    let bits = x.abs().to_bits();
    let (mut exponent, mut fraction) = ((bits >> BITS) as i32, bits & ((1 << BITS) - 1));
    if exponent == 0 {
        // A subnormal number: its first set bit moves in front of the point.
        let shift = fraction.leading_zeros() - (u64::BITS - 1 - BITS);
        exponent = 1 - shift as i32;
        fraction = fraction << shift & ((1 << BITS) - 1);
    }
    let digits = format!("{fraction:013x}");
    let digits = digits.trim_end_matches('0');
    let point = if digits.is_empty() { "" } else { "." };
    let sign = if x < 0.0 { "-" } else { "" };
    format!("{sign}0x1{point}{digits}p{:+}", exponent - 1023)
}

/// A time in seconds, or in milliseconds if it is shorter than one second.
pub fn duration(time: Duration) -> String {
    let secs = time.as_secs_f64();
    if secs < 1.0 {
        format!("{:.1} ms", secs * 1e3)
    } else {
        format!("{secs:.2} s")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_times_are_in_seconds() {
        assert_eq!(duration(Duration::from_micros(1_250)), "1.2 ms");
        assert_eq!(duration(Duration::from_millis(3_456)), "3.46 s");
    }

    #[test]
    fn small_and_large_numbers_have_an_exponent_and_zero_has_no_sign() {
        assert_eq!(number(1.456_372_9e-12_f32), "1.4563729e-12");
        assert_eq!(number(-0.0_f32), "0");
        assert_eq!(number(0.25_f32), "0.25");
        assert_eq!(number(-500_000.001_f64), "-500000.001");
        assert_eq!(number(3e38_f32), "3e38");
        assert_eq!(number(f64::NEG_INFINITY), "-inf");
    }

    #[test]
    fn hexadecimal_floats_have_all_bits() {
        for (x, text) in [
            (3.0, "0x1.8p+1"),
            (-0.1, "-0x1.999999999999ap-4"),
            (f64::from(0.1_f32), "0x1.99999ap-4"),
            (1.0, "0x1p+0"),
            (0.0, "0"),
            (f64::MIN_POSITIVE, "0x1p-1022"),
            (5e-324, "0x1p-1074"),
            (1.5 * f64::MIN_POSITIVE / 8.0, "0x1.8p-1025"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(hexadecimal(x), text);
        }
    }
}
