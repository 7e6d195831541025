//! A χ² test: sampled directions follow the density that their model states.

use super::{cases, sampled};
use crate::bsdf::{Bsdf, Scatter, Scattered};
use crate::random::Random;
use glam::Vec3;
use std::f64::consts::{PI, TAU};

const ROWS: usize = 12;
const COLUMNS: usize = 16;

/// The polar angle by row, from 0 to 1: rows are narrow at the poles, about which refracted light is concentrated.
fn polar_angle(row: f64) -> f64 {
    PI * row * row * (3.0 - 2.0 * row)
}

/// The number of the cell that contains a direction.
fn cell(dir: Vec3) -> usize {
    let dir = dir.as_dvec3();
    let angle = libm::acos(dir.z.clamp(-1.0, 1.0));
    // The inverse of the polar angle by row.
    let row = (0.5 - libm::sin(libm::asin(1.0 - 2.0 * angle / PI) / 3.0)) * ROWS as f64;
    let column = (libm::atan2(dir.y, dir.x) / TAU).rem_euclid(1.0) * COLUMNS as f64;
    (row as usize).min(ROWS - 1) * COLUMNS + (column as usize).min(COLUMNS - 1)
}

/// The integral of the density over each cell, from a random point in each of 1600 parts: where facets are vertical, the
/// density jumps, along a curve that a regular grid might follow.
fn integrals(bsdf: &Bsdf, outgoing: Vec3) -> Vec<f64> {
    const STEPS: usize = 40;
    let mut random = Random::new(6);
    let mut cells = vec![0.0; ROWS * COLUMNS];
    let (rows, columns) = (ROWS * STEPS, COLUMNS * STEPS);
    for i in 0..rows {
        for j in 0..columns {
            let row = (i as f64 + random.unit()) / rows as f64;
            let (sin, cos) = libm::sincos(polar_angle(row));
            let column = (j as f64 + random.unit()) / columns as f64;
            let (sin_phi, cos_phi) = libm::sincos(column * TAU);
            let step = PI * 6.0 * row * (1.0 - row) / rows as f64;
            let area = sin * step * TAU / columns as f64;
            let dir = glam::DVec3::new(sin * cos_phi, sin * sin_phi, cos).as_vec3();
            let density = f64::from(bsdf.density(outgoing, dir));
            cells[i / STEPS * COLUMNS + j / STEPS] += area * density;
        }
    }
    cells
}

/// The quantile of the χ² distribution that is exceeded with probability 10⁻⁵.
///
/// Source: Wilson, Hilferty, "The Distribution of Chi-Square", PNAS 17, 1931.
fn chi_squared_bound(degrees: usize) -> f64 {
    let x = 2.0 / (9.0 * degrees as f64);
    // 4.265: the same quantile of the normal distribution.
    degrees as f64 * (1.0 - x + 4.265 * x.sqrt()).powi(3)
}

#[test]
fn directions_are_sampled_with_their_density_whose_integral_is_the_probability_of_any() {
    // Few enough that the errors of the integrals, below 1e-4 of the whole, are below those of the samples,
    // √(n · integral).
    const N: usize = 20_000;
    for (name, bsdf, outgoing) in cases() {
        let mut integrals = integrals(&bsdf, outgoing);
        let sum: f64 = integrals.iter().sum();
        assert!(sum <= 1.0 + 1e-3, "{name}: {sum}");
        let mut counts = vec![0usize; integrals.len()];
        let mut random = Random::new(4);
        for _ in 0..N {
            if let Some(Scattered {
                incoming,
                density: Some(_),
                ..
            }) = sampled(&bsdf, outgoing, &mut random)
            {
                counts[cell(incoming)] += 1;
            }
        }
        // Samples of single directions, and samples without a direction.
        counts.push(N - counts.iter().sum::<usize>());
        integrals.push((1.0 - sum).max(0.0));
        // The test needs 5 expected samples per cell; cells with fewer are joined to one.
        let (mut statistic, mut degrees) = (0.0, 0);
        let mut few = (0.0, 0.0);
        let mut add = |expected: f64, count: f64| {
            statistic += (count - expected).powi(2) / expected;
            degrees += 1;
        };
        for (integral, count) in integrals.iter().zip(counts) {
            let (expected, count) = (integral * N as f64, count as f64);
            if expected >= 5.0 {
                add(expected, count);
            } else {
                few = (few.0 + expected, few.1 + count);
            }
        }
        if few.0 >= 5.0 {
            add(few.0, few.1);
        } else {
            // Where 5 samples are expected, there are 25 or more with a probability of about 10⁻¹⁰.
            assert!(few.1 < 25.0, "{name}: {few:?}");
        }
        if degrees > 1 {
            let bound = chi_squared_bound(degrees - 1);
            assert!(
                statistic < bound,
                "{name}: χ² {statistic}, {degrees} cells, bound {bound}"
            );
        }
    }
}
