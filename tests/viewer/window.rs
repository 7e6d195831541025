//! Tests of the program in a real window, under Xvfb with software Vulkan.

use crate::harness::{app_on, gpu, require, shared_setup, wait};
use egui_kittest::kittest::Queryable as _;
use hitscope::app::App;
use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Output, Stdio};
use tempfile::TempDir;

/// A separate display, which is closed when dropped.
pub struct Xvfb {
    server: Child,
    display: String,
}

impl Xvfb {
    /// A display without a window manager; `None` if Xvfb is missing and the test is skipped.
    pub fn start() -> Option<Self> {
        let server = Command::new("Xvfb")
            .args([
                "-displayfd",
                "1",
                "-screen",
                "0",
                "1400x900x24",
                "-nolisten",
                "tcp",
                // Without this, the server resets when its last client disconnects, and refuses connections meanwhile.
                "-noreset",
            ])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn();
        require("Xvfb", server.is_ok()).then_some(())?;
        let mut server = server.ok()?;
        let mut number = String::new();
        let stdout = server.stdout.take().expect("piped");
        BufReader::new(stdout)
            .read_line(&mut number)
            .expect("Xvfb prints its display");
        Some(Self {
            server,
            display: format!(":{}", number.trim()),
        })
    }

    /// Runs the program on this display until it ends by itself.
    fn hitscope(&self, folder: &TempDir, args: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hitscope"));
        let command = self.environment(&mut command, folder).args(args);
        command.output().expect("the program runs")
    }

    /// Sets up a program to run on this display, with a folder for all its files.
    pub fn environment<'a>(&self, command: &'a mut Command, folder: &TempDir) -> &'a mut Command {
        command
            .current_dir(folder.path())
            .env("DISPLAY", &self.display)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .env("XDG_RUNTIME_DIR", folder.path())
            .env("XDG_DATA_HOME", folder.path())
    }
}

impl Drop for Xvfb {
    fn drop(&mut self) {
        _ = self.server.kill();
        _ = self.server.wait();
    }
}

#[test]
fn the_window_opens_and_its_screenshot_shows_the_scene() {
    if gpu().is_none() {
        return;
    }
    let Some(xvfb) = Xvfb::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let ran = xvfb.hitscope(&folder, &["--screenshot", "window.png"]);
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    let image = image::open(folder.path().join("window.png")).expect("a PNG");
    let image = image.to_rgba8();
    assert_eq!(image.dimensions(), (1200, 700));
    // The expected picture, from a window of the same size in this process.
    let Some(gpu) = gpu() else { return };
    let mut window = app_on(shared_setup(gpu), None, egui::vec2(1200.0, 700.0), 1.0);
    wait(&mut window, "all samples", App::is_settled);
    let film = window.state().film();
    let corner = window.get_by_label("Rendered picture").rect().min;
    let size = film.size();
    // Beside the menus.
    let fill = window.ctx.global_style().visuals.panel_fill.to_array();
    assert_eq!(image.get_pixel(1000, 10).0, fill, "the panels' colour");
    let cropped =
        image::imageops::crop_imm(&image, corner.x as u32, corner.y as u32, size.x, size.y);
    let shown: Vec<[u8; 4]> = cropped.to_image().pixels().map(|pixel| pixel.0).collect();
    assert!(shown == film.pixels(), "a different picture of {size}");
}

#[test]
fn a_screenshot_of_the_first_picture_tells_the_time_to_it() {
    if gpu().is_none() {
        return;
    }
    let Some(xvfb) = Xvfb::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::write(folder.path().join("mesh.obj"), mesh).expect("written");
    let began = std::time::Instant::now();
    let line = ["mesh.obj", "--screenshot", "window.png", "--after", "first"];
    let ran = xvfb.hitscope(&folder, &line);
    let lasted = began.elapsed().as_secs_f64();
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{said}");
    let printed = String::from_utf8_lossy(&ran.stdout).into_owned();
    let time = printed.strip_prefix("first picture after ");
    let time = time.and_then(|time| time.strip_suffix(" s\n"));
    let seconds: f64 = time.and_then(|time| time.parse().ok()).expect(&printed);
    assert!(seconds > 0.0 && seconds < lasted, "{seconds} of {lasted}");
    // The triangle is in the middle of the picture.
    let image = image::open(folder.path().join("window.png")).expect("a PNG");
    let colours: std::collections::HashSet<[u8; 4]> =
        image.to_rgba8().pixels().map(|pixel| pixel.0).collect();
    assert!(colours.len() > 2);
}

#[test]
fn a_screenshot_of_an_unreadable_file_fails_with_a_reason() {
    if gpu().is_none() {
        return;
    }
    let Some(xvfb) = Xvfb::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let bad = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n";
    std::fs::write(folder.path().join("bad.obj"), bad).expect("written");
    for (line, reason) in [
        ("none.obj --screenshot window.png", "hitscope: none.obj: "),
        (
            "none.obj --screenshot window.png --after 1",
            "hitscope: none.obj: ",
        ),
        (
            "bad.obj --screenshot window.png --after 3",
            "bad.obj:4: no faces left",
        ),
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let ran = xvfb.hitscope(&folder, &arguments);
        let said = String::from_utf8_lossy(&ran.stderr);
        assert_eq!(ran.status.code(), Some(1), "{line}: {said}");
        assert!(said.contains(reason), "{line}: {said}");
        assert!(!folder.path().join("window.png").exists());
    }
}
