//! Tests of a lack of memory on the graphics device: a message is shown, and the picture stays or comes back.

use crate::app::App;
use crate::gpu::upload::shortage;
use crate::harness::{app_on_own_device, press, wait};
use crate::overlay::wireframe::WIREFRAME;
use egui::{Key, vec2};

const MESSAGE: &str = "the graphics adapter has no memory left for the picture or its overlay";

#[test]
fn lines_without_memory_are_turned_off_and_can_be_turned_on_when_there_is_some() {
    let Some((mut window, device)) = app_on_own_device() else {
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
    let Some((mut window, device)) = app_on_own_device() else {
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
