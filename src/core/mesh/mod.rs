//! Triangle meshes.
//!
//! An indexed mesh as given by the file: each vertex once, triangles as three indices, and for each triangle
//! the polygon that it came from, so that a wireframe can hide triangulation diagonals.

mod area;
pub mod corridors;
mod edges;
mod health;
mod material;
mod normals;
mod runs;
pub mod shapes;
mod strips;
mod texture;
mod weld;

pub use area::has_zero_area;
pub use health::{FLAWS, Flaw, FlawInfo, FlawLocations, Health, SLIVER_ASPECT};
pub use material::{Illumination, Material, TextureMap};
pub use normals::{Crease, VertexNormals};
pub use runs::Runs;
pub use strips::bytes_as;
pub use texture::Texture;
use weld::Welded;

use crate::aabb::Aabb;
use glam::{DVec3, Vec2, Vec3};
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

/// Counts of the file's triangles and other elements that were dropped, by reason.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// Triangles whose area is exactly zero after rounding their corners to f32.
    pub zero_area: usize,
    /// Triangles with a corner that is NaN, infinite or too large for f32.
    pub non_finite: usize,
    /// Faces (not triangles) with an invalid index or fewer than three corners.
    pub bad_index: usize,
    /// Lines and points, dropped for any of these reasons.
    pub elements: usize,
}

/// Smoothing groups: edges between triangles of the same group are smooth, all others are creases.
#[derive(Clone, Debug, Default)]
pub struct Smoothing {
    /// Whether the file has smoothing groups; without them all triangles are smooth.
    pub has_groups: bool,
    /// The group of each triangle; 0 is flat.
    pub groups: Runs,
}

/// An indexed triangle mesh. Its positions are f32 relative to an f64 origin; kernels test exactly these
/// positions.
///
/// A list is empty if the file has no content for it. All other per-triangle lists have the same length.
#[derive(Clone, Debug, Default)]
pub struct TriangleMesh {
    /// The file's coordinates of the positions' origin (0, 0, 0).
    pub origin: DVec3,
    /// The vertices in use, relative to [`origin`](Self::origin), in the file's order.
    pub positions: Vec<Vec3>,
    /// Three indices into the positions; no triangle has zero area or a non-finite corner.
    pub triangles: Vec<[u32; 3]>,
    /// See [`face_of`](Self::face_of). Empty if triangle k is face k.
    pub faces: Vec<u32>,
    /// See [`outline_of`](Self::outline_of). Empty if all faces are triangles.
    pub outline: Vec<u8>,
    /// Per triangle, the index into [`materials`](Self::materials).
    pub material: Runs,
    /// Per triangle, the index into [`groups`](Self::groups).
    pub group: Runs,
    /// The smoothing groups.
    pub smoothing: Smoothing,
    /// Vertex colours, sRGB from 0 to 1. As many as positions, or none.
    pub colours: Vec<Vec3>,
    /// The file's normals, unchanged: not always unit length.
    pub normals: Vec<Vec3>,
    /// Per triangle, the indices of its corners into the normals, or [`NO_INDEX`].
    pub corner_normals: Vec<[u32; 3]>,
    /// Texture coordinates. Empty if no material has a texture.
    pub texture_coordinates: Vec<Vec2>,
    /// Per triangle, the indices of its corners into the texture coordinates, or [`NO_INDEX`].
    pub corner_textures: Vec<[u32; 3]>,
    /// The ends of line elements, which aren't edges of faces.
    pub lines: Vec<[u32; 2]>,
    /// Vertices of point elements.
    pub points: Vec<u32>,
    /// The materials that faces use; the first one is for faces without a material.
    pub materials: Vec<Material>,
    /// The materials' textures.
    pub textures: Vec<Texture>,
    /// The groups and objects that contain faces; the first one is for faces outside any.
    pub groups: Vec<String>,
    /// Number of polygons that the triangles come from, without dropped ones.
    pub face_count: usize,
    /// Counts of dropped elements.
    pub dropped: Dropped,
}

impl TriangleMesh {
    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|v| self.positions[v as usize])
    }

    /// The file's face (counted from 0) that contains a triangle.
    pub fn face_of(&self, triangle: u32) -> u32 {
        self.faces
            .get(triangle as usize)
            .copied()
            .unwrap_or(triangle)
    }

    /// Bit k is set if the edge from corner k to the next corner is an edge of the polygon, not a diagonal.
    pub fn outline_of(&self, triangle: u32) -> u8 {
        self.outline
            .get(triangle as usize)
            .copied()
            .unwrap_or(0b111)
    }

    /// A triangle's material, if it is known.
    pub fn material_of(&self, triangle: u32) -> Option<&Material> {
        self.materials.get(self.material.of(triangle) as usize)
    }

    /// Appends a triangle of a face. `outline` marks the edges that are edges of the face; see
    /// [`outline_of`](Self::outline_of).
    pub(crate) fn add_triangle(&mut self, corners: [u32; 3], face: u32, outline: u8) {
        let index = self.triangles.len();
        self.triangles.push(corners);
        // A list starts at the first triangle that differs from its default.
        if !self.faces.is_empty() || face as usize != index {
            self.faces.extend(self.faces.len() as u32..index as u32);
            self.faces.push(face);
        }
        if !self.outline.is_empty() || outline != 0b111 {
            self.outline.resize(index, 0b111);
            self.outline.push(outline);
        }
    }

    /// Appends the triangles, lines and points of another mesh with the same vertices, and its counts. Its faces are
    /// numbered from `first_face`.
    pub(crate) fn append(&mut self, mut later: Self, first_face: u32) {
        let (first, count) = (self.triangles.len(), later.triangles.len());
        let is_numbered = !self.faces.is_empty() || !later.faces.is_empty();
        if count > 0 && (is_numbered || first_face as usize != first) {
            self.faces.extend(self.faces.len() as u32..first as u32);
            let faces = (0..count as u32).map(|triangle| first_face + later.face_of(triangle));
            self.faces.extend(faces);
        }
        if !self.outline.is_empty() || !later.outline.is_empty() {
            self.outline.resize(first, 0b111);
            self.outline.append(&mut later.outline);
            self.outline.resize(first + count, 0b111);
        }
        for (own, later) in [
            (&mut self.corner_normals, &mut later.corner_normals),
            (&mut self.corner_textures, &mut later.corner_textures),
        ] {
            if !own.is_empty() || !later.is_empty() {
                own.resize(first, [NO_INDEX; 3]);
                own.append(later);
                own.resize(first + count, [NO_INDEX; 3]);
            }
        }
        self.triangles.append(&mut later.triangles);
        self.lines.append(&mut later.lines);
        self.points.append(&mut later.points);
        self.face_count += later.face_count;
        self.dropped.zero_area += later.dropped.zero_area;
        self.dropped.non_finite += later.dropped.non_finite;
        self.dropped.bad_index += later.dropped.bad_index;
        self.dropped.elements += later.dropped.elements;
    }

    /// Releases the unused capacity of the lists per triangle.
    pub(crate) fn shrink(&mut self) {
        self.triangles.shrink_to_fit();
        self.faces.shrink_to_fit();
        self.outline.shrink_to_fit();
        self.corner_normals.shrink_to_fit();
        self.corner_textures.shrink_to_fit();
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
        let vertices = self.lines.as_flattened().iter().chain(&self.points);
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
        !self.lines.is_empty() || !self.points.is_empty()
    }

    /// Number of materials that faces name.
    pub fn named_material_count(&self) -> usize {
        self.materials.len().saturating_sub(1)
    }

    /// Number of groups and objects that contain faces.
    pub fn named_group_count(&self) -> usize {
        self.groups.len().saturating_sub(1)
    }

    /// Name and size in bytes of each part.
    pub fn bytes(&self) -> [(&'static str, usize); 6] {
        [
            ("positions", size_of_val(&self.positions[..])),
            ("triangles", size_of_val(&self.triangles[..])),
            (
                "normals",
                size_of_val(&self.normals[..]) + size_of_val(&self.corner_normals[..]),
            ),
            (
                "faces",
                size_of_val(&self.faces[..])
                    + size_of_val(&self.outline[..])
                    + self.material.bytes()
                    + self.group.bytes()
                    + self.smoothing.groups.bytes(),
            ),
            (
                "colours and textures",
                size_of_val(&self.colours[..])
                    + size_of_val(&self.texture_coordinates[..])
                    + size_of_val(&self.corner_textures[..])
                    + self.textures.iter().map(Texture::bytes).sum::<usize>(),
            ),
            (
                "lines and points",
                size_of_val(&self.lines[..]) + size_of_val(&self.points[..]),
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
            let mesh = TriangleMesh {
                origin: DVec3::splat(origin),
                ..TriangleMesh::default()
            };
            let own = Vec3::splat((written - origin) as f32);
            assert_eq!(mesh.vertex_in_file(own), DVec3::splat(written));
        }
    }

    #[test]
    fn positions_are_f32_in_the_file_if_their_sums_with_the_origin_are() {
        let are_f32 = |origin: f64, own: f32| {
            let mesh = TriangleMesh {
                origin: DVec3::splat(origin),
                positions: vec![Vec3::splat(own)],
                ..TriangleMesh::default()
            };
            mesh.are_f32_in_file()
        };
        assert!(are_f32(0.0, 0.1) && are_f32(1000.0, 0.25) && are_f32(-3.0, 4.0));
        // 1000.1 isn't an f32, nor is a sum that only rounding makes one.
        assert!(!are_f32(1000.0, 0.1) && !are_f32(1000.0, 1e-20));
    }

    #[test]
    fn per_triangle_lists_start_at_the_first_value_that_differs_from_the_default() {
        let mut mesh = TriangleMesh::default();
        mesh.add_triangle([0, 1, 2], 0, 0b111);
        mesh.add_triangle([0, 1, 2], 1, 0b111);
        assert!(mesh.faces.is_empty() && mesh.outline.is_empty());
        mesh.add_triangle([0, 1, 2], 3, 0b011);
        mesh.add_triangle([0, 1, 2], 3, 0b110);
        assert_eq!([0, 1, 2, 3].map(|t| mesh.face_of(t)), [0, 1, 3, 3]);
        let outlines = [0, 1, 2, 3].map(|t| mesh.outline_of(t));
        assert_eq!(outlines, [0b111, 0b111, 0b011, 0b110]);
    }
}
