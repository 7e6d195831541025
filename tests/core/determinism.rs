//! The picture depends neither on the number of threads, nor on coarse passes, nor on earlier jobs.

use crate::golden::job;
use glam::UVec2;
use hitscope_core::Film;
use hitscope_core::camera::Projection;
use hitscope_core::integrator::INTEGRATORS;
use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::mesh::shapes::{Placement, sphere};
use hitscope_core::plan::{Plan, STEPS};
use hitscope_core::progress::Progress;
use hitscope_core::render::{Job, Message, Renderer, render, render_with_progress};
use hitscope_core::scene::{FirstTree, SceneOptions, Shading};
use hitscope_core::{Intersector, Scene};
use std::sync::Arc;

/// Several tiles, the last of them cropped.
const SIZE: UVec2 = UVec2::new(131, 101);

fn picture(view: &str, first_step: u32) -> Job {
    let projection = Projection::Perspective {
        fov_y_radians: 0.75,
    };
    job(
        view,
        Shading::Smooth,
        projection,
        Plan::new(SIZE, first_step, 4),
    )
}

fn rendered(job: Job, threads: usize) -> Vec<[u8; 4]> {
    render(job, threads).expect("no panic").pixels().to_vec()
}

/// Posts a job and collects its tiles until the picture is complete.
fn posted(renderer: &mut Renderer, job: Job) -> Vec<[u8; 4]> {
    let mut film = Film::new(job.plan.clone(), job.context.background);
    renderer.post(job);
    while !film.is_complete() {
        match renderer.wait_next() {
            Message::Tile(tile) => _ = film.add(tile.samples),
            Message::Panicked(_, panic) => panic!("{panic}"),
        }
    }
    film.pixels().to_vec()
}

#[test]
fn every_number_of_threads_renders_the_same_picture() {
    for view in INTEGRATORS {
        let alone = rendered(picture(view.name, 4), 1);
        for threads in [2, 5] {
            assert_eq!(
                rendered(picture(view.name, 4), threads),
                alone,
                "{} {threads}",
                view.name
            );
        }
    }
}

#[test]
fn the_final_picture_does_not_depend_on_the_first_passes_step() {
    let at_once = rendered(picture("shaded", 1), 2);
    assert!(at_once.iter().any(|pixel| *pixel != at_once[0]));
    for step in STEPS {
        assert_eq!(
            rendered(picture("shaded", step), 2),
            at_once,
            "first step {step}"
        );
    }
}

#[test]
fn earlier_jobs_do_not_affect_a_picture() {
    let mut renderer = Renderer::new(3, || ());
    let views = ["shaded", "depth", "cost"];
    let forwards = views.map(|view| posted(&mut renderer, picture(view, 8)));
    let mut backwards = views;
    backwards.reverse();
    let mut pictures = backwards.map(|view| posted(&mut renderer, picture(view, 8)));
    pictures.reverse();
    assert_eq!(forwards, pictures);
    let alone = views.map(|view| rendered(picture(view, 8), 1));
    assert_eq!(forwards, alone);
}

/// A picture of a large mesh, started with the given kind of tree.
fn large_picture(first_tree: FirstTree) -> Job {
    let options = SceneOptions {
        first_tree,
        ..SceneOptions::default()
    };
    let mesh = sphere(150, Placement::UNIT);
    let scene = Scene::with_options(mesh, options, &Progress::default()).expect("not cancelled");
    let scene = Arc::new(scene);
    let intersector: Arc<dyn Intersector> = scene.intersector(default_triangle_kernel()).into();
    let mut picture = picture("shaded", 4);
    picture.context.second = Arc::clone(&intersector);
    picture.context.intersector = intersector;
    picture.context.scene = scene;
    picture
}

#[test]
fn replacing_the_tree_during_rendering_does_not_change_the_picture() {
    let expected = rendered(large_picture(FirstTree::Best), 2);
    assert!(expected.iter().any(|pixel| *pixel != expected[0]));
    let job = large_picture(FirstTree::Quick);
    let scene = Arc::clone(&job.context.scene);
    assert!(!scene.has_best_tree());
    let found = std::thread::scope(|threads| {
        threads.spawn(|| scene.improve(&Progress::default()));
        rendered(job, 2)
    });
    assert!(scene.has_best_tree());
    assert!(found == expected);
}

#[test]
fn the_progress_of_a_picture_grows_from_tile_to_tile_to_all_of_it() {
    let job = picture("normal", 4);
    let units = job.plan.unit_count();
    let mut parts = Vec::new();
    let film = render_with_progress(job, 2, |part| parts.push(part)).expect("no panic");
    assert!(film.is_complete());
    assert_eq!(parts.len(), units);
    assert!(parts.is_sorted() && parts[0] > 0.0, "{parts:?}");
    assert_eq!(parts.last(), Some(&1.0));
}
