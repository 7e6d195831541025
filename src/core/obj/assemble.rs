//! Assembles a mesh from a file's contents.
//!
//! Vertices are stored relative to the mesh's origin. The elements of each chunk are triangulated in parallel, straight into
//! the mesh's list, in file order.

use super::contents::Contents;
use super::corner::List;
use super::elements::Elements;
use super::error::{Problem, Warning};
use super::materials::{self, ReferencedFiles, ResolvedMaterials};
use super::oddities::{Oddities, no_triangles};
use super::origin::{ChosenOrigin, choose_origin, far_vertices, sample_surface};
use super::report::LoadReport;
use super::rounding::max_rounding;
use super::steps::LoadSteps;
use super::triangulate::{Assembly, ChunkTriangles};
use super::used::Used;
use super::{LoadOptions, Loaded, Recentre};
use crate::counts::counted_as;
use crate::mesh::{Assigned, Attributes, CornerValues, Runs, TriangleMesh};
use crate::progress::{Phase, Progress};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::sync::Mutex;

/// Assembles the mesh, and reads the materials and textures that it uses.
pub(super) fn assemble(
    mut contents: Contents,
    options: &LoadOptions,
    files: &dyn ReferencedFiles,
    progress: &Progress,
    steps: &mut LoadSteps,
) -> Result<Loaded, Problem> {
    progress.enter(Phase::Checking);
    let vertex_count = contents.positions.len();
    let prepared = steps.time("removing unused entries", || Prepared::of(&mut contents));
    let mut warnings = prepared.warnings;
    let resolve = || materials::resolve(&contents, files, options.max_memory, progress);
    let mut found = steps.time("materials", resolve)?;
    warnings.append(&mut found.warnings);
    let has_textures = options.keeps_coordinates || !found.textures.is_empty();
    progress.check()?;

    let exact = std::mem::take(&mut contents.positions);
    let recentre = || recentred(&exact, &prepared.surface, options.recentre);
    let (ChosenOrigin { origin, core }, positions) = steps.time("recentring", recentre);
    let elements = std::mem::take(&mut contents.elements);
    let assembly = Assembly {
        exact: &exact,
        positions: &positions,
        unusable_normals: &prepared.unusable_normals,
        used: &prepared.used,
        has_textures,
        contents: &contents,
        large_polygons: Mutex::new(()),
        progress,
    };
    let (mut triangles, parts) =
        steps.time("triangulating", || triangulate(&assembly, elements))?;
    progress.check()?;

    let (attributes, oddities) = steps.time("gathering", || {
        let (found, colours) = ((found, has_textures), prepared.colours);
        gather(&mut triangles, parts, &mut contents, found, colours)
    });
    let dropped = oddities.dropped(&contents.skipped);
    warnings.extend(oddities.warnings());
    progress.check()?;
    if triangles.is_empty() {
        return Err(no_triangles(&contents, dropped, vertex_count));
    }
    let mesh = TriangleMesh::new_unchecked(positions, triangles)
        .with_origin(origin)
        .with_attributes(attributes);
    let has_long_numbers = contents.has_long_numbers;
    let far = |core| far_vertices(&mesh, &exact, core, has_long_numbers);
    warnings.extend(core.and_then(far));
    let report = LoadReport {
        max_rounding: steps.time("rounding", || max_rounding(&mesh, &exact, has_long_numbers)),
        warnings,
        dropped,
        vertex_count,
        face_lines: contents.face_lines,
        ..LoadReport::default()
    };
    Ok(Loaded { mesh, report })
}

/// The origin, and the vertices' positions relative to it.
fn recentred(exact: &[DVec3], surface: &[DVec3], recentre: Recentre) -> (ChosenOrigin, Vec<Vec3>) {
    let chosen = choose_origin(exact, surface, recentre);
    let moved = exact.par_iter().map(|&p| (p - chosen.origin).as_vec3());
    let positions = moved.collect();
    (chosen, positions)
}

/// What the assembly needs besides the contents that elements use.
struct Prepared {
    /// Points of the surface, for the choice of the origin.
    surface: Vec<DVec3>,
    colours: Vec<Vec3>,
    used: Used,
    /// See [`unusable`].
    unusable_normals: Vec<bool>,
    warnings: Vec<Warning>,
}

impl Prepared {
    /// Takes the colours out of the contents, and removes the entries that no element uses.
    fn of(contents: &mut Contents) -> Self {
        let mut warnings = contents.warnings();
        let (mut colours, warning) = contents.colours.take(contents.positions.len());
        warnings.extend(warning);
        let surface = sample_surface(&contents.elements, &contents.positions);
        let used = keep_used(contents, &mut colours);
        let (unusable_normals, warning) = unusable(&contents.normals);
        warnings.extend(warning);
        Self {
            surface,
            colours,
            used,
            unusable_normals,
            warnings,
        }
    }
}

/// Removes the entries that no element uses.
fn keep_used(contents: &mut Contents, colours: &mut Vec<Vec3>) -> Used {
    let used = Used::in_elements(&contents.elements, contents.counts());
    used.keep(List::Vertex, &mut contents.positions);
    if !colours.is_empty() {
        used.keep(List::Vertex, colours);
    }
    used.keep(List::Texture, &mut contents.textures);
    used.keep(List::Normal, &mut contents.normals);
    used
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
        "{} zero or not finite in the file; computed instead",
        counted_as(count, "normal is", "normals are")
    );
    (normals, Some(Warning::of_file(message)))
}

/// Triangulates all chunks. Each fills its own part of the list of triangles, which may leave gaps.
fn triangulate(
    assembly: &Assembly,
    elements: Vec<Elements>,
) -> Result<(Vec<[u32; 3]>, Vec<ChunkTriangles>), Problem> {
    let progress = assembly.progress;
    progress.set_steps(0, elements.len());
    let most: usize = elements.iter().map(Elements::fan_triangles).sum();
    let mut triangles = vec![[0; 3]; most];
    let mut rest = &mut triangles[..];
    let mut part_of = |elements: Elements| {
        let (part, after) = std::mem::take(&mut rest).split_at_mut(elements.fan_triangles());
        rest = after;
        (elements, part)
    };
    let chunks: Vec<_> = elements.into_iter().map(&mut part_of).collect();
    let parts = chunks.into_par_iter().map(|(elements, triangles)| {
        progress.check()?;
        progress.add_step();
        assembly.triangulate(elements, triangles)
    });
    let parts = parts.collect::<Result<_, Problem>>()?;
    Ok((triangles, parts))
}

/// Moves the chunks' triangles together, and gathers their attributes and oddities.
fn gather(
    triangles: &mut Vec<[u32; 3]>,
    parts: Vec<ChunkTriangles>,
    contents: &mut Contents,
    (found, has_textures): (ResolvedMaterials, bool),
    colours: Vec<Vec3>,
) -> (Attributes, Oddities) {
    close_gaps(triangles, &parts);
    let normals = std::mem::take(&mut contents.normals);
    let coordinates = std::mem::take(&mut contents.textures);
    // Without a texture, texture coordinates aren't used.
    let coordinates = if has_textures {
        coordinates
    } else {
        Vec::new()
    };
    let mut attributes = Attributes {
        colours,
        normals: CornerValues::with_values(normals),
        texture_coordinates: CornerValues::with_values(coordinates),
        textures: found.textures,
        ..Attributes::default()
    };
    let mut oddities = Oddities::default();
    let mut all_runs: [Runs; 3] = Default::default();
    let mut count = 0;
    for part in parts {
        let first = count as u32;
        for (runs, begun) in all_runs.iter_mut().zip(&part.runs) {
            for &(triangle, number) in begun {
                runs.begin(first + triangle, number);
            }
        }
        let first_face = part.first_face as u32;
        attributes.append(first, part.count as u32, part.attributes, first_face);
        oddities.append(part.oddities);
        count += part.count;
    }
    attributes.shrink();
    let [materials, groups, smoothing] = all_runs;
    attributes.materials = Assigned::new(found.materials, materials);
    attributes.groups = Assigned::new(contents.groups.names.clone(), groups);
    attributes.smoothing = (!contents.smoothing.is_empty()).then_some(smoothing);
    (attributes, oddities)
}

/// Moves the chunks' triangles together.
fn close_gaps(triangles: &mut Vec<[u32; 3]>, parts: &[ChunkTriangles]) {
    if parts.iter().any(|part| !part.overflow.is_empty()) {
        let mut rest = &triangles[..];
        let mut all = Vec::with_capacity(parts.iter().map(|part| part.count).sum());
        for part in parts {
            let own;
            (own, rest) = rest.split_at(part.space);
            all.extend(&own[..part.count.min(part.space)]);
            all.extend(&part.overflow);
        }
        *triangles = all;
        return;
    }
    let (mut count, mut start) = (0, 0);
    for part in parts {
        if count < start {
            triangles.copy_within(start..start + part.count, count);
        }
        count += part.count;
        start += part.space;
    }
    triangles.truncate(count);
    triangles.shrink_to_fit();
}
