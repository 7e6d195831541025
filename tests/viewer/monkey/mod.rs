//! Random actions cause no panic and no error of the graphics device, and closing the window frees the memory.
//!
//! `HITSCOPE_MONKEY=10000` sets the number of actions, and checks the memory that each window leaves against that of the
//! first one; `HITSCOPE_MONKEY_SEED=7` sets the seed. Each window gets at most [`PER_WINDOW`] actions, and the next seed.

mod actions;
mod files;
mod inputs;

pub use files::grid;

use crate::alone::{alone, memory_below, memory_mb, panics};
use crate::harness::{Window, app, gpu, press, say, settle, shared_setup, wait};
use actions::Monkey;
use egui::Key;
use hitscope::app::{App, StartOptions};
use std::path::Path;
use std::time::Instant;

/// Actions of an ordinary run; a few seconds.
const FEW: usize = 120;
/// The most actions in one window.
const PER_WINDOW: usize = 2500;
/// Memory may grow by this factor. The process has some 160 MB after the first window.
const GROWTH: f64 = 1.05;

fn number(variable: &str) -> Option<usize> {
    std::env::var(variable).ok()?.parse().ok()
}

/// A window with the built-in scene.
fn window() -> Option<Window> {
    let gpu = gpu()?;
    let window = egui_kittest::Harness::builder()
        .with_size(egui::vec2(800.0, 600.0))
        .with_step_dt(1.0 / 60.0)
        .with_render_cursor(false)
        .allow_missing_glyphs()
        .wgpu_setup(shared_setup(gpu))
        .build_eframe(|cc| App::new(cc, StartOptions::default()).expect("the harness has wgpu"));
    Some(window)
}

/// Does random things in a new window, and closes it.
fn play(seed: u64, count: usize, folder: &Path) -> Option<()> {
    let mut window = window()?;
    let mut monkey = Monkey::new(seed, folder);
    for _ in 0..count {
        monkey.act(&mut window);
        assert_eq!(panics(), 0);
        assert_eq!(window.state().graphics_errors(), 0);
    }
    Some(())
}

fn require_memory_back(before: f64, after: f64) {
    assert!(
        after <= GROWTH * before,
        "{before:.1} MB before, {after:.1} MB after"
    );
}

#[test]
fn random_actions_cause_no_panic_or_gpu_error() {
    let name = "monkey::random_actions_cause_no_panic_or_gpu_error";
    alone(name, |folder| {
        let count = number("HITSCOPE_MONKEY").unwrap_or(FEW);
        let seed = number("HITSCOPE_MONKEY_SEED").unwrap_or(1) as u64;
        let per_window = PER_WINDOW.min(count.div_ceil(2));
        let (mut window_seed, mut done, mut first) = (seed, 0, None);
        while done < count {
            let start = Instant::now();
            let actions = per_window.min(count - done);
            (window_seed, done) = (window_seed + 1, done + actions);
            if play(window_seed, actions, folder).is_none() {
                return;
            }
            let secs = start.elapsed().as_secs();
            // Only in a measurement: it waits for the allocator.
            if number("HITSCOPE_MONKEY").is_none() {
                continue;
            }
            let after = memory_below(first.unwrap_or(0.0));
            say(&format!(
                "seed {window_seed}: {actions} actions in {secs} s; {after:.1} MB are left"
            ));
            // The first window compiles shaders, and fills the blocks of GPU memory of a software adapter.
            require_memory_back(*first.get_or_insert(after), after);
        }
    });
}

#[test]
fn opening_and_closing_a_hundred_files_keeps_none_of_them() {
    alone(
        "monkey::opening_and_closing_a_hundred_files_keeps_none_of_them",
        |folder| {
            let Some(mut window) = app(None) else { return };
            press(&mut window, Key::W);
            let files: Vec<_> = (0..4)
                .map(|k| grid(folder, &format!("grid-{k}.obj"), 60 + k))
                .collect();
            let open = |window: &mut Window, k: usize| {
                let path = files[k % files.len()].clone();
                let name = path
                    .file_name()
                    .expect("a file")
                    .to_string_lossy()
                    .into_owned();
                crate::app::drop_file(window, path);
                wait(window, &name, |app| {
                    app.document().name() == name && app.film().samples() > 0
                });
                window.run_steps(3);
            };
            for k in 0..12 {
                open(&mut window, k);
            }
            settle(&mut window, "grid-3.obj");
            let before = memory_mb().unwrap_or(0.0);
            for k in 0..100 {
                open(&mut window, k);
            }
            settle(&mut window, "grid-3.obj");
            let after = memory_below(GROWTH * before);
            say(&format!(
                "memory before {before:.1} MB, after 100 files {after:.1} MB"
            ));
            require_memory_back(before, after);
            assert_eq!((panics(), window.state().graphics_errors()), (0, 0));
        },
    );
}
