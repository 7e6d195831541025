//! Quadrics.

use super::{Placeable, Placed, PlacedPrimitive, Refusal, axis_of};
use crate::group::Solid;
use crate::scene_file::{self, Shape};
use crate::shape::Quadric;
use glam::{DMat3, DMat4, DVec3};

#[derive(Debug)]
pub(super) struct PlacedQuadric {
    coefficients: [f64; 10],
    /// The box's centre, from which coordinates are measured.
    centre: DVec3,
    /// Half the box's edges.
    half: DVec3,
}

impl Placeable for scene_file::Quadric {
    /// The map must keep the edges of the quadric's box along the axes.
    fn placed(&self, shape: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        let linear = DMat3::from_mat4(*to_world);
        let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
        if !columns.into_iter().all(|column| axis_of(column).is_some()) {
            let message = "the transform turns its box, whose edges stay along the axes; only scaling, translation and quarter turns are possible: apply others to the coefficients";
            return Err(Refusal::of_shape(shape, message));
        }
        let inverse = linear.inverse();
        let [a, b, c, d, e, f, g, h, i, j] = *self.coefficients;
        let q = DMat3::from_cols_array(&[a, d, f, d, b, e, f, e, c]);
        let linear_part = DVec3::new(g, h, i);
        // About the box's centre m in its own coordinates: x = m + y.
        let m = 0.5 * (self.min + self.max);
        let constant = m.dot(q * m) + 2.0 * linear_part.dot(m) + j;
        let half = 0.5 * (self.max - self.min);
        Ok(Box::new(PlacedQuadric {
            coefficients: coefficients(
                inverse.transpose() * q * inverse,
                inverse.transpose() * (q * m + linear_part),
                constant,
            ),
            centre: to_world.transform_point3(m),
            half: columns[0].abs() * half.x + columns[1].abs() * half.y + columns[2].abs() * half.z,
        }))
    }
}

impl PlacedQuadric {
    /// The image of the unit sphere under a linear map, moved to a centre: |L⁻¹x|² = 1.
    pub fn ellipsoid(centre: DVec3, linear: DMat3) -> Self {
        let inverse = linear.inverse();
        let rows = linear.transpose();
        // The greatest extent along each axis is the length of the matrix's row.
        let half = DVec3::new(
            rows.x_axis.length(),
            rows.y_axis.length(),
            rows.z_axis.length(),
        );
        Self {
            coefficients: coefficients(inverse.transpose() * inverse, DVec3::ZERO, -1.0),
            centre,
            // Slightly larger, so that rounding can't cut the ellipsoid: 10⁻⁵ is 84 ulps of f32.
            half: half * (1.0 + 1e-5),
        }
    }
}

/// The coefficients a to j of xᵀqx + 2·slope·x + constant.
pub(super) fn coefficients(q: DMat3, slope: DVec3, constant: f64) -> [f64; 10] {
    let [x, y, z] = [q.x_axis, q.y_axis, q.z_axis];
    [
        x.x, y.y, z.z, x.y, y.z, x.z, slope.x, slope.y, slope.z, constant,
    ]
}

impl PlacedPrimitive for PlacedQuadric {
    type Shape = Quadric;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        Some([self.centre - self.half, self.centre + self.half])
    }

    fn rounded(&self, origin: DVec3) -> Quadric {
        Quadric {
            coefficients: self.coefficients.map(|x| x as f32),
            centre: (self.centre - origin).as_vec3(),
            half: self.half.as_vec3(),
        }
    }

    /// The coefficients of a huge ellipsoid become 0.
    fn is_kept(quadric: &Quadric) -> bool {
        quadric.coefficients[..9].iter().any(|&x| x != 0.0)
    }

    const OPERAND_COUNT: usize = 2;

    fn solid(quadric: Quadric) -> Solid {
        Solid::of_quadric(quadric)
    }
}
