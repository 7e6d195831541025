//! Attributes of a mesh: faces, normals, texture coordinates, colours, materials and groups, with lines and points.

use super::{Faces, Material, NO_INDEX, PerTriangle, Runs, Texture};
use glam::{Vec2, Vec3};

/// The attributes of a mesh, with its lines and points. By default each triangle is a face, and all else is empty.
#[derive(Clone, Debug, Default)]
pub struct Attributes {
    /// The polygon of each triangle in the file.
    pub faces: Faces,
    /// The file's normals, unchanged; they needn't be unit length.
    pub normals: CornerValues<Vec3>,
    /// Texture coordinates. Empty if no material has a texture.
    pub texture_coordinates: CornerValues<Vec2>,
    /// Vertex colours, sRGB from 0 to 1: one per position, or none.
    pub colours: Vec<Vec3>,
    /// The material of each triangle. The first entry is for faces without a material.
    pub materials: Assigned<Material>,
    /// The group or object of each triangle. The first entry is for faces outside all groups.
    pub groups: Assigned<String>,
    /// Smoothing group of each triangle. Edges within a group are smooth, all others are creases; group 0 is flat.
    /// `None` if the file has no smoothing groups: all edges are smooth.
    pub smoothing: Option<Runs>,
    /// The textures that the materials' texture maps refer to.
    pub textures: Vec<Texture>,
    /// End vertices of each segment of the file's line elements.
    pub lines: Vec<[u32; 2]>,
    /// Vertices of the file's point elements.
    pub points: Vec<u32>,
}

impl Attributes {
    /// Appends the faces, corner indices, lines and points of `later`, which has `count` triangles. Its triangle 0
    /// becomes triangle `first`, and its face 0 becomes face `first_face`. The lists of values stay the same.
    pub(crate) fn append(&mut self, first: u32, count: u32, mut later: Self, first_face: u32) {
        self.faces.append(first, count, later.faces, first_face);
        self.normals.corners.append(first, later.normals.corners);
        let textures = later.texture_coordinates.corners;
        self.texture_coordinates.corners.append(first, textures);
        self.lines.append(&mut later.lines);
        self.points.append(&mut later.points);
    }

    /// One more than the last triangle with a face, normal or texture coordinates that aren't the default.
    pub(super) fn end(&self) -> usize {
        let normals = self.normals.corners.end();
        let coordinates = self.texture_coordinates.corners.end();
        self.faces.end().max(normals).max(coordinates)
    }

    /// Whether the file gives no appearance: no vertex has a colour, and no triangle a material of its own.
    pub fn is_bare(&self) -> bool {
        let mut materials = self.materials.entries().iter();
        self.colours.is_empty() && materials.all(|material| *material == Material::default())
    }

    /// Whether a material emits light.
    pub fn emits(&self) -> bool {
        self.materials.entries().iter().any(Material::emits)
    }

    /// Releases unused memory of the per-triangle lists.
    pub(crate) fn shrink(&mut self) {
        self.faces.shrink();
        self.normals.corners.shrink();
        self.texture_coordinates.corners.shrink();
    }
}

/// A list of values, and each triangle corner's index into it.
#[derive(Clone, Debug)]
pub struct CornerValues<T> {
    values: Vec<T>,
    /// Indices into the values, or [`NO_INDEX`].
    corners: PerTriangle<[u32; 3]>,
}

impl<T> Default for CornerValues<T> {
    fn default() -> Self {
        Self::with_values(Vec::new())
    }
}

impl<T> CornerValues<T> {
    /// Creates the list with values that no corner refers to yet.
    pub(crate) fn with_values(values: Vec<T>) -> Self {
        let corners = PerTriangle::new([NO_INDEX; 3]);
        Self { values, corners }
    }
}

impl<T: Copy> CornerValues<T> {
    /// Creates the list from values and the indices of each triangle's corners. A corner whose index is out of range
    /// has no value.
    pub fn new(values: Vec<T>, corners: impl IntoIterator<Item = [u32; 3]>) -> Self {
        let mut list = Self::with_values(values);
        for (triangle, indices) in (0..).zip(corners) {
            let is_valid = |index: &u32| (*index as usize) < list.values.len();
            let indices = indices.map(|index| Some(index).filter(is_valid).unwrap_or(NO_INDEX));
            list.push(triangle, indices);
        }
        list
    }

    /// Sets the indices of a triangle's corners. Triangles must be set in ascending order.
    #[inline]
    pub(crate) fn push(&mut self, triangle: u32, indices: [u32; 3]) {
        self.corners.push(triangle, indices);
    }

    /// The indices of a triangle's corners; [`NO_INDEX`] for a corner without a value.
    pub fn indices(&self, triangle: u32) -> [u32; 3] {
        self.corners.of(triangle)
    }

    /// The values of a triangle's corners; `None` for a corner without one.
    pub fn of_triangle(&self, triangle: u32) -> [Option<T>; 3] {
        let value = |index: u32| self.values.get(index as usize).copied();
        self.indices(triangle).map(value)
    }

    /// Whether all corners of a triangle have a value.
    pub fn are_complete(&self, triangle: u32) -> bool {
        self.of_triangle(triangle).iter().all(Option::is_some)
    }

    /// Whether no corner has a value.
    pub fn is_empty(&self) -> bool {
        self.corners.is_default()
    }

    /// All values.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// Size in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..]) + self.corners.bytes()
    }
}

/// A list of entries, and each triangle's index into it.
#[derive(Clone, Debug)]
pub struct Assigned<T> {
    entries: Vec<T>,
    indices: Runs,
}

impl<T> Default for Assigned<T> {
    fn default() -> Self {
        Self::new(Vec::new(), Runs::default())
    }
}

impl<T> Assigned<T> {
    /// Creates the list from entries and each triangle's index. A triangle whose index is out of range has no entry.
    pub fn new(entries: Vec<T>, indices: Runs) -> Self {
        Self { entries, indices }
    }

    /// The index of a triangle's entry.
    pub fn index(&self, triangle: u32) -> u32 {
        self.indices.of(triangle)
    }

    /// The entry with this index; `None` if out of range.
    pub fn get(&self, index: u32) -> Option<&T> {
        self.entries.get(index as usize)
    }

    /// The entry of a triangle; `None` if its index is out of range.
    pub fn of(&self, triangle: u32) -> Option<&T> {
        self.get(self.index(triangle))
    }

    /// All entries.
    pub fn entries(&self) -> &[T] {
        &self.entries
    }

    /// Size in bytes of the indices, without the entries.
    pub fn bytes(&self) -> usize {
        self.indices.bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_corner_whose_index_is_out_of_range_has_no_value() {
        let list = CornerValues::new(vec!['a', 'b'], [[5, 5, 5], [0, 2, 1]]);
        assert_eq!(list.of_triangle(0), [None; 3]);
        assert_eq!(list.indices(1), [0, NO_INDEX, 1]);
        assert_eq!(list.of_triangle(1), [Some('a'), None, Some('b')]);
        assert!(!list.is_empty() && !list.are_complete(1));
        assert!(CornerValues::new(vec!['a'], [[1, 2, 3]]).is_empty());
    }
}
