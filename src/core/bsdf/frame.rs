//! Orthonormal frames about a normal.

use glam::Vec3;

/// A right-handed frame whose z axis is a unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The x axis.
    pub x: Vec3,
    /// The y axis.
    pub y: Vec3,
    /// The normal.
    pub z: Vec3,
}

impl Frame {
    /// A frame about a unit normal.
    ///
    /// Source: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
    #[inline]
    pub fn about(normal: Vec3) -> Self {
        let Vec3 { x, y, z } = normal;
        let sign = 1f32.copysign(z);
        let a = -1.0 / (sign + z);
        let b = x * y * a;
        Self {
            x: Vec3::new(1.0 + sign * x * x * a, sign * b, -sign * x),
            y: Vec3::new(b, sign + y * y * a, -y),
            z: normal,
        }
    }

    /// A direction of the world in the frame.
    #[inline]
    pub fn to_local(&self, dir: Vec3) -> Vec3 {
        Vec3::new(self.x.dot(dir), self.y.dot(dir), self.z.dot(dir))
    }

    /// A direction of the frame in the world.
    #[inline]
    pub fn to_world(&self, dir: Vec3) -> Vec3 {
        dir.x * self.x + dir.y * self.y + dir.z * self.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn frames_are_right_handed_and_orthonormal() {
        let mut random = Random::new(1);
        let random = (0..1000).map(|_| random.direction().as_vec3());
        let extreme = [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::new(1e-20, 0.0, -1.0)];
        for normal in extreme.into_iter().chain(random) {
            let frame = Frame::about(normal);
            assert!(
                (frame.x.cross(frame.y) - frame.z).length() < 1e-6,
                "{normal}"
            );
            assert!(frame.x.dot(frame.y).abs() < 1e-6 && frame.x.is_normalized());
            let dir = Vec3::new(0.3, -0.2, 0.9);
            assert!((frame.to_local(frame.to_world(dir)) - dir).length() < 1e-6);
        }
    }
}
