//! Tests of unusable graphics backends and display servers in the environment: the next one is tried, with a
//! warning.

use crate::harness::{gpu, require};
use crate::window::Xvfb;
use std::process::{Command, Output};
use tempfile::TempDir;

/// Hides all drivers from Vulkan's loader.
const NO_VULKAN: [(&str, &str); 2] = [
    ("VK_DRIVER_FILES", "/nonexistent"),
    ("VK_ICD_FILENAMES", "/nonexistent"),
];

/// Renders a triangle with its edges to `out.png`, without a window.
fn render_wireframe(folder: &TempDir, environment: &[(&str, &str)]) -> Output {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::write(folder.path().join("mesh.obj"), triangle).expect("written");
    let line = "render mesh.obj -o out.png --size 64x48 --samples 1 --wireframe";
    Command::new(env!("CARGO_BIN_EXE_hitscope"))
        .args(line.split(' '))
        .current_dir(folder.path())
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env_remove("WGPU_BACKEND")
        .envs(environment.iter().copied())
        .output()
        .expect("the program runs")
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn picture(folder: &TempDir) -> image::RgbaImage {
    let path = folder.path().join("out.png");
    let picture = image::open(&path).expect("a PNG").to_rgba8();
    std::fs::remove_file(path).expect("removed");
    picture
}

/// A backend that this operating system doesn't have.
const FOREIGN_BACKEND: &str = if cfg!(target_os = "macos") {
    "dx12"
} else {
    "metal"
};

#[test]
fn an_unusable_backend_gives_a_warning_and_the_next_one_is_used() {
    if gpu().is_none() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let usual = render_wireframe(&folder, &[]);
    assert!(usual.status.success(), "{}", stderr(&usual));
    assert!(!stderr(&usual).contains("WGPU_BACKEND"));
    let expected = picture(&folder);
    for (value, warning) in [
        ("", "it names no graphics backend"),
        ("glide", "“glide” isn't a graphics backend"),
        (FOREIGN_BACKEND, "WGPU_BACKEND can't be used"),
    ] {
        let output = render_wireframe(&folder, &[("WGPU_BACKEND", value)]);
        assert!(output.status.success(), "{value:?}: {}", stderr(&output));
        assert!(
            stderr(&output).contains(warning),
            "{value:?}: {}",
            stderr(&output)
        );
        assert!(picture(&folder) == expected, "{value:?}");
    }
}

#[test]
fn lines_are_drawn_with_opengl_if_there_is_no_vulkan() {
    let folder = tempfile::tempdir().expect("a folder");
    let [a, b] = NO_VULKAN;
    let asked_for = render_wireframe(&folder, &[a, b, ("WGPU_BACKEND", "gl")]);
    if !require(
        "OpenGL (Mesa's llvmpipe will do)",
        asked_for.status.success(),
    ) {
        return;
    }
    let expected = picture(&folder);
    let unasked = render_wireframe(&folder, &NO_VULKAN);
    assert!(unasked.status.success(), "{}", stderr(&unasked));
    assert!(picture(&folder) == expected);
}

/// Opens a window and saves a screenshot. Returns the program's stderr.
fn window(xvfb: &Xvfb, environment: &[(&str, &str)]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::new(env!("CARGO_BIN_EXE_hitscope"));
    let command = xvfb.environment(&mut command, &folder);
    command.args(["--after", "0", "--screenshot", "window.png"]);
    command.envs(environment.iter().copied());
    let output = command.output().expect("the program runs");
    let said = stderr(&output);
    assert!(output.status.success(), "{environment:?}: {said}");
    let size = image::image_dimensions(folder.path().join("window.png"));
    assert_eq!(size.expect("a PNG"), (1200, 700), "{environment:?}");
    said
}

#[test]
fn the_window_opens_on_the_next_display_server_and_backend() {
    if gpu().is_none() {
        return;
    }
    let Some(xvfb) = Xvfb::start() else { return };
    assert_eq!(window(&xvfb, &[("WAYLAND_DISPLAY", "")]), "");
    let said = window(&xvfb, &[("WAYLAND_DISPLAY", "wayland-none")]);
    assert!(
        said.starts_with("hitscope: WAYLAND_DISPLAY=wayland-none can't be used: "),
        "{said}"
    );
    assert!(said.ends_with("; using DISPLAY\n"), "{said}");
    let said = window(&xvfb, &[("WGPU_BACKEND", "")]);
    assert!(
        said.contains("WGPU_BACKEND is partly or wholly ignored"),
        "{said}"
    );
    let said = window(&xvfb, &[("WGPU_BACKEND", FOREIGN_BACKEND)]);
    assert!(said.contains("WGPU_BACKEND can't be used"), "{said}");
}

#[test]
fn unresponsive_servers_are_named_and_a_picture_is_written_to_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = Command::new(env!("CARGO_BIN_EXE_hitscope"))
        .current_dir(folder.path())
        .env("DISPLAY", ":4242")
        .env("WAYLAND_DISPLAY", "wayland-none")
        .env("XDG_RUNTIME_DIR", folder.path())
        .env("XDG_DATA_HOME", folder.path())
        .env_remove("WAYLAND_SOCKET")
        .output()
        .expect("the program runs");
    let said = stderr(&output);
    assert!(output.status.success(), "{said}");
    assert!(
        said.contains("can't open a window: WAYLAND_DISPLAY=wayland-none can't be used: "),
        "{said}"
    );
    assert!(said.contains("; DISPLAY=:4242 can't be used: "), "{said}");
    assert!(!said.contains(".rs:"), "{said}");
    assert!(folder.path().join("hitscope.png").exists());
}
