//! Vertex colours.

use super::error::Warning;
use crate::counts::{counted, counted_as};
use glam::Vec3;

/// The colours of a file's vertices.
#[derive(Default)]
pub(super) struct Colours {
    /// The colour of each vertex up to the last coloured one. Vertices without a colour have infinity, which is
    /// white on both scales.
    values: Vec<[f32; 3]>,
    /// The number of vertices with a colour.
    coloured_count: usize,
}

impl Colours {
    /// Sets the colour of a vertex. Its index must exceed those of all coloured vertices.
    pub(super) fn add(&mut self, vertex: usize, colour: [f32; 3]) {
        self.values.resize(vertex, [f32::INFINITY; 3]);
        self.values.push(colour);
        self.coloured_count += 1;
    }

    pub(super) fn len(&self) -> usize {
        self.values.len()
    }

    /// The sRGB colours of `count` vertices, from 0 to 1, and a warning if the file's values don't lie there. Whole values up
    /// to 255 are bytes, as some programs write them, unless all are so small that the mesh would be black. The list is empty
    /// if no vertex has a colour.
    pub(super) fn take(&mut self, count: usize) -> (Vec<Vec3>, Option<Warning>) {
        /// A mesh whose largest byte is this is black to the eye.
        const BLACK: f32 = 15.0;
        let mut values = std::mem::take(&mut self.values);
        if !values.is_empty() {
            values.resize(count, [f32::INFINITY; 3]);
        }
        let given = values
            .iter()
            .filter(|colour| **colour != [f32::INFINITY; 3]);
        let mut channels = given.clone().flatten();
        let largest = channels.clone().copied().fold(0.0, f32::max);
        let are_whole = channels.all(|x| x.fract() == 0.0);
        let are_bytes = are_whole && largest > BLACK && largest <= 255.0;
        let white = if are_bytes { 255.0 } else { 1.0 };
        let is_outside = |colour: &&[f32; 3]| colour.iter().any(|x| !(0.0..=white).contains(x));
        let outside = given.filter(is_outside).count();
        let warning = if outside > 0 {
            let colours = counted(outside, "vertex colour");
            Some(format!(
                "{colours} with a value outside 0 to {white}: clamped; NaN becomes 0"
            ))
        } else {
            let message = "vertex colours above 1: interpreted as bytes";
            are_bytes.then(|| message.to_owned())
        };
        let channel = |x: f32| {
            if x.is_nan() {
                0.0
            } else {
                (x / white).clamp(0.0, 1.0)
            }
        };
        let colour = |channels: [f32; 3]| Vec3::from_array(channels.map(channel));
        let colours = values.into_iter().map(colour).collect();
        (colours, warning.map(Warning::of_file))
    }

    /// A warning if some, but not all, of `count` vertices have no colour.
    pub(super) fn warning(&self, count: usize) -> Option<Warning> {
        let colourless = count - self.coloured_count;
        (self.coloured_count > 0 && colourless > 0).then(|| {
            let vertices = counted_as(
                colourless,
                "vertex without a colour is",
                "vertices without a colour are",
            );
            Warning::of_file(format!("{vertices} white"))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(given: &[[f32; 3]]) -> (Vec<Vec3>, Option<String>) {
        let mut colours = Colours::default();
        for (vertex, colour) in given.iter().enumerate() {
            colours.add(vertex, *colour);
        }
        let (values, warning) = colours.take(given.len());
        (values, warning.map(|warning| warning.message))
    }

    #[test]
    fn values_above_1_are_bytes_or_clamped() {
        let (values, warning) = taken(&[[255.0, 51.0, 0.0]]);
        assert_eq!(values, [Vec3::new(1.0, 0.2, 0.0)]);
        assert!(warning.is_some_and(|text| text.ends_with("interpreted as bytes")));
        assert_eq!(
            taken(&[[1.0, 0.5, 0.0]]),
            (vec![Vec3::new(1.0, 0.5, 0.0)], None)
        );
        for (given, clamped) in [
            ([2.0, 0.0, 0.0], Vec3::X),
            ([1.5, 0.0, 1.0], Vec3::new(1.0, 0.0, 1.0)),
            ([f32::NAN, 1.0, -1.0], Vec3::Y),
            ([300.0, 0.0, 0.0], Vec3::X),
        ] {
            let (values, warning) = taken(&[given]);
            assert_eq!(values, [clamped], "{given:?}");
            let expected = "1 vertex colour with a value outside 0 to 1: clamped; NaN becomes 0";
            assert_eq!(warning.as_deref(), Some(expected), "{given:?}");
        }
    }
}
