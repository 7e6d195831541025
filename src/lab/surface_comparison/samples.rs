//! Points of a surface from which distances are measured.

use glam::{DVec3, Vec3};
use hitscope_core::TriangleMesh;
use hitscope_core::random::Random;

/// A point of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SurfaceSample {
    /// In the mesh's coordinates.
    pub position: DVec3,
    /// A triangle that it belongs to.
    pub triangle: u32,
}

/// Each vertex that a triangle uses, once.
pub(super) fn vertices(mesh: &TriangleMesh) -> Vec<SurfaceSample> {
    let mut is_new = vec![true; mesh.positions().len()];
    let mut samples = Vec::new();
    for (triangle, corners) in (0..).zip(mesh.triangles()) {
        for &vertex in corners {
            if std::mem::take(&mut is_new[vertex as usize]) {
                samples.push(SurfaceSample {
                    position: mesh.positions()[vertex as usize].as_dvec3(),
                    triangle,
                });
            }
        }
    }
    samples
}

/// Points that are uniform by area: one in each of `count` parts of equal area, in the order of the triangles. They depend
/// on the mesh and the count only.
pub(super) struct AreaSamples<'a> {
    mesh: &'a TriangleMesh,
    /// The area of the triangles up to and including each.
    sums: Vec<f64>,
    count: usize,
}

impl<'a> AreaSamples<'a> {
    pub(super) fn new(mesh: &'a TriangleMesh, count: usize) -> Self {
        let area = |sum: &mut f64, triangle: u32| {
            let [a, b, c] = mesh.corners(triangle).map(Vec3::as_dvec3);
            *sum += 0.5 * (b - a).cross(c - a).length();
            Some(*sum)
        };
        let triangles = 0..mesh.triangles().len() as u32;
        Self {
            mesh,
            sums: triangles.scan(0.0, area).collect(),
            count,
        }
    }

    /// The area of the mesh.
    pub(super) fn area(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// Number of samples.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// A sample.
    pub(super) fn sample(&self, index: usize) -> SurfaceSample {
        let mut random = Random::new(index as u64);
        let at = self.area() * (index as f64 + random.unit()) / self.count as f64;
        let last = self.sums.len() - 1;
        let triangle = self.sums.partition_point(|&sum| sum <= at).min(last) as u32;
        let (mut u, mut v) = (random.unit(), random.unit());
        // The other half of the parallelogram.
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let [a, b, c] = self.mesh.corners(triangle).map(Vec3::as_dvec3);
        SurfaceSample {
            position: a + u * (b - a) + v * (c - a),
            triangle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::mesh::shapes::{Placement, cube, soup};

    #[test]
    fn samples_are_uniform_by_area() {
        // Areas 8 and 2.
        let mesh = soup(&[
            [Vec3::ZERO, 4.0 * Vec3::X, 4.0 * Vec3::Y],
            [Vec3::Z, Vec3::Z + 2.0 * Vec3::X, Vec3::Z + 2.0 * Vec3::Y],
        ]);
        let samples = AreaSamples::new(&mesh, 1000);
        assert_eq!(samples.area(), 10.0);
        let all: Vec<SurfaceSample> = (0..1000).map(|index| samples.sample(index)).collect();
        let of = |triangle| all.iter().filter(move |sample| sample.triangle == triangle);
        assert_eq!((of(0).count(), of(1).count()), (800, 200));
        let mean = of(0).map(|sample| sample.position).sum::<DVec3>() / 800.0;
        // The centroid; 0.2 are six standard errors.
        let centroid = DVec3::new(4.0, 4.0, 0.0) / 3.0;
        assert!((mean - centroid).abs().max_element() < 0.2, "{mean}");
        for sample in &all {
            let p = sample.position;
            let size = if sample.triangle == 0 { 4.0 } else { 2.0 };
            assert!(p.min_element() >= 0.0 && p.x + p.y <= size + 1e-12, "{p}");
        }
    }

    #[test]
    fn each_vertex_in_use_is_a_sample_once() {
        let mesh = cube(2, Placement::UNIT);
        let found = vertices(&mesh);
        assert_eq!(found.len(), mesh.positions().len());
        for sample in found {
            let corners = mesh.corners(sample.triangle);
            assert!(corners.contains(&sample.position.as_vec3()));
        }
    }
}
