//! Indexed triangle meshes.
//!
//! Vertices are stored once, as in the file, and triangles as three vertex indices. Each triangle also refers to the
//! polygon that it came from, so that a wireframe can hide triangulation diagonals.

mod area;
mod attributes;
pub mod corridors;
mod edges;
mod faces;
mod health;
mod material;
mod normals;
mod per_triangle;
mod place;
mod relief;
mod runs;
mod sampling;
pub mod shapes;
mod strips;
mod texture;
mod texture_frame;
mod texture_map;
mod weld;

pub use area::has_zero_area;
pub(crate) use area::{aspect, two_sum};
pub use attributes::{Assigned, Attributes, CornerValues};
pub use faces::Faces;
pub use health::{FLAWS, Flaw, FlawInfo, FlawLocations, Health, SLIVER_ASPECT};
pub use material::{Illumination, Material, Property, Side, Sides};
pub use normals::{Crease, VertexNormals};
pub use per_triangle::PerTriangle;
pub use place::ElementPlace;
pub use relief::{Bitangent, HeightUnit, Relief, ReliefKind, Tilt};
pub use runs::Runs;
pub use sampling::{Encoding, Filter, Sampling, Wrap};
pub use strips::bytes_as;
pub use texture::Texture;
pub use texture_frame::TextureFrame;
pub use texture_map::TextureMap;

use crate::aabb::Aabb;
use crate::shape::{Primitives, Triangle};
use crate::simd::{baseline, prefetch};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use weld::Welded;

/// Range of mesh sizes that f32 kernels handle well: from a distance of ten times the size, products of two lengths
/// stay well inside the range of f32.
pub const SAFE_SIZE: std::ops::RangeInclusive<f64> = 1e-15..=1e16;

/// See [`Triangle::unit_normal`].
pub fn unit_normal(corners: [Vec3; 3]) -> DVec3 {
    Triangle(corners).unit_normal()
}

/// Maximum number of triangles, so that a u32 can number their corners.
pub(crate) const MAX_TRIANGLES: usize = u32::MAX as usize / 3;

/// The index of a corner without a normal or texture coordinates.
pub const NO_INDEX: u32 = u32::MAX;

/// An indexed triangle mesh with f32 positions relative to an f64 origin. Kernels test exactly these positions.
///
/// Every triangle has finite corners and an area above zero, because no ray can hit others.
#[derive(Clone, Debug, Default)]
pub struct TriangleMesh {
    origin: DVec3,
    positions: Vec<Vec3>,
    triangles: Vec<[u32; 3]>,
    face_count: usize,
    attributes: Attributes,
}

impl Primitives<Triangle> for TriangleMesh {
    fn count(&self) -> usize {
        self.triangles.len()
    }

    #[inline]
    fn primitive(&self, index: u32) -> Triangle {
        Triangle(self.corners(index))
    }
}

impl TriangleMesh {
    /// Creates a mesh from triangles, each three indices into the positions. Triangles that no ray can hit are dropped:
    /// those of zero area or with a corner that isn't finite.
    ///
    /// The origin is (0, 0, 0), each triangle is a face, and there are no other attributes.
    ///
    /// # Panics
    /// If an index is out of range, or there are more than 2³²/3 triangles.
    pub fn new(positions: Vec<Vec3>, mut triangles: Vec<[u32; 3]>) -> Self {
        triangles.retain(|triangle| {
            let corners = triangle.map(|vertex| positions[vertex as usize]);
            corners.iter().all(|p| p.is_finite()) && !has_zero_area(corners)
        });
        Self::new_unchecked(positions, triangles)
    }

    /// [`new`](Self::new) without its check, for triangles with finite corners and an area above zero.
    pub(crate) fn new_unchecked(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Self {
        assert!(triangles.len() <= MAX_TRIANGLES, "too many triangles");
        Self {
            origin: DVec3::ZERO,
            positions,
            face_count: triangles.len(),
            triangles,
            attributes: Attributes::default(),
        }
    }

    /// Moves the mesh: the positions stay the same, and the origin becomes this point in the file's coordinates.
    ///
    /// # Panics
    /// If the origin isn't finite.
    #[must_use]
    pub fn with_origin(self, origin: DVec3) -> Self {
        assert!(origin.is_finite(), "a finite origin");
        Self { origin, ..self }
    }

    /// Applies `to` to each position and makes a [`new`](Self::new) mesh of the same triangles, without this mesh's
    /// origin and attributes.
    #[must_use]
    pub fn map_positions(&self, to: impl Fn(Vec3) -> Vec3) -> Self {
        let positions = self.positions.iter().map(|&p| to(p)).collect();
        Self::new(positions, self.triangles.clone())
    }

    /// Replaces the attributes. Per-triangle attributes follow [`triangles`](Self::triangles), without dropped ones.
    ///
    /// # Panics
    /// If the number of colours is neither 0 nor that of positions, a line or point refers to a
    /// missing vertex, or an attribute is of a missing triangle.
    #[must_use]
    pub fn with_attributes(self, attributes: Attributes) -> Self {
        let (count, colours) = (self.positions.len(), attributes.colours.len());
        assert!(colours == 0 || colours == count, "one colour per position");
        let ends = attributes.lines.as_flattened().iter();
        let mut vertices = ends.chain(&attributes.points);
        assert!(
            vertices.all(|&vertex| (vertex as usize) < count),
            "a line or point refers to a missing vertex"
        );
        let triangles = self.triangles.len();
        assert!(
            attributes.end() <= triangles,
            "an attribute of a missing triangle"
        );
        Self {
            face_count: attributes.faces.count(triangles),
            attributes,
            ..self
        }
    }

    /// The origin of the positions, in the file's coordinates.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Vertex positions relative to [`origin`](Self::origin), in the file's order. The OBJ reader keeps only the
    /// vertices in use; positions outside triangles may be NaN or infinite.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// The triangles, each three indices into the positions.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corner positions of a triangle.
    #[inline]
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|v| self.positions[v as usize])
    }

    /// Prefetches the corners of triangles that will be looked up soon: they are spread over memory.
    pub(crate) fn prefetch_corners(&self, triangles: impl Iterator<Item = u32> + Clone) {
        let token = baseline();
        for triangle in triangles.clone() {
            prefetch(
                token,
                &self.triangles,
                triangle as usize,
                size_of::<[u32; 3]>(),
            );
        }
        for vertex in triangles.flat_map(|triangle| self.triangles[triangle as usize]) {
            prefetch(token, &self.positions, vertex as usize, size_of::<Vec3>());
        }
    }

    /// The mesh's attributes.
    pub fn attributes(&self) -> &Attributes {
        &self.attributes
    }

    /// The index of the file's face that contains a triangle, from 0.
    pub fn face_of(&self, triangle: u32) -> u32 {
        self.attributes.faces.of(triangle)
    }

    /// Number of faces that have a triangle.
    pub fn face_count(&self) -> usize {
        self.face_count
    }

    /// The bounding box of all triangles; empty if there are none.
    pub fn bounds(&self) -> Aabb {
        let of = |triangle: &[u32; 3]| {
            Aabb::around(triangle.map(|vertex| self.positions[vertex as usize]))
        };
        let boxes = self.triangles.par_iter().map(of);
        boxes.reduce(|| Aabb::EMPTY, Aabb::union)
    }

    /// The bounding box of all lines and points; empty if there are none.
    pub fn line_and_point_bounds(&self) -> Aabb {
        let vertices = self.attributes.lines.as_flattened().iter();
        let vertices = vertices.chain(&self.attributes.points);
        Aabb::around(vertices.map(|&vertex| self.positions[vertex as usize]))
    }

    /// The corner positions of every triangle.
    pub fn corner_list(&self) -> Vec<[Vec3; 3]> {
        let count = self.triangles.len() as u32;
        (0..count).map(|triangle| self.corners(triangle)).collect()
    }

    /// Converts a point from the mesh's coordinates to the file's.
    pub fn in_file(&self, p: DVec3) -> DVec3 {
        p + self.origin
    }

    /// Whether every position has f32 coordinates in the file's frame too: moving the origin to (0, 0, 0) would round
    /// none. False if a position isn't finite.
    pub fn are_f32_in_file(&self) -> bool {
        let is_f32 = |own: f32, origin: f64| {
            let (own, in_file) = (f64::from(own), f64::from(own) + origin);
            // Each difference equals the other term only if the sum isn't rounded.
            let is_exact = in_file - origin == own && in_file - own == origin;
            is_exact && f64::from(in_file as f32) == in_file
        };
        let are_f32_coordinates = |p: &Vec3| (0..3).all(|axis| is_f32(p[axis], self.origin[axis]));
        self.positions.par_iter().all(are_f32_coordinates)
    }

    /// A vertex as written in the file: of all coordinates that load as this vertex, those with the fewest digits.
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

    /// The [`unit_normal`] of a triangle, rounded to f32.
    pub fn geometric_normal(&self, triangle: u32) -> Vec3 {
        unit_normal(self.corners(triangle)).as_vec3()
    }

    /// Whether the mesh has lines or points.
    pub fn has_lines_or_points(&self) -> bool {
        !self.attributes.lines.is_empty() || !self.attributes.points.is_empty()
    }

    /// Number of materials with a name.
    pub fn named_material_count(&self) -> usize {
        let materials = self.attributes.materials.entries().iter();
        materials
            .filter(|material| !material.name.is_empty())
            .count()
    }

    /// Number of groups and objects that contain faces.
    pub fn named_group_count(&self) -> usize {
        self.attributes.groups.entries().len().saturating_sub(1)
    }

    /// Memory of each part of the mesh: its name and size in bytes.
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
    fn a_vertex_is_printed_as_in_the_file_near_and_far_from_the_origin() {
        for (origin, written) in [
            (500_000.0, 500_000.001),
            (4_649_776.0, 4_649_776.25),
            (0.0, 0.1),
            (0.0, -1.234_567e-20),
            // 14 and 16 digits: fewer digits load as another vertex, and the exact f64 is another number.
            (4_649_776.0, 4_649_776.123_456_7),
            (1.0, 1.000_000_012_345_679),
        ] {
            let mesh = TriangleMesh::default().with_origin(DVec3::splat(origin));
            let own = Vec3::splat((written - origin) as f32);
            assert_eq!(mesh.vertex_in_file(own), DVec3::splat(written));
        }
    }

    #[test]
    fn positions_are_f32_in_the_file_if_their_exact_sums_with_the_origin_are() {
        let are_f32 = |origin: f64, own: f32| {
            let mesh = TriangleMesh::new(vec![Vec3::splat(own)], Vec::new());
            mesh.with_origin(DVec3::splat(origin)).are_f32_in_file()
        };
        assert!(are_f32(0.0, 0.1) && are_f32(1000.0, 0.25) && are_f32(-3.0, 4.0));
        // 1000.1 isn't an f32. 1000 + 1e-20 isn't either, but rounds to one.
        assert!(!are_f32(1000.0, 0.1) && !are_f32(1000.0, 1e-20));
    }

    #[test]
    fn triangles_that_no_ray_can_hit_are_dropped() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::NAN, 2.0 * Vec3::X];
        let triangles = vec![[0, 1, 4], [0, 1, 2], [0, 1, 3]];
        let mesh = TriangleMesh::new(positions, triangles);
        assert_eq!((mesh.triangles(), mesh.face_count()), (&[[0, 1, 2]][..], 1));
    }

    #[test]
    #[should_panic(expected = "one colour per position")]
    fn a_wrong_number_of_colours_panics() {
        let attributes = Attributes {
            colours: vec![Vec3::ONE],
            ..Attributes::default()
        };
        _ = TriangleMesh::default().with_attributes(attributes);
    }
}
