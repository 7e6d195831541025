//! Tests of the record of the pixels on the screen.

use super::*;
use crate::camera::Projection;
use crate::film::{SampleSum, TileSamples};
use crate::tone::Display;
use glam::{DVec3, Vec3};

/// Two tiles in a row, the second of which is narrow.
const SIZE: UVec2 = UVec2::new(TILE_PX + 7, 31);

const ALL: PixelRect = PixelRect::whole(SIZE);

/// A camera at this height, which is the blue component of its picture.
fn camera(height: f64) -> Camera {
    let projection = Projection::Orthographic { height: 1.0 };
    let eye = DVec3::new(0.0, height, 1.0);
    Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, SIZE).expect("a camera")
}

/// The colour of a pixel in a camera's picture.
fn colour(of: &ShownPixel) -> [u8; 4] {
    Display::default().encode(radiance(&of.camera, of.pixel))
}

fn radiance(camera: &Camera, pixel: UVec2) -> Vec3 {
    // Far enough apart to differ in 8 bits.
    Vec3::new(pixel.x as f32 / 64.0, pixel.y as f32 / 64.0, camera.eye().y)
}

/// An empty film of a camera's picture.
fn film(height: f64, first_step: u32) -> Film {
    let mut film = Film::new(Plan::new(SIZE, first_step, 1), Vec3::ZERO);
    film.set_camera(camera(height));
    film
}

/// Begins another camera's picture.
fn restart(film: &mut Film, height: f64, first_step: u32) {
    film.restart(Plan::new(SIZE, first_step, 1), Vec3::ONE);
    film.set_camera(camera(height));
}

/// Adds a unit, each pixel in a colour of its own.
fn trace(film: &mut Film, height: f64, pass: usize, tile: usize) {
    let unit = crate::plan::WorkUnit { pass, tile };
    let camera = camera(height);
    let sum = |pixel| {
        let mut sum = SampleSum::default();
        sum.add(radiance(&camera, pixel));
        sum
    };
    let sums = film.plan().pixels(unit).map(sum).collect();
    film.add(TileSamples { unit, sums });
}

/// Checks that each pixel of the screen has the colour of the pixel that it is said to show.
fn check(screen: &[[u8; 4]], shown: &ShownPixels) {
    for (i, pixel) in screen.iter().enumerate() {
        let at = UVec2::new(i as u32 % SIZE.x, i as u32 / SIZE.x);
        let of = shown.at(at).expect("traced");
        assert_eq!(*pixel, colour(&of), "{at} shows {of:?}");
    }
}

#[test]
fn every_pixel_has_the_colour_of_the_pixel_that_it_shows() {
    let (mut film, mut shown) = (film(0.25, 4), ShownPixels::default());
    assert_eq!(shown.at(UVec2::ZERO), None);
    shown.update(&film, ALL);
    assert_eq!(shown.at(UVec2::ZERO), None, "background");
    for pass in 0..film.plan().pass_count() {
        (0..2).for_each(|tile| trace(&mut film, 0.25, pass, tile));
        shown.update(&film, ALL);
        let screen = film.pixels().to_vec();
        check(&screen, &shown);
        // What is on the screen stays when the film begins another picture.
        let mut next = film.clone();
        restart(&mut next, 0.5, 16);
        check(&screen, &shown);
        shown.update(&next, ALL);
        assert_eq!(next.pixels(), screen);
        check(&screen, &shown);
    }
    let pixel = UVec2::new(9, 8);
    let camera = camera(0.25);
    assert_eq!(shown.at(pixel), Some(ShownPixel { camera, pixel }));
    assert_eq!(shown.at(SIZE), None);
}

#[test]
fn tiles_of_several_pictures_are_told_apart() {
    let (mut film, mut shown) = (film(0.25, 4), ShownPixels::default());
    (0..2).for_each(|tile| trace(&mut film, 0.25, 0, tile));
    shown.update(&film, ALL);
    let mut screen = film.pixels().to_vec();
    // A picture that ends after one tile, then one that reaches the other.
    restart(&mut film, 0.5, 16);
    trace(&mut film, 0.5, 0, 0);
    check(&screen, &shown);
    restart(&mut film, 0.75, 2);
    trace(&mut film, 0.75, 0, 1);
    // The second tile is uploaded, then all.
    let second = film.plan().tile_rect(1);
    for row in (second.min.y..second.max.y).map(|y| film.row(second, y)) {
        screen[row.clone()].copy_from_slice(&film.pixels()[row]);
    }
    shown.update(&film, second);
    check(&screen, &shown);
    shown.update(&film, ALL);
    check(film.pixels(), &shown);
    let height = |x: u32| shown.at(UVec2::new(x, 3)).map(|of| of.camera.eye().y);
    assert_eq!([height(0), height(TILE_PX)], [Some(0.5), Some(0.75)]);
}

#[test]
fn a_picture_of_another_size_shows_nothing_of_the_last_one() {
    let (mut film, mut shown) = (film(0.25, 1), ShownPixels::default());
    (0..2).for_each(|tile| trace(&mut film, 0.25, 0, tile));
    shown.update(&film, ALL);
    let size = UVec2::new(SIZE.x - 1, SIZE.y);
    film.restart(Plan::new(size, 1, 1), Vec3::ONE);
    shown.update(&film, PixelRect::whole(size));
    assert_eq!(shown.at(UVec2::ZERO), None);
}
