//! `hitscope lab`: measures accuracy and speed of every kernel on this machine.

use super::args::MeshArgs;
use super::camera::CameraArgs;
use super::kernel::kernel_list;
use super::stderr::print_on_terminal;
use super::{CommandError, Output, default_thread_count, file_error};
use crate::json;
use crate::measure::scene::{SceneRow, SceneSizes};
use crate::measure::statistics::{rate_text, short, speed_text};
use crate::measure::{self, CaseInfo, Measurements, RunProgress, Sizes};
use crate::progress::{Meter, ProgressBar, seconds_text};
use crate::report::{self, RunInfo};
use clap::Args;
use hitscope_core::counts::grouped;
use hitscope_core::obj::Recentre;
use hitscope_core::progress::Progress;
use hitscope_core::simd::SimdLevel;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};

const EXAMPLES: &str = "\
Examples:
  hitscope lab --quick
  hitscope lab --out report
  hitscope lab --case closed --case order --seed 7
  hitscope lab --scene bunny.obj --eye 3,2,4

All results except times are the same on every machine for the same seed. Uses
one thread per core.";

/// Measure accuracy and speed of every kernel against exact arithmetic
///
/// Without --scene, the kernels are measured on built-in cases that cover extreme sizes, shapes and positions. With
/// --scene, they are measured on the rays of a camera in your own mesh or scene: the kernels of
/// all its shapes.
#[derive(Args, Clone, Debug)]
#[command(
    mut_args(only_with_scene),
    after_help = EXAMPLES,
    after_long_help = format!("{EXAMPLES}\n\n{}", kernel_list())
)]
pub struct LabArgs {
    /// Measure fewer rays: half a minute instead of several minutes
    #[arg(long)]
    pub quick: bool,
    /// Write report.html and lab.json to this directory; without --scene, also accuracy.md
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Measure only cases whose names begin with NAME, and neither speed nor packing; repeat the option for several
    #[arg(long, value_name = "NAME")]
    pub case: Vec<String>,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Random seed
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = parse_seed)]
    pub seed: u64,
    /// Measure with camera rays in this OBJ or scene file instead; - for standard input
    #[arg(long, value_name = "FILE", conflicts_with_all = CASE_OPTIONS)]
    pub scene: Option<PathBuf>,
    /// Camera.
    #[command(flatten, next_help_heading = "With --scene")]
    pub camera: CameraArgs,
    /// How the mesh is loaded.
    #[command(flatten)]
    pub mesh: MeshArgs,
}

/// `7`.
fn parse_seed(text: &str) -> Result<u64, String> {
    let most = u64::MAX;
    let seed = text.parse();
    seed.map_err(|_| format!("expected an integer from 0 to {most}"))
}

/// Options that don't require `--scene`.
const OWN_OPTIONS: [&str; 6] = ["quick", "out", "case", "json", "seed", "scene"];
/// Options that have no effect on a scene.
const CASE_OPTIONS: [&str; 2] = ["case", "seed"];

fn only_with_scene(arg: clap::Arg) -> clap::Arg {
    if OWN_OPTIONS.contains(&arg.get_id().as_str()) {
        arg
    } else {
        arg.requires("scene").conflicts_with_all(CASE_OPTIONS)
    }
}

impl LabArgs {
    /// Measures and prints.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn run(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        match &self.scene {
            Some(file) => self.measure_scene(file, out),
            None => self.measure_cases(out),
        }
    }

    fn measure_cases(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let mut sizes = if self.quick {
            Sizes::QUICK
        } else {
            Sizes::FULL
        };
        if !self.case.is_empty() {
            self.refuse_unknown_cases()?;
            sizes.speed_rays = 0;
        }
        let files = self.out.as_deref().map(ReportFiles::create).transpose()?;
        let is_wanted = |name: &str| {
            self.case.is_empty() || self.case.iter().any(|case| name.starts_with(&**case))
        };
        let (began, start) = (SystemTime::now(), Instant::now());
        let threads = default_thread_count();
        let time = measure::expected(sizes, &is_wanted, threads);
        print_on_terminal(format_args!(
            "about {} on {threads} threads",
            seconds_text(time)
        ));
        let meter = Meter::default();
        let bar = ProgressBar::of(&meter);
        meter.begin("Measuring accuracy");
        let show = |run: RunProgress| match run {
            RunProgress::Accuracy(done) => meter.set(done),
            RunProgress::Speed => meter.begin("Measuring speed and packing"),
        };
        let never_cancelled = Progress::default();
        let measured = measure::run(sizes, self.seed, &is_wanted, &never_cancelled, &show);
        let all = measured.expect("never cancelled");
        drop(bar);
        let about = self.about(began, start);
        // Print the tables first: a file may turn out not to be writable.
        let json = report::to_json(&about, &all);
        if self.json {
            writeln!(out, "{}", json::to_pretty(&json))?;
        } else {
            print_cases(&about, &all, out)?;
        }
        out.flush()?;
        files.map_or(Ok(()), |files| files.write(&json, &all))
    }

    fn refuse_unknown_cases(&self) -> Result<(), CommandError> {
        let known = measure::all_cases();
        for case in &self.case {
            let is_prefix = |info: &&CaseInfo| info.name.starts_with(&**case);
            if case.is_empty() || !known.iter().any(|info| is_prefix(&info)) {
                let families = known.iter().filter_map(|info| info.name.split('-').next());
                let families: BTreeSet<&str> = families.collect();
                let families = families.into_iter().collect::<Vec<_>>().join(", ");
                return Err(CommandError::Usage(format!(
                    "no case name begins with “{case}”; case names begin with one of {families}"
                )));
            }
        }
        Ok(())
    }

    /// The shortest command line with the same effect.
    fn command_line(&self) -> String {
        let mut text = "hitscope lab".to_owned();
        if self.quick {
            text += " --quick";
        }
        for case in &self.case {
            text += &format!(" --case {case}");
        }
        if self.seed != 1 {
            text += &format!(" --seed {}", self.seed);
        }
        if let Some(file) = &self.scene {
            text += &format!(" --scene {}", file.display());
        }
        if let Some(folder) = &self.out {
            text += &format!(" --out {}", folder.display());
        }
        text
    }

    fn about(&self, began: SystemTime, start: Instant) -> RunInfo {
        RunInfo {
            version: env!("CARGO_PKG_VERSION"),
            command: self.command_line(),
            machine: machine(),
            started: humantime::format_rfc3339_seconds(began).to_string(),
            seconds: start.elapsed().as_secs_f64(),
            seed: self.seed,
            size: if self.quick { "quick" } else { "full" },
        }
    }

    fn measure_scene(&self, file: &Path, out: &mut dyn Write) -> Result<(), CommandError> {
        self.camera.check()?;
        let files = self.out.as_deref().map(PageFiles::create).transpose()?;
        let (began, start) = (SystemTime::now(), Instant::now());
        let loaded = self.mesh.load(file, Recentre::Auto)?;
        let scene = loaded.scene;
        let camera = self.camera.camera(&scene, loaded.view.as_ref())?;
        let sizes = if self.quick {
            SceneSizes::PANEL
        } else {
            SceneSizes::COMMAND
        };
        let is_empty = scene.primitive_count() == 0;
        let kernels = measure::scene::measured_kernels(&scene);
        let mut rows = Vec::new();
        let meter = Meter::default();
        let bar = ProgressBar::of(&meter);
        meter.begin("Measuring kernels");
        let never_cancelled = Progress::default();
        if !is_empty {
            let each = |row| {
                rows.push(row);
                meter.set(rows.len() as f64 / kernels.len() as f64);
            };
            let measured = measure::scene::measure(&scene, &camera, sizes, &never_cancelled, each);
            measured.expect("never cancelled");
        }
        drop(bar);
        let name = file.display().to_string();
        let json = json!({
            "file": name,
            "machine": machine(),
            "triangles": scene.mesh().triangles().len(),
            "primitives": scene.primitive_count(),
            "kernels": rows,
        });
        if self.json {
            writeln!(out, "{}", json::to_pretty(&json))?;
        } else if is_empty {
            writeln!(out, "the scene is empty: there is nothing to measure")?;
        } else {
            print_scene(&rows, out)?;
        }
        out.flush()?;
        let Some(files) = files else {
            return Ok(());
        };
        let about = self.about(began, start);
        files.write(&json, &report::scene_for_page(&about, &name, &scene, &rows))
    }
}

/// The page and its data. They are opened before the measurement, which takes minutes, so that it isn't lost if they
/// can't be written.
struct PageFiles {
    json: Output,
    page: Output,
}

impl PageFiles {
    fn create(folder: &Path) -> Result<Self, CommandError> {
        std::fs::create_dir_all(folder).map_err(|source| file_error(folder, source))?;
        Ok(Self {
            json: Output::create(&folder.join("lab.json"))?,
            page: Output::create(&folder.join("report.html"))?,
        })
    }

    fn write(&self, json: &Value, for_page: &Value) -> Result<(), CommandError> {
        self.json
            .write(|out| writeln!(out, "{}", json::to_pretty(json)))?;
        self.page
            .write(|out| out.write_all(report::to_page(for_page).as_bytes()))
    }
}

/// The files of a report of all cases.
struct ReportFiles {
    page: PageFiles,
    table: Output,
}

impl ReportFiles {
    fn create(folder: &Path) -> Result<Self, CommandError> {
        Ok(Self {
            page: PageFiles::create(folder)?,
            table: Output::create(&folder.join("accuracy.md"))?,
        })
    }

    fn write(&self, json: &Value, all: &Measurements) -> Result<(), CommandError> {
        self.page.write(json, json)?;
        self.table.write(|out| {
            out.write_all(report::accuracy_table(all).as_bytes())?;
            writeln!(out)?;
            out.write_all(report::shape_table(all).as_bytes())
        })
    }
}

fn print_cases(about: &RunInfo, all: &Measurements, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "hitscope {}, {}", about.version, about.machine)?;
    writeln!(
        out,
        "{}: {:.1} s, seed {}\n",
        about.command, about.seconds, about.seed
    )?;
    report::print(all, out)
}

fn print_scene(rows: &[SceneRow], out: &mut dyn Write) -> io::Result<()> {
    let (n, hits) = rows.first().map_or((0, 0), |row| (row.n, row.hits));
    writeln!(out, "{}", machine())?;
    writeln!(
        out,
        "Mrays/s by CPU time of one thread; errors against the exact answer for {} camera and bounce rays, {} of which hit",
        grouped(n as usize),
        grouped(hits as usize)
    )?;
    if measure::scene::has_several_shapes(rows) {
        writeln!(out, "{}", measure::scene::OF_WHOLE_SCENE)?;
    }
    let width = rows
        .iter()
        .map(|row| row.kernel.len() + 2)
        .max()
        .unwrap_or(0);
    let width = width.max(24);
    writeln!(
        out,
        "{:<width$} {:>9} {:>9} {:>9} {:>10}   {:>10} {:>10} {:>10} {:>9} {:>9}",
        "kernel",
        "primary",
        "bounce",
        "random",
        "time/fast",
        "missed/M",
        "false/M",
        "other/M",
        "t p99",
        "t max"
    )?;
    let mut heading = "";
    for line in report::scene_lines(rows) {
        if line.heading != std::mem::replace(&mut heading, line.heading) {
            writeln!(out, "{heading}")?;
        }
        print_row(line.name, line.row, width, out)?;
    }
    Ok(())
}

fn print_row(name: &str, row: &SceneRow, width: usize, out: &mut dyn Write) -> io::Result<()> {
    let (rates, t) = (row.speed.mrays_per_s, row.t_ulps);
    // There are no bounce rays if nothing is hit, and no random rays if the scene has no bounds.
    let ulps = |x: Option<f64>| x.map_or("–".to_owned(), short);
    writeln!(
        out,
        "  {:<width$} {:>9} {:>9} {:>9} {:>10.3}   {:>10} {:>10} {:>10} {:>9} {:>9}",
        name,
        speed_text(rates.primary),
        speed_text(rates.bounce),
        speed_text(rates.random),
        row.speed.time_relative_to_fast,
        rate_text(row.missed, row.n),
        rate_text(row.false_hits, row.n),
        rate_text(row.other_triangle, row.n),
        ulps(t.map(|t| t.p99)),
        ulps(t.map(|t| t.max)),
        width = width - 2,
    )
}

/// Describes the machine: CPU, threads and SIMD level.
pub(super) fn machine() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':'))
        .map_or(std::env::consts::ARCH, |(_, name)| name.trim());
    format!(
        "{model}, {} threads, {}",
        default_thread_count(),
        SimdLevel::current().name()
    )
}
