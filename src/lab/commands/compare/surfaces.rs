//! The comparison of two surfaces.

use super::CompareArgs;
use crate::commands::legend::Legend;
use crate::commands::picture::picture_bytes;
use crate::commands::{CommandError, DARK_BACKGROUND};
use crate::json;
use crate::progress::{Meter, ProgressBar};
use crate::rounding::significant;
use crate::surface_comparison::{
    DistanceFigures, DistancePicture, Inventory, OneSided, OnlyIn, Surface, diagonal, only_in,
};
use glam::UVec2;
use hitscope_core::colour::{COLOUR_MAPS, ColourScale, colour_map};
use hitscope_core::loading::LoadedScene;
use hitscope_core::obj::{Recentre, shown};
use hitscope_core::srgb::from_display;
use serde::Serialize;
use std::io::{self, Write};
use std::path::Path;

/// Significant digits of lengths and areas.
const DIGITS: usize = 6;

/// The result. Lengths are in the units of the files.
#[derive(Serialize)]
struct Report {
    a: Inventory,
    b: Inventory,
    only_in_a: OnlyIn,
    only_in_b: OnlyIn,
    /// Of the box around both.
    diagonal: f64,
    a_to_b: OneSided,
    /// Null with `--one-sided`.
    b_to_a: Option<OneSided>,
    two_sided: Option<DistanceFigures>,
    relative_to_diagonal: Relative,
    /// The distance that has the last colour in the picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<f64>,
}

/// The figures as parts of the diagonal.
#[derive(Serialize)]
struct Relative {
    a_to_b: DistanceFigures,
    b_to_a: Option<DistanceFigures>,
    two_sided: Option<DistanceFigures>,
}

impl CompareArgs {
    /// Compares two surfaces.
    pub(super) fn compare_surfaces(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        self.surfaces.camera.check()?;
        let output = self.created_output()?;
        let load = |path: &Path| self.mesh.load(path, Recentre::Auto);
        let (loaded_a, loaded_b) = (load(&self.a)?, load(&self.b)?);
        let a = Surface::new(&loaded_a).map_err(|error| super::about(&self.a, error))?;
        let b = Surface::new(&loaded_b).map_err(|error| super::about(&self.b, error))?;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.surfaces.threads.count());
        let pool = pool.build();
        let pool = pool.map_err(|error| CommandError::Other(error.to_string()))?;
        let meter = Meter::default();
        let bar = ProgressBar::of(&meter);
        let (there, back) = pool.install(|| self.distances(&a, &b, &meter));
        let scale = output.is_some().then(|| self.scale(there.max));
        let scale = scale.transpose()?;
        if let (Some(output), Some(scale)) = (output, scale) {
            meter.begin("Rendering");
            let draw = || self.draw((&a, &b), &loaded_a, scale, &meter);
            let (size, pixels) = pool.install(draw)?;
            output.write_png(size, &pixels)?;
        }
        drop(bar);
        if self.prints_picture() {
            return Ok(());
        }
        let inventory = |path: &Path, loaded: &LoadedScene, surface: &Surface<'_>| {
            Inventory::new(shown(path), loaded, surface.area())
        };
        let report = Report::new(
            [
                inventory(&self.a, &loaded_a, &a),
                inventory(&self.b, &loaded_b, &b),
            ],
            [&loaded_a, &loaded_b],
            (there, back),
            scale.map(|scale| scale.range()[1]),
        );
        if self.json {
            writeln!(out, "{}", json::to_pretty(&report))?;
        } else {
            report.print(out)?;
        }
        Ok(())
    }

    /// The distances from A to B, and back if they are asked for.
    fn distances(
        &self,
        a: &Surface<'_>,
        b: &Surface<'_>,
        meter: &Meter,
    ) -> (OneSided, Option<OneSided>) {
        let measured = |title: &str, from: &Surface<'_>, to: &Surface<'_>| {
            meter.begin(title);
            let points = self.surfaces.points as usize;
            from.distances_to(to, points, &|part| meter.set(part))
        };
        let there = measured("Distances from A to B", a, b);
        let is_both = !self.surfaces.one_sided;
        let back = is_both.then(|| measured("Distances from B to A", b, a));
        (there, back)
    }

    /// The colours of distances, of which the largest is known.
    fn scale(&self, largest: f64) -> Result<ColourScale, CommandError> {
        let options = &self.surfaces;
        let map = options.colour_map.as_deref();
        let map = map.map_or(COLOUR_MAPS[0], |name| {
            colour_map(name).expect("clap accepts only names in the table")
        });
        // If all distances are 0, any limit shows the same.
        let largest = if largest > 0.0 { largest } else { 1.0 };
        let limit = options.limit.unwrap_or(largest);
        let scale = ColourScale::new("Distance", "", [0.0, limit], map, false);
        scale.map_err(|error| CommandError::Usage(error.to_string()))
    }

    /// The picture of A: its size and its pixels.
    fn draw(
        &self,
        (a, b): (&Surface<'_>, &Surface<'_>),
        loaded: &LoadedScene,
        scale: ColourScale,
        meter: &Meter,
    ) -> Result<(UVec2, Vec<[u8; 4]>), CommandError> {
        let (scene, options) = (&*loaded.scene, &self.surfaces);
        let camera = options.camera.camera(scene, loaded.view.as_ref())?;
        let size = camera.resolution();
        let what = format_args!("a picture of {}x{} pixels", size.x, size.y);
        let memory = self.mesh.memory;
        memory.require(picture_bytes(size), scene, 0, what)?;
        let intersector = scene.intersector(options.kernel.choice);
        let picture = DistancePicture {
            surface: a,
            other: b,
            camera,
            intersector: &*intersector,
            samples: options.samples,
            scale,
            background: from_display(DARK_BACKGROUND),
        };
        let pixels = picture.trace(&|part| meter.set(part));
        Ok(if options.legend {
            let legend = Legend::new(size, &scale);
            let size = UVec2::new(legend.width_together(), size.y);
            (size, legend.beside(&pixels, 0))
        } else {
            (size, pixels)
        })
    }
}

impl Report {
    fn new(
        [a, b]: [Inventory; 2],
        [loaded_a, loaded_b]: [&LoadedScene; 2],
        (a_to_b, b_to_a): (OneSided, Option<OneSided>),
        limit: Option<f64>,
    ) -> Self {
        let diagonal = diagonal(loaded_a, loaded_b);
        let there = a_to_b.figures();
        let back = b_to_a.as_ref().map(OneSided::figures);
        let two_sided = back.map(|back| DistanceFigures::both_ways(there, back));
        let relative = |figures: DistanceFigures| figures.relative_to(diagonal);
        Self {
            a,
            b,
            only_in_a: only_in(loaded_a, loaded_b),
            only_in_b: only_in(loaded_b, loaded_a),
            diagonal,
            relative_to_diagonal: Relative {
                a_to_b: relative(there),
                b_to_a: back.map(relative),
                two_sided: two_sided.map(relative),
            },
            a_to_b,
            b_to_a,
            two_sided,
            limit,
        }
    }

    fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        let (a, b) = (&self.a, &self.b);
        writeln!(out, "A              {}", a.file)?;
        writeln!(out, "B              {}", b.file)?;
        writeln!(out, "{:<14} {:>16} {:>16} {:>16}", "", "A", "B", "B - A")?;
        let counts = [
            ("vertices", a.vertices, b.vertices),
            ("triangles", a.triangles, b.triangles),
            ("faces", a.faces, b.faces),
            ("parts", a.parts, b.parts),
            ("materials", a.materials, b.materials),
        ];
        for (name, a, b) in counts {
            let more = b as i128 - a as i128;
            writeln!(out, "{name:<14} {a:>16} {b:>16} {more:>+16}")?;
        }
        let more = b.area - a.area;
        let plus = if more < 0.0 { "" } else { "+" };
        let [area_a, area_b] = [a.area, b.area].map(|area| significant(area, DIGITS));
        let more = format!("{plus}{}", significant(more, DIGITS));
        writeln!(out, "{:<14} {area_a:>16} {area_b:>16} {more:>16}", "area")?;
        for (title, names) in [
            ("only in A", &self.only_in_a),
            ("only in B", &self.only_in_b),
        ] {
            print_names(title, names, out)?;
        }
        writeln!(out, "diagonal       {}", self.diagonal)?;
        let sides = [
            ("from A to B", Some(&self.a_to_b)),
            ("from B to A", self.b_to_a.as_ref()),
        ];
        for (title, side) in sides {
            if let Some(side) = side {
                print_side(title, side, self.diagonal, out)?;
            }
        }
        if let Some(both) = self.two_sided {
            writeln!(out, "both ways")?;
            print_figures(both, self.diagonal, out)?;
        }
        if let Some(limit) = self.limit {
            writeln!(out, "colours        from 0 to {limit}")?;
        }
        Ok(())
    }
}

fn print_names(title: &str, names: &OnlyIn, out: &mut dyn Write) -> io::Result<()> {
    /// As many as fit on a screen.
    const MOST: usize = 20;
    for (kind, names) in [("part", &names.parts), ("material", &names.materials)] {
        for name in names.iter().take(MOST) {
            writeln!(out, "{title:<14} {kind} {}", shown(name.as_ref()))?;
        }
        if let Some(more @ 1..) = names.len().checked_sub(MOST) {
            writeln!(out, "{title:<14} and {more} more")?;
        }
    }
    Ok(())
}

fn print_side(title: &str, side: &OneSided, diagonal: f64, out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        "{title}, from {} vertices and {} points",
        side.vertices, side.samples
    )?;
    print_figures(side.figures(), diagonal, out)?;
    let [p50, p90, p99] = [side.p50, side.p90, side.p99].map(|p| significant(p, DIGITS));
    writeln!(out, "  quantiles    50 %: {p50}, 90 %: {p90}, 99 %: {p99}")?;
    let worst = &side.worst;
    let line = worst
        .line
        .map_or_else(String::new, |line| format!(" on line {line}"));
    writeln!(
        out,
        "  largest at   {:?}, triangle {} in face {}{line}",
        worst.position, worst.triangle, worst.face
    )?;
    writeln!(
        out,
        "  nearest      {:?}, triangle {}",
        worst.nearest, worst.nearest_triangle
    )
}

fn print_figures(figures: DistanceFigures, diagonal: f64, out: &mut dyn Write) -> io::Result<()> {
    let relative = figures.relative_to(diagonal);
    for (name, length, part) in [
        ("mean", figures.mean, relative.mean),
        ("rms", figures.rms, relative.rms),
        ("max", figures.max, relative.max),
    ] {
        let (length, part) = (significant(length, DIGITS), significant(part, 4));
        writeln!(out, "  {name:<12} {length}, {part} of the diagonal")?;
    }
    Ok(())
}
