//! Disks and rectangles.

use super::{Placeable, Placed, PlacedPrimitive, Refusal};
use crate::group::UnitShape;
use crate::scene_file::{self, Shape};
use crate::shape::{Disk, Rectangle, Span, ellipse_reach};
use glam::{DMat3, DMat4, DVec3};

/// The image of the unit disk or of the square from −1 to 1.
#[derive(Debug)]
struct PlacedSpan {
    centre: DVec3,
    axes: [DVec3; 2],
}

impl PlacedSpan {
    fn new(to_world: &DMat4) -> Self {
        let linear = DMat3::from_mat4(*to_world);
        Self {
            centre: to_world.transform_point3(DVec3::ZERO),
            axes: [linear.x_axis, linear.y_axis],
        }
    }

    /// The box with these half edges about the centre.
    fn around(&self, half: DVec3) -> [DVec3; 2] {
        [self.centre - half, self.centre + half]
    }

    fn rounded(&self, origin: DVec3) -> Span {
        let [u, v] = self.axes.map(|axis| axis.as_vec3());
        Span {
            centre: (self.centre - origin).as_vec3(),
            u,
            v,
        }
    }
}

#[derive(Debug)]
struct PlacedDisk(PlacedSpan);

#[derive(Debug)]
struct PlacedRectangle(PlacedSpan);

impl Placeable for scene_file::Disk {
    /// The normal is u × v, which a mirroring transform turns away from the image of +z.
    const FLIPS_WHEN_MIRRORED: bool = true;

    fn placed(&self, _: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        Ok(Box::new(PlacedDisk(PlacedSpan::new(to_world))))
    }

    fn unit(&self) -> Option<(UnitShape, DMat4)> {
        Some((UnitShape::Disk, DMat4::IDENTITY))
    }
}

impl Placeable for scene_file::Rectangle {
    /// As for a disk.
    const FLIPS_WHEN_MIRRORED: bool = true;

    fn placed(&self, _: &Shape, to_world: &DMat4) -> Result<Box<dyn Placed>, Refusal> {
        Ok(Box::new(PlacedRectangle(PlacedSpan::new(to_world))))
    }

    fn unit(&self) -> Option<(UnitShape, DMat4)> {
        Some((UnitShape::Rectangle, DMat4::IDENTITY))
    }
}

impl PlacedPrimitive for PlacedDisk {
    type Shape = Disk;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let [u, v] = self.0.axes;
        let half = [0, 1, 2].map(|axis| ellipse_reach(u[axis], v[axis]));
        Some(self.0.around(half.into()))
    }

    fn rounded(&self, origin: DVec3) -> Disk {
        Disk(self.0.rounded(origin))
    }

    fn check_closed(&self) -> Result<(), String> {
        Err("a disk isn't a solid".to_owned())
    }
}

impl PlacedPrimitive for PlacedRectangle {
    type Shape = Rectangle;

    fn bounds(&self) -> Option<[DVec3; 2]> {
        let [u, v] = self.0.axes;
        Some(self.0.around(u.abs() + v.abs()))
    }

    fn rounded(&self, origin: DVec3) -> Rectangle {
        Rectangle(self.0.rounded(origin))
    }

    fn check_closed(&self) -> Result<(), String> {
        Err("a rectangle isn't a solid".to_owned())
    }
}
