//! Procedural meshes for tests and measurements. They are bit-identical on every machine, because only sums, products,
//! quotients and square roots are used.

use super::TriangleMesh;
use glam::{DVec2, DVec3, Vec3};

/// Scale and offset of a shape.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Scale factor, applied first.
    pub scale: f64,
    /// Offset, added after scaling.
    pub offset: DVec3,
}

impl Placement {
    /// The identity.
    pub const UNIT: Self = Self {
        scale: 1.0,
        offset: DVec3::ZERO,
    };

    /// Scales by `scale`, then moves by (1, −0.75, 0.5) · `offset_in_scales` · `scale`.
    pub fn new(scale: f64, offset_in_scales: f64) -> Self {
        Self {
            scale,
            offset: DVec3::new(1.0, -0.75, 0.5) * (offset_in_scales * scale),
        }
    }

    /// Applies the placement to a point of the shape and rounds it to f32.
    pub fn of(&self, point: DVec3) -> Vec3 {
        (self.scale * point + self.offset).as_vec3()
    }
}

/// Radius of the torus's centre line.
pub const TORUS_RADIUS: f64 = 0.75;
/// Radius of the torus's tube.
pub const TUBE_RADIUS: f64 = 0.3;

/// A point on the unit circle; `turn` from 0 to 1 goes once around, not at uniform speed.
///
/// Source: the rational parametrisation ((1 − s²)/(1 + s²), 2s/(1 + s²)), one quarter at a time.
pub fn circle(turn: f64) -> DVec2 {
    let quarters = 4.0 * turn;
    let s = quarters - quarters.floor();
    let (x, y) = ((1.0 - s * s) / (1.0 + s * s), 2.0 * s / (1.0 + s * s));
    match quarters.floor() as i64 & 3 {
        0 => DVec2::new(x, y),
        1 => DVec2::new(-y, x),
        2 => DVec2::new(-x, -y),
        _ => DVec2::new(y, -x),
    }
}

/// A point of the torus about the z axis, `depth` tube radii away from its centre line. `around` is the turn around the
/// axis and `across` the turn around the tube, as for [`circle`].
pub fn in_torus(around: f64, across: f64, depth: f64) -> DVec3 {
    let (ring, tube) = (circle(around), circle(across) * (TUBE_RADIUS * depth));
    (ring * (TORUS_RADIUS + tube.x)).extend(tube.y)
}

/// A closed torus about the z axis: `around` × `across` quads of two triangles, with outward normals.
pub fn torus(around: u32, across: u32, place: Placement) -> TriangleMesh {
    let turn = |k: u32, n: u32| f64::from(k) / f64::from(n);
    let points = (0..around).flat_map(|i| {
        (0..across).map(move |j| place.of(in_torus(turn(i, around), turn(j, across), 1.0)))
    });
    let vertex = |i: u32, j: u32| i % around * across + j % across;
    let quads = (0..around).flat_map(|i| (0..across).map(move |j| (i, j)));
    let triangles = quads.flat_map(|(i, j)| {
        let [a, b] = [vertex(i, j), vertex(i + 1, j)];
        let [c, d] = [vertex(i + 1, j + 1), vertex(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    TriangleMesh::new(points.collect(), triangles.collect())
}

/// A closed unit sphere: a cube of `cells` × `cells` quads per side, projected onto the sphere.
pub fn sphere(cells: u32, place: Placement) -> TriangleMesh {
    surface_of_cube(cells, |corner| {
        let p = 2.0 * corner.as_dvec3() / f64::from(cells) - 1.0;
        place.of(p / (p.x * p.x + p.y * p.y + p.z * p.z).sqrt())
    })
}

/// A closed cube from 0 to `cells` along each axis; each side is a grid of unit squares.
pub fn cube(cells: u32, place: Placement) -> TriangleMesh {
    surface_of_cube(cells, |corner| place.of(corner.as_dvec3()))
}

/// An open grid of unit squares in the plane z = 0, from (0, 0) to (`cells`, `cells`).
pub fn flat_grid(cells: u32, place: Placement) -> TriangleMesh {
    let row = cells + 1;
    let points = (0..row)
        .flat_map(|y| (0..row).map(move |x| place.of(DVec3::new(f64::from(x), f64::from(y), 0.0))));
    let squares = (0..cells).flat_map(|y| (0..cells).map(move |x| y * row + x));
    let triangles = squares.flat_map(|a| [[a, a + 1, a + row + 1], [a, a + row + 1, a + row]]);
    TriangleMesh::new(points.collect(), triangles.collect())
}

/// The six sides of a cube of `cells` × `cells` × `cells`, with outward normals. Each side has its own vertices; those
/// on shared edges have the same positions. `place` maps a grid point to a position.
fn surface_of_cube(cells: u32, place: impl Fn(glam::UVec3) -> Vec3) -> TriangleMesh {
    let row = cells + 1;
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for (axis, level) in (0..3).flat_map(|axis| [(axis, 0), (axis, cells)]) {
        let first = points.len() as u32;
        for (y, x) in (0..row).flat_map(|y| (0..row).map(move |x| (y, x))) {
            let mut corner = glam::UVec3::splat(level);
            corner[(axis + 1) % 3] = x;
            corner[(axis + 2) % 3] = y;
            points.push(place(corner));
        }
        for (y, x) in (0..cells).flat_map(|y| (0..cells).map(move |x| (y, x))) {
            let a = first + y * row + x;
            let (b, c, d) = (a + 1, a + row + 1, a + row);
            triangles.extend(if level == 0 {
                [[a, c, b], [a, d, c]]
            } else {
                [[a, b, c], [a, c, d]]
            });
        }
    }
    TriangleMesh::new(points, triangles)
}

/// A mesh of separate triangles that share no vertices. As in [`TriangleMesh::new`], triangles of zero area are
/// dropped.
pub fn soup(corners: &[[Vec3; 3]]) -> TriangleMesh {
    let triangle = |k: u32| [3 * k, 3 * k + 1, 3 * k + 2];
    let triangles = (0..corners.len() as u32).map(triangle).collect();
    TriangleMesh::new(corners.as_flattened().to_vec(), triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Flaw, Health};

    #[test]
    fn closed_shapes_are_closed_and_face_outwards() {
        for mesh in [
            torus(16, 8, Placement::UNIT),
            sphere(6, Placement::UNIT),
            cube(3, Placement::UNIT),
        ] {
            let health = Health::of(&mesh);
            assert!(health.is_closed());
            assert_eq!(health.places(Flaw::FlippedEdge).count(), Some(0));
            // Six times the volume; positive if the normals point outwards.
            let six_volumes: f64 = (0..mesh.triangles.len() as u32)
                .map(|k| mesh.corners(k).map(Vec3::as_dvec3))
                .map(|[a, b, c]| a.dot(b.cross(c)))
                .sum();
            assert!(six_volumes > 1.0, "{six_volumes}");
        }
    }
}
