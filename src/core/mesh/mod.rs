//! Which triangles, about which origin?
//!
//! An indexed mesh as the file gave it: each vertex once, triangles as three indices, and for each
//! triangle the polygon that it came from, so that a wireframe can hide triangulation diagonals.

mod area;
mod health;
mod normals;
pub mod shapes;

pub use area::has_zero_area;
pub use health::{Health, SLIVER_ASPECT};
pub use normals::VertexNormals;

use crate::aabb::Aabb;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// A place as bits that can be compared and hashed; −0 is the same place as 0.
fn place(p: Vec3) -> [u32; 3] {
    (p + Vec3::ZERO).to_array().map(f32::to_bits)
}

/// Sizes of a mesh for which f32 kernels are at their best: seen from ten times as far, the products of
/// two lengths then stay well inside f32's range.
pub const SAFE_SIZE: std::ops::RangeInclusive<f64> = 1e-15..=1e16;

/// The unit normal by the right-hand rule over A, B, C; zero for a triangle of zero area.
///
/// In f64, where neither a product nor a length of f32 numbers under- or overflows.
pub fn unit_normal(corners: [Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero()
}

/// Marks a corner without a normal in [`TriangleMesh::corner_normals`].
pub const NO_NORMAL: u32 = u32::MAX;

/// What a face looks like.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// As the file calls it.
    pub name: String,
    /// Diffuse reflectance in linear RGB, where the material library gives one.
    pub diffuse: Option<Vec3>,
}

/// Why triangles are missing that the file has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Dropped {
    /// Their area is exactly zero, once their corners are rounded to f32.
    pub zero_area: usize,
    /// A corner is NaN or infinite, or too large for f32.
    pub non_finite: usize,
}

/// An indexed triangle mesh. Its positions are f32 about an f64 origin: that is what rays are asked
/// against, exactly.
///
/// All lists that go by triangle have the same length.
#[derive(Clone, Debug, Default)]
pub struct TriangleMesh {
    /// Where (0, 0, 0) of the positions lies in the file's coordinates.
    pub origin: DVec3,
    /// The vertices, relative to [`origin`](Self::origin).
    pub positions: Vec<Vec3>,
    /// Three indices into the positions; no triangle has zero area or a non-finite corner.
    pub triangles: Vec<[u32; 3]>,
    /// The file's face (counted from 0) that a triangle is part of.
    pub faces: Vec<u32>,
    /// Bit k: the edge from corner k to the next one is an edge of the polygon, no diagonal.
    pub outline: Vec<u8>,
    /// Index into [`materials`](Self::materials).
    pub material: Vec<u32>,
    /// Index into [`groups`](Self::groups).
    pub group: Vec<u32>,
    /// The file's normals, as given: not always unit length. Empty if it has none.
    pub normals: Vec<Vec3>,
    /// Indices into the normals, or [`NO_NORMAL`]. Empty if the file has no normals.
    pub corner_normals: Vec<[u32; 3]>,
    /// The materials that faces name; the first one is for faces that name none.
    pub materials: Vec<Material>,
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

    /// The box around all triangles.
    pub fn bounds(&self) -> Aabb {
        let of = |triangle: &[u32; 3]| {
            Aabb::around(triangle.map(|vertex| self.positions[vertex as usize]))
        };
        let boxes = self.triangles.par_iter().map(of);
        boxes.reduce(|| Aabb::EMPTY, Aabb::union)
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

    /// [`unit_normal`], rounded to f32.
    pub fn geometric_normal(&self, triangle: u32) -> Vec3 {
        unit_normal(self.corners(triangle)).as_vec3()
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
    pub fn bytes(&self) -> [(&'static str, usize); 4] {
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
                    + size_of_val(&self.material[..])
                    + size_of_val(&self.group[..]),
            ),
        ]
    }
}
