//! Shapes of primitives: one file per shape.

mod axis_box;
mod axis_plane;
mod compact;
mod cone;
mod cuboid;
mod curve;
mod cylinder;
mod disk;
mod extent;
mod flat_patch;
mod interior;
mod lines;
mod parameter;
mod plane;
mod plane_form;
mod quadric;
mod quadric_lines;
mod rectangle;
mod sample;
mod shared_corners;
mod span;
mod sphere;
mod sphere_filter;
mod subtended;
mod surface;
mod torus;
mod triangle;

pub use axis_box::AxisBox;
pub use axis_plane::AxisPlane;
pub(crate) use compact::{BLOCKS_AT_ONCE, CompactBlocks, EmptyLanes};
pub use cone::Cone;
pub use cuboid::Cuboid;
pub use curve::LineView;
pub use cylinder::Cylinder;
pub(crate) use cylinder::{BASE, SIDE, TOP};
pub use disk::Disk;
pub(crate) use extent::{disk_reach, ellipse_reach};
pub(crate) use flat_patch::FlatPatch;
pub use interior::Interior;
pub(crate) use interior::UNBOUNDED;
pub use lines::{AddLine, LineDetail, LinePoint};
pub use parameter::{Parameter, ParameterKind};
pub use plane::Plane;
pub use plane_form::PlaneForm;
pub use quadric::Quadric;
pub use rectangle::Rectangle;
pub use sample::{SampledPoint, SampledSurface};
pub(crate) use sample::{in_disk, on_sphere};
pub use span::Span;
pub use sphere::Sphere;
pub use surface::SurfacePoint;
pub use torus::Torus;
pub use triangle::Triangle;

use crate::aabb::{Aabb, Planes};
use crate::lane::{Lane, Values};
use crate::ray::{Hit, Ray};
use glam::{DVec2, Vec3};
use std::fmt::Debug;

/// A shape's names and equations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeInfo {
    /// One primitive, as in “1 sphere”.
    pub name: &'static str,
    /// Several primitives.
    pub plural: &'static str,
    /// The names of its parameters, in the order of [`Shape::write`].
    pub parameters: &'static [Parameter],
    /// The equation of each part of its surface for a point p.
    pub equations: &'static [&'static str],
}

/// The parameters of a primitive, in f32. They are the question that kernels answer.
pub trait Shape: Clone + Debug + Send + Sync + 'static {
    /// Its names.
    const INFO: ShapeInfo;
    /// Storage for packing in little memory.
    type Compact: CompactBlocks<Self>;

    /// The number of its parameters.
    const NUMBERS: usize;
    /// The largest number of points at which a line meets a primitive.
    const MOST_CROSSINGS: usize;
    /// Whether primitives have finite boxes. If not, all are tested.
    const IS_BOUNDED: bool = true;

    /// A primitive that no ray hits, for unused lanes.
    fn nowhere() -> Self;

    /// Writes the parameters.
    fn write(&self, numbers: &mut [f32]);

    /// The primitive with the parameters.
    fn read(numbers: &impl Values<f32>) -> Self;

    /// The boxes around primitives with the parameters.
    fn planes<L: Lane>(numbers: &impl Values<L>) -> Planes<L>;

    /// The lanes whose primitives a line may meet, given its origin and direction; `None` if the shape has no test that
    /// rejects more lines than the primitive's box. A primitive that isn't met is missed in exact arithmetic, and by
    /// kernels that are filtered.
    #[inline(always)]
    fn may_meet<L: Lane>(_line: [&[L; 3]; 2], _numbers: &impl Values<L>) -> Option<L::Mask> {
        None
    }

    /// The primitive's box in the tree. It encloses the primitive, also as kernels recompute it from packed
    /// values. Empty or not finite if no ray can hit the primitive.
    fn bounds(&self) -> Aabb;

    /// The boxes around the points inside and around all others, if the primitive is part of a solid. They are infinite
    /// where there may be such points.
    fn bounds_of_sides(&self) -> [Aabb; 2] {
        let inside = if Self::IS_BOUNDED {
            self.bounds()
        } else {
            Aabb::EVERYWHERE
        };
        [inside, Aabb::EVERYWHERE]
    }

    /// The surface where a ray hits the primitive.
    fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint;

    /// Passes lines on the surface to `add`, for display.
    fn lines(&self, detail: &LineDetail, add: AddLine<'_>);

    /// The area of the surface; 0 if its points can't be sampled.
    fn area(&self) -> f64 {
        0.0
    }

    /// A point of the surface, uniform by area for uniform points `at` of the unit square; `None` if the area is 0.
    fn sampled_point(&self, _at: DVec2) -> Option<SampledPoint> {
        None
    }

    /// A point of the surface to be lit by from `from`; by default [`sampled_point`](Self::sampled_point).
    fn sampled_from(&self, _from: Vec3, at: DVec2) -> Option<SampledPoint> {
        self.sampled_point(at)
    }

    /// The surface at the point of [`sampled_from`](Self::sampled_from), and its density if the directions are uniform.
    /// `None` also if the point is `from` itself.
    fn sampled_surface(&self, from: Vec3, at: DVec2) -> Option<SampledSurface> {
        let SampledPoint { position, u, v } = self.sampled_from(from, at)?;
        let ray = Ray::new(from, (position - from.as_dvec3()).as_vec3()).ok()?;
        // The length of the direction may have been scaled.
        let t = 2f32.powi(-ray.scale);
        let hit = Hit {
            t,
            u,
            v,
            primitive: 0,
        };
        Some(SampledSurface {
            surface: self.surface(&ray, &hit),
            u,
            v,
            density: self.density_from(from),
        })
    }

    /// The primitive prepared for sampling, with the points of [`sampled_surface`](Self::sampled_surface); `None` if that
    /// isn't faster.
    fn flat_patch(&self) -> Option<FlatPatch> {
        None
    }

    /// The density per solid angle of [`sampled_from`](Self::sampled_from), if the directions to its points are uniform over
    /// those in which the shape appears. `None` if the points are uniform by area.
    fn density_from(&self, _from: Vec3) -> Option<f64> {
        None
    }

    /// How crossings divide the ray's whole line into parts inside and outside the primitive.
    fn interior(&self, _ray: &Ray) -> Interior {
        Interior::Open
    }
}

/// A primitive's parameters.
pub(crate) fn numbers_of<S: Shape>(shape: &S) -> [f32; MAX_NUMBERS] {
    let mut numbers = [0.0; MAX_NUMBERS];
    shape.write(&mut numbers[..S::NUMBERS]);
    numbers
}

/// Half an ulp of 1 in f32.
const U: f32 = f32::EPSILON / 2.0;

/// The largest number of parameters of any shape.
const MAX_NUMBERS: usize = 16;

/// A list of primitives of one shape.
pub trait Primitives<S>: Send + Sync {
    /// The number of primitives.
    fn count(&self) -> usize;

    /// The primitive of an index.
    ///
    /// # Panics
    /// If the index isn't below the count.
    fn primitive(&self, index: u32) -> S;
}

impl<S: Shape> Primitives<S> for Vec<S> {
    fn count(&self) -> usize {
        self.len()
    }

    fn primitive(&self, index: u32) -> S {
        self[index as usize].clone()
    }
}

/// A function that returns the boxes of primitives, from which trees are built.
pub fn bounds_in<S: Shape>(primitives: &impl Primitives<S>) -> impl Fn(u32) -> Aabb + Sync {
    |index| primitives.primitive(index).bounds()
}
