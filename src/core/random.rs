//! Numbers that look random and never change.

use crate::sampler::mix;
use glam::{DVec3, Vec3};

/// A sequence that its seed determines.
///
/// Source: G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014.
pub struct Random(u64);

impl Random {
    /// Another sequence for each seed.
    pub fn new(seed: u64) -> Self {
        Self(mix(seed))
    }

    /// 64 bits.
    pub fn bits(&mut self) -> u64 {
        // 2⁶⁴ over the golden ratio, as the paper has it.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        mix(self.0)
    }

    /// A number below `count`.
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

    /// A point in the cube from −1 to 1.
    pub fn in_cube(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }

    /// A direction of unit length, every one as likely.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.in_cube();
            let squared = p.length_squared();
            if squared > 1e-4 && squared <= 1.0 {
                return p / squared.sqrt();
            }
        }
    }

    /// The same as in the cube, rounded.
    pub fn in_cube_f32(&mut self) -> Vec3 {
        self.in_cube().as_vec3()
    }
}
