//! The path of a sample.

use super::in_file;
use hitscope_core::Scene;
use hitscope_core::integrator::{Integrator, PathRecord, PathVertex, ShadowRay};
use serde::Serialize;

/// The path of one sample of a picture. Positions are in the file's coordinates; light is linear RGB, and is what the
/// vertex adds to the colour of the sample.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PathReport {
    /// The view.
    pub view: &'static str,
    /// Index of the sample in its pixel.
    pub sample: u32,
    /// The origin of the camera's ray.
    pub origin: [f64; 3],
    /// The surfaces that the path meets.
    pub vertices: Vec<VertexReport>,
    /// Why the path ends.
    pub end: &'static str,
    /// The unit direction of the last ray.
    pub last_direction: [f32; 3],
    /// The light that the last ray brings from infinitely far away, or the background.
    pub from_afar: [f32; 3],
    /// The colour of the sample: the sum of all light.
    pub radiance: [f32; 3],
}

/// A surface that a path meets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VertexReport {
    /// Distance in units of the length of the direction of the ray that arrives.
    pub t: f32,
    /// The shape.
    pub shape: &'static str,
    /// Index of the primitive in the scene, counted from 0.
    pub primitive: u32,
    /// The position.
    pub position: [f64; 3],
    /// Whether the path passes through the surface, because the surface covers only a part.
    pub is_passed: bool,
    /// The light that the surface emits.
    pub emission: [f32; 3],
    /// The light that the surface scatters straight from a light.
    pub direct: [f32; 3],
    /// The ray to the light, if one was traced.
    pub shadow_ray: Option<ShadowRayReport>,
    /// The throughput of the path that continues; 0 if it ends here.
    pub throughput: [f32; 3],
    /// The probability with which Russian roulette let the path continue, if it was played.
    pub survival: Option<f32>,
}

/// A ray to a light.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShadowRayReport {
    /// The unit direction to the light.
    pub direction: [f32; 3],
    /// The point of the light; null if it is infinitely far away.
    pub target: Option<[f64; 3]>,
    /// The part of the light that arrives.
    pub arriving: f32,
}

impl PathReport {
    /// Describes the path of a sample in a view of a scene.
    pub fn new(scene: &Scene, view: &Integrator, sample: u32, path: &PathRecord) -> Self {
        let vertices = path.vertices.iter();
        Self {
            view: view.name,
            sample,
            origin: in_file(scene.mesh(), path.origin),
            vertices: vertices
                .map(|vertex| VertexReport::new(scene, vertex))
                .collect(),
            end: path.end.text(),
            last_direction: path.last_dir.to_array(),
            from_afar: path.from_afar.to_array(),
            radiance: path.radiance.to_array(),
        }
    }
}

impl VertexReport {
    fn new(scene: &Scene, vertex: &PathVertex) -> Self {
        let shadow_ray = |ray: ShadowRay| ShadowRayReport {
            direction: ray.dir.to_array(),
            target: ray.target.map(|target| in_file(scene.mesh(), target)),
            arriving: ray.arriving,
        };
        Self {
            t: vertex.t,
            shape: scene.group_of(vertex.primitive).0.shape().name,
            primitive: vertex.primitive,
            position: in_file(scene.mesh(), vertex.position),
            is_passed: vertex.is_passed,
            emission: vertex.emission.to_array(),
            direct: vertex.direct.to_array(),
            shadow_ray: vertex.shadow_ray.map(shadow_ray),
            throughput: vertex.throughput.to_array(),
            survival: vertex.survival,
        }
    }

    /// What happens at the vertex besides scattering, in a few words; empty if nothing does.
    pub fn notes(&self) -> String {
        let mut notes = Vec::new();
        if self.is_passed {
            notes.push("passed through".to_owned());
        }
        match self.shadow_ray.map(|ray| ray.arriving) {
            None => {}
            Some(0.0) => notes.push("light blocked".to_owned()),
            Some(1.0) => notes.push("light visible".to_owned()),
            Some(part) => notes.push(format!("{:.3} % of the light arrives", 100.0 * part)),
        }
        if let Some(survival) = self.survival {
            notes.push(format!(
                "Russian roulette: survival probability {survival:.3}"
            ));
        }
        notes.join(", ")
    }
}

/// Light as text: its three channels, with four digits.
pub fn light_text(rgb: [f32; 3]) -> String {
    let text = |x: f32| {
        let is_plain = x == 0.0 || (1e-3..1e4).contains(&x.abs());
        if is_plain {
            format!("{x:.4}")
        } else {
            format!("{x:.3e}")
        }
    };
    rgb.map(text).join(" ")
}
