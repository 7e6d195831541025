//! Assembles a mesh from a file's contents.
//!
//! Vertices are stored relative to the mesh's origin. The elements of each chunk are triangulated in parallel, and the
//! triangles are concatenated in file order.

use super::contents::Contents;
use super::corner::List;
use super::elements::{Element, ElementRef, Elements};
use super::error::{Problem, Warning};
use super::oddities::{Oddities, require_content};
use super::outline::Outline;
use super::place::{far_vertices, max_rounding, placement, sample_surface};
use super::polygon::{Cut, Triangulator};
use super::referenced_files::ReferencedFiles;
use super::used::Used;
use super::{LoadOptions, Loaded, materials};
use crate::counts::counted;
use crate::mesh::{NO_INDEX, TriangleMesh, has_zero_area};
use crate::progress::{Phase, Progress};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::sync::Mutex;

/// A polygon of more corners takes more than some megabytes to cut.
const LARGE: usize = 10_000;

/// Assembles the mesh, and reads the materials and textures that it uses.
pub(super) fn assemble(
    mut contents: Contents,
    options: &LoadOptions,
    files: &dyn ReferencedFiles,
    progress: &Progress,
) -> Result<Loaded, Problem> {
    progress.enter(Phase::Checking);
    let vertex_count = contents.positions.len();
    let mut warnings = contents.warnings();
    let (mut colours, are_bytes) = contents.colours.take(vertex_count);
    if are_bytes {
        let message = "vertex colours above 1: interpreted as bytes".to_owned();
        warnings.push(Warning::of_file(message));
    }
    let surface = sample_surface(&contents.elements, &contents.positions);
    let used = Used::in_elements(&contents.elements, contents.counts());
    progress.check()?;
    used.keep(List::Vertex, &mut contents.positions);
    if !colours.is_empty() {
        used.keep(List::Vertex, &mut colours);
    }
    used.keep(List::Texture, &mut contents.textures);
    used.keep(List::Normal, &mut contents.normals);
    let (unusable_normals, warning) = unusable(&contents.normals);
    warnings.extend(warning);
    let found = materials::look_up(&contents, files, options.max_memory, progress)?;
    warnings.extend(found.warnings);
    // Without a texture, texture coordinates aren't used.
    let has_textures = !found.textures.is_empty();
    progress.check()?;

    let placement = placement(&contents.positions, &surface, options.recentre);
    let origin = placement.origin;
    let exact = std::mem::take(&mut contents.positions);
    let positions: Vec<Vec3> = exact.par_iter().map(|&p| (p - origin).as_vec3()).collect();
    let elements = std::mem::take(&mut contents.elements);
    progress.set_steps(0, elements.len());
    let assembly = Assembly {
        exact: &exact,
        positions: &positions,
        unusable_normals: &unusable_normals,
        used: &used,
        has_textures,
        contents: &contents,
        large_polygons: Mutex::new(()),
        progress,
    };
    let parts: Vec<Triangles> = elements
        .into_par_iter()
        .map(|elements| {
            progress.check()?;
            progress.add_step();
            assembly.triangles(elements)
        })
        .collect::<Result<_, Problem>>()?;
    progress.check()?;

    let mut mesh = TriangleMesh {
        origin,
        positions,
        colours,
        normals: std::mem::take(&mut contents.normals),
        materials: found.materials,
        textures: found.textures,
        groups: contents.groups.names.clone(),
        ..TriangleMesh::default()
    };
    if has_textures {
        mesh.texture_coordinates = std::mem::take(&mut contents.textures);
    }
    let oddities = gather(&mut mesh, parts);
    mesh.dropped.bad_index = contents.dropped_faces.count;
    mesh.dropped.elements += contents.dropped_others.count;
    mesh.smoothing.has_groups = !contents.smoothing.is_empty();
    warnings.extend(oddities.warnings(mesh.dropped));
    progress.check()?;
    require_content(&mesh, &contents, vertex_count)?;
    let has_long_numbers = contents.has_long_numbers;
    warnings.extend(
        placement
            .core
            .and_then(|core| far_vertices(&mesh, &exact, core, has_long_numbers)),
    );
    Ok(Loaded {
        max_rounding: max_rounding(&mesh, &exact, has_long_numbers),
        mesh,
        warnings,
        vertex_count,
        face_lines: contents.face_lines,
        files: Vec::new(),
    })
}

/// Flags the normals that are zero or not finite, and returns the warning about them. The list is empty if there are
/// none.
fn unusable(normals: &[Vec3]) -> (Vec<bool>, Option<Warning>) {
    let is_unusable = |n: &Vec3| !n.is_finite() || *n == Vec3::ZERO;
    let count = normals.par_iter().filter(|&n| is_unusable(n)).count();
    if count == 0 {
        return (Vec::new(), None);
    }
    let normals: Vec<bool> = normals.iter().map(is_unusable).collect();
    let message = format!(
        "{} computed: zero or not finite in the file",
        counted(count, "normal")
    );
    (normals, Some(Warning::of_file(message)))
}

/// The data from which the chunks' triangles are built.
struct Assembly<'c> {
    /// Positions in the file, and relative to the mesh's origin.
    exact: &'c [DVec3],
    positions: &'c [Vec3],
    /// See [`unusable`].
    unusable_normals: &'c [bool],
    used: &'c Used,
    has_textures: bool,
    contents: &'c Contents,
    /// Held while a large polygon is cut, so that only one at a time takes its memory.
    large_polygons: Mutex<()>,
    progress: &'c Progress,
}

/// The triangles of a chunk; faces are counted from the chunk's first.
#[derive(Default)]
struct Triangles {
    /// Of the mesh, only lists per triangle, lines, points and counts.
    mesh: TriangleMesh,
    first_face: usize,
    /// The first triangles of runs of materials, groups and smoothing groups, and their numbers.
    runs: [Vec<(u32, u32)>; 3],
    oddities: Oddities,
}

impl Assembly<'_> {
    fn triangles(&self, mut elements: Elements) -> Result<Triangles, Problem> {
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
            triangles: Triangles {
                first_face,
                ..Triangles::default()
            },
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
        builder
            .triangles
            .mesh
            .triangles
            .reserve(elements.face_count());
        for element in elements.iter() {
            match element.kind {
                Element::Face => builder.add_face(&elements, &element)?,
                Element::Line | Element::Points => {
                    builder
                        .add_lines_or_points(element.kind, &elements.corners[0][element.corners]);
                }
            }
        }
        Ok(builder.triangles)
    }
}

struct TriangleBuilder<'c> {
    assembly: &'c Assembly<'c>,
    triangles: Triangles,
    triangulator: Triangulator,
    outline: Outline,
    /// Corners of the face that is being triangulated: the file's numbers, and the mesh's.
    polygon: Vec<DVec3>,
    placed: Vec<Vec3>,
    /// Of materials, groups and smoothing groups.
    runs: [FaceRuns<'c>; 3],
}

impl TriangleBuilder<'_> {
    fn add_lines_or_points(&mut self, kind: Element, vertices: &[u32]) {
        let mesh = &mut self.triangles.mesh;
        let is_finite = |v: &u32| self.assembly.positions[*v as usize].is_finite();
        if !vertices.iter().all(is_finite) {
            mesh.dropped.elements += 1;
            self.triangles.oddities.not_finite_elements += 1;
        } else if kind == Element::Points {
            mesh.points.extend(vertices);
        } else {
            let pairs = vertices.windows(2).map(|pair| [pair[0], pair[1]]);
            mesh.lines.extend(pairs);
        }
    }

    /// Triangulates a face, and drops triangles that no ray can hit.
    fn add_face(&mut self, elements: &Elements, element: &ElementRef) -> Result<(), Problem> {
        let line = || elements.line(element);
        let corners = element.corners.clone();
        let Triangles {
            mesh,
            first_face,
            runs,
            oddities,
        } = &mut self.triangles;
        let face = element.index;
        let triangle = mesh.triangles.len() as u32;
        for (begins, begun) in self.runs.iter_mut().zip(runs) {
            begins.step(*first_face + face, triangle, begun);
        }

        let positions = self.assembly.positions;
        let vertices = &elements.corners[0][corners.clone()];
        let is_finite = |v: &u32| positions[*v as usize].is_finite();
        if !vertices.iter().all(is_finite) {
            mesh.dropped.non_finite += vertices.len() - 2;
            oddities.non_finite.add(line());
            return Ok(());
        }
        let is_triangle = vertices.len() == 3;
        if !is_triangle {
            self.outline.prepare(vertices);
        }
        let [_, textures, normals] = &elements.corners;
        let before = mesh.triangles.len();
        let mut add = |local: [usize; 3]| {
            let triangle = local.map(|k| vertices[k]);
            if has_zero_area(triangle.map(|v| positions[v as usize])) {
                mesh.dropped.zero_area += 1;
                oddities.zero_area.add(line());
                return;
            }
            let outline = if is_triangle {
                0b111
            } else {
                self.outline.of(local, vertices)
            };
            mesh.add_triangle(triangle, face as u32, outline);
            let of_corner = |indices: &[u32]| {
                local.map(|k| indices.get(corners.start + k).copied().unwrap_or(NO_INDEX))
            };
            if !normals.is_empty() {
                mesh.corner_normals.push(of_corner(normals));
            }
            if !textures.is_empty() {
                mesh.corner_textures.push(of_corner(textures));
            }
        };
        if is_triangle {
            add([0, 1, 2]);
        } else {
            let exact = vertices.iter().map(|&v| self.assembly.exact[v as usize]);
            self.polygon.clear();
            self.polygon.extend(exact);
            let placed = vertices.iter().map(|&v| positions[v as usize]);
            self.placed.clear();
            self.placed.extend(placed);
            let progress = self.assembly.progress;
            let is_large = vertices.len() > LARGE;
            let large_polygons = &self.assembly.large_polygons;
            let _alone = is_large.then(|| large_polygons.lock());
            let how = self
                .triangulator
                .cut(&self.polygon, &self.placed, progress, &mut add)?;
            if how == Cut::Fan {
                oddities.fan.add(line());
            }
        }
        mesh.face_count += usize::from(mesh.triangles.len() > before);
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

/// Concatenates the chunks' triangles.
fn gather(mesh: &mut TriangleMesh, parts: Vec<Triangles>) -> Oddities {
    let total: usize = parts.iter().map(|part| part.mesh.triangles.len()).sum();
    let mut oddities = Oddities::default();
    mesh.triangles.reserve_exact(total);
    for part in parts {
        let first = mesh.triangles.len() as u32;
        let runs = [
            &mut mesh.material,
            &mut mesh.group,
            &mut mesh.smoothing.groups,
        ];
        for (runs, begun) in runs.into_iter().zip(&part.runs) {
            for &(triangle, number) in begun {
                runs.begin(first + triangle, number);
            }
        }
        mesh.append(part.mesh, part.first_face as u32);
        oddities.append(part.oddities);
    }
    mesh.shrink();
    oddities
}
