//! `hitscope converge`: the error of pictures against the time that they take.

use super::camera::CameraArgs;
use super::kernel::parse_kernel;
use super::lab::machine;
use super::picture::picture_bytes;
use super::scene::SceneArgs;
use super::{ClipArgs, CommandError, DARK_BACKGROUND, LightArgs, Output, ThreadsArg, file_error};
use crate::json;
use crate::measure::convergence::{
    Convergence, ConvergencePoint, ConvergenceSizes, LightSetting, measure,
};
use crate::progress::{Meter, ProgressBar};
use crate::report;
use clap::Args;
use hitscope_core::integrator::{Context, INTEGRATORS, Setting, ViewOptions, integrator};
use hitscope_core::names::alternatives;
use hitscope_core::spawn::{SPAWN_POLICIES, spawn_policy};
use hitscope_core::srgb::from_display;
use serde_json::{Value, json};
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

/// Measure the error of pictures against the CPU time that they take
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Each setting renders pictures with 1, 2, 4, … samples per pixel. Their error is
the root mean square over all pixels of the difference of luminance from the
reference, relative to the reference's mean luminance. The reference is the view
“path” with --kernel, --spawn and --depth. It contains the pictures' samples; as
pictures have at most a sixteenth of its samples, this lowers errors by at most
3 %.

A setting is the name of a view whose colours are light, and changes:
path,depth=3,spawn=nvidia,kernel=fast

Examples:
  hitscope converge bunny.obj --size 256x256 --environment studio
  hitscope converge scene.xml --setting path --setting direct --out report")]
pub struct ConvergeArgs {
    /// Scene, shading and kernel.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Setting to measure; repeat the option for several
    /// [default: path; path,depth=2; direct; path,kernel=fast]
    #[arg(long = "setting", value_name = "VIEW[,NAME=VALUE]...")]
    pub settings: Vec<String>,
    /// End a setting with the picture at which its pictures have taken this CPU time
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0, allow_negative_numbers = true, value_parser = parse_seconds)]
    pub seconds: f64,
    /// Samples per pixel of the reference, 16 to 65536, rounded up to a power of two
    #[arg(long, value_name = "N", default_value_t = 1024, allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(16..=65536))]
    pub reference: u32,
    /// Camera.
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Clip.
    #[command(flatten)]
    pub clip: ClipArgs,
    /// Light.
    #[command(flatten)]
    pub light: LightArgs,
    /// Threads.
    #[command(flatten)]
    pub threads: ThreadsArg,
    /// Write report.html, with a plot, and lab.json to this directory
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// The settings without `--setting`.
const DEFAULT_SETTINGS: [&str; 4] = ["path", "path,depth=2", "direct", "path,kernel=fast"];

impl ConvergeArgs {
    /// Measures and prints.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn run(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        self.camera.check()?;
        self.scene.check()?;
        let reference = self.setting("path")?;
        self.light.check(&[reference.view])?;
        let named = self.settings.iter().map(String::as_str);
        let default = DEFAULT_SETTINGS
            .iter()
            .copied()
            .filter(|_| self.settings.is_empty());
        let settings = named.chain(default).map(|text| self.setting(text));
        let settings = settings.collect::<Result<Vec<LightSetting>, _>>()?;
        let files = self.files()?;
        let base = self.context()?;
        let sizes = ConvergenceSizes {
            reference_samples: self.reference.next_power_of_two(),
            seconds: self.seconds,
            threads: self.threads.count(),
        };
        let meter = Meter::default();
        let bar = ProgressBar::of(&meter);
        let measured = measure(&base, &reference, &settings, sizes, &meter)?;
        drop(bar);
        let json = self.report(&measured);
        if self.json {
            writeln!(out, "{}", json::to_pretty(&json))?;
        } else {
            self.print(&measured, out)?;
        }
        out.flush()?;
        let Some([page, data]) = files else {
            return Ok(());
        };
        data.write(|out| writeln!(out, "{}", json::to_pretty(&json)))?;
        page.write(|out| out.write_all(report::to_page(&json).as_bytes()))
    }

    /// The files of the report, opened before the measurement to be sure that they are writable.
    fn files(&self) -> Result<Option<[Output; 2]>, CommandError> {
        let Some(folder) = &self.out else {
            return Ok(None);
        };
        std::fs::create_dir_all(folder).map_err(|source| file_error(folder, source))?;
        let page = Output::create(&folder.join("report.html"))?;
        Ok(Some([page, Output::create(&folder.join("lab.json"))?]))
    }

    /// The scene, the camera and the lights.
    fn context(&self) -> Result<Context, CommandError> {
        let mut loaded = self.scene.load()?;
        loaded.scene = self.clip.apply(loaded.scene)?;
        let scene = &loaded.scene;
        let view = loaded.view.as_ref();
        let (camera, up_axis) = (self.camera.camera(scene, view)?, self.camera.up_axis(view));
        let intersector = self.scene.intersector(scene);
        let memory = self.scene.mesh.memory;
        let size = camera.resolution();
        // The reference and a picture, and two packed scenes.
        let (bytes, packed) = (2 * picture_bytes(size), 2 * intersector.bytes());
        memory.require(
            bytes,
            scene,
            packed,
            format_args!("a reference and a picture"),
        )?;
        Ok(Context {
            scene: Arc::clone(scene),
            second: Arc::clone(&intersector),
            intersector,
            camera,
            shading: self.scene.shading.into(),
            background: from_display(DARK_BACKGROUND),
            lighting: self
                .light
                .lighting(&loaded, (&camera, up_axis), memory.bytes())?,
            options: ViewOptions::default(),
        })
    }

    /// Parses a setting.
    fn setting(&self, text: &str) -> Result<LightSetting, CommandError> {
        let refuse = |why: String| CommandError::Usage(format!("setting “{text}”: {why}"));
        let mut words = text.split(',');
        let name = words.next().unwrap_or_default();
        let view = integrator(name).filter(|view| view.needs.uses(Setting::Exposure));
        let view = view.ok_or_else(|| refuse(not_a_view_of_light(name)))?;
        let mut setting = LightSetting {
            name: text.to_owned(),
            view,
            kernel: self.scene.kernel.choice,
            spawn: None,
            depth: None,
        };
        for word in words {
            let unknown = || {
                refuse(format!(
                    "“{word}” is none of depth=N, spawn=POLICY and kernel=KERNEL"
                ))
            };
            match word.split_once('=').ok_or_else(unknown)? {
                ("depth", depth) if view.needs.uses(Setting::Depth) => {
                    let wrong = |_| refuse(format!("depth is a whole number, not “{depth}”"));
                    setting.depth = Some(depth.parse().map_err(wrong)?);
                }
                ("depth", _) => {
                    return Err(refuse(format!("depth has no effect on the view “{name}”")));
                }
                ("spawn", policy) => {
                    let names: Vec<&str> = SPAWN_POLICIES.iter().map(|p| p.name).collect();
                    let names = alternatives(&names);
                    let wrong = || refuse(format!("spawn is {names}, not “{policy}”"));
                    setting.spawn = Some(spawn_policy(policy).ok_or_else(wrong)?);
                }
                ("kernel", kernel) => {
                    let refused = |why| refuse(format!("“{word}”: {why}"));
                    setting.kernel = parse_kernel(kernel).map_err(refused)?;
                }
                _ => return Err(unknown()),
            }
        }
        Ok(setting)
    }

    fn report(&self, measured: &Convergence) -> Value {
        json!({
            "about": {
                "version": env!("CARGO_PKG_VERSION"),
                "command": "hitscope converge",
                "machine": machine(),
            },
            "file": self.scene.file.display().to_string(),
            "convergence": measured,
        })
    }

    fn print(&self, measured: &Convergence, out: &mut dyn Write) -> std::io::Result<()> {
        let Convergence {
            size: [width, height],
            reference,
            points,
        } = measured;
        writeln!(out, "{}", machine())?;
        writeln!(
            out,
            "{width} x {height} pixels; reference: {}, {} samples per pixel, {:.2} CPU s, relative standard error {:.2e}",
            reference.setting, reference.samples, reference.cpu_s, reference.relative_error
        )?;
        writeln!(
            out,
            "{:<32} {:>8} {:>10} {:>14}",
            "setting", "samples", "CPU s", "relative RMSE"
        )?;
        for point in points {
            let ConvergencePoint {
                setting,
                samples,
                cpu_s,
                relative_rmse,
            } = point;
            writeln!(
                out,
                "{setting:<32} {samples:>8} {cpu_s:>10.3} {relative_rmse:>14.3e}"
            )?;
        }
        Ok(())
    }
}

/// `2.5`.
fn parse_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("expected seconds above 0".to_owned()),
    }
}

/// The message about a setting whose name isn't that of a view of light.
fn not_a_view_of_light(name: &str) -> String {
    let with_light = INTEGRATORS
        .iter()
        .filter(|view| view.needs.uses(Setting::Exposure));
    let names: Vec<&str> = with_light.map(|view| view.name).collect();
    let names = alternatives(&names);
    match integrator(name) {
        Some(_) => format!("the colours of “{name}” aren't light; expected {names}"),
        None => format!("there is no view “{name}”; expected {names}"),
    }
}
