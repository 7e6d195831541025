//! The four descriptions of a plane, and conversions between them.
//!
//! Source: Lensch, Basic Geometry, lecture, 2022.

use glam::DVec3;

/// A description of an infinite plane. Seen from the side of the normal, v to w and the three points run
/// counterclockwise. Descriptions with parallel vectors, collinear points or a normal of 0 describe none; conversions
/// of them give a normal of 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaneForm {
    /// x = p + s·v + t·w.
    PointAndVectors {
        /// The point p.
        point: DVec3,
        /// The vectors v and w, which aren't parallel.
        vectors: [DVec3; 2],
    },
    /// Three points that aren't collinear.
    ThreePoints([DVec3; 3]),
    /// n·(x − p) = 0.
    PointAndNormal {
        /// The point p.
        point: DVec3,
        /// The normal n, of any length.
        normal: DVec3,
    },
    /// a·x₁ + b·x₂ + c·x₃ + d = 0, where (a, b, c) is the normal, of any length.
    Equation {
        /// The normal (a, b, c).
        normal: DVec3,
        /// The constant d.
        d: f64,
    },
}

impl PlaneForm {
    /// A normal, of any length.
    pub fn normal(&self) -> DVec3 {
        match *self {
            Self::PointAndVectors {
                vectors: [v, w], ..
            } => v.cross(w),
            Self::ThreePoints([a, b, c]) => (b - a).cross(c - a),
            Self::PointAndNormal { normal, .. } | Self::Equation { normal, .. } => normal,
        }
    }

    /// A point of the plane: the one given, or the one nearest to (0, 0, 0); NaN for an equation with a normal of 0.
    pub fn point(&self) -> DVec3 {
        match *self {
            Self::PointAndVectors { point, .. } | Self::PointAndNormal { point, .. } => point,
            Self::ThreePoints([a, ..]) => a,
            Self::Equation { normal, d } => normal * (-d / normal.length_squared()),
        }
    }

    /// By a point and two vectors: those given, or else perpendicular unit vectors.
    #[must_use]
    pub fn to_point_and_vectors(&self) -> Self {
        let vectors = match *self {
            Self::PointAndVectors { vectors, .. } => vectors,
            Self::ThreePoints([a, b, c]) => [b - a, c - a],
            _ => {
                let pair = self
                    .normal()
                    .try_normalize()
                    .map(|n| n.any_orthonormal_pair());
                pair.map_or([DVec3::ZERO; 2], |(v, w)| [v, w])
            }
        };
        Self::PointAndVectors {
            point: self.point(),
            vectors,
        }
    }

    /// By three points: p, p + v and p + w.
    #[must_use]
    pub fn to_three_points(&self) -> Self {
        match (*self, self.to_point_and_vectors()) {
            (Self::ThreePoints(points), _) => Self::ThreePoints(points),
            (
                _,
                Self::PointAndVectors {
                    point,
                    vectors: [v, w],
                },
            ) => Self::ThreePoints([point, point + v, point + w]),
            (_, other) => other,
        }
    }

    /// By a point and a normal.
    #[must_use]
    pub fn to_point_and_normal(&self) -> Self {
        Self::PointAndNormal {
            point: self.point(),
            normal: self.normal(),
        }
    }

    /// By an equation.
    #[must_use]
    pub fn to_equation(&self) -> Self {
        let normal = self.normal();
        let d = match *self {
            Self::Equation { d, .. } => d,
            _ => -normal.dot(self.point()),
        };
        Self::Equation { normal, d }
    }

    /// The Hesse form n·x = D: the unit normal and the distance D of the plane from (0, 0, 0), negative if the normal
    /// points towards it. `None` if the description describes no plane.
    pub fn to_hesse(&self) -> Option<(DVec3, f64)> {
        let normal = self.normal().try_normalize()?;
        let distance = match *self {
            Self::Equation { normal, d } => -d / normal.length(),
            _ => normal.dot(self.point()),
        };
        Some((normal, distance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    type Conversion = fn(&PlaneForm) -> PlaneForm;

    const CONVERSIONS: [Conversion; 4] = [
        PlaneForm::to_point_and_vectors,
        PlaneForm::to_three_points,
        PlaneForm::to_point_and_normal,
        PlaneForm::to_equation,
    ];

    #[test]
    fn every_description_converts_to_every_other_and_back() {
        let mut random = Random::new(1);
        for _ in 0..1000 {
            let [a, b, c] = [(); 3].map(|()| 3.0 * random.in_cube());
            let first = PlaneForm::ThreePoints([a, b, c]);
            let area = first.normal().length();
            if area < 0.1 {
                continue;
            }
            let (normal, distance) = first.to_hesse().expect("a plane");
            for there in CONVERSIONS {
                for back in CONVERSIONS {
                    let converted = back(&there(&first));
                    let (n, d) = converted.to_hesse().expect("a plane");
                    // Some ten operations on numbers below 6, divided by the area.
                    let bound = 1e3 * f64::EPSILON / area;
                    assert!((n - normal).length() < bound, "{first:?} {converted:?}");
                    assert!((d - distance).abs() < bound, "{first:?} {converted:?}");
                    for point in [a, b, c] {
                        assert!((n.dot(point) - d).abs() < bound, "{converted:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_descriptions_of_the_lecture_have_their_values() {
        let plane = PlaneForm::ThreePoints([DVec3::Z, DVec3::X + DVec3::Z, DVec3::Y + DVec3::Z]);
        assert_eq!(plane.to_hesse(), Some((DVec3::Z, 1.0)));
        let equation = PlaneForm::Equation {
            normal: DVec3::Z,
            d: -1.0,
        };
        assert_eq!(plane.to_equation(), equation);
        assert_eq!(equation.point(), DVec3::Z);
        let vectors = [DVec3::X, DVec3::Y];
        let point = DVec3::Z;
        assert_eq!(
            plane.to_point_and_vectors(),
            PlaneForm::PointAndVectors { point, vectors }
        );
        let nothing = PlaneForm::PointAndNormal {
            point,
            normal: DVec3::ZERO,
        };
        assert_eq!(nothing.to_three_points().to_hesse(), None);
        let none = PlaneForm::ThreePoints([DVec3::ZERO, DVec3::X, 2.0 * DVec3::X]);
        assert_eq!(none.to_hesse(), None);
    }
}
