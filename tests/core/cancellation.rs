//! Stopping: stale jobs, dropped renderers, pauses, cancelled loads, panics.
//!
//! Anything that could block for ever runs in a thread of its own and fails after ten seconds.

use crate::golden::job;
use glam::UVec2;
use hitscope_core::bvh::OpenedBox;
use hitscope_core::camera::Projection;
use hitscope_core::intersector::{Cost, Crossing};
use hitscope_core::kernel::KernelInfo;
use hitscope_core::mesh::shapes::{Placement, torus};
use hitscope_core::obj::{self, LoadError, LoadOptions};
use hitscope_core::plan::{Pass, Plan, WorkUnit};
use hitscope_core::progress::Progress;
use hitscope_core::render::{Job, Message, RenderError, Renderer, render};
use hitscope_core::scene::Shading;
use hitscope_core::{Film, Hit, Intersector, Ray, Scene};
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::thread;
use std::time::Duration;

/// The longest that a test waits: much longer than rendering a pixel takes.
const PATIENCE: Duration = Duration::from_secs(10);

/// Runs `f` on another thread, and panics if it takes too long.
fn in_time<T: Send + 'static>(what: &str, f: impl FnOnce() -> T + Send + 'static) -> T {
    let (done, result) = channel();
    thread::spawn(move || _ = done.send(f()));
    let result = result.recv_timeout(PATIENCE);
    result.unwrap_or_else(|e| panic!("{what}: {e}"))
}

fn picture(view: &str, plan: Plan) -> Job {
    let projection = Projection::Perspective {
        fov_y_radians: 0.75,
    };
    job(view, Shading::Flat, projection, plan)
}

/// Calls `before` with each ray, then forwards to `inner`.
struct Before<F> {
    inner: Arc<dyn Intersector>,
    before: F,
}

impl<F: Fn(&Ray) + Send + Sync> Intersector for Before<F> {
    fn kernel(&self) -> &'static KernelInfo {
        self.inner.kernel()
    }
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        rays.iter().for_each(&self.before);
        self.inner.closest_hits(rays, hits);
    }
    fn closest_hit_with_cost(&self, ray: &Ray) -> (Option<Hit>, Cost) {
        (self.before)(ray);
        self.inner.closest_hit_with_cost(ray)
    }
    fn any_hits(&self, rays: &[Ray], are_hits: &mut [bool]) {
        rays.iter().for_each(&self.before);
        self.inner.any_hits(rays, are_hits);
    }
    fn all_hits(&self, ray: &Ray) -> Vec<Crossing> {
        (self.before)(ray);
        self.inner.all_hits(ray)
    }
    fn candidates(&self, ray: &Ray) -> Vec<u32> {
        self.inner.candidates(ray)
    }
    fn opened_boxes(&self, ray: &Ray) -> Vec<OpenedBox> {
        self.inner.opened_boxes(ray)
    }
    fn count_hits(&self, ray: &Ray) -> usize {
        self.inner.count_hits(ray)
    }
    fn bytes(&self) -> usize {
        self.inner.bytes()
    }
}

fn with_before(mut job: Job, before: impl Fn(&Ray) + Send + Sync + 'static) -> Job {
    let inner = Arc::clone(&job.context.intersector);
    job.context.intersector = Arc::new(Before { inner, before });
    job
}

/// A job that takes 8 ms per pixel and 18 s per tile, and sends a message per ray.
fn slow_picture(started: Sender<()>) -> Job {
    with_before(
        picture("shaded", Plan::new(UVec2::splat(480), 1, 1)),
        move |_| {
            _ = started.send(());
            thread::sleep(Duration::from_millis(8));
        },
    )
}

/// Collects messages until the picture is complete, first polling, then blocking. Asserts that each work unit
/// arrives once and has the right size.
fn complete(renderer: &Renderer, job: &Job) -> Film {
    let mut film = Film::new(job.plan.clone(), job.context.background);
    let mut seen: Vec<WorkUnit> = Vec::new();
    while !film.is_complete() {
        let message = renderer.try_next();
        let Message::Tile(tile) = message.unwrap_or_else(|| renderer.wait_next()) else {
            panic!("nothing panics here");
        };
        let unit = tile.samples.unit;
        assert!(unit.pass < job.plan.pass_count() && unit.tile < job.plan.tile_count());
        assert_eq!(tile.samples.sums.len(), job.plan.pixels(unit).count());
        assert!(!seen.contains(&unit), "{unit:?} came twice");
        seen.push(unit);
        film.add(tile.samples);
    }
    film
}

#[test]
fn after_a_cancel_no_tile_arrives_until_another_job_is_posted() {
    let job = picture("normal", Plan::new(UVec2::new(97, 61), 4, 4));
    in_time("the job after the cancel", move || {
        let mut renderer = Renderer::new(2, || ());
        renderer.post(job.clone());
        _ = renderer.wait_next();
        renderer.cancel();
        thread::sleep(Duration::from_millis(50));
        assert!(renderer.try_next().is_none());
        renderer.post(job.clone());
        complete(&renderer, &job);
    });
}

#[test]
fn after_a_new_job_is_posted_no_tile_of_the_old_one_arrives() {
    let old = picture("normal", Plan::new(UVec2::new(400, 300), 8, 16));
    let new = picture("shaded", Plan::new(UVec2::new(97, 61), 4, 2));
    let expected = render(new.clone(), 1).expect("no panic");
    let pictures = in_time("the newest job", move || {
        let mut renderer = Renderer::new(3, || ());
        // After no, some and many tiles of the old job.
        [0, 1, 5, 60].map(|taken| {
            renderer.post(old.clone());
            (0..taken).for_each(|_| _ = renderer.wait_next());
            renderer.post(new.clone());
            complete(&renderer, &new)
        })
    });
    for film in pictures {
        assert_eq!(film.pixels(), expected.pixels());
    }
}

#[test]
fn a_stale_job_is_abandoned_within_a_row_of_pixels() {
    let (started, has_started) = channel();
    in_time("a new job after a slow one", move || {
        let mut renderer = Renderer::new(1, || ());
        renderer.post(slow_picture(started));
        has_started.recv().expect("it starts");
        let new = picture("shaded", Plan::new(UVec2::new(20, 10), 1, 1));
        renderer.post(new.clone());
        complete(&renderer, &new);
    });
}

#[test]
fn a_renderer_dropped_in_the_middle_of_a_tile_ends_its_threads() {
    let (started, has_started) = channel();
    in_time("dropping", move || {
        let mut renderer = Renderer::new(2, || ());
        renderer.post(slow_picture(started));
        has_started.recv().expect("it starts");
        drop(renderer);
    });
}

#[test]
fn a_renderer_dropped_while_its_channel_is_full_ends_its_threads() {
    let (wake, woken) = channel();
    in_time("dropping", move || {
        let mut renderer = Renderer::new(2, move || _ = wake.send(()));
        renderer.post(picture("triangle", Plan::new(UVec2::splat(1500), 16, 4096)));
        // Once no tile has been sent for a while, the channel is full and both threads are blocked.
        woken.recv().expect("a first tile");
        let sent =
            1 + std::iter::from_fn(|| woken.recv_timeout(Duration::from_millis(300)).ok()).count();
        assert!(
            sent < 961,
            "the channel holds a whole pass of 32 × 32 tiles: {sent}"
        );
        drop(renderer);
    });
}

#[test]
fn a_pause_renders_the_first_pass_and_holds_the_rest_until_resumed() {
    let job = picture("shaded", Plan::new(UVec2::new(150, 100), 8, 4));
    let expected = render(job.clone(), 1).expect("no panic");
    let film = in_time("pause and resume", move || {
        // One thread: each of several might have started a tile of the next pass.
        let mut renderer = Renderer::new(1, || ());
        renderer.pause();
        renderer.post(job.clone());
        let mut film = Film::new(job.plan.clone(), job.context.background);
        for _ in 0..job.plan.tile_count() {
            let Message::Tile(tile) = renderer.wait_next() else {
                panic!("nothing panics here");
            };
            assert_eq!(tile.samples.unit.pass, 0);
            film.add(tile.samples);
        }
        // The whole picture takes about 20 ms.
        thread::sleep(Duration::from_millis(200));
        assert!(renderer.try_next().is_none(), "a later pass while paused");
        assert_eq!(film.passes_done(), 1);

        renderer.resume();
        while !film.is_complete() {
            if let Message::Tile(tile) = renderer.wait_next() {
                film.add(tile.samples);
            }
        }
        film
    });
    assert_eq!(film.pixels(), expected.pixels());
}

#[test]
fn a_panic_is_reported_with_its_pixel_and_sample_and_the_other_tiles_arrive() {
    // The last sample of a pixel in the second row of tiles.
    let (pixel, sample) = (UVec2::new(70, 60), 3);
    let job = picture("shaded", Plan::new(UVec2::new(131, 101), 4, 4));
    let fatal = job.context.camera.ray(pixel, Plan::position(pixel, sample));
    let kernel = job.context.intersector.kernel().name;
    let bad = with_before(job.clone(), move |ray| {
        assert!(*ray != fatal, "a ray to fail at");
    });
    let (panics, tiles) = in_time("a job that panics", move || {
        let mut renderer = Renderer::new(2, || ());
        renderer.post(bad.clone());
        let (mut panics, mut tiles) = (Vec::new(), Vec::new());
        for _ in 0..bad.plan.unit_count() {
            match renderer.wait_next() {
                Message::Tile(tile) => tiles.push(tile.samples.unit),
                Message::Panicked(_, panic) => panics.push(panic),
            }
        }
        // The threads are still alive.
        let good = picture("shaded", Plan::new(UVec2::new(60, 50), 1, 1));
        renderer.post(good.clone());
        complete(&renderer, &good);
        (panics, tiles)
    });

    let [panic] = &panics[..] else {
        panic!("one panic expected: {panics:?}");
    };
    assert_eq!(
        (panic.pixel, panic.sample, panic.kernel),
        (pixel, sample, kernel)
    );
    assert!(
        panic.message.contains("a ray to fail at"),
        "{}",
        panic.message
    );
    let command = format!("--pixel 70,60 --kernel {kernel}");
    assert!(panic.to_string().contains(&command), "{panic}");

    // Only the tile with that pixel, in the pass with that sample, is missing.
    let units = (0..job.plan.unit_count()).map(|k| job.plan.unit(k));
    let missing: Vec<WorkUnit> = units.filter(|unit| !tiles.contains(unit)).collect();
    let [missing] = missing[..] else {
        panic!("one tile is missing: {missing:?}");
    };
    assert_eq!(
        job.plan.pass(missing.pass),
        Pass::Samples { first: 2, count: 2 }
    );
    assert!(job.plan.pixels(missing).any(|p| p == pixel));
}

#[test]
fn rendering_returns_a_panic_as_an_error() {
    let job = picture("shaded", Plan::new(UVec2::splat(30), 1, 1));
    let bad = with_before(job, |_| panic!("no ray works"));
    let error = in_time("a picture that panics", move || render(bad, 2).err());
    let Some(RenderError::Panic(panic)) = error else {
        panic!("{error:?}");
    };
    assert_eq!(panic.message, "no ray works");
}

/// An endless file whose reader cancels the load after a megabyte.
struct Endless {
    progress: Arc<Progress>,
    given: usize,
}

impl Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        const LINE: &[u8] = b"v 1 2 3\n";
        for (k, byte) in buffer.iter_mut().enumerate() {
            *byte = LINE[(self.given + k) % LINE.len()];
        }
        self.given += buffer.len();
        if self.given > 1 << 20 {
            self.progress.cancel();
        }
        Ok(buffer.len())
    }
}

fn parse(bytes: impl Read, progress: &Progress) -> Result<obj::Loaded, LoadError> {
    let no_library = |_: &str| Err(io::ErrorKind::NotFound.into());
    obj::parse(
        bytes,
        Path::new("x.obj"),
        LoadOptions::default(),
        &no_library,
        progress,
    )
}

#[test]
fn cancelling_the_load_of_an_endless_file_returns_an_error() {
    let result = in_time("a cancelled load", || {
        let progress = Arc::new(Progress::default());
        let endless = Endless {
            progress: Arc::clone(&progress),
            given: 0,
        };
        parse(endless, &progress).map(|loaded| loaded.report.vertex_count)
    });
    let is_cancelled =
        matches!(&result, Err(LoadError::Cancelled { path }) if path == Path::new("x.obj"));
    assert!(is_cancelled, "{result:?}");
}

#[test]
fn a_load_cancelled_before_its_start_returns_an_error() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let progress = Progress::default();
    assert!(parse(text.as_bytes(), &progress).is_ok());
    progress.cancel();
    let result = parse(text.as_bytes(), &progress);
    assert!(
        matches!(result, Err(LoadError::Cancelled { .. })),
        "{result:?}"
    );
}

#[test]
fn cancelling_before_tree_construction_returns_an_error() {
    let progress = Progress::default();
    progress.cancel();
    assert!(Scene::new(torus(8, 8, Placement::UNIT), &progress).is_err());
}
