//! Boxes.

use super::{Placeable, Placed, PlacedPrimitive, Refusal, axis_of};
use crate::group::UnitShape;
use crate::scene_file::{self, Shape};
use crate::shape::{AxisBox, Cuboid};
use glam::{DMat3, DMat4, DVec3};

impl Placeable for scene_file::Cube {
    fn placed(&self, _: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        Ok(placed(to_world, DVec3::NEG_ONE, DVec3::ONE))
    }

    fn unit(&self) -> Option<(UnitShape, DMat4)> {
        Some((UnitShape::Cube, DMat4::IDENTITY))
    }
}

impl Placeable for scene_file::Cuboid {
    fn placed(&self, _: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        Ok(placed(to_world, self.min, self.max))
    }

    fn unit(&self) -> Option<(UnitShape, DMat4)> {
        let centre = DMat4::from_translation(0.5 * (self.min + self.max));
        let half = DMat4::from_scale(0.5 * (self.max - self.min));
        Some((UnitShape::Cube, centre * half))
    }
}

/// The image of a box with edges along the axes; an [`AxisBox`] if its edges still are.
fn placed(to_world: &DMat4, min: DVec3, max: DVec3) -> Box<dyn Placed> {
    let linear = DMat3::from_mat4(*to_world);
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
    if columns.into_iter().all(|column| axis_of(column).is_some()) {
        let [a, b] = [min, max].map(|corner| to_world.transform_point3(corner));
        return Box::new(PlacedAxisBox([a.min(b), a.max(b)]));
    }
    let half = 0.5 * (max - min);
    Box::new(PlacedCuboid {
        centre: to_world.transform_point3(0.5 * (min + max)),
        axes: [
            half.x * linear.x_axis,
            half.y * linear.y_axis,
            half.z * linear.z_axis,
        ],
    })
}

/// The lowest and the highest corner.
#[derive(Debug)]
struct PlacedAxisBox([DVec3; 2]);

impl PlacedPrimitive for PlacedAxisBox {
    type Shape = AxisBox;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        Some(self.0)
    }

    fn rounded(&self, origin: DVec3) -> AxisBox {
        let [min, max] = self.0.map(|corner| (corner - origin).as_vec3());
        AxisBox { min, max }
    }
}

#[derive(Debug)]
struct PlacedCuboid {
    centre: DVec3,
    axes: [DVec3; 3],
}

impl PlacedPrimitive for PlacedCuboid {
    type Shape = Cuboid;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let half: DVec3 = self.axes.iter().map(|axis| axis.abs()).sum();
        Some([self.centre - half, self.centre + half])
    }

    fn rounded(&self, origin: DVec3) -> Cuboid {
        Cuboid {
            centre: (self.centre - origin).as_vec3(),
            axes: self.axes.map(|axis| axis.as_vec3()),
        }
    }
}
