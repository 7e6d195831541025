//! The ray moved to the z axis, and triangles with it, by a permutation and a shear.
//!
//! Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.

use crate::kernel::Values;
use crate::lane::{Lane, Number, longest_axis};
use crate::ray::Ray;

/// A ray made ready to shear triangles.
#[derive(Clone, Copy)]
pub(crate) struct ShearedRay<L> {
    /// Which coordinate becomes x, y and z; z is the direction's longest.
    axes: [usize; 3],
    /// The origin, its coordinates permuted.
    origin: [L; 3],
    /// What x and y are multiplied by: d_z where products of f32 are exact, so that no slope is
    /// rounded, else 1.
    unit: L,
    /// d_x/d_z and d_y/d_z, times the unit.
    slope: [L; 2],
    /// The direction's longest coordinate.
    dir_z: L,
}

impl<L: Lane> ShearedRay<L> {
    #[inline(always)]
    pub fn new(token: L::Token, ray: &Ray) -> Self {
        let axes = axes_of(ray.dir.to_array());
        let lane = |x: f32| L::of(token, x);
        let [dx, dy, dz] = axes.map(|axis| lane(ray.dir[axis]));
        let (unit, slope) = if L::Number::HOLDS_PRODUCTS {
            (dz, [dx, dy])
        } else {
            (lane(1.0), [dx / dz, dy / dz])
        };
        Self {
            axes,
            origin: axes.map(|axis| lane(ray.origin[axis])),
            unit,
            slope,
            dir_z: dz,
        }
    }

    /// The direction's longest coordinate: a depth is t times this.
    #[inline(always)]
    pub fn dir_z(&self) -> L {
        self.dir_z
    }

    /// What x and y of sheared corners are multiplied by; depths aren't.
    #[inline(always)]
    pub fn unit(&self) -> L {
        self.unit
    }

    /// The three corners, relative to the ray: x and y across it, z along its longest coordinate.
    ///
    /// A corner is moved by the same operations whichever triangle it belongs to.
    #[inline(always)]
    pub fn sheared(&self, triangles: &impl Values<L>) -> [[L; 3]; 3] {
        [
            self.sheared_corner(triangles, 0),
            self.sheared_corner(triangles, 3),
            self.sheared_corner(triangles, 6),
        ]
    }

    #[inline(always)]
    fn sheared_corner(&self, triangles: &impl Values<L>, first: usize) -> [L; 3] {
        let [x, y, z] = [
            triangles.value(first + self.axes[0]) - self.origin[0],
            triangles.value(first + self.axes[1]) - self.origin[1],
            triangles.value(first + self.axes[2]) - self.origin[2],
        ];
        if L::Number::HOLDS_PRODUCTS {
            let [dx, dy] = self.slope;
            [x * self.unit - dx * z, y * self.unit - dy * z, z]
        } else {
            [x - self.slope[0] * z, y - self.slope[1] * z, z]
        }
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
