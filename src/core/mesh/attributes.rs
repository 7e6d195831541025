//! What a mesh has besides its surface.

use super::{Faces, Material, NO_INDEX, PerTriangle, Runs, Texture};
use glam::{Vec2, Vec3};

/// What a mesh has besides its surface; all empty by default.
#[derive(Clone, Debug, Default)]
pub struct Attributes {
    /// The polygons.
    pub faces: Faces,
    /// The file's normals, unchanged: not always unit length.
    pub normals: CornerValues<Vec3>,
    /// Texture coordinates. Empty if no material has a texture.
    pub texture_coordinates: CornerValues<Vec2>,
    /// Vertex colours, sRGB from 0 to 1: as many as positions, or none.
    pub colours: Vec<Vec3>,
    /// The materials that faces use; the first one is for faces without a material.
    pub materials: Assigned<Material>,
    /// The groups and objects that contain faces; the first one is for faces outside any.
    pub groups: Assigned<String>,
    /// Smoothing groups: edges between triangles of the same group are smooth, all others are creases; 0 is flat. `None`
    /// if the file has none: all triangles are smooth.
    pub smoothing: Option<Runs>,
    /// The materials' textures.
    pub textures: Vec<Texture>,
    /// The ends of line elements, which aren't edges of faces.
    pub lines: Vec<[u32; 2]>,
    /// Vertices of point elements.
    pub points: Vec<u32>,
}

impl Attributes {
    /// Adds those of `count` later triangles, the first of which is `first`, with their lines and points; lists that
    /// triangles refer to stay as they are. The later faces are counted from `first_face`.
    pub(crate) fn append(&mut self, first: u32, count: u32, mut later: Self, first_face: u32) {
        self.faces.append(first, count, later.faces, first_face);
        self.normals.corners.append(first, later.normals.corners);
        let textures = later.texture_coordinates.corners;
        self.texture_coordinates.corners.append(first, textures);
        self.lines.append(&mut later.lines);
        self.points.append(&mut later.points);
    }

    /// Releases the unused memory of the lists per triangle.
    pub(crate) fn shrink(&mut self) {
        self.faces.shrink();
        self.normals.corners.shrink();
        self.texture_coordinates.corners.shrink();
    }
}

/// Values that corners of triangles refer to.
#[derive(Clone, Debug)]
pub struct CornerValues<T> {
    values: Vec<T>,
    /// Indices into the values, or [`NO_INDEX`].
    corners: PerTriangle<[u32; 3]>,
}

impl<T> Default for CornerValues<T> {
    fn default() -> Self {
        let values = Vec::new();
        let corners = PerTriangle::new([NO_INDEX; 3]);
        Self { values, corners }
    }
}

impl<T: Copy> CornerValues<T> {
    /// Values, and the indices of each triangle's corners into them; an index beyond the last value means that the corner
    /// has none.
    pub fn new(values: Vec<T>, corners: impl IntoIterator<Item = [u32; 3]>) -> Self {
        let mut of_corners = Self::of(values);
        for (triangle, indices) in (0..).zip(corners) {
            of_corners.push(triangle, indices);
        }
        of_corners
    }

    /// Values that no corner refers to yet.
    pub(crate) fn of(values: Vec<T>) -> Self {
        let corners = PerTriangle::new([NO_INDEX; 3]);
        Self { values, corners }
    }

    /// Sets the indices of a triangle's corners; it must come after all that have been set.
    #[inline]
    pub(crate) fn push(&mut self, triangle: u32, indices: [u32; 3]) {
        self.corners.push(triangle, indices);
    }

    /// The indices of a triangle's corners, or [`NO_INDEX`].
    pub fn indices(&self, triangle: u32) -> [u32; 3] {
        self.corners.of(triangle)
    }

    /// The values of a triangle's corners.
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

    /// The values.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// Size in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..]) + self.corners.bytes()
    }
}

/// A list, and the entry of it that each triangle has.
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
    /// Entries, and the index of each triangle's entry.
    pub fn new(entries: Vec<T>, indices: Runs) -> Self {
        Self { entries, indices }
    }

    /// The index of a triangle's entry.
    pub fn index(&self, triangle: u32) -> u32 {
        self.indices.of(triangle)
    }

    /// An entry by its index, if there is one.
    pub fn get(&self, index: u32) -> Option<&T> {
        self.entries.get(index as usize)
    }

    /// A triangle's entry, if it has one.
    pub fn of(&self, triangle: u32) -> Option<&T> {
        self.get(self.index(triangle))
    }

    /// All entries.
    pub fn entries(&self) -> &[T] {
        &self.entries
    }

    /// Size in bytes of the indices.
    pub fn bytes(&self) -> usize {
        self.indices.bytes()
    }
}
