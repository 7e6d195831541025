//! Measures whether the tree's boxes lose triangles that a ray hits, independent of any kernel.

use super::statistics::{bound_per_million, per_million};
use crate::oracle;
use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::mesh::TriangleMesh;
use hitscope_core::mesh::shapes::{Placement, cube, flat_grid, soup};
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use serde::Serialize;

/// A kind of boxes, and rays that touch them.
pub struct BoxCase {
    /// The name, as in `--case`.
    pub name: &'static str,
    /// The title in tables.
    pub title: &'static str,
    /// What makes it difficult.
    pub about: &'static str,
    mesh: fn(&mut Random) -> TriangleMesh,
    ray: fn(&TriangleMesh, &mut Random) -> Option<Ray>,
    /// Rays per mesh.
    rays_per_mesh: u64,
}

/// The result of one case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoxCell {
    /// The case.
    pub case: &'static str,
    /// Exact hits on triangles; each ray must meet the triangle's box.
    pub n: u64,
    /// Hits on triangles in leaves that the ray didn't reach.
    pub lost: u64,
    /// The same per million.
    pub lost_per_million: f64,
    /// The upper bound per million, with 95 % confidence, if the count is zero.
    pub bound_per_million: f64,
}

/// All cases.
pub static BOX_CASES: &[BoxCase] = &[
    BoxCase {
        name: "box-unit",
        title: "size 1",
        about: "Rays at corners and edges of triangles of size 1.",
        mesh: |random| triangles(random, DVec3::ONE, 0.0),
        ray: |mesh, random| aimed(mesh, random, 3.0),
        rays_per_mesh: 16,
    },
    BoxCase {
        name: "box-size-1e-30",
        title: "size 1e-30",
        about: "The same with size 1e-30.",
        mesh: |random| triangles(random, DVec3::splat(1e-30), 0.0),
        ray: |mesh, random| aimed(mesh, random, 3e-30),
        rays_per_mesh: 16,
    },
    BoxCase {
        name: "box-size-1e30",
        title: "size 1e30",
        about: "The same with size 1e30.",
        mesh: |random| triangles(random, DVec3::splat(1e30), 0.0),
        ray: |mesh, random| aimed(mesh, random, 3e30),
        rays_per_mesh: 16,
    },
    BoxCase {
        name: "box-offset-1e5",
        title: "offset 1e5",
        about: "The same at an offset of 1e5 sizes from the world origin.",
        mesh: |random| triangles(random, DVec3::ONE, 1e5),
        ray: |mesh, random| aimed(mesh, random, 3.0),
        rays_per_mesh: 16,
    },
    BoxCase {
        name: "box-far-1e5",
        title: "far 1e5",
        about: "The same with rays from 1e5 sizes away.",
        mesh: |random| triangles(random, DVec3::ONE, 0.0),
        ray: |mesh, random| aimed(mesh, random, 1e5),
        rays_per_mesh: 16,
    },
    BoxCase {
        name: "box-thin-1e-7",
        title: "thin, 1e-7",
        about: "Boxes with a thickness of 1e-7.",
        mesh: |random| triangles(random, DVec3::new(1.0, 1.0, 1e-7), 0.0),
        ray: |mesh, random| aimed(mesh, random, 3.0),
        rays_per_mesh: 16,
    },
    BoxCase {
        name: "box-flat",
        title: "flat",
        about: "Boxes with zero thickness.",
        mesh: |random| triangles(random, DVec3::new(1.0, 1.0, 0.0), 0.0),
        ray: |mesh, random| aimed(mesh, random, 3.0),
        rays_per_mesh: 16,
    },
    BoxCase {
        name: "box-thin-offset-far",
        title: "thin, offset and far",
        about: "A thickness of 1e-7, at an offset of 1e5, with rays from 1e4 away.",
        mesh: |random| triangles(random, DVec3::new(1.0, 1.0, 1e-7), 1e5),
        ray: |mesh, random| aimed(mesh, random, 1e4),
        rays_per_mesh: 16,
    },
    BoxCase {
        name: "box-flat-border",
        title: "border of a flat grid",
        about: "Axis-aligned rays, with zeros of either sign, at the edges and corners of a flat grid.",
        mesh: |random| grid(random),
        ray: |mesh, random| at_border(mesh, random),
        rays_per_mesh: 64,
    },
    BoxCase {
        name: "box-in-plane",
        title: "in the plane of a face",
        about: "Axis-aligned rays in the plane of a cube's face, which hit the neighbouring faces.",
        mesh: |_| cube(2, Placement::UNIT),
        ray: |mesh, random| in_face(mesh, random),
        rays_per_mesh: 4096,
    },
    BoxCase {
        name: "box-lattice",
        title: "integers",
        about: "Rays from lattice points to the vertices of a cube on the lattice.",
        mesh: |_| cube(4, Placement::UNIT),
        ray: |mesh, random| on_lattice(mesh, random),
        rays_per_mesh: 4096,
    },
    BoxCase {
        name: "box-tiny-slope",
        title: "a slope of 1e-42",
        about: "Directions with a component whose reciprocal overflows, at the border of a flat grid.",
        mesh: |random| grid(random),
        ray: |mesh, random| {
            let ray = at_border(mesh, random)?;
            let steepest = ray.dir.abs().max_element();
            let slope = |x: f32| {
                if x.abs() == steepest {
                    x
                } else {
                    1e-42f32.copysign(x)
                }
            };
            let dir = Vec3::from_array(ray.dir.to_array().map(slope));
            Ray::new(ray.origin, dir).ok()
        },
        rays_per_mesh: 64,
    },
];

impl BoxCase {
    /// Traces rays until the oracle has found `n` hits, but at most 4·`n` rays.
    pub fn measure(&self, n: u64, seed: u64) -> BoxCell {
        let mut random = Random::new(seed);
        let (mut met, mut lost, mut rays) = (0, 0, 0);
        while met < n && rays < 4 * n {
            let scene = scene((self.mesh)(&mut random));
            let intersector = scene.intersector(default_triangle_kernel());
            let corners = scene.mesh().corner_list();
            for _ in 0..self.rays_per_mesh.min(n - met) {
                rays += 1;
                let Some(ray) = (self.ray)(scene.mesh(), &mut random) else {
                    continue;
                };
                let candidates = intersector.candidates(&ray);
                let is_hit = |k: &usize| oracle::intersect(&ray, corners[*k]).is_some();
                for k in (0..corners.len()).filter(is_hit) {
                    met += 1;
                    lost += u64::from(!candidates.contains(&(k as u32)));
                }
            }
        }
        BoxCell {
            case: self.name,
            n: met,
            lost,
            lost_per_million: per_million(lost, met),
            bound_per_million: bound_per_million(met),
        }
    }
}

/// A few triangles within a box of this extent, translated.
fn triangles(random: &mut Random, extent: DVec3, offset: f64) -> TriangleMesh {
    let place = DVec3::new(offset, -offset, offset);
    let mut corner = || (place + extent * random.in_cube()).as_vec3();
    // Enough for several leaves, so that the tree has boxes below the root.
    let corners: Vec<[Vec3; 3]> = (0..24).map(|_| [corner(), corner(), corner()]).collect();
    soup(&corners)
}

/// A ray from `distance` sizes away to a corner of a triangle or a point on one of its edges.
fn aimed(mesh: &TriangleMesh, random: &mut Random, distance: f64) -> Option<Ray> {
    if mesh.triangles().is_empty() {
        return None;
    }
    let [a, b, _] = mesh.corners(random.index(mesh.triangles().len()) as u32);
    let target = a.lerp(b, [0.0, 1.0, 0.5, random.unit() as f32][random.index(4)]);
    let origin = target + (distance * random.in_cube()).as_vec3();
    Ray::new(origin, target - origin).ok()
}

/// A grid perpendicular to an axis, at a random position.
fn grid(random: &mut Random) -> TriangleMesh {
    let place = Placement::new(1.0, [0.0, 0.5, 4096.0][random.index(3)]);
    let turn = random.index(3);
    flat_grid(2, place).map_positions(|p| Vec3::new(p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]))
}

/// A perpendicular ray at an edge or a corner of a grid, with zeros of either sign in the other components.
fn at_border(mesh: &TriangleMesh, random: &mut Random) -> Option<Ray> {
    let count = mesh.positions().len();
    let [a, b] = [(); 2].map(|()| mesh.positions()[random.index(count)]);
    let target = if random.index(2) == 0 {
        a
    } else {
        0.5 * (a + b)
    };
    let first = mesh.positions()[0];
    let is_flat = |&axis: &usize| mesh.positions().iter().all(|p| p[axis] == first[axis]);
    let axis = (0..3).find(is_flat)?;
    let mut sign = || if random.index(2) == 0 { 1.0 } else { -1.0 };
    let mut dir = Vec3::new(sign() * 0.0, sign() * 0.0, sign() * 0.0);
    dir[axis] = 64.0 * sign();
    Ray::new(target - dir, dir).ok()
}

/// A ray along an axis in the plane of a face of the cube [0, 2]³.
fn in_face(_: &TriangleMesh, random: &mut Random) -> Option<Ray> {
    let axis = random.index(3);
    let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut origin = Vec3::ZERO;
    origin[x] = [0.0, 2.0][random.index(2)];
    origin[y] = 0.25 * random.index(9) as f32;
    let is_up = random.index(2) == 0;
    origin[axis] = if is_up { -1.0 } else { 3.0 };
    let mut dir = Vec3::from_array([(); 3].map(|()| if random.index(2) == 0 { 0.0 } else { -0.0 }));
    dir[axis] = if is_up { 1.0 } else { -1.0 };
    Ray::new(origin, dir).ok()
}

/// A ray from a half-integer point to a vertex on the cube's surface.
fn on_lattice(mesh: &TriangleMesh, random: &mut Random) -> Option<Ray> {
    let mut half = || 0.5 * (random.index(25) as f32 - 8.0);
    let origin = Vec3::new(half(), half(), half());
    let target = mesh.positions()[random.index(mesh.positions().len())];
    Ray::new(origin, target - origin).ok()
}
