//! The thickness of the wall at a hit.

use super::in_file_f64;
use glam::UVec2;
use hitscope_core::kernel::exact_triangle_kernel;
use hitscope_core::measure::{WallPoint, thickness};
use hitscope_core::obj::LineRuns;
use hitscope_core::spawn::default_spawn_policy;
use hitscope_core::{Camera, Scene};
use serde::Serialize;

/// What lies on the normal's line through a hit: one exact ray each way.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ThicknessReport {
    /// The unit normal on the side that the ray sees.
    pub normal: [f64; 3],
    /// The other side of the wall, against the normal; `None` if there is none.
    pub inwards: Option<WallReport>,
    /// The next surface in front, along the normal; `None` if there is none.
    pub outwards: Option<WallReport>,
}

/// A surface that a ray along a normal hits.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WallReport {
    /// The distance from the hit along the normal, in the file's units.
    pub distance: f64,
    /// The point, in the file's coordinates.
    pub position: [f64; 3],
    /// The shape.
    pub shape: &'static str,
    /// Index of the primitive in the scene, counted from 0; triangles come first.
    pub primitive: u32,
    /// Index of the face in the file, counted from 0, if it is a triangle.
    pub face: Option<u32>,
    /// The face's line in the file, counted from 1, once [`find_line`](super::Inspection::find_line) has found it.
    pub line: Option<usize>,
}

impl ThicknessReport {
    /// Measures at the hit of the ray through a pixel's centre; `None` if it hits nothing or the surface has no normal.
    pub fn of_pixel(scene: &Scene, camera: &Camera, pixel: UVec2) -> Option<Self> {
        let exact = scene.intersector(exact_triangle_kernel());
        let ray = camera.ray_through(pixel.as_dvec2() + 0.5);
        let hit = exact.closest_hit(&ray)?;
        let found = thickness(scene, &*exact, default_spawn_policy(), (&ray, &hit))?;
        let report = |wall: WallPoint| WallReport::new(scene, wall);
        Some(Self {
            normal: found.normal.to_array(),
            inwards: found.inwards.map(report),
            outwards: found.outwards.map(report),
        })
    }

    /// Finds the lines of the faces.
    pub(super) fn find_lines(&mut self, face_lines: &LineRuns) {
        for wall in self.inwards.iter_mut().chain(&mut self.outwards) {
            let line = wall.face.map(|face| face_lines.line(face as usize));
            wall.line = line.filter(|&line| line > 0);
        }
    }
}

impl WallReport {
    fn new(scene: &Scene, wall: WallPoint) -> Self {
        let mesh = scene.mesh();
        let is_triangle = scene.is_triangle(wall.primitive);
        Self {
            distance: wall.distance,
            position: in_file_f64(mesh, wall.position),
            shape: scene.group_of(wall.primitive).0.shape().name,
            primitive: wall.primitive,
            face: is_triangle.then(|| mesh.face_of(wall.primitive)),
            line: None,
        }
    }
}
