//! Tests of a lack of memory on the graphics device: a message is shown, and the picture stays or comes back.

use crate::app::App;
use crate::gpu::upload::shortage;
use crate::harness::{Window, app_on, gpu, press, wait};
use crate::overlay::wireframe::WIREFRAME;
use eframe::egui_wgpu::{WgpuSetup, WgpuSetupExisting};
use egui::{Key, vec2};

const MESSAGE: &str =
    "the graphics adapter has no memory left for the picture or the lines over it";

/// A window on a device of its own, and the device.
fn window() -> Option<(Window, wgpu::Device)> {
    let gpu = gpu()?;
    let made = pollster::block_on(
        gpu.adapter
            .request_device(&wgpu::DeviceDescriptor::default()),
    );
    let (device, queue) = made.expect("the adapter gives another device");
    std::mem::forget((device.clone(), queue.clone()));
    let setup = WgpuSetup::Existing(WgpuSetupExisting {
        instance: gpu.instance.clone(),
        adapter: gpu.adapter.clone(),
        device: device.clone(),
        queue,
    });
    Some((app_on(setup, None, vec2(800.0, 600.0), 1.0), device))
}

#[test]
fn lines_without_memory_are_turned_off_and_can_be_turned_on_when_there_is_some() {
    let Some((mut window, device)) = window() else {
        return;
    };
    shortage::set(&device, true);
    press(&mut window, Key::W);
    wait(&mut window, "the message", |app| {
        app.notice() == Some(MESSAGE)
    });
    assert!(!window.state().settings().overlays.is_on(&WIREFRAME));
    press(&mut window, Key::Escape);
    wait(&mut window, "the picture", App::is_settled);
    assert_eq!(window.state().notice(), None);
    shortage::set(&device, false);
    press(&mut window, Key::W);
    wait(&mut window, "the lines", App::is_settled);
    assert!(window.state().settings().overlays.is_on(&WIREFRAME));
    assert_eq!(window.state().notice(), None);
}

#[test]
fn a_picture_without_memory_comes_back_when_there_is_some() {
    let Some((mut window, device)) = window() else {
        return;
    };
    press(&mut window, Key::W);
    wait(&mut window, "the lines", App::is_settled);
    shortage::set(&device, true);
    window.set_size(vec2(700.0, 500.0));
    wait(&mut window, "the message", |app| {
        app.notice() == Some(MESSAGE)
    });
    assert!(!window.state().settings().overlays.is_on(&WIREFRAME));
    shortage::set(&device, false);
    press(&mut window, Key::Escape);
    wait(&mut window, "the picture", App::is_settled);
    window.run_steps(3);
    let image = window.render().expect("drawn");
    let film = window.state().film();
    let corner = window.state().shown.canvas_rect.min;
    let size = film.size();
    let [x, y] = [corner.x, corner.y].map(|x| x as u32);
    let shown = image::imageops::crop_imm(&image, x, y, size.x, size.y / 2).to_image();
    let shown: Vec<[u8; 4]> = shown.pixels().map(|pixel| pixel.0).collect();
    let part = &film.pixels()[..shown.len()];
    let same = shown.iter().zip(part).filter(|(a, b)| a == b).count();
    // The legend and marks cover some pixels.
    assert!(same * 10 > shown.len() * 9, "{same} of {}", shown.len());
}
