//! `hitscope completions`: prints the completions of the command line for a shell.

use crate::about;
use clap::Args;
use clap_complete::{Shell, generate};
use std::io::{self, Write};

/// Print the completions of the command line for a shell
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  hitscope completions bash > /etc/bash_completion.d/hitscope
  hitscope completions zsh > /usr/local/share/zsh/site-functions/_hitscope
  hitscope completions fish > ~/.config/fish/completions/hitscope.fish")]
pub struct CompletionsArgs {
    /// Shell
    pub shell: Shell,
}

impl CompletionsArgs {
    /// Prints the completions of `program`.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn run(&self, mut program: clap::Command, out: &mut dyn Write) -> io::Result<()> {
        // `generate` panics if its output fails, which memory never does.
        let mut script = Vec::new();
        generate(self.shell, &mut program, about::NAME, &mut script);
        out.write_all(&script)
    }
}
