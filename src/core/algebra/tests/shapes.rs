//! Shapes as pieces, for the tests.

use super::super::pieces::{Piece, Pieces, RayIn};
use super::super::polynomial::Polynomial;
use super::super::ring::{Ring, cross, difference, dot, squared_length, vector};
use glam::Vec3;

pub struct Sphere {
    pub centre: Vec3,
    pub radius: f32,
}

impl Pieces for Sphere {
    fn centre(&self) -> Vec3 {
        self.centre
    }

    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<R>)) {
        let f = difference(&ray.origin, &vector(self.centre));
        let a = squared_length(&ray.dir);
        let b = dot(&f, &ray.dir).doubled();
        let c = squared_length(&f) - R::from(self.radius).square();
        emit(Piece {
            part: 0,
            surface: &Polynomial::new([c, b, a]),
            conditions: &[],
        });
    }
}

/// A solid cylinder from `base` to `base + axis`: its side and two caps.
pub struct Cylinder {
    pub base: Vec3,
    pub axis: Vec3,
    pub radius: f32,
}

impl Pieces for Cylinder {
    fn centre(&self) -> Vec3 {
        self.base + 0.5 * self.axis
    }

    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<R>)) {
        let f = difference(&ray.origin, &vector(self.base));
        let w = vector(self.axis);
        // Heights above the base and squared distances from the axis, both times |axis|² or its square.
        let length = squared_length(&w);
        let height = Polynomial::new([dot(&f, &w), dot(&ray.dir, &w)]);
        let [near, along] = [cross(&f, &w), cross(&ray.dir, &w)];
        let distance = Polynomial::new([
            squared_length(&near),
            dot(&near, &along).doubled(),
            squared_length(&along),
        ]);
        let limit = Polynomial::constant(R::from(self.radius).square() * length.clone());
        let top = Polynomial::constant(length);
        let below_top = top.minus(&height);
        emit(Piece {
            part: 0,
            surface: &distance.minus(&limit),
            conditions: &[height.clone(), below_top.clone()],
        });
        let inside = [limit.minus(&distance)];
        for (part, surface) in [(1, &height), (2, &below_top)] {
            emit(Piece {
                part,
                surface,
                conditions: &inside,
            });
        }
    }
}

/// A torus around an axis of any length.
pub struct Torus {
    pub centre: Vec3,
    pub axis: Vec3,
    pub major: f32,
    pub minor: f32,
}

impl Pieces for Torus {
    fn centre(&self) -> Vec3 {
        self.centre
    }

    fn pieces<R: Ring>(&self, ray: &RayIn<R>, emit: &mut impl FnMut(Piece<R>)) {
        let f = difference(&ray.origin, &vector(self.centre));
        let w = vector(self.axis);
        let length = squared_length(&w);
        let (major, minor) = (R::from(self.major).square(), R::from(self.minor).square());
        let height = Polynomial::new([dot(&f, &w), dot(&ray.dir, &w)]);
        let square = Polynomial::new([
            squared_length(&f),
            dot(&f, &ray.dir).doubled(),
            squared_length(&ray.dir),
        ]);
        let distance = square.scaled(&length).minus(&height.times(&height));
        let sum = square.plus(&Polynomial::constant(major.clone() - minor));
        // (|p|² + R² − r²)²|w|² = 4R²·distance
        let left = sum.times(&sum).scaled(&length);
        let right = distance.scaled(&major.doubled().doubled());
        emit(Piece {
            part: 0,
            surface: &left.minus(&right),
            conditions: &[],
        });
    }
}
