//! Views of numbers: a number for each ray, which a scale colours.

use super::{Context, Integrator, Source};
use crate::colour::{ColourMap, ColourScale, ScaleError};
use crate::plan::Plan;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use glam::{UVec2, Vec3};
use rayon::prelude::*;

/// A view of numbers.
pub(super) struct NumberView {
    /// The quantity.
    pub title: &'static str,
    /// Its unit; empty if it has none.
    pub unit: &'static str,
    /// The colour map, if the user chooses none.
    pub map: &'static ColourMap,
    /// The range, likewise.
    pub range: DefaultRange,
    /// Whether the scale is logarithmic, likewise.
    pub is_logarithmic: bool,
    /// What a ray shows.
    pub shown: fn(&Context, &Ray, Option<Hit>, &mut Sampler) -> Shown,
}

/// The range of a scale, if the user chooses none.
pub(super) enum DefaultRange {
    /// The same for all scenes.
    Fixed([f64; 2]),
    /// It depends on scene and camera.
    Of(fn(&Context) -> [f64; 2]),
}

/// What a ray shows in a view of numbers.
pub(super) enum Shown {
    /// A number.
    Number(f64),
    /// A number that has this colour if it is below the range.
    NumberOr(f64, Vec3),
    /// Something else.
    Colour(Vec3),
}

impl NumberView {
    fn default_range(&self, context: &Context) -> [f64; 2] {
        match self.range {
            DefaultRange::Fixed(range) => range,
            DefaultRange::Of(range) => range(context),
        }
    }

    fn is_logarithmic(&self, context: &Context) -> bool {
        let chosen = context.options.scale.is_logarithmic;
        chosen.unwrap_or(self.is_logarithmic)
    }

    fn scale(&self, context: &Context) -> Result<ColourScale, ScaleError> {
        let chosen = &context.options.scale;
        let range = chosen.range.unwrap_or_else(|| self.default_range(context));
        let map = chosen.map.unwrap_or(self.map);
        ColourScale::new(
            self.title,
            self.unit,
            range,
            map,
            self.is_logarithmic(context),
        )
    }

    /// The colour of a ray. If there is no scale, that of a scale from 0 to 1.
    pub fn colour(&self, context: &Context, shown: Shown) -> Vec3 {
        let number = match shown {
            Shown::Colour(colour) => return colour,
            Shown::Number(x) | Shown::NumberOr(x, _) => x,
        };
        let unit = || ColourScale::new("", "", [0.0, 1.0], self.map, false);
        let Ok(scale) = self.scale(context).or_else(|_| unit()) else {
            return self.map.colour(f32::NAN);
        };
        let [first, last] = scale.range();
        match shown {
            Shown::NumberOr(x, colour) if x < first.min(last) => colour,
            _ => scale.colour(number),
        }
    }
}

impl Integrator {
    fn number_view(&self) -> Option<&NumberView> {
        match &self.source {
            Source::Number(view) => Some(view),
            Source::Colour(_) | Source::Batch(_) | Source::Index => None,
        }
    }

    /// The scale with the user's choices; `None` if the view shows no numbers.
    ///
    /// # Errors
    /// See [`ScaleError`].
    pub fn scale(&self, context: &Context) -> Result<Option<ColourScale>, ScaleError> {
        let view = self.number_view();
        view.map(|view| view.scale(context)).transpose()
    }

    /// The scale without choices of the user, if it is the same for all scenes.
    pub fn default_scale(&self) -> Option<ColourScale> {
        let view = self.number_view()?;
        let DefaultRange::Fixed(range) = view.range else {
            return None;
        };
        ColourScale::new(view.title, view.unit, range, view.map, view.is_logarithmic).ok()
    }

    /// The number that a ray shows, given its first hit; `None` if it shows none.
    pub fn number(
        &self,
        context: &Context,
        ray: &Ray,
        hit: Option<Hit>,
        sampler: &mut Sampler,
    ) -> Option<f64> {
        match (self.number_view()?.shown)(context, ray, hit, sampler) {
            Shown::Number(x) | Shown::NumberOr(x, _) => Some(x),
            Shown::Colour(_) => None,
        }
    }

    /// The range of the numbers in the centres of at most 128 × 128 evenly spaced pixels; `None` if there are none. A
    /// single number is the middle of the range. The larger end comes first if it does in the view's own range.
    pub fn measured_range(&self, context: &Context) -> Option<[f64; 2]> {
        let view = self.number_view()?;
        let is_logarithmic = view.is_logarithmic(context);
        let number = |pixel: UVec2| {
            let ray = context.camera.ray(pixel, Plan::position(pixel, 0));
            let hit = context.intersector.closest_hit(&ray);
            let number = self.number(context, &ray, hit, &mut Sampler::new(pixel, 0))?;
            let counts = number.is_finite() && (number > 0.0 || !is_logarithmic);
            counts.then_some([number; 2])
        };
        let numbers = lattice(context).into_par_iter().filter_map(number);
        let join = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a.min(c), b.max(d)];
        let [least, most] = numbers.reduce_with(join)?;
        let range = match (least < most, is_logarithmic) {
            (true, _) => [least, most],
            (false, true) => [0.5 * least, 2.0 * least],
            (false, false) => {
                let half = (0.5 * least.abs()).max(0.5);
                [least - half, least + half]
            }
        };
        let [first, last] = view.default_range(context);
        Some(if first > last {
            [range[1], range[0]]
        } else {
            range
        })
    }
}

/// The pixels of a lattice over the picture.
fn lattice(context: &Context) -> Vec<UVec2> {
    const MOST: u32 = 128;
    let size = context.camera.resolution();
    let step = size.max_element().div_ceil(MOST).max(1);
    let rows = (step / 2..size.y).step_by(step as usize);
    let pixel = |y| {
        (step / 2..size.x)
            .step_by(step as usize)
            .map(move |x| UVec2::new(x, y))
    };
    rows.flat_map(pixel).collect()
}
