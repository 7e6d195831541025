//! A hit, and the surface at its point.

use super::{Parameters, SolidReport};
use crate::formula;
use crate::surface::SurfacePoint;
use glam::Vec3;
use hitscope_core::interaction::SurfaceInteraction;
use hitscope_core::scene::{Scene, Shading};
use hitscope_core::{Hit, Ray};
use serde::Serialize;

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
    /// The primitive's parameters by name, if it is neither a triangle nor a solid.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parameters: Option<Parameters>,
    /// The solid, if it is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub solid: Option<SolidReport>,
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
    /// The derivation of t, line by line.
    pub formula: Vec<String>,
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
    /// The face's line in the file, counted from 1, once [`find_line`](super::Inspection::find_line) has found it.
    pub line: Option<usize>,
    /// The triangle's corners.
    pub vertices: [[f64; 3]; 3],
}

impl HitReport {
    /// The mesh at a ray's hit.
    pub fn new(scene: &Scene, ray: &Ray, hit: Hit, shading: Shading) -> Self {
        let mesh = scene.mesh();
        let surface = SurfaceInteraction::new(scene, ray, hit, shading);
        let (group, _) = scene.group_of(hit.primitive);
        let is_triangle = scene.is_triangle(hit.primitive);
        let materials = &mesh.attributes().materials;
        let material = materials.get(scene.material(hit.primitive));
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
            parameters: Parameters::of_primitive(scene, hit.primitive),
            solid: SolidReport::new(scene, ray, &hit, |t| t),
            surface_uv: (!is_triangle).then(|| scene.surface(ray, &hit).uv.to_array()),
            side: side(ray, surface.geometric_normal),
            position: SurfacePoint::in_file(scene, ray, &hit).position,
            geometric_normal: surface.geometric_normal.to_array(),
            shading_normal: surface.shading_normal.to_array(),
            material: material.map_or_else(String::new, |material| material.name.clone()),
            group: name.flatten().cloned().unwrap_or_default(),
            formula: formula::lines(scene, mesh.origin(), ray, &hit),
        }
    }
}

/// The side of a surface that a ray hits.
pub(super) fn side(ray: &Ray, geometric_normal: Vec3) -> &'static str {
    let is_back = ray.dir.as_dvec3().dot(geometric_normal.as_dvec3()) > 0.0;
    if is_back { "back" } else { "front" }
}

/// The barycentric coordinates of a hit, none below 0. The hit counts as inside, so values of the kernel, and
/// 1 − u − v, are below 0 by rounding only.
pub fn weights(hit: &Hit) -> [f32; 3] {
    hit.barycentric()
        .map(|weight| if weight < 0.0 { 0.0 } else { weight })
}
