//! Triangulates the faces of a chunk.

use super::contents::Contents;
use super::corner::List;
use super::elements::{Element, ElementKind, Elements};
use super::error::Problem;
use super::oddities::Oddities;
use super::tally::Tally;
use super::used::Used;
use crate::mesh::{Attributes, Faces, NO_INDEX, has_zero_area};
use crate::polygon::{Cut, Outline, Triangulator};
use crate::progress::Progress;
use glam::{DVec3, Vec3};
use std::sync::Mutex;

/// Triangulating a larger polygon takes more than 4.5 MB.
const LARGE_POLYGON: usize = 10_000;

/// The data from which the chunks' triangles are built.
pub(super) struct Assembly<'c> {
    /// Positions in the file, and relative to the mesh's origin.
    pub exact: &'c [DVec3],
    pub positions: &'c [Vec3],
    /// Flags normals that are zero or not finite; may be empty.
    pub unusable_normals: &'c [bool],
    pub used: &'c Used,
    pub has_textures: bool,
    pub contents: &'c Contents,
    /// Held while a large polygon is cut, so that only one at a time takes its memory.
    pub large_polygons: Mutex<()>,
    pub progress: &'c Progress,
}

/// The triangles of a chunk; faces are counted from the chunk's first.
pub(super) struct ChunkTriangles {
    /// Number of triangles, and the places reserved for them in the mesh's list.
    pub count: usize,
    pub space: usize,
    /// The last triangles, for which there was no space: a polygon that touches itself may have more than a fan.
    pub overflow: Vec<[u32; 3]>,
    /// The triangles' attributes, and the chunk's lines and points.
    pub attributes: Attributes,
    pub first_face: usize,
    /// The first triangles of runs of materials, groups and smoothing groups, and their numbers.
    pub runs: [Vec<(u32, u32)>; 3],
    pub oddities: Oddities,
}

impl Assembly<'_> {
    /// Triangulates the faces of a chunk into `triangles`.
    pub(super) fn triangulate(
        &self,
        mut elements: Elements,
        triangles: &mut [[u32; 3]],
    ) -> Result<ChunkTriangles, Problem> {
        let first_face = elements.first_face;
        if !self.has_textures {
            elements.corners[List::Texture as usize] = Vec::new();
        }
        for list in List::ALL {
            self.used
                .renumber(list, &mut elements.corners[list as usize]);
        }
        for index in &mut elements.corners[List::Normal as usize] {
            if self.unusable_normals.get(*index as usize) == Some(&true) {
                *index = NO_INDEX;
            }
        }
        let mut builder = TriangleBuilder {
            assembly: self,
            result: ChunkTriangles {
                count: 0,
                space: triangles.len(),
                overflow: Vec::new(),
                attributes: Attributes::default(),
                first_face,
                runs: Default::default(),
                oddities: Oddities::default(),
            },
            triangles,
            triangulator: Triangulator::new(),
            outline: Outline::default(),
            polygon: Vec::new(),
            placed: Vec::new(),
            runs: [
                FaceRuns::from(&self.contents.materials.runs, first_face),
                FaceRuns::from(&self.contents.groups.runs, first_face),
                FaceRuns::from(&self.contents.smoothing, first_face),
            ],
        };
        for element in elements.iter() {
            match element.kind {
                ElementKind::Face => builder.add_face(&elements, &element)?,
                ElementKind::Line | ElementKind::Points => {
                    builder
                        .add_lines_or_points(element.kind, &elements.corners[0][element.corners]);
                }
            }
        }
        Ok(builder.result)
    }
}

struct TriangleBuilder<'c, 't> {
    assembly: &'c Assembly<'c>,
    triangles: &'t mut [[u32; 3]],
    result: ChunkTriangles,
    triangulator: Triangulator,
    outline: Outline,
    /// Corners of the face that is being triangulated: the file's numbers, and the mesh's.
    polygon: Vec<DVec3>,
    placed: Vec<Vec3>,
    /// Of materials, groups and smoothing groups.
    runs: [FaceRuns<'c>; 3],
}

impl TriangleBuilder<'_, '_> {
    fn add_lines_or_points(&mut self, kind: ElementKind, vertices: &[u32]) {
        let ChunkTriangles {
            attributes,
            oddities,
            ..
        } = &mut self.result;
        let is_finite = |v: &u32| self.assembly.positions[*v as usize].is_finite();
        if !vertices.iter().all(is_finite) {
            oddities.not_finite_elements += 1;
        } else if kind == ElementKind::Points {
            attributes.points.extend(vertices);
        } else {
            let pairs = vertices.windows(2).map(|pair| [pair[0], pair[1]]);
            attributes.lines.extend(pairs);
        }
    }

    /// Triangulates a face.
    fn add_face(&mut self, elements: &Elements, face: &Element) -> Result<(), Problem> {
        let ChunkTriangles {
            count,
            first_face,
            runs,
            oddities,
            ..
        } = &mut self.result;
        for (begins, begun) in self.runs.iter_mut().zip(runs) {
            begins.step(*first_face + face.index, *count as u32, begun);
        }
        let positions = self.assembly.positions;
        let vertices = &elements.corners[0][face.corners.clone()];
        let is_finite = |v: &u32| positions[*v as usize].is_finite();
        if !vertices.iter().all(is_finite) {
            oddities.non_finite.append(Tally {
                count: vertices.len() - 2,
                first_line: elements.line(face),
            });
        } else if vertices.len() == 3 {
            self.add_triangle(elements, face, [0, 1, 2], Faces::ALL_EDGES);
        } else {
            self.cut_polygon(elements, face)?;
        }
        Ok(())
    }

    /// Triangulates a face of more than three corners.
    fn cut_polygon(&mut self, elements: &Elements, face: &Element) -> Result<(), Problem> {
        let vertices = &elements.corners[0][face.corners.clone()];
        let large_polygons = &self.assembly.large_polygons;
        let _alone = (vertices.len() > LARGE_POLYGON).then(|| large_polygons.lock());
        let of = |vertex: &u32| *vertex as usize;
        let exact = vertices.iter().map(|v| self.assembly.exact[of(v)]);
        self.polygon.clear();
        self.polygon.extend(exact);
        let placed = vertices.iter().map(|v| self.assembly.positions[of(v)]);
        self.placed.clear();
        self.placed.extend(placed);
        let progress = self.assembly.progress;
        let how = self
            .triangulator
            .cut(&self.polygon, &self.placed, progress)?;
        let oddities = &mut self.result.oddities;
        match how {
            Cut::Good => {}
            Cut::Fan => oddities.fan.add(elements.line(face)),
            Cut::Incomplete => oddities.incomplete.add(elements.line(face)),
        }
        self.outline.prepare(vertices);
        for index in 0..self.triangulator.count() {
            let local = self.triangulator.triangle(index);
            let outline = self.outline.of(local, vertices);
            self.add_triangle(elements, face, local, outline);
        }
        Ok(())
    }

    /// Adds a triangle of a face, given its corners among the face's, unless no ray can hit it.
    #[inline]
    fn add_triangle(
        &mut self,
        elements: &Elements,
        face: &Element,
        local: [usize; 3],
        outline: u8,
    ) {
        let ChunkTriangles {
            count,
            overflow,
            attributes,
            oddities,
            ..
        } = &mut self.result;
        let corners = local.map(|k| face.corners.start + k);
        let [vertices, textures, normals] = &elements.corners;
        let triangle = corners.map(|corner| vertices[corner]);
        if has_zero_area(triangle.map(|v| self.assembly.positions[v as usize])) {
            oddities.zero_area.add(elements.line(face));
            return;
        }
        match self.triangles.get_mut(*count) {
            Some(slot) => *slot = triangle,
            None => overflow.push(triangle),
        }
        let index = *count as u32;
        *count += 1;
        attributes.faces.push(index, face.index as u32, outline);
        let of_corners = |indices: &[u32]| {
            corners.map(|corner| indices.get(corner).copied().unwrap_or(NO_INDEX))
        };
        if !normals.is_empty() {
            attributes.normals.push(index, of_corners(normals));
        }
        if !textures.is_empty() {
            let coordinates = &mut attributes.texture_coordinates;
            coordinates.push(index, of_corners(textures));
        }
    }
}

/// The runs of faces that begin in a chunk.
struct FaceRuns<'r> {
    rest: &'r [(usize, u32)],
}

impl<'r> FaceRuns<'r> {
    fn from(runs: &'r [(usize, u32)], first_face: usize) -> Self {
        let before = runs.partition_point(|(first, _)| *first < first_face);
        Self {
            rest: &runs[before..],
        }
    }

    /// Records the runs that begin at or before a face, whose first triangle is `triangle`.
    fn step(&mut self, face: usize, triangle: u32, of_triangles: &mut Vec<(u32, u32)>) {
        while let [(first, number), rest @ ..] = self.rest
            && *first <= face
        {
            of_triangles.push((triangle, *number));
            self.rest = rest;
        }
    }
}
