//! The commands that need no window.

use crate::completions::CompletionsArgs;
use crate::man::ManArgs;
use crate::render;
use clap::Subcommand;
use hitscope_lab::commands::{
    BenchArgs, CommandError, CompareArgs, ConvergeArgs, InfoArgs, InspectArgs, LabArgs, RenderArgs,
    ThreadsArg, TraceArgs,
};
use std::io::{BufWriter, Write as _, stdout};

/// A command that needs no window.
#[derive(Subcommand, Debug)]
pub(crate) enum Command {
    #[command(display_name = "hitscope render")]
    Render(Box<RenderArgs>),
    #[command(display_name = "hitscope inspect")]
    Inspect(Box<InspectArgs>),
    #[command(display_name = "hitscope trace")]
    Trace(TraceArgs),
    #[command(display_name = "hitscope info")]
    Info(InfoArgs),
    #[command(display_name = "hitscope compare")]
    Compare(CompareArgs),
    #[command(display_name = "hitscope lab")]
    Lab(LabArgs),
    #[command(display_name = "hitscope bench")]
    Bench(BenchArgs),
    #[command(display_name = "hitscope converge")]
    Converge(ConvergeArgs),
    #[command(display_name = "hitscope man", hide = true)]
    Man(ManArgs),
    #[command(display_name = "hitscope completions", hide = true)]
    Completions(CompletionsArgs),
}

impl Command {
    /// Runs it. `all` returns the program's whole command line.
    pub(crate) fn run(&self, all: fn() -> clap::Command) -> Result<(), CommandError> {
        let mut out = BufWriter::new(stdout().lock());
        match self {
            Self::Render(args) => render::run(args, &mut out)?,
            Self::Inspect(args) => args.run(&mut out)?,
            Self::Trace(args) => args.run(&mut out)?,
            Self::Info(args) => args.run(&mut out)?,
            Self::Compare(args) => args.run(&mut out)?,
            Self::Lab(args) => args.run(&mut out)?,
            Self::Bench(args) => args.run(&mut out)?,
            Self::Converge(args) => args.run(&mut out)?,
            Self::Man(args) => args.run(all(), &mut out)?,
            Self::Completions(args) => args.run(all(), &mut out)?,
        }
        Ok(out.flush()?)
    }

    /// The number of threads that its arguments request.
    pub(crate) fn threads(&self) -> ThreadsArg {
        match self {
            Self::Render(args) => args.picture.threads,
            Self::Trace(args) => args.threads,
            Self::Compare(args) => args.surfaces.threads,
            Self::Bench(args) => args.threads,
            Self::Converge(args) => args.threads,
            Self::Inspect(_) | Self::Info(_) | Self::Lab(_) => ThreadsArg::default(),
            Self::Man(_) | Self::Completions(_) => ThreadsArg::default(),
        }
    }
}
