//! Extreme cases of a ray and a single triangle.
//!
//! A case is a recipe for a ray's origin and a triangle. The ray is then aimed at the triangle and slightly
//! past it, or exactly at its edges and corners. Recipes use only sums, products, quotients and roots, so
//! that the numbers are the same on every machine.

mod recipes;

use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::random::Random;

/// One case.
pub struct Case {
    /// The name, as in `--case`.
    pub name: String,
    /// The title in tables.
    pub title: String,
    /// What makes it extreme.
    pub about: &'static str,
    aim: Aim,
    /// Length of directions; the distance to the triangle if `None`.
    dir_length: Option<f64>,
    recipe: Recipe,
}

/// Makes an origin and a triangle.
type Recipe = Box<dyn Fn(&mut Random) -> (Vec3, [Vec3; 3]) + Send + Sync>;

/// What a ray is aimed at.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Aim {
    /// The triangle, and a tenth of its size beyond it.
    Spread,
    /// Edges and corners: as exactly as f32 allows, one ulp off, and slightly inside or outside.
    Edges,
}

impl Case {
    /// Makes a ray and a triangle; retries if a number overflows f32 or the direction is zero.
    pub fn sample(&self, random: &mut Random) -> (Ray, [Vec3; 3]) {
        loop {
            let (origin, corners) = (self.recipe)(random);
            let dir = self.direction(origin, corners, random);
            if corners.iter().all(|p| p.is_finite())
                && let Ok(ray) = Ray::new(origin, dir)
            {
                return (ray, corners);
            }
        }
    }

    fn direction(&self, origin: Vec3, corners: [Vec3; 3], random: &mut Random) -> Vec3 {
        let (weights, ulps) = match self.aim {
            Aim::Spread => (spread_weights(random), 0),
            Aim::Edges => edge_weights(random),
        };
        let origin = origin.as_dvec3();
        let relative = corners.map(|p| p.as_dvec3() - origin);
        let to: DVec3 = (0..3).map(|k| weights[k] * relative[k]).sum();
        let mut dir = match self.dir_length {
            Some(length) => (to / to.length() * length).as_vec3(),
            None => to.as_vec3(),
        };
        if ulps != 0 {
            let axis = random.index(3);
            dir[axis] = if ulps > 0 {
                dir[axis].next_up()
            } else {
                dir[axis].next_down()
            };
        }
        dir
    }
}

/// Barycentric coordinates in the triangle scaled by 1.2 about its centroid.
fn spread_weights(random: &mut Random) -> [f64; 3] {
    let (mut u, mut v) = (random.unit(), random.unit());
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    let blown = |x: f64| (x - 1.0 / 3.0) * 1.2 + 1.0 / 3.0;
    let (u, v) = (blown(u), blown(v));
    [1.0 - u - v, u, v]
}

/// Barycentric coordinates on an edge, at a corner or near an edge, and the offset of the aim in ulps.
fn edge_weights(random: &mut Random) -> ([f64; 3], i32) {
    let start = random.index(3);
    let [a, b, c] = [start, (start + 1) % 3, (start + 2) % 3];
    let part = random.unit();
    let mut weights = [0.0; 3];
    let kind = random.index(5);
    match kind {
        0 | 1 => (weights[a], weights[b]) = (part, 1.0 - part),
        2 | 3 => weights[a] = 1.0,
        _ => {
            // From 10⁻³ to the last digit of f64, inside or outside.
            let size = 2f64.powi(-10 - random.index(43) as i32);
            let beside = if random.index(2) == 0 { size } else { -size };
            weights[a] = part * (1.0 - beside);
            weights[b] = (1.0 - part) * (1.0 - beside);
            weights[c] = beside;
        }
    }
    let ulps = match kind {
        1 | 3 if random.index(2) == 0 => 1,
        1 | 3 => -1,
        _ => 0,
    };
    (weights, ulps)
}

/// All cases; those aimed at edges come last.
pub fn triangle_cases() -> Vec<Case> {
    [Aim::Spread, Aim::Edges]
        .into_iter()
        .flat_map(|aim| {
            recipes::all()
                .into_iter()
                .map(move |recipe| recipe.case(aim))
        })
        .collect()
}
