//! Measures loading an OBJ file with hitscope and with tobj.
//!
//! `cargo run --release -p hitscope-core --example load -- [hitscope|tobj|cancel] FILE.obj`
//! prints JSON with the seconds and the peak memory of one of them, so that each runs in its own process.
//! `cancel` cancels loading at several times, the tree's construction included, and prints how long it took
//! to stop.

use hitscope_core::loading::LoadedScene;
use hitscope_core::obj::{self, LoadOptions};
use hitscope_core::progress::Progress;
use hitscope_core::scene::{FirstTree, SceneOptions};
use std::path::Path;
use std::time::{Duration, Instant};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [who, file] = &arguments[..] else {
        return Err("expected hitscope, tobj or cancel, and a file".into());
    };
    let path = Path::new(file);
    let start = Instant::now();
    let triangles = match who.as_str() {
        "hitscope" => obj::load(path, LoadOptions::default(), &Progress::default())?
            .mesh
            .triangles()
            .len(),
        "tobj" => bare_tobj(path)?,
        "cancel" => return cancel(path),
        other => return Err(format!("unknown mode {other}").into()),
    };
    let secs = start.elapsed().as_secs_f64();
    let peak = peak_rss_bytes().map_or("null".to_owned(), |bytes| bytes.to_string());
    out(&format!(
        r#"{{"who":"{who}","triangles":{triangles},"seconds":{secs},"peak_rss_bytes":{peak}}}"#
    ));
    Ok(())
}

fn bare_tobj(path: &Path) -> Result<usize, tobj::LoadError> {
    let options = tobj::LoadOptions {
        single_index: false,
        ..tobj::LoadOptions::default()
    };
    let (models, _) = tobj::load_obj(path, &options)?;
    let corners = models.iter().map(|model| model.mesh.indices.len());
    Ok(corners.sum::<usize>() / 3)
}

/// Cancels at ten times, spread evenly over the duration of a load.
fn cancel(path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let options = SceneOptions {
        first_tree: FirstTree::Quick,
        ..SceneOptions::default()
    };
    let load =
        |progress: &Progress| LoadedScene::load(path, LoadOptions::default(), options, progress);
    let start = Instant::now();
    drop(load(&Progress::default())?);
    let whole = start.elapsed();
    for tenth in 0..10u32 {
        let progress = Progress::default();
        let wait = whole * tenth / 10 + Duration::from_millis(1);
        let took = std::thread::scope(|threads| {
            let loading = threads.spawn(|| load(&progress).is_err());
            std::thread::sleep(wait);
            let cancelled = Instant::now();
            progress.cancel();
            let is_cancelled = loading.join().expect("loading doesn't panic");
            (is_cancelled, cancelled.elapsed())
        });
        let (is_cancelled, millis) = (took.0, took.1.as_secs_f64() * 1e3);
        let after = wait.as_secs_f64();
        out(&format!(
            r#"{{"cancelled_after":{after},"is_cancelled":{is_cancelled},"milliseconds":{millis}}}"#
        ));
    }
    Ok(())
}

#[expect(clippy::print_stdout, reason = "printing is this program's purpose")]
fn out(line: &str) {
    println!("{line}");
}

/// Peak resident memory of the process; `None` except on Linux.
fn peak_rss_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}
