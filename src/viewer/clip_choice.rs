//! The clip that the user chooses, in the file's coordinates.

use glam::DVec3;
use hitscope_core::clip::{Clip, ClipError};
use std::ops::RangeInclusive;

/// What clips the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ClipShape {
    /// Nothing: all of it is shown.
    #[default]
    None,
    /// A plane.
    Plane,
    /// A box aligned with the axes, of which the inside is shown.
    Box,
}

/// The box around a scene in the file's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The lowest corner.
    pub min: DVec3,
    /// The highest corner.
    pub max: DVec3,
}

/// The chosen clip.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClipChoice {
    /// What clips the scene.
    pub shape: ClipShape,
    /// The plane's normal, which points to the side that is removed.
    pub normal: DVec3,
    /// The plane's offset: `normal·p` of its points.
    pub offset: f64,
    /// The box.
    pub cell: Option<Extent>,
}

impl Extent {
    /// The middle.
    pub fn centre(&self) -> DVec3 {
        self.min.midpoint(self.max)
    }
}

impl ClipChoice {
    /// The clip; `None` if nothing clips the scene.
    ///
    /// # Errors
    /// See [`ClipError`].
    pub fn clip(&self) -> Result<Option<Clip>, ClipError> {
        let cell = || self.cell.map(|cell| Clip::axis_box(cell.min, cell.max));
        match self.shape {
            ClipShape::None => Ok(None),
            ClipShape::Plane => Clip::plane(self.normal, self.offset).map(Some),
            ClipShape::Box => cell().transpose(),
        }
    }

    /// Clips by this shape; if it already does, shows everything. The first plane and box are those of a scene.
    pub fn toggle(&mut self, shape: ClipShape, scene: &Extent) {
        if self.shape == shape {
            self.shape = ClipShape::None;
            return;
        }
        self.shape = shape;
        if self.normal == DVec3::ZERO {
            self.set_plane(DVec3::X, scene.centre());
        }
        self.cell.get_or_insert(*scene);
    }

    /// Clips by a plane through a point.
    pub fn use_plane(&mut self, normal: DVec3, point: DVec3) {
        self.shape = ClipShape::Plane;
        self.set_plane(normal, point);
    }

    fn set_plane(&mut self, normal: DVec3, point: DVec3) {
        (self.normal, self.offset) = (normal, normal.dot(point));
    }

    /// Turns the plane's normal. The plane still passes through its point nearest to the middle of a scene.
    pub fn turn(&mut self, normal: DVec3, scene: &Extent) {
        let (old, centre) = (self.normal, scene.centre());
        let away = (self.offset - old.dot(centre)) / old.length_squared();
        self.set_plane(normal, centre + away * old);
    }

    /// Shows the other side of the plane.
    pub fn flip(&mut self) {
        (self.normal, self.offset) = (-self.normal, -self.offset);
    }

    /// The offsets at which the plane passes through a scene.
    pub fn offsets(&self, scene: &Extent) -> RangeInclusive<f64> {
        let half = 0.5 * (scene.max - scene.min);
        let middle = self.normal.dot(scene.centre());
        let reach = self.normal.abs().dot(half);
        middle - reach..=middle + reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: Extent = Extent {
        min: DVec3::new(-1.0, 0.0, 2.0),
        max: DVec3::new(3.0, 2.0, 4.0),
    };

    #[test]
    fn the_first_plane_halves_the_scene_and_the_first_box_holds_it() {
        let mut choice = ClipChoice::default();
        assert_eq!(choice.clip(), Ok(None));
        choice.toggle(ClipShape::Plane, &SCENE);
        let plane = choice.clip().expect("a clip").expect("a plane");
        assert!(plane.keeps(DVec3::new(0.9, 1.0, 3.0)) && !plane.keeps(DVec3::new(1.1, 1.0, 3.0)));
        assert_eq!(choice.offsets(&SCENE), -1.0..=3.0);
        choice.toggle(ClipShape::Box, &SCENE);
        let cell = choice.clip().expect("a clip").expect("a box");
        assert!(cell.keeps(SCENE.centre()) && !cell.keeps(DVec3::ZERO));
        assert!(cell.keeps(SCENE.min) && cell.keeps(SCENE.max));
        choice.toggle(ClipShape::Box, &SCENE);
        assert_eq!(choice.clip(), Ok(None));
    }

    #[test]
    fn a_flipped_plane_shows_the_other_side_and_a_turned_one_keeps_its_distance() {
        let mut choice = ClipChoice::default();
        choice.use_plane(DVec3::Z, DVec3::new(0.0, 0.0, 2.5));
        let keeps = |choice: &ClipChoice, point| {
            let clip = choice.clip().expect("a clip").expect("a plane");
            clip.keeps(point)
        };
        let low = DVec3::new(1.0, 1.0, 2.0);
        assert!(keeps(&choice, low));
        choice.flip();
        assert!(!keeps(&choice, low));
        choice.turn(DVec3::X, &SCENE);
        assert_eq!(choice.offset, 1.0);
    }
}
