//! Measures whether kernels find the nearest triangle and order all crossings correctly: small sets of
//! triangles, traced through the tree and compared with the oracle.

use super::statistics::{bound_per_million, per_million};
use crate::oracle::{self, Crossing};
use glam::Vec3;
use hitscope_core::kernel::TriangleKernel;
use hitscope_core::mesh::shapes::soup;
use hitscope_core::random::Random;
use hitscope_core::scene::scene;
use hitscope_core::{Intersector, Ray};
use serde::Serialize;

/// A kind of triangle set, and its rays.
pub struct OrderCase {
    /// The name, as in `--case`.
    pub name: &'static str,
    /// The title in tables.
    pub title: &'static str,
    /// What makes it difficult.
    pub about: &'static str,
    recipe: fn(&mut Random) -> Heap,
}

/// Triangles, and a ray's origin and target.
type Heap = (Vec<[Vec3; 3]>, Vec3, Vec3);

/// The result of one kernel in one case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OrderCell {
    /// The case.
    pub case: &'static str,
    /// The kernel.
    pub kernel: &'static str,
    /// Number of rays.
    pub n: u64,
    /// Rays with two or more triangles at the same t.
    pub ties: u64,
    /// Rays whose nearest triangle differs from the oracle's, or that found none.
    pub wrong_nearest: u64,
    /// The same per million.
    pub wrong_nearest_per_million: f64,
    /// Rays whose crossings differ from the oracle's in any hit, order or tie.
    pub wrong_crossings: u64,
    /// The same per million.
    pub wrong_crossings_per_million: f64,
    /// The upper bound per million, with 95 % confidence, if a count is zero.
    pub bound_per_million: f64,
}

/// All cases.
pub static ORDER_CASES: &[OrderCase] = &[
    OrderCase {
        name: "order-independent",
        title: "independent",
        about: "Random triangles.",
        recipe: |random| {
            let triangles = (0..6).map(|_| [(); 3].map(|()| random.in_cube_f32()));
            let triangles = triangles.collect();
            (
                triangles,
                3.0 * random.in_cube_f32(),
                0.5 * random.in_cube_f32(),
            )
        },
    },
    OrderCase {
        name: "order-fan",
        title: "a shared vertex",
        about: "Six triangles around a vertex that the ray is aimed at.",
        recipe: |random| {
            let tip = random.in_cube_f32();
            let ring = [(); 6].map(|()| random.in_cube_f32());
            let triangles = (0..6).map(|k| [tip, ring[k], ring[(k + 1) % 6]]).collect();
            (triangles, 3.0 * random.in_cube_f32(), tip)
        },
    },
    OrderCase {
        name: "order-edge",
        title: "a shared edge",
        about: "Four triangles at an edge that the ray is aimed at.",
        recipe: |random| {
            let [a, b] = [(); 2].map(|()| random.in_cube_f32());
            let triangles = (0..4).map(|_| [a, b, random.in_cube_f32()]).collect();
            let target = a.lerp(b, random.unit() as f32);
            (triangles, 3.0 * random.in_cube_f32(), target)
        },
    },
    OrderCase {
        name: "order-duplicates",
        title: "duplicates",
        about: "The same triangle several times, with rotated corners.",
        recipe: |random| {
            let [a, b, c] = [(); 3].map(|()| random.in_cube_f32());
            let triangles = vec![[a, b, c], [b, c, a], [a, b, c], [a, c, b], [c, a, b]];
            let middle = (a + b + c) / 3.0;
            (
                triangles,
                3.0 * random.in_cube_f32(),
                middle + 0.3 * random.in_cube_f32(),
            )
        },
    },
    OrderCase {
        name: "order-coplanar",
        title: "overlapping in a plane",
        about: "Different triangles in one plane with integer coordinates: t is equal, though rounding hides it.",
        recipe: |random| {
            let mut whole = || (random.index(129) as i64 - 64) as f32;
            let triangles = (0..6)
                .map(|_| {
                    [(); 3].map(|()| {
                        let (x, y) = (whole(), whole());
                        Vec3::new(x, y, 2.0 * x - 3.0 * y + 5.0)
                    })
                })
                .collect();
            let origin = Vec3::new(whole(), whole(), 512.0 + whole());
            (
                triangles,
                origin,
                Vec3::new(0.25 * whole(), 0.25 * whole(), 5.0),
            )
        },
    },
    OrderCase {
        name: "order-ulp",
        title: "one ulp apart",
        about: "Copies of a triangle, each with one coordinate an ulp further.",
        recipe: |random| {
            let mut corners = [(); 3].map(|()| random.in_cube_f32());
            let middle = corners.iter().sum::<Vec3>() / 3.0;
            let mut triangles = vec![corners];
            for _ in 0..4 {
                let (corner, axis) = (random.index(3), random.index(3));
                corners[corner][axis] = corners[corner][axis].next_up();
                triangles.push(corners);
            }
            (
                triangles,
                3.0 * random.in_cube_f32(),
                middle + 0.2 * random.in_cube_f32(),
            )
        },
    },
    OrderCase {
        name: "order-grid",
        title: "integers",
        about: "Triangles with small integer coordinates; rays from an integer point to a vertex.",
        recipe: |random| {
            let mut whole = || (random.index(9) as i64 - 4) as f32;
            let mut point = || Vec3::new(whole(), whole(), whole());
            let triangles: Vec<[Vec3; 3]> = (0..6).map(|_| [point(), point(), point()]).collect();
            (triangles.clone(), point(), triangles[0][0])
        },
    },
    OrderCase {
        name: "order-stack",
        title: "a far stack",
        about: "Layers at distances of 1e-7, seen from a million sizes away.",
        recipe: |random| {
            let corners = [(); 3].map(|()| random.in_cube_f32());
            let lifted = |k: usize| corners.map(|p| p + Vec3::Z * (1e-7 * k as f32));
            let middle = corners.iter().sum::<Vec3>() / 3.0;
            let origin = 1e6 * random.in_cube_f32();
            (
                (0..5).map(lifted).collect(),
                origin,
                middle + 0.2 * random.in_cube_f32(),
            )
        },
    },
    OrderCase {
        name: "order-mixed",
        title: "mixed exponents",
        about: "Coordinates of independent magnitudes from 2^-40 to 2^40.",
        recipe: |random| {
            let mut number = || (random.signed() * 2f64.powi(random.index(81) as i32 - 40)) as f32;
            let mut point = || Vec3::new(number(), number(), number());
            let triangles: Vec<[Vec3; 3]> = (0..6).map(|_| [point(), point(), point()]).collect();
            let target = (triangles[0][0] + triangles[0][1] + triangles[0][2]) / 3.0;
            (triangles, point(), target)
        },
    },
];

impl OrderCase {
    /// Measures all kernels with the same `n` rays.
    pub fn measure(
        &self,
        kernels: &[&'static TriangleKernel],
        n: u64,
        seed: u64,
    ) -> Vec<OrderCell> {
        let mut random = Random::new(seed);
        let mut ties = 0;
        let mut wrong = vec![(0, 0); kernels.len()];
        for _ in 0..n {
            let (triangles, ray) = self.sample(&mut random);
            let scene = scene(soup(&triangles));
            let mesh = scene.mesh();
            let every: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
            let exact = oracle::crossings(mesh, &ray, &every);
            ties += u64::from(exact.iter().any(|(_, primitives)| primitives.len() > 1));
            for (kernel, (nearest, all)) in kernels.iter().zip(&mut wrong) {
                let intersector = scene.intersector(*kernel);
                let expected = exact.first().map(|(_, primitives)| primitives[0]);
                let found = intersector.closest_hit(&ray).map(|hit| hit.primitive);
                *nearest += u64::from(found != expected);
                *all += u64::from(!is_same(&*intersector, &ray, &exact));
            }
        }
        let cells = kernels.iter().zip(wrong);
        cells
            .map(|(kernel, (nearest, all))| OrderCell {
                case: self.name,
                kernel: kernel.info.name,
                n,
                ties,
                wrong_nearest: nearest,
                wrong_nearest_per_million: per_million(nearest, n),
                wrong_crossings: all,
                wrong_crossings_per_million: per_million(all, n),
                bound_per_million: bound_per_million(n),
            })
            .collect()
    }

    fn sample(&self, random: &mut Random) -> (Vec<[Vec3; 3]>, Ray) {
        loop {
            let (triangles, origin, target) = (self.recipe)(random);
            if let Ok(ray) = Ray::new(origin, target - origin) {
                return (triangles, ray);
            }
        }
    }
}

fn is_same(intersector: &dyn Intersector, ray: &Ray, exact: &[Crossing]) -> bool {
    let found = intersector.all_hits(ray);
    found.len() == exact.len()
        && found.iter().zip(exact).all(|(found, (_, primitives))| {
            found.hit.primitive == primitives[0] && found.also == primitives[1..]
        })
}
