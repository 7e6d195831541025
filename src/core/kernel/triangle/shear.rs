//! The ray moved to the z axis, and triangles with it, by a permutation and a shear.
//!
//! Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.

use crate::kernel::Values;
use crate::lane::{Lane, longest_axis};
use crate::ray::Ray;

/// A ray made ready to shear triangles.
#[derive(Clone, Copy)]
pub(crate) struct ShearedRay<L> {
    /// Which coordinate becomes x, y and z; z is the direction's longest.
    axes: [usize; 3],
    /// The origin, its coordinates permuted.
    origin: [L; 3],
    /// d_x/d_z, d_y/d_z, d_z.
    shear: [L; 3],
}

impl<L: Lane> ShearedRay<L> {
    #[inline(always)]
    pub fn new(token: L::Token, ray: &Ray) -> Self {
        let axes = axes_of(ray.dir.to_array());
        let lane = |x: f32| L::of(token, x);
        let [dx, dy, dz] = axes.map(|axis| lane(ray.dir[axis]));
        Self {
            axes,
            origin: axes.map(|axis| lane(ray.origin[axis])),
            shear: [dx / dz, dy / dz, dz],
        }
    }

    /// The direction's longest coordinate: a depth is t times this.
    #[inline(always)]
    pub fn dir_z(&self) -> L {
        self.shear[2]
    }

    /// The three corners, relative to the ray: x and y across it, z along its longest coordinate.
    ///
    /// A corner is moved by the same operations whichever triangle it belongs to.
    #[inline(always)]
    pub fn sheared(&self, triangles: &impl Values<L>) -> [[L; 3]; 3] {
        [0, 1, 2].map(
            #[inline(always)]
            |corner| {
                let relative =
                    |k: usize| triangles.value(3 * corner + self.axes[k]) - self.origin[k];
                let [x, y, z] = [relative(0), relative(1), relative(2)];
                [x - self.shear[0] * z, y - self.shear[1] * z, z]
            },
        )
    }
}

/// The direction's longest coordinate as z, the next two as x and y; swapped where z looks
/// backwards, which keeps the triangles' winding.
fn axes_of(dir: [f32; 3]) -> [usize; 3] {
    let z = longest_axis(dir);
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    if dir[z] < 0.0 { [y, x, z] } else { [x, y, z] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn the_axes_keep_the_winding_whichever_way_the_ray_looks() {
        for dir in [Vec3::X, Vec3::Y, Vec3::Z] {
            for sign in [1.0, -1.0] {
                let d = (dir * sign).to_array();
                let [x, y, z] = axes_of(d);
                let unit = |i: usize| {
                    Vec3::from_array(std::array::from_fn(|k| f32::from(u8::from(k == i))))
                };
                assert_eq!(unit(x).cross(unit(y)).dot(unit(z)), sign, "{d:?}");
            }
        }
    }
}
