//! Lookup of the picked face in its file, in the background.

use crate::task::Task;
use hitscope_core::obj::{FaceCorner, FaceSource, face_source};
use hitscope_core::progress::Progress;
use hitscope_core::{Scene, TriangleMesh};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The picked triangle in its file.
#[derive(Clone, Debug, PartialEq)]
pub enum FaceInFile {
    /// The face was found.
    Found {
        /// The statement of the face, shortened if it is long.
        statement: String,
        /// The corners of the triangle.
        corners: Box<[FaceCorner; 3]>,
    },
    /// The face couldn't be read, for this reason.
    Unknown(String),
}

impl FaceInFile {
    /// Reads the face at a line of a file or of the built-in scene, and compares it with a triangle of the mesh.
    fn read(
        path: Option<&Path>,
        mesh: &TriangleMesh,
        triangle: u32,
        line: usize,
        progress: &Progress,
    ) -> Self {
        let shown = path.unwrap_or(Path::new("the built-in scene"));
        match face_source(|| open_again(path), shown, line, progress) {
            Ok(source) => source
                .and_then(|source| Self::matched(source, mesh, triangle))
                .unwrap_or_else(|| {
                    Self::Unknown("The file has changed since it was loaded.".to_owned())
                }),
            Err(error) => Self::Unknown(error.to_string()),
        }
    }

    /// Finds the triangle's corners among those of the face; `None` if one is missing.
    fn matched(source: FaceSource, mesh: &TriangleMesh, triangle: u32) -> Option<Self> {
        let mut left = source.corners;
        let corners = mesh.corners(triangle).map(|position| {
            let loaded = |corner: &FaceCorner| (corner.position - mesh.origin()).as_vec3();
            let at = left.iter().position(|corner| loaded(corner) == position)?;
            Some(left.remove(at))
        });
        let [Some(a), Some(b), Some(c)] = corners else {
            return None;
        };
        Some(Self::Found {
            statement: source.statement,
            corners: Box::new([a, b, c]),
        })
    }

    fn corners(&self) -> Option<&[FaceCorner; 3]> {
        match self {
            Self::Found { corners, .. } => Some(corners),
            Self::Unknown(_) => None,
        }
    }

    /// Index of a corner's `v` statement in the file, counted from 1.
    pub fn vertex(&self, corner: usize) -> Option<usize> {
        Some(self.corners()?[corner].vertex)
    }

    /// The texture coordinates at barycentric coordinates; `None` if a corner has none.
    pub fn uv(&self, barycentric: [f32; 3]) -> Option<[f64; 2]> {
        let mut sum = glam::DVec2::ZERO;
        for (corner, weight) in self.corners()?.iter().zip(barycentric) {
            sum += corner.uv? * f64::from(weight);
        }
        Some(sum.to_array())
    }
}

/// Opens a regular file, which can be read twice, or the built-in scene.
pub(crate) fn open_again(path: Option<&Path>) -> io::Result<Box<dyn Read>> {
    let Some(path) = path else {
        return Ok(Box::new(crate::document::DEFAULT_OBJ.as_bytes()));
    };
    // Opening a pipe would block until there is a writer.
    if !std::fs::metadata(path)?.is_file() {
        let why = "only a regular file can be read again";
        return Err(io::Error::new(io::ErrorKind::Unsupported, why));
    }
    Ok(Box::new(File::open(path)?))
}

/// Starts to look up the face of a triangle; the face begins at `line`.
pub fn look_up_face(
    path: Option<PathBuf>,
    scene: &Arc<Scene>,
    triangle: u32,
    line: usize,
    ctx: &egui::Context,
) -> Task<FaceInFile> {
    let scene = Arc::clone(scene);
    Task::cancellable("face", ctx, move |progress| {
        FaceInFile::read(path.as_deref(), scene.mesh(), triangle, line, progress)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};

    #[test]
    fn a_triangles_corners_are_found_in_its_polygon_unless_the_file_has_changed() {
        let corner = |vertex, position, uv: [f64; 2]| FaceCorner {
            vertex,
            position,
            uv: Some(uv.into()),
            ..FaceCorner::default()
        };
        let source = FaceSource {
            statement: "f 7 8 9 10".to_owned(),
            corners: vec![
                corner(7, DVec3::ZERO, [0.0, 0.0]),
                corner(8, DVec3::X, [1.0, 0.0]),
                corner(9, DVec3::new(1.0, 1.0, 0.0), [1.0, 1.0]),
                corner(10, DVec3::Y, [0.0, 1.0]),
            ],
        };
        let triangle = TriangleMesh::new(
            vec![Vec3::new(1.0, 1.0, 0.0), Vec3::Y, Vec3::ZERO],
            vec![[0, 1, 2]],
        );
        let face = FaceInFile::matched(source.clone(), &triangle, 0).expect("it is there");
        let vertices = [0, 1, 2].map(|corner| face.vertex(corner));
        assert_eq!(vertices, [Some(9), Some(10), Some(7)]);
        assert_eq!(face.uv([0.5, 0.25, 0.25]), Some([0.5, 0.75]));
        let moved = TriangleMesh::new(vec![Vec3::ONE, Vec3::Y, Vec3::ZERO], vec![[0, 1, 2]]);
        assert_eq!(FaceInFile::matched(source, &moved, 0), None);
    }
}
