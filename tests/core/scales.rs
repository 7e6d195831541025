//! Scales of views of numbers: the user's choices, and measured ranges.

use crate::golden::{clipped, job};
use glam::{UVec2, Vec2, Vec3};
use hitscope_core::camera::Projection;
use hitscope_core::colour::{ScaleError, colour_map};
use hitscope_core::integrator::{INTEGRATORS, Setting};
use hitscope_core::plan::Plan;
use hitscope_core::render::Job;
use hitscope_core::sampler::Sampler;
use hitscope_core::scene::Shading;

const SIZE: UVec2 = UVec2::new(40, 30);

fn picture(view: &str) -> Job {
    let projection = Projection::Perspective {
        fov_y_radians: 0.75,
    };
    job(view, Shading::Smooth, projection, Plan::new(SIZE, 1, 1))
}

/// The colours and the numbers of the pixels' centres.
fn pixels(
    Job {
        context,
        integrator,
        ..
    }: &Job,
) -> Vec<(Vec3, Option<f64>)> {
    let pixels = (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| UVec2::new(x, y)));
    let shown = |pixel| {
        let ray = context.camera.ray(pixel, Vec2::splat(0.5));
        let hit = context.intersector.closest_hit(&ray);
        let sampler = || Sampler::new(pixel, 0);
        let colour = integrator.radiance(context, &ray, hit, &mut sampler());
        (
            colour,
            integrator.number(context, &ray, hit, &mut sampler()),
        )
    };
    pixels.map(shown).collect()
}

#[test]
fn views_of_numbers_have_the_colours_of_their_scale() {
    let mut count = 0;
    for view in INTEGRATORS {
        let job = picture(view.name);
        let scale = view.scale(&job.context).expect("a range");
        assert_eq!(
            scale.is_some(),
            view.needs.uses(Setting::Scale),
            "{}",
            view.name
        );
        let Some(scale) = scale else {
            assert!(pixels(&job).iter().all(|(_, number)| number.is_none()));
            continue;
        };
        count += 1;
        let [first, last] = scale.range();
        let numbers = pixels(&job);
        for (colour, number) in &numbers {
            // Below the range, a view may have another colour.
            if let Some(x) = number.filter(|x| *x >= first.min(last)) {
                assert_eq!(*colour, scale.colour(x), "{}: {x}", view.name);
            }
        }
        let shown = numbers.iter().filter(|(_, number)| number.is_some());
        assert!(shown.count() > 100, "{}", view.name);
    }
    assert!(count >= 5, "{count}");
}

#[test]
fn the_users_map_range_and_spacing_replace_the_views_own() {
    let mut job = picture("depth");
    let view = job.integrator;
    let map = colour_map("vik").expect("in the table");
    job.context.options.scale.map = Some(map);
    job.context.options.scale.range = Some([2.0, 4.0]);
    job.context.options.scale.is_logarithmic = Some(true);
    let scale = view.scale(&job.context).expect("good").expect("numbers");
    assert_eq!((scale.map(), scale.range()), (map, [2.0, 4.0]));
    assert!(scale.is_logarithmic());
    for (colour, number) in pixels(&job) {
        let expected = number.map_or(job.context.background, |x| scale.colour(x));
        assert_eq!(colour, expected);
    }
    job.context.options.scale.range = Some([0.0, 4.0]);
    let error = view.scale(&job.context);
    assert_eq!(error, Err(ScaleError::NotPositive));
    // Such a scale has no colours, but no view panics.
    assert!(pixels(&job).iter().all(|(colour, _)| colour.is_finite()));
}

#[test]
fn a_measured_range_is_that_of_the_numbers_in_the_picture() {
    for view in ["depth", "cost", "error-t"] {
        for job in [picture(view), clipped(picture(view))] {
            let numbers = pixels(&job).into_iter().filter_map(|(_, number)| number);
            let own = job
                .integrator
                .scale(&job.context)
                .expect("good")
                .expect("numbers");
            let is_shown = |x: &f64| !own.is_logarithmic() || *x > 0.0;
            let numbers: Vec<f64> = numbers.filter(is_shown).collect();
            let least = numbers.iter().copied().fold(f64::INFINITY, f64::min);
            let most = numbers.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert!(least < most, "{view}");
            // White is near in the view “depth”.
            let expected = if view == "depth" {
                [most, least]
            } else {
                [least, most]
            };
            let found = job.integrator.measured_range(&job.context);
            assert_eq!(found, Some(expected), "{view}");
        }
    }
    let triangle = picture("triangle");
    assert_eq!(triangle.integrator.measured_range(&triangle.context), None);
}
