//! Mesh checks: borders, non-manifold edges, flipped triangles, slivers and other flaws.

mod t_junctions;
mod triangles;

pub use triangles::SLIVER_ASPECT;

use super::edges::{EdgeTable, EdgeUse, VertexFans};
use super::{TriangleMesh, Welded};
use crate::aabb::Aabb;
use rayon::prelude::*;

/// A kind of flaw of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flaw {
    /// An edge with one triangle: the mesh has a border there.
    OpenEdge,
    /// An edge with more than two triangles.
    NonManifoldEdge,
    /// An edge that its two triangles traverse in the same direction: one of them is flipped.
    FlippedEdge,
    /// A border vertex in the interior of another border edge: the mesh looks closed there, but isn't.
    TJunction,
    /// A vertex at which parts of the surface touch without a common edge.
    TouchingVertex,
    /// A triangle with the same corners as an earlier one.
    Duplicate,
    /// A triangle whose longest edge is more than [`SLIVER_ASPECT`] times its height.
    Sliver,
}

/// Names and description of a kind of flaw.
#[derive(Clone, Copy, Debug)]
pub struct FlawInfo {
    /// The kind of flaw.
    pub flaw: Flaw,
    /// The name in reports.
    pub name: &'static str,
    /// The name in menus.
    pub title: &'static str,
    /// A description of one sentence.
    pub about: &'static str,
}

/// Every kind of flaw, in the order of [`Flaw`].
pub static FLAWS: [FlawInfo; 7] = [
    FlawInfo {
        flaw: Flaw::OpenEdge,
        name: "open_edges",
        title: "Open edges",
        about: "Edges with one triangle: the mesh has a border there.",
    },
    FlawInfo {
        flaw: Flaw::NonManifoldEdge,
        name: "non_manifold_edges",
        title: "Non-manifold edges",
        about: "Edges with more than two triangles.",
    },
    FlawInfo {
        flaw: Flaw::FlippedEdge,
        name: "flipped_edges",
        title: "Flipped edges",
        about: "Edges between two triangles of opposite winding.",
    },
    FlawInfo {
        flaw: Flaw::TJunction,
        name: "t_junctions",
        title: "T-junctions",
        about: "Border vertices in the interior of another border edge.",
    },
    FlawInfo {
        flaw: Flaw::TouchingVertex,
        name: "touching_vertices",
        title: "Touching vertices",
        about: "Vertices at which parts of the surface touch without a common edge.",
    },
    FlawInfo {
        flaw: Flaw::Duplicate,
        name: "duplicates",
        title: "Duplicates",
        about: "Triangles with the same corners as an earlier one.",
    },
    FlawInfo {
        flaw: Flaw::Sliver,
        name: "slivers",
        title: "Slivers",
        about: "Triangles whose longest edge is more than 1000 times their height.",
    },
];

/// The locations of one kind of flaw.
#[derive(Clone, Debug, PartialEq)]
pub enum FlawLocations {
    /// The end vertices of edges.
    Edges(Vec<[u32; 2]>),
    /// Triangle indices.
    Triangles(Vec<u32>),
    /// Vertex indices.
    Vertices(Vec<u32>),
    /// Not checked, because the check would take too long.
    Unknown,
}

impl FlawLocations {
    /// The number of locations; `None` if they weren't checked.
    pub fn count(&self) -> Option<usize> {
        match self {
            Self::Edges(edges) => Some(edges.len()),
            Self::Triangles(triangles) => Some(triangles.len()),
            Self::Vertices(vertices) => Some(vertices.len()),
            Self::Unknown => None,
        }
    }
}

/// The flaws of a mesh.
#[derive(Clone, Debug)]
pub struct Health {
    /// The locations of each [`Flaw`], in the order of [`FLAWS`].
    places: [FlawLocations; 7],
    /// The bounding box of the triangles at each flaw's locations.
    bounds: [Aabb; 7],
    /// The largest ratio of longest edge to height of any triangle; infinite if a height is 0 in f64.
    pub max_aspect: f64,
}

impl Health {
    /// Upper bound on the memory that [`of`](Self::of) uses, including its result, in bytes.
    pub fn bytes(mesh: &TriangleMesh) -> u64 {
        // Per edge: two copies of its use while the table is collected, and its ends in the list of open edges.
        let of_edge = 2 * size_of::<EdgeUse>() + 2 * size_of::<[u32; 2]>();
        // Per vertex: its position and index in the sorted list, and its representative.
        let of_vertex = size_of::<([u32; 3], u32)>() + size_of::<u32>();
        let edges = 3 * mesh.triangles.len() as u64;
        edges * of_edge as u64 + mesh.positions.len() as u64 * of_vertex as u64
    }

    /// Checks every triangle and every edge. Vertices at the same position count as one.
    pub fn of(mesh: &TriangleMesh) -> Self {
        let welded = Welded::of(mesh);
        let edges = EdgeTable::welded(mesh, &welded);
        let (mut open, mut non_manifold, mut flipped) = (Vec::new(), Vec::new(), Vec::new());
        for uses in edges.iter() {
            match uses {
                [alone] => open.push(alone.ends),
                [a, b] if a.is_forward == b.is_forward => flipped.push(a.ends),
                [_, _] => {}
                _ => non_manifold.push(uses[0].ends),
            }
        }
        let (slivers, max_aspect) = triangles::slivers(mesh);
        let t_junctions = t_junctions::find(mesh, &open);
        let places = [
            FlawLocations::Edges(open),
            FlawLocations::Edges(non_manifold),
            FlawLocations::Edges(flipped),
            t_junctions.map_or(FlawLocations::Unknown, FlawLocations::Vertices),
            FlawLocations::Vertices(touching_vertices(mesh, &welded, &edges)),
            FlawLocations::Triangles(triangles::duplicates(mesh, &welded)),
            FlawLocations::Triangles(slivers),
        ];
        Self {
            bounds: places.each_ref().map(|places| bounds(mesh, places)),
            places,
            max_aspect,
        }
    }

    /// The locations of a kind of flaw.
    pub fn places(&self, flaw: Flaw) -> &FlawLocations {
        &self.places[flaw as usize]
    }

    /// The bounding box of all triangles with a vertex at one of the flaw's locations; `None` if there are none.
    pub fn bounds(&self, flaw: Flaw) -> Option<Aabb> {
        let bounds = self.bounds[flaw as usize];
        (!bounds.is_empty()).then_some(bounds)
    }

    /// Whether the mesh is closed: every edge has exactly two triangles.
    pub fn is_closed(&self) -> bool {
        [Flaw::OpenEdge, Flaw::NonManifoldEdge]
            .into_iter()
            .all(|flaw| self.places(flaw).count() == Some(0))
    }
}

/// The bounding box of all triangles with a vertex at one of the locations.
fn bounds(mesh: &TriangleMesh, places: &FlawLocations) -> Aabb {
    let mut is_there = vec![false; mesh.positions.len()];
    let mut mark = |vertex: u32| is_there[vertex as usize] = true;
    match places {
        FlawLocations::Unknown => return Aabb::EMPTY,
        _ if places.count() == Some(0) => return Aabb::EMPTY,
        FlawLocations::Edges(edges) => edges.as_flattened().iter().copied().for_each(mark),
        FlawLocations::Vertices(vertices) => vertices.iter().copied().for_each(mark),
        FlawLocations::Triangles(triangles) => triangles
            .iter()
            .flat_map(|&triangle| mesh.triangles[triangle as usize])
            .for_each(&mut mark),
    }
    let is_near = |corners: &&[u32; 3]| corners.iter().any(|&vertex| is_there[vertex as usize]);
    let near = mesh.triangles.par_iter().filter(is_near);
    near.map(|corners| Aabb::around(corners.map(|vertex| mesh.positions[vertex as usize])))
        .reduce(|| Aabb::EMPTY, Aabb::union)
}

/// Vertices whose corners form more than one fan.
fn touching_vertices(mesh: &TriangleMesh, welded: &Welded, edges: &EdgeTable) -> Vec<u32> {
    let mut fans = VertexFans::of(mesh, edges, |_, _| true);
    let mut fan_count = vec![0u8; mesh.positions.len()];
    for (triangle, &corners) in (0..).zip(&mesh.triangles) {
        for (k, vertex) in (0..).zip(welded.corners(corners)) {
            let corner = 3 * triangle + k;
            if fans.find(corner) == corner {
                let count = &mut fan_count[vertex as usize];
                *count = count.saturating_add(1);
            }
        }
    }
    let vertices = (0..).zip(fan_count);
    vertices
        .filter_map(|(vertex, count)| (count > 1).then_some(vertex))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn tetrahedron() -> TriangleMesh {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        TriangleMesh::new(positions, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    }

    fn counts(mesh: &TriangleMesh) -> [usize; 7] {
        let health = Health::of(mesh);
        FLAWS.map(|info| health.places(info.flaw).count().expect("checked"))
    }

    #[test]
    fn flaws_are_listed_in_the_order_of_the_enum() {
        for (index, info) in FLAWS.iter().enumerate() {
            assert_eq!(info.flaw as usize, index, "{}", info.name);
        }
    }

    #[test]
    fn a_closed_mesh_is_healthy() {
        assert_eq!(counts(&tetrahedron()), [0; 7]);
    }

    #[test]
    fn edge_flaws_are_counted() {
        let mut mesh = tetrahedron();
        mesh.triangles.truncate(3);
        assert_eq!(counts(&mesh), [3, 0, 0, 0, 0, 0, 0]);
        mesh.triangles.extend([[1, 3, 2], [1, 2, 3]]);
        assert_eq!(counts(&mesh), [0, 3, 0, 0, 0, 1, 0]);
        let mut mesh = tetrahedron();
        mesh.triangles[3] = [1, 3, 2];
        assert_eq!(counts(&mesh), [0, 0, 3, 0, 0, 0, 0]);
    }

    #[test]
    fn a_thin_triangle_is_a_sliver() {
        let mut mesh = tetrahedron();
        mesh.positions[3] = Vec3::new(0.5, 0.5, 1e-4);
        assert_eq!(counts(&mesh)[6], 1);
    }

    #[test]
    fn a_sliver_is_more_than_a_thousand_times_longer_than_high() {
        for (height, expected) in [(1.0 / 999.0, 0), (1.0 / 1001.0, 1)] {
            let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(0.5, height, 0.0)];
            let mesh = TriangleMesh::new(positions, vec![[0, 1, 2]]);
            assert_eq!(counts(&mesh)[6], expected, "{height}");
        }
    }

    #[test]
    fn two_solids_that_share_one_point_have_a_touching_vertex() {
        let mut mesh = tetrahedron();
        let mirrored = [Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z, Vec3::ZERO];
        mesh.positions.extend(mirrored);
        let other = [[7, 4, 5], [7, 6, 4], [7, 5, 6], [4, 6, 5]];
        mesh.triangles.extend(other);
        assert_eq!(counts(&mesh), [0, 0, 0, 0, 1, 0, 0]);
        let health = Health::of(&mesh);
        assert_eq!(
            health.places(Flaw::TouchingVertex),
            &FlawLocations::Vertices(vec![0])
        );
    }

    /// ```text
    ///   3───────2
    ///   │ \     │
    ///   0───4───1    one triangle above the edge 0–1, two below
    ///   │ /   \ │
    ///   5───────6
    /// ```
    #[test]
    fn a_vertex_in_the_interior_of_a_border_edge_is_a_t_junction() {
        let flat = |x: f32, y: f32| Vec3::new(x, y, 0.3 * x + 0.1 * y);
        let positions = [(0, 0), (3, 0), (3, 1), (0, 1), (1, 0), (0, -1), (3, -1)]
            .map(|(x, y)| flat(x as f32 / 3.0, y as f32));
        let triangles = vec![[0, 1, 3], [1, 2, 3], [0, 5, 4], [4, 5, 6], [4, 6, 1]];
        let mesh = TriangleMesh::new(positions.to_vec(), triangles);
        let health = Health::of(&mesh);
        assert_eq!(
            health.places(Flaw::TJunction),
            &FlawLocations::Vertices(vec![4])
        );
    }
}
