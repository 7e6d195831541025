//! Exact intersections with planes, disks, rectangles and boxes.
//!
//! Points of disks, rectangles and boxes have coordinates along their half axes; elimination (Bareiss, "Sylvester's
//! Identity and Multistep Integer-Preserving Gaussian Elimination", Mathematics of Computation 22, 1968) finds them as
//! quotients of integers. A line crosses the surface of a box where it enters and leaves it: at the largest of the t
//! at which it enters a slab between two opposite faces, and the smallest of those at which it leaves one. The kernels
//! multiply with cross products, and look at each face.

use super::exact_t::ExactT;
use super::shapes::{IntegerRay, Oracle};
use super::surd::Surd;
use super::triangle::dot;
use dashu_int::IBig;
use hitscope_core::Ray;
use hitscope_core::shape::{Cuboid, Disk, Plane, Rectangle, Span};
use std::cmp::Ordering;

impl Oracle for Plane {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let crossings = || {
            let all = IntegerRay::new(ray, &[self.point])?;
            let (normals, _) = super::triangle::integers(&[self.normal])?;
            let t = Surd::rational(-dot(&normals[0], &all.from(0)), dot(&normals[0], &all.dir))?;
            Some(all.positive(vec![t]))
        };
        crossings().unwrap_or_default()
    }
}

impl Oracle for Disk {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        spanned(ray, &self.0, |a, b, one| a * a + b * b <= one * one)
    }
}

impl Oracle for Rectangle {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let is_within = |x: &IBig, one: &IBig| x * x <= one * one;
        spanned(ray, &self.0, |a, b, one| {
            is_within(a, one) && is_within(b, one)
        })
    }
}

/// The crossing with the plane of c + a·u + b·v, if it contains a and b, given as numerators and their denominator.
fn spanned(ray: &Ray, span: &Span, contains: impl Fn(&IBig, &IBig, &IBig) -> bool) -> Vec<ExactT> {
    let crossings = || {
        let all = IntegerRay::new(ray, &[span.centre, span.u, span.v])?;
        let [u, v] = [1, 2].map(|k| all.places[k].clone());
        // a·u + b·v − t·d = o − c.
        let back = all.dir.each_ref().map(|x| -x);
        let ([[a, b, t]], det) = solve(&[u, v, back], [all.from(0)])?;
        contains(&a, &b, &det).then(|| all.positive(Surd::rational(t, det).into_iter().collect()))
    };
    crossings().unwrap_or_default()
}

impl Oracle for Cuboid {
    fn crossings(&self, ray: &Ray) -> Vec<ExactT> {
        let crossings = || {
            let [a, b, c] = self.axes;
            let all = IntegerRay::new(ray, &[self.centre, a, b, c])?;
            let axes = [1, 2, 3].map(|k| all.places[k].clone());
            let ([at, step], one) = solve(&axes, [all.from(0), all.dir.clone()])?;
            let ends = between_slabs(&at, &step, &[(); 3].map(|()| one.clone()))?;
            Some(all.positive(ends.into()))
        };
        crossings().unwrap_or_default()
    }
}

/// Where at + t·step, in units of one, is between −1 and 1 in each coordinate: the first and the last t.
pub(super) fn between_slabs(
    at: &[IBig; 3],
    step: &[IBig; 3],
    one: &[IBig; 3],
) -> Option<[Surd; 2]> {
    let mut inside: Option<[Surd; 2]> = None;
    for ((at, step), one) in at.iter().zip(step).zip(one) {
        let faces = [-one - at, one - at].map(|rest| Surd::rational(rest, step.clone()));
        let [Some(first), Some(second)] = faces else {
            // Parallel to the slab: in it everywhere or nowhere.
            if at * at > one * one {
                return None;
            }
            continue;
        };
        let [enter, leave] = if first.compare(&second) == Ordering::Less {
            [first, second]
        } else {
            [second, first]
        };
        inside = Some(match inside {
            None => [enter, leave],
            Some([a, b]) => [
                if a.compare(&enter) == Ordering::Less {
                    enter
                } else {
                    a
                },
                if leave.compare(&b) == Ordering::Less {
                    leave
                } else {
                    b
                },
            ],
        });
    }
    inside.filter(|[enter, leave]| enter.compare(leave) != Ordering::Greater)
}

/// Solutions of x₀·columns₀ + x₁·columns₁ + x₂·columns₂ = right for several right sides, as numerators and their
/// denominator; `None` if the columns lie in a plane.
pub(super) fn solve<const N: usize>(
    columns: &[[IBig; 3]; 3],
    rights: [[IBig; 3]; N],
) -> Option<([[IBig; 3]; N], IBig)> {
    let mut rows: Vec<Vec<IBig>> = (0..3)
        .map(|row| {
            let right = rights.iter().map(|right| right[row].clone());
            columns
                .iter()
                .map(|c| c[row].clone())
                .chain(right)
                .collect()
        })
        .collect();
    let mut before = IBig::ONE;
    for k in 0..3 {
        let pivot = (k..3).find(|&row| rows[row][k] != IBig::ZERO)?;
        if pivot != k {
            rows.swap(k, pivot);
            rows[k].iter_mut().for_each(|x| *x = -&*x);
        }
        let pivots = rows[k].clone();
        for (row, numbers) in rows.iter_mut().enumerate() {
            if row != k {
                let factor = numbers[k].clone();
                for (x, p) in numbers.iter_mut().zip(&pivots) {
                    // The division leaves no remainder.
                    *x = (&*x * &pivots[k] - &factor * p) / &before;
                }
            }
        }
        before = pivots[k].clone();
    }
    let solution = |n: usize| std::array::from_fn(|row| rows[row][3 + n].clone());
    Some((std::array::from_fn(solution), before))
}

#[cfg(test)]
mod tests {
    use super::super::shapes::crossings_in_f64;
    use super::*;
    use glam::Vec3;

    fn ray(origin: [f32; 3], dir: [f32; 3]) -> Ray {
        Ray::new(origin.into(), dir.into()).expect("a ray")
    }

    #[test]
    fn a_skew_box_is_crossed_at_its_faces_edges_and_corners() {
        let skew = Cuboid {
            centre: Vec3::new(1.0, 0.0, 0.0),
            axes: [Vec3::X, Vec3::new(1.0, 2.0, 0.0), Vec3::Z],
        };
        let at = |origin, dir| crossings_in_f64(&ray(origin, dir), &skew);
        // At y = 0 it reaches from x = 0 to 2, at y = 2 from 1 to 3.
        assert_eq!(at([-3.0, 0.0, 0.0], [1.0, 0.0, 0.0]), [3.0, 5.0]);
        assert_eq!(at([-3.0, 2.0, 0.5], [1.0, 0.0, 0.0]), [4.0, 6.0]);
        assert_eq!(at([1.0, 0.0, 0.0], [0.0, 0.0, 0.5]), [2.0]);
        // Through the corner (3, 2, 1) alone.
        assert_eq!(at([4.0, 1.0, 1.0], [-1.0, 1.0, 0.0]), [1.0]);
        assert!(at([4.0, 1.5, 1.0], [-1.0, 1.0, 0.0]).is_empty());
        assert!(at([-3.0, 2.5, 0.0], [1.0, 0.0, 0.0]).is_empty());
    }

    #[test]
    fn a_disk_includes_its_rim_and_a_ray_in_its_plane_misses() {
        let disk = Disk(Span {
            centre: Vec3::Z,
            u: Vec3::new(5.0, 0.0, 0.0),
            v: Vec3::new(0.0, 5.0, 0.0),
        });
        let at = |origin, dir| crossings_in_f64(&ray(origin, dir), &disk);
        assert_eq!(at([3.0, 4.0, 0.0], [0.0, 0.0, 2.0]), [0.5]);
        assert!(at([3.0, 4f32.next_up(), 0.0], [0.0, 0.0, 2.0]).is_empty());
        assert!(at([-9.0, 0.0, 1.0], [1.0, 0.0, 0.0]).is_empty());
    }
}
