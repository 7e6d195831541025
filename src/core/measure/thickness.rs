//! The thickness of a wall behind a hit, and the clearance in front of it.

use crate::interaction::position_at;
use crate::intersector::Intersector;
use crate::ray::{Hit, Ray};
use crate::scene::Scene;
use crate::spawn::{Departure, SpawnPolicy};
use glam::{DVec3, Vec3};

/// What lies on the normal's line through a hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thickness {
    /// The unit normal on the side that the ray sees.
    pub normal: DVec3,
    /// The next surface behind the hit, against the normal: the other side of the wall. `None` if there is none.
    pub inwards: Option<WallPoint>,
    /// The next surface in front of the hit, along the normal. `None` if there is none.
    pub outwards: Option<WallPoint>,
}

/// A point of a surface that a ray along a normal hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallPoint {
    /// The distance from the hit along the normal.
    pub distance: f64,
    /// The point, in the scene's coordinates.
    pub position: DVec3,
    /// The primitive.
    pub primitive: u32,
}

/// Traces a ray each way along the normal at a hit. `exact` finds their hits; `policy` keeps them from hitting the surface
/// where they start. `None` if the surface has no normal there.
///
/// The distance errs by the rounding of the hit's position and of the normal to f32.
pub fn thickness(
    scene: &Scene,
    exact: &dyn Intersector,
    policy: &SpawnPolicy,
    (ray, hit): (&Ray, &Hit),
) -> Option<Thickness> {
    let surface = scene.surface(ray, hit);
    let normal = surface.facing_normal(-ray.dir);
    if normal == Vec3::ZERO {
        return None;
    }
    let start = position_at(scene, ray, hit);
    let next = |dir: Vec3| {
        let departure = Departure {
            arrived_by: ray,
            hit,
            surface: &surface,
            corners: scene.corners(hit.primitive),
            dir,
            offset: Vec3::ZERO,
        };
        let ray = policy.spawn(&departure).ok()?;
        let hit = exact.closest_hit(&ray)?;
        let position = position_at(scene, &ray, &hit);
        Some(WallPoint {
            distance: (position - start).dot(dir.as_dvec3()),
            position,
            primitive: hit.primitive,
        })
    };
    Some(Thickness {
        normal: normal.as_dvec3(),
        inwards: next(-normal),
        outwards: next(normal),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::group::Appearance;
    use crate::kernel::exact_triangle_kernel;
    use crate::mesh::TriangleMesh;
    use crate::mesh::shapes::{Placement, cube};
    use crate::progress::Progress;
    use crate::scene::{SceneOptions, scene};
    use crate::shape::Sphere;
    use crate::spawn::default_spawn_policy;

    fn measured(scene: &Scene, origin: Vec3, dir: Vec3) -> Thickness {
        let exact = scene.intersector(exact_triangle_kernel());
        let ray = Ray::new(origin, dir).expect("a ray");
        let hit = exact.closest_hit(&ray).expect("a hit");
        let found = thickness(scene, &*exact, default_spawn_policy(), (&ray, &hit));
        found.expect("triangles have normals")
    }

    /// Two plates, of which the upper is `thin`, with a gap of 1.
    fn plates(thin: f32, place: Vec3) -> Scene {
        let of = |height: f32, thickness: f32| {
            let plate = cube(3, Placement::UNIT);
            plate.map_positions(|p| Vec3::new(p.x, p.y, height + thickness * p.z / 3.0) + place)
        };
        let (lower, upper) = (of(0.0, 2.0), of(3.0, thin));
        let mut positions = lower.positions().to_vec();
        let first = positions.len() as u32;
        positions.extend(upper.positions());
        let mut triangles = lower.triangles().to_vec();
        let moved = upper.triangles().iter();
        triangles.extend(moved.map(|corners| corners.map(|vertex| vertex + first)));
        scene(TriangleMesh::new(positions, triangles))
    }

    #[test]
    fn a_plate_has_its_thickness_and_the_clearance_to_the_next() {
        for (thin, place) in [(0.5, 0.0), (1e-4, 0.0), (0.25, 1024.0)] {
            let place = Vec3::splat(place);
            let scene = plates(thin, place);
            // Slanted, onto the top of the lower plate, then onto the underside of the upper one.
            let inside = place + Vec3::new(1.3, 1.4, 2.5);
            let lower = measured(&scene, inside, Vec3::new(0.1, 0.2, -1.0));
            assert_eq!(lower.normal, DVec3::Z);
            let distances = |found: Thickness| {
                [found.inwards, found.outwards].map(|point| point.map(|point| point.distance))
            };
            assert_eq!(distances(lower), [Some(2.0), Some(1.0)], "{place}");
            let upper = measured(&scene, inside, Vec3::new(0.1, 0.2, 1.0));
            assert_eq!(upper.normal, DVec3::NEG_Z);
            let [wall, gap] = distances(upper).map(|distance| distance.expect("a surface"));
            assert_eq!(gap, 1.0);
            // The plate's corners are rounded to f32.
            let bound = f64::from(f32::EPSILON) * (4.0 + f64::from(place.z));
            assert!((wall - f64::from(thin)).abs() <= bound, "{wall}");
            let top = measured(&scene, inside + 9.0 * Vec3::Z, Vec3::NEG_Z);
            assert_eq!(top.outwards, None);
        }
    }

    #[test]
    fn a_sphere_is_as_thick_as_its_diameter() {
        let mut scene = scene(TriangleMesh::default());
        let sphere = Sphere {
            centre: Vec3::new(1.0, 2.0, 3.0),
            radius: 2.0,
        };
        let added = scene.add_group(
            vec![sphere],
            Appearance::default(),
            SceneOptions::default(),
            &Progress::default(),
        );
        added.expect("nobody cancels");
        let found = measured(&scene, Vec3::new(9.0, 2.5, 3.5), Vec3::NEG_X);
        let wall = found.inwards.expect("the other side");
        assert!((wall.distance - 4.0).abs() < 1e-5, "{wall:?}");
        assert_eq!(found.outwards, None);
    }
}
