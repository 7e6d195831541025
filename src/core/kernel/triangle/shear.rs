//! Permutation and shear that move the ray to the z axis and triangles with it.
//!
//! Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.

use crate::kernel::RayLanes;
use crate::lane::{Lane, Number, Values};
use crate::ray::Ray;

/// A ray prepared for shearing triangles.
#[derive(Clone, Copy)]
pub(crate) struct ShearedRay<L> {
    /// The coordinates used as x, y and z; z is the direction's longest component.
    axes: [usize; 3],
    /// The origin with permuted coordinates.
    origin: [L; 3],
    /// Factor of x and y: d_z if products of f32 are exact, so that no slope is rounded, else 1.
    unit: L,
    /// d_x/d_z and d_y/d_z, times `unit`.
    slope: [L; 2],
    /// The direction's longest component.
    dir_z: L,
}

impl<L: Lane> ShearedRay<L> {
    /// Prepares one ray.
    #[inline(always)]
    pub fn of(token: L::Token, ray: &Ray) -> Self {
        Self::new(&RayLanes::of(token, ray))
    }

    #[inline(always)]
    pub fn new(rays: &RayLanes<L>) -> Self {
        let [origin, [dx, dy, dz]] = rays.along_axes;
        let (unit, slope) = if L::Number::HOLDS_PRODUCTS {
            (dz, [dx, dy])
        } else {
            (L::of(dz.token(), 1.0), [dx / dz, dy / dz])
        };
        Self {
            axes: rays.axes,
            origin,
            unit,
            slope,
            dir_z: dz,
        }
    }

    /// The direction's longest component; a depth is t times this.
    #[inline(always)]
    pub fn dir_z(&self) -> L {
        self.dir_z
    }

    /// The factor of x and y of sheared corners; depths aren't scaled.
    #[inline(always)]
    pub fn unit(&self) -> L {
        self.unit
    }

    /// The three corners relative to the ray: x and y across it, z along its longest component.
    ///
    /// The operations on a corner don't depend on the triangle that it belongs to.
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
