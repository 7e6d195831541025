//! The app in a test harness, and the gate for tests that need a GPU.

use eframe::egui_wgpu::{WgpuSetup, WgpuSetupExisting};
use egui::{Event, Key, Modifiers, PointerButton, Pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use hitscope::app::{App, StartOptions};
use hitscope::gpu::adapter::Gpu;
use hitscope::preferences::Preferences;
use hitscope::settings::Settings;
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// The app in a harness that replaces the window.
pub type Window = Harness<'static, App>;

/// Whether a test that needs something can run. If not, the test is skipped with a message; with
/// `HITSCOPE_REQUIRE_GPU=1` it fails.
pub fn require(what: &str, is_there: bool) -> bool {
    if !is_there {
        let is_required = std::env::var_os("HITSCOPE_REQUIRE_GPU").is_some_and(|v| v == "1");
        assert!(
            !is_required,
            "HITSCOPE_REQUIRE_GPU=1, but there is no {what}"
        );
        say(&format!("SKIPPED: this test needs {what}"));
    }
    is_there
}

/// Prints to the terminal directly: the test runner hides the output of passing tests.
pub fn say(text: &str) {
    _ = writeln!(std::io::stderr(), "{text}");
}

/// Writes a file of a folder. Returns its path.
pub fn write(folder: &tempfile::TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("written");
    path
}

/// The device that all tests share, or `None` if the test is skipped. It is never closed.
pub fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    let gpu = GPU.get_or_init(|| Gpu::open().ok()).as_ref();
    require(
        "a graphics adapter (Mesa's software Vulkan will do)",
        gpu.is_some(),
    );
    gpu
}

/// The shared device as a harness's setup.
pub fn shared_setup(gpu: &Gpu) -> WgpuSetup {
    WgpuSetup::Existing(WgpuSetupExisting {
        instance: gpu.instance.clone(),
        adapter: gpu.adapter.clone(),
        device: gpu.device.clone(),
        queue: gpu.queue.clone(),
    })
}

/// The app in a window of 800 × 600 points, after its first picture.
pub fn app(file: Option<PathBuf>) -> Option<Harness<'static, App>> {
    app_scaled(file, 1.0)
}

/// Like [`app`] at another scale of the window.
pub fn app_scaled(file: Option<PathBuf>, pixels_per_point: f32) -> Option<Harness<'static, App>> {
    let gpu = gpu()?;
    let size = egui::vec2(800.0, 600.0);
    Some(app_on(shared_setup(gpu), file, size, pixels_per_point))
}

/// Like [`app_scaled`] on another device, in a window of this size.
pub fn app_on(
    setup: WgpuSetup,
    file: Option<PathBuf>,
    size: egui::Vec2,
    pixels_per_point: f32,
) -> Window {
    let start = StartOptions {
        file,
        ..StartOptions::default()
    };
    started(setup, start, size, pixels_per_point)
}

/// A device of the shared adapter with these limits. It is never closed.
pub fn limited_device(limits: wgpu::Limits) -> Option<(wgpu::Device, wgpu::Queue)> {
    let descriptor = wgpu::DeviceDescriptor {
        required_limits: limits,
        ..wgpu::DeviceDescriptor::default()
    };
    let made = pollster::block_on(gpu()?.adapter.request_device(&descriptor));
    let (device, queue) = made.expect("the adapter gives another device");
    std::mem::forget((device.clone(), queue.clone()));
    Some((device, queue))
}

/// A window of 800 × 600 points on its own device, and the device; `None` if the test is skipped.
pub fn app_on_own_device() -> Option<(Window, wgpu::Device)> {
    let (device, queue) = limited_device(wgpu::Limits::default())?;
    let gpu = gpu()?;
    let setup = WgpuSetup::Existing(WgpuSetupExisting {
        instance: gpu.instance.clone(),
        adapter: gpu.adapter.clone(),
        device: device.clone(),
        queue,
    });
    let window = app_on(setup, None, egui::vec2(800.0, 600.0), 1.0);
    Some((window, device))
}

/// The app with these settings, in a window of 800 × 600 points, after its first picture.
pub fn app_with(settings: Settings) -> Option<Window> {
    let start = StartOptions {
        settings,
        ..StartOptions::default()
    };
    app_started(start)
}

/// Like [`app_with`] without the side panel.
pub fn bare_with(settings: Settings) -> Option<Window> {
    app_started(StartOptions {
        settings,
        preferences: Preferences {
            shows_panel: false,
            ..Preferences::default()
        },
        ..StartOptions::default()
    })
}

/// The app with these options, in a window of 800 × 600 points, after its first picture.
pub fn app_started(start: StartOptions) -> Option<Window> {
    let gpu = gpu()?;
    let size = egui::vec2(800.0, 600.0);
    Some(started(shared_setup(gpu), start, size, 1.0))
}

fn started(
    setup: WgpuSetup,
    mut start: StartOptions,
    size: egui::Vec2,
    pixels_per_point: f32,
) -> Window {
    // Tests of animated changes of the view and of the axis gizmo, which covers pixels, turn them on.
    start.preferences.navigation.reduces_motion = true;
    start.preferences.navigation.shows_gizmo = false;
    let mut harness = Harness::builder()
        .with_size(size)
        .with_pixels_per_point(pixels_per_point)
        // At screen frame rates, so that a double click is two clicks within 0.3 s.
        .with_step_dt(1.0 / 60.0)
        .with_render_cursor(false)
        .wgpu_setup(setup)
        .build_eframe(move |cc| App::new(cc, start).expect("the harness has wgpu"));
    wait(&mut harness, "the first picture", |app| {
        app.film().passes_done() > 0
    });
    harness
}

/// A test that waits longer has failed, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(300);

/// Draws frames until a condition holds; panics after [`PATIENCE`].
pub fn wait(harness: &mut Harness<'_, App>, what: &str, is_so: impl Fn(&App) -> bool) {
    let start = Instant::now();
    harness.step();
    while !is_so(harness.state()) {
        assert!(start.elapsed() < PATIENCE, "timed out waiting for {what}");
        std::thread::sleep(Duration::from_millis(5));
        harness.step();
    }
}

/// Draws frames until the document of this name is open and its picture is complete.
pub fn settle(window: &mut Window, name: &str) {
    wait(window, name, |app| {
        app.document().name() == name && app.is_settled()
    });
    window.run_steps(2);
}

/// A point of the picture, from its top left (0, 0) to its bottom right (1, 1).
pub fn in_picture(harness: &Harness<'_, App>, x: f32, y: f32) -> Pos2 {
    let rect = harness.get_by_label("Rendered picture").rect();
    rect.lerp_inside(egui::vec2(x, y))
}

/// The window without its side panel, whose labels would duplicate those of the tool bar.
pub fn bare() -> Option<Window> {
    let mut window = app(None)?;
    press(&mut window, Key::I);
    window.run_steps(20);
    assert!(!window.state().preferences().shows_panel);
    Some(window)
}

/// Presses and releases a key.
pub fn press(window: &mut Window, key: Key) {
    window.key_press(key);
    window.run_steps(2);
}

/// Runs the command whose title fits these words best, by the command palette.
pub fn run_command(window: &mut Window, words: &str) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::P);
    window.run_steps(4);
    window.event(Event::Text(words.to_owned()));
    window.run_steps(3);
    window.key_press(Key::Enter);
    window.run_steps(3);
}

/// Chooses a view in the tool bar of a window without its side panel.
pub fn choose_view(window: &mut Window, title: &str) {
    let combo = window.get_by_role(egui::accesskit::Role::ComboBox);
    combo.click();
    window.run_steps(2);
    let entry = window.get_all_by_label(title).last();
    entry.expect("in the menu").click();
    window.run_steps(2);
}

/// Chooses a kernel by its text in the list of the Display tab, which must be open.
pub fn choose_kernel(window: &mut Window, text: &str) {
    let combo = window
        .get_all_by_role(egui::accesskit::Role::ComboBox)
        .last()
        .expect("of kernels");
    combo.click();
    window.run_steps(2);
    window.get_by_label(text).click();
}

/// Presses or releases a pointer button.
pub fn pointer(
    window: &Window,
    pos: Pos2,
    button: PointerButton,
    pressed: bool,
    modifiers: Modifiers,
) {
    let event = Event::PointerButton {
        pos,
        button,
        pressed,
        modifiers,
    };
    window.event_modifiers(event, modifiers);
}

/// Clicks once.
pub fn click(window: &mut Window, at: Pos2) {
    window.event(Event::PointerMoved(at));
    window.step();
    pointer(window, at, PointerButton::Primary, true, Modifiers::NONE);
    window.step();
    pointer(window, at, PointerButton::Primary, false, Modifiers::NONE);
    window.run_steps(2);
}
