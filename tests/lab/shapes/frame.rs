//! Integers times a power of two, as coordinates of shapes and rays.

use glam::{IVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::random::Random;

/// Moves and scales a shape and a ray so that all numbers stay integers times a power of two.
pub struct Frame {
    at: IVec3,
    scale: f32,
    /// The first axis of the frame among x, y and z.
    turn: usize,
}

impl Frame {
    pub fn random(random: &mut Random) -> Self {
        let mut whole = || random.index(2001) as i32 - 1000;
        Self {
            at: IVec3::new(whole(), whole(), whole()),
            scale: 2f32.powi(random.index(17) as i32 - 8),
            turn: random.index(3),
        }
    }

    pub fn vector(&self, [x, y, z]: [i32; 3]) -> Vec3 {
        let turned = [[x, y, z], [z, x, y], [y, z, x]][self.turn];
        self.scale * IVec3::from_array(turned).as_vec3()
    }

    pub fn point(&self, [x, y, z]: [i32; 3]) -> Vec3 {
        self.vector([x, y, z]) + self.scale * self.at.as_vec3()
    }

    pub fn length(&self, x: i32) -> f32 {
        self.scale * x as f32
    }

    /// A ray through a point that it reaches at t = `steps`.
    pub fn ray(&self, through: [i32; 3], dir: [i32; 3], steps: i32) -> Ray {
        let origin = std::array::from_fn(|k| through[k] - steps * dir[k]);
        Ray::new(self.point(origin), self.vector(dir)).expect("a ray")
    }
}

/// Integers a, b, c with a² + b² = c².
pub fn triple(random: &mut Random) -> [i32; 3] {
    let all = [
        [3, 4, 5],
        [5, 12, 13],
        [8, 15, 17],
        [7, 24, 25],
        [20, 21, 29],
    ];
    let [a, b, c] = all[random.index(all.len())];
    let mut sign = || [-1, 1][random.index(2)];
    let (a, b) = (a * sign(), b * sign());
    if random.index(2) == 0 {
        [a, b, c]
    } else {
        [b, a, c]
    }
}
