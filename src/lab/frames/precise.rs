//! Sums in twice the precision of f64.

/// A number as the sum of two f64, accurate to about 100 bits; `high` is the rounded sum.
#[derive(Clone, Copy, Debug)]
pub(super) struct Precise {
    pub high: f64,
    low: f64,
}

impl Precise {
    /// a + b, exactly. Source: Knuth, The Art of Computer Programming 2, 4.2.2, theorem B.
    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        Self {
            high,
            low: (a - (high - part)) + (b - part),
        }
    }

    /// a + b + c·d, to about 100 bits.
    pub fn sum_with_product(a: f64, b: f64, c: f64, d: f64) -> Self {
        if c == 0.0 {
            return Self::sum(a, b);
        }
        let product = c * d;
        // A fused multiplication rounds once, so that this is the exact error of the product.
        let product_error = c.mul_add(d, -product);
        let (sum, total) = (Self::sum(a, b), Self::sum(a + b, product));
        Self::sum(total.high, total.low + (sum.low + product_error))
    }

    /// The error of a rounded number: how much it is larger.
    pub fn error_of(self, rounded: f32) -> f64 {
        (f64::from(rounded) - self.high) - self.low
    }
}
