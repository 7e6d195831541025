//! Numbers rounded for text.

/// A number rounded to significant digits, at least one; zero has no sign.
///
/// Numbers below 1e-4, and those with more digits before the point than `digits`, have an exponent.
pub fn significant(x: f64, digits: usize) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let scientific = format!("{x:.*e}", digits - 1);
    let exponent = scientific.split('e').nth(1);
    match exponent.and_then(|exponent| exponent.parse::<i32>().ok()) {
        Some(exponent) if (-4..digits as i32).contains(&exponent) => {
            format!("{x:.*}", (digits as i32 - 1 - exponent) as usize)
        }
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_keeps_significant_digits() {
        assert_eq!(significant(0.333_333_333_333, 9), "0.333333333");
        assert_eq!(significant(-1e-17, 9), "-1.00000000e-17");
        assert_eq!(significant(-0.0, 9), "0");
        assert_eq!(significant(9.999_999_999_9, 3), "10.0");
        assert_eq!(significant(123_456.0, 3), "1.23e5");
    }
}
