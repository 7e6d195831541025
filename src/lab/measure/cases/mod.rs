//! The extremes: rays and single triangles, case by case.
//!
//! Every case is a recipe for a ray's origin and a triangle. The ray is then aimed over the triangle
//! and a little beyond, or at its edges and corners to the last bit. Only sums, products, quotients and
//! roots, so that the numbers are the same on every machine.

mod recipes;

use glam::{DVec3, Vec3};
use hitscope_core::Ray;
use hitscope_core::random::Random;

/// A row of the matrix.
pub struct Case {
    /// As `--case` takes it.
    pub name: String,
    /// For tables.
    pub title: String,
    /// What is extreme about it.
    pub about: &'static str,
    /// Whether it asks for more than f64's digits: a distance 10¹³ times a size, coordinates 10¹² times
    /// others, a ray that starts on its triangle or meets it in its plane, or an aim at edges to the last bit.
    pub is_beyond_f64: bool,
    aim: Aim,
    /// How long directions are made; as long as the way to the triangle if `None`.
    dir_length: Option<f64>,
    recipe: Recipe,
}

/// Makes an origin and a triangle.
type Recipe = Box<dyn Fn(&mut Random) -> (Vec3, [Vec3; 3]) + Send + Sync>;

/// Where the ray goes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Aim {
    /// Over the triangle and a tenth beyond.
    Spread,
    /// To edges and corners, exactly as f32 aims, one ulp beside, and a little inside and outside.
    Edges,
}

impl Case {
    /// A ray and a triangle; tries again where the numbers leave f32 or the direction is zero.
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

/// Weights over the triangle, blown up by 1.2 about its middle.
fn spread_weights(random: &mut Random) -> [f64; 3] {
    let (mut u, mut v) = (random.unit(), random.unit());
    if u + v > 1.0 {
        (u, v) = (1.0 - u, 1.0 - v);
    }
    let blown = |x: f64| (x - 1.0 / 3.0) * 1.2 + 1.0 / 3.0;
    let (u, v) = (blown(u), blown(v));
    [1.0 - u - v, u, v]
}

/// Weights on an edge, at a corner or near an edge, and by how many ulps the aim is to be off.
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
            // From a thousandth down to f64's last place, inside or outside.
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

/// Every case, those aimed at edges after those that aren't.
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
