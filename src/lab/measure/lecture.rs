//! The lecture's programs as they are printed, slips included: what porting them literally gives.
//!
//! Source: H. Lensch, "Basic Geometry", lecture in computer graphics, Tübingen 2022. None of this is
//! used for pictures; the kernels of the same names are the corrected ones.

use glam::Vec3;
use hitscope_core::{Aabb, Hit, Ray};

/// A program of the lecture.
pub struct AsPrinted {
    /// As tables call it.
    pub name: &'static str,
    /// For tables.
    pub title: &'static str,
    /// What is wrong with it.
    pub summary: &'static str,
    /// Where it says that the ray hits.
    pub intersect: fn(&Ray, [Vec3; 3]) -> Option<Hit>,
}

/// The three methods.
pub static AS_PRINTED: &[AsPrinted] = &[
    AsPrinted {
        name: "plane-projection as printed",
        title: "Plane and projection, as printed",
        summary: "Weights of B and C exchanged; t < 1e-6 is no hit; D = A·n cancels away from the origin.",
        intersect: plane_projection,
    },
    AsPrinted {
        name: "parametric as printed",
        title: "Parametric, as printed",
        summary: "P = α(B − A) + β(C − A) lacks A: right only where A is the origin.",
        intersect: parametric,
    },
    AsPrinted {
        name: "edge-planes as printed",
        title: "Edge planes, as printed",
        summary: "One side only; normals are made unit length, a NaN where the origin lies on an edge's line.",
        intersect: edge_planes,
    },
];

/// The lecture's tolerance on t.
const EPSILON: f32 = 0.000_001;

/// Method (1), the pseudo-code; its missing parenthesis is where it must be.
pub fn plane_projection(ray: &Ray, [a, b, c]: [Vec3; 3]) -> Option<Hit> {
    let n = program_normal([a, b, c]);
    let (b, c) = (b - a, c - a);
    let distance = a.dot(n);
    let t = (distance - ray.origin.dot(n)) / ray.dir.dot(n);
    if t < EPSILON || t > ray.t_max {
        return None;
    }
    let size = n.abs();
    let k = if size.x > size.y {
        if size.x > size.z { 0 } else { 2 }
    } else if size.y > size.z {
        1
    } else {
        2
    };
    let (u, v) = ((k + 1) % 3, (k + 2) % 3);
    let p = ray.origin + t * ray.dir - a;
    let det = b[u] * c[v] - b[v] * c[u];
    let beta = (b[u] * p[v] - b[v] * p[u]) / det;
    if beta < 0.0 {
        return None;
    }
    let gamma = (c[v] * p[u] - c[u] * p[v]) / det;
    if gamma < 0.0 || beta + gamma > 1.0 {
        return None;
    }
    // Taken for the weights of B and C, in that order, as a reader of HIT(t, beta, gamma) would.
    Some(Hit {
        t,
        u: beta,
        v: gamma,
        primitive: 0,
    })
}

/// The normal of the pseudo-code: c × b, where the slide on normals has (v1 − v0) × (v2 − v0).
pub fn program_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    (c - a).cross(b - a).normalize()
}

/// Whether a hit passes the slide on precision: there |t| < ε is none.
pub fn passes_slide(t: f32) -> bool {
    t.abs() >= EPSILON
}

/// Method (2): P = α(B − A) + β(C − A), solved by least squares.
pub fn parametric(ray: &Ray, [a, b, c]: [Vec3; 3]) -> Option<Hit> {
    let (e1, e2) = (b - a, c - a);
    let n = e1.cross(e2);
    let t = (a - ray.origin).dot(n) / ray.dir.dot(n);
    if t < EPSILON {
        return None;
    }
    let p = ray.origin + t * ray.dir;
    let [d11, d12, d22] = [e1.dot(e1), e1.dot(e2), e2.dot(e2)];
    let det = d11 * d22 - d12 * d12;
    let alpha = (d22 * p.dot(e1) - d12 * p.dot(e2)) / det;
    let beta = (d11 * p.dot(e2) - d12 * p.dot(e1)) / det;
    (alpha >= 0.0 && beta >= 0.0 && alpha + beta <= 1.0).then_some(Hit {
        t,
        u: alpha,
        v: beta,
        primitive: 0,
    })
}

/// Method (3); t by the plane, the weights by areas, of which the lecture says nothing.
pub fn edge_planes(ray: &Ray, corners: [Vec3; 3]) -> Option<Hit> {
    let o = ray.origin;
    let [a, b, c] = corners.map(|corner| corner - o);
    let n = (b - a).cross(c - a);
    let t = a.dot(n) / ray.dir.dot(n);
    if t < EPSILON {
        return None;
    }
    let p = o + t * ray.dir;
    for (from, to) in [(a, b), (b, c), (c, a)] {
        let edge = from.cross(to) / from.cross(to).length();
        let s = -o.dot(edge);
        if p.dot(edge) + s < 0.0 {
            return None;
        }
    }
    let p = p - o;
    let area = |q: Vec3, r: Vec3| (q - p).cross(r - p).dot(n) / n.dot(n);
    Some(Hit {
        t,
        u: area(c, a),
        v: area(a, b),
        primitive: 0,
    })
}

/// The box test of the slides: a miss if t_near > t_far for one pair of planes, each pair by itself.
pub fn meets_box(ray: &Ray, bounds: &Aabb) -> bool {
    (0..3).all(|axis| {
        let to = |plane: Vec3| (plane[axis] - ray.origin[axis]) / ray.dir[axis];
        let (first, second) = (to(bounds.min), to(bounds.max));
        first.min(second) <= first.max(second)
    })
}
