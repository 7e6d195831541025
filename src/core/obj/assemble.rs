//! Assembles a mesh from the file's numbers.

use super::error::{Problem, Warning};
use super::facts::{Element, Facts, Tally, lines_or_points};
use super::numbers::Numbers;
use super::outline::Outline;
use super::place::{max_rounding, origin};
use super::polygon::{Cut, Triangulator};
use super::referenced_files::ReferencedFiles;
use super::{LoadOptions, Loaded, materials};
use crate::counts::{counted, grouped};
use crate::mesh::{Dropped, Runs, TriangleMesh, has_zero_area};
use crate::progress::{Phase, Progress};
use glam::DVec3;
use std::ops::Range;

/// Elements between two cancellation checks.
const ELEMENTS_PER_CHECK: usize = 1 << 14;

pub(super) fn assemble(
    mut numbers: Numbers,
    facts: &Facts,
    options: &LoadOptions,
    files: &dyn ReferencedFiles,
    progress: &Progress,
) -> Result<Loaded, Problem> {
    progress.enter(Phase::Checking);
    let mut warnings = facts.warnings();
    let looks = materials::look_up(facts, files, options.max_memory, progress)?;
    warnings.extend(looks.warnings);
    if looks.textures.is_empty() {
        // Texture coordinates aren't used.
        numbers.textures = Vec::new();
        numbers.corners[1] = Vec::new();
    }
    progress.check()?;
    let origin = origin(&numbers.positions, options.recentre);
    let positions = numbers.positions.iter().map(|&p| (p - origin).as_vec3());
    let mesh = TriangleMesh {
        origin,
        positions: positions.collect(),
        colours: std::mem::take(&mut numbers.colours),
        normals: std::mem::take(&mut numbers.normals),
        texture_coordinates: std::mem::take(&mut numbers.textures),
        materials: looks.materials,
        textures: looks.textures,
        groups: facts.groups.names.clone(),
        ..TriangleMesh::default()
    };
    let mut assembly = Assembly {
        mesh,
        numbers: &numbers,
        oddities: Oddities::default(),
        triangulator: Triangulator::new(),
        outline: Outline::default(),
        polygon: Vec::new(),
    };
    assembly.add_elements(facts, progress)?;
    let (mut mesh, oddities) = (assembly.mesh, assembly.oddities);
    mesh.dropped.bad_index = facts.dropped_faces.count;
    mesh.dropped.elements += facts.dropped_others.count;
    mesh.smoothing.has_groups = !facts.smoothing.is_empty();
    warnings.extend(oddities.warnings(mesh.dropped));
    progress.check()?;
    shrink(&mut mesh);
    require_content(&mesh, facts)?;
    Ok(Loaded {
        max_rounding: max_rounding(&mesh, &numbers.positions, facts.has_long_numbers),
        mesh,
        warnings,
        vertex_count: facts.counts[0],
        face_lines: facts.face_lines.clone(),
        files: Vec::new(),
    })
}

/// A mesh under construction.
struct Assembly<'n> {
    mesh: TriangleMesh,
    numbers: &'n Numbers,
    oddities: Oddities,
    triangulator: Triangulator,
    outline: Outline,
    /// Corners of the face that is being triangulated.
    polygon: Vec<DVec3>,
}

impl Assembly<'_> {
    fn add_elements(&mut self, facts: &Facts, progress: &Progress) -> Result<(), Problem> {
        let mut materials = FaceRuns::new(&facts.materials.runs);
        let mut groups = FaceRuns::new(&facts.groups.runs);
        let mut smoothing = FaceRuns::new(&facts.smoothing);
        let mut non_faces = facts.non_faces.iter().peekable();
        let (mut start, mut face) = (0, 0);
        for element in 0..facts.element_count {
            if element % ELEMENTS_PER_CHECK == 0 {
                progress.check()?;
                progress.set_steps(element, facts.element_count);
            }
            let count = self.numbers.arities.get(element).map_or(3, |&n| n as usize);
            let corners = start..start + count;
            start += count;
            if let Some(&(_, kind)) = non_faces.next_if(|(at, _)| *at == element) {
                self.add_lines_or_points(kind, corners);
                continue;
            }
            let triangle = self.mesh.triangles.len() as u32;
            materials.step(face, triangle, &mut self.mesh.material);
            groups.step(face, triangle, &mut self.mesh.group);
            smoothing.step(face, triangle, &mut self.mesh.smoothing.groups);
            self.add_face(face, facts, corners, progress)?;
            face += 1;
        }
        Ok(())
    }

    fn add_lines_or_points(&mut self, kind: Element, corners: Range<usize>) {
        let mesh = &mut self.mesh;
        let vertices = &self.numbers.corners[0][corners];
        let is_finite = |v: &u32| mesh.positions[*v as usize].is_finite();
        if !vertices.iter().all(is_finite) {
            mesh.dropped.elements += 1;
            self.oddities.not_finite_elements += 1;
        } else if kind == Element::Points {
            mesh.points.extend(vertices);
        } else {
            let pairs = vertices.windows(2).map(|pair| [pair[0], pair[1]]);
            mesh.lines.extend(pairs);
        }
    }

    /// Triangulates a face, and drops triangles that no ray can hit.
    fn add_face(
        &mut self,
        face: usize,
        facts: &Facts,
        corners: Range<usize>,
        progress: &Progress,
    ) -> Result<(), Problem> {
        let (mesh, oddities) = (&mut self.mesh, &mut self.oddities);
        let vertices = &self.numbers.corners[0][corners.clone()];
        let is_finite = |v: &u32| mesh.positions[*v as usize].is_finite();
        if !vertices.iter().all(is_finite) {
            mesh.dropped.non_finite += vertices.len() - 2;
            oddities.non_finite.add(facts.face_line(face));
            return Ok(());
        }
        self.outline.prepare(vertices);
        let [_, textures, normals] = &self.numbers.corners;
        let before = mesh.triangles.len();
        let mut add = |local: [usize; 3]| {
            let triangle = local.map(|k| vertices[k]);
            if has_zero_area(triangle.map(|v| mesh.positions[v as usize])) {
                mesh.dropped.zero_area += 1;
                oddities.zero_area.add(facts.face_line(face));
                return;
            }
            let outline = self.outline.of(local, vertices);
            mesh.add_triangle(triangle, face as u32, outline);
            if let Some(normals) = normals.get(corners.clone()) {
                mesh.corner_normals.push(local.map(|k| normals[k]));
            }
            if let Some(textures) = textures.get(corners.clone()) {
                mesh.corner_textures.push(local.map(|k| textures[k]));
            }
        };
        if vertices.len() == 3 {
            add([0, 1, 2]);
        } else {
            let exact = |&v: &u32| self.numbers.positions[v as usize];
            self.polygon.clear();
            self.polygon.extend(vertices.iter().map(exact));
            let (triangulator, polygon) = (&mut self.triangulator, &self.polygon);
            let how = triangulator.cut(polygon, progress, &mut add)?;
            if how == Cut::Fan {
                oddities.fan.add(facts.face_line(face));
            }
        }
        mesh.face_count += usize::from(mesh.triangles.len() > before);
        Ok(())
    }
}

/// Converts runs of faces to runs of triangles.
struct FaceRuns<'r> {
    rest: &'r [(usize, u32)],
}

impl<'r> FaceRuns<'r> {
    fn new(runs: &'r [(usize, u32)]) -> Self {
        Self { rest: runs }
    }

    /// Starts a face whose first triangle is `triangle`.
    fn step(&mut self, face: usize, triangle: u32, of_triangles: &mut Runs) {
        while let [(first, number), rest @ ..] = self.rest
            && *first <= face
        {
            of_triangles.begin(triangle, *number);
            self.rest = rest;
        }
    }
}

/// Count and first line of each oddity.
#[derive(Default)]
struct Oddities {
    non_finite: Tally,
    zero_area: Tally,
    fan: Tally,
    not_finite_elements: usize,
}

impl Oddities {
    fn warnings(self, dropped: Dropped) -> impl Iterator<Item = Warning> {
        let (non_finite, zero_area) = (dropped.non_finite, dropped.zero_area);
        let elements = self.not_finite_elements;
        let of_elements = (elements > 0).then(|| {
            let elements = lines_or_points(elements);
            Warning::of_file(format!(
                "{elements} dropped: a vertex is not finite or too large"
            ))
        });
        [
            self.non_finite.warning(|_| {
                let triangles = counted(non_finite, "triangle");
                format!("{triangles} dropped: a corner is not finite or too large")
            }),
            self.zero_area.warning(|_| {
                let triangles = counted(zero_area, "triangle");
                format!("{triangles} dropped: zero area")
            }),
            self.fan.warning(|fans| {
                let polygons = counted(fans, "polygon");
                format!(
                    "{polygons} triangulated as fans: intersecting themselves, without a plane or with too many corners"
                )
            }),
            of_elements,
        ]
        .into_iter()
        .flatten()
    }
}

/// Releases the unused capacity of lists.
fn shrink(mesh: &mut TriangleMesh) {
    mesh.triangles.shrink_to_fit();
    mesh.faces.shrink_to_fit();
    mesh.outline.shrink_to_fit();
    mesh.corner_normals.shrink_to_fit();
    mesh.corner_textures.shrink_to_fit();
}

/// Returns an error with the reason if the mesh has no triangles.
fn require_content(mesh: &TriangleMesh, facts: &Facts) -> Result<(), Problem> {
    if !mesh.triangles.is_empty() {
        return Ok(());
    }
    let Dropped {
        zero_area,
        non_finite,
        bad_index,
        ..
    } = mesh.dropped;
    let message = if zero_area + non_finite > 0 {
        let (zero_area, non_finite) = (grouped(zero_area), grouped(non_finite));
        let message = format!(
            "no triangles left: {zero_area} with zero area, {non_finite} with a corner that is NaN, infinite or too large for f32"
        );
        return Err(Problem::line(facts.face_line(0), message));
    } else if bad_index > 0 {
        let message = format!(
            "no faces left: {} with an index that is out of range or fewer than three corners",
            grouped(bad_index)
        );
        return Err(Problem::line(facts.dropped_faces.first_line, message));
    } else if facts.element_count > 0 {
        format!(
            "there are lines or points ({}), but no faces: nothing to trace",
            grouped(facts.element_count)
        )
    } else if facts.counts[0] > 0 {
        format!(
            "there are vertices ({}), but no faces: nothing to show",
            grouped(facts.counts[0])
        )
    } else {
        "no vertices and no faces: this is not an OBJ file".to_owned()
    };
    Err(Problem::Content(message))
}
