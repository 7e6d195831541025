//! Vertex normals for smooth shading.

use super::edges::{EdgeTable, EdgeUse, VertexFans};
use super::{NO_INDEX, TriangleMesh, Welded, unit_normal};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// The edges that smooth shading keeps sharp.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Crease {
    /// Creases given by the file's normals and smoothing groups. Without those, all edges are smooth.
    #[default]
    FromFile,
    /// Edges at which the triangles' normals differ by more than this angle in radians, regardless of the file. With
    /// NaN every edge is a crease.
    Above(f32),
}

/// One unit normal per corner; zero where the normals of the adjacent faces cancel.
#[derive(Clone, Debug)]
pub struct VertexNormals {
    normals: Vec<Vec3>,
    indices: Indices,
}

/// The index of each corner's normal.
#[derive(Clone, Debug)]
enum Indices {
    /// The mesh's vertex indices.
    OfVertices,
    /// The file's normal indices.
    OfFile,
    /// A separate list of indices, per triangle.
    Own(Vec<[u32; 3]>),
}

impl VertexNormals {
    /// Computes the vertex normals of a mesh. A computed normal is the normalized sum of the normals of the triangles
    /// around the vertex, up to the creases, each weighted by its angle there. With [`Crease::FromFile`], the file's
    /// normals take precedence.
    ///
    /// Vertices at the same position count as one, so that seams don't show.
    /// Source: Thürmer, Wüthrich, "Computing Vertex Normals from Polygonal Facets", JGT 3(1), 1998.
    pub fn of(mesh: &TriangleMesh, crease: Crease) -> Self {
        if let Crease::Above(radians) = crease {
            return creased(mesh, radians);
        }
        let mut triangles = 0..mesh.triangles.len() as u32;
        let given = &mesh.attributes.normals;
        if !given.is_empty() && triangles.all(|t| given.are_complete(t)) {
            return Self {
                normals: from_file(mesh).map(DVec3::as_vec3).collect(),
                indices: Indices::OfFile,
            };
        }
        if given.is_empty() && mesh.attributes.smoothing.is_none() {
            return of_vertices(mesh);
        }
        mixed(mesh)
    }

    /// The normals at a triangle's corners. `mesh` must be the mesh that was passed to [`of`](Self::of).
    pub fn of_triangle(&self, mesh: &TriangleMesh, triangle: u32) -> [Vec3; 3] {
        let indices = match &self.indices {
            Indices::OfVertices => mesh.triangles[triangle as usize],
            Indices::OfFile => mesh.attributes.normals.indices(triangle),
            Indices::Own(corners) => corners[triangle as usize],
        };
        indices.map(|index| self.normals[index as usize])
    }
}

/// The file's normals, normalized in f64, where the length of an f32 vector neither under- nor overflows.
fn from_file(mesh: &TriangleMesh) -> impl Iterator<Item = DVec3> {
    mesh.attributes
        .normals
        .values()
        .iter()
        .map(|normal| normal.as_dvec3().normalize_or_zero())
}

/// A triangle's normal weighted by the angle at each corner.
fn weighted(mesh: &TriangleMesh, triangle: u32) -> [DVec3; 3] {
    let corners = mesh.corners(triangle);
    let (normal, p) = (unit_normal(corners), corners.map(Vec3::as_dvec3));
    [0, 1, 2].map(|k| {
        let (next, last) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
        normal * next.angle_between(last)
    })
}

fn normalized(sums: Vec<DVec3>) -> Vec<Vec3> {
    let normal = |sum: DVec3| sum.normalize_or_zero().as_vec3();
    sums.into_iter().map(normal).collect()
}

/// Computes one normal per vertex.
fn of_vertices(mesh: &TriangleMesh) -> VertexNormals {
    let welded = Welded::of(mesh);
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    for (triangle, &vertices) in (0..).zip(&mesh.triangles) {
        for (vertex, normal) in vertices.into_iter().zip(weighted(mesh, triangle)) {
            sums[welded.vertex(vertex) as usize] += normal;
        }
    }
    for vertex in 0..sums.len() as u32 {
        sums[vertex as usize] = sums[welded.vertex(vertex) as usize];
    }
    VertexNormals {
        normals: normalized(sums),
        indices: Indices::OfVertices,
    }
}

/// Uses the file's normals where corners have one. Other corners get one normal per vertex and smoothing group, or the
/// triangle's normal if the triangle is in group 0.
fn mixed(mesh: &TriangleMesh) -> VertexNormals {
    let welded = Welded::of(mesh);
    let mut sums: Vec<DVec3> = from_file(mesh).collect();
    let mut by_group: HashMap<(u32, u32), u32> = HashMap::new();
    let mut own = Vec::with_capacity(mesh.triangles.len());
    let groups = mesh.attributes.smoothing.as_ref();
    let group_of = |triangle: u32| groups.map_or(0, |groups| groups.of(triangle));
    let is_flat = |triangle: u32| groups.is_some() && group_of(triangle) == 0;
    for (triangle, &vertices) in (0..).zip(&mesh.triangles) {
        let given = mesh.attributes.normals.indices(triangle);
        let mut of_triangle = None;
        own.push([0, 1, 2].map(|k| {
            if given[k] != NO_INDEX {
                return given[k];
            }
            if is_flat(triangle) {
                return *of_triangle.get_or_insert_with(|| {
                    sums.push(unit_normal(mesh.corners(triangle)));
                    sums.len() as u32 - 1
                });
            }
            let key = (welded.vertex(vertices[k]), group_of(triangle));
            *by_group.entry(key).or_insert_with(|| {
                sums.push(DVec3::ZERO);
                sums.len() as u32 - 1
            })
        }));
    }
    // Triangles with normals in the file also contribute to computed normals of their neighbours.
    for (triangle, &vertices) in (0..).zip(&mesh.triangles) {
        if is_flat(triangle) {
            continue;
        }
        for (vertex, normal) in vertices.into_iter().zip(weighted(mesh, triangle)) {
            let key = (welded.vertex(vertex), group_of(triangle));
            if let Some(&index) = by_group.get(&key) {
                sums[index as usize] += normal;
            }
        }
    }
    VertexNormals {
        normals: normalized(sums),
        indices: Indices::Own(own),
    }
}

/// Computes one normal per fan of triangles around a vertex without creases between them.
fn creased(mesh: &TriangleMesh, radians: f32) -> VertexNormals {
    let welded = Welded::of(mesh);
    let normal_of = |triangle| unit_normal(mesh.corners(triangle));
    let is_smooth = |a: &EdgeUse, b: &EdgeUse| {
        let angle = normal_of(a.triangle).angle_between(normal_of(b.triangle));
        angle <= f64::from(radians)
    };
    let mut fans = VertexFans::of(mesh, &EdgeTable::welded(mesh, &welded), is_smooth);
    let (mut sums, mut of_fan) = (Vec::new(), vec![NO_INDEX; 3 * mesh.triangles.len()]);
    let mut own = Vec::with_capacity(mesh.triangles.len());
    for triangle in 0..mesh.triangles.len() as u32 {
        let weighted = weighted(mesh, triangle);
        own.push([0, 1, 2].map(|k| {
            let index = &mut of_fan[fans.find(3 * triangle + k) as usize];
            if *index == NO_INDEX {
                *index = sums.len() as u32;
                sums.push(DVec3::ZERO);
            }
            sums[*index as usize] += weighted[k as usize];
            *index
        }));
    }
    VertexNormals {
        normals: normalized(sums),
        indices: Indices::Own(own),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{CornerValues, Runs};
    use std::f32::consts::PI;

    /// The two sides of a roof, with the ridge from (0, 0, 1) to (0, 1, 1).
    fn roof() -> TriangleMesh {
        let positions = vec![
            Vec3::new(0.0, 0.0, 1.0),
            Vec3::new(0.0, 1.0, 1.0),
            Vec3::new(-1.0, 0.0, 0.0),
            Vec3::new(1.0, 0.0, 0.0),
            Vec3::new(-0.0, 1.0, 1.0),
        ];
        TriangleMesh::new(positions, vec![[0, 1, 2], [0, 3, 4]])
    }

    fn normals(mesh: &TriangleMesh, crease: Crease) -> [[Vec3; 3]; 2] {
        let normals = VertexNormals::of(mesh, crease);
        [0, 1].map(|triangle| normals.of_triangle(mesh, triangle))
    }

    /// Whether `a` is the direction of `b`, rounded to f32. The components are at most 1, so each is off by at most
    /// 2⁻²⁵ and the vector by at most √3 times that.
    fn is_near(a: Vec3, b: Vec3) -> bool {
        (a.as_dvec3() - b.as_dvec3().normalize()).length() < 2f64.powi(-24)
    }

    #[test]
    fn a_seam_of_duplicate_vertices_is_smooth() {
        let [left, right] = normals(&roof(), Crease::FromFile);
        assert_eq!(left[1], right[2]);
        assert!(is_near(left[1], Vec3::Z), "{left:?}");
        assert!(is_near(left[2], Vec3::new(-1.0, 0.0, 1.0)));
    }

    #[test]
    fn the_files_normals_take_precedence_per_corner() {
        let mut mesh = roof();
        let given = |right: [u32; 3]| CornerValues::new(vec![Vec3::Y * 2.0], [[0; 3], right]);
        mesh.attributes.normals = given([NO_INDEX; 3]);
        let [left, right] = normals(&mesh, Crease::FromFile);
        assert_eq!(left, [Vec3::Y; 3]);
        // The right triangle's normals are computed, with the left triangle's contribution.
        assert!(is_near(right[0], Vec3::Z), "{right:?}");
        // A normal in the file for one corner only.
        mesh.attributes.normals = given([NO_INDEX, 0, NO_INDEX]);
        let [_, right] = normals(&mesh, Crease::FromFile);
        assert_eq!(right[1], Vec3::Y);
        assert!(is_near(right[0], Vec3::Z), "{right:?}");
        mesh.attributes.normals = given([0; 3]);
        assert_eq!(normals(&mesh, Crease::FromFile), [[Vec3::Y; 3]; 2]);
    }

    #[test]
    fn edges_are_smooth_within_and_creased_between_smoothing_groups() {
        let (left, right) = (Vec3::new(-1.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 1.0));
        for (groups, ridge) in [
            ([2, 2], [Vec3::Z, Vec3::Z]),
            ([1, 2], [left, right]),
            ([0, 0], [left, right]),
            ([0, 1], [left, right]),
        ] {
            let mut mesh = roof();
            let smoothing = mesh.attributes.smoothing.insert(Runs::default());
            for (triangle, group) in (0..).zip(groups) {
                smoothing.begin(triangle, group);
            }
            let found = normals(&mesh, Crease::FromFile).map(|corners| corners[0]);
            let is_right = is_near(found[0], ridge[0]) && is_near(found[1], ridge[1]);
            assert!(is_right, "{groups:?}: {found:?}");
        }
    }

    #[test]
    fn an_edge_is_a_crease_above_its_angle_regardless_of_the_file() {
        let mut mesh = roof();
        mesh.attributes.normals = CornerValues::new(vec![Vec3::Y], [[0; 3]; 2]);
        let ridge = |degrees: f32| normals(&mesh, Crease::Above(degrees * PI / 180.0))[0][0];
        assert!(is_near(ridge(91.0), Vec3::Z), "{}", ridge(91.0));
        assert!(
            is_near(ridge(89.0), Vec3::new(-1.0, 0.0, 1.0)),
            "{}",
            ridge(89.0)
        );
    }

    #[test]
    fn normals_that_cancel_give_a_zero_normal() {
        let mut mesh = roof();
        mesh.triangles = vec![[0, 1, 2], [0, 2, 1]];
        assert_eq!(normals(&mesh, Crease::FromFile)[0][0], Vec3::ZERO);
    }
}
