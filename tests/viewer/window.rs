//! The built program in a real window: under Xvfb, with software Vulkan.

use crate::harness::{gpu, require};
use std::io::{BufRead as _, BufReader};
use std::process::{Child, Command, Output, Stdio};
use tempfile::TempDir;

/// A display of its own; gone when dropped.
pub struct Xvfb {
    server: Child,
    display: String,
}

impl Xvfb {
    /// A display without a window manager; `None` where Xvfb is missing and the test is to be skipped.
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
            .expect("Xvfb says its display");
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

    /// Has a program run on this display, with a folder for all its files.
    pub fn environment<'a>(&self, command: &'a mut Command, folder: &TempDir) -> &'a mut Command {
        command
            .current_dir(folder.path())
            .env("DISPLAY", &self.display)
            .env_remove("WAYLAND_DISPLAY")
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
    let output = folder.path().join("window.png");
    let ran = xvfb.hitscope(&folder, &["--after", "2", "--screenshot", "window.png"]);
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    let image = image::open(&output).expect("a PNG").to_rgba8();
    assert_eq!(image.dimensions(), (1200, 700));
    // The knot is orange, the gem blue, and both are to be seen.
    let count = |is: fn([u8; 4]) -> bool| image.pixels().filter(|pixel| is(pixel.0)).count();
    let orange =
        count(|[r, g, b, _]| r > 150 && r > g.saturating_add(25) && g > b.saturating_add(15));
    let blue =
        count(|[r, g, b, _]| b > 120 && b > g.saturating_add(15) && g > r.saturating_add(10));
    assert!(
        orange > 5000 && blue > 2000,
        "{orange} orange and {blue} blue pixels"
    );
}

#[test]
fn a_screenshot_of_what_can_not_be_loaded_fails_and_says_why() {
    if gpu().is_none() {
        return;
    }
    let Some(xvfb) = Xvfb::start() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let ran = xvfb.hitscope(&folder, &["none.obj", "--screenshot", "window.png"]);
    assert_eq!(ran.status.code(), Some(1));
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(said.contains("hitscope: none.obj: "), "{said}");
    assert!(!folder.path().join("window.png").exists());
}
