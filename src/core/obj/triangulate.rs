//! Triangulates the faces of a chunk.

use super::contents::Contents;
use super::corner::List;
use super::elements::{Element, ElementKind, Elements};
use super::error::Problem;
use super::oddities::Oddities;
use super::report::Dropped;
use super::used::Used;
use crate::mesh::{Attributes, Faces, NO_INDEX, has_zero_area};
use crate::polygon::{Cut, Outline, Triangulator};
use crate::progress::Progress;
use glam::{DVec3, Vec3};
use std::sync::Mutex;

/// A polygon of more corners takes more than some megabytes to cut.
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
    /// Number of triangles, and the space that there was for them in the mesh's list.
    pub count: usize,
    pub space: usize,
    /// The last triangles, for which there was no space: a polygon that touches itself may have more than a fan.
    pub overflow: Vec<[u32; 3]>,
    /// Those of the triangles, and lines and points.
    pub attributes: Attributes,
    pub first_face: usize,
    /// The first triangles of runs of materials, groups and smoothing groups, and their numbers.
    pub runs: [Vec<(u32, u32)>; 3],
    pub dropped: Dropped,
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
        for list in List::ALL {
            self.used
                .renumber(list, &mut elements.corners[list as usize]);
        }
        if !self.has_textures {
            elements.corners[List::Texture as usize] = Vec::new();
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
                dropped: Dropped::default(),
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
            dropped,
            oddities,
            ..
        } = &mut self.result;
        let is_finite = |v: &u32| self.assembly.positions[*v as usize].is_finite();
        if !vertices.iter().all(is_finite) {
            dropped.elements += 1;
            oddities.not_finite_elements += 1;
        } else if kind == ElementKind::Points {
            attributes.points.extend(vertices);
        } else {
            let pairs = vertices.windows(2).map(|pair| [pair[0], pair[1]]);
            attributes.lines.extend(pairs);
        }
    }

    /// Triangulates a face, and drops triangles that no ray can hit.
    fn add_face(&mut self, elements: &Elements, element: &Element) -> Result<(), Problem> {
        let line = || elements.line(element);
        let corners = element.corners.clone();
        let ChunkTriangles {
            count,
            overflow,
            attributes,
            first_face,
            runs,
            dropped,
            oddities,
            ..
        } = &mut self.result;
        let face = element.index;
        for (begins, begun) in self.runs.iter_mut().zip(runs) {
            begins.step(*first_face + face, *count as u32, begun);
        }

        let positions = self.assembly.positions;
        let vertices = &elements.corners[0][corners.clone()];
        let is_finite = |v: &u32| positions[*v as usize].is_finite();
        if !vertices.iter().all(is_finite) {
            dropped.non_finite += vertices.len() - 2;
            oddities.non_finite.add(line());
            return Ok(());
        }
        let is_triangle = vertices.len() == 3;
        if !is_triangle {
            self.outline.prepare(vertices);
        }
        let [_, textures, normals] = &elements.corners;
        let mut add = |local: [usize; 3]| {
            let triangle = local.map(|k| vertices[k]);
            if has_zero_area(triangle.map(|v| positions[v as usize])) {
                dropped.zero_area += 1;
                oddities.zero_area.add(line());
                return;
            }
            let outline = if is_triangle {
                Faces::ALL_EDGES
            } else {
                self.outline.of(local, vertices)
            };
            match self.triangles.get_mut(*count) {
                Some(slot) => *slot = triangle,
                None => overflow.push(triangle),
            }
            let index = *count as u32;
            *count += 1;
            attributes.faces.push(index, face as u32, outline);
            let of_corner = |indices: &[u32]| {
                local.map(|k| indices.get(corners.start + k).copied().unwrap_or(NO_INDEX))
            };
            if !normals.is_empty() {
                attributes.normals.push(index, of_corner(normals));
            }
            if !textures.is_empty() {
                let indices = of_corner(textures);
                attributes.texture_coordinates.push(index, indices);
            }
        };
        if is_triangle {
            add([0, 1, 2]);
            return Ok(());
        }
        let exact = vertices.iter().map(|&v| self.assembly.exact[v as usize]);
        self.polygon.clear();
        self.polygon.extend(exact);
        let placed = vertices.iter().map(|&v| positions[v as usize]);
        self.placed.clear();
        self.placed.extend(placed);
        let progress = self.assembly.progress;
        let is_large = vertices.len() > LARGE_POLYGON;
        let large_polygons = &self.assembly.large_polygons;
        let _alone = is_large.then(|| large_polygons.lock());
        let how = self
            .triangulator
            .cut(&self.polygon, &self.placed, progress, &mut add)?;
        if how == Cut::Fan {
            oddities.fan.add(line());
        }
        Ok(())
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
