//! Tables of all shapes: single primitives, spawned rays and packing.

use super::accuracy::{Accuracy, Figures};
use super::text::{header, print_table};
use crate::measure::Measurements;
use crate::measure::lecture::{BOX_AS_PRINTED, LECTURE, PrintedInfo};
use crate::measure::shape_speed::ShapeSpeed;
use crate::measure::statistics::{Quantiles, rate_text, short, speed_text};
use hitscope_core::counts::grouped;
use hitscope_core::group::all_kernels;
use hitscope_core::kernel::Tier;
use hitscope_core::shape::{AxisBox, Shape as _};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Prints the results for single primitives of all shapes.
pub(super) fn print(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    print_hits(all, out)?;
    print_spawning(all, out)?;
    print_speed(all, out)?;
    print_packing(all, out)
}

fn print_speed(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    if all.shape_speed.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "Speed at random primitives of every shape; Mrays/s of CPU time on one thread"
    )?;
    print_speeds(all.shape_speed.iter().filter(|row| !row.is_aligned), out)?;
    writeln!(
        out,
        "Kernels of general planes and boxes on axis-aligned primitives; times relative to the fast kernel for axis-aligned ones"
    )?;
    print_speeds(all.shape_speed.iter().filter(|row| row.is_aligned), out)
}

fn print_speeds<'a>(
    speeds: impl Iterator<Item = &'a ShapeSpeed>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut rows = header(&[
        "shape",
        "kernel",
        "primary",
        "bounce",
        "random",
        "time/fast",
        "bytes/primitive",
    ]);
    for row in speeds {
        let rates = row.speed.mrays_per_s;
        rows.push(vec![
            row.shape.to_owned(),
            row.kernel.to_owned(),
            speed_text(rates.primary),
            speed_text(rates.bounce),
            speed_text(rates.random),
            format!("{:.3}", row.speed.time_relative_to_fast),
            short(row.speed.bytes_per_triangle),
        ]);
    }
    print_table(out, &rows)
}

fn print_packing(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    if all.packing.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "Packing primitives of every shape; CPU time in ns and memory in bytes per primitive"
    )?;
    let mut rows = header(&["shape", "kernel", "n", "ns", "bytes", "tree bytes"]);
    for cell in &all.packing {
        rows.push(vec![
            cell.shape.to_owned(),
            cell.kernel.to_owned(),
            grouped(cell.n),
            short(cell.ns_per_primitive),
            short(cell.bytes_per_primitive),
            short(cell.tree_bytes_per_primitive),
        ]);
    }
    print_table(out, &rows)
}

fn print_hits(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    if all.shapes.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "Single primitives compared with the oracle; rates per million rays, errors of t in f32 ulps and in sizes of the primitive"
    )?;
    let mut rows = header(&[
        "case",
        "kernel",
        "n",
        "hits",
        "missed",
        "false",
        "t p50",
        "t p99",
        "t max",
        "error/size p99",
        "error/size max",
    ]);
    for cell in &all.shapes {
        let text = |quantiles: Option<Quantiles>, pick: fn(&Quantiles) -> f64| {
            quantiles.map_or("–".to_owned(), |q| short(pick(&q)))
        };
        rows.push(vec![
            cell.case.clone(),
            cell.kernel.to_owned(),
            grouped(cell.n as usize),
            grouped(cell.hits as usize),
            rate_text(cell.missed, cell.n),
            rate_text(cell.false_hits, cell.n),
            text(cell.t_ulps, |q| q.p50),
            text(cell.t_ulps, |q| q.p99),
            text(cell.t_ulps, |q| q.max),
            text(cell.error_in_sizes, |q| q.p99),
            text(cell.error_in_sizes, |q| q.max),
        ]);
    }
    print_table(out, &rows)
}

fn print_spawning(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    if all.shape_spawning.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "Rays spawned on single primitives by the default policy; per million rays, heights in sizes of the primitive"
    )?;
    let mut rows = header(&[
        "case",
        "kernel",
        "n",
        "self-hits",
        "beyond an edge",
        "height p50",
        "height max",
    ]);
    for cell in &all.shape_spawning {
        rows.push(vec![
            cell.case.clone(),
            cell.kernel.to_owned(),
            grouped(cell.n as usize),
            rate_text(cell.self_hits, cell.n),
            rate_text(cell.edge_hits, cell.n),
            short(cell.height_p50),
            short(cell.height_max),
        ]);
    }
    print_table(out, &rows)
}

/// The kernels of all shapes, for the page.
pub(super) fn kernels_json(all: &Measurements) -> Vec<Value> {
    let shapes = all_kernels().into_iter();
    let kernels = shapes.flat_map(|shape| {
        let name = shape.shape.name;
        let of_table = shape.kernels.into_iter().map(move |info| KernelEntry {
            name: info.name,
            title: info.title,
            tier: info.tier.map(Tier::name),
            precision: info.precision.name(),
            source: info.source,
            summary: info.summary,
        });
        let printed = printed(name).map(|info| KernelEntry {
            name: info.name,
            title: info.title,
            tier: None,
            precision: "f32",
            source: LECTURE,
            summary: info.summary,
        });
        of_table
            .chain(printed)
            .map(move |entry| entry.measured(name, all))
    });
    kernels.collect()
}

/// What tables state of a kernel or a program.
struct KernelEntry {
    name: &'static str,
    title: &'static str,
    tier: Option<&'static str>,
    precision: &'static str,
    source: &'static str,
    summary: &'static str,
}

impl KernelEntry {
    /// The entry with the figures of a shape.
    fn measured(self, shape: &str, all: &Measurements) -> Value {
        let mut speeds = all.shape_speed.iter();
        let speed =
            speeds.find(|row| row.shape == shape && row.kernel == self.name && !row.is_aligned);
        let cells = all.shapes.iter();
        let cells = cells.filter(|cell| cell.shape == shape && cell.kernel == self.name);
        json!({
            "name": self.name,
            "shape": shape,
            "title": self.title,
            "tier": self.tier,
            "precision": self.precision,
            "source": self.source,
            "summary": self.summary,
            "speed": speed.map(|row| &row.speed),
            "accuracy": Accuracy::of(cells.map(Figures::from)),
        })
    }
}

/// The lecture's programs for a shape other than triangles.
fn printed(shape: &str) -> impl Iterator<Item = &'static PrintedInfo> {
    let programs = BOX_AS_PRINTED.iter().map(|program| &program.info);
    programs.filter(move |_| shape == AxisBox::INFO.name)
}

/// Columns of the table in `docs/accuracy.md`: the end of the case's name, and the title.
const SHOWN: [(&str, &str); 7] = [
    ("around", "ordinary"),
    ("far-1e3", "from 10³"),
    ("far-1e6", "from 10⁶"),
    ("silhouette", "silhouette"),
    ("edges", "at edges"),
    ("axes", "along axes"),
    ("inside", "from inside"),
];

/// Columns of the table in the README.
const SUMMARY: [(&str, &str); 4] = [SHOWN[0], SHOWN[1], SHOWN[2], SHOWN[3]];
/// Shapes in the table in the README.
const SUMMARY_SHAPES: [&str; 2] = ["sphere", "cylinder"];

/// The end of the name of a shape's case.
fn case_of(shape: &str, kind: &str) -> String {
    format!("shape-{shape}-{kind}")
}

/// Whether the table in `docs/accuracy.md` includes this case.
pub fn is_in_shape_table(case: &str) -> bool {
    let mut shapes = all_kernels().into_iter();
    shapes.any(|shape| {
        let name = shape.shape.name;
        SHOWN.iter().any(|(kind, _)| case_of(name, kind) == case)
    })
}

/// The table in `docs/accuracy.md`: wrong decisions per million rays and the error of t, per shape, kernel and case.
pub fn shape_table(all: &Measurements) -> String {
    table(all, &SHOWN, |_| true)
}

/// The table in the README.
pub fn summary_table(all: &Measurements) -> String {
    table(all, &SUMMARY, |shape| SUMMARY_SHAPES.contains(&shape))
}

fn table(all: &Measurements, columns: &[(&str, &str)], is_shown: impl Fn(&str) -> bool) -> String {
    let mut text = String::from("| shape | kernel |");
    for (_, title) in columns {
        _ = write!(text, " {title} |");
    }
    text += "\n|---|---|";
    text += &"---|".repeat(columns.len());
    text.push('\n');
    for shape in all_kernels() {
        let name = shape.shape.name;
        let is_measured = all.shapes.iter().any(|cell| cell.shape == name);
        if !is_measured || !is_shown(name) {
            continue;
        }
        let kernels = shape.kernels.iter().map(|info| {
            let tier = info.tier.map(|tier| format!(" (**{}**)", tier.name()));
            (
                info.name,
                format!("`{}`{}", info.name, tier.unwrap_or_default()),
            )
        });
        let printed = printed(name).map(|info| (info.name, info.name.to_owned()));
        for (kernel, title) in kernels.chain(printed) {
            _ = write!(text, "| {name} | {title} |");
            for (kind, _) in columns {
                let case = case_of(name, kind);
                let mut cells = all.shapes.iter();
                let cell = cells.find(|cell| cell.case == case && cell.kernel == kernel);
                let figures = cell.map(|cell| Figures::from(cell).text());
                _ = write!(text, " {} |", figures.unwrap_or("–".to_owned()));
            }
            text.push('\n');
        }
    }
    text
}
