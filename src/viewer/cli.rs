//! The command line: which command, and what it prints.

use crate::app::{App, StartOptions};
use crate::document::embedded_scene;
use crate::gpu::GpuError;
use crate::offscreen;
use crate::overlay::wireframe::WireframeEdges;
use crate::screenshot::{Outcome, ScreenshotOptions};
use clap::{Parser, Subcommand};
use eframe::egui_wgpu::{WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use hitscope_core::obj::LoadOptions;
use hitscope_core::scene::SceneOptions;
use hitscope_core::simd::SimdLevel;
use hitscope_lab::commands::{
    BenchArgs, CommandError, InfoArgs, InspectArgs, LabArgs, MemoryArg, PictureArgs, RenderArgs,
    TraceArgs, load, write_png,
};
use std::io::{BufWriter, ErrorKind, Write, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Arc, PoisonError};
use std::time::Duration;

/// A ray-tracing mesh viewer that shows what a ray really does to your mesh
#[derive(Parser, Debug)]
#[command(version, args_conflicts_with_subcommands = true)]
struct Cli {
    /// The OBJ file to open; the built-in scene without one
    file: Option<PathBuf>,
    /// Save a picture of the whole window once the rendering has converged, and quit
    #[arg(long, value_name = "OUT.png")]
    screenshot: Option<PathBuf>,
    /// Take the picture after so many seconds instead
    #[arg(long, value_name = "SECONDS", requires = "screenshot", value_parser = parse_seconds)]
    after: Option<Duration>,
    #[command(flatten)]
    memory: MemoryArg,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand, Debug)]
enum Command {
    Render(RenderArgs),
    Inspect(InspectArgs),
    Trace(TraceArgs),
    Info(InfoArgs),
    Lab(LabArgs),
    Bench(BenchArgs),
}

/// Runs what the command line asks for. 0: done; 1: the input is bad, with one line on stderr; 2:
/// the command line is.
pub fn run() -> ExitCode {
    let cli = Cli::parse();
    if let Err(error) = SimdLevel::chosen() {
        eprintln!("hitscope: {error}");
        return ExitCode::from(2);
    }
    let result = match &cli.command {
        Some(command) => command.run(),
        None => window(&cli),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // Whoever read our output has enough of it.
        Err(CommandError::Stdout(error)) if error.kind() == ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("hitscope: {error}");
            ExitCode::FAILURE
        }
    }
}

impl Command {
    fn run(&self) -> Result<(), CommandError> {
        let mut out = BufWriter::new(stdout().lock());
        match self {
            Self::Render(args) => render(args)?,
            Self::Inspect(args) => args.run(&mut out)?,
            Self::Trace(args) => args.run(&mut out)?,
            Self::Info(args) => args.run(&mut out)?,
            Self::Lab(args) => args.run(&mut out)?,
            Self::Bench(args) => args.run(&mut out)?,
        }
        Ok(out.flush()?)
    }
}

fn render(args: &RenderArgs) -> Result<(), CommandError> {
    let failed = |error: GpuError| CommandError::Other(error.to_string());
    // Before the long work: without an adapter there is none to be done.
    let needs_gpu = args.wireframe || args.normals;
    let gpu = needs_gpu
        .then(offscreen::device)
        .transpose()
        .map_err(failed)?;
    let rendered = args.trace()?;
    let mut pixels = rendered.film.pixels().to_vec();
    if let Some(gpu) = &gpu {
        let edges = args.wireframe.then_some(WireframeEdges::Polygons);
        let normals = args.normals.then_some(rendered.shading);
        offscreen::draw_over(gpu, &mut pixels, &rendered, edges, normals).map_err(failed)?;
    }
    write_png(&args.output, rendered.film.size(), &pixels)
}

/// Opens the window; without a display, renders what it would have shown.
fn window(cli: &Cli) -> Result<(), CommandError> {
    let outcome = Outcome::default();
    let load_options = LoadOptions {
        max_memory: cli.memory.bytes(),
        ..StartOptions::default().load_options
    };
    let start = StartOptions {
        file: cli.file.clone(),
        load_options,
        screenshot: cli.screenshot.clone().map(|output| ScreenshotOptions {
            output,
            after: cli.after,
            outcome: Arc::clone(&outcome),
        }),
    };
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_app_id("hitscope")
            .with_title("hitscope")
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([560.0, 320.0]),
        wgpu_options: WgpuConfiguration {
            wgpu_setup: WgpuSetup::CreateNew(wgpu_setup()),
            ..WgpuConfiguration::default()
        },
        // The picture's bytes are to reach the screen as they are.
        dithering: false,
        persist_window: cli.screenshot.is_none(),
        ..eframe::NativeOptions::default()
    };
    let create: eframe::AppCreator<'_> = Box::new(|cc| Ok(Box::new(App::new(cc, start)?)));
    let ran = eframe::run_native("hitscope", options, create);
    match (ran, &cli.screenshot) {
        (Ok(()), None) => Ok(()),
        (Ok(()), Some(_)) => {
            let mut outcome = outcome.lock().unwrap_or_else(PoisonError::into_inner);
            let closed = || Err("the window was closed before its picture was taken".to_owned());
            outcome
                .take()
                .unwrap_or_else(closed)
                .map_err(CommandError::Other)
        }
        (Err(error), Some(_)) => Err(CommandError::Other(no_window(&error))),
        (Err(error), None) => {
            eprintln!("hitscope: {}", no_window(&error));
            render_instead(cli.file.as_deref(), load_options)
        }
    }
}

/// Why there is no window, without the places in source code that winit's error names.
fn no_window(error: &eframe::Error) -> String {
    match error {
        eframe::Error::WinitEventLoop(_) => "no window: there is no display".to_owned(),
        error => format!("no window: {error}"),
    }
}

/// The file or the embedded scene as a picture in the current folder.
fn render_instead(file: Option<&Path>, load_options: LoadOptions) -> Result<(), CommandError> {
    const OUTPUT: &str = "hitscope.png";
    let input = file.unwrap_or(Path::new("the built-in scene"));
    let loaded = match file {
        Some(path) => load(path, load_options, SceneOptions::default())?,
        None => embedded_scene(),
    };
    let rendered = PictureDefaults::parse_from(["hitscope"])
        .picture
        .trace(loaded)?;
    write_png(
        Path::new(OUTPUT),
        rendered.film.size(),
        rendered.film.pixels(),
    )?;
    let mut out = stdout().lock();
    writeln!(out, "rendered {} to {OUTPUT}", input.display())?;
    writeln!(
        out,
        "choose view, size and output with: hitscope render FILE -o OUT.png"
    )?;
    Ok(())
}

/// A picture of which nothing is said.
#[derive(Parser)]
struct PictureDefaults {
    #[command(flatten)]
    picture: PictureArgs,
}

/// As eframe has it, but for the largest buffers that the adapter grants: a mesh may need them.
fn wgpu_setup() -> WgpuSetupCreateNew {
    let setup = WgpuSetupCreateNew::without_display_handle();
    let base = Arc::clone(&setup.device_descriptor);
    WgpuSetupCreateNew {
        device_descriptor: Arc::new(move |adapter| {
            let mut descriptor = base(adapter);
            descriptor.required_limits.max_buffer_size = adapter.limits().max_buffer_size;
            descriptor
        }),
        ..setup
    }
}

fn parse_seconds(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|_| "expected a number of seconds")?;
    Duration::try_from_secs_f64(seconds).map_err(|error| error.to_string())
}
