//! Tests of films.

use super::*;
use crate::plan::{Pass, STEPS};

fn sum_of(samples: &[Vec3]) -> SampleSum {
    let mut sum = SampleSum::default();
    samples.iter().for_each(|&sample| _ = sum.add(sample));
    sum
}

#[test]
fn a_changed_display_gives_the_pixels_of_a_film_that_had_it_from_the_start() {
    let display = Display::new(1.5, crate::tone::TONE_CURVES[1]);
    // Blocks at the right and lower border are cut.
    let plan = Plan::new(UVec2::new(101, 53), 16, 2);
    let background = Vec3::new(0.1, 0.2, 0.3);
    let mut with = Film::new(plan.clone(), background);
    assert!(with.set_display(display));
    assert!(!with.set_display(display));
    let mut without = Film::new(plan.clone(), background);
    let shade = |p: UVec2| Vec3::new(p.x as f32, 2.0 * p.y as f32, 9.0) / 50.0;
    for unit in (0..plan.unit_count()).map(|k| plan.unit(k)) {
        let sums = plan.pixels(unit).map(|p| sum_of(&[shade(p)])).collect();
        let tile = TileSamples { unit, sums };
        with.add(tile.clone());
        without.add(tile);
        if unit.tile % 2 == 0 {
            without.set_display(display);
            assert!(without.pixels() == with.pixels(), "{unit:?}");
            without.set_display(Display::default());
        }
    }
    // A restart keeps the display.
    with.restart(Plan::new(UVec2::ONE, 1, 1), background);
    assert_eq!(with.display(), display);
    assert_eq!(with.pixels(), [Display::default().encode(background)]);
}

#[test]
fn exposure_and_tone_curve_change_light_and_not_the_background() {
    let background = Vec3::new(0.1, 0.2, 0.3);
    let (grey, display) = (
        Vec3::splat(0.125),
        Display::new(1.0, crate::tone::TONE_CURVES[0]),
    );
    // From the left: background, both, light.
    let shows = [
        [Seen::Background; 2],
        [Seen::Background, Seen::Surface],
        [Seen::Surface; 2],
    ];
    let plan = Plan::new(UVec2::new(3, 1), 1, 2);
    let mut film = Film::new(plan.clone(), background);
    for unit in (0..plan.unit_count()).map(|k| plan.unit(k)) {
        let sum_of = |pixel: UVec2| {
            let mut sum = SampleSum::default();
            for k in plan.pass(unit.pass).samples() {
                let seen = shows[pixel.x as usize][k as usize];
                let colour = if seen == Seen::Surface {
                    grey
                } else {
                    background
                };
                assert!(sum.add_seen(colour, seen));
            }
            sum
        };
        let sums = plan.pixels(unit).map(sum_of).collect();
        film.add(TileSamples { unit, sums });
    }
    let plain = Display::default();
    let both = |light: Vec3| plain.encode(0.5 * (background + light));
    assert_eq!(
        film.pixels(),
        [plain.encode(background), both(grey), plain.encode(grey)]
    );
    film.set_display(display);
    let lit = 2.0 * grey;
    assert_eq!(
        film.pixels(),
        [plain.encode(background), both(lit), plain.encode(lit)]
    );
    let surfaces = [0, 1, 2].map(|x| film.shows_surface(UVec2::new(x, 0)));
    assert_eq!(surfaces, [false, true, true]);
}

#[test]
fn the_order_of_tiles_does_not_change_the_picture() {
    let plan = Plan::new(UVec2::new(70, 50), 4, 4);
    let tiles: Vec<TileSamples> = (0..plan.unit_count())
        .map(|k| {
            let unit = plan.unit(k);
            let shade = |p: UVec2| Vec3::new(p.x as f32, p.y as f32, k as f32) / 90.0;
            let samples = plan.pass(unit.pass).samples_per_pixel() as usize;
            let sums = plan.pixels(unit).map(|p| sum_of(&vec![shade(p); samples]));
            TileSamples {
                unit,
                sums: sums.collect(),
            }
        })
        .collect();
    let mut forwards = Film::new(plan.clone(), Vec3::ZERO);
    let mut backwards = forwards.clone();
    tiles.iter().for_each(|tile| _ = forwards.add(tile.clone()));
    let reversed = tiles.into_iter().rev();
    reversed.for_each(|tile| _ = backwards.add(tile));
    assert!(forwards.is_complete() && backwards.is_complete());
    assert_eq!(forwards.pixels(), backwards.pixels());
    assert_eq!(forwards.samples(), 4);
}

#[test]
fn a_pixel_without_a_sample_shows_the_colour_of_its_block() {
    // Of whole blocks: at the border a block's pixel may have been sampled for a larger one.
    let size = UVec2::new(144, 96);
    let shade = |p: UVec2| Vec3::new(p.x as f32, 2.0 * p.y as f32, 1.0) / 192.0;
    for first_step in [16, 12, 6] {
        let plan = Plan::new(size, first_step, 1);
        let mut film = Film::new(plan.clone(), Vec3::ONE);
        let mut has_sample = vec![false; size.element_product() as usize];
        for pass in 0..plan.pass_count() {
            for tile in 0..plan.tile_count() {
                let unit = WorkUnit { pass, tile };
                plan.pixels(unit)
                    .for_each(|p| has_sample[film.index(p)] = true);
                let sums = plan.pixels(unit).map(|p| sum_of(&[shade(p)])).collect();
                film.add(TileSamples { unit, sums });
            }
            let Pass::Lattice { step } = plan.pass(pass) else {
                panic!("{pass} is a pass of a plan of one sample");
            };
            for i in 0..size.element_product() {
                let p = UVec2::new(i % size.x, i / size.x);
                let middle = p / step * step + step / 2;
                let shown = if has_sample[i as usize] { p } else { middle };
                let expected = Display::default().encode(shade(shown));
                assert_eq!(film.pixels()[i as usize], expected, "{p} by {step}");
            }
        }
    }
}

#[test]
fn after_the_first_pass_each_pixel_shows_the_sample_of_its_block_at_any_size() {
    let shade = |p: UVec2| Vec3::new(p.x as f32, 2.0 * p.y as f32, 1.0) / 200.0;
    for (x, y) in [(1, 1), (47, 49), (50, 2), (97, 100)] {
        let size = UVec2::new(x, y);
        for step in STEPS {
            let plan = Plan::new(size, step, 1);
            let mut film = Film::new(plan.clone(), Vec3::ONE);
            for tile in 0..plan.tile_count() {
                let unit = WorkUnit { pass: 0, tile };
                let sums = plan.pixels(unit).map(|p| sum_of(&[shade(p)])).collect();
                film.add(TileSamples { unit, sums });
            }
            // As the samples arrived, and spread over the film.
            for is_spread in [false, true] {
                if is_spread {
                    (0..plan.tile_count()).for_each(|tile| film.begin_tile(tile));
                }
                for i in 0..size.element_product() {
                    let p = UVec2::new(i % x, i / x);
                    let case = format!("{p} of {size} by {step}, {is_spread}");
                    let shown = Plan::representative(size, p, step);
                    let expected = Display::default().encode(shade(shown));
                    assert_eq!(film.pixels()[i as usize], expected, "{case}");
                    let in_film = film.shown(p, &Display::default());
                    assert_eq!(in_film, Some(expected), "{case}");
                    let radiance = (p == shown).then(|| shade(p));
                    assert_eq!(film.radiance(p), radiance, "{case}");
                }
            }
        }
    }
}

#[test]
fn a_picture_consists_of_blocks_while_every_tile_has_its_first_pass_and_no_other() {
    let size = UVec2::new(100, 50);
    let add = |film: &mut Film, pass: usize, tile: usize| {
        let unit = WorkUnit { pass, tile };
        let sums = film.plan().pixels(unit).map(|_| sum_of(&[Vec3::ONE]));
        let sums = sums.collect();
        film.add(TileSamples { unit, sums });
    };
    let mut film = Film::new(Plan::new(size, 4, 1), Vec3::ZERO);
    let tiles = film.plan().tile_count();
    for step in [4, 2, 6] {
        film.restart(Plan::new(size, step, 1), Vec3::ZERO);
        for tile in 0..tiles {
            assert_eq!(film.block_px(), 1, "{tile} tiles by {step}");
            add(&mut film, 0, tile);
        }
        assert_eq!(film.block_px(), step);
    }
    add(&mut film, 1, 3);
    assert_eq!(film.block_px(), 1, "a later pass");
    film.restart(Plan::new(size, 4, 1), Vec3::ZERO);
    film.skip(WorkUnit { pass: 0, tile: 0 });
    (1..tiles).for_each(|tile| add(&mut film, 0, tile));
    assert_eq!(
        (film.passes_done(), film.block_px()),
        (1, 1),
        "a skipped tile"
    );
}

#[test]
fn a_restarted_film_of_the_same_size_keeps_its_colours() {
    let size = UVec2::new(50, 2);
    let mut film = Film::new(Plan::new(size, 1, 1), Vec3::ZERO);
    let white = |film: &mut Film| {
        for tile in 0..film.plan().tile_count() {
            let unit = film.plan().unit(tile);
            let sums = film
                .plan()
                .pixels(unit)
                .map(|_| sum_of(&[Vec3::ONE]))
                .collect();
            film.add(TileSamples { unit, sums });
        }
    };
    white(&mut film);
    assert_eq!((film.samples(), film.is_complete()), (1, true));
    film.restart(Plan::new(size, 2, 1), Vec3::ZERO);
    assert_eq!((film.samples(), film.passes_done()), (0, 0));
    assert!(film.pixels().iter().all(|&p| p == [255; 4]));
    // Nothing is left of the samples before: white once more is no brighter.
    white(&mut film);
    let counts = (0..100).map(|i| film.sample_count(UVec2::new(i % 50, i / 50)));
    assert_eq!(counts.sum::<u32>(), 25);
    let size = UVec2::new(51, 2);
    film.restart(Plan::new(size, 1, 1), Vec3::ZERO);
    assert_eq!(film.size(), size);
    assert_eq!(film.pixels(), [[0, 0, 0, 255]; 102]);
}

#[test]
fn a_film_counts_skipped_tiles_as_done() {
    let plan = Plan::new(UVec2::new(50, 50), 1, 1);
    let mut film = Film::new(plan.clone(), Vec3::ONE);
    (0..plan.unit_count()).for_each(|k| film.skip(plan.unit(k)));
    assert!(film.is_complete());
    assert!(film.pixels().iter().all(|&p| p == [255; 4]));
}

#[test]
fn the_union_of_rectangles_contains_both() {
    let rect = |a, b, c, d| PixelRect {
        min: UVec2::new(a, b),
        max: UVec2::new(c, d),
    };
    let (first, second) = (rect(3, 1, 5, 9), rect(2, 4, 8, 6));
    assert_eq!(first.union(second), rect(2, 1, 8, 9));
    assert_eq!(second.union(first), rect(2, 1, 8, 9));
}

#[test]
fn the_first_pass_covers_the_whole_picture() {
    let plan = Plan::new(UVec2::new(101, 53), 8, 1);
    let mut film = Film::new(plan.clone(), Vec3::ZERO);
    for tile in 0..plan.tile_count() {
        let unit = plan.unit(tile);
        let sums = plan.pixels(unit).map(|_| sum_of(&[Vec3::ONE])).collect();
        film.add(TileSamples { unit, sums });
    }
    assert!(film.pixels().iter().all(|&p| p == [255; 4]));
    assert_eq!((film.passes_done(), film.samples()), (1, 0));
}
