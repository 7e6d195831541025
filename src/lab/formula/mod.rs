//! The derivation of a ray's hit with its numbers, as lines of text.
//!
//! The ray is r(t) = o + t·d, as in the lecture. Numbers are computed in f64 from the f32 numbers of ray and primitive,
//! and shown with ten digits.
//!
//! | file | derivation |
//! |---|---|
//! | this file | the ray, the parameters, and for every shape its equations along the ray |
//! | `triangle` | plane equation and signed areas |
//! | `sphere`, `plane`, `cuboid` | the lecture's formulas for these shapes |
//! | `solid` | the intervals inside a solid's parts |
//! | `number` | numbers, vectors and polynomials as text |

mod cuboid;
mod number;
mod plane;
mod solid;
mod sphere;
mod triangle;

pub use solid::solid_tree;

use glam::{DVec3, Vec3};
use hitscope_core::group::Group;
use hitscope_core::kernel::LineEquation;
use hitscope_core::ray::f32_above;
use hitscope_core::shape::{AxisBox, Cuboid, Parameter, ParameterKind, Plane, Shape, Sphere};
use hitscope_core::{Hit, Ray, Scene};
use number::{point, polynomial, text};

/// The derivation of a ray's hit. The ray is relative to `origin`, which is the scene's unless only triangles are hit.
///
/// # Panics
/// If the scene has no such primitive.
pub fn lines(scene: &Scene, origin: DVec3, ray: &Ray, hit: &Hit) -> Vec<String> {
    let line = Line::of(ray);
    let mesh = scene.mesh();
    let mut lines = vec!["r(t) = o + t d".to_owned()];
    if origin != DVec3::ZERO {
        let origin = point(origin);
        lines.push(format!(
            "Points are relative to the scene's origin {origin}."
        ));
    }
    lines.push(format!("o = {}", point(line.origin)));
    lines.push(format!("d = {}", point(line.dir)));
    let primitive = hit.primitive;
    if scene.is_triangle(primitive) {
        let is_own = origin == mesh.origin();
        let corner = |p: Vec3| {
            if is_own {
                p.as_dvec3()
            } else {
                mesh.vertex_in_file(p) - origin
            }
        };
        let corners = mesh.corners(primitive).map(corner);
        lines.extend(triangle::lines(&line, corners));
        return lines;
    }
    let (group, index) = scene.group_of(primitive);
    if let Some(solid) = group.solid(index) {
        lines.extend(solid::lines(&line, ray, solid, hit));
        return lines;
    }
    lines.extend(of_primitive(&line, ray, group, index));
    lines.push(match exact_t(scene, ray, hit) {
        Some(t) => line.hit(t),
        None => "In exact arithmetic the ray misses this primitive.".to_owned(),
    });
    lines
}

/// A sentence that derives the t of a given ray from the t of the traced ray. The traced ray starts at t = `start` of
/// the given one, and its t is in units of `scale`.
pub fn t_of_given_ray(start: f64, scale: f64, t: f64) -> String {
    let product = if scale == 1.0 {
        "t".to_owned()
    } else {
        format!("{} t", text(scale))
    };
    format!(
        "The traced ray starts at t = {} of the given one, whose t is {} + {product} = {}.",
        text(start),
        text(start),
        text(t)
    )
}

/// The exact t, rounded once, of the ray's crossing of the primitive that is nearest to the hit; `None` if it misses.
fn exact_t(scene: &Scene, ray: &Ray, hit: &Hit) -> Option<f64> {
    let (mut rest, mut nearest) = (*ray, None);
    let distance = |t: f64| (t - f64::from(hit.t)).abs();
    while let Some([t, ..]) = scene.exact_answer(&rest, hit.primitive) {
        if nearest.is_some_and(|nearest| distance(nearest) <= distance(t)) {
            break;
        }
        nearest = Some(t);
        rest.t_min = f32_above(t);
    }
    nearest
}

/// The parameters of a primitive that is neither a triangle nor a solid, and its equations along the ray.
fn of_primitive(line: &Line, ray: &Ray, group: &dyn Group, index: u32) -> Vec<String> {
    let mut lines = parameters(group, index);
    let equations = group.equations(ray, index);
    let numbers = group.numbers(index);
    let (shape, numbers) = (group.shape(), &numbers[..]);
    lines.extend(if *shape == Sphere::INFO {
        sphere::lines(line, &Sphere::read(&numbers), &equations)
    } else if *shape == Plane::INFO {
        plane::lines(line, &Plane::read(&numbers))
    } else if *shape == Cuboid::INFO {
        cuboid::lines(&cuboid::CUBOID, &equations)
    } else if *shape == AxisBox::INFO {
        cuboid::lines(&cuboid::AXIS_BOX, &equations)
    } else {
        of_equations(shape.equations, &equations)
    });
    lines
}

/// The line of a ray in f64.
struct Line {
    origin: DVec3,
    dir: DVec3,
}

impl Line {
    fn of(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.as_dvec3(),
            dir: ray.dir.as_dvec3(),
        }
    }

    fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.dir
    }

    /// The point of a hit.
    fn hit(&self, t: f64) -> String {
        format!("r({}) = {}", text(t), point(self.at(t)))
    }
}

/// The parameters of a primitive, without flags, which aren't in the equations.
fn parameters(group: &dyn Group, index: u32) -> Vec<String> {
    let numbers = group.numbers(index);
    let line = |(parameter, own): (&Parameter, &[f32])| {
        let value = match own {
            &[x, y, z] => point(Vec3::new(x, y, z).as_dvec3()),
            own => text(own.iter().copied().map(f64::from).sum()),
        };
        format!("{} = {value}", parameter.symbol)
    };
    let named = group.shape().named(&numbers);
    let in_equations =
        |(parameter, _): &(&Parameter, &[f32])| parameter.kind != ParameterKind::Flag;
    named.filter(in_equations).map(line).collect()
}

/// Every equation of a shape, with the ray substituted, and its roots.
fn of_equations(texts: &[&str], equations: &[LineEquation]) -> Vec<String> {
    let mut lines = Vec::new();
    for equation in equations {
        let text = texts.get(usize::from(equation.part));
        lines.extend(text.map(|&text| text.to_owned()));
        lines.push(format!(
            "p = r(t): 0 = {}",
            polynomial(&equation.coefficients)
        ));
        lines.push(roots(equation));
    }
    lines
}

/// The roots of an equation.
fn roots(equation: &LineEquation) -> String {
    if equation.coefficients.iter().all(|&c| c == 0.0) {
        return "true for all t: the ray lies in the surface and misses it".to_owned();
    }
    let root = |root: &hitscope_core::kernel::LineRoot| {
        let note = if root.is_on_shape {
            ""
        } else {
            " (not on the shape)"
        };
        text(root.t) + note
    };
    let roots: Vec<String> = equation.roots.iter().map(root).collect();
    match &roots[..] {
        [] => "no real root".to_owned(),
        [t] => format!("t = {t}"),
        several => (1..)
            .zip(several)
            .map(|(k, t)| format!("t{k} = {t}"))
            .collect::<Vec<_>>()
            .join(", "),
    }
}
