//! Tables for the terminal, and the table in `docs/accuracy.md`.

use super::accuracy::Figures;
use crate::measure::contestants::{Contestant, contestants};
use crate::measure::statistics::{rate_text, short};
use crate::measure::{Measurements, cells_of};
use hitscope_core::counts::grouped;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::shape::Triangle;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Prints all results, section by section.
///
/// # Errors
/// Errors of the writer.
pub fn print(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    print_speed(all, out)?;
    print_triangles(all, out)?;
    print_meshes(all, out)?;
    print_order(all, out)?;
    print_boxes(all, out)?;
    print_spawning(all, out)?;
    super::shapes::print(all, out)
}

/// Prints columns as wide as their widest cell, the first two left-aligned.
pub(super) fn print_table(out: &mut dyn Write, rows: &[Vec<String>]) -> io::Result<()> {
    let columns = rows.first().map_or(0, Vec::len);
    let width = |k: usize| {
        rows.iter()
            .map(|row| row[k].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for row in rows {
        let mut line = String::new();
        for (k, (cell, width)) in row.iter().zip(&widths).enumerate() {
            let padding = " ".repeat(width - cell.chars().count());
            let (before, after) = if k < 2 {
                ("", &*padding)
            } else {
                (&*padding, "")
            };
            _ = write!(line, "{before}{cell}{after}  ");
        }
        writeln!(out, "{}", line.trim_end())?;
    }
    writeln!(out)
}

pub(super) fn header(titles: &[&str]) -> Vec<Vec<String>> {
    vec![titles.iter().map(|&title| title.to_owned()).collect()]
}

fn print_speed(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    let Some(first) = all.speed.first() else {
        return Ok(());
    };
    writeln!(
        out,
        "Speed: {}; Mrays/s of CPU time on one thread",
        first.mesh
    )?;
    let mut rows = header(&[
        "kernel",
        "tier",
        "primary",
        "bounce",
        "random",
        "time/fast",
        "ns/test",
        "bytes/tri",
        "in f64/M",
        "in integers/M",
    ]);
    for (kernel, speed) in TRIANGLE_KERNELS.iter().zip(&all.speed) {
        let rates = speed.mrays_per_s;
        let rate = |x: Option<f64>| x.map_or(String::new(), short);
        rows.push(vec![
            kernel.info.name.to_owned(),
            kernel.info.tier.map_or("", |tier| tier.name()).to_owned(),
            short(rates.primary),
            short(rates.bounce),
            short(rates.random),
            format!("{:.3}", speed.time_relative_to_fast),
            speed.ns_per_test.map_or("–".to_owned(), short),
            short(speed.bytes_per_triangle),
            rate(speed.in_f64_per_million),
            rate(speed.in_integers_per_million),
        ]);
    }
    print_table(out, &rows)
}

fn print_triangles(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    if all.triangles.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "Single triangles compared with the oracle; rates per million rays, errors of t in f32 ulps"
    )?;
    let mut rows = header(&[
        "case",
        "kernel",
        "n",
        "hits",
        "missed",
        "false",
        "not finite",
        "t p50",
        "t p99",
        "t max",
        "barycentric p99",
        "barycentric max",
        "gap max",
    ]);
    for cell in &all.triangles {
        let t = |pick: fn(&crate::measure::statistics::Quantiles) -> f64| {
            cell.t_ulps
                .as_ref()
                .map_or("–".to_owned(), |q| short(pick(q)))
        };
        let weights = |pick: fn(&crate::measure::statistics::Quantiles) -> f64| {
            let error = cell.barycentric_error.as_ref();
            error.map_or("–".to_owned(), |q| short(pick(q)))
        };
        rows.push(vec![
            cell.case.clone(),
            cell.kernel.to_owned(),
            grouped(cell.n as usize),
            grouped(cell.hits as usize),
            rate_text(cell.missed, cell.n),
            rate_text(cell.false_hits, cell.n),
            grouped(cell.non_finite as usize),
            t(|q| q.p50),
            t(|q| q.p99),
            t(|q| q.max),
            weights(|q| q.p99),
            weights(|q| q.max),
            cell.gap.map_or("–".to_owned(), |q| short(q.max)),
        ]);
    }
    print_table(out, &rows)
}

fn print_meshes(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    if all.meshes.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "Rays from inside closed meshes, through the tree; per million rays"
    )?;
    let mut rows = header(&[
        "case",
        "kernel",
        "n",
        "missed",
        "doubled",
        "in f64",
        "in integers",
    ]);
    for cell in &all.meshes {
        let rate = |x: Option<f64>| x.map_or(String::new(), short);
        rows.push(vec![
            cell.case.clone(),
            cell.kernel.to_owned(),
            grouped(cell.n as usize),
            rate_text(cell.missed, cell.n),
            if cell.doubled == 0 {
                format!("0 (<{})", short(cell.doubled_bound_per_million))
            } else {
                short(cell.doubled_per_million)
            },
            rate(cell.in_f64_per_million),
            rate(cell.in_integers_per_million),
        ]);
    }
    for kernel in TRIANGLE_KERNELS.iter() {
        let cells = all
            .meshes
            .iter()
            .filter(|cell| cell.kernel == kernel.info.name);
        let (n, missed) = cells.fold((0, 0), |(n, missed), cell| {
            (n + cell.n, missed + cell.missed)
        });
        rows.push(vec![
            "all".to_owned(),
            kernel.info.name.to_owned(),
            grouped(n as usize),
            rate_text(missed, n),
            String::new(),
            String::new(),
            String::new(),
        ]);
    }
    print_table(out, &rows)
}

fn print_order(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    if all.order.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "The nearest of a few triangles, and the order of all crossings; per million rays"
    )?;
    let mut rows = header(&[
        "case",
        "kernel",
        "n",
        "with ties",
        "wrong nearest",
        "wrong crossings",
    ]);
    for cell in &all.order {
        rows.push(vec![
            cell.case.to_owned(),
            cell.kernel.to_owned(),
            grouped(cell.n as usize),
            grouped(cell.ties as usize),
            rate_text(cell.wrong_nearest, cell.n),
            rate_text(cell.wrong_crossings, cell.n),
        ]);
    }
    print_table(out, &rows)
}

fn print_boxes(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    if all.boxes.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "Exact hits in boxes that the ray doesn't meet; per million hits"
    )?;
    let mut rows = header(&["case", "", "n", "lost"]);
    for cell in &all.boxes {
        let lost = rate_text(cell.lost, cell.n);
        rows.push(vec![
            cell.case.to_owned(),
            String::new(),
            grouped(cell.n as usize),
            lost,
        ]);
    }
    print_table(out, &rows)
}

fn print_spawning(all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    if all.spawning.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "Spawned rays; per million rays, heights in sizes of the surface"
    )?;
    let mut rows = header(&[
        "case",
        "policy",
        "kernel",
        "n",
        "self-hits",
        "height p50",
        "height max",
    ]);
    for cell in &all.spawning {
        rows.push(vec![
            cell.case.clone(),
            cell.policy.to_owned(),
            cell.kernel.to_owned(),
            grouped(cell.n as usize),
            rate_text(cell.self_hits, cell.n),
            short(cell.height_p50),
            short(cell.height_max),
        ]);
    }
    print_table(out, &rows)
}

/// Columns of the table in `docs/accuracy.md`: case and title.
const SHOWN: [(&str, &str); 8] = [
    ("offset-0e0", "ordinary"),
    ("offset-0e0-edges", "at edges"),
    ("offset-1e5", "offset 10⁵"),
    ("sliver-1e5", "sliver 10⁵"),
    ("grazing-1e-5", "10⁻⁵ rad"),
    ("far-1e6", "from 10⁶"),
    ("scale-1e-30", "size 10⁻³⁰"),
    ("direction-1e20", "direction 10²⁰"),
];

/// Whether the table in `docs/accuracy.md` includes this case.
pub fn is_in_accuracy_table(case: &str) -> bool {
    SHOWN.iter().any(|(name, _)| *name == case)
}

/// The table in `docs/accuracy.md`: wrong decisions per million rays and the error of t, per kernel and case.
pub fn accuracy_table(all: &Measurements) -> String {
    let mut text = String::from("| kernel |");
    for (_, title) in SHOWN {
        _ = write!(text, " {title} |");
    }
    text += "\n|---|";
    text += &"---|".repeat(SHOWN.len());
    text.push('\n');
    for contestant in contestants::<Triangle>() {
        _ = write!(text, "| {} |", name(contestant));
        for (case, _) in SHOWN {
            let cell = cells_of(&all.triangles, contestant).find(|cell| cell.case == case);
            let figures = cell.map(|cell| Figures::from(cell).text());
            _ = write!(text, " {} |", figures.unwrap_or("–".to_owned()));
        }
        text.push('\n');
    }
    text
}

fn name(contestant: Contestant) -> String {
    match contestant {
        Contestant::Kernel(kernel) => match kernel.info.tier {
            Some(tier) => format!("`{}` (**{}**)", kernel.info.name, tier.name()),
            None => format!("`{}`", kernel.info.name),
        },
        Contestant::AsPrinted(program) => program.info.name.to_owned(),
    }
}
