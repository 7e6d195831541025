//! The point of a mesh that is nearest to a point.

mod triangle;

pub use triangle::{ClosestOnTriangle, closest_on_triangle};

use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::mesh::TriangleMesh;
use crate::scene::Scene;
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// The point of a mesh nearest to another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoint {
    /// The point, in the mesh's coordinates.
    pub position: DVec3,
    /// Its distance.
    pub distance: f64,
    /// Its triangle; of several at the same distance, the lowest.
    pub triangle: u32,
    /// Its barycentric coordinates for the triangle's corners.
    pub barycentric: [f64; 3],
}

/// Finds the points of a scene's triangles that are nearest to other points.
#[derive(Clone, Debug)]
pub struct ClosestPoints<'a> {
    mesh: &'a TriangleMesh,
    bvh: Arc<Bvh>,
}

impl<'a> ClosestPoints<'a> {
    /// Uses the tree over the scene's triangles; `None` if it has no triangle.
    pub fn of(scene: &'a Scene) -> Option<Self> {
        let mesh = scene.mesh();
        // Triangles are the first group.
        let group = scene.groups().first()?;
        (!mesh.triangles().is_empty()).then(|| Self {
            mesh,
            bvh: group.bvh(),
        })
    }

    /// The point nearest to `p`, which is in the mesh's coordinates; `None` if `p` isn't finite.
    ///
    /// The distance errs by a few ulps of the coordinates. The answer doesn't depend on the tree.
    pub fn closest(&self, p: DVec3) -> Option<ClosestPoint> {
        let mut best: Option<Candidate> = None;
        if p.is_finite() {
            self.bvh.visit_nearest(p, |block| {
                for &triangle in self.bvh.block(block) {
                    let candidate = Candidate::new(self.mesh, triangle, p);
                    if best.is_none_or(|best| candidate.is_before(&best)) {
                        best = Some(candidate);
                    }
                }
                best.map_or(f64::INFINITY, |best| best.rank)
            });
        }
        best.map(Candidate::into_point)
    }
}

/// The nearest point of one triangle.
#[derive(Clone, Copy)]
struct Candidate {
    triangle: u32,
    on_triangle: ClosestOnTriangle,
    /// The square of the distance, but no less than that of the triangle's box, which rounding could undercut.
    rank: f64,
}

impl Candidate {
    fn new(mesh: &TriangleMesh, triangle: u32, p: DVec3) -> Self {
        let corners = mesh.corners(triangle);
        let on_triangle = closest_on_triangle(p, corners.map(Vec3::as_dvec3));
        let of_box = Aabb::around(corners).distance_squared(p);
        Self {
            triangle,
            on_triangle,
            rank: on_triangle.distance_squared.max(of_box),
        }
    }

    fn is_before(&self, other: &Self) -> bool {
        (self.rank, self.triangle) < (other.rank, other.triangle)
    }

    fn into_point(self) -> ClosestPoint {
        ClosestPoint {
            position: self.on_triangle.position,
            distance: self.rank.sqrt(),
            triangle: self.triangle,
            barycentric: self.on_triangle.barycentric,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::{Placement, flat_grid, soup, sphere, torus};
    use crate::random::Random;
    use crate::scene::scene;

    /// The answer of all triangles, one after the other.
    fn by_brute_force(mesh: &TriangleMesh, p: DVec3) -> Option<ClosestPoint> {
        let triangles = 0..mesh.triangles().len() as u32;
        let candidates = triangles.map(|triangle| Candidate::new(mesh, triangle, p));
        let first = candidates.reduce(|a, b| if b.is_before(&a) { b } else { a });
        first.map(Candidate::into_point)
    }

    #[test]
    fn the_tree_finds_the_same_point_as_a_search_through_all_triangles() {
        let mut random = Random::new(3);
        let needles: Vec<[Vec3; 3]> = (0..500)
            .map(|_| {
                let a = random.in_cube_f32();
                [a, a + random.in_cube_f32(), a + 1e-6 * random.in_cube_f32()]
            })
            .collect();
        for mesh in [
            torus(40, 20, Placement::UNIT),
            sphere(12, Placement::new(1e4, 30.0)),
            // Many triangles at the same distance.
            flat_grid(20, Placement::new(1e-3, 1.0)),
            soup(&needles),
        ] {
            let (scene, bounds) = (scene(mesh.clone()), mesh.bounds());
            let closest = ClosestPoints::of(&scene).expect("it has triangles");
            let centre = bounds.centre().as_dvec3();
            for k in 0..400 {
                let reach = bounds.radius() * [0.3, 1.5, 100.0][k % 3];
                let p = match k % 4 {
                    0 => mesh.positions()[random.index(mesh.positions().len())].as_dvec3(),
                    _ => centre + reach * random.in_cube(),
                };
                assert_eq!(closest.closest(p), by_brute_force(&mesh, p), "{p}");
            }
        }
    }

    #[test]
    fn a_vertex_is_at_distance_0_from_its_mesh() {
        let mesh = sphere(10, Placement::new(3.0, 5.0));
        let scene = scene(mesh.clone());
        let closest = ClosestPoints::of(&scene).expect("it has triangles");
        for &vertex in mesh.positions() {
            let found = closest.closest(vertex.as_dvec3()).expect("it is finite");
            assert_eq!((found.distance, found.position), (0.0, vertex.as_dvec3()));
        }
        assert_eq!(closest.closest(DVec3::NAN), None);
    }

    #[test]
    fn a_scene_without_triangles_has_no_closest_points() {
        assert!(ClosestPoints::of(&scene(TriangleMesh::default())).is_none());
    }
}
