//! [`Lane`] for SIMD vectors.

use super::{Lane, LaneMask};
use fearless_simd::{Simd, f32x8, f32x16, f64x8, mask32x8, mask32x16, mask64x8, prelude::*};

macro_rules! vector_lane {
    ($vector:ident, $mask:ident, $number:ty, $sign_bit:expr) => {
        impl<S: Simd> LaneMask for $mask<S> {
            #[inline(always)]
            fn any(self) -> bool {
                self.any_true()
            }
            #[inline(always)]
            fn all(self) -> bool {
                self.all_true()
            }
            #[inline(always)]
            fn bits(self) -> u32 {
                self.to_bitmask() as u32
            }
        }

        impl<S: Simd> Lane for $vector<S> {
            type Token = S;
            type Mask = $mask<S>;
            type Number = $number;
            #[inline(always)]
            fn splat(token: S, x: $number) -> Self {
                SimdBase::splat(token, x)
            }
            #[inline(always)]
            fn token(self) -> S {
                ExtractToken::token(&self)
            }
            #[inline(always)]
            fn abs(self) -> Self {
                SimdBase::abs(self)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                SimdFloat::sqrt(self)
            }
            #[inline(always)]
            fn flip(self, sign: Self) -> Self {
                SimdFloat::from_bits(self.to_bits() ^ (sign.to_bits() & $sign_bit))
            }
            #[inline(always)]
            fn lesser(self, other: Self) -> Self {
                self.min(other)
            }
            #[inline(always)]
            fn greater(self, other: Self) -> Self {
                self.max(other)
            }
            #[inline(always)]
            fn lt(self, other: Self) -> Self::Mask {
                self.simd_lt(other)
            }
            #[inline(always)]
            fn le(self, other: Self) -> Self::Mask {
                self.simd_le(other)
            }
            #[inline(always)]
            fn map<const COUNT: usize>(
                values: [Self; COUNT],
                mut of: impl FnMut([$number; COUNT]) -> $number,
            ) -> Self {
                let token = ExtractToken::token(&values[0]);
                let values = values.map(|lanes| lanes.to_array());
                let mut result = values[0];
                for (lane, result) in result.iter_mut().enumerate() {
                    *result = of(values.map(|numbers| numbers[lane]));
                }
                Self::load_array(token, result)
            }
            #[inline(always)]
            fn select(mask: Self::Mask, a: Self, b: Self) -> Self {
                mask.select(a, b)
            }
        }
    };
}

vector_lane!(f32x8, mask32x8, f32, 0x8000_0000u32);
vector_lane!(f32x16, mask32x16, f32, 0x8000_0000u32);
vector_lane!(f64x8, mask64x8, f64, 0x8000_0000_0000_0000u64);
