//! Normals at vertices, for smooth shading and to be shown.

use super::{NO_NORMAL, TriangleMesh, place};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// A unit normal for each corner that has one.
#[derive(Clone, Debug, Default)]
pub struct VertexNormals {
    /// The file's where it has them, else computed; zero where the faces around cancel out.
    corners: Vec<[Vec3; 3]>,
}

impl VertexNormals {
    /// Takes the file's normals; computes those that are missing from the faces around a vertex,
    /// each weighted by its angle there.
    ///
    /// Vertices at the same place count as one, so that a seam doesn't show.
    /// Source: Thürmer, Wüthrich, "Computing Vertex Normals from Polygonal Facets", JGT 3(1), 1998.
    pub fn of(mesh: &TriangleMesh) -> Self {
        let has_normal = |triangle: usize| {
            mesh.corner_normals
                .get(triangle)
                .is_some_and(|corners| !corners.contains(&NO_NORMAL))
        };
        let is_complete = (0..mesh.triangles.len()).all(has_normal);
        let computed = if is_complete {
            Vec::new()
        } else {
            computed(mesh)
        };
        // In f64, where the length of an f32 vector neither under- nor overflows.
        let from_file = |index: u32| {
            let normal = mesh.normals[index as usize].as_dvec3();
            normal.normalize_or_zero().as_vec3()
        };
        let corners = mesh.triangles.iter().enumerate().map(|(triangle, corner)| {
            if has_normal(triangle) {
                mesh.corner_normals[triangle].map(from_file)
            } else {
                corner.map(|vertex| computed[vertex as usize])
            }
        });
        Self {
            corners: corners.collect(),
        }
    }

    /// The normals at a triangle's corners.
    pub fn of_triangle(&self, triangle: u32) -> [Vec3; 3] {
        self.corners[triangle as usize]
    }
}

/// One normal for each vertex, from the faces around it.
fn computed(mesh: &TriangleMesh) -> Vec<Vec3> {
    let place = places(&mesh.positions);
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    for corner in &mesh.triangles {
        let p = corner.map(|v| mesh.positions[v as usize].as_dvec3());
        let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize_or_zero();
        for k in 0..3 {
            let (next, last) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            sums[place[corner[k] as usize] as usize] += normal * next.angle_between(last);
        }
    }
    let normal = |&at: &u32| sums[at as usize].normalize_or_zero().as_vec3();
    place.iter().map(normal).collect()
}

/// For each vertex the first one at the same place.
fn places(positions: &[Vec3]) -> Vec<u32> {
    let mut first = HashMap::with_capacity(positions.len());
    let first = |(vertex, &p): (usize, &Vec3)| *first.entry(place(p)).or_insert(vertex as u32);
    positions.iter().enumerate().map(first).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two sides of a roof that meet in the ridge from (0, 0, 1) to (0, 1, 1).
    fn roof() -> TriangleMesh {
        TriangleMesh {
            positions: vec![
                Vec3::new(0.0, 0.0, 1.0),
                Vec3::new(0.0, 1.0, 1.0),
                Vec3::new(-1.0, 0.0, 0.0),
                Vec3::new(1.0, 0.0, 0.0),
                Vec3::new(-0.0, 1.0, 1.0),
            ],
            triangles: vec![[0, 1, 2], [0, 3, 4]],
            ..TriangleMesh::default()
        }
    }

    #[test]
    fn a_seam_of_doubled_vertices_does_not_show() {
        let normals = VertexNormals::of(&roof());
        let [left, right] = [normals.of_triangle(0), normals.of_triangle(1)];
        assert_eq!(left[1], right[2]);
        assert!(left[1].x.abs() < 1e-7 && left[1].z > 0.999, "{left:?}");
        let flat = Vec3::new(-1.0, 0.0, 1.0).normalize();
        assert!((left[2] - flat).length() < 1e-6);
    }

    #[test]
    fn the_files_normals_win_face_by_face() {
        let mut mesh = roof();
        mesh.normals = vec![Vec3::Y * 2.0];
        mesh.corner_normals = vec![[0; 3], [NO_NORMAL; 3]];
        let normals = VertexNormals::of(&mesh);
        assert_eq!(normals.of_triangle(0), [Vec3::Y; 3]);
        assert_ne!(normals.of_triangle(1)[0], Vec3::Y);
    }

    #[test]
    fn faces_that_cancel_out_leave_a_zero_normal() {
        let mut mesh = roof();
        mesh.triangles = vec![[0, 1, 2], [0, 2, 1]];
        assert_eq!(VertexNormals::of(&mesh).of_triangle(0)[0], Vec3::ZERO);
    }
}
