//! The oracle for combined solids: exact decisions about points between the crossings of the shapes.
//!
//! Between two consecutive crossings with any shape, one point decides about all. The kernels instead count how often
//! each shape is entered and left.

use super::enclosing::{Enclosing, EnclosingShape};
use super::exact_t::ExactT;
use hitscope_core::group::{CsgOperation, Solid};
use hitscope_core::mesh::{Runs, TriangleMesh};
use hitscope_core::progress::Progress;
use hitscope_core::{Ray, Scene};
use std::cmp::Ordering;
use std::fmt::Debug;
use std::sync::Arc;

/// A solid with exact crossings.
#[derive(Clone, Debug)]
pub enum OracleSolid {
    /// The interior of a shape.
    Shape(Arc<dyn EnclosingShape>),
    /// A combination of solids, at least one.
    Combined(CsgOperation, Vec<OracleSolid>),
}

/// A ray's points with t > 0, divided where it crosses a surface of any of a solid's shapes.
#[derive(Clone, Debug)]
pub struct Division {
    /// t of these crossings in ascending order, equal ones once.
    pub ends: Vec<ExactT>,
    /// A t before the first of them, between each two, and after the last.
    pub middles: Vec<f64>,
    /// Whether the solid contains the points there.
    pub inside: Vec<bool>,
}

impl OracleSolid {
    /// The interior of a shape.
    pub fn of(shape: impl Enclosing) -> Self {
        Self::Shape(Arc::new(shape))
    }

    /// The same for kernels.
    pub fn solid(&self) -> Solid {
        match self {
            Self::Shape(shape) => shape.solid(),
            Self::Combined(operation, parts) => {
                Solid::combined(*operation, parts.iter().map(Self::solid).collect())
            }
        }
    }

    /// A scene of this solid alone, for kernels.
    pub fn scene(&self) -> Scene {
        let mut scene = hitscope_core::scene::scene(TriangleMesh::default());
        let solids = vec![self.solid()];
        let added = scene.add_solids(solids, Runs::default(), &Progress::default());
        added.expect("nobody cancels");
        scene
    }

    /// The shapes, in the order of the tree.
    pub fn shapes(&self) -> Vec<&dyn EnclosingShape> {
        match self {
            Self::Shape(shape) => vec![&**shape],
            Self::Combined(_, parts) => parts.iter().flat_map(Self::shapes).collect(),
        }
    }

    /// The operands of [`solid`](Self::solid).
    pub fn operands(&self) -> Vec<Arc<dyn EnclosingShape>> {
        let shapes = self.shapes().into_iter();
        shapes.flat_map(EnclosingShape::operands).collect()
    }

    /// Whether the point o + t·d is inside; `None` if it is on the surface of one of the shapes.
    pub fn is_inside(&self, ray: &Ray, t: f64) -> Option<bool> {
        match self {
            Self::Shape(shape) => match shape.side(ray, t) {
                Ordering::Less => Some(true),
                Ordering::Equal => None,
                Ordering::Greater => Some(false),
            },
            Self::Combined(operation, parts) => {
                let parts = parts.iter().map(|part| part.is_inside(ray, t));
                let parts = parts.collect::<Option<Vec<bool>>>()?;
                let (first, others) = parts.split_first()?;
                let is_in_any = |parts: &[bool]| parts.contains(&true);
                Some(match operation {
                    CsgOperation::Union => is_in_any(&parts),
                    CsgOperation::Intersection => !parts.contains(&false),
                    CsgOperation::Difference => *first && !is_in_any(others),
                })
            }
        }
    }

    /// The parts of a ray inside and outside the solid. `None` if the ray lies in a surface, or if two crossings are
    /// closer than f64 numbers.
    pub fn division(&self, ray: &Ray) -> Option<Division> {
        let changes = self
            .shapes()
            .into_iter()
            .flat_map(|shape| shape.changes(ray));
        let mut ends = sorted(changes);
        let middles = middles(&mut ends)?;
        let inside = middles.iter().map(|&t| self.is_inside(ray, t));
        Some(Division {
            inside: inside.collect::<Option<_>>()?,
            ends,
            middles,
        })
    }
}

impl Division {
    /// Indices of the ends at which the solid is entered or left.
    pub fn crossings(&self) -> Vec<usize> {
        let ends = 0..self.ends.len();
        ends.filter(|&k| self.inside[k] != self.inside[k + 1])
            .collect()
    }
}

/// In ascending order, equal ones once.
fn sorted(found: impl Iterator<Item = ExactT>) -> Vec<ExactT> {
    let mut sorted: Vec<ExactT> = Vec::new();
    for mut t in found {
        let mut place = sorted.len();
        let mut order = Ordering::Greater;
        while place > 0 {
            order = t.compare(&mut sorted[place - 1]);
            if order != Ordering::Less {
                break;
            }
            place -= 1;
        }
        if place == 0 || order == Ordering::Greater {
            sorted.insert(place, t);
        }
    }
    sorted
}

/// A number before the first of positive numbers, between each two, and after the last.
fn middles(ends: &mut [ExactT]) -> Option<Vec<f64>> {
    let [first, .., last] = ends else {
        let only = ends.first_mut().map(ExactT::to_f64);
        return Some(only.map_or_else(|| vec![1.0], |t| vec![0.5 * t, 2.0 * t]));
    };
    let (first, last) = (first.to_f64(), last.to_f64());
    let mut middles = vec![0.5 * first];
    for k in 1..ends.len() {
        let (lower, upper) = ends.split_at_mut(k);
        middles.push(lower[k - 1].between(&mut upper[0])?);
    }
    middles.push(2.0 * last);
    Some(middles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use hitscope_core::shape::{AxisBox, AxisPlane, Cone, Cylinder, Quadric, Sphere, Torus};

    fn ray(origin: [f32; 3], dir: [f32; 3]) -> Ray {
        Ray::new(origin.into(), dir.into()).expect("a ray")
    }

    /// The sides of points on the x axis.
    fn sides(shape: &dyn EnclosingShape, points: &[f64]) -> Vec<Ordering> {
        let along_x = ray([0.0; 3], [1.0, 0.0, 0.0]);
        points.iter().map(|&t| shape.side(&along_x, t)).collect()
    }

    #[test]
    fn points_are_inside_on_or_outside_each_shape() {
        use Ordering::{Equal, Greater, Less};
        let just_below = 1f64.next_down();
        let expected = [Less, Less, Equal, Greater];
        let points = [0.5, just_below, 1.0, 1f64.next_up()];
        let (centre, radius) = (Vec3::ZERO, 1.0);
        assert_eq!(sides(&Sphere { centre, radius }, &points), expected);
        let (min, max) = (-Vec3::ONE, Vec3::ONE);
        assert_eq!(sides(&AxisBox { min, max }, &points), expected);
        let half_space = AxisPlane {
            axis: 0,
            coordinate: 1.0,
            is_along_axis: true,
        };
        assert_eq!(sides(&half_space, &points), expected);
        for is_capped in [true, false] {
            let [p0, p1] = [-Vec3::Z, Vec3::Z];
            let cylinder = Cylinder {
                p0,
                p1,
                radius,
                is_capped,
            };
            // At half its height, the cone has half the radius of its base.
            let cone = Cone {
                p0,
                p1,
                radius: 2.0,
                is_capped,
            };
            let expected = if is_capped { expected } else { [Greater; 4] };
            assert_eq!(sides(&cylinder, &points), expected);
            assert_eq!(sides(&cone, &points), expected);
        }
        let torus = Torus {
            centre,
            axis: 3.0 * Vec3::Z,
            major: 0.625,
            minor: 0.375,
        };
        assert_eq!(sides(&torus, &points), expected);
        assert_eq!(sides(&torus, &[0.125, 0.25]), [Greater, Equal]);
        // x² + y² = 4, cut at x = ±1, and x² + y² = 1, cut at ±4.
        for (size, half) in [(4.0, 1.0), (1.0, 4.0)] {
            let coefficients = [1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -size];
            let half = Vec3::splat(half);
            let quadric = Quadric {
                coefficients,
                centre,
                half,
            };
            assert_eq!(sides(&quadric, &points), expected);
        }
    }

    #[test]
    fn a_difference_is_divided_where_its_shapes_are_crossed() {
        let ball = |x: f32| {
            OracleSolid::of(Sphere {
                centre: x * Vec3::X,
                radius: 2.0,
            })
        };
        let both = vec![ball(4.0), ball(5.0)];
        let solid = OracleSolid::Combined(CsgOperation::Difference, both);
        let mut division = solid
            .division(&ray([0.0; 3], [1.0, 0.0, 0.0]))
            .expect("apart");
        let ends: Vec<f64> = division.ends.iter_mut().map(ExactT::to_f64).collect();
        assert_eq!(ends, [2.0, 3.0, 6.0, 7.0]);
        assert_eq!(division.inside, [false, true, false, false, false]);
        assert_eq!(division.crossings(), [0, 1]);
        let along = AxisBox {
            min: Vec3::new(1.0, 0.0, -1.0),
            max: Vec3::new(2.0, 1.0, 1.0),
        };
        let in_a_face = ray([0.0; 3], [1.0, 0.0, 0.0]);
        assert!(OracleSolid::of(along).division(&in_a_face).is_none());
    }
}
