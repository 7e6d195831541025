//! Tests of views that need lights: their preview, and the limits that end refinement.

use super::*;
use hitscope_core::integrator::integrator;
use hitscope_core::render::render;

/// A request for the view *Ambient occlusion*, which needs no light sources.
fn lit(scene: &Arc<Scene>, x: f64, samples: u32) -> Request {
    Request {
        integrator: integrator("ao").expect("in the table"),
        ..request(scene, x, samples)
    }
}

/// The picture of a request's view, or of its preview, which has one sample.
fn rendered(request: &Request, is_preview: bool) -> Vec<[u8; 4]> {
    let (integrator, samples) = if is_preview {
        (INTEGRATORS[0], 1)
    } else {
        (request.integrator, request.samples)
    };
    let job = Job {
        context: request.context.clone(),
        integrator,
        plan: Plan::new(SIZE, 1, samples),
    };
    render(job, 1).expect("no panic").pixels().to_vec()
}

#[test]
fn a_view_with_lights_is_previewed_until_the_camera_rests() {
    let (mut tracer, scene) = (tracer(), ball());
    // Blocks of one pixel, so that the preview is a picture of one sample.
    tracer.first_pass = Duration::from_millis(20);
    tracer.request(lit(&scene, 0.0, 1));
    collect_until(&mut tracer, |tracer| tracer.is_finished());
    while tracer.take_changes().is_some() {}
    for x in [1.0, 2.0] {
        let wanted = lit(&scene, x, 4);
        tracer.speeds[0] = Speed::default();
        tracer.request(wanted.clone());
        let mut pictures = Vec::new();
        collect_until(&mut tracer, |tracer| {
            let shows_lit = tracer.shows_lit();
            if let Some((film, _)) = tracer.take_changes() {
                pictures.push((shows_lit, film.pixels().to_vec()));
            }
            tracer.is_finished()
        });
        // Complete pictures only: the preview once, and then the view from its first pass on.
        let (previews, views): (Vec<_>, Vec<_>) = pictures.into_iter().partition(|(lit, _)| !lit);
        assert!(!previews.is_empty() && !views.is_empty());
        let preview = rendered(&wanted, true);
        assert!(previews.iter().all(|(_, pixels)| *pixels == preview));
        let view = rendered(&wanted, false);
        assert!(views.last().is_some_and(|(_, pixels)| *pixels == view));
        assert!(view != preview);
    }
}

#[test]
fn the_preview_stays_until_the_first_pass_of_the_view_is_done() {
    let (mut tracer, scene) = (tracer(), ball());
    tracer.request(lit(&scene, 0.0, 1));
    collect_until(&mut tracer, |tracer| tracer.is_finished());
    while tracer.take_changes().is_some() {}
    tracer.request(lit(&scene, 1.0, 4));
    collect_until(&mut tracer, |tracer| {
        tracer.take_changes();
        !tracer.is_moving()
    });
    // The view's first pass has begun; no tile of it is collected yet.
    assert!(tracer.is_lit() && !tracer.shows_lit() && !tracer.is_finished());
    assert_eq!(tracer.film().passes_done(), 0);
    assert!(tracer.take_changes().is_none(), "nothing of it is shown");
    // A movement doesn't wait for it.
    tracer.request(lit(&scene, 2.0, 4));
    let posted = tracer.posted.as_ref().expect("posted");
    assert!(posted.is_preview && posted.request.context.camera.eye().x == 2.0);
}

#[test]
fn other_light_on_the_same_picture_needs_no_preview() {
    let (mut tracer, scene) = (tracer(), ball());
    let mut wanted = lit(&scene, 0.0, 1);
    tracer.request(wanted.clone());
    collect_until(&mut tracer, |tracer| tracer.is_finished());
    wanted.context.lighting.ao_distance = 0.5;
    tracer.request(wanted.clone());
    assert!(tracer.is_lit() && tracer.is_moving(), "it waits to refine");
    assert!(tracer.shows_lit(), "the old picture stays");
    // The preview doesn't depend on light.
    wanted.integrator = INTEGRATORS[0];
    tracer.request(wanted.clone());
    collect_until(&mut tracer, |tracer| tracer.film().passes_done() > 0);
    let before = tracer.posted.as_ref().expect("posted").at;
    wanted.context.lighting.ao_distance = 0.25;
    tracer.request(wanted);
    assert_eq!(tracer.posted.as_ref().expect("posted").at, before);
}

/// Collects tiles until none has arrived for a while. Returns the samples of all pixels together.
fn samples_at_rest(tracer: &mut Tracer) -> u64 {
    let mut last = u64::MAX;
    loop {
        collect_until(tracer, |tracer| tracer.film().passes_done() > 0);
        let film = tracer.film();
        let pixels = (0..SIZE.element_product()).map(|k| UVec2::new(k % SIZE.x, k / SIZE.x));
        let samples = pixels
            .map(|pixel| u64::from(film.sample_count(pixel)))
            .sum();
        if samples == last {
            return samples;
        }
        last = samples;
        std::thread::sleep(Duration::from_millis(300));
    }
}

#[test]
fn refinement_ends_at_a_limit_and_goes_on_without_it() {
    let (mut tracer, scene) = (tracer(), ball());
    for (limits, reason) in [
        (
            Limits {
                noise: Some(1.0),
                secs: None,
            },
            StopReason::Noise,
        ),
        (
            Limits {
                noise: None,
                secs: Some(1e-9),
            },
            StopReason::Time,
        ),
    ] {
        tracer.set_limits(limits);
        tracer.request(lit(&scene, f64::from(reason as u8), 65536));
        collect_until(&mut tracer, |tracer| tracer.is_finished());
        assert_eq!(tracer.status().stopped, Some(reason));
        let stopped = samples_at_rest(&mut tracer);
        assert!(!tracer.film().is_complete(), "{stopped}");
        tracer.set_limits(Limits::default());
        assert!(!tracer.is_finished());
        collect_until(&mut tracer, |tracer| tracer.film().samples() >= 64);
        assert!(tracer.status().noise.is_some_and(|noise| noise.mean > 0.0));
    }
}

#[test]
fn the_time_limit_is_by_the_clock_and_needs_no_tile_to_arrive() {
    const LIMIT: Duration = Duration::from_secs(1);
    let (mut tracer, scene) = (tracer(), ball());
    tracer.request(lit(&scene, 0.0, 65536));
    collect_until(&mut tracer, |tracer| {
        tracer.is_lit() && tracer.film().passes_done() > 0
    });
    // No tile is collected meanwhile.
    std::thread::sleep(LIMIT);
    let limits = Limits {
        noise: None,
        secs: Some(LIMIT.as_secs_f64()),
    };
    tracer.set_limits(limits);
    assert_eq!(tracer.status().stopped, Some(StopReason::Time));
    assert!(tracer.is_finished() && !tracer.film().is_complete());
}
