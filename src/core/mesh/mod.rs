//! Triangle meshes.
//!
//! An indexed mesh as given by the file: each vertex once, triangles as three indices, and for each triangle
//! the polygon that it came from, so that a wireframe can hide triangulation diagonals.

mod area;
mod attributes;
pub mod corridors;
mod edges;
mod faces;
mod health;
mod material;
mod normals;
mod per_triangle;
mod runs;
pub mod shapes;
mod strips;
mod texture;
mod weld;

pub use area::has_zero_area;
pub use attributes::{Assigned, Attributes, CornerValues};
pub use faces::Faces;
pub use health::{FLAWS, Flaw, FlawInfo, FlawLocations, Health, SLIVER_ASPECT};
pub use material::{Illumination, Material, TextureMap};
pub use normals::{Crease, VertexNormals};
pub use per_triangle::PerTriangle;
pub use runs::Runs;
pub use strips::bytes_as;
pub use texture::Texture;
use weld::Welded;

use crate::aabb::Aabb;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Mesh sizes at which f32 kernels work best: from a distance of ten times the size, products of two lengths
/// stay well inside the range of f32.
pub const SAFE_SIZE: std::ops::RangeInclusive<f64> = 1e-15..=1e16;

/// The unit normal by the right-hand rule over A, B, C; zero for a triangle of zero area, and for one too
/// thin for f64.
///
/// Computed in f64, where neither products nor lengths of f32 numbers under- or overflow.
pub fn unit_normal(corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero()
}

/// Marks a corner without a normal or texture coordinates in per-corner lists.
pub const NO_INDEX: u32 = u32::MAX;

/// An indexed triangle mesh. Its positions are f32 relative to an f64 origin; kernels test exactly these
/// positions.
///
/// No triangle has zero area or a corner that isn't finite: no ray can hit those.
#[derive(Clone, Debug, Default)]
pub struct TriangleMesh {
    origin: DVec3,
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    face_count: usize,
    attributes: Attributes,
}

impl TriangleMesh {
    /// A mesh of triangles, each three indices into the positions, without those that no ray can hit: of zero area or with
    /// a corner that isn't finite. Its origin is (0, 0, 0), each triangle is a face, and there are no other attributes.
    ///
    /// # Panics
    /// An index is out of range.
    pub fn new(positions: Vec<Vec3>, mut triangles: Vec<[u32; 3]>) -> Self {
        triangles.retain(|triangle| {
            let corners = triangle.map(|vertex| positions[vertex as usize]);
            corners.iter().all(|p| p.is_finite()) && !has_zero_area(corners)
        });
        Self::of_valid(positions, triangles)
    }

    /// [`new`](Self::new) for triangles of which none has to be dropped.
    pub(crate) fn of_valid(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        Self {
            origin: DVec3::ZERO,
            positions,
            face_count: triangles.len(),
            triangles,
            attributes: Attributes::default(),
        }
    }

    /// The same positions relative to another point of the file's coordinates: the mesh is moved.
    #[must_use]
    pub fn with_origin(self, origin: DVec3) -> Self {
        Self { origin, ..self }
    }

    /// The mesh with its vertices moved, and as [`new`](Self::new) makes it otherwise.
    #[must_use]
    pub fn moved(&self, to: impl Fn(Vec3) -> Vec3) -> Self {
        let positions = self.positions.iter().map(|&p| to(p)).collect();
        Self::new(positions, self.triangles.clone())
    }

    /// The same surface with other attributes.
    ///
    /// # Panics
    /// There are colours, but not as many as positions; or a line or a point has a vertex that doesn't exist.
    #[must_use]
    pub fn with_attributes(self, attributes: Attributes) -> Self {
        let (count, colours) = (self.positions.len(), attributes.colours.len());
        assert!(colours == 0 || colours == count, "a colour per position");
        let ends = attributes.lines.as_flattened().iter();
        let mut vertices = ends.chain(&attributes.points);
        assert!(
            vertices.all(|&vertex| (vertex as usize) < count),
            "a vertex of a line or a point that doesn't exist"
        );
        Self {
            face_count: attributes.faces.count(self.triangles.len()),
            attributes,
            ..self
        }
    }

    /// The file's coordinates of the positions' origin (0, 0, 0).
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The vertices in use, relative to [`origin`](Self::origin), in the file's order.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Triangles as three indices into the positions.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|v| self.positions[v as usize])
    }

    /// What the mesh has besides its surface.
    pub fn attributes(&self) -> &Attributes {
        &self.attributes
    }

    /// The file's face (counted from 0) that contains a triangle.
    pub fn face_of(&self, triangle: u32) -> u32 {
        self.attributes.faces.of(triangle)
    }

    /// Number of faces that the triangles come from, without dropped ones.
    pub fn face_count(&self) -> usize {
        self.face_count
    }

    /// The box around all triangles.
    pub fn bounds(&self) -> Aabb {
        let of = |triangle: &[u32; 3]| {
            Aabb::around(triangle.map(|vertex| self.positions[vertex as usize]))
        };
        let boxes = self.triangles.par_iter().map(of);
        boxes.reduce(|| Aabb::EMPTY, Aabb::union)
    }

    /// The box around all lines and points.
    pub fn element_bounds(&self) -> Aabb {
        let vertices = self.attributes.lines.as_flattened().iter();
        let vertices = vertices.chain(&self.attributes.points);
        Aabb::around(vertices.map(|&vertex| self.positions[vertex as usize]))
    }

    /// The corners of every triangle.
    pub fn corner_list(&self) -> Vec<[Vec3; 3]> {
        let count = self.triangles.len() as u32;
        (0..count).map(|triangle| self.corners(triangle)).collect()
    }

    /// A point of the mesh in the file's coordinates.
    pub fn in_file(&self, p: DVec3) -> DVec3 {
        p + self.origin
    }

    /// Whether all positions are also f32 numbers in the file's coordinates: with the origin at (0, 0, 0)
    /// they would be the same points.
    pub fn are_f32_in_file(&self) -> bool {
        let is_f32 = |own: f32, origin: f64| {
            let (own, in_file) = (f64::from(own), f64::from(own) + origin);
            // Both differences equal the terms only if the sum isn't rounded.
            let is_exact = in_file - origin == own && in_file - own == origin;
            is_exact && f64::from(in_file as f32) == in_file
        };
        let are_f32_coordinates = |p: &Vec3| (0..3).all(|axis| is_f32(p[axis], self.origin[axis]));
        self.positions.par_iter().all(are_f32_coordinates)
    }

    /// A vertex as written in the file: of all coordinates that would have been loaded as this vertex, those
    /// with the fewest digits.
    pub fn vertex_in_file(&self, p: Vec3) -> DVec3 {
        let shortest = |axis: usize| {
            let (origin, own) = (self.origin[axis], p[axis]);
            let exact = f64::from(own) + origin;
            // 17 digits distinguish every f64.
            let rounded = (0..17).filter_map(|digits| format!("{exact:.digits$e}").parse().ok());
            rounded
                .into_iter()
                .find(|x: &f64| (x - origin) as f32 == own)
                .unwrap_or(exact)
        };
        DVec3::new(shortest(0), shortest(1), shortest(2))
    }

    /// [`unit_normal`], rounded to f32.
    pub fn geometric_normal(&self, triangle: u32) -> Vec3 {
        unit_normal(self.corners(triangle)).as_vec3()
    }

    /// Whether there are lines or points besides triangles.
    pub fn has_elements(&self) -> bool {
        !self.attributes.lines.is_empty() || !self.attributes.points.is_empty()
    }

    /// Number of materials that faces name.
    pub fn named_material_count(&self) -> usize {
        self.attributes.materials.entries().len().saturating_sub(1)
    }

    /// Number of groups and objects that contain faces.
    pub fn named_group_count(&self) -> usize {
        self.attributes.groups.entries().len().saturating_sub(1)
    }

    /// Name and size in bytes of each part.
    pub fn bytes(&self) -> [(&'static str, usize); 6] {
        let Attributes {
            faces,
            normals,
            texture_coordinates,
            colours,
            materials,
            groups,
            smoothing,
            textures,
            lines,
            points,
        } = &self.attributes;
        let smoothing = smoothing.as_ref().map_or(0, Runs::bytes);
        let textures: usize = textures.iter().map(Texture::bytes).sum();
        [
            ("positions", size_of_val(&self.positions[..])),
            ("triangles", size_of_val(&self.triangles[..])),
            ("normals", normals.bytes()),
            (
                "faces",
                faces.bytes() + materials.bytes() + groups.bytes() + smoothing,
            ),
            (
                "colours and textures",
                size_of_val(&colours[..]) + texture_coordinates.bytes() + textures,
            ),
            (
                "lines and points",
                size_of_val(&lines[..]) + size_of_val(&points[..]),
            ),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vertex_is_printed_as_in_the_file_far_from_the_origin_and_near_it() {
        for (origin, written) in [
            (500_000.0, 500_000.001),
            (4_649_776.0, 4_649_776.25),
            (0.0, 0.1),
            (0.0, -1.234_567e-20),
            // These have 14 and 16 digits: fewer digits give another vertex, and the exact f64 is another
            // number.
            (4_649_776.0, 4_649_776.123_456_7),
            (1.0, 1.000_000_012_345_679),
        ] {
            let mesh = TriangleMesh::default().with_origin(DVec3::splat(origin));
            let own = Vec3::splat((written - origin) as f32);
            assert_eq!(mesh.vertex_in_file(own), DVec3::splat(written));
        }
    }

    #[test]
    fn positions_are_f32_in_the_file_if_their_sums_with_the_origin_are() {
        let are_f32 = |origin: f64, own: f32| {
            let mesh = TriangleMesh::new(vec![Vec3::splat(own)], Vec::new());
            mesh.with_origin(DVec3::splat(origin)).are_f32_in_file()
        };
        assert!(are_f32(0.0, 0.1) && are_f32(1000.0, 0.25) && are_f32(-3.0, 4.0));
        // 1000.1 isn't an f32, nor is a sum that only rounding makes one.
        assert!(!are_f32(1000.0, 0.1) && !are_f32(1000.0, 1e-20));
    }

    #[test]
    fn triangles_that_no_ray_can_hit_are_left_out() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN, 2.0 * Vec3::X];
        let triangles = vec![[0, 1, 4], [0, 1, 2], [0, 1, 3]];
        let mesh = TriangleMesh::new(positions, triangles);
        assert_eq!((mesh.triangles(), mesh.face_count()), (&[[0, 1, 2]][..], 1));
    }

    #[test]
    #[should_panic(expected = "a colour per position")]
    fn colours_are_as_many_as_positions() {
        let attributes = Attributes {
            colours: vec![Vec3::ONE],
            ..Attributes::default()
        };
        _ = TriangleMesh::default().with_attributes(attributes);
    }
}
