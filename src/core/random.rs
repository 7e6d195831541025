//! Pseudorandom numbers, reproducible from a seed.

use crate::sampler::mix;
use glam::{DVec3, Vec3};

/// A SplitMix64 generator.
///
/// Source: G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014.
pub struct Random(u64);

impl Random {
    /// A generator whose sequence depends only on the seed.
    pub fn new(seed: u64) -> Self {
        Self(mix(seed))
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        // 2⁶⁴ divided by the golden ratio, as in the paper.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.0)
    }

    /// An index in `0..count`; the bias is below `count`/2⁶⁴.
    pub fn index(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// A number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// A point distributed uniformly in the cube [−1, 1)³.
    pub fn in_cube(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    /// A unit vector distributed uniformly over the sphere.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.in_cube();
            let squared = p.length_squared();
            if squared > 1e-4 && squared <= 1.0 {
                return p / squared.sqrt();
            }
        }
    }

    /// [`in_cube`](Self::in_cube), rounded to f32.
    pub fn in_cube_f32(&mut self) -> Vec3 {
        self.in_cube().as_vec3()
    }
}
