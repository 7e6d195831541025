//! Measurements between picked points: their texts, and the lines that show them.

use crate::numbers::number;
use glam::DVec3;
use hitscope_core::measure::{Circle, Separation, angle_at, angle_between};
use hitscope_lab::inspection::ThicknessReport;

/// A picked point.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredPoint {
    /// The number of the pick.
    pub number: u32,
    /// The point in the file's coordinates.
    pub in_file: DVec3,
    /// The point in the scene's coordinates.
    pub in_scene: DVec3,
    /// The geometric normal.
    pub normal: DVec3,
}

/// Measurements.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurements {
    /// Names and values, in the file's units and degrees.
    pub rows: Vec<[String; 2]>,
    /// Lines in the scene's coordinates.
    pub lines: Vec<[DVec3; 2]>,
    /// Texts at points in the scene's coordinates.
    pub texts: Vec<(DVec3, String)>,
}

impl Measurements {
    /// The distances from each point to the next one; of the last two points the angle between the normals; of the last
    /// three the angle at the middle one and the circle through them.
    pub fn between(points: &[MeasuredPoint]) -> Self {
        let mut all = Self::default();
        for pair in points.windows(2) {
            all.add_distance(&pair[0], &pair[1]);
        }
        if let [.., a, b] = points {
            let angle = angle_between(a.normal, b.normal);
            all.row(
                format!("angle of normals {} and {}", a.number, b.number),
                degrees(angle),
            );
        }
        if let [.., a, b, c] = points {
            all.add_angle([a, b, c]);
            all.add_circle([a, b, c]);
        }
        all
    }

    /// Adds the thickness of the wall and the clearance at a hit; positions in the file are `origin` away from those in
    /// the scene.
    pub fn add_thickness(&mut self, thickness: &ThicknessReport, from: DVec3, origin: DVec3) {
        let walls = [
            ("thickness", &thickness.inwards),
            ("clearance", &thickness.outwards),
        ];
        for (name, wall) in walls {
            let Some(wall) = wall else {
                self.row(name.to_owned(), "no other surface".to_owned());
                continue;
            };
            let to = DVec3::from_array(wall.position) - origin;
            self.lines.push([from, to]);
            let text = number(wall.distance);
            self.texts.push((0.5 * (from + to), short(wall.distance)));
            let primitive = format!("{text}, to {} {}", wall.shape, wall.primitive);
            self.row(name.to_owned(), primitive);
        }
    }

    /// The rows as lines of two columns, separated by tabs.
    pub fn to_text(&self) -> String {
        let line = |[name, value]: &[String; 2]| format!("{name}\t{value}\n");
        self.rows.iter().map(line).collect()
    }

    fn row(&mut self, name: String, value: String) {
        self.rows.push([name, value]);
    }

    fn add_distance(&mut self, a: &MeasuredPoint, b: &MeasuredPoint) {
        let Separation { delta, length } = Separation::new(a.in_file, b.in_file);
        let between = format!("{} to {}", a.number, b.number);
        self.row(format!("distance {between}"), number(length));
        let delta = delta.to_array().map(number).join(", ");
        self.row(format!("dx, dy, dz {between}"), delta);
        self.lines.push([a.in_scene, b.in_scene]);
        let middle = 0.5 * (a.in_scene + b.in_scene);
        self.texts.push((middle, short(length)));
    }

    fn add_angle(&mut self, [a, b, c]: [&MeasuredPoint; 3]) {
        let angle = angle_at(b.in_file, [a.in_file, c.in_file]);
        self.row(format!("angle at {}", b.number), degrees(angle));
        let Some(angle) = angle else { return };
        let arms = [a.in_scene - b.in_scene, c.in_scene - b.in_scene];
        let radius = ARC * arms[0].length().min(arms[1].length());
        let [from, to] = arms.map(DVec3::normalize_or_zero);
        let Some(side) = (to - to.dot(from) * from).try_normalize() else {
            return;
        };
        let on = |part: f64| {
            let (sin, cos) = (part * angle).sin_cos();
            b.in_scene + radius * (cos * from + sin * side)
        };
        self.curve(ARC_PIECES, on);
        self.texts.push((on(0.5), degrees(Some(angle))));
    }

    fn add_circle(&mut self, [a, b, c]: [&MeasuredPoint; 3]) {
        let name = format!("circle {}, {}, {}", a.number, b.number, c.number);
        let Some(circle) = Circle::through([a, b, c].map(|p| p.in_file)) else {
            self.row(name, "none: the points are on a line".to_owned());
            return;
        };
        self.row(format!("{name}: radius"), number(circle.radius));
        let centre = circle.centre.to_array().map(number).join(", ");
        self.row("centre".to_owned(), centre);
        let Some(shown) = Circle::through([a, b, c].map(|p| p.in_scene)) else {
            return;
        };
        let (x, y) = shown.normal.any_orthonormal_pair();
        let on = |part: f64| {
            let (sin, cos) = (std::f64::consts::TAU * part).sin_cos();
            shown.centre + shown.radius * (cos * x + sin * y)
        };
        self.curve(CIRCLE_PIECES, on);
        let text = format!("radius {}", short(circle.radius));
        self.texts.push((shown.centre, text));
    }

    /// Adds a curve of so many lines.
    fn curve(&mut self, count: u32, on: impl Fn(f64) -> DVec3) {
        let at = |k: u32| on(f64::from(k) / f64::from(count));
        self.lines.extend((0..count).map(|k| [at(k), at(k + 1)]));
    }
}

/// The radius of the arc of an angle, as a fraction of the shorter arm.
const ARC: f64 = 0.3;
/// Lines of an arc: so many look round.
const ARC_PIECES: u32 = 24;
/// Lines of a circle.
const CIRCLE_PIECES: u32 = 96;

/// A length for the picture.
fn short(length: f64) -> String {
    crate::numbers::significant(length, 6)
}

fn degrees(angle: Option<f64>) -> String {
    angle.map_or_else(
        || "undefined".to_owned(),
        |angle| format!("{}°", crate::numbers::significant(angle.to_degrees(), 8)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(all: &[[f64; 3]]) -> Vec<MeasuredPoint> {
        let origin = DVec3::new(100.0, 0.0, 0.0);
        let point = |(number, p): (u32, &[f64; 3])| MeasuredPoint {
            number,
            in_file: DVec3::from_array(*p) + origin,
            in_scene: DVec3::from_array(*p),
            normal: if number == 1 { DVec3::Z } else { DVec3::X },
        };
        (1..).zip(all).map(point).collect()
    }

    fn value<'m>(found: &'m Measurements, name: &str) -> &'m str {
        let row = found.rows.iter().find(|[title, _]| title == name);
        &row.unwrap_or_else(|| panic!("no {name} in {found:?}"))[1]
    }

    #[test]
    fn two_points_have_a_distance_and_an_angle_of_normals() {
        let found = Measurements::between(&points(&[[0.0; 3], [3.0, 4.0, 0.0]]));
        assert_eq!(value(&found, "distance 1 to 2"), "5");
        assert_eq!(value(&found, "dx, dy, dz 1 to 2"), "3, 4, 0");
        assert_eq!(value(&found, "angle of normals 1 and 2"), "90.000000°");
        assert_eq!(found.lines, [[DVec3::ZERO, DVec3::new(3.0, 4.0, 0.0)]]);
        assert_eq!(found.texts[0].1, "5.00000");
        assert!(found.to_text().starts_with("distance 1 to 2\t5\n"));
        assert_eq!(
            Measurements::between(&points(&[[1.0; 3]])),
            Measurements::default()
        );
    }

    #[test]
    fn three_points_have_an_angle_and_a_circle_that_is_drawn_through_them() {
        let corners = [[6.0, 0.0, 0.0], [0.0; 3], [0.0, 8.0, 0.0]];
        let found = Measurements::between(&points(&corners));
        assert_eq!(value(&found, "angle at 2"), "90.000000°");
        assert_eq!(value(&found, "circle 1, 2, 3: radius"), "5");
        assert_eq!(value(&found, "centre"), "103, 4, 0");
        let circle = &found.lines[found.lines.len() - CIRCLE_PIECES as usize..];
        for [start, _] in circle {
            assert!(((*start - DVec3::new(3.0, 4.0, 0.0)).length() - 5.0).abs() < 1e-12);
        }
        let line = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
        let found = Measurements::between(&points(&line));
        assert!(value(&found, "circle 1, 2, 3").starts_with("none"));
    }
}
