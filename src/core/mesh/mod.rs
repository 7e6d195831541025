//! Triangle meshes.
//!
//! An indexed mesh as the file gave it: each vertex once, triangles as three indices, and for each
//! triangle the polygon that it came from, so that a wireframe can hide triangulation diagonals.

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

/// Sizes of a mesh for which f32 kernels are at their best: seen from ten times as far, the products of
/// two lengths then stay well inside f32's range.
pub const SAFE_SIZE: std::ops::RangeInclusive<f64> = 1e-15..=1e16;

/// The unit normal by the right-hand rule over A, B, C; zero for a triangle of zero area, and for one so thin
/// that f64 finds none.
///
/// In f64, where neither a product nor a length of f32 numbers under- or overflows.
pub fn unit_normal(corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero()
}

/// Marks a corner without a normal, or without texture coordinates, in lists that go by corner.
pub const NO_INDEX: u32 = u32::MAX;

/// Why triangles are missing that the file has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// Their area is exactly zero, once their corners are rounded to f32.
    pub zero_area: usize,
    /// A corner is NaN or infinite, or too large for f32.
    pub non_finite: usize,
    /// Faces, not triangles: an index names nothing, or there are fewer than three corners.
    pub bad_index: usize,
    /// Lines and points, for any of these reasons.
    pub elements: usize,
}

/// Smoothing groups: triangles of one group are smooth where they meet, others have an edge there.
#[derive(Clone, Debug, Default)]
pub struct Smoothing {
    /// Whether the file says anything of them; else all triangles are smooth.
    pub has_groups: bool,
    /// The group of each triangle; 0 is flat.
    pub groups: Runs,
}

/// An indexed triangle mesh. Its positions are f32 about an f64 origin: that is what rays are asked
/// against, exactly.
///
/// A list is empty where the file has nothing that it would hold. Those that go by triangle have else the same
/// length.
#[derive(Clone, Debug, Default)]
pub struct TriangleMesh {
    /// Where (0, 0, 0) of the positions lies in the file's coordinates.
    pub origin: DVec3,
    /// The vertices that something uses, relative to [`origin`](Self::origin), in the file's order.
    pub positions: Vec<Vec3>,
    /// Three indices into the positions; no triangle has zero area or a non-finite corner.
    pub triangles: Vec<[u32; 3]>,
    /// See [`face_of`](Self::face_of). Empty if triangle k is face k.
    pub faces: Vec<u32>,
    /// See [`outline_of`](Self::outline_of). Empty if all faces are triangles.
    pub outline: Vec<u8>,
    /// Index of each triangle into [`materials`](Self::materials).
    pub material: Runs,
    /// Index of each triangle into [`groups`](Self::groups).
    pub group: Runs,
    /// Which triangles are smooth where they meet.
    pub smoothing: Smoothing,
    /// Colours of the vertices, sRGB from 0 to 1. As many as positions, or none.
    pub colours: Vec<Vec3>,
    /// The file's normals, as given: not always unit length.
    pub normals: Vec<Vec3>,
    /// Indices of each triangle's corners into the normals, or [`NO_INDEX`].
    pub corner_normals: Vec<[u32; 3]>,
    /// Places in textures. Empty if no material has a texture.
    pub texture_coordinates: Vec<Vec2>,
    /// Indices of each triangle's corners into the texture coordinates; [`NO_INDEX`] where there are none.
    pub corner_textures: Vec<[u32; 3]>,
    /// The ends of straight lines that are no edges.
    pub lines: Vec<[u32; 2]>,
    /// Vertices that stand alone.
    pub points: Vec<u32>,
    /// The materials that faces name; the first one is for faces that name none.
    pub materials: Vec<Material>,
    /// The pictures of materials.
    pub textures: Vec<Texture>,
    /// The groups and objects that faces lie in; the first one is for faces outside any.
    pub groups: Vec<String>,
    /// How many polygons the triangles come from, those that were dropped not counted.
    pub face_count: usize,
    /// What is missing.
    pub dropped: Dropped,
}

impl TriangleMesh {
    /// The corners of a triangle.
    pub fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.triangles[triangle as usize].map(|v| self.positions[v as usize])
    }

    /// The file's face (counted from 0) that a triangle is part of.
    pub fn face_of(&self, triangle: u32) -> u32 {
        self.faces
            .get(triangle as usize)
            .copied()
            .unwrap_or(triangle)
    }

    /// Bit k: the edge from corner k to the next one is an edge of the polygon, no diagonal.
    pub fn outline_of(&self, triangle: u32) -> u8 {
        self.outline
            .get(triangle as usize)
            .copied()
            .unwrap_or(0b111)
    }

    /// What a triangle looks like, where that is known.
    pub fn material_of(&self, triangle: u32) -> Option<&Material> {
        self.materials.get(self.material.of(triangle) as usize)
    }

    /// Appends a triangle of a face, with the edges that are edges of the face; see
    /// [`outline_of`](Self::outline_of).
    pub(crate) fn add_triangle(&mut self, corners: [u32; 3], face: u32, outline: u8) {
        let index = self.triangles.len();
        self.triangles.push(corners);
        // Lists begin when they have something to say.
        if !self.faces.is_empty() || face as usize != index {
            self.faces.extend(self.faces.len() as u32..index as u32);
            self.faces.push(face);
        }
        if !self.outline.is_empty() || outline != 0b111 {
            self.outline.resize(index, 0b111);
            self.outline.push(outline);
        }
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

    /// Whether all positions are f32 numbers in the file's coordinates, too: with the origin at (0, 0, 0) they
    /// would be the same points.
    pub fn are_f32_in_file(&self) -> bool {
        let is_f32 = |own: f32, origin: f64| {
            let (own, in_file) = (f64::from(own), f64::from(own) + origin);
            // Both differences give back the terms only if the sum isn't rounded.
            let is_exact = in_file - origin == own && in_file - own == origin;
            is_exact && f64::from(in_file as f32) == in_file
        };
        let is_good = |p: &Vec3| (0..3).all(|axis| is_f32(p[axis], self.origin[axis]));
        self.positions.par_iter().all(is_good)
    }

    /// A vertex as the file spells it: of all coordinates that would have been loaded as these, those with
    /// the fewest digits.
    pub fn vertex_in_file(&self, p: Vec3) -> DVec3 {
        let shortest = |axis: usize| {
            let (origin, own) = (self.origin[axis], p[axis]);
            let exact = f64::from(own) + origin;
            // 17 digits tell each f64 from all others.
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

    /// How many materials faces name.
    pub fn named_material_count(&self) -> usize {
        self.materials.len().saturating_sub(1)
    }

    /// How many groups and objects faces lie in.
    pub fn named_group_count(&self) -> usize {
        self.groups.len().saturating_sub(1)
    }

    /// Bytes taken by each part: name and size.
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
    fn a_vertex_is_spelt_as_in_the_file_far_from_the_origin_and_near_it() {
        for (origin, written) in [
            (500_000.0, 500_000.001),
            (4_649_776.0, 4_649_776.25),
            (0.0, 0.1),
            (0.0, -1.234_567e-20),
            // 14 and 16 digits: with fewer another vertex, and what f64 holds exactly is another number.
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
        // 1000.1 isn't, nor is a sum that only rounding makes one.
        assert!(!are_f32(1000.0, 0.1) && !are_f32(1000.0, 1e-20));
    }

    #[test]
    fn lists_by_triangle_begin_when_they_have_something_to_say() {
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
