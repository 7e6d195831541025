//! What a movement does to the picture: how coarse it gets, when it refines, and when it is shown.

use super::*;
use glam::DVec3;
use hitscope_core::camera::Projection;
use hitscope_core::integrator::INTEGRATORS;
use hitscope_core::kernel::triangle_kernel;
use hitscope_core::mesh::shapes::{Placement, scene, sphere};
use hitscope_core::scene::Shading;

const SIZE: UVec2 = UVec2::new(96, 64);
/// A test that waits for longer has failed.
const PATIENCE: Duration = Duration::from_secs(300);

fn tracer() -> Tracer {
    Tracer::new(1, &egui::Context::default())
}

/// A ball of its own.
fn ball() -> Arc<Scene> {
    Arc::new(scene(sphere(4, Placement::UNIT)))
}

/// A view of the scene, with so many samples, from a place that depends on `x`.
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
        },
        integrator: &INTEGRATORS[0],
        samples,
        shows_last_tree: true,
    }
}

/// Collects until something is the case.
fn collect_until(tracer: &mut Tracer, mut is_so: impl FnMut(&mut Tracer) -> bool) {
    let (ctx, start) = (egui::Context::default(), Instant::now());
    loop {
        assert!(tracer.collect(&ctx).is_empty(), "no panic");
        if is_so(tracer) {
            return;
        }
        assert!(start.elapsed() < PATIENCE, "waited in vain");
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn slow_frames_shorten_the_first_pass_and_quick_ones_lengthen_it_within_bounds() {
    let mut tracer = tracer();
    let usual = tracer.first_pass;
    tracer.adapt(FRAME.start);
    tracer.adapt(FRAME.end);
    assert_eq!(tracer.first_pass, usual, "as it should be");
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
fn the_first_pass_has_the_smallest_blocks_that_its_time_allows() {
    let mut tracer = tracer();
    let pixels = f64::from(SIZE.element_product());
    tracer.first_pass = Duration::from_millis(10);
    for (rays_per_first_pass, step) in [
        (pixels, 1),
        (pixels - 1.0, 2),
        (pixels / 4.0, 2),
        (pixels / 4.0 - 1.0, 3),
        (pixels / 255.0, 16),
        // The coarsest there is.
        (1.0, 16),
    ] {
        (tracer.rays, tracer.busy_secs) = (rays_per_first_pass, 0.01);
        assert_eq!(
            tracer.first_step(SIZE),
            step,
            "{rays_per_first_pass} of {pixels}"
        );
    }
}

#[test]
fn only_frames_of_a_movement_are_counted() {
    let mut tracer = tracer();
    let long_ago = Duration::from_millis(100);
    tracer.has_rested = false;
    tracer.shown_at = Instant::now().checked_sub(long_ago);
    let before = tracer.first_pass;
    tracer.count_frame();
    assert!(tracer.first_pass < before, "a frame of 100 ms is slow");
    let [median, _] = tracer.frame_intervals.median_and_99th().expect("one frame");
    assert!(median >= long_ago);
    // The first view after a rest shows nothing of what a frame takes.
    tracer.has_rested = true;
    tracer.shown_at = Instant::now().checked_sub(long_ago);
    let before = tracer.first_pass;
    tracer.count_frame();
    assert_eq!(tracer.first_pass, before);
    assert_eq!(tracer.frame_intervals.median_and_99th(), None);
}

#[test]
fn refinement_waits_until_the_view_has_been_at_rest() {
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
    // Another view holds it again, and each further one anew.
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
    // Paused threads have nothing to do, so there is nothing to come.
    assert!(tracer.is_paused() && tracer.film().passes_done() == 1);
    tracer.toggle_pause();
    collect_until(&mut tracer, |tracer| tracer.film().is_complete());
}

#[test]
fn parts_are_shown_of_a_new_scene_and_whole_passes_of_a_new_view() {
    let (mut tracer, first, second) = (tracer(), ball(), ball());
    tracer.request(request(&first, 0.0, 1));
    // No tile is collected yet: the picture of the new scene starts empty.
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
        assert_eq!(tracer.take_changes().is_some(), is_done, "half a view");
        is_done
    });
    assert_eq!(tracer.shown().map(|(_, camera)| camera.eye().x), Some(1.0));
    assert!(tracer.film().pixels() != complete);

    tracer.request(request(&second, 0.0, 1));
    assert!(
        tracer.take_changes().is_some(),
        "the old scene goes at once"
    );
    assert!(
        tracer
            .shown()
            .is_some_and(|(scene, _)| Arc::ptr_eq(scene, &second))
    );
}
