//! A measured environment: the light from each direction as a picture of the sphere.
//!
//! Columns are longitudes, rows are latitudes, in the convention of Mitsuba 3's emitter `envmap`: the first row is the
//! direction +y, up, and the last row is −y. Column centres lie at the longitudes φ = 2π(i + ½)/width, counted from −z
//! over +x, so that the middle of the picture is +z. Between them, light is interpolated bilinearly, around the seam, too.
//!
//! ```text
//!  −z       +x       +z       −x       −z
//!   ┌──────────────────────────────────┐ θ = 0, +y
//!   │                                  │
//!   └──────────────────────────────────┘ θ = π, −y
//!  φ = 0                               2π
//! ```
//!
//! Directions are sampled by their luminance: first a cell between four texels, then a point in the cell with the
//! luminance interpolated bilinearly in φ and cos θ, which differs little from the light's interpolation in φ and θ.
//!
//! Source of sampling a bilinear function: Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, 2023, 2.4.

use super::cumulative::Cumulative;
use crate::brightness::MAX_BRIGHTNESS;
use crate::progress::{Cancelled, Progress};
use crate::srgb::luminance_f64;
use glam::{DVec3, UVec2, Vec2, Vec3};
use std::f32::consts;
use std::f64::consts::{PI, TAU};

/// A picture of the light from all directions, with what is needed to sample it.
#[derive(Clone, Debug)]
pub struct EnvironmentMap {
    /// At least two rows.
    size: UVec2,
    /// Linear RGB, row by row from the top; finite and not negative.
    texels: Vec<Vec3>,
    /// cos θ of each row of texels.
    row_cos: Vec<f64>,
    /// Chooses a row of cells.
    rows: Cumulative,
    /// Chooses a cell of each row. Cell k lies between the texels k and k + 1.
    cells: Vec<Cumulative>,
    flux: Vec3,
    replaced: usize,
    brightest: f32,
}

/// Why there is no map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MapError {
    /// There are no texels, or not as many as the size says.
    #[error("the picture has no pixels")]
    Size,
    /// The load was cancelled.
    #[error("cancelled")]
    Cancelled,
}

impl From<Cancelled> for MapError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapSample {
    /// The unit direction to the light.
    pub dir: Vec3,
    /// The light.
    pub radiance: Vec3,
    /// The probability per solid angle.
    pub density: f32,
}

/// A place in a cell.
struct Place {
    row: usize,
    column: usize,
    /// From 0 to 1: along φ, along θ, and along −cos θ.
    along_phi: f64,
    along_theta: f64,
    along_cos: f64,
}

impl EnvironmentMap {
    /// Memory of a texel.
    pub const BYTES_PER_TEXEL: usize = size_of::<Vec3>() + size_of::<u32>();

    /// A map of texels in linear RGB, row by row from the top. A number that is negative or NaN becomes 0, one above
    /// [`MAX_BRIGHTNESS`] becomes this limit, an infinite one the largest of the others.
    ///
    /// # Errors
    /// See [`MapError`].
    pub fn new(size: UVec2, texels: Vec<Vec3>, progress: &Progress) -> Result<Self, MapError> {
        let count = u64::from(size.x) * u64::from(size.y);
        if count == 0 || texels.len() as u64 != count {
            return Err(MapError::Size);
        }
        let mut map = Self {
            size: size.max(UVec2::new(1, 2)),
            texels,
            row_cos: Vec::new(),
            rows: Cumulative::new(&[]),
            cells: Vec::new(),
            flux: Vec3::ZERO,
            replaced: 0,
            brightest: 0.0,
        };
        map.replace_invalid();
        let brightest = map.texels.iter().map(|texel| texel.max_element());
        map.brightest = brightest.fold(0.0, f32::max);
        if size.y == 1 {
            map.texels.extend_from_within(..);
        }
        let last = f64::from(map.size.y - 1);
        let cos = |row| libm::cos(PI * f64::from(row) / last);
        map.row_cos = (0..map.size.y).map(cos).collect();
        map.distribute(progress)?;
        Ok(map)
    }

    /// Replaces numbers that aren't finite, are negative or too bright.
    fn replace_invalid(&mut self) {
        let values = || self.texels.iter().flat_map(|texel| texel.to_array());
        let is_valid = |x: f32| (0.0..=MAX_BRIGHTNESS).contains(&x);
        self.replaced = values().filter(|&x| !is_valid(x)).count();
        if self.replaced == 0 {
            return;
        }
        let largest = values().filter(|&x| is_valid(x)).fold(0.0, f32::max);
        let replace = |x: f32| match x {
            x if is_valid(x) => x,
            f32::INFINITY => largest,
            x if x > MAX_BRIGHTNESS => MAX_BRIGHTNESS,
            _ => 0.0,
        };
        for texel in &mut self.texels {
            *texel = Vec3::from_array(texel.to_array().map(replace));
        }
    }

    /// Computes the distribution of directions, and the flux.
    fn distribute(&mut self, progress: &Progress) -> Result<(), Cancelled> {
        let columns = self.size.x as usize;
        let (mut row_weights, mut flux) = (Vec::new(), DVec3::ZERO);
        for row in 0..self.size.y as usize - 1 {
            progress.check()?;
            let weight = |column| self.corners(row, column).map(luminance_f64).iter().sum();
            let weights: Vec<f64> = (0..columns).map(weight).collect();
            let solid_angle = self.solid_angle(row);
            row_weights.push(solid_angle * weights.iter().sum::<f64>());
            self.cells.push(Cumulative::new(&weights));
            let texels = &self.texels[row * columns..(row + 2) * columns];
            let sum: DVec3 = texels.iter().map(|texel| texel.as_dvec3()).sum();
            flux += solid_angle * 0.5 * sum;
        }
        self.rows = Cumulative::new(&row_weights);
        self.flux = flux.as_vec3();
        Ok(())
    }

    /// Width and height in texels, as in the file. A file with one row has two equal rows here.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The number of numbers that were negative, not finite or above [`MAX_BRIGHTNESS`], of three for each texel.
    pub fn replaced(&self) -> usize {
        self.replaced
    }

    /// The largest of all numbers.
    pub fn brightest(&self) -> f32 {
        self.brightest
    }

    /// The largest factor with which no number exceeds [`MAX_BRIGHTNESS`]; infinite if all are 0.
    pub fn largest_scale(&self) -> f32 {
        MAX_BRIGHTNESS / self.brightest
    }

    /// Size in bytes.
    pub fn bytes(&self) -> usize {
        self.texels.len() * Self::BYTES_PER_TEXEL
    }

    /// The irradiance, summed over all directions.
    pub(super) fn flux(&self) -> Vec3 {
        self.flux
    }

    /// The light from a unit direction.
    pub fn radiance(&self, dir: Vec3) -> Vec3 {
        let place = self.place(dir);
        self.interpolated(&place)
    }

    /// A direction, by the brightness of the light; `None` if all is black. `at` are uniform numbers in [0, 1).
    pub fn sample(&self, at: Vec2) -> Option<MapSample> {
        let (row, across_rows) = self.rows.sample(at.y.into())?;
        let (column, across_columns) = self.cells[row].sample(at.x.into())?;
        // A point in the cell.
        let [a, b, c, d] = self.corners(row, column).map(luminance_f64);
        let along_cos = sample_linear(across_rows, a + b, c + d);
        let along_phi = sample_linear(across_columns, mix(a, c, along_cos), mix(b, d, along_cos));
        // Its direction.
        let cos = mix(self.row_cos[row], self.row_cos[row + 1], along_cos);
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        let theta = f64::from(libm::atan2f(sin as f32, cos as f32));
        let phi = TAU * (column as f64 + 0.5 + along_phi) / f64::from(self.size.x);
        let (sin_phi, cos_phi) = libm::sincos(phi);
        let place = Place {
            row,
            column,
            along_phi,
            along_theta: (theta / PI * self.intervals() - row as f64).clamp(0.0, 1.0),
            along_cos,
        };
        let density = self.density_at(&place);
        (density > 0.0).then(|| MapSample {
            dir: DVec3::new(sin_phi * sin, cos, -cos_phi * sin).as_vec3(),
            radiance: self.interpolated(&place),
            density,
        })
    }

    /// The density with which [`sample`](Self::sample) chooses a unit direction, per solid angle.
    pub fn density(&self, dir: Vec3) -> f32 {
        self.density_at(&self.place(dir))
    }

    fn density_at(&self, place: &Place) -> f32 {
        let corners = self.corners(place.row, place.column).map(luminance_f64);
        let mean = 0.25 * corners.iter().sum::<f64>();
        if mean == 0.0 {
            return 0.0;
        }
        let [a, b, c, d] = corners;
        let above = mix(a, b, place.along_phi);
        let here = mix(above, mix(c, d, place.along_phi), place.along_cos);
        let cell =
            self.rows.probability(place.row) * self.cells[place.row].probability(place.column);
        (cell * (here / mean) / self.solid_angle(place.row)) as f32
    }

    /// The place of a direction.
    fn place(&self, dir: Vec3) -> Place {
        let across = (dir.x * dir.x + dir.z * dir.z).sqrt();
        let theta = libm::atan2f(across, dir.y);
        let phi = libm::atan2f(dir.x, -dir.z);
        // Rows reach from pole to pole.
        let at = f64::from(theta / consts::PI) * self.intervals();
        let row = (at as usize).min(self.size.y as usize - 2);
        let along_theta = (at - row as f64).clamp(0.0, 1.0);
        // Column centres are at half-integers.
        let at = f64::from(phi / consts::TAU) * f64::from(self.size.x) - 0.5;
        let column = (at.floor() as i64).rem_euclid(i64::from(self.size.x)) as usize;
        // In f64, because cos θ hardly changes near the poles.
        let cos = dir.as_dvec3().normalize_or_zero().y;
        let (first, last) = (self.row_cos[row], self.row_cos[row + 1]);
        Place {
            row,
            column,
            along_phi: at - at.floor(),
            along_theta,
            along_cos: ((first - cos) / (first - last)).clamp(0.0, 1.0),
        }
    }

    fn interpolated(&self, place: &Place) -> Vec3 {
        let [a, b, c, d] = self.corners(place.row, place.column);
        let along_phi = place.along_phi as f32;
        let (above, below) = (a.lerp(b, along_phi), c.lerp(d, along_phi));
        above.lerp(below, place.along_theta as f32)
    }

    /// The texels around a cell: two of the upper row, two of the lower.
    fn corners(&self, row: usize, column: usize) -> [Vec3; 4] {
        let columns = self.size.x as usize;
        let next = if column + 1 == columns { 0 } else { column + 1 };
        let (upper, lower) = (row * columns, (row + 1) * columns);
        [upper + column, upper + next, lower + column, lower + next].map(|k| self.texels[k])
    }

    /// The solid angle of a cell of a row.
    fn solid_angle(&self, row: usize) -> f64 {
        TAU / f64::from(self.size.x) * (self.row_cos[row] - self.row_cos[row + 1])
    }

    /// Intervals between rows.
    fn intervals(&self) -> f64 {
        f64::from(self.size.y - 1)
    }
}

fn mix(from: f64, to: f64, part: f64) -> f64 {
    (1.0 - part) * from + part * to
}

/// A number from 0 to 1 whose density is proportional to the linear function from `from` at 0 to `to` at 1.
fn sample_linear(at: f64, from: f64, to: f64) -> f64 {
    let root = mix(from * from, to * to, at).sqrt();
    if from + root > 0.0 {
        (at * (from + to) / (from + root)).clamp(0.0, 1.0)
    } else {
        at
    }
}
