//! Samples of planes and boxes that are aligned with the axes.

use super::flat::end_or_between;
use super::samples::{Sampled, end, length};
use crate::measure::lecture::{AsPrinted, BOX_AS_PRINTED};
use glam::{DVec3, Vec3};
use hitscope_core::Hit;
use hitscope_core::random::Random;
use hitscope_core::shape::{AxisBox, AxisPlane};

impl Sampled for AxisPlane {
    const HAS_EDGES: bool = false;
    const IS_CONVEX: bool = true;

    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        let axis = random.index(3);
        Self {
            axis: axis as u8,
            coordinate: (near + size * random.in_cube())[axis] as f32,
            is_along_axis: random.index(2) == 0,
        }
    }

    fn edge_point(&self, _: &mut Random) -> Option<DVec3> {
        Some(f64::from(self.coordinate) * self.axis().as_dvec3())
    }

    fn axis(&self) -> Vec3 {
        [Vec3::X, Vec3::Y, Vec3::Z][usize::from(self.axis)]
    }

    fn size(&self) -> f64 {
        1.0
    }
}

impl Sampled for AxisBox {
    const HAS_EDGES: bool = true;
    const IS_CONVEX: bool = true;

    fn sample(random: &mut Random, near: DVec3, size: f64) -> Self {
        let centre = (near + 0.2 * size * random.in_cube()).as_vec3();
        let half = Vec3::from_array([(); 3].map(|()| length(random, 0.6 * size)));
        Self {
            min: centre - half,
            max: centre + half,
        }
    }

    fn edge_point(&self, random: &mut Random) -> Option<DVec3> {
        let mut at = [(); 3].map(|()| end(random));
        at[random.index(3)] = end_or_between(random);
        let (min, max) = (self.min.as_dvec3(), self.max.as_dvec3());
        Some(0.5 * (min + max) + 0.5 * DVec3::from_array(at) * (max - min))
    }

    fn axis(&self) -> Vec3 {
        Vec3::X
    }

    fn as_printed() -> &'static [AsPrinted<Self>] {
        BOX_AS_PRINTED
    }

    fn part(hit: &Hit) -> u32 {
        hit.u as u32
    }
}
