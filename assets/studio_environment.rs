//! Makes the built-in environment, a photographer's studio: `assets/studio.hdr`.
//!
//! Run `cargo run -p hitscope-core --example studio_environment` after a change; it prints the path that it wrote. The
//! functions come from `libm`, so that the file is the same on every machine.

use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI, TAU};
use std::path::Path;

const WIDTH: usize = 128;
/// Rows reach from pole to pole.
const HEIGHT: usize = 64;

/// A lamp behind a rectangular cloth.
struct Softbox {
    /// Where it is, as seen from the middle.
    towards: DVec3,
    /// Half its width and height at distance 1.
    half_size: [f64; 2],
    radiance: DVec3,
}

fn main() -> std::io::Result<()> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/studio.hdr");
    std::fs::write(&path, file())?;
    eprintln!("wrote {}", path.display());
    Ok(())
}

/// The file in Radiance HDR format, without compression.
pub fn file() -> Vec<u8> {
    let texels: Vec<DVec3> = (0..WIDTH * HEIGHT)
        .map(|k| radiance(direction(k % WIDTH, k / WIDTH)))
        .collect();
    // White that faces up reflects the radiance 1.
    let scale = 1.0 / reflected_upwards(&texels);
    let header = format!(
        "#?RADIANCE\n# Made by assets/studio_environment.rs\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n"
    );
    let mut bytes = header.into_bytes();
    texels
        .iter()
        .for_each(|&texel| bytes.extend(rgbe(scale * texel)));
    bytes
}

/// The direction of a texel: φ from −z over +x, θ from +y.
fn direction(column: usize, row: usize) -> DVec3 {
    let (sin_phi, cos_phi) = libm::sincos(TAU * (column as f64 + 0.5) / WIDTH as f64);
    let (sin, cos) = libm::sincos(PI * row as f64 / (HEIGHT - 1) as f64);
    DVec3::new(sin_phi * sin, cos, -cos_phi * sin)
}

fn radiance(dir: DVec3) -> DVec3 {
    let softboxes = [
        // Key light: left of the camera, high, warm.
        Softbox {
            towards: DVec3::new(-0.75, 0.85, 0.7),
            half_size: [0.55, 0.45],
            radiance: DVec3::new(9.0, 8.6, 8.0),
        },
        // Fill light: right of the camera, low, cool.
        Softbox {
            towards: DVec3::new(1.0, 0.25, 0.45),
            half_size: [0.45, 0.7],
            radiance: DVec3::new(1.3, 1.4, 1.6),
        },
        // Two strips behind, for bright edges.
        Softbox {
            towards: DVec3::new(0.75, 0.45, -0.85),
            half_size: [0.14, 0.6],
            radiance: DVec3::new(6.0, 6.2, 6.6),
        },
        Softbox {
            towards: DVec3::new(-0.9, 0.3, -0.75),
            half_size: [0.1, 0.5],
            radiance: DVec3::new(3.0, 3.1, 3.3),
        },
    ];
    let walls = DVec3::new(0.26, 0.27, 0.29);
    let ceiling = DVec3::new(0.42, 0.43, 0.45);
    let floor = DVec3::new(0.10, 0.098, 0.095);
    let room = if dir.y > 0.0 {
        walls.lerp(ceiling, smooth(dir.y))
    } else {
        walls.lerp(floor, smooth(-4.0 * dir.y))
    };
    softboxes
        .iter()
        .fold(room, |light, softbox| light + softbox.seen(dir))
}

impl Softbox {
    fn seen(&self, dir: DVec3) -> DVec3 {
        let towards = self.towards.normalize();
        let side = DVec3::Y.cross(towards).normalize();
        let up = towards.cross(side);
        let depth = dir.dot(towards);
        if depth <= 0.0 {
            return DVec3::ZERO;
        }
        // Brighter in the middle, with soft edges.
        const EDGE: f64 = 0.15;
        let part = |axis: DVec3, half: f64| {
            let at = (dir.dot(axis) / depth).abs();
            smooth((half - at) / EDGE + 0.5) * (1.0 - 0.3 * (at / half).min(1.0))
        };
        part(side, self.half_size[0]) * part(up, self.half_size[1]) * self.radiance
    }
}

/// From 0 to 1 without corners.
fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// The green radiance that a white horizontal surface reflects upwards.
fn reflected_upwards(texels: &[DVec3]) -> f64 {
    let cell = TAU / WIDTH as f64 * PI / (HEIGHT - 1) as f64;
    (0..texels.len())
        .map(|k| {
            let cos = direction(k % WIDTH, k / WIDTH).y.max(0.0);
            let sin = (1.0 - cos * cos).max(0.0).sqrt();
            FRAC_1_PI * texels[k].y * cos * sin * cell
        })
        .sum()
}

/// Four bytes: mantissas, rounded, and a common exponent.
fn rgbe(rgb: DVec3) -> [u8; 4] {
    let largest = rgb.max_element();
    // largest = mantissa · 2^exponent with ½ ≤ mantissa < 1.
    let (_, mut exponent) = libm::frexp(largest);
    let scaled = |exponent: i32| (rgb * libm::ldexp(256.0, -exponent)).round();
    if scaled(exponent).max_element() > 255.0 {
        exponent += 1;
    }
    let [r, g, b] = scaled(exponent).to_array().map(|x| x as u8);
    [r, g, b, (exponent + 128) as u8]
}
