//! `hitscope lab`: what speed costs in accuracy, on this machine.

use super::args::CameraArgs;
use super::render::default_thread_count;
use super::{CommandError, file_error, load};
use crate::measure::scene::{SceneRow, SceneSizes};
use crate::measure::statistics::{rate_text, short};
use crate::measure::{self, Measurements, RunProgress, Sizes};
use crate::report::{self, RunInfo};
use clap::Args;
use hitscope_core::kernel::TRIANGLE_KERNELS;
use hitscope_core::obj::LoadOptions;
use hitscope_core::progress::Progress;
use hitscope_core::scene::SceneOptions;
use hitscope_core::simd::SimdLevel;
use serde_json::json;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// Measures what speed costs in accuracy: every kernel, every extreme, against exact arithmetic
#[derive(Args, Clone, Debug)]
pub struct LabArgs {
    /// Half a minute instead of several: fewer rays
    #[arg(long)]
    pub quick: bool,
    /// Write report.html, lab.json and accuracy.md there
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Only cases whose name begins so; speed is left out
    #[arg(long, value_name = "NAME")]
    pub case: Vec<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// What random numbers begin with
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Measure this OBJ file, as the camera sees it, instead
    #[arg(long, value_name = "FILE", conflicts_with_all = ["out", "case", "seed"])]
    pub scene: Option<PathBuf>,
    /// Camera, for --scene
    #[command(flatten)]
    pub camera: CameraArgs,
}

impl LabArgs {
    /// Measures and prints.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn run(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        match &self.scene {
            Some(file) => self.measure_scene(file, out),
            None => self.measure_matrix(out),
        }
    }

    fn measure_matrix(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let mut sizes = if self.quick {
            Sizes::QUICK
        } else {
            Sizes::FULL
        };
        if !self.case.is_empty() {
            self.refuse_unknown_cases()?;
            sizes.speed_rays = 0;
        }
        // Before the work: a folder that can't be made shouldn't cost minutes.
        if let Some(folder) = &self.out {
            std::fs::create_dir_all(folder).map_err(|source| file_error(folder, source))?;
        }
        let is_wanted = |name: &str| {
            self.case.is_empty() || self.case.iter().any(|case| name.starts_with(&**case))
        };
        let (began, start) = (SystemTime::now(), Instant::now());
        let is_told = io::stderr().is_terminal();
        let threads = default_thread_count();
        if is_told {
            let time = measure::expected(sizes, &is_wanted, threads);
            eprintln!("about {} on {threads} threads", duration_text(time));
        }
        let tell = |advance: RunProgress| {
            if is_told {
                let (percent, left) = (100.0 * advance.done, duration_text(advance.left));
                eprint!("\r{percent:3.0} %, {left} left but for the speed     ");
            }
        };
        let progress = Progress::default();
        let all =
            measure::run(sizes, self.seed, &is_wanted, &progress, &tell).expect("nobody cancels");
        if is_told {
            eprintln!();
        }
        let about = RunInfo {
            version: env!("CARGO_PKG_VERSION"),
            command: self.command_line(),
            machine: machine(),
            started: humantime::format_rfc3339_seconds(began).to_string(),
            seconds: start.elapsed().as_secs_f64(),
            seed: self.seed,
            size: if self.quick { "quick" } else { "full" },
        };
        self.hand_over(&about, &all, out)
    }

    /// Writes the files and prints the tables.
    fn hand_over(
        &self,
        about: &RunInfo,
        all: &Measurements,
        out: &mut dyn Write,
    ) -> Result<(), CommandError> {
        let json = report::to_json(about, all);
        if let Some(folder) = &self.out {
            write(&folder.join("lab.json"), &format!("{json:#}\n"))?;
            write(&folder.join("report.html"), &report::to_page(&json))?;
            write(&folder.join("accuracy.md"), &report::accuracy_table(all))?;
        }
        if self.json {
            writeln!(out, "{json:#}")?;
        } else {
            writeln!(out, "hitscope {}, {}", about.version, about.machine)?;
            writeln!(
                out,
                "{}: {:.1} s, seed {}\n",
                about.command, about.seconds, about.seed
            )?;
            report::print(all, out)?;
        }
        Ok(out.flush()?)
    }

    fn refuse_unknown_cases(&self) -> Result<(), CommandError> {
        let known = measure::all_cases();
        for case in &self.case {
            if !known.iter().any(|info| info.name.starts_with(&**case)) {
                let names: Vec<&str> = known.iter().map(|info| &*info.name).collect();
                let names = names.join(", ");
                return Err(CommandError::Other(format!(
                    "no case begins with “{case}”; there are {names}"
                )));
            }
        }
        Ok(())
    }

    /// What was typed, in its shortest form.
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
        if let Some(folder) = &self.out {
            text += &format!(" --out {}", folder.display());
        }
        text
    }

    fn measure_scene(&self, file: &Path, out: &mut dyn Write) -> Result<(), CommandError> {
        let scene = load(file, LoadOptions::default(), SceneOptions::default())?.scene;
        let camera = self.camera.camera(&scene)?;
        let progress = Progress::default();
        let sizes = if self.quick {
            SceneSizes::PANEL
        } else {
            SceneSizes::COMMAND
        };
        let mut rows = Vec::new();
        let is_told = io::stderr().is_terminal();
        let measured = measure::scene::measure(&scene, &camera, sizes, &progress, |row| {
            if is_told {
                eprint!("\r{} of {} kernels", rows.len() + 1, TRIANGLE_KERNELS.len());
            }
            rows.push(row);
        });
        measured.expect("nobody cancels");
        if is_told {
            eprintln!();
        }
        if self.json {
            let json = json!({
                "file": file.display().to_string(),
                "machine": machine(),
                "triangles": scene.mesh().triangles.len(),
                "kernels": rows,
            });
            writeln!(out, "{json:#}")?;
        } else {
            print_scene(&rows, out)?;
        }
        Ok(out.flush()?)
    }
}

fn print_scene(rows: &[SceneRow], out: &mut dyn Write) -> io::Result<()> {
    let (n, hits) = rows.first().map_or((0, 0), |row| (row.n, row.hits));
    writeln!(out, "{}", machine())?;
    writeln!(
        out,
        "Mrays/s of one thread's CPU time; errors of {n} camera and bounce rays, of which {hits} hit, against the oracle"
    )?;
    writeln!(
        out,
        "{:<22} {:>9} {:>9} {:>9} {:>10}   {:>10} {:>10} {:>10} {:>9} {:>9}",
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
    for (row, kernel) in rows.iter().zip(TRIANGLE_KERNELS) {
        let (rates, t) = (row.speed.mrays_per_s, row.t_ulps);
        let ulps = |x: Option<f64>| x.map_or("–".to_owned(), short);
        writeln!(
            out,
            "{:<22} {:>9} {:>9} {:>9} {:>10.3}   {:>10} {:>10} {:>10} {:>9} {:>9}",
            kernel.info.name,
            short(rates.primary),
            if rates.bounce > 0.0 {
                short(rates.bounce)
            } else {
                "–".to_owned()
            },
            short(rates.random),
            row.speed.time_relative_to_fast,
            rate_text(row.missed, row.n),
            rate_text(row.false_hits, row.n),
            rate_text(row.other_triangle, row.n),
            ulps(t.map(|t| t.p99)),
            ulps(t.map(|t| t.max)),
        )?;
    }
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<(), CommandError> {
    std::fs::write(path, text).map_err(|source| file_error(path, source))
}

/// CPU, threads and SIMD level.
fn machine() -> String {
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

/// Whole seconds, as `2m 5s`.
fn duration_text(time: Duration) -> String {
    let seconds = Duration::from_secs(time.as_secs_f64().ceil() as u64);
    humantime::format_duration(seconds).to_string()
}
