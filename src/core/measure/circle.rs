//! The circle through three points.
//!
//! Source: Shewchuk, "Lecture Notes on Geometric Robustness", 2013, "Circumcenters and Circumradii of Triangles":
//!   the centre relative to one of the points, which keeps its digits far from the origin.

use super::Separation;
use glam::DVec3;

/// A circle in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// The centre.
    pub centre: DVec3,
    /// The radius.
    pub radius: f64,
    /// Unit normal of its plane; the points run counterclockwise about it.
    pub normal: DVec3,
}

impl Circle {
    /// The circle through three points; `None` if they lie on a line, as far as f64 can tell, or one isn't finite.
    ///
    /// Relative errors grow with the flatness of the triangle: to about 2⁻⁵¹ divided by the sine of its largest angle.
    pub fn through([a, b, c]: [DVec3; 3]) -> Option<Self> {
        let (u, v) = (b - a, c - a);
        let scale = u.abs().max(v.abs()).max_element();
        let (u, v) = (u / scale, v / scale);
        let normal = u.cross(v);
        let area = normal.length();
        // False for NaN, too.
        let has_area = area > COLLINEAR * u.length() * v.length();
        if !has_area {
            return None;
        }
        let to_centre = (u.length_squared() * v.cross(normal)
            + v.length_squared() * normal.cross(u))
            / (2.0 * area * area);
        let lengths = u.length() * v.length() * (u - v).length();
        Some(Self {
            centre: a + scale * to_centre,
            radius: scale * (lengths / (2.0 * area)),
            normal: normal / area,
        })
    }

    /// The circumference.
    pub fn circumference(&self) -> f64 {
        std::f64::consts::TAU * self.radius
    }

    /// The diameter.
    pub fn diameter(&self) -> f64 {
        2.0 * self.radius
    }

    /// The largest difference between the radius and a point's distance from the centre.
    pub fn error(&self, points: [DVec3; 3]) -> f64 {
        let off = points.map(|p| (Separation::new(self.centre, p).length - self.radius).abs());
        off.into_iter().fold(0.0, f64::max)
    }
}

/// The bound below which the length of a cross product u × v, relative to |u|·|v|, could be rounding alone. Each
/// coordinate of u and v, which are differences, is rounded by 2⁻⁵³ and again by the scale; each coordinate of the product
/// is the difference of two products, each off by 5·2⁻⁵³ and of at most |u|·|v|. The sum, 10·2⁻⁵³ and another rounding,
/// is less than 12·2⁻⁵³, and the length of three of them less than 21·2⁻⁵³.
const COLLINEAR: f64 = 21.0 * f64::EPSILON / 2.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn points_of_a_circle_give_it_back_at_any_scale_and_place() {
        let mut random = Random::new(5);
        for (scale, place) in [(1.0, 0.0), (1e-20, 0.0), (1e20, 0.0), (1.0, 1e6)] {
            for _ in 0..100 {
                let normal = random.direction();
                let x = normal.cross(random.direction()).normalize();
                let y = normal.cross(x);
                let centre = place * random.in_cube();
                let on = |angle: f64| centre + scale * (angle.cos() * x + angle.sin() * y);
                let points = [on(0.2), on(1.9), on(4.4)];
                let found = Circle::through(points).expect("not on a line");
                // Points are rounded by 2⁻⁵³ of their coordinates.
                let bound = 1e-14 * scale + 1e-15 * place;
                assert!((found.radius - scale).abs() < bound, "{found:?}");
                assert!((found.centre - centre).length() < bound, "{found:?}");
                assert!(
                    (found.normal - normal).length() < bound / scale,
                    "{found:?}"
                );
                assert!(found.error(points) < bound, "{found:?}");
            }
        }
    }

    #[test]
    fn the_circle_about_a_right_angle_is_exact() {
        let found = Circle::through([DVec3::ZERO, 6.0 * DVec3::X, 8.0 * DVec3::Y]);
        let found = found.expect("a triangle");
        assert_eq!(
            (found.centre, found.radius, found.normal),
            (DVec3::new(3.0, 4.0, 0.0), 5.0, DVec3::Z)
        );
        assert_eq!(found.diameter(), 10.0);
    }

    #[test]
    fn points_on_a_line_have_no_circle_but_nearly_straight_ones_have() {
        let mut random = Random::new(6);
        for _ in 0..1000 {
            let (from, along) = (random.in_cube(), random.in_cube());
            // Rounded: the points are on the line up to an ulp.
            let on = |t: f64| from + t * along;
            let scale = (2.0 * random.signed()).exp2();
            let line = [DVec3::ZERO, scale * along, 3.0 * scale * along];
            assert_eq!(Circle::through(line), None);
            let [a, b, c] = [on(0.0), on(1.0), on(0.4)];
            let bent = c + 1e-6 * along.cross(DVec3::X);
            assert!(Circle::through([a, b, bent]).is_some());
        }
        for none in [[DVec3::ONE; 3], [DVec3::ZERO, DVec3::ZERO, DVec3::X]] {
            assert_eq!(Circle::through(none), None);
        }
        assert_eq!(Circle::through([DVec3::NAN, DVec3::X, DVec3::Y]), None);
    }
}
