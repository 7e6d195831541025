//! The place of one flaw of a mesh.

use glam::{DVec3, Vec3};
use hitscope_core::mesh::{Flaw, FlawLocations, Health};
use hitscope_core::{Aabb, TriangleMesh};

/// One flaw and its surroundings.
#[derive(Clone, Debug, PartialEq)]
pub struct FlawPlace {
    /// The kind of flaw.
    pub flaw: Flaw,
    /// Index among the flaws of the kind, counted from 0.
    pub index: usize,
    /// Its centre, in the scene's coordinates.
    pub point: DVec3,
    /// Bounds of the adjacent triangles.
    pub bounds: Aabb,
    /// An adjacent face, counted from 0.
    pub face: Option<u32>,
}

impl FlawPlace {
    /// Finds a flaw in a mesh; `None` if the index is out of range.
    pub fn find(mesh: &TriangleMesh, health: &Health, flaw: Flaw, index: usize) -> Option<Self> {
        let vertices = vertices(mesh, health, flaw, index)?;
        let positions = || {
            vertices
                .iter()
                .map(|&vertex| mesh.positions()[vertex as usize])
        };
        // Vertices at the same position count as one.
        let touched = |corners: &[u32; 3]| {
            let at = |p: Vec3| corners.iter().any(|&v| mesh.positions()[v as usize] == p);
            positions().all(at)
        };
        let mut bounds = Aabb::around(positions());
        let mut face = None;
        for (triangle, corners) in (0..).zip(mesh.triangles()) {
            if touched(corners) {
                bounds = bounds.union(Aabb::around(mesh.corners(triangle)));
                face = face.or(Some(mesh.face_of(triangle)));
            }
        }
        let sum: DVec3 = positions().map(Vec3::as_dvec3).sum();
        Some(Self {
            flaw,
            index,
            point: sum / vertices.len() as f64,
            bounds,
            face,
        })
    }
}

/// The centre of a flaw, in the scene's coordinates.
pub fn point(mesh: &TriangleMesh, health: &Health, flaw: Flaw, index: usize) -> Option<DVec3> {
    let vertices = vertices(mesh, health, flaw, index)?;
    let positions = vertices
        .iter()
        .map(|&vertex| mesh.positions()[vertex as usize]);
    let sum: DVec3 = positions.map(Vec3::as_dvec3).sum();
    Some(sum / vertices.len() as f64)
}

/// The vertices of a flaw: those of a triangle or an edge, or a single one.
fn vertices(mesh: &TriangleMesh, health: &Health, flaw: Flaw, index: usize) -> Option<Vec<u32>> {
    match health.places(flaw) {
        FlawLocations::Edges(edges) => edges.get(index).map(|edge| edge.to_vec()),
        FlawLocations::Vertices(vertices) => vertices.get(index).map(|&vertex| vec![vertex]),
        FlawLocations::Triangles(triangles) => {
            let triangle = *triangles.get(index)?;
            Some(mesh.triangles()[triangle as usize].to_vec())
        }
        FlawLocations::Unknown => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flaw_has_a_centre_bounds_and_a_face() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y, 10.0 * Vec3::Z, Vec3::ONE];
        let two = TriangleMesh::new(corners, vec![[0, 1, 2], [0, 1, 4]]);
        let health = Health::of(&two);
        let places: Vec<FlawPlace> = (0..)
            .map_while(|index| FlawPlace::find(&two, &health, Flaw::OpenEdge, index))
            .collect();
        assert_eq!(places.len(), 4);
        let far = places
            .iter()
            .find(|place| place.point == DVec3::new(1.0, 0.5, 0.5));
        let far = far.expect("the edge from (1, 0, 0) to (1, 1, 1)");
        assert_eq!(far.face, Some(1));
        assert_eq!(far.bounds, Aabb::around([Vec3::ZERO, Vec3::ONE]));
        assert_eq!(
            point(&two, &health, Flaw::OpenEdge, far.index),
            Some(far.point)
        );
        assert_eq!(FlawPlace::find(&two, &health, Flaw::Sliver, 0), None);
    }
}
