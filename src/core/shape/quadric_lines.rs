//! Wireframe lines of quadrics: intersections with planes perpendicular to each axis, and with the sides of the box.
//!
//! The intersection with a plane is a conic a·y² + 2·b·x·y + c·x² + 2·d·y + 2·e·x + f = 0. For each x between the ends of
//! the conic's arcs, y is a root of a quadratic equation. Arcs end at the box and where both roots are equal.

use super::lines::{AddLine, LineDetail, LinePoint};
use super::quadric::Quadric;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// Positions of the planes, relative to half the box's edge. The first and the last one are sides of the box.
const PLANES: [f64; 7] = [-1.0, -0.8, -0.4, 0.0, 0.4, 0.8, 1.0];

/// The conic in which a plane perpendicular to an axis meets a quadric.
struct Conic<'a> {
    quadric: &'a Quadric,
    /// The axes of the plane's normal, of x and of y.
    axes: [usize; 3],
    /// The plane's coordinate along its normal.
    at: f64,
    /// The coefficients a to f.
    coefficients: [f64; 6],
}

/// Passes the curves to `add`.
pub(super) fn quadric_lines(quadric: &Quadric, detail: &LineDetail, add: AddLine<'_>) {
    for axis in 0..3 {
        for part in PLANES {
            let at = part * f64::from(quadric.half[axis]);
            Conic::new(quadric, axis, at).lines(detail, add);
        }
    }
}

impl<'a> Conic<'a> {
    fn new(quadric: &'a Quadric, axis: usize, at: f64) -> Self {
        let with_axes = |axes: [usize; 3]| {
            let [_, x, y] = axes.map(|axis| DVec3::AXES[axis]);
            let foot = at * DVec3::AXES[axis];
            let at_foot = quadric.gradient(foot);
            // The halved gradient is linear.
            let second = |p: DVec3| quadric.gradient(p) - quadric.gradient(DVec3::ZERO);
            let coefficients = [
                second(y).dot(y),
                second(x).dot(y),
                second(x).dot(x),
                at_foot.dot(y),
                at_foot.dot(x),
                quadric.value(foot),
            ];
            Self {
                quadric,
                axes,
                at,
                coefficients,
            }
        };
        let (j, k) = ((axis + 1) % 3, (axis + 2) % 3);
        let conic = with_axes([axis, j, k]);
        // A line x = constant is on the conic only if a = 0, and if the conic is a line, only if d = 0, too.
        let [a, _, c, d, e, _] = conic.coefficients.map(f64::abs);
        if a > c || (a == c && d >= e) {
            conic
        } else {
            with_axes([axis, k, j])
        }
    }

    /// Half the box's edges along x and y.
    fn half(&self) -> [f64; 2] {
        [1, 2].map(|k| f64::from(self.quadric.half[self.axes[k]]))
    }

    fn point(&self, x: f64, y: f64) -> LinePoint {
        let mut p = DVec3::ZERO;
        (p[self.axes[0]], p[self.axes[1]], p[self.axes[2]]) = (self.at, x, y);
        LinePoint {
            position: self.quadric.centre.as_dvec3() + p,
            normal: self.quadric.gradient(p).normalize_or_zero(),
        }
    }

    /// The coefficients of the equation a·y² + 2·p·y + q = 0 for y at an x.
    fn equation(&self, x: f64) -> [f64; 3] {
        let [a, b, c, d, e, f] = self.coefficients;
        [a, b * x + d, (c * x + 2.0 * e) * x + f]
    }

    /// The values of y at an x: that with the subtracted root, and that with the added one.
    fn ordinates(&self, x: f64) -> [f64; 2] {
        let [a, p, q] = self.equation(x);
        let root = (p * p - a * q).max(0.0).sqrt();
        let far = -(p + root.copysign(p));
        if far == 0.0 {
            // Both are 0, or there is none and this is NaN.
            [0.0 / a; 2]
        } else if p.is_sign_negative() {
            [q / far, far / a]
        } else {
            [far / a, q / far]
        }
    }

    /// One of the values of y at an x. Where an arc crosses a line x = constant that is on the conic, too, it is that at
    /// an x nearer to the arc's middle.
    fn ordinate(&self, x: f64, branch: usize, middle: f64) -> f64 {
        /// A part of the arc that isn't seen.
        const STEP: f64 = 1e-6;
        let y = self.ordinates(x)[branch];
        if y.is_nan() {
            self.ordinates(x + STEP * (middle - x))[branch]
        } else {
            y
        }
    }

    /// The values of x at which arcs may begin or end, ascending, from one side of the box to the other.
    fn ends(&self) -> Vec<f64> {
        let [a, b, c, d, e, f] = self.coefficients;
        let [half_x, half_y] = self.half();
        let mut ends = vec![-half_x, half_x];
        // Both roots are equal: p² = a·q.
        ends.extend(roots(b * b - a * c, b * d - a * e, d * d - a * f));
        // The root is infinite, or the two have equal absolute values.
        ends.push(-d / b);
        for y in [-half_y, half_y] {
            ends.extend(roots(c, b * y + e, (a * y + 2.0 * d) * y + f));
        }
        ends.retain(|x| x.abs() <= half_x);
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        ends
    }

    fn lines(&self, detail: &LineDetail, add: AddLine<'_>) {
        let half_y = self.half()[1];
        let ends = self.ends();
        for x in ends.iter().copied().filter(|&x| self.has_every_y(x)) {
            add(&[self.point(x, -half_y), self.point(x, half_y)]);
        }
        for pair in ends.windows(2) {
            let (middle, reach) = (0.5 * (pair[0] + pair[1]), 0.5 * (pair[1] - pair[0]));
            let [a, p, q] = self.equation(middle);
            if p * p < a * q {
                continue;
            }
            for branch in 0..2 {
                // NaN and infinity are outside.
                let is_inside = self.ordinates(middle)[branch].abs() <= half_y;
                if !is_inside {
                    continue;
                }
                // A point at the end of an arc at which both roots are equal moves smoothly with the angle.
                let at = |angle: f64| {
                    let x = (middle + reach * angle.sin()).clamp(pair[0], pair[1]);
                    self.point(x, self.ordinate(x, branch, middle).clamp(-half_y, half_y))
                };
                let pieces = (detail.segments / 2).max(4);
                add(&detail.curve([-FRAC_PI_2, FRAC_PI_2], pieces, &at));
            }
        }
    }

    /// Whether a line x = constant is on the conic.
    fn has_every_y(&self, x: f64) -> bool {
        /// The sums of up to three terms, and x, are rounded a few times.
        const ROUNDING: f64 = 8.0 * f64::EPSILON;
        let [a, b, c, d, e, f] = self.coefficients;
        let [_, p, q] = self.equation(x);
        let p_terms = (b * x).abs() + d.abs();
        let q_terms = (c * x * x).abs() + 2.0 * (e * x).abs() + f.abs();
        a == 0.0 && p.abs() <= ROUNDING * p_terms && q.abs() <= ROUNDING * q_terms
    }
}

/// The real roots of a·x² + 2·b·x + c, of which some may be infinite or NaN.
fn roots(a: f64, b: f64, c: f64) -> [f64; 2] {
    let root = (b * b - a * c).sqrt();
    let far = -(b + root.copysign(b));
    [far / a, c / far]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aabb::Aabb;
    use glam::Vec3;

    fn lines(coefficients: [f32; 10], half: Vec3) -> Vec<Vec<DVec3>> {
        let quadric = Quadric {
            coefficients,
            centre: Vec3::ZERO,
            half,
        };
        let detail = LineDetail {
            segments: 64,
            around: Aabb::EMPTY,
            view: None,
        };
        let mut lines = Vec::new();
        quadric_lines(&quadric, &detail, &mut |line| {
            for point in line {
                let value = quadric.value(point.position);
                assert!(value.abs() < 1e-9, "{value} at {}", point.position);
                let beyond = point.position.abs() - half.as_dvec3();
                assert!(beyond.max_element() <= 0.0);
            }
            lines.push(line.iter().map(|point| point.position).collect());
        });
        lines
    }

    /// The sum of the lengths of the lines in a plane across an axis.
    fn length(lines: &[Vec<DVec3>], axis: usize, at: f64) -> f64 {
        let is_there = |line: &&Vec<DVec3>| line.iter().all(|p| (p[axis] - at).abs() < 1e-9);
        let pieces = lines
            .iter()
            .filter(is_there)
            .flat_map(|line| line.windows(2));
        pieces.map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// x² + y² − z² = r².
    fn hyperboloid(squared_radius: f32) -> [f32; 10] {
        let mut coefficients = [0.0; 10];
        coefficients[..3].copy_from_slice(&[1.0, 1.0, -1.0]);
        coefficients[9] = -squared_radius;
        coefficients
    }

    #[test]
    fn circles_are_whole_however_small_and_the_cut_border_is_a_circle() {
        for radius in [0.5, 0.01, 1e-4] {
            let half = Vec3::new(1.2, 1.2, 1.0);
            let lines = lines(hyperboloid(radius * radius), half);
            let neck = std::f64::consts::TAU * f64::from(radius);
            let found = length(&lines, 2, 0.0);
            assert!((found / neck - 1.0).abs() < 2e-3, "{found} for {neck}");
            let border = std::f64::consts::TAU * f64::from(1.0 + radius * radius).sqrt();
            let found = length(&lines, 2, 1.0);
            assert!((found / border - 1.0).abs() < 2e-3, "{found} for {border}");
        }
    }

    #[test]
    fn straight_lines_in_a_surface_are_found_along_both_axes() {
        // 2xy = 0 contains the planes x = 0 and y = 0.
        let mut coefficients = [0.0; 10];
        coefficients[3] = 1.0;
        let lines = lines(coefficients, Vec3::ONE);
        assert!((length(&lines, 2, 0.4) - 4.0).abs() < 1e-9);
    }

    #[test]
    fn both_arcs_of_a_hyperbola_reach_the_box() {
        // In the plane x = 0.96: y² − z² = 0.25 − 0.9216, with arcs above and below.
        let lines = lines(hyperboloid(0.25), Vec3::splat(1.2));
        let arc: Vec<f64> = lines
            .iter()
            .flatten()
            .filter(|p| (p.x - 0.96).abs() < 1e-7)
            .map(|p| p.z)
            .collect();
        let reach = arc.iter().fold(0.0_f64, |most, z| most.max(z.abs()));
        assert!((reach - 1.2).abs() < 1e-6, "{reach}");
        assert!(arc.iter().any(|z| *z > 0.0) && arc.iter().any(|z| *z < 0.0));
    }
}
