//! `hitscope man`: writes the man pages, which contain the same texts as `--help`.

use crate::about;
use clap::Args;
use clap_mangen::Man;
use clap_mangen::roff::{Roff, bold, roman};
use hitscope_lab::commands::{CommandError, Output};
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

/// Print the man page, or write those of all commands
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  hitscope man | man -l -
  hitscope man --out /usr/local/share/man/man1")]
pub struct ManArgs {
    /// Write hitscope.1 and one page per command to this directory
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

impl ManArgs {
    /// Prints the page of `program`, or writes all its pages.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn run(&self, program: clap::Command, out: &mut dyn Write) -> Result<(), CommandError> {
        let pages = pages(program);
        let Some(folder) = &self.out else {
            pages[0].render(out)?;
            return Ok(());
        };
        let failed = |source| CommandError::File {
            path: folder.clone(),
            source,
        };
        fs::create_dir_all(folder).map_err(failed)?;
        for page in pages {
            let name = format!("{}.1", page.name);
            Output::create(&folder.join(name))?.write(|out| page.render(out))?;
        }
        Ok(())
    }
}

/// The pages of the program, which is the first, and of its commands.
fn pages(program: clap::Command) -> Vec<Page> {
    let mut program = program
        .disable_help_subcommand(true)
        .subcommand_help_heading("COMMANDS");
    program.build();
    let commands: Vec<_> = program.get_subcommands().cloned().collect();
    let visible = commands
        .into_iter()
        .filter(|command| !command.is_hide_set());
    let commands = visible
        .map(|command| Page::new(format!("{}-{}", about::NAME, command.get_name()), command));
    let first = Page::new(about::NAME.to_owned(), program);
    [first].into_iter().chain(commands).collect()
}

/// A man page in section 1.
struct Page {
    /// The page's name, as `man` takes it.
    name: String,
    command: clap::Command,
}

impl Page {
    fn new(name: String, command: clap::Command) -> Self {
        Self {
            command: command.display_name(name.clone()),
            name,
        }
    }

    fn render(&self, out: &mut dyn Write) -> io::Result<()> {
        let man = Man::new(self.command.clone())
            .title(self.name.to_uppercase())
            // The empty argument in quotes: pages of the same version are the same on every day.
            .date("\"\"")
            .source(format!("{} {}", about::NAME, about::VERSION))
            .manual("User Commands");
        man.render_title(out)?;
        man.render_name_section(out)?;
        man.render_synopsis_section(out)?;
        self.description().to_writer(out)?;
        man.render_options_section(out)?;
        if self.is_program() {
            man.render_subcommands_section(out)?;
        }
        self.sections().to_writer(out)?;
        self.see_also().to_writer(out)
    }

    fn is_program(&self) -> bool {
        self.name == about::NAME
    }

    fn description(&self) -> Roff {
        let text = self.command.get_long_about().or(self.command.get_about());
        let text = text.map(ToString::to_string).unwrap_or_default();
        let mut roff = Roff::new();
        write_section("DESCRIPTION", &blocks(&text), &mut roff);
        roff
    }

    /// The text after the options: paragraphs under NOTES, and each list under its own heading.
    fn sections(&self) -> Roff {
        let text = self.command.get_after_help();
        let text = text.map(ToString::to_string).unwrap_or_default();
        let blocks = blocks(&text).into_iter();
        let (lists, notes): (Vec<_>, Vec<_>) = blocks.partition(|block| block.heading().is_some());
        let mut roff = Roff::new();
        write_section("NOTES", &notes, &mut roff);
        for list in lists {
            let heading = list.heading().unwrap_or_default().to_uppercase();
            write_section(&heading, &[list], &mut roff);
        }
        roff
    }

    fn see_also(&self) -> Roff {
        let mut roff = Roff::new();
        if !self.is_program() {
            roff.control("SH", ["SEE ALSO"]);
            roff.text([bold(about::NAME), roman("(1)")]);
        }
        roff
    }
}

/// Writes a section of these blocks; nothing if there are none.
fn write_section(heading: &str, blocks: &[Block<'_>], roff: &mut Roff) {
    for (index, block) in blocks.iter().enumerate() {
        match index {
            0 => roff.control("SH", [heading]),
            _ => roff.control("PP", []),
        };
        block.write(roff);
    }
}

/// Lines of a help text without an empty line between them.
struct Block<'a>(Vec<&'a str>);

fn blocks(text: &str) -> Vec<Block<'_>> {
    text.split("\n\n")
        .map(|block| Block(block.lines().collect()))
        .filter(|block| !block.0.is_empty())
        .collect()
}

impl<'a> Block<'a> {
    /// The heading, if this is a list: a line that ends in a colon, then indented lines.
    fn heading(&self) -> Option<&'a str> {
        let (first, rest) = self.0.split_first()?;
        let is_list = !rest.is_empty() && rest.iter().all(|line| is_indented(line));
        first
            .strip_suffix(':')
            .filter(|_| is_list && !is_indented(first))
    }

    /// Writes the block without its heading. Indented lines keep their breaks, others are filled.
    fn write(&self, roff: &mut Roff) {
        let lines = &self.0[usize::from(self.heading().is_some())..];
        for run in lines.chunk_by(|a, b| is_indented(a) == is_indented(b)) {
            let is_list = run.iter().all(|line| is_indented(line));
            if is_list {
                roff.control("RS", ["4"]).control("nf", []);
            }
            for line in run {
                let line = line.strip_prefix(INDENT).unwrap_or(line);
                roff.text([roman(line)]);
            }
            if is_list {
                roff.control("fi", []).control("RE", []);
            }
        }
    }
}

/// The indentation of lists in help texts.
const INDENT: &str = "  ";

fn is_indented(line: &str) -> bool {
    line.starts_with(INDENT)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(command: clap::Command) -> String {
        let mut bytes = Vec::new();
        let page = Page::new("hitscope-try".to_owned(), command);
        page.render(&mut bytes).expect("memory");
        String::from_utf8(bytes).expect("UTF-8")
    }

    #[test]
    fn lists_keep_their_lines_and_paragraphs_are_notes() {
        let text = "First line\nof two.\n\nExit status:\n  0  success\n  1  failure\n\nLast.";
        let page = page(clap::Command::new("try").after_help(text));
        let expected = ".SH NOTES\nFirst line\nof two.\n.PP\nLast.\n\
            .SH \"EXIT STATUS\"\n.RS 4\n.nf\n0  success\n1  failure\n.fi\n.RE\n";
        assert!(page.contains(expected), "{page}");
    }

    #[test]
    fn an_indented_block_of_a_description_has_no_heading() {
        let text = "Trace rays\n\nInput:\n\n  ox oy oz\n\nA ray.";
        let page = page(clap::Command::new("try").long_about(text));
        let expected = ".SH DESCRIPTION\nTrace rays\n.PP\nInput:\n.PP\n.RS 4\n.nf\nox oy oz\n.fi\n.RE\n.PP\nA ray.\n";
        assert!(page.contains(expected), "{page}");
    }
}
