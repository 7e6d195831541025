//! One suite for all models of the table and their examples.

mod density;

use super::*;
use crate::random::Random;

/// Each example with its model's name, seen along the normal, at angles, and from behind if light passes through.
fn cases() -> Vec<(String, Bsdf, Vec3)> {
    let mut cases = Vec::new();
    for model in MODELS {
        for (k, bsdf) in (model.examples)().into_iter().enumerate() {
            assert_eq!(bsdf.model().name, model.name);
            let sides: &[f64] = if model.transmits {
                &[1.0, -1.0]
            } else {
                &[1.0]
            };
            for side in sides {
                for cos in [1.0f64, 0.7, 0.2] {
                    let sin = (1.0 - cos * cos).sqrt();
                    let outgoing = glam::DVec3::new(0.6 * sin, 0.8 * sin, side * cos).as_vec3();
                    cases.push((
                        format!("{} {k}, z = {}", model.name, outgoing.z),
                        bsdf,
                        outgoing,
                    ));
                }
            }
        }
    }
    cases
}

fn sampled(bsdf: &Bsdf, outgoing: Vec3, random: &mut Random) -> Option<Scattered> {
    let mut unit = || (random.bits() >> 40) as f32 / (1u32 << 24) as f32;
    bsdf.sample(outgoing, Vec2::new(unit(), unit()), unit())
}

#[test]
fn models_use_only_the_random_numbers_that_their_row_names() {
    let mut random = Random::new(6);
    let mut unit = || (random.bits() >> 40) as f32 / (1u32 << 24) as f32;
    for (name, bsdf, outgoing) in cases() {
        let model = bsdf.model();
        for _ in 0..100 {
            let [at, other_at] = [0; 2].map(|_| Vec2::new(unit(), unit()));
            let [choice, other_choice] = [0; 2].map(|_| unit());
            let one = bsdf.sample(outgoing, at, choice);
            let at = if model.uses_point { at } else { other_at };
            let choice = if model.uses_choice {
                choice
            } else {
                other_choice
            };
            assert_eq!(one, bsdf.sample(outgoing, at, choice), "{name}");
        }
    }
}

/// The index of refraction beyond the surface, relative to that on the side of a direction.
fn index_beyond(bsdf: &Bsdf, outgoing: Vec3) -> f32 {
    match bsdf {
        Bsdf::RoughDielectric(model) => dielectric::index_beyond(model.media.eta, outgoing),
        _ => 1.0,
    }
}

#[test]
fn exchanging_both_directions_gives_the_same_bsdf_but_for_the_squared_index() {
    let mut random = Random::new(1);
    for (name, bsdf, outgoing) in cases() {
        for _ in 0..1000 {
            let incoming = random.direction().as_vec3();
            let (eta, transmits) = (index_beyond(&bsdf, outgoing), outgoing.z * incoming.z < 0.0);
            // The normal of the facet that refracts.
            let m = (outgoing + eta * incoming).normalize();
            let grazes = outgoing.dot(m).abs().min(incoming.dot(m).abs()) < 0.02;
            if incoming.z.abs() < 1e-3 || transmits && grazes {
                continue;
            }
            let one = bsdf.evaluate(outgoing, incoming) / incoming.z.abs();
            let other = bsdf.evaluate(incoming, outgoing) / outgoing.z.abs();
            let scale = if transmits { eta * eta } else { 1.0 };
            let difference = (scale * one - other).abs().max_element();
            // Both orders compute the halfway direction to 1e-7, which changes the area of facets by 1e-7 times its
            // logarithm's slope: 2/alpha, times the exponent of Beckmann's law, up to 80. A cosine beyond the interface of
            // at least 0.02 is exact to 2e-7/(2 · 0.02²) of itself, and so is the part of light that is refracted.
            let bound = 1e-3 * other.max_element() + 1e-12;
            assert!(difference <= bound, "{name}, {incoming}: {one} {other}");
        }
    }
}

#[test]
fn no_model_reflects_more_light_than_arrives() {
    const N: u32 = 40_000;
    for (name, bsdf, outgoing) in cases() {
        let mut random = Random::new(2);
        let (mut sum, mut squares) = (glam::DVec3::ZERO, glam::DVec3::ZERO);
        for _ in 0..N {
            // Refracted radiance is scaled by the squared index, its power isn't.
            let weight = sampled(&bsdf, outgoing, &mut random)
                .map_or(Vec3::ZERO, |s| s.weight * s.eta * s.eta);
            assert!(
                weight.is_finite() && weight.min_element() >= 0.0,
                "{name}: {weight}"
            );
            sum += weight.as_dvec3();
            squares += weight.as_dvec3() * weight.as_dvec3();
        }
        let n = f64::from(N);
        let mean = sum / n;
        let error = ((squares / n - mean * mean).max(glam::DVec3::ZERO) / n).powf(0.5);
        // 4 standard errors: one in 30 000 such sums, of about 110, exceeds them by chance. 1e-3: the transmittance of
        // rough coats is a table.
        let excess = (mean - 4.0 * error).max_element();
        assert!(excess <= 1.0 + 1e-3, "{name}: {mean} ± {error}, n = {N}");
    }
}

#[test]
fn weights_are_the_bsdf_over_the_density_and_single_directions_have_none() {
    for (name, bsdf, outgoing) in cases() {
        let mut random = Random::new(3);
        let mut has_density = false;
        for _ in 0..5000 {
            let Some(scattered) = sampled(&bsdf, outgoing, &mut random) else {
                continue;
            };
            let Scattered {
                incoming,
                weight,
                density,
                eta,
            } = scattered;
            assert!((incoming.length() - 1.0).abs() < 1e-4, "{name}: {incoming}");
            assert!(eta == 1.0 || outgoing.z * incoming.z < 0.0, "{name}");
            let Some(density) = density else { continue };
            has_density = true;
            let found = bsdf.density(outgoing, incoming);
            let value = bsdf.evaluate(outgoing, incoming);
            // Where two roundings of the direction meet a steep density, both differ; see the reciprocity.
            let is_steep = incoming.z.abs() < 0.01;
            if is_steep {
                continue;
            }
            assert!(
                (found / density - 1.0).abs() < 1e-2,
                "{name}: {incoming} {found} {density}"
            );
            let difference = (value / found - weight).abs().max_element();
            assert!(
                difference < 1e-3 * weight.max_element().max(1.0),
                "{name}: {incoming} {value} {found} {weight}"
            );
        }
        for _ in 0..100 {
            let incoming = random.direction().as_vec3();
            let value = bsdf.evaluate(outgoing, incoming);
            let density = bsdf.density(outgoing, incoming);
            let (same, same_density) = bsdf.evaluate_with_density(outgoing, incoming);
            // A few roundings.
            assert!((same - value).abs().max_element() <= 1e-5 * value.max_element());
            assert!((same_density - density).abs() <= 1e-5 * density, "{name}");
            assert!(
                has_density || (value == Vec3::ZERO && density == 0.0),
                "{name}"
            );
            // Where light is scattered to, it can be sampled.
            assert!(
                density > 0.0 || value == Vec3::ZERO,
                "{name}: {incoming} {value}"
            );
        }
    }
}

#[test]
fn single_directions_have_the_light_that_samples_of_them_carry_on_average() {
    const N: u32 = 1 << 12;
    for (name, bsdf, outgoing) in cases() {
        let singles = bsdf.single_directions(outgoing);
        let mut sums = [Vec3::ZERO; 2];
        for k in 0..N {
            let choice = (k as f32 + 0.5) / N as f32;
            let sampled = bsdf.sample(outgoing, Vec2::new(0.3, 0.6), choice);
            let Some(sampled) = sampled.filter(|sampled| sampled.density.is_none()) else {
                continue;
            };
            let is_it = |single: &Option<Scattered>| {
                single.is_some_and(|single| {
                    (single.incoming, single.eta) == (sampled.incoming, sampled.eta)
                })
            };
            let single = singles.iter().position(is_it);
            sums[single.unwrap_or_else(|| panic!("{name}: {sampled:?}"))] += sampled.weight;
        }
        for (single, sum) in singles.into_iter().zip(sums) {
            let expected = single.map_or(Vec3::ZERO, |single| single.weight);
            let weight = sum / N as f32;
            // One choice more or less, of a weight up to 1/0.75², or 1 over the probability of a mirror, at most 1/0.02;
            // that times the probability is the expected weight.
            let bound = 50.0 / N as f32 * expected.max_element() + 2.0 / N as f32;
            assert!(
                (weight - expected).abs().max_element() <= bound,
                "{name}: {weight} {expected}"
            );
        }
    }
}

#[test]
fn smooth_glass_refracts_by_snells_law_and_reflects_what_fresnel_says() {
    let (eta, transmittance) = (1.5f32, Vec3::new(1.0, 0.5, 0.25));
    let glass = Dielectric {
        eta,
        reflectance: Vec3::ONE,
        transmittance,
    };
    for (z, eta) in [
        (1.0f32, eta),
        (0.5, eta),
        (0.05, eta),
        (-1.0, 1.0 / eta),
        (-0.8, 1.0 / eta),
    ] {
        let outgoing = Vec3::new((1.0 - z * z).sqrt(), 0.0, z);
        let refracted = glass
            .sample(outgoing, Vec2::ZERO, 0.999_999)
            .expect("light passes");
        let incoming = refracted.incoming;
        // Rounding of numbers of size 1.
        assert!((eta * incoming.x + outgoing.x).abs() < 1e-6 && incoming.y == 0.0);
        assert!(incoming.z * z < 0.0 && (incoming.length() - 1.0).abs() < 1e-6);
        assert_eq!((refracted.eta, refracted.density), (eta, None));
        assert!((refracted.weight * eta * eta - transmittance).length() < 1e-6);
        let reflected = glass
            .sample(outgoing, Vec2::ZERO, 0.0)
            .expect("light is reflected");
        assert_eq!(reflected.incoming, Vec3::new(-outgoing.x, 0.0, z));
    }
    // Along the normal, 4 % are reflected.
    let at = |choice| {
        glass
            .sample(Vec3::Z, Vec2::ZERO, choice)
            .expect("light")
            .incoming
            .z
    };
    assert!(at(0.039_99) > 0.0 && at(0.040_01) < 0.0);
    // Inside, beyond 41.8° from the normal, everything is.
    let inside = Vec3::new(0.7, 0.0, -(1.0 - 0.49f32).sqrt());
    let reflected = glass.sample(inside, Vec2::ZERO, 0.999_999).expect("light");
    assert_eq!(
        (reflected.incoming.z, reflected.weight),
        (inside.z, Vec3::ONE)
    );
}

#[test]
fn white_plastic_and_glass_lose_no_light() {
    const N: u32 = 100_000;
    let white = Vec3::ONE;
    let plastic = Bsdf::Plastic(Plastic::new(white, white, 1.5, true));
    let pane = Bsdf::ThinDielectric(ThinDielectric {
        eta: 1.5,
        reflectance: white,
        transmittance: white,
    });
    let outgoing = Vec3::new(0.6, 0.0, 0.8);
    for bsdf in [plastic, pane] {
        let mut random = Random::new(5);
        let weight =
            |_| sampled(&bsdf, outgoing, &mut random).map_or(0.0, |s| f64::from(s.weight.x));
        let weights: Vec<f64> = (0..N).map(weight).collect();
        let mean = weights.iter().sum::<f64>() / f64::from(N);
        // The weights' standard deviation is below 0.2: 4 standard errors.
        assert!(
            (mean - 1.0).abs() < 4.0 * 0.2 / f64::from(N).sqrt(),
            "{mean}"
        );
    }
}

#[test]
fn exactly_the_models_that_are_said_to_be_specular_scatter_into_single_directions_alone() {
    let mut random = Random::new(11);
    for model in MODELS {
        let mut spreads = false;
        for bsdf in (model.examples)() {
            for _ in 0..1000 {
                let [outgoing, incoming] = [0, 1].map(|_| random.direction().as_vec3());
                spreads |= bsdf.evaluate(outgoing, incoming) != Vec3::ZERO;
            }
        }
        assert_eq!(spreads, !model.is_specular, "{}", model.name);
    }
}
