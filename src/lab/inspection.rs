//! Inspection of one ray: its hit, the exact answer, and the answers of all kernels.

use crate::frames;
use crate::json;
use crate::oracle::{self, ExactHit, Fraction};
use crate::surface::SurfacePoint;
use glam::{UVec2, Vec3};
use hitscope_core::interaction::SurfaceInteraction;
use hitscope_core::intersector::Cost;
use hitscope_core::kernel::{KernelChoice, exact_triangle_kernel};
use hitscope_core::mesh::TriangleMesh;
use hitscope_core::obj::LineRuns;
use hitscope_core::ray::ulp_at;
use hitscope_core::scene::{Scene, Shading};
use hitscope_core::{Camera, Hit, Intersector, Ray};
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
    /// The exact answer; `None` for a miss.
    pub exact: Option<ExactReport>,
    /// The answers of all kernels in the table.
    pub kernels: Vec<KernelRow>,
    /// The number of tests done for the ray.
    pub cost: CostReport,
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

/// A hit, and the mesh at this point. Positions are in the file's coordinates.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HitReport {
    /// Distance in units of the direction's length.
    pub t: f32,
    /// The shape that was hit.
    pub shape: &'static str,
    /// Index of the primitive in the scene, counted from 0; triangles come first.
    pub primitive: u32,
    /// The triangle, if it is one.
    #[serde(flatten)]
    pub triangle: Option<TriangleReport>,
    /// The primitive's parameters relative to the scene's origin, if it isn't a triangle.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub parameters: Vec<f32>,
    /// The surface coordinates, if it isn't a triangle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface_uv: Option<[f64; 2]>,
    /// The side that the ray hits: `front` if the geometric normal faces the ray's origin, as it does if a triangle's
    /// corners run counterclockwise as seen from there, else `back`.
    pub side: &'static str,
    /// The position; for a triangle, l1·A + l2·B + l3·C.
    pub position: [f64; 3],
    /// Unit length, by the right-hand rule.
    pub geometric_normal: [f32; 3],
    /// Unit length; the geometric one in flat shading.
    pub shading_normal: [f32; 3],
    /// Name of the material; empty if the face names none.
    pub material: String,
    /// Name of the group or object; empty if the face lies in none.
    pub group: String,
}

/// The triangle that was hit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TriangleReport {
    /// Barycentric coordinates for the three corners.
    pub barycentric: [f32; 3],
    /// Index of the triangle, counted from 0.
    #[serde(rename = "triangle")]
    pub index: u32,
    /// Index of the face in the file, counted from 0.
    pub face: u32,
    /// The face's line in the file, counted from 1, once [`Inspection::find_line`] has found it.
    pub line: Option<usize>,
    /// The triangle's corners.
    pub vertices: [[f64; 3]; 3],
}

/// The exact answer, correctly rounded to f64.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExactReport {
    /// The nearest primitive; the lowest index of several at the same t. For a scene of triangles alone, also called
    /// `triangle`.
    #[serde(rename = "triangle")]
    pub primitive: u32,
    /// Other primitives at exactly the same t.
    pub also: Vec<u32>,
    /// Distance in units of the direction's length.
    pub t: f64,
    /// The answer of the oracle about a triangle.
    #[serde(flatten)]
    pub fractions: Option<ExactTriangle>,
}

/// The exact answer about a triangle, also as fractions.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExactTriangle {
    /// Barycentric coordinates for the three corners.
    pub barycentric: [f64; 3],
    /// t as numerator/denominator.
    pub t_fraction: String,
    /// The barycentric coordinates likewise.
    pub barycentric_fractions: [String; 3],
    /// Whether the hit lies on an edge or at a corner.
    pub is_on_boundary: bool,
}

/// The answer of one kernel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KernelRow {
    /// The kernel.
    pub name: &'static str,
    /// Whether it found a hit.
    pub hit: bool,
    /// The triangle, counted from 0.
    pub triangle: Option<u32>,
    /// Distance in units of the direction's length.
    pub t: Option<f32>,
    /// Barycentric coordinates for the three corners.
    pub barycentric: Option<[f32; 3]>,
    /// |t − exact t| in ulps of f32, relative to the exact answer for the same triangle; `None` if the ray misses it
    /// in exact arithmetic.
    pub t_error_ulps: Option<f64>,
    /// The largest error of a barycentric coordinate, likewise.
    pub barycentric_error: Option<f64>,
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
    /// Traces the ray through a pixel's centre.
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
            kernels: kernels_of(scene, exact.as_ref().map(|exact| exact.primitive), hit)
                .into_iter()
                .map(|kernel| KernelRow::new(kernel, &subset, &ray, &candidates))
                .collect(),
            exact,
            cost: cost.into(),
        }
    }
}

impl Inspection {
    /// Finds the line of the face that was hit.
    pub fn find_line(&mut self, face_lines: &LineRuns) {
        let hit = self.hit.as_mut();
        if let Some(triangle) = hit.and_then(|hit| hit.triangle.as_mut()) {
            let line = face_lines.line(triangle.face as usize);
            triangle.line = (line > 0).then_some(line);
        }
    }

    /// As indented JSON.
    pub fn to_json(&self) -> String {
        json::to_pretty(self)
    }
}

impl HitReport {
    /// The mesh at a ray's hit.
    pub fn new(scene: &Scene, ray: &Ray, hit: Hit, shading: Shading) -> Self {
        let mesh = scene.mesh();
        let surface = SurfaceInteraction::new(scene, ray, hit, shading);
        let (group, index) = scene.group_of(hit.primitive);
        let is_triangle = scene.is_triangle(hit.primitive);
        let materials = &mesh.attributes().materials;
        let material = materials.get(scene.material(hit.primitive));
        let is_back = ray.dir.as_dvec3().dot(surface.geometric_normal.as_dvec3()) > 0.0;
        let name = is_triangle.then(|| mesh.attributes().groups.of(hit.primitive));
        Self {
            t: hit.t,
            shape: group.shape().name,
            primitive: hit.primitive,
            triangle: is_triangle.then(|| TriangleReport {
                barycentric: weights(&hit),
                index: hit.primitive,
                face: mesh.face_of(hit.primitive),
                line: None,
                vertices: mesh
                    .corners(hit.primitive)
                    .map(|p| mesh.vertex_in_file(p).to_array()),
            }),
            parameters: if is_triangle {
                Vec::new()
            } else {
                group.numbers(index)
            },
            surface_uv: (!is_triangle).then(|| scene.surface(ray, &hit).uv.to_array()),
            side: if is_back { "back" } else { "front" },
            position: SurfacePoint::in_file(scene, ray, &hit).position,
            geometric_normal: surface.geometric_normal.to_array(),
            shading_normal: surface.shading_normal.to_array(),
            material: material.map_or_else(String::new, |material| material.name.clone()),
            group: name.flatten().cloned().unwrap_or_default(),
        }
    }
}

impl ExactReport {
    /// The nearest hit: by the oracle if all candidates are triangles, else by the exact kernels.
    fn nearest(scene: &Scene, subset: &Scene, ray: &Ray, candidates: &[u32]) -> Option<Self> {
        let mesh = scene.mesh();
        if candidates
            .iter()
            .all(|&primitive| scene.is_triangle(primitive))
        {
            let (hit, triangles) = oracle::crossings(mesh, ray, candidates)
                .into_iter()
                .next()?;
            return Some(Self::of_triangle(&hit, triangles));
        }
        let crossings = subset.intersector(exact_triangle_kernel()).all_hits(ray);
        let first = crossings.into_iter().next()?;
        let number = |index: u32| candidates[index as usize];
        let primitive = number(first.hit.primitive);
        let also = first.also.into_iter().map(number);
        if scene.is_triangle(primitive) {
            let hit = oracle::intersect(ray, mesh.corners(primitive))?;
            let all = std::iter::once(primitive).chain(also).collect();
            return Some(Self::of_triangle(&hit, all));
        }
        Some(Self {
            primitive,
            also: also.collect(),
            t: scene.exact_answer(ray, primitive)?[0],
            fractions: None,
        })
    }

    fn of_triangle(hit: &ExactHit, primitives: Vec<u32>) -> Self {
        Self {
            primitive: primitives[0],
            also: primitives[1..].to_vec(),
            t: hit.t.to_f64(),
            fractions: Some(ExactTriangle {
                barycentric: hit.barycentric.each_ref().map(Fraction::to_f64),
                t_fraction: hit.t.to_string(),
                barycentric_fractions: hit.barycentric.each_ref().map(ToString::to_string),
                is_on_boundary: hit.is_on_boundary,
            }),
        }
    }
}

/// The kernels of the shape that is hit exactly, or else by the chosen kernel; those of triangles if nothing is hit.
fn kernels_of(scene: &Scene, exact: Option<u32>, hit: Option<Hit>) -> Vec<KernelChoice> {
    let primitive = exact.or(hit.map(|hit| hit.primitive));
    let infos = match primitive {
        Some(primitive) => scene.group_of(primitive).0.kernels(),
        None => scene.groups()[0].kernels(),
    };
    infos
        .into_iter()
        .map(|info| KernelChoice { info })
        .collect()
}

impl KernelRow {
    /// Traces the ray with a kernel through the candidates, which are the primitives of `subset`.
    fn new(kernel: KernelChoice, subset: &Scene, ray: &Ray, candidates: &[u32]) -> Self {
        let nearest = subset.intersector(kernel).closest_hit(ray);
        let of_triangle = nearest.filter(|hit| subset.is_triangle(hit.primitive));
        let corners = |hit: Hit| subset.mesh().corners(hit.primitive);
        let exact = of_triangle.and_then(|hit| oracle::intersect(ray, corners(hit)));
        let errors = of_triangle
            .zip(exact)
            .map(|(hit, exact)| errors(&hit, &exact));
        let t_error = |hit: Hit| {
            let [t, ..] = subset.exact_answer(ray, hit.primitive)?;
            Some((f64::from(hit.t) - t).abs() / ulp_at(t))
        };
        let t_error_ulps = match (of_triangle, nearest) {
            (Some(_), _) => errors.map(|(t, _)| t),
            (None, hit) => hit.and_then(t_error),
        };
        Self {
            name: kernel.info.name,
            hit: nearest.is_some(),
            triangle: nearest.map(|hit| candidates[hit.primitive as usize]),
            t: nearest.map(|hit| hit.t),
            barycentric: of_triangle.map(|hit| weights(&hit)),
            t_error_ulps,
            barycentric_error: errors.map(|(_, barycentric)| barycentric),
        }
    }
}

/// The error of t in ulps of f32, and the largest error of a barycentric coordinate.
fn errors(hit: &Hit, exact: &ExactHit) -> (f64, f64) {
    let t = Fraction::from_f64(hit.t.into()).expect("a hit is finite");
    let error = t.minus(&exact.t).to_f64().abs();
    let weights = exact.barycentric.each_ref().map(Fraction::to_f64);
    (error / ulp_at(exact.t.to_f64()), hit.weight_error(weights))
}

/// The barycentric coordinates of a hit, none below 0. The hit counts as inside, so values of the kernel, and
/// 1 − u − v, are below 0 by rounding only.
pub fn weights(hit: &Hit) -> [f32; 3] {
    hit.barycentric()
        .map(|weight| if weight < 0.0 { 0.0 } else { weight })
}

/// A point of the mesh in the file's coordinates.
fn in_file(mesh: &TriangleMesh, p: Vec3) -> [f64; 3] {
    mesh.in_file(p.as_dvec3()).to_array()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_in_ulps_of_the_exact_value() {
        let corners = [
            Vec3::ZERO,
            Vec3::new(4.0, 0.0, 0.0),
            Vec3::new(0.0, 4.0, 0.0),
        ];
        let ray = Ray::new(Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z).expect("a ray");
        let exact = oracle::intersect(&ray, corners).expect("inside");
        let hit = |t: f32, u: f32| Hit {
            t,
            u,
            v: 0.5,
            primitive: 0,
        };
        assert_eq!(errors(&hit(3.0, 0.25), &exact), (0.0, 0.0));
        let off = errors(&hit(3.0f32.next_up().next_up(), 0.25), &exact);
        assert_eq!(off, (2.0, 0.0));
        // An error of u makes the opposite error of the first coordinate.
        let (t, weights) = errors(&hit(3.0, 0.25 + 0.03125), &exact);
        assert_eq!((t, weights), (0.0, 0.03125));
    }
}
