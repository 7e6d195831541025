//! Exact intersections with planes and boxes that are aligned with the axes.

use super::exact_t::ExactT;
use super::flat::between_slabs;
use super::shapes::{IntegerRay, Oracle};
use glam::Vec3;
use hitscope_core::Ray;
use hitscope_core::shape::{AxisBox, AxisPlane, Plane};

impl Oracle for AxisPlane {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let axis = [Vec3::X, Vec3::Y, Vec3::Z][usize::from(self.axis)];
        let plane = Plane {
            point: self.coordinate * axis,
            normal: axis,
        };
        plane.crossings(ray)
    }
}

impl Oracle for AxisBox {
    /// With 2p − min − max for the point p, in units of max − min, a box spans −1 to 1.
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let crossings = || {
            if !self.min.cmple(self.max).all() {
                return None;
            }
            let all = IntegerRay::new(ray, &[self.min, self.max])?;
            let (above, below) = (all.from(0), all.from(1));
            let at = [0, 1, 2].map(|axis| &above[axis] + &below[axis]);
            let one = [0, 1, 2].map(|axis| &above[axis] - &below[axis]);
            let step = all.dir.each_ref().map(|x| x + x);
            Some(all.positive(between_slabs(&at, &step, &one)?.into()))
        };
        crossings().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::super::shapes::crossings_in_f64;
    use super::*;

    #[test]
    fn a_ray_enters_and_leaves_a_box_also_along_a_face_and_not_beside_it() {
        let shape = AxisBox {
            min: Vec3::new(0.0, 1.0, 2.0),
            max: Vec3::new(1.0, 3.0, 6.0),
        };
        let along_x = |y: f32| {
            let ray = Ray::new(Vec3::new(-1.0, y, 4.0), Vec3::X).expect("a ray");
            crossings_in_f64(&ray, &shape)
        };
        for y in [1.0, 2.0, 3.0] {
            assert_eq!(along_x(y), [1.0, 2.0]);
        }
        assert_eq!(along_x(3.0f32.next_up()), [0.0; 0]);
        let up = AxisPlane {
            axis: 2,
            coordinate: 5.0,
            is_along_axis: true,
        };
        let ray = Ray::new(Vec3::ZERO, Vec3::new(1.0, 0.0, 2.0)).expect("a ray");
        assert_eq!(crossings_in_f64(&ray, &up), [2.5]);
    }
}
