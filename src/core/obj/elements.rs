//! The faces, lines and points of a chunk.

use super::corner::List;
use super::tally::LineRuns;
use crate::mesh::NO_INDEX;
use std::ops::Range;

/// Kinds of statements with corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ElementKind {
    Face,
    /// A polyline through its corners.
    Line,
    /// One point per corner.
    Points,
}

impl ElementKind {
    /// The minimum number of corners, and a sentence for the error message.
    pub(super) fn least_corners(self) -> (usize, &'static str) {
        match self {
            Self::Face => (3, "a face needs at least three corners"),
            Self::Line => (2, "a line needs at least two corners"),
            Self::Points => (1, "a list of points needs at least one point"),
        }
    }
}

/// One element.
pub(super) struct Element {
    pub kind: ElementKind,
    /// Its index among the faces, or among the lines and points.
    pub index: usize,
    /// Its corners in the lists.
    pub corners: Range<usize>,
}

/// Faces, lines and points.
#[derive(Default)]
pub(super) struct Elements {
    /// For each corner of each element, its index from 0 in each list, or [`NO_INDEX`]. The second and third list
    /// are empty as long as no corner has such an index.
    pub corners: [Vec<u32>; 3],
    /// The corners whose index in a list is relative to the number of entries before the chunk.
    pub relative: [Vec<u32>; 3],
    /// The lowest relative index; negative if it refers to an entry before the chunk.
    pub lowest: [i32; 3],
    /// One more than the highest absolute index in each list.
    pub highest: [usize; 3],
    /// Number of corners of each element; empty if all have three.
    pub arities: Vec<u32>,
    pub count: usize,
    /// Number of faces before the chunk, once the whole file has been read.
    pub first_face: usize,
    /// Indices of the elements that aren't faces, in ascending order.
    pub non_faces: Vec<(u32, ElementKind)>,
    pub face_lines: LineRuns,
    pub other_lines: LineRuns,
    /// Largest number of corners of an element.
    pub largest: usize,
}

impl Elements {
    pub(super) fn face_count(&self) -> usize {
        self.count - self.non_faces.len()
    }

    /// Number of triangles if every face becomes a fan, or a little more.
    pub(super) fn fan_triangles(&self) -> usize {
        self.corners[0].len().saturating_sub(2 * self.face_count())
    }

    /// Ends an element whose corners have been added since `first`.
    pub(super) fn end(&mut self, kind: ElementKind, first: usize, line: usize) {
        let arity = self.corners[0].len() - first;
        if arity != 3 || !self.arities.is_empty() {
            self.arities.resize(self.count, 3);
            self.arities.push(arity as u32);
        }
        self.largest = self.largest.max(arity);
        if kind == ElementKind::Face {
            self.face_lines.push(line);
        } else {
            self.non_faces.push((self.count as u32, kind));
            self.other_lines.push(line);
        }
        self.count += 1;
    }

    /// Adds a corner's index in a list, or [`NO_INDEX`]. Call it for the vertex first.
    #[inline]
    pub(super) fn push(&mut self, list: List, index: u32) {
        if index != NO_INDEX {
            self.start_corner(list).push(index);
            let highest = &mut self.highest[list as usize];
            *highest = (*highest).max(index as usize + 1);
        } else if !self.corners[list as usize].is_empty() {
            self.start_corner(list).push(NO_INDEX);
        }
    }

    /// Adds a corner's index in a list, relative to the number of entries before the chunk.
    pub(super) fn push_relative(&mut self, list: List, index: i32) {
        let indices = self.start_corner(list);
        let corner = indices.len() as u32;
        indices.push(index.cast_unsigned());
        self.relative[list as usize].push(corner);
        let lowest = &mut self.lowest[list as usize];
        *lowest = index.min(*lowest);
    }

    /// The indices in a list, of all corners before the one that is being added.
    #[inline]
    fn start_corner(&mut self, list: List) -> &mut Vec<u32> {
        let corner = self.corners[0].len() - usize::from(list != List::Vertex);
        let indices = &mut self.corners[list as usize];
        indices.resize(corner, NO_INDEX);
        indices
    }

    /// Removes the corners from `first` on.
    pub(super) fn truncate(&mut self, first: usize) {
        for (indices, relative) in self.corners.iter_mut().zip(&mut self.relative) {
            indices.truncate(first);
            // In ascending order.
            relative.truncate(relative.partition_point(|&corner| (corner as usize) < first));
        }
    }

    /// Makes relative indices absolute; `before` is the number of entries before the chunk in each list.
    pub(super) fn resolve_relative(&mut self, before: [usize; 3]) {
        for (list, before) in before.into_iter().enumerate() {
            for corner in std::mem::take(&mut self.relative[list]) {
                let index = &mut self.corners[list][corner as usize];
                // Can't be negative: such a chunk is parsed again.
                *index = (before as u32).wrapping_add(*index);
            }
        }
    }

    /// All elements, in the file's order.
    #[inline]
    pub(super) fn iter(&self) -> impl Iterator<Item = Element> {
        let (mut start, mut face) = (0, 0);
        let mut others = (0..).zip(&self.non_faces).peekable();
        (0..self.count).map(move |element| {
            let arity = self.arities.get(element).map_or(3, |&n| n as usize);
            let corners = start..start + arity;
            start = corners.end;
            let other = others.next_if(|(_, (at, _))| *at as usize == element);
            let (kind, index) = match other {
                Some((index, &(_, kind))) => (kind, index),
                None => (ElementKind::Face, face),
            };
            face += usize::from(kind == ElementKind::Face);
            Element {
                kind,
                index,
                corners,
            }
        })
    }

    /// The line of an element.
    pub(super) fn line(&self, element: &Element) -> usize {
        match element.kind {
            ElementKind::Face => self.face_lines.line(element.index),
            ElementKind::Line | ElementKind::Points => self.other_lines.line(element.index),
        }
    }

    /// The line of the element with a corner.
    pub(super) fn line_of_corner(&self, corner: usize) -> usize {
        let found = self
            .iter()
            .find(|element| element.corners.contains(&corner));
        found.map_or(0, |element| self.line(&element))
    }

    /// The line, list and index of the first corner that refers to an entry beyond the lists' ends.
    pub(super) fn first_missing(&self, counts: [usize; 3]) -> Option<(usize, List, u32)> {
        let missing_in = |list: List| {
            let (highest, count) = (self.highest[list as usize], counts[list as usize]);
            let is_missing = |&index: &u32| index != NO_INDEX && index as usize >= count;
            let corners = &self.corners[list as usize];
            // A dropped element may have had the highest index.
            let corner = (highest > count).then(|| corners.iter().position(is_missing))??;
            Some((corner, list, corners[corner]))
        };
        let missing = List::ALL.into_iter().filter_map(missing_in);
        let (corner, list, index) = missing.min_by_key(|(corner, ..)| *corner)?;
        Some((self.line_of_corner(corner), list, index))
    }

    /// Bytes of the lists that are short in most files.
    pub(super) fn other_bytes(&self) -> usize {
        self.face_lines.bytes() * 2
            + self.other_lines.bytes()
            + size_of_val(&self.non_faces[..])
            + size_of_val(&self.arities[..])
    }
}
