//! Inspection of one ray: its hit, all crossings, the exact answer, and the answers of all kernels.

mod crossing;
mod exact;
mod hit;
mod kernel_row;
mod parameters;
mod path;
mod solid;
mod thickness;

pub use crossing::CrossingReport;
pub use exact::{ExactReport, ExactTriangle};
pub use hit::{HitReport, TriangleReport, weights};
pub use kernel_row::KernelRow;
pub use parameters::{ParameterReport, ParameterValue, Parameters};
pub use path::{PathReport, ShadowRayReport, VertexReport, light_text};
pub use solid::{OperandName, OperandReport, SolidPart, SolidPartKind, SolidReport};
pub use thickness::{ThicknessReport, WallReport};

use crate::frames;
use crate::json;
use glam::{DVec3, UVec2, Vec3};
use hitscope_core::intersector::Cost;
use hitscope_core::mesh::TriangleMesh;
use hitscope_core::obj::LineRuns;
use hitscope_core::scene::{Scene, Shading};
use hitscope_core::{Camera, Intersector};
use kernel_row::kernels_of;
use serde::Serialize;

/// The ray of a pixel, and everything known about it. Serialises to the output of `inspect --json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Inspection {
    /// The pixel, from the top left.
    pub pixel: [u32; 2],
    /// The ray through its centre.
    pub ray: RayReport,
    /// The kernel.
    pub kernel: &'static str,
    /// The kernel's hit; `None` for a miss.
    pub hit: Option<HitReport>,
    /// All points where the ray crosses a surface according to the kernel, ordered by t.
    pub crossings: Vec<CrossingReport>,
    /// The exact answer; `None` for a miss.
    pub exact: Option<ExactReport>,
    /// The answers of all kernels in the table.
    pub kernels: Vec<KernelRow>,
    /// The number of tests done for the ray.
    pub cost: CostReport,
    /// The thickness of the wall, if it was asked for; `Some(None)` if the ray hits nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thickness: Option<Option<ThicknessReport>>,
    /// The path of a sample, if one was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<PathReport>,
}

/// A ray in the file's coordinates.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RayReport {
    /// The origin.
    pub origin: [f64; 3],
    /// The direction; t is in units of its length.
    pub direction: [f32; 3],
    /// The largest distance per coordinate, in the file's units, between this ray and the camera's ray in f64, where
    /// they may meet the mesh. Large for a distant camera.
    pub ray_rounding: f64,
}

/// The number of tests done for a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct CostReport {
    /// Boxes tested.
    pub boxes: u32,
    /// Triangles tested.
    pub triangles: u32,
    /// Triangles whose bounds the exact kernel narrowed in f64; 0 for other kernels.
    pub in_f64: u32,
    /// Decisions that the exact kernel took in integers.
    pub in_integers: u32,
}

impl From<Cost> for CostReport {
    fn from(cost: Cost) -> Self {
        Self {
            boxes: cost.boxes,
            triangles: cost.primitives,
            in_f64: cost.in_f64,
            in_integers: cost.in_integers,
        }
    }
}

impl Inspection {
    /// Traces the ray through a pixel's centre. Of a clipped scene, with its clipped intersector, everything is of the part
    /// that is shown.
    pub fn of_pixel(
        scene: &Scene,
        intersector: &dyn Intersector,
        shading: Shading,
        camera: &Camera,
        pixel: UVec2,
    ) -> Self {
        let at = pixel.as_dvec2() + 0.5;
        let ray = camera.ray_through(at);
        let (hit, cost) = intersector.closest_hit_with_cost(&ray);
        let mesh = scene.mesh();
        // Sorted, so that the first of several at the same t is the lowest.
        let mut candidates = intersector.candidates(&ray);
        candidates.sort_unstable();
        let subset = scene.subset(&candidates);
        let exact = ExactReport::nearest(scene, &subset, &ray, &candidates);
        Self {
            pixel: pixel.to_array(),
            ray: RayReport {
                origin: in_file(mesh, ray.origin),
                direction: ray.dir.to_array(),
                ray_rounding: frames::rounding(scene, &ray, camera.ray_before_rounding(at)),
            },
            kernel: intersector.kernel().name,
            hit: hit.map(|hit| HitReport::new(scene, &ray, hit, shading)),
            crossings: intersector
                .all_hits(&ray)
                .into_iter()
                .map(|crossing| CrossingReport::new(scene, &ray, crossing))
                .collect(),
            kernels: kernels_of(scene, exact.as_ref().map(|exact| exact.primitive), hit)
                .into_iter()
                .map(|kernel| KernelRow::new(kernel, &subset, &ray, &candidates))
                .collect(),
            exact,
            cost: cost.into(),
            thickness: None,
            path: None,
        }
    }
}

impl Inspection {
    /// Finds the lines of the faces that were hit.
    pub fn find_line(&mut self, face_lines: &LineRuns) {
        let hit = self.hit.as_mut();
        if let Some(triangle) = hit.and_then(|hit| hit.triangle.as_mut()) {
            let line = face_lines.line(triangle.face as usize);
            triangle.line = (line > 0).then_some(line);
        }
        if let Some(Some(thickness)) = &mut self.thickness {
            thickness.find_lines(face_lines);
        }
    }

    /// As indented JSON.
    pub fn to_json(&self) -> String {
        json::to_pretty(self)
    }
}

/// A point of the mesh in the file's coordinates.
fn in_file(mesh: &TriangleMesh, p: Vec3) -> [f64; 3] {
    in_file_f64(mesh, p.as_dvec3())
}

fn in_file_f64(mesh: &TriangleMesh, p: DVec3) -> [f64; 3] {
    mesh.in_file(p).to_array()
}
