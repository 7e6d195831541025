//! Vertex colours.

use super::error::Warning;
use crate::counts::counted_as;
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

    /// The sRGB colours of `count` vertices, from 0 to 1, and whether the file's values range from 0 to 255, as some
    /// programs write them. The list is empty if no vertex has a colour.
    pub(super) fn take(&mut self, count: usize) -> (Vec<Vec3>, bool) {
        let mut values = std::mem::take(&mut self.values);
        if !values.is_empty() {
            values.resize(count, [f32::INFINITY; 3]);
        }
        let channels = values.as_flattened().iter().copied();
        let mut given = channels.filter(|x| x.is_finite());
        let largest = given.clone().fold(0.0, f32::max);
        let are_whole = given.all(|x| x.fract() == 0.0);
        let are_bytes = are_whole && largest > 1.0 && largest <= 255.0;
        let white = if are_bytes { 255.0 } else { 1.0 };
        // NaN becomes black.
        let channel = |x: f32| {
            if x.is_nan() {
                0.0
            } else {
                (x / white).clamp(0.0, 1.0)
            }
        };
        let colour = |channels: [f32; 3]| Vec3::from_array(channels.map(channel));
        (values.into_iter().map(colour).collect(), are_bytes)
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
