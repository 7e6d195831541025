//! Quantiles and rates.

use serde::Serialize;

/// Median, 99th percentile and maximum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quantiles {
    /// The median.
    pub p50: f64,
    /// The 99th percentile.
    pub p99: f64,
    /// The maximum.
    pub max: f64,
}

impl Quantiles {
    /// The quantiles of finite numbers; `None` if there are none.
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_unstable_by(f64::total_cmp);
        let at = |part: f64| values[((values.len() - 1) as f64 * part).ceil() as usize];
        (!values.is_empty()).then(|| Self {
            p50: at(0.5),
            p99: at(0.99),
            max: at(1.0),
        })
    }
}

/// `count` of `n` as a rate per million.
pub fn per_million(count: u64, n: u64) -> f64 {
    count as f64 / (n.max(1) as f64) * 1e6
}

/// The upper bound per million, with 95 % confidence, if there are no failures among `n`: 3/n.
///
/// Source: Hanley, Lippman-Hand, "If Nothing Goes Wrong, Is Everything All Right?", JAMA 249(13), 1983.
pub fn bound_per_million(n: u64) -> f64 {
    per_million(3, n)
}

/// A rate per million, such as `12`; with its upper bound if it is zero, such as `0 (<30.0)`.
pub fn rate_text(count: u64, n: u64) -> String {
    if count == 0 {
        format!("0 (<{})", short(bound_per_million(n)))
    } else {
        short(per_million(count, n))
    }
}

/// Rays per second; a dash for 0, where there were no rays.
pub fn speed_text(rate: f64) -> String {
    if rate > 0.0 {
        short(rate)
    } else {
        "–".to_owned()
    }
}

/// A number with about three digits, such as `0`, `12.3`, `4570`, `1.2e5`.
pub fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".to_owned()
    } else if !(0.01..99_999.5).contains(&size) {
        format!("{x:.1e}")
    } else if size >= 99.95 {
        format!("{x:.0}")
    } else if size >= 9.995 {
        format!("{x:.1}")
    } else {
        format!("{x:.2}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_values_of_the_sample() {
        let values: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        let quantiles = Quantiles::of(values).expect("not empty");
        assert_eq!(
            (quantiles.p50, quantiles.p99, quantiles.max),
            (50.0, 99.0, 100.0)
        );
        assert_eq!(Quantiles::of(vec![]), None);
        let one = Quantiles::of(vec![2.0]).expect("not empty");
        assert_eq!((one.p50, one.max), (2.0, 2.0));
    }

    #[test]
    fn a_rate_of_zero_is_shown_with_its_bound() {
        assert_eq!(rate_text(0, 1_000_000), "0 (<3.00)");
        assert_eq!(rate_text(5, 1_000_000), "5.00");
        assert_eq!(rate_text(250_000, 1_000_000), "2.5e5");
    }
}
