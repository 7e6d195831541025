//! Wireframe lines of shapes: lines of constant surface coordinates.

use super::curve::LineView;
use crate::aabb::Aabb;
use glam::DVec3;
use std::f64::consts::TAU;

/// A point of a line on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinePoint {
    /// The point.
    pub position: DVec3,
    /// Unit normal of the surface.
    pub normal: DVec3,
}

/// How lines are drawn.
#[derive(Clone, Copy, Debug)]
pub struct LineDetail {
    /// The least number of straight pieces of a full circle.
    pub segments: u32,
    /// The region in which infinite surfaces are drawn.
    pub around: Aabb,
    /// The camera whose picture curves are divided for. Without it, they have the least number of pieces.
    pub view: Option<LineView>,
}

/// Receives lines, each as a sequence of points.
pub type AddLine<'a> = &'a mut dyn FnMut(&[LinePoint]);

impl LineDetail {
    /// The ellipse with two half axes; `normal` is that at an outward unit vector.
    pub(super) fn circle(
        &self,
        centre: DVec3,
        [x, y]: [DVec3; 2],
        add: AddLine<'_>,
        normal: impl Fn(DVec3) -> DVec3,
    ) {
        let point = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            let outwards = cos * x + sin * y;
            LinePoint {
                position: centre + outwards,
                normal: normal(outwards.normalize_or_zero()),
            }
        };
        add(&self.curve([0.0, TAU], self.segments, &point));
    }
}

/// A straight line on a flat part of a surface.
pub(super) fn straight(from: DVec3, to: DVec3, normal: DVec3, add: AddLine<'_>) {
    add(&[from, to].map(|position| LinePoint { position, normal }));
}

/// A grid over the points c + a·u + b·v with |a|, |b| ≤ 1, with an even `count` of cells along each side. The lines through
/// the centre come first.
pub(super) fn grid(centre: DVec3, [u, v]: [DVec3; 2], count: u32, normal: DVec3, add: AddLine<'_>) {
    let half = f64::from(count / 2);
    for k in 0..=count {
        // 0, −1, 1, −2, 2, …
        let steps = f64::from(k.div_ceil(2));
        let at = if k % 2 == 1 { -steps } else { steps } / half;
        straight(centre + at * u - v, centre + at * u + v, normal, add);
        straight(centre + at * v - u, centre + at * v + u, normal, add);
    }
}

/// A grid over the part of a plane that is near a region.
pub(super) fn plane_grid(point: DVec3, normal: DVec3, detail: &LineDetail, add: AddLine<'_>) {
    /// Spaces along each side.
    const COUNT: u32 = 20;
    let radius = detail.around.radius();
    let reach = if radius > 0.0 { radius } else { 1.0 };
    let centre = if detail.around.is_empty() {
        point
    } else {
        detail.around.centre().as_dvec3()
    };
    let foot = centre - (centre - point).dot(normal) * normal;
    let (u, v) = normal.any_orthonormal_pair();
    grid(foot, [reach * u, reach * v], COUNT, normal, add);
}

/// Grids on the six sides of the box with these half axes about a centre.
pub(super) fn box_grid(centre: DVec3, axes: [DVec3; 3], add: AddLine<'_>) {
    /// Spaces along each edge.
    const COUNT: u32 = 4;
    let turn = axes[0].cross(axes[1]).dot(axes[2]).signum();
    for axis in 0..3 {
        let (u, v) = (axes[(axis + 1) % 3], axes[(axis + 2) % 3]);
        for side in [-1.0, 1.0] {
            let normal = (side * turn * u.cross(v)).normalize_or_zero();
            grid(centre + side * axes[axis], [u, v], COUNT, normal, add);
        }
    }
}

/// Diameters, which come first, and circles of a disk with this normal, or of an ellipse with these half axes.
pub(super) fn disk_lines(
    centre: DVec3,
    axes: [DVec3; 2],
    normal: DVec3,
    detail: &LineDetail,
    add: AddLine<'_>,
) {
    /// Diameters; they meet the lines of a cylinder's side.
    const DIAMETERS: u32 = 6;
    for k in 0..DIAMETERS {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(2 * DIAMETERS)).sin_cos();
        let radius = cos * axes[0] + sin * axes[1];
        straight(centre - radius, centre + radius, normal, add);
    }
    for part in [0.5, 1.0] {
        detail.circle(centre, axes.map(|axis| part * axis), add, |_| normal);
    }
}

/// Lines of a cylinder's or a cone's side from one end of an axis to the other, with the radii there.
pub(super) fn side_lines(ends: [DVec3; 2], radii: [f64; 2], detail: &LineDetail, add: AddLine<'_>) {
    /// Circles, including those at the ends, and straight lines.
    const CIRCLES: u32 = 5;
    const STRAIGHT: u32 = 12;
    let along = ends[1] - ends[0];
    let length = along.length();
    let axis = along / length;
    let (x, y) = axis.any_orthonormal_pair();
    let normal =
        |outwards: DVec3| (length * outwards + (radii[0] - radii[1]) * axis).normalize_or_zero();
    let radius = |at: f64| radii[0] + at * (radii[1] - radii[0]);
    for k in 0..CIRCLES {
        let at = f64::from(k) / f64::from(CIRCLES - 1);
        if radius(at) > 0.0 {
            let axes = [radius(at) * x, radius(at) * y];
            detail.circle(ends[0] + at * along, axes, add, normal);
        }
    }
    for k in 0..STRAIGHT {
        let (sin, cos) = (TAU * f64::from(k) / f64::from(STRAIGHT)).sin_cos();
        let outwards = cos * x + sin * y;
        let [from, to] = [0, 1].map(|end| ends[end] + radii[end] * outwards);
        straight(from, to, normal(outwards), add);
    }
}
