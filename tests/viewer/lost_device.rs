//! Loss of the graphics device: the app continues in a new window with a new device.

use crate::harness::{
    Window, app_on_own_device, click, gpu, in_picture, press, shared_setup, wait,
};
use egui::{Key, ViewportCommand, vec2};
use hitscope::app::App;
use hitscope::overlay::wireframe::WIREFRAME;

/// The app of a window, in a window with the shared device.
fn reopened(window: Window) -> Window {
    let gpu = gpu().expect("there is one");
    let app = window.into_state();
    egui_kittest::Harness::builder()
        .with_size(vec2(800.0, 600.0))
        .with_step_dt(1.0 / 60.0)
        .with_render_cursor(false)
        .wgpu_setup(shared_setup(gpu))
        .build_eframe(move |cc| app.reopened(cc).expect("the harness has wgpu"))
}

/// Loses the device and draws frames until the window wants to close.
fn lose(window: &mut Window, device: &wgpu::Device) {
    device.destroy();
    // wgpu reports the end of an idle device when it is polled next.
    _ = device.poll(wgpu::PollType::Poll);
    wait(window, "the loss", |app| app.graphics_loss().is_some());
    window.step();
    let commands = &window.output().viewport_output[&egui::ViewportId::ROOT].commands;
    assert!(commands.contains(&ViewportCommand::Close), "{commands:?}");
}

#[test]
fn the_app_continues_in_a_new_window_with_the_same_picture() {
    let Some((mut window, device)) = app_on_own_device() else {
        return;
    };
    press(&mut window, Key::W);
    let at = in_picture(&window, 0.5, 0.5);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    wait(&mut window, "the picture", App::is_settled);
    window.run_steps(3);
    let before = window.render().expect("drawn");
    let turntable = *window.state().turntable();
    lose(&mut window, &device);
    // No frame after the loss panics.
    window.run_steps(3);
    let mut window = reopened(window);
    let notice = window.state().notice().expect("a message").to_owned();
    assert!(notice.contains("device was lost"), "{notice}");
    press(&mut window, Key::Escape);
    wait(&mut window, "the picture", App::is_settled);
    window.run_steps(3);
    let app = window.state();
    assert_eq!(app.notice(), None);
    assert_eq!((app.graphics_errors(), app.graphics_loss()), (0, None));
    assert_eq!(*app.turntable(), turntable);
    assert!(app.inspection().is_some() && app.settings().overlays.is_on(&WIREFRAME));
    let after = window.render().expect("drawn");
    // Without the pointer, and with another status line.
    let rect = window.state().canvas_rect();
    let part = |image: &image::RgbaImage| {
        let size = rect.size() - vec2(0.0, 40.0);
        let [x, y, width, height] = [rect.min.x, rect.min.y, size.x, size.y].map(|x| x as u32);
        image::imageops::crop_imm(image, x, y, width, height).to_image()
    };
    assert!(part(&before) == part(&after));
}

#[test]
fn a_device_lost_while_a_file_is_loaded_and_rays_are_traced_does_no_harm() {
    let Some((mut window, device)) = app_on_own_device() else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    let file = crate::monkey::grid(folder.path(), "grid.obj", 300);
    press(&mut window, Key::W);
    crate::app::drop_file(&mut window, file);
    lose(&mut window, &device);
    let mut window = reopened(window);
    // The loading thread wakes the new window.
    wait(&mut window, "the file", |app| {
        app.document().name() == "grid.obj"
    });
    wait(&mut window, "the picture", App::is_settled);
    assert_eq!(window.state().graphics_errors(), 0);
    assert!(window.state().settings().overlays.is_on(&WIREFRAME));
}

#[test]
fn threads_of_the_lost_window_wake_the_new_one() {
    let Some((mut window, device)) = app_on_own_device() else {
        return;
    };
    wait(&mut window, "the picture", App::is_settled);
    let old = window.ctx.clone();
    lose(&mut window, &device);
    let mut window = reopened(window);
    wait(&mut window, "the picture", App::is_settled);
    window.run_steps(400);
    for _ in 0..3 {
        assert!(!window.ctx.has_requested_repaint());
        old.request_repaint();
        assert!(window.ctx.has_requested_repaint());
        window.run_steps(5);
    }
}
