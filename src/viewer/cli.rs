//! The command line: parsing, the exit status, and the commands that need the viewer's crates.

use crate::about::version_and_target;
use crate::app::StartOptions;
use crate::display;
use crate::document::embedded_scene;
use crate::first_picture::shown_time;
use crate::launch::run_window;
use crate::offscreen;
use crate::screenshot::{Due, Outcome, ScreenshotOptions};
use crate::session::is_session;
use crate::storage::{Kept, stored};
use crate::subcommand::Command;
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches as _, Parser};
use hitscope_core::names::nearest;
use hitscope_core::obj::{LoadOptions, shown};
use hitscope_core::simd::SimdLevel;
use hitscope_lab::commands::{
    CommandError, MemoryArg, Output, PictureArgs, is_stdin, parse_png, print_line,
    start_thread_pool,
};
use std::ffi::{OsStr, OsString};
use std::io::{self, Write, stdout};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

/// The width of the help in characters: that of a small terminal, so that no line is broken twice.
const HELP_WIDTH: usize = 80;

/// A ray-tracing mesh viewer that compares hits with exact arithmetic
///
/// Without a command, hitscope opens a window, or renders the file to hitscope.png if there is no display.
#[derive(Parser, Debug)]
#[command(
    version = version_and_target(),
    propagate_version = true,
    term_width = HELP_WIDTH,
    args_conflicts_with_subcommands = true,
    after_help = "\
Examples:
  hitscope                                   open the built-in scene
  hitscope bunny.obj                         open a file
  hitscope render bunny.obj -o bunny.png     render without a window
  hitscope trace bunny.obj --rays rays.txt   trace rays and print JSON
  hitscope inspect bunny.obj --pixel 9,7     compare all kernels on one ray
  hitscope COMMAND --help                    list all options of a command

Exit status:
  0  success
  1  bad input or a system error; one line on stderr has the reason
  2  the command line is wrong

Results go to stdout; warnings and errors go to stderr.

Limits: 1.4 billion triangles; lines of 128 MB; pictures of 16384 x 16384
pixels; 1024 threads; the memory that --max-memory allows."
)]
struct Cli {
    /// OBJ file, plain or gzipped, scene file (.xml) or session (.hitscope) to open [default: the built-in scene]
    file: Option<PathBuf>,
    /// Further files, which are refused: the window shows one file.
    #[arg(hide = true)]
    more: Vec<PathBuf>,
    /// Save a screenshot of the window when rendering has converged, and quit
    #[arg(long, value_name = "OUT.png", value_parser = parse_png)]
    screenshot: Option<PathBuf>,
    /// Take the screenshot after this time instead; “first”: as soon as the first traced picture is shown, and print the
    /// time to it from the start of the program
    #[arg(long, value_name = "SECONDS|first", requires = "screenshot", allow_negative_numbers = true, value_parser = parse_due)]
    after: Option<Due>,
    #[command(flatten)]
    memory: MemoryArg,
    #[command(subcommand)]
    command: Option<Command>,
}

/// Runs the command line. The exit status is 0 on success, 1 for bad input or a system error, with one line on
/// stderr, and 2 if the command line is wrong.
pub fn run() -> ExitCode {
    let began = Instant::now();
    let arguments: Vec<OsString> = std::env::args_os().collect();
    if let Some(message) = misspelt_command(&arguments) {
        return refuse(Cli::command(), message);
    }
    let matches = command().get_matches_from(arguments);
    let cli = match Cli::from_arg_matches(&matches) {
        Ok(cli) => cli,
        Err(error) => error.format(&mut command()).exit(),
    };
    if let Err(message) = cli.check() {
        return refuse(command(), message);
    }
    if let Err(error) = SimdLevel::chosen() {
        print_line(format_args!("hitscope: {error}"));
        return ExitCode::from(2);
    }
    let threads = cli.command.as_ref().map(Command::threads);
    let started = start_thread_pool(threads.unwrap_or_default());
    let result = started.and_then(|()| match &cli.command {
        Some(command) => command.run(Cli::command),
        None => open_window(&cli, began),
    });
    match result {
        Ok(()) => ExitCode::SUCCESS,
        // The reader has closed our output, as in `hitscope trace … | head`.
        Err(CommandError::Stdout(error)) if error.kind() == io::ErrorKind::BrokenPipe => {
            ExitCode::SUCCESS
        }
        Err(error) if error.is_usage() => {
            refuse(subcommand(matches.subcommand_name()), error.to_string())
        }
        Err(error) => {
            print_line(format_args!("hitscope: {error}"));
            ExitCode::FAILURE
        }
    }
}

/// The command line, with the names of the overlays.
fn command() -> clap::Command {
    offscreen::with_overlays(Cli::command())
}

/// Prints a usage error in clap's format, with the usage of `command`.
fn refuse(mut command: clap::Command, message: String) -> ExitCode {
    let error = command.error(ErrorKind::ValueValidation, message);
    _ = error.print();
    ExitCode::from(2)
}

/// The subcommand with this name, or the top-level command if `name` is `None`.
fn subcommand(name: Option<&str>) -> clap::Command {
    let mut all = command();
    all.build();
    let found = name.and_then(|name| all.find_subcommand(name).cloned());
    found.unwrap_or(all)
}

/// The error if the first argument is a misspelt command, which would otherwise be taken for a file.
fn misspelt_command(arguments: &[OsString]) -> Option<String> {
    let word = arguments.get(1)?.to_str()?;
    let is_word = word.bytes().all(|b| b.is_ascii_alphabetic());
    if !is_word || Path::new(word).exists() {
        return None;
    }
    let cli = Cli::command();
    let name = nearest(word, cli.get_subcommands().map(clap::Command::get_name))?;
    let is_other = word != name;
    is_other.then(|| format!("there is no command or file “{word}”; did you mean “{name}”?"))
}

impl Cli {
    /// Checks combinations of arguments that are valid individually.
    fn check(&self) -> Result<(), String> {
        let file = self.file.as_deref();
        if file.is_some_and(is_stdin) {
            return Err("the window can't show standard input: save it as a file".to_owned());
        }
        if let (Some(first), Some(second)) = (file, self.more.first()) {
            let is_command = |name: &str| Self::command().find_subcommand(name).is_some();
            let (first, second) = (shown(first), shown(second));
            if is_command(&second) {
                return Err(format!(
                    "the command must come before the file: hitscope {second} {first}"
                ));
            }
            return Err(format!(
                "the window shows one file, not “{first}” and “{second}” together"
            ));
        }
        Ok(())
    }
}

/// The view of the built-in scene.
const BUILT_IN_VIEW: &str = "path";

/// Opens the window, or renders a picture if there is no display. `began` is the start time of the program.
fn open_window(cli: &Cli, began: Instant) -> Result<(), CommandError> {
    // Open the output before the window, so that an unwritable path fails at once.
    let output = cli.screenshot.as_deref().map(Output::create).transpose()?;
    if let (Some(_), Some(file)) = (&cli.screenshot, &cli.file) {
        // A missing file fails at once, too; otherwise the window would show the error.
        std::fs::metadata(file).map_err(|source| CommandError::File {
            path: file.clone(),
            source,
        })?;
    }
    let outcome = Outcome::default();
    let load_options = LoadOptions {
        max_memory: cli.memory.bytes(),
        ..StartOptions::default().load_options
    };
    // A screenshot uses the default settings, not the stored ones.
    let mut kept = match &cli.screenshot {
        Some(_) => Kept::default(),
        None => stored(),
    };
    if cli.screenshot.is_none() && cli.file.is_none() {
        kept.settings.file_view = Some(BUILT_IN_VIEW);
    }
    let start = StartOptions {
        file: cli.file.clone(),
        settings: kept.settings,
        preferences: kept.preferences,
        load_options,
        screenshot: output.map(|output| ScreenshotOptions {
            output,
            due: cli.after.unwrap_or_default(),
            outcome: Arc::clone(&outcome),
        }),
        began,
        ..StartOptions::default()
    };
    let ran = run_window(&start);
    match (ran, &cli.screenshot) {
        (Ok(()), None) => Ok(()),
        (Ok(()), Some(_)) => {
            let mut outcome = outcome.lock().unwrap_or_else(PoisonError::into_inner);
            let closed = || Err("the window was closed before the screenshot was taken".to_owned());
            let taken = outcome.take().unwrap_or_else(closed);
            let first = taken.map_err(CommandError::Other)?.first_picture;
            if let (Some(Due::FirstPicture), Some(after)) = (cli.after, first) {
                writeln!(stdout(), "{}", shown_time(after))?;
            }
            Ok(())
        }
        (Err(error), Some(_)) => Err(CommandError::Other(no_window(&error))),
        (Err(error), None) => {
            print_line(format_args!("hitscope: {}", no_window(&error)));
            render_instead(cli)
        }
    }
}

/// The message if no window can be opened.
fn no_window(error: &eframe::Error) -> String {
    format!("can't open a window: {}", display::explain(error))
}

/// Renders the file or the built-in scene to a picture in the current directory.
fn render_instead(cli: &Cli) -> Result<(), CommandError> {
    const OUTPUT: &str = "hitscope.png";
    if let Some(session) = cli.file.as_deref().filter(|file| is_session(file)) {
        let message = format!("{}: a session needs the window", shown(session));
        return Err(CommandError::Other(message));
    }
    let built_in = Path::new("the built-in scene");
    let file = cli.file.as_deref().unwrap_or(built_in);
    // A file's name may begin with a hyphen.
    let words = [OsStr::new("hitscope"), OsStr::new("--"), file.as_os_str()];
    let PictureDefaults { mut picture } = PictureDefaults::parse_from(words);
    picture.scene.mesh.memory = cli.memory;
    picture.check()?;
    let output = Output::create(Path::new(OUTPUT))?;
    let loaded = match cli.file {
        Some(_) => picture.scene.load()?,
        None => embedded_scene(),
    };
    let rendered = picture.trace(loaded, false)?;
    output.write_png(rendered.film.size(), rendered.film.pixels())?;
    let mut out = stdout().lock();
    writeln!(out, "rendered {} to {OUTPUT}", shown(file))?;
    writeln!(
        out,
        "to choose view, size and output: hitscope render FILE -o OUT.png"
    )?;
    Ok(())
}

/// Picture options at their defaults.
#[derive(Parser)]
struct PictureDefaults {
    #[command(flatten)]
    picture: PictureArgs,
}

fn parse_due(text: &str) -> Result<Due, String> {
    if text == "first" {
        return Ok(Due::FirstPicture);
    }
    let seconds = text.parse().ok();
    seconds
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
        .map(Due::After)
        .ok_or_else(|| "expected a non-negative number of seconds, or “first”".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_of_the_help_is_broken_twice() {
        let mut all = command();
        all.build();
        let commands = [&all].into_iter().chain(all.get_subcommands());
        for command in commands {
            let texts = [
                command.get_long_about(),
                command.get_after_help(),
                command.get_after_long_help(),
            ];
            for text in texts.into_iter().flatten() {
                let text = text.to_string();
                // A paragraph on a single line is broken once.
                let paragraphs = text.split("\n\n").filter(|text| text.contains('\n'));
                for line in paragraphs.flat_map(str::lines) {
                    let name = command.get_name();
                    assert!(line.chars().count() <= HELP_WIDTH, "{name}: {line}");
                }
            }
        }
    }
}
