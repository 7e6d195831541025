//! Tests: coarseness, refinement and display of the picture during and after a movement.

mod lit;

use super::pacing::{FIRST_PASS, FRAME};
use super::pausing::REST;
use super::*;
use glam::DVec3;
use hitscope_core::camera::Projection;
use hitscope_core::integrator::{INTEGRATORS, Lighting, ViewOptions};
use hitscope_core::kernel::triangle_kernel;
use hitscope_core::mesh::shapes::{Placement, sphere};
use hitscope_core::scene::Shading;
use hitscope_core::scene::scene;

const SIZE: UVec2 = UVec2::new(96, 64);
/// A test that waits longer has failed.
const PATIENCE: Duration = Duration::from_secs(300);

fn tracer() -> Tracer {
    Tracer::new(1, &egui::Context::default())
}

/// A new sphere scene.
fn ball() -> Arc<Scene> {
    Arc::new(scene(sphere(4, Placement::UNIT)))
}

/// A request for the scene with a number of samples, from a place that depends on `x`.
fn request(scene: &Arc<Scene>, x: f64, samples: u32) -> Request {
    let kernel = triangle_kernel("watertight").expect("in the table");
    let intersector: Arc<dyn hitscope_core::Intersector> = Arc::from(scene.intersector(kernel));
    let projection = Projection::Perspective { fov_y_radians: 0.7 };
    let eye = DVec3::new(x, 0.5, 4.0);
    Request {
        context: Context {
            scene: Arc::clone(scene),
            second: Arc::clone(&intersector),
            intersector,
            camera: Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, SIZE)
                .expect("a camera"),
            shading: Shading::Flat,
            background: Vec3::ZERO,
            lighting: Lighting::default(),
            options: ViewOptions::default(),
        },
        integrator: INTEGRATORS[0],
        samples,
        shows_last_tree: true,
    }
}

/// Collects tiles until a condition holds.
fn collect_until(tracer: &mut Tracer, mut is_so: impl FnMut(&mut Tracer) -> bool) {
    let (ctx, start) = (egui::Context::default(), Instant::now());
    loop {
        assert!(tracer.collect(&ctx).is_empty(), "no panic");
        if is_so(tracer) {
            return;
        }
        assert!(start.elapsed() < PATIENCE, "timed out");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn slow_frames_shorten_the_first_pass_and_fast_frames_lengthen_it_within_bounds() {
    let mut tracer = tracer();
    let usual = tracer.first_pass;
    tracer.adapt(FRAME.start);
    tracer.adapt(FRAME.end);
    assert_eq!(tracer.first_pass, usual, "within the target");
    tracer.adapt(FRAME.end + Duration::from_millis(1));
    assert!(tracer.first_pass < usual);
    for _ in 0..100 {
        tracer.adapt(Duration::from_secs(1));
    }
    assert_eq!(tracer.first_pass, *FIRST_PASS.start());
    tracer.adapt(FRAME.start - Duration::from_millis(1));
    assert!(tracer.first_pass > *FIRST_PASS.start());
    for _ in 0..100 {
        tracer.adapt(Duration::ZERO);
    }
    assert_eq!(tracer.first_pass, *FIRST_PASS.end());
}

#[test]
fn a_frame_waits_for_a_first_pass_only_if_it_is_missing_and_expected_to_be_quick() {
    let mut tracer = tracer();
    assert!(!tracer.is_first_pass_quick(), "nothing is requested");
    tracer.set_first_step(Some(1));
    tracer.request(request(&ball(), 0.0, 1));
    assert!(!tracer.is_first_pass_quick(), "the speed isn't known");
    let mut expect = |secs: f64| {
        tracer.speeds[0] = Speed {
            rays: f64::from(SIZE.element_product()),
            busy_secs: secs,
        };
        tracer.is_first_pass_quick()
    };
    assert!(expect(0.009));
    assert!(!expect(0.011));
    collect_until(&mut tracer, |tracer| tracer.film.passes_done() > 0);
    tracer.speeds[0].busy_secs = 1e-3;
    assert!(!tracer.is_first_pass_quick(), "it is there");
}

#[test]
fn the_first_pass_has_the_smallest_blocks_that_fit_its_time() {
    let mut tracer = tracer();
    let pixels = f64::from(SIZE.element_product());
    tracer.first_pass = Duration::from_millis(10);
    for (rays_per_first_pass, step) in [
        (pixels, 1),
        (pixels - 1.0, 2),
        (pixels / 4.0, 2),
        (pixels / 4.0 - 1.0, 3),
        (pixels / 255.0, 16),
        // The coarsest step.
        (1.0, 16),
    ] {
        tracer.speeds[0] = Speed {
            rays: rays_per_first_pass,
            busy_secs: 0.01,
        };
        assert_eq!(
            tracer.first_step(SIZE, false),
            step,
            "{rays_per_first_pass} of {pixels}"
        );
    }
    tracer.set_first_step(Some(4));
    assert_eq!(tracer.first_step(SIZE, false), 4, "as chosen");
    tracer.speeds[1] = Speed {
        rays: 1.0,
        busy_secs: 0.01,
    };
    assert_eq!(tracer.first_step(SIZE, true), 16, "not of views of light");
    tracer.set_first_step(None);
    assert_eq!(tracer.first_step(SIZE, false), 16);
}

#[test]
fn only_frames_during_a_movement_are_counted() {
    let mut tracer = tracer();
    let long_ago = Duration::from_millis(100);
    tracer.has_rested = false;
    tracer.shown_at = Instant::now().checked_sub(long_ago);
    let before = tracer.first_pass;
    tracer.count_frame();
    assert!(tracer.first_pass < before, "a frame of 100 ms is slow");
    let [median, _] = tracer.frame_intervals.median_and_99th().expect("one frame");
    assert!(median >= long_ago);
    // The first picture after a rest says nothing about frame times.
    tracer.has_rested = true;
    tracer.shown_at = Instant::now().checked_sub(long_ago);
    let before = tracer.first_pass;
    tracer.count_frame();
    assert_eq!(tracer.first_pass, before);
    assert_eq!(tracer.frame_intervals.median_and_99th(), None);
}

#[test]
fn refinement_waits_until_the_camera_has_been_at_rest() {
    let (mut tracer, scene) = (tracer(), ball());
    let requested = Instant::now();
    tracer.request(request(&scene, 0.0, 4));
    assert!(tracer.is_moving());
    collect_until(&mut tracer, |tracer| {
        if tracer.is_moving() {
            assert!(tracer.film().passes_done() <= 1, "refined while held");
        }
        !tracer.is_moving()
    });
    assert!(requested.elapsed() >= REST);
    collect_until(&mut tracer, |tracer| tracer.film().is_complete());
    // Each change of the camera restarts the hold.
    for x in [1.0, 2.0] {
        tracer.request(request(&scene, x, 4));
        assert!(tracer.is_moving());
        collect_until(&mut tracer, |tracer| tracer.film().passes_done() > 0);
    }
    let last = tracer.posted.as_ref().expect("posted").at;
    collect_until(&mut tracer, |tracer| !tracer.is_moving());
    assert!(last.elapsed() >= REST);
}

#[test]
fn a_pause_outlasts_the_hold() {
    let (mut tracer, scene) = (tracer(), ball());
    tracer.toggle_pause();
    tracer.request(request(&scene, 0.0, 4));
    collect_until(&mut tracer, |tracer| {
        !tracer.is_moving() && tracer.film().passes_done() > 0
    });
    // Paused threads are idle, so no more tiles arrive.
    assert!(tracer.is_paused() && tracer.film().passes_done() == 1);
    tracer.toggle_pause();
    collect_until(&mut tracer, |tracer| tracer.film().is_complete());
}

#[test]
fn a_new_scene_is_shown_in_parts_and_a_new_camera_after_a_complete_pass() {
    let (mut tracer, first, second) = (tracer(), ball(), ball());
    tracer.request(request(&first, 0.0, 1));
    // No tile has been collected yet: the picture of the new scene starts empty.
    let (film, changed) = tracer.take_changes().expect("at once");
    assert_eq!(
        (film.passes_done(), changed.min, changed.max),
        (0, UVec2::ZERO, SIZE)
    );
    collect_until(&mut tracer, |tracer| tracer.film().is_complete());
    let complete = tracer.film().pixels().to_vec();
    tracer.take_changes();

    tracer.request(request(&first, 1.0, 1));
    assert!(tracer.take_changes().is_none(), "the old picture stays");
    assert_eq!(tracer.shown().map(|(_, camera)| camera.eye().x), Some(0.0));
    collect_until(&mut tracer, |tracer| {
        let is_done = tracer.film().passes_done() > 0;
        assert_eq!(
            tracer.take_changes().is_some(),
            is_done,
            "an incomplete pass"
        );
        is_done
    });
    assert_eq!(tracer.shown().map(|(_, camera)| camera.eye().x), Some(1.0));
    assert!(tracer.film().pixels() != complete);

    tracer.request(request(&second, 0.0, 1));
    assert!(
        tracer.take_changes().is_some(),
        "the old scene disappears at once"
    );
    assert!(
        tracer
            .shown()
            .is_some_and(|(scene, _)| Arc::ptr_eq(scene, &second))
    );
}
