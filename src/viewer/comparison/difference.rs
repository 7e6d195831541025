//! The picture of the differences between both sides.

use rayon::prelude::*;

/// The absolute differences in each channel, times `gain`. Pixels are sRGB with alpha 255; both pictures have the same
/// size.
pub fn difference_picture(a: &[[u8; 4]], b: &[[u8; 4]], gain: f32) -> Vec<[u8; 4]> {
    let pixel = |(a, b): (&[u8; 4], &[u8; 4])| {
        let channel = |k: usize| (gain * f32::from(a[k].abs_diff(b[k]))).min(255.0) as u8;
        [channel(0), channel(1), channel(2), 255]
    };
    a.par_iter().zip(b).map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_multiplied_and_limited() {
        let (a, b) = (
            [[10, 20, 30, 255]; 2],
            [[12, 20, 0, 255], [10, 20, 30, 255]],
        );
        assert_eq!(
            difference_picture(&a, &b, 10.0),
            [[20, 0, 255, 255], [0, 0, 0, 255]]
        );
    }
}
