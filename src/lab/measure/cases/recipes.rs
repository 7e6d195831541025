//! Recipes for extreme rays and triangles.

use super::{Aim, Case, Recipe};
use glam::{DVec3, Vec3};
use hitscope_core::random::Random;

/// A recipe and its name.
pub(super) struct NamedRecipe {
    name: String,
    about: &'static str,
    dir_length: Option<f64>,
    recipe: Recipe,
}

impl NamedRecipe {
    /// The case of this recipe with this aim.
    pub fn case(self, aim: Aim) -> Case {
        let (name, title) = match aim {
            Aim::Spread => (self.name.clone(), self.name),
            Aim::Edges => (
                format!("{} edges", self.name),
                format!("{}, at edges", self.name),
            ),
        };
        Case {
            name: name.replace(' ', "-"),
            title,
            about: self.about,
            aim,
            dir_length: self.dir_length,
            recipe: self.recipe,
        }
    }
}

fn named(
    name: impl Into<String>,
    about: &'static str,
    recipe: impl Fn(&mut Random) -> (Vec3, [Vec3; 3]) + Send + Sync + 'static,
) -> NamedRecipe {
    NamedRecipe {
        name: name.into(),
        about,
        dir_length: None,
        recipe: Box::new(recipe),
    }
}

/// A triangle about the origin and a ray from three sizes away, both scaled by `scale`.
fn ordinary(random: &mut Random, scale: f64) -> (Vec3, [Vec3; 3]) {
    let mut point = |size: f64| (size * scale * random.in_cube()).as_vec3();
    (point(3.0), [point(1.0), point(1.0), point(1.0)])
}

/// All recipes.
pub(super) fn all() -> Vec<NamedRecipe> {
    let mut all = Vec::new();
    for offset in [0.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7] {
        let place = DVec3::new(offset, -offset, offset);
        all.push(named(
            format!("offset {offset:e}"),
            "A triangle of size 1 at this offset from the world origin; the ray starts three sizes away. At 1e7 the ulp is 1, so most triangles degenerate.",
            move |random| {
                let mut point = |size: f64| (place + size * random.in_cube()).as_vec3();
                (point(3.0), [point(1.0), point(1.0), point(1.0)])
            },
        ));
    }
    for scale in [
        1e-42, 1e-30, 1e-18, 1e-12, 1e-6, 1e6, 1e12, 1e18, 1e30, 1e38,
    ] {
        all.push(named(
            format!("scale {scale:e}"),
            "Triangle and ray scaled by this factor.",
            move |random| ordinary(random, scale),
        ));
    }
    for length in [1e-42, 1e-20, 1e-10, 1e10, 1e20] {
        let about = "A direction of this length, with an origin so close that t is a float.";
        all.push(NamedRecipe {
            dir_length: Some(length),
            ..named(format!("direction {length:e}"), about, |random| {
                ordinary(random, 1e-6)
            })
        });
    }
    for aspect in [1e3, 1e5, 1e6, 1e8, 1e10, 1e12] {
        all.push(named(
            format!("sliver {aspect:e}"),
            "A triangle of this aspect ratio in a random orientation.",
            move |random| sliver(random, aspect),
        ));
    }
    for digit in 1..=8 {
        let angle = 1.0 / 10f64.powi(digit);
        all.push(named(
            format!("grazing 1e-{digit}"),
            "A ray at this angle, in radians, to the plane of the triangle.",
            move |random| grazing(random, angle),
        ));
    }
    for distance in [1e3, 1e4, 1e5, 1e6, 1e7, 1e9, 1e12] {
        all.push(named(
            format!("far {distance:e}"),
            "A ray that starts at this distance, in sizes of the triangle.",
            move |random| {
                let (_, corners) = ordinary(random, 1.0);
                ((distance * random.direction()).as_vec3(), corners)
            },
        ));
    }
    all.extend(special_recipes());
    all
}

fn special_recipes() -> Vec<NamedRecipe> {
    let mut all = vec![
        named(
            "in plane",
            "A ray in the plane of an axis-aligned triangle: a miss.",
            in_plane,
        ),
        named(
            "zero area",
            "Triangles with equal or collinear corners, which loading removes.",
            zero_area,
        ),
        named(
            "needle",
            "Three corners on an axis-parallel line that the ray is aimed at: a false hit in the tests of pbrt (BadCases).",
            needle,
        ),
        named("tiny 2e-4", "Edges of 2e-4 at a distance of 3.", |random| {
            tiny(random, 2e-4)
        }),
        named(
            "tiny 1e-13",
            "Edges of 1e-13 about the origin, at a distance of 3.",
            |random| {
                let (origin, corners) = ordinary(random, 1.0);
                (origin, corners.map(|p| (p.as_dvec3() * 1e-13).as_vec3()))
            },
        ),
        named(
            "tiny 1e-40",
            "Edges of subnormal length, at a distance of 1.",
            |random| {
                let (origin, corners) = ordinary(random, 1.0);
                (origin, corners.map(|p| (p.as_dvec3() * 1e-40).as_vec3()))
            },
        ),
        named(
            "origin on triangle",
            "A ray that starts at a corner, on an edge, inside the triangle, or an ulp beside.",
            origin_on_triangle,
        ),
    ];
    all.extend(number_recipes());
    all
}

/// Recipes with special numbers.
fn number_recipes() -> Vec<NamedRecipe> {
    let mut all = Vec::new();
    for side in [4, 64, 4096] {
        all.push(named(
            format!("integer grid {side}"),
            "Integer coordinates up to this: hits on edges and corners are exact.",
            move |random| {
                let mut whole = || (random.index(2 * side + 1) as i64 - side as i64) as f32;
                let mut point = || Vec3::new(whole(), whole(), whole());
                (point(), [point(), point(), point()])
            },
        ));
    }
    for range in [20, 60, 126] {
        all.push(named(
            format!("mixed exponents {range}"),
            "Coordinates of independent magnitudes, from 2 to the power of minus this to 2 to the power of this.",
            move |random| {
                let mut number = || {
                    let exponent = random.index(2 * range + 1) as i32 - range as i32;
                    (random.signed() * 2f64.powi(exponent)) as f32
                };
                let mut point = || Vec3::new(number(), number(), number());
                (point(), [point(), point(), point()])
            },
        ));
    }
    all
}

fn sliver(random: &mut Random, aspect: f64) -> (Vec3, [Vec3; 3]) {
    let along = random.direction();
    let across = along.cross(random.direction()).normalize();
    let a = (0.3 * random.in_cube()).as_vec3();
    let part = random.unit();
    let b = (a.as_dvec3() + along).as_vec3();
    let c = (a.as_dvec3() + part * along + across / aspect).as_vec3();
    ((3.0 * random.in_cube()).as_vec3(), [a, b, c])
}

fn grazing(random: &mut Random, angle: f64) -> (Vec3, [Vec3; 3]) {
    let x = random.direction();
    let normal = x.cross(random.direction()).normalize();
    let y = normal.cross(x);
    let corners = [(); 3].map(|()| (random.signed() * x + random.signed() * y).as_vec3());
    let towards = loop {
        let (s, t) = (random.signed(), random.signed());
        let size = (s * s + t * t).sqrt();
        if size > 0.1 {
            break (s * x + t * y) / size;
        }
    };
    ((3.0 * (towards + angle * normal)).as_vec3(), corners)
}

fn in_plane(random: &mut Random) -> (Vec3, [Vec3; 3]) {
    let (level, axis) = (random.signed() as f32, random.index(3));
    let mut point = |size: f64| {
        let mut p = (size * random.in_cube()).as_vec3();
        p[axis] = level;
        p
    };
    (point(3.0), [point(1.0), point(1.0), point(1.0)])
}

fn zero_area(random: &mut Random) -> (Vec3, [Vec3; 3]) {
    let (origin, [a, b, _]) = ordinary(random, 1.0);
    let kind = random.index(3);
    let mut whole = || (random.index(65) as i64 - 32) as f32;
    let corners = match kind {
        0 => [a, a, b],
        1 => [a; 3],
        _ => {
            let (from, step) = (
                Vec3::new(whole(), whole(), whole()),
                Vec3::new(whole(), whole(), whole()),
            );
            [from, from + step, from + 3.0 * step]
        }
    };
    (origin, corners)
}

fn needle(random: &mut Random) -> (Vec3, [Vec3; 3]) {
    let (origin, [a, b, c]) = ordinary(random, 1.0);
    let axis = random.index(3);
    let on_line = |p: Vec3| {
        let mut q = a;
        q[axis] = p[axis];
        q
    };
    (origin, [a, on_line(b), on_line(c)])
}

fn tiny(random: &mut Random, size: f64) -> (Vec3, [Vec3; 3]) {
    let place = random.in_cube();
    let corners = [(); 3].map(|()| (place + size * random.in_cube()).as_vec3());
    ((3.0 * random.in_cube()).as_vec3(), corners)
}

fn origin_on_triangle(random: &mut Random) -> (Vec3, [Vec3; 3]) {
    let (_, corners) = ordinary(random, 1.0);
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let on = match random.index(3) {
        0 => a,
        1 => 0.5 * (a + b),
        _ => (a + b + c) / 3.0,
    };
    let mut origin = on.as_vec3();
    if random.index(2) == 0 {
        let axis = random.index(3);
        origin[axis] = origin[axis].next_up();
    }
    (origin, corners)
}
