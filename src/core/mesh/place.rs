//! The places of a mesh's elements: where to look to see one.

use super::{TriangleMesh, unit_normal};
use crate::aabb::Aabb;
use glam::{DVec3, Vec3};

/// Where an element of a mesh is, in the mesh's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementPlace {
    /// The point to look at: the element's centroid, or the vertex.
    pub centre: DVec3,
    /// The box around the element; for a vertex, around the triangles that meet there.
    pub bounds: Aabb,
    /// The unit normal by the right-hand rule, averaged over the element's triangles by area. Zero if there is none.
    pub normal: DVec3,
}

impl TriangleMesh {
    /// The place of a triangle; `None` if the mesh has no such triangle.
    pub fn place_of_triangle(&self, triangle: u32) -> Option<ElementPlace> {
        let is_there = (triangle as usize) < self.triangles.len();
        is_there.then(|| self.place_of_triangles([triangle]))
    }

    /// The place of a face of the file; `None` if no triangle belongs to it.
    pub fn place_of_face(&self, face: u32) -> Option<ElementPlace> {
        let triangles = self.triangles_of_face(face);
        (!triangles.is_empty()).then(|| self.place_of_triangles(triangles))
    }

    /// The triangles of a face of the file.
    pub fn triangles_of_face(&self, face: u32) -> std::ops::Range<u32> {
        // Faces ascend.
        let first_from = |face: u64| {
            let (mut low, mut high) = (0, self.triangles.len() as u32);
            while low < high {
                let middle = low + (high - low) / 2;
                if u64::from(self.face_of(middle)) < face {
                    low = middle + 1;
                } else {
                    high = middle;
                }
            }
            low
        };
        first_from(face.into())..first_from(u64::from(face) + 1)
    }

    /// The place of a vertex, by its index in [`positions`](Self::positions); `None` if there is none or its position isn't
    /// finite.
    pub fn place_of_vertex(&self, vertex: u32) -> Option<ElementPlace> {
        self.place_of_point(*self.positions.get(vertex as usize)?)
    }

    /// The place of a vertex of any element at this position, which may also be a point of the file that no triangle uses;
    /// `None` if it isn't finite.
    pub fn place_of_point(&self, position: Vec3) -> Option<ElementPlace> {
        let meets = |&triangle: &u32| self.corners(triangle).contains(&position);
        let triangles = (0..self.triangles.len() as u32).filter(meets);
        let place = self.place_of_triangles(triangles);
        position.is_finite().then(|| ElementPlace {
            centre: position.as_dvec3(),
            bounds: place.bounds.union(Aabb::around([position])),
            normal: place.normal,
        })
    }

    fn place_of_triangles(&self, triangles: impl IntoIterator<Item = u32>) -> ElementPlace {
        let (mut bounds, mut areas, mut weighted) = (Aabb::EMPTY, 0.0, DVec3::ZERO);
        let mut normal = DVec3::ZERO;
        for triangle in triangles {
            let corners = self.corners(triangle);
            bounds = bounds.union(Aabb::around(corners));
            let [a, b, c] = corners.map(Vec3::as_dvec3);
            let area = 0.5 * (b - a).cross(c - a).length();
            areas += area;
            weighted += area / 3.0 * (a + b + c);
            normal += area * unit_normal(corners);
        }
        ElementPlace {
            // Areas of finite triangles may vanish only by underflow.
            centre: if areas > 0.0 {
                weighted / areas
            } else {
                bounds.centre().as_dvec3()
            },
            bounds,
            normal: normal.normalize_or_zero(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Attributes, Faces};

    /// A square of two triangles, which is face 1, and a triangle above it, which is face 3.
    fn mesh() -> TriangleMesh {
        let positions = [
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [2.0, 2.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.0, 0.0, 6.0],
        ];
        let mut faces = Faces::default();
        for (triangle, face, outline) in [(0, 1, 0b011), (1, 1, 0b110), (2, 3, 0b111)] {
            faces.push(triangle, face, outline);
        }
        TriangleMesh::new(
            positions.map(Vec3::from).to_vec(),
            vec![[0, 1, 2], [0, 2, 3], [0, 1, 4]],
        )
        .with_attributes(Attributes {
            faces,
            ..Attributes::default()
        })
    }

    #[test]
    fn triangles_faces_and_vertices_have_a_centre_a_box_and_a_normal() {
        let mesh = mesh();
        let triangle = mesh.place_of_triangle(2).expect("there");
        assert!((triangle.centre - DVec3::new(2.0 / 3.0, 0.0, 2.0)).length() < 1e-15);
        assert_eq!(triangle.normal, DVec3::NEG_Y);
        let face = mesh.place_of_face(1).expect("there");
        assert!((face.centre - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-15);
        assert_eq!(
            face.bounds,
            Aabb::around([Vec3::ZERO, Vec3::new(2.0, 2.0, 0.0)])
        );
        assert_eq!(face.normal, DVec3::Z);
        let vertex = mesh.place_of_vertex(4).expect("there");
        assert_eq!(vertex.centre, DVec3::new(0.0, 0.0, 6.0));
        assert_eq!(vertex.bounds, triangle.bounds);
    }

    #[test]
    fn missing_elements_have_no_place() {
        let mesh = mesh();
        assert_eq!(mesh.place_of_triangle(3), None);
        for missing in [0, 2, 4, u32::MAX] {
            assert_eq!(mesh.place_of_face(missing), None, "{missing}");
        }
        assert_eq!(mesh.triangles_of_face(3), 2..3);
        assert_eq!(mesh.place_of_vertex(5), None);
        assert_eq!(mesh.place_of_point(Vec3::NAN), None);
        let free = mesh.place_of_point(Vec3::ONE).expect("finite");
        assert_eq!((free.centre, free.normal), (DVec3::ONE, DVec3::ZERO));
    }
}
