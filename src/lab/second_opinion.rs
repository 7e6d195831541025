//! Compares a loaded mesh with the result of the OBJ reader tobj.
//!
//! tobj 4.0.5 reads what most programs write. It refuses comments after numbers and continued lines, reads polylines of
//! three or more points as faces, and panics on some invalid indices. A difference is therefore not always a bug in
//! hitscope.

use glam::{DVec3, Vec2, Vec3};
use hitscope_core::TriangleMesh;
use hitscope_core::counts::counted;
use hitscope_core::mesh::Attributes;
use hitscope_core::obj::LoadReport;
use serde::Serialize;
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// The differences between a mesh and tobj's result.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SecondOpinion {
    /// Why tobj can't read the file; nothing is compared then.
    pub refused: Option<String>,
    /// Number of triangles whose corners were compared.
    pub triangles: usize,
    /// The first differences.
    pub differences: Vec<String>,
    /// Number of all differences.
    pub difference_count: usize,
}

/// Reads the bytes of a file with tobj, and compares faces, positions to the bit, and, where every corner has them,
/// colours, normals and texture coordinates with those of the mesh.
pub fn compare(bytes: &[u8], mesh: &TriangleMesh, report: &LoadReport) -> SecondOpinion {
    let mut opinion = SecondOpinion {
        refused: None,
        triangles: 0,
        differences: Vec::new(),
        difference_count: 0,
    };
    let read = || faces_by_tobj(bytes);
    let faces = match catch_unwind(AssertUnwindSafe(read)) {
        Ok(Ok(faces)) => faces,
        Ok(Err(error)) => {
            opinion.refused = Some(error.to_string());
            return opinion;
        }
        Err(_) => {
            opinion.refused = Some("tobj panicked".to_owned());
            return opinion;
        }
    };
    let triangles: Vec<[Corner; 3]> = corners(mesh).collect();
    opinion.triangles = triangles.len();
    let face_of = |triangle: usize| mesh.face_of(triangle as u32) as usize;
    let mut start = 0;
    while start < triangles.len() {
        let face = face_of(start);
        let end = (start..triangles.len()).find(|&triangle| face_of(triangle) != face);
        let end = end.unwrap_or(triangles.len());
        let place = format!("face {}, line {}", face + 1, report.face_lines.line(face));
        match faces.get(face) {
            None => opinion.add(format!(
                "{place}: tobj reads only {}",
                counted(faces.len(), "face")
            )),
            Some(theirs) => {
                if let Some(difference) = difference(&triangles[start..end], theirs, mesh.origin())
                {
                    opinion.add(format!("{place}: {difference}"));
                }
            }
        }
        start = end;
    }
    let (ours, theirs) = (report.face_lines.count(), faces.len());
    if ours != theirs {
        let theirs = counted(theirs, "face");
        opinion.add(format!("tobj reads {theirs}, hitscope {ours}"));
    }
    opinion
}

/// The first difference between a face's triangles and its corners as read by tobj.
fn difference(ours: &[[Corner; 3]], theirs: &[Corner], origin: DVec3) -> Option<String> {
    // The corners of a polygon's triangles are in any order.
    let is_there = |k: usize, own: &Corner| match theirs {
        [_, _, _] => own.is_same(&theirs[k], origin),
        _ => theirs.iter().any(|corner| own.is_same(corner, origin)),
    };
    for own in ours.iter().flat_map(|triangle| triangle.iter().enumerate()) {
        if !is_there(own.0, own.1) {
            return Some(match theirs {
                [_, _, _] => format!(
                    "tobj reads corner {} as {}, hitscope as {}",
                    own.0 + 1,
                    theirs[own.0],
                    own.1
                ),
                _ => format!("tobj has no corner {}", own.1),
            });
        }
    }
    // With fewer triangles than a fan, some were dropped.
    let is_whole = ours.len() + 2 >= theirs.len();
    // Of corners at one position, a triangulation may use one.
    let is_repeated = |corner: &Corner| {
        let here = theirs
            .iter()
            .filter(|other| other.position == corner.position);
        here.count() > 1
    };
    let is_reached = |corner: &&Corner| {
        let own = ours.as_flattened();
        let is_repeated = is_repeated(corner);
        own.iter()
            .any(|own| own.is_same(corner, origin) || is_repeated && own.is_at(corner, origin))
    };
    let missed = theirs.iter().find(|corner| !is_reached(corner));
    missed
        .filter(|_| is_whole)
        .map(|corner| format!("no triangle reaches corner {corner}, which tobj reads"))
}

impl SecondOpinion {
    fn add(&mut self, difference: String) {
        /// Enough to recognise the kind of difference.
        const MOST_LISTED: usize = 20;
        if self.differences.len() < MOST_LISTED {
            self.differences.push(difference);
        }
        self.difference_count += 1;
    }
}

/// The data of a face's corner; `None` where not every corner has it.
#[derive(Debug, PartialEq)]
struct Corner {
    position: DVec3,
    colour: Option<Vec3>,
    normal: Option<Vec3>,
    texture: Option<Vec2>,
}

impl fmt::Display for Corner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let DVec3 { x, y, z } = self.position;
        write!(f, "({x}, {y}, {z})")?;
        if let Some(colour) = self.colour {
            write!(f, " of colour {colour}")?;
        }
        if let Some(normal) = self.normal {
            write!(f, " with normal {normal}")?;
        }
        if let Some(texture) = self.texture {
            write!(f, " with texture coordinates {texture}")?;
        }
        Ok(())
    }
}

impl Corner {
    /// Whether a corner of a mesh with this origin has the bits of one in the file as its position.
    fn is_at(&self, in_file: &Self, origin: DVec3) -> bool {
        let rounded = (in_file.position - origin).as_vec3();
        let bits = |p: Vec3| p.to_array().map(f32::to_bits);
        bits(self.position.as_vec3()) == bits(rounded)
    }

    /// Whether a corner of a mesh with this origin has the bits of one in the file.
    fn is_same(&self, in_file: &Self, origin: DVec3) -> bool {
        fn agree<const N: usize>(ours: Option<[f32; N]>, theirs: Option<[f32; N]>) -> bool {
            let bits = |values: [f32; N]| values.map(f32::to_bits);
            ours.is_none() || theirs.is_none() || ours.map(bits) == theirs.map(bits)
        }
        let of_three = |values: Option<Vec3>| values.map(|v| v.to_array());
        let of_two = |values: Option<Vec2>| values.map(|v| v.to_array());
        self.is_at(in_file, origin)
            && agree(of_three(self.colour), of_three(in_file.colour))
            && agree(of_three(self.normal), of_three(in_file.normal))
            && agree(of_two(self.texture), of_two(in_file.texture))
    }
}

/// The corners of each triangle; positions are relative to the mesh's origin.
fn corners(mesh: &TriangleMesh) -> impl Iterator<Item = [Corner; 3]> {
    let Attributes {
        normals,
        texture_coordinates,
        colours,
        ..
    } = mesh.attributes();
    let triangles = 0..mesh.triangles().len() as u32;
    let has_normals = triangles.clone().all(|t| normals.are_complete(t));
    let has_textures = triangles
        .clone()
        .all(|t| texture_coordinates.are_complete(t));
    triangles.map(move |triangle| {
        let normals = normals.of_triangle(triangle);
        let textures = texture_coordinates.of_triangle(triangle);
        [0, 1, 2].map(|k| {
            let vertex = mesh.triangles()[triangle as usize][k] as usize;
            Corner {
                position: mesh.positions()[vertex].as_dvec3(),
                colour: colours.get(vertex).copied(),
                normal: normals[k].filter(|_| has_normals),
                texture: textures[k].filter(|_| has_textures),
            }
        })
    })
}

/// The corners of every face, read by tobj.
fn faces_by_tobj(bytes: &[u8]) -> Result<Vec<Vec<Corner>>, tobj::LoadError> {
    let options = tobj::LoadOptions {
        single_index: false,
        ignore_lines: true,
        ignore_points: true,
        ..tobj::LoadOptions::default()
    };
    let no_library = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut &*bytes, &options, no_library)?;
    let meshes = models.into_iter().map(|model| model.mesh);
    Ok(meshes.flat_map(|mesh| faces_of(&mesh)).collect())
}

fn faces_of(mesh: &tobj::Mesh) -> Vec<Vec<Corner>> {
    let three = |values: &[f64], k: u32| {
        let at = 3 * k as usize;
        values.get(at..at + 3).map(DVec3::from_slice)
    };
    let has_colours = mesh.vertex_color.len() == mesh.positions.len();
    let has_normals = mesh.normal_indices.len() == mesh.indices.len();
    let has_textures = mesh.texcoord_indices.len() == mesh.indices.len();
    let corner = |corner: usize| {
        let vertex = mesh.indices[corner];
        let normal = has_normals.then(|| mesh.normal_indices[corner]);
        let texture = has_textures.then(|| 2 * mesh.texcoord_indices[corner] as usize);
        Corner {
            position: three(&mesh.positions, vertex).unwrap_or(DVec3::NAN),
            colour: has_colours
                .then(|| three(&mesh.vertex_color, vertex))
                .flatten()
                .map(|c| c.as_vec3()),
            normal: normal
                .and_then(|k| three(&mesh.normals, k))
                .map(|n| n.as_vec3()),
            texture: texture.and_then(|k| {
                let [u, v] = *mesh.texcoords.get(k..k + 2)?.first_chunk()?;
                Some(Vec2::new(u as f32, v as f32))
            }),
        }
    };
    // Listed only if a face doesn't have three corners.
    let arities = match &mesh.face_arities[..] {
        [] => vec![3; mesh.indices.len() / 3],
        arities => arities.to_vec(),
    };
    let mut start = 0;
    let face = |arity: u32| {
        let corners = start..start + arity as usize;
        start = corners.end;
        corners.map(corner).collect()
    };
    arities.into_iter().map(face).collect()
}
