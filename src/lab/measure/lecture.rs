//! The lecture's programs as printed, including their mistakes.
//!
//! Source: H. Lensch, "Basic Geometry", lecture in computer graphics, Tübingen 2022. The kernels of the same
//! names are corrected versions; the programs here are only measured.

use glam::Vec3;
use hitscope_core::shape::{AxisBox, Triangle};
use hitscope_core::{Hit, Ray};

/// The source, in tables.
pub const LECTURE: &str = "Lensch, Basic Geometry, lecture, 2022";

/// What tables state of a program.
pub struct PrintedInfo {
    /// The name.
    pub name: &'static str,
    /// The title.
    pub title: &'static str,
    /// Its mistakes.
    pub summary: &'static str,
}

/// A program of the lecture.
pub struct AsPrinted<S: 'static> {
    /// What tables state of it.
    pub info: PrintedInfo,
    /// The program's ray–primitive test.
    pub intersect: fn(&Ray, &S) -> Option<Hit>,
}

/// The lecture's three methods for triangles.
pub static TRIANGLE_AS_PRINTED: &[AsPrinted<Triangle>] = &[
    AsPrinted {
        info: PrintedInfo {
            name: "plane-projection as printed",
            title: "Plane and projection, as printed",
            summary: "Swaps the weights of B and C; rejects t < 1e-6; D = A·n cancels far from the origin.",
        },
        intersect: |ray, triangle| plane_projection(ray, triangle.0),
    },
    AsPrinted {
        info: PrintedInfo {
            name: "parametric as printed",
            title: "Parametric, as printed",
            summary: "P = α(B − A) + β(C − A) lacks A, so it is right only if A is the origin.",
        },
        intersect: |ray, triangle| parametric(ray, triangle.0),
    },
    AsPrinted {
        info: PrintedInfo {
            name: "edge-planes as printed",
            title: "Edge planes, as printed",
            summary: "Culls back faces; normalising gives NaN if the ray's origin lies on the line of an edge.",
        },
        intersect: |ray, triangle| edge_planes(ray, triangle.0),
    },
];

/// The lecture's method for boxes.
pub static BOX_AS_PRINTED: &[AsPrinted<AxisBox>] = &[AsPrinted {
    info: PrintedInfo {
        name: "slabs as printed",
        title: "Slabs, as printed",
        summary: "Compares t_near with t_far of single pairs of planes, where it is never greater, so no ray misses.",
    },
    intersect: slabs,
}];

/// The lecture's tolerance on t.
const EPSILON: f32 = 0.000_001;

/// Method (1): the pseudo-code, with its missing parenthesis added.
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
    // In HIT(t, beta, gamma), these read as the weights of B and C, in this order.
    Some(Hit {
        t,
        u: beta,
        v: gamma,
        primitive: 0,
    })
}

/// The normal in the pseudo-code, c × b. The slide on normals has (v1 − v0) × (v2 − v0), the opposite.
pub fn program_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    (c - a).cross(b - a).normalize()
}

/// Whether a hit passes the test of the slide on precision, which rejects |t| < ε.
pub fn passes_slide(t: f32) -> bool {
    t.abs() >= EPSILON
}

/// Method (2): solves P = α(B − A) + β(C − A) by least squares.
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

/// Method (3). The lecture doesn't define t and the barycentric coordinates; they are computed from the plane
/// and from areas.
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

/// The box test of the slides: a miss if t_near > t_far for any single pair of planes.
///
/// The slides don't state the hit's t. Here it is the last entry, or the first exit if that lies before the interval.
pub fn slabs(ray: &Ray, bounds: &AxisBox) -> Option<Hit> {
    let (mut enter, mut leave) = (f32::NEG_INFINITY, f32::INFINITY);
    for axis in 0..3 {
        let to = |plane: Vec3| (plane[axis] - ray.origin[axis]) / ray.dir[axis];
        let (first, second) = (to(bounds.min), to(bounds.max));
        let (near, far) = (first.min(second), first.max(second));
        if near > far {
            return None;
        }
        enter = enter.max(near);
        leave = leave.min(far);
    }
    let t = if enter > ray.t_min { enter } else { leave };
    (ray.t_min < t && t < ray.t_max).then_some(Hit {
        t,
        u: 0.0,
        v: 0.0,
        primitive: 0,
    })
}
