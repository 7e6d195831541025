//! Pictures rendered in strips.

use crate::golden::job;
use glam::{UVec2, Vec3};
use hitscope_core::camera::Projection;
use hitscope_core::integrator::INTEGRATORS;
use hitscope_core::picture::guides;
use hitscope_core::plan::Plan;
use hitscope_core::progress::Progress;
use hitscope_core::render::{Job, RenderError, Strip, Strips};
use hitscope_core::scene::Shading;

/// Three strips.
const SIZE: UVec2 = UVec2::new(67, 101);

fn picture(view: &str) -> Job {
    let projection = Projection::Perspective {
        fov_y_radians: 0.75,
    };
    job(view, Shading::Smooth, projection, Plan::new(SIZE, 1, 4))
}

/// The strips of a job's picture that have at most this much memory.
fn strips(job: &Job, bytes: u64) -> Vec<Strip> {
    let progress = Progress::default();
    let render = |rows| Strip::render(job, rows, 2, &progress, |_| true).expect("no panic");
    Strips::new(SIZE, bytes).rows().map(render).collect()
}

fn pixels(job: &Job, bytes: u64) -> Vec<[u8; 4]> {
    strips(job, bytes).iter().flat_map(Strip::pixels).collect()
}

#[test]
fn strips_are_the_picture_rendered_whole() {
    for view in INTEGRATORS {
        let mut job = picture(view.name);
        let whole = pixels(&job, u64::MAX);
        assert_eq!(whole.len(), SIZE.element_product() as usize);
        assert!(pixels(&job, 0) == whole, "{}", view.name);
        job.context.background = Vec3::ZERO;
        job.context.options.has_transparent_background = true;
        let [whole, parts] = [u64::MAX, 0].map(|bytes| strips(&job, bytes));
        assert_eq!((whole.len(), parts.len()), (1, 3));
        let all =
            |strips: &[Strip]| -> Vec<[u8; 4]> { strips.iter().flat_map(Strip::pixels).collect() };
        assert!(all(&parts) == all(&whole), "{}, transparent", view.name);
        assert!(all(&whole).iter().any(|pixel| pixel[3] == 0));
    }
}

#[test]
fn the_guides_of_a_strip_are_those_of_its_rows() {
    let job = picture("shaded");
    let of = |plan: &Plan| guides(&job.context, plan, 2, &Progress::default()).expect("guides");
    let (whole, strip) = (of(&job.plan), of(&job.plan.of_rows(48..96)));
    let width = SIZE.x as usize;
    assert_eq!(strip.pixels(), &whole.pixels()[48 * width..96 * width]);
}

#[test]
fn strips_tell_the_progress_of_the_whole_picture_and_can_be_cancelled() {
    let (job, progress) = (picture("shaded"), Progress::default());
    let mut parts = Vec::new();
    for rows in Strips::new(SIZE, 0).rows() {
        let strip = Strip::render(&job, rows.clone(), 2, &progress, |part| {
            parts.push(part);
            true
        });
        assert_eq!(strip.expect("no panic").rows, rows);
        let done = f64::from(rows.end) / f64::from(SIZE.y);
        let last = parts.last().expect("tiles");
        assert!((last - done).abs() < 1e-9, "{last} {done}");
    }
    assert!(parts.is_sorted());
    let strip = Strip::render(&job, 0..48, 2, &progress, |_| false);
    assert!(matches!(strip, Err(RenderError::Cancelled)));
    let mut transparent = picture("shaded");
    transparent.context.options.has_transparent_background = true;
    progress.cancel();
    let strip = Strip::render(&transparent, 0..48, 2, &progress, |_| true);
    assert!(matches!(strip, Err(RenderError::Cancelled)));
}
