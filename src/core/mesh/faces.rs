//! The polygons that triangles come from.

use super::PerTriangle;

/// All edges of a triangle are edges of its polygon.
const ALL_EDGES: u8 = 0b111;

/// The file's polygons, and which edges of triangles are theirs. By default each triangle is a polygon.
#[derive(Clone, Debug)]
pub struct Faces {
    /// A triangle's face less the triangle, modulo 2³².
    shifts: PerTriangle<u32>,
    outlines: PerTriangle<u8>,
}

impl Default for Faces {
    fn default() -> Self {
        Self {
            shifts: PerTriangle::new(0),
            outlines: PerTriangle::new(ALL_EDGES),
        }
    }
}

impl Faces {
    /// The face of a triangle.
    #[inline]
    pub fn of(&self, triangle: u32) -> u32 {
        triangle.wrapping_add(self.shifts.of(triangle))
    }

    /// Bit k is set if the edge from corner k to the next corner is an edge of the polygon, not a diagonal.
    pub fn outline(&self, triangle: u32) -> u8 {
        self.outlines.of(triangle)
    }

    /// Sets the face and the outline of a triangle, which must come after all that have been set.
    #[inline]
    pub fn push(&mut self, triangle: u32, face: u32, outline: u8) {
        self.shifts.push(triangle, face.wrapping_sub(triangle));
        self.outlines.push(triangle, outline);
    }

    /// Number of faces that `triangles` triangles belong to; those of a face follow one another.
    pub(super) fn count(&self, triangles: usize) -> usize {
        if self.shifts.is_default() {
            return triangles;
        }
        let begins = |&triangle: &u32| triangle == 0 || self.of(triangle) != self.of(triangle - 1);
        (0..triangles as u32).filter(begins).count()
    }

    /// Adds the faces of `count` later triangles, the first of which is `first`. Their faces are counted from
    /// `first_face`.
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
    fn faces_are_numbered_on_across_parts() {
        // A triangle, a quad, and a triangle after a face that was dropped.
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
