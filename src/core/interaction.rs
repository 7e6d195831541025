//! The surface at a hit: normals, material, texture coordinates and colour.

use crate::barycentric::{spherical_mean, weighted};
use crate::mesh::TextureFrame;
use crate::ray::{Hit, Ray};
use crate::scene::{Scene, Shading};
use crate::shape::SurfacePoint;
use glam::{DVec3, Vec2, Vec3};

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
        Self::of_surface(scene, &scene.surface(ray, &hit), hit, shading)
    }

    /// The same for a hit whose surface is known.
    pub(crate) fn of_surface(
        scene: &Scene,
        surface: &SurfacePoint,
        hit: Hit,
        shading: Shading,
    ) -> Self {
        let geometric_normal = surface.normal.as_vec3();
        let shading_normal = if scene.is_triangle(hit.primitive) {
            interpolated_normal(scene, hit, shading).unwrap_or(geometric_normal)
        } else {
            geometric_normal
        };
        Self {
            geometric_normal,
            shading_normal,
            material: scene.material(hit.primitive),
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

/// The vertex normals of a triangle interpolated at a hit; `None` in flat shading, or if they cancel.
fn interpolated_normal(scene: &Scene, hit: Hit, shading: Shading) -> Option<Vec3> {
    let corners = || {
        let normals = scene.vertex_normals();
        normals.of_triangle(scene.mesh(), hit.primitive)
    };
    match shading {
        Shading::Flat => None,
        Shading::Smooth => weighted(hit.barycentric(), corners()).try_normalize(),
        Shading::Spherical => spherical_mean(hit.barycentric(), corners()),
    }
}

/// The point of a hit in f64, in the scene's coordinates: of a triangle from the barycentric coordinates.
pub fn position_at(scene: &Scene, ray: &Ray, hit: &Hit) -> DVec3 {
    match scene.corners(hit.primitive) {
        Some(corners) => {
            let [a, b, c] = corners.map(Vec3::as_dvec3);
            a + f64::from(hit.u) * (b - a) + f64::from(hit.v) * (c - a)
        }
        None => scene.surface(ray, hit).position.as_dvec3(),
    }
}

/// Texture coordinates at a hit at a position; `None` if a corner of a triangle or the primitive has none.
pub fn texture_coordinates(scene: &Scene, position: Vec3, hit: &Hit) -> Option<Vec2> {
    if scene.is_triangle(hit.primitive) {
        return scene.mesh().texture_coordinates_at(hit);
    }
    texture_frame(scene, position, hit).map(|frame| frame.uv)
}

/// Texture coordinates and their derivatives at a hit at a position; `None` if there are none, or if those of a triangle
/// lie on a line.
pub(crate) fn texture_frame(scene: &Scene, position: Vec3, hit: &Hit) -> Option<TextureFrame> {
    if scene.is_triangle(hit.primitive) {
        return scene.mesh().texture_frame(hit);
    }
    let (group, index) = scene.group_of(hit.primitive);
    group.texture_frame(index, position)
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
