//! From tobj's numbers to a mesh.

use super::error::{Problem, Warning};
use super::facts::Facts;
use super::polygon::{Cut, Triangulator};
use super::{Library, Loaded, Recentre, mtl};
use crate::mesh::{Dropped, Material, NO_NORMAL, TriangleMesh, has_zero_area};
use crate::progress::{Phase, Progress};
use glam::{DVec3, Vec3};

/// Faces between two looks at whether the load is still wanted.
const FACES_PER_CHECK: usize = 1 << 14;

pub(super) fn assemble(
    parsed: &tobj::Mesh,
    facts: &Facts,
    recentre: Recentre,
    library: Library,
    progress: &Progress,
) -> Result<Loaded, Problem> {
    progress.enter(Phase::Checking);
    let mut warnings: Vec<Warning> = facts.ignored_statements().collect();
    let exact: Vec<DVec3> = points(&parsed.positions);
    let (materials, face_material) = materials(facts, library, &mut warnings);
    let (groups, face_group) = named_runs(&facts.face_groups, "");

    let mut mesh = TriangleMesh {
        origin: origin(&exact, recentre),
        normals: points(&parsed.normals)
            .into_iter()
            .map(DVec3::as_vec3)
            .collect(),
        materials,
        groups,
        ..TriangleMesh::default()
    };
    mesh.positions = exact.iter().map(|&p| (p - mesh.origin).as_vec3()).collect();
    add_triangles(&mut mesh, parsed, &exact, facts, &mut warnings, progress)?;
    for &face in &mesh.faces {
        mesh.material.push(face_material.of(face as usize));
        mesh.group.push(face_group.of(face as usize));
    }
    require_content(&mesh, facts)?;
    Ok(Loaded {
        max_rounding: max_rounding(&mesh, &exact),
        mesh,
        warnings,
        vertex_count: facts.vertex_count,
    })
}

fn points(numbers: &[f64]) -> Vec<DVec3> {
    numbers.chunks_exact(3).map(DVec3::from_slice).collect()
}

/// A point near the mesh whose coordinates have few bits, so that subtracting it in f64 is exact for
/// coordinates of up to some 29 bits below the mesh's size; zero if the mesh isn't far away.
fn origin(points: &[DVec3], recentre: Recentre) -> DVec3 {
    /// Nearer than this many sizes, f32 loses at most two bits more than at the origin.
    const NEAR: f64 = 4.0;
    let finite = points.iter().filter(|p| p.is_finite());
    let (min, max) = finite.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), &p| {
        (min.min(p), max.max(p))
    });
    let size = (max - min).max_element();
    let centre = 0.5 * min + 0.5 * max;
    if recentre == Recentre::Off || !centre.is_finite() || centre.abs().max_element() <= NEAR * size
    {
        return DVec3::ZERO;
    }
    // A mesh of one point: its own coordinates, as f32 holds them.
    if size == 0.0 {
        return centre.as_vec3().as_dvec3();
    }
    let grid = 2f64.powi(size.log2().floor() as i32);
    let origin = (centre / grid).round() * grid;
    if origin.is_finite() {
        origin
    } else {
        DVec3::ZERO
    }
}

/// Triangulates the faces, and leaves out triangles that no ray can hit.
fn add_triangles(
    mesh: &mut TriangleMesh,
    parsed: &tobj::Mesh,
    exact: &[DVec3],
    facts: &Facts,
    warnings: &mut Vec<Warning>,
    progress: &Progress,
) -> Result<(), Problem> {
    let has_normals = facts.face_has_normals.contains(&true);
    let mut triangulator = Triangulator::new();
    let (mut dropped, mut first) = (Dropped::default(), FirstFaces::default());
    let mut polygon: Vec<DVec3> = Vec::new();
    let mut start = 0;
    for face in 0..facts.face_count {
        if face % FACES_PER_CHECK == 0 {
            progress.check()?;
        }
        let count = parsed.face_arities.get(face).map_or(3, |&n| n as usize);
        let corners = start..start + count;
        start += count;
        let indices = &parsed.indices[corners.clone()];
        polygon.clear();
        polygon.extend(indices.iter().map(|&v| exact[v as usize]));
        if !indices
            .iter()
            .all(|&v| mesh.positions[v as usize].is_finite())
        {
            dropped.non_finite += count - 2;
            first.non_finite.get_or_insert(face);
            continue;
        }

        let before = mesh.triangles.len();
        let how = triangulator.cut(&polygon, |local| {
            let triangle = local.map(|k| indices[k]);
            if has_zero_area(triangle.map(|v| mesh.positions[v as usize])) {
                dropped.zero_area += 1;
                first.zero_area.get_or_insert(face);
                return;
            }
            mesh.triangles.push(triangle);
            mesh.faces.push(face as u32);
            mesh.outline.push(outline(local, count));
            if has_normals {
                let normals = &parsed.normal_indices[corners.clone()];
                let has_normal = facts.face_has_normals[face];
                let of_corner = |k: usize| if has_normal { normals[k] } else { NO_NORMAL };
                mesh.corner_normals.push(local.map(of_corner));
            }
        });
        mesh.face_count += usize::from(mesh.triangles.len() > before);
        if how == Cut::Fan {
            first.fans += 1;
            first.fan.get_or_insert(face);
        }
    }
    mesh.dropped = dropped;
    warnings.extend(first.warnings(dropped, facts));
    Ok(())
}

/// Which of a triangle's edges are edges of its polygon of `count` corners.
fn outline(local: [usize; 3], count: usize) -> u8 {
    (0..3)
        .filter(|&k| {
            let (from, to) = (local[k], local[(k + 1) % 3]);
            (from + 1) % count == to || (to + 1) % count == from
        })
        .fold(0, |bits, k| bits | 1 << k)
}

/// The first face of each kind of oddity.
#[derive(Default)]
struct FirstFaces {
    non_finite: Option<usize>,
    zero_area: Option<usize>,
    fan: Option<usize>,
    fans: usize,
}

impl FirstFaces {
    fn warnings(&self, dropped: Dropped, facts: &Facts) -> impl Iterator<Item = Warning> {
        let warning = |face: Option<usize>, message: String| {
            face.map(|face| Warning {
                line: Some(facts.face_line(face)),
                message,
            })
        };
        [
            warning(
                self.non_finite,
                format!(
                    "{} triangle(s) dropped: a corner is not finite",
                    dropped.non_finite
                ),
            ),
            warning(
                self.zero_area,
                format!(
                    "{} triangle(s) dropped: their area is zero",
                    dropped.zero_area
                ),
            ),
            warning(
                self.fan,
                format!(
                    "{} polygon(s) cross themselves or have no plane: cut as a fan",
                    self.fans
                ),
            ),
        ]
        .into_iter()
        .flatten()
    }
}

/// Which name a run of faces goes by: index into a list of names.
struct Runs(Vec<(usize, u32)>);

impl Runs {
    fn of(&self, face: usize) -> u32 {
        let run = self.0.partition_point(|(first, _)| *first <= face);
        run.checked_sub(1).map_or(0, |run| self.0[run].1)
    }
}

/// The distinct names, the first one for faces before any run, and the runs by index.
fn named_runs(runs: &[(usize, String)], default: &str) -> (Vec<String>, Runs) {
    let mut names = vec![default.to_owned()];
    let mut index = std::collections::HashMap::from([(default.to_owned(), 0)]);
    let numbered = runs.iter().map(|(first, name)| {
        let number = *index.entry(name.clone()).or_insert_with(|| {
            names.push(name.clone());
            names.len() as u32 - 1
        });
        (*first, number)
    });
    let numbered = numbered.collect();
    (names, Runs(numbered))
}

fn materials(
    facts: &Facts,
    library: Library,
    warnings: &mut Vec<Warning>,
) -> (Vec<Material>, Runs) {
    let mut known: Vec<Material> = Vec::new();
    for (line, name) in &facts.libraries {
        match library(name) {
            Ok(bytes) => known.extend(mtl::parse(&bytes)),
            Err(error) => warnings.push(Warning {
                line: Some(*line),
                message: format!("material library “{name}”: {error}"),
            }),
        }
    }
    let (names, runs) = named_runs(&facts.face_materials, "");
    let is_unknown = |name: &&String| !name.is_empty() && known.iter().all(|m| m.name != **name);
    let unknown: Vec<&String> = names.iter().filter(is_unknown).collect();
    if let Some(first) = unknown.first() {
        warnings.push(Warning {
            line: None,
            message: format!(
                "{} material(s) without a definition, “{first}” first",
                unknown.len()
            ),
        });
    }
    let materials = names.into_iter().map(|name| Material {
        diffuse: known
            .iter()
            .find(|m| m.name == name)
            .and_then(|m| m.diffuse),
        name,
    });
    (materials.collect(), runs)
}

/// A mesh without triangles is an error that says why.
fn require_content(mesh: &TriangleMesh, facts: &Facts) -> Result<(), Problem> {
    if !mesh.triangles.is_empty() {
        return Ok(());
    }
    let Dropped {
        zero_area,
        non_finite,
    } = mesh.dropped;
    let message = if zero_area + non_finite > 0 {
        let message = format!(
            "no triangle is left: {zero_area} have zero area, {non_finite} a corner that is NaN, infinite or too large for f32"
        );
        return Err(Problem::Line(facts.face_line(0), message));
    } else if facts.vertex_count > 0 {
        format!(
            "there are vertices ({}), but no faces: nothing to show",
            facts.vertex_count
        )
    } else {
        "no vertices and no faces: this is not an OBJ file, or an empty one".to_owned()
    };
    Err(Problem::Content(message))
}

/// What recentring and rounding to f32 moved a coordinate by, at most.
fn max_rounding(mesh: &TriangleMesh, exact: &[DVec3]) -> f64 {
    let moved = |(p, q): (&Vec3, &DVec3)| (p.as_dvec3() + mesh.origin - *q).abs().max_element();
    let finite = mesh
        .positions
        .iter()
        .zip(exact)
        .filter(|(p, _)| p.is_finite());
    finite.map(moved).fold(0.0, f64::max)
}
