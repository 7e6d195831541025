//! Snapping: the vertex, edge or face that a click means.

use crate::camera::{Camera, Projection};
use crate::interaction::position_at;
use crate::mesh::TriangleMesh;
use crate::ray::{Hit, Ray};
use crate::scene::Scene;
use glam::{DVec2, DVec3, Vec3};

/// What a click snaps to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SnapTarget {
    /// A corner of the triangle that was hit, by its index in the mesh's positions.
    Vertex(u32),
    /// An edge of the face that was hit, by its two vertices. Diagonals of polygons aren't edges.
    Edge([u32; 2]),
    /// The face that was hit, or a surface that isn't a triangle.
    Face,
}

/// A point that a click snaps to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Snapped {
    /// What it is.
    pub target: SnapTarget,
    /// The point in the scene's coordinates: the vertex itself, the point of the edge that the picture shows nearest to the
    /// click, or the hit.
    pub position: DVec3,
    /// Its distance from the click in the picture, in pixels; 0 for a face.
    pub distance_px: f64,
    /// The primitive that was hit.
    pub primitive: u32,
}

impl Snapped {
    /// The point in the file's coordinates; a vertex has the digits that it has in the file.
    pub fn position_in_file(&self, mesh: &TriangleMesh) -> DVec3 {
        match self.target {
            SnapTarget::Vertex(vertex) => mesh.vertex_in_file(mesh.positions()[vertex as usize]),
            SnapTarget::Edge(_) | SnapTarget::Face => mesh.in_file(self.position),
        }
    }
}

/// The distances in the picture, in pixels, within which a click snaps. Nothing is within a negative distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SnapReach {
    /// To a vertex.
    pub vertex_px: f64,
    /// To an edge.
    pub edge_px: f64,
}

impl SnapReach {
    /// Every click means the face.
    pub const NONE: Self = Self {
        vertex_px: -1.0,
        edge_px: -1.0,
    };
    /// Every click means a vertex.
    pub const VERTEX: Self = Self {
        vertex_px: f64::INFINITY,
        ..Self::NONE
    };
    /// Every click means an edge.
    pub const EDGE: Self = Self {
        edge_px: f64::INFINITY,
        ..Self::NONE
    };

    /// The same distance to both.
    pub const fn within(px: f64) -> Self {
        Self {
            vertex_px: px,
            edge_px: px,
        }
    }
}

/// What a click at `at`, in pixels from the top left corner of the picture, snaps to: the nearest corner of the triangle
/// that its ray hits, if the picture shows one within reach, else the nearest edge, else the face.
pub fn snap(
    scene: &Scene,
    camera: &Camera,
    at: DVec2,
    (ray, hit): (&Ray, &Hit),
    reach: SnapReach,
) -> Snapped {
    let face = Snapped {
        target: SnapTarget::Face,
        position: position_at(scene, ray, hit),
        distance_px: 0.0,
        primitive: hit.primitive,
    };
    let Some(corners) = scene.corners(hit.primitive) else {
        return face;
    };
    let (mesh, corners) = (scene.mesh(), corners.map(Vec3::as_dvec3));
    let vertices = mesh.triangles()[hit.primitive as usize];
    let nearest = |a: &Snapped, b: &Snapped| a.distance_px.total_cmp(&b.distance_px);
    let vertex = (0..3).filter_map(|k| {
        Some(Snapped {
            target: SnapTarget::Vertex(vertices[k]),
            position: corners[k],
            distance_px: camera.pixel_of(corners[k])?.distance(at),
            ..face
        })
    });
    if let Some(vertex) = vertex
        .filter(|vertex| vertex.distance_px <= reach.vertex_px)
        .min_by(nearest)
    {
        return vertex;
    }
    let outline = mesh.attributes().faces.outline(hit.primitive);
    let closest = NEAR * camera.depth_of(face.position);
    let edge = (0..3).filter(|k| outline >> k & 1 == 1).filter_map(|k| {
        let next = (k + 1) % 3;
        let (position, distance_px) =
            shown_nearest(camera, [corners[k], corners[next]], at, closest)?;
        Some(Snapped {
            target: SnapTarget::Edge([vertices[k], vertices[next]]),
            position,
            distance_px,
            ..face
        })
    });
    edge.filter(|edge| edge.distance_px <= reach.edge_px)
        .min_by(nearest)
        .unwrap_or(face)
}

/// The part of an edge that is nearer to the eye than this part of the hit's distance isn't snapped to, nor is the part
/// behind the eye.
const NEAR: f64 = 1e-3;

/// The point of a segment that the picture shows nearest to a place, and its distance there in pixels; `None` if no part of
/// the segment is in front of the depth `closest`.
fn shown_nearest(
    camera: &Camera,
    ends: [DVec3; 2],
    at: DVec2,
    closest: f64,
) -> Option<(DVec3, f64)> {
    let [from, to] = in_front(camera, ends, closest)?;
    let (start, end) = (camera.pixel_of(from)?, camera.pixel_of(to)?);
    let along = (at - start).dot(end - start) / (end - start).length_squared();
    // NaN for an edge seen from its end.
    let along = if along > 0.0 { along.min(1.0) } else { 0.0 };
    let shown = start.lerp(end, along);
    // In perspective, the inverse of the depth varies linearly over the picture.
    let weights = match camera.projection() {
        Projection::Perspective { .. } => [
            (1.0 - along) * camera.depth_of(to),
            along * camera.depth_of(from),
        ],
        Projection::Orthographic { .. } => [1.0 - along, along],
    };
    let part = weights[1] / (weights[0] + weights[1]);
    Some((from + part * (to - from), shown.distance(at)))
}

/// The part of a segment with at least this depth.
fn in_front(camera: &Camera, [a, b]: [DVec3; 2], closest: f64) -> Option<[DVec3; 2]> {
    let depths = [a, b].map(|p| camera.depth_of(p) - closest);
    let crossing = || a + depths[0] / (depths[0] - depths[1]) * (b - a);
    match depths.map(|depth| depth >= 0.0) {
        [true, true] => Some([a, b]),
        [true, false] => Some([a, crossing()]),
        [false, true] => Some([crossing(), b]),
        [false, false] => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::exact_triangle_kernel;
    use crate::mesh::{Attributes, Faces};
    use crate::scene::scene;
    use glam::UVec2;

    /// A square in the plane z = 0 with a diagonal from (0, 0) to (4, 4).
    fn square() -> Scene {
        let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        let mut faces = Faces::default();
        faces.push(0, 0, 0b011);
        faces.push(1, 0, 0b110);
        let mesh = TriangleMesh::new(
            corners.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec(),
            vec![[0, 1, 2], [0, 2, 3]],
        );
        scene(mesh.with_attributes(Attributes {
            faces,
            ..Attributes::default()
        }))
    }

    fn snapped(scene: &Scene, camera: &Camera, at: DVec2) -> Snapped {
        let ray = camera.ray_through(at);
        let intersector = scene.intersector(exact_triangle_kernel());
        let hit = intersector.closest_hit(&ray).expect("a hit");
        snap(scene, camera, at, (&ray, &hit), SnapReach::within(6.0))
    }

    fn cameras() -> [Camera; 2] {
        let (eye, target) = (DVec3::new(1.0, -3.0, 5.0), DVec3::new(2.0, 2.0, 0.0));
        let perspective = Projection::Perspective { fov_y_radians: 1.0 };
        let orthographic = Projection::Orthographic { height: 6.0 };
        [perspective, orthographic].map(|projection| {
            Camera::look_at(eye, target, DVec3::Y, projection, UVec2::new(400, 300))
                .expect("a camera")
        })
    }

    #[test]
    fn a_click_snaps_to_the_nearest_vertex_then_edge_then_face() {
        let scene = square();
        for camera in cameras() {
            let pixel = |p: DVec3| camera.pixel_of(p).expect("in front");
            let corner = DVec3::new(4.0, 4.0, 0.0);
            let inwards = (pixel(DVec3::new(2.0, 2.0, 0.0)) - pixel(corner)).normalize();
            let at_corner = snapped(&scene, &camera, pixel(corner) + 5.0 * inwards);
            assert_eq!(at_corner.target, SnapTarget::Vertex(2));
            assert_eq!(at_corner.position, corner);
            assert!((at_corner.distance_px - 5.0).abs() < 1e-9);
            // Next to the middle of the right edge.
            let edge = DVec3::new(4.0, 1.5, 0.0);
            let inside = pixel(DVec3::new(3.95, 1.5, 0.0));
            let at_edge = snapped(&scene, &camera, inside);
            assert_eq!(at_edge.target, SnapTarget::Edge([1, 2]));
            assert_eq!(at_edge.position.x, 4.0);
            assert!((at_edge.position - edge).length() < 0.05, "{at_edge:?}");
            // No point of the edge is shown nearer to the click.
            for k in 0..=1000 {
                let other = pixel(DVec3::new(4.0, 4.0 * f64::from(k) / 1000.0, 0.0));
                assert!(at_edge.distance_px <= other.distance(inside) + 1e-9);
            }
            let shown = pixel(at_edge.position).distance(inside);
            assert!((shown - at_edge.distance_px).abs() < 1e-9);
            // On the diagonal, which is no edge.
            let middle = DVec3::new(2.0, 2.0, 0.0);
            let at_face = snapped(&scene, &camera, pixel(middle));
            assert_eq!(at_face.target, SnapTarget::Face);
            assert!((at_face.position - middle).length() < 1e-5);
        }
    }

    #[test]
    fn a_reach_can_be_for_one_kind_only() {
        let scene = square();
        let camera = cameras()[0];
        let pixel = |p: DVec3| camera.pixel_of(p).expect("in front");
        let at = pixel(DVec3::new(3.9, 3.5, 0.0));
        let ray = camera.ray_through(at);
        let intersector = scene.intersector(exact_triangle_kernel());
        let hit = intersector.closest_hit(&ray).expect("a hit");
        let target = |reach| snap(&scene, &camera, at, (&ray, &hit), reach).target;
        assert_eq!(target(SnapReach::NONE), SnapTarget::Face);
        assert_eq!(target(SnapReach::VERTEX), SnapTarget::Vertex(2));
        assert_eq!(target(SnapReach::EDGE), SnapTarget::Edge([1, 2]));
    }

    #[test]
    fn an_edge_that_passes_the_camera_is_snapped_to_where_it_is_seen() {
        let scene = square();
        let perspective = Projection::Perspective { fov_y_radians: 1.0 };
        // Above the square, looking along its right edge, with a part of it behind.
        let (eye, target) = (DVec3::new(3.9, 1.0, 0.2), DVec3::new(3.95, 4.0, 0.0));
        let camera = Camera::look_at(eye, target, DVec3::Z, perspective, UVec2::new(400, 300));
        let camera = camera.expect("a camera");
        let edge = camera
            .pixel_of(DVec3::new(4.0, 3.0, 0.0))
            .expect("in front");
        let found = snapped(&scene, &camera, edge - DVec2::new(3.0, 0.0));
        assert_eq!(found.target, SnapTarget::Edge([1, 2]));
        assert!((found.position.y - 3.0).abs() < 0.2, "{found:?}");
    }

    #[test]
    fn a_vertex_has_its_coordinates_in_the_file() {
        let mesh = square().mesh().clone();
        let mesh = mesh.with_origin(DVec3::new(1e6 + 0.1, 0.0, 0.0));
        let snapped = Snapped {
            target: SnapTarget::Vertex(1),
            position: DVec3::new(4.0, 0.0, 0.0),
            distance_px: 0.0,
            primitive: 0,
        };
        let in_file = snapped.position_in_file(&mesh);
        assert_eq!(in_file, DVec3::new(1_000_004.1, 0.0, 0.0));
    }
}
