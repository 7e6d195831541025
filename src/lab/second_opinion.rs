//! A second opinion about an OBJ file: the crate tobj reads it, too, and the results are compared.
//!
//! tobj 4.0.5 reads what most programs write. It refuses comments behind numbers and continued lines, takes polylines of
//! three and more points for faces, and panics on some invalid indices. So a difference isn't always hitscope's fault.

use glam::{DVec3, Vec2, Vec3};
use hitscope_core::TriangleMesh;
use hitscope_core::mesh::Attributes;
use hitscope_core::obj::LoadReport;
use serde::Serialize;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// What tobj reads differently.
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
            opinion.refused = Some("it panics".to_owned());
            return opinion;
        }
    };
    for (triangle, ours) in (0..).zip(corners(mesh)) {
        opinion.triangles += 1;
        let face = mesh.face_of(triangle) as usize;
        let place = format!("face {}, line {}", face + 1, report.face_lines.line(face));
        let Some(theirs) = faces.get(face) else {
            opinion.add(format!("{place}: tobj reads only {} faces", faces.len()));
            continue;
        };
        for (k, ours) in ours.iter().enumerate() {
            let is_same = |theirs: &Corner| ours.is_same(theirs, mesh.origin());
            // The corners of a polygon's triangles are in any order.
            let is_there = match theirs.len() {
                3 => is_same(&theirs[k]),
                _ => theirs.iter().any(is_same),
            };
            if !is_there {
                opinion.add(format!("{place}: tobj has {theirs:?}, not {ours:?}"));
                break;
            }
        }
    }
    // A face's triangles may all have been dropped, and so may the last faces.
    let last = mesh.triangles().len().checked_sub(1);
    let ours = last.map_or(0, |last| mesh.face_of(last as u32) as usize + 1);
    let dropped = report.dropped.zero_area + report.dropped.non_finite;
    if faces.len() > ours + dropped {
        let count = faces.len();
        opinion.add(format!("tobj reads {count} faces, hitscope {ours}"));
    }
    opinion
}

impl SecondOpinion {
    fn add(&mut self, difference: String) {
        /// As many as one reads.
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

impl Corner {
    /// Whether a corner of a mesh with this origin equals one of the file.
    fn is_same(&self, in_file: &Self, origin: DVec3) -> bool {
        fn agree<T: PartialEq>(ours: Option<T>, theirs: Option<T>) -> bool {
            ours.is_none() || theirs.is_none() || ours == theirs
        }
        let rounded = (in_file.position - origin).as_vec3();
        self.position.as_vec3() == rounded
            && agree(self.colour, in_file.colour)
            && agree(self.normal, in_file.normal)
            && agree(self.texture, in_file.texture)
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
