//! The surface at a hit: normals, material, texture coordinates and colour.

use crate::barycentric::{spherical_mean, weighted};
use crate::ray::{Hit, Ray};
use crate::scene::{Scene, Shading};
use glam::{Vec2, Vec3};

/// Normals and material at a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceInteraction {
    /// Unit normal, independent of the side that the ray sees: by the right-hand rule over A, B, C for a triangle,
    /// outwards for a closed shape.
    pub geometric_normal: Vec3,
    /// Unit normal for shading; equals the geometric normal in flat shading and where the mesh has no other.
    pub shading_normal: Vec3,
    /// Index into the mesh's materials.
    pub material: u32,
}

impl SurfaceInteraction {
    /// Looks up a hit in the scene. The first smooth lookup computes the vertex normals of the whole mesh.
    pub fn new(scene: &Scene, ray: &Ray, hit: Hit, shading: Shading) -> Self {
        if !scene.is_triangle(hit.primitive) {
            let normal = scene.surface(ray, &hit).normal.as_vec3();
            return Self {
                geometric_normal: normal,
                shading_normal: normal,
                material: scene.material(hit.primitive),
            };
        }
        let mesh = scene.mesh();
        let weights = hit.barycentric();
        let geometric_normal = mesh.geometric_normal(hit.primitive);
        let shading_normal = match shading {
            Shading::Flat => geometric_normal,
            Shading::Smooth | Shading::Spherical => {
                let corners = scene.vertex_normals().of_triangle(mesh, hit.primitive);
                let interpolated = match shading {
                    Shading::Spherical => spherical_mean(weights, corners),
                    _ => weighted(weights, corners).try_normalize(),
                };
                interpolated.unwrap_or(geometric_normal)
            }
        };
        Self {
            geometric_normal,
            shading_normal,
            material: mesh.attributes().materials.index(hit.primitive),
        }
    }

    /// The shading normal, flipped to the side that the ray comes from.
    pub fn facing_normal(&self, ray: &Ray) -> Vec3 {
        if self.geometric_normal.dot(ray.dir) > 0.0 {
            -self.shading_normal
        } else {
            self.shading_normal
        }
    }
}

/// Texture coordinates at a hit; `None` if a corner of a triangle or the primitive has none.
pub fn texture_coordinates(scene: &Scene, ray: &Ray, hit: &Hit) -> Option<Vec2> {
    if scene.is_triangle(hit.primitive) {
        return scene.mesh().texture_coordinates_at(hit);
    }
    scene.texture_frame(ray, hit).map(|frame| frame.uv)
}

/// Vertex colour interpolated at a hit of a triangle, in sRGB; `None` if the mesh has no vertex colours.
pub fn vertex_colour(scene: &Scene, hit: &Hit) -> Option<Vec3> {
    let mesh = scene.mesh();
    if !scene.is_triangle(hit.primitive) || mesh.attributes().colours.is_empty() {
        return None;
    }
    let corners = mesh.triangles()[hit.primitive as usize];
    let colours = corners.map(|vertex| mesh.attributes().colours[vertex as usize]);
    Some(weighted(hit.barycentric(), colours))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::soup;
    use crate::mesh::{Attributes, CornerValues};
    use crate::progress::Progress;

    /// A triangle in the plane z = 0 with three different vertex normals.
    fn scene() -> Scene {
        let normals = vec![Vec3::X, Vec3::Y, Vec3::Z];
        let mesh = soup(&[[Vec3::ZERO, Vec3::X, Vec3::Y]]).with_attributes(Attributes {
            normals: CornerValues::new(normals, [[0, 1, 2]]),
            ..Attributes::default()
        });
        Scene::new(mesh, &Progress::default()).expect("nobody cancels")
    }

    #[test]
    fn the_nearest_corners_normal_dominates_and_faces_the_viewer() {
        let scene = scene();
        let hit = Hit {
            t: 1.0,
            u: 0.125,
            v: 0.625,
            primitive: 0,
        };
        let ray = Ray::new(Vec3::ZERO, Vec3::Z).expect("a ray");
        let flat = SurfaceInteraction::new(&scene, &ray, hit, Shading::Flat);
        assert_eq!(
            (flat.geometric_normal, flat.shading_normal),
            (Vec3::Z, Vec3::Z)
        );
        let smooth = SurfaceInteraction::new(&scene, &ray, hit, Shading::Smooth);
        let expected = Vec3::new(0.25, 0.125, 0.625).normalize();
        assert!((smooth.shading_normal - expected).length() < 1e-6);
        for (dir, side) in [(Vec3::NEG_Z, 1.0), (Vec3::Z, -1.0)] {
            let ray = Ray::new(Vec3::ZERO, dir).expect("a ray");
            assert_eq!(smooth.facing_normal(&ray), side * smooth.shading_normal);
        }
    }
}
