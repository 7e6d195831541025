//! Maps triangles to the file's polygons.

use super::PerTriangle;

/// The polygon of each triangle, and which of the triangle's edges are polygon edges. By default each triangle is a
/// polygon.
#[derive(Clone, Debug)]
pub struct Faces {
    /// Face index minus triangle index, modulo 2³².
    shifts: PerTriangle<u32>,
    outlines: PerTriangle<u8>,
}

impl Default for Faces {
    fn default() -> Self {
        Self {
            shifts: PerTriangle::new(0),
            outlines: PerTriangle::new(Self::ALL_EDGES),
        }
    }
}

impl Faces {
    /// Outline of a triangle whose edges are all edges of its polygon.
    pub const ALL_EDGES: u8 = 0b111;

    /// The index of a triangle's face.
    #[inline]
    pub fn of(&self, triangle: u32) -> u32 {
        triangle.wrapping_add(self.shifts.of(triangle))
    }

    /// The polygon edges of a triangle: bit k is set unless the edge from corner k to the next corner is a diagonal.
    pub fn outline(&self, triangle: u32) -> u8 {
        self.outlines.of(triangle)
    }

    /// Sets the face and outline of a triangle. The triangles of a face must be consecutive.
    ///
    /// # Panics
    /// If triangles aren't set in ascending order.
    #[inline]
    pub fn push(&mut self, triangle: u32, face: u32, outline: u8) {
        self.shifts.push(triangle, face.wrapping_sub(triangle));
        self.outlines.push(triangle, outline);
    }

    /// Number of faces of the first `triangles` triangles. The triangles of a face must be consecutive.
    pub(super) fn count(&self, triangles: usize) -> usize {
        if self.shifts.is_default() {
            return triangles;
        }
        let begins = |&triangle: &u32| triangle == 0 || self.of(triangle) != self.of(triangle - 1);
        (0..triangles as u32).filter(begins).count()
    }

    /// Appends the faces of `count` triangles. Triangle 0 of `later` becomes triangle `first`, and its face 0 becomes
    /// face `first_face`.
    pub(super) fn append(&mut self, first: u32, count: u32, later: Self, first_face: u32) {
        let shift = first_face.wrapping_sub(first);
        if shift == 0 {
            self.shifts.append(first, later.shifts);
        } else {
            for triangle in 0..count {
                let own = later.shifts.of(triangle);
                self.shifts.push(first + triangle, own.wrapping_add(shift));
            }
        }
        self.outlines.append(first, later.outlines);
    }

    pub(super) fn end(&self) -> usize {
        self.shifts.end().max(self.outlines.end())
    }

    pub(super) fn shrink(&mut self) {
        self.shifts.shrink();
        self.outlines.shrink();
    }

    pub(super) fn bytes(&self) -> usize {
        self.shifts.bytes() + self.outlines.bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn appended_faces_continue_the_numbering() {
        // A triangle, a quad, a dropped face, and another triangle.
        let mut faces = Faces::default();
        for (triangle, face, outline) in
            [(0, 0, 0b111), (1, 1, 0b011), (2, 1, 0b110), (3, 3, 0b111)]
        {
            faces.push(triangle, face, outline);
        }
        let mut later = Faces::default();
        later.push(0, 0, 0b111);
        later.push(1, 1, 0b011);
        faces.append(4, 2, later, 4);
        faces.append(6, 1, Faces::default(), 6);
        let of = |triangle| faces.of(triangle);
        assert_eq!([0, 1, 2, 3, 4, 5, 6].map(of), [0, 1, 1, 3, 4, 5, 6]);
        assert_eq!(
            [1, 4, 5, 6].map(|t| faces.outline(t)),
            [0b011, 0b111, 0b011, 0b111]
        );
        assert_eq!(faces.count(7), 6);
        assert_eq!(Faces::default().count(7), 7);
    }
}
