//! The ray moved to the z axis, and triangles with it, by a permutation and a shear.
//!
//! Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.

use crate::kernel::{RayLanes, Values};
use crate::lane::{Lane, Number};
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
    /// One ray.
    #[inline(always)]
    pub fn of(token: L::Token, ray: &Ray) -> Self {
        Self::new(&RayLanes::of(token, ray))
    }

    #[inline(always)]
    pub fn new(rays: &RayLanes<L>) -> Self {
        let RayLanes {
            origin, dir, axes, ..
        } = *rays;
        let [dx, dy, dz] = [dir[axes[0]], dir[axes[1]], dir[axes[2]]];
        let (unit, slope) = if L::Number::HOLDS_PRODUCTS {
            (dz, [dx, dy])
        } else {
            (L::of(dz.token(), 1.0), [dx / dz, dy / dz])
        };
        Self {
            axes,
            origin: [origin[axes[0]], origin[axes[1]], origin[axes[2]]],
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
