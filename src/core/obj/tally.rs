//! Counts of unusual statements, and line numbers of statements.

use super::error::{Warning, printable};
use crate::counts::counted_as;
use std::collections::BTreeMap;

/// A number of occurrences, and the line of the first.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    pub count: usize,
    pub first_line: usize,
}

impl Tally {
    pub(super) fn add(&mut self, line: usize) {
        self.append(Self {
            count: 1,
            first_line: line,
        });
    }

    /// Adds the occurrences of another tally.
    pub(super) fn append(&mut self, other: Self) {
        if self.count == 0 || (other.count > 0 && other.first_line < self.first_line) {
            self.first_line = other.first_line;
        }
        self.count += other.count;
    }

    /// A warning at the first line, if the count isn't zero.
    pub(super) fn warning(self, message: impl FnOnce(usize) -> String) -> Option<Warning> {
        (self.count > 0).then(|| Warning::at(self.first_line, message(self.count)))
    }
}

/// Counts a statement under its keyword.
pub(super) fn count_by_keyword(tallies: &mut BTreeMap<String, Tally>, keyword: &str, line: usize) {
    let mut one = Tally::default();
    one.add(line);
    add_by_keyword(tallies, keyword, one);
}

/// Adds a tally to that of a keyword.
pub(super) fn add_by_keyword(tallies: &mut BTreeMap<String, Tally>, keyword: &str, more: Tally) {
    /// Files of random bytes have many keywords. Those after the first 40 share one tally.
    const MAX_KEYWORDS: usize = 40;
    let is_known = tallies.contains_key(keyword);
    let name = if is_known || tallies.len() < MAX_KEYWORDS {
        keyword
    } else {
        "…"
    };
    tallies.entry(name.to_owned()).or_default().append(more);
}

/// Line numbers of statements, stored as runs of statements on consecutive lines.
#[derive(Clone, Debug, Default)]
pub struct LineRuns {
    /// The index of the first statement in each run, and its line.
    runs: Vec<(usize, usize)>,
    count: usize,
    /// The line after the last statement.
    next_line: usize,
}

impl LineRuns {
    pub(super) fn push(&mut self, line: usize) {
        if line != self.next_line || self.runs.is_empty() {
            self.runs.push((self.count, line));
        }
        self.count += 1;
        self.next_line = line + 1;
    }

    /// Adds the statements of a later part of the file.
    pub(super) fn append(&mut self, later: &Self) {
        let is_continued = |&&(_, line): &&(usize, usize)| line == self.next_line;
        let continues = !self.runs.is_empty() && later.runs.first().filter(is_continued).is_some();
        let new = later.runs[usize::from(continues)..].iter();
        self.runs
            .extend(new.map(|(first, line)| (self.count + first, *line)));
        if later.count > 0 {
            self.next_line = later.next_line;
        }
        self.count += later.count;
    }

    /// Number of statements.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The line (from 1) of a statement (from 0), or 0 if there are no statements.
    pub fn line(&self, statement: usize) -> usize {
        let run = self.runs.partition_point(|(first, _)| *first <= statement);
        match run.checked_sub(1).map(|run| self.runs[run]) {
            Some((first, line)) => line + statement - first,
            None => 0,
        }
    }

    /// The statement (from 0) that starts on a line (from 1), if there is one.
    pub fn statement_on(&self, line: usize) -> Option<usize> {
        let run = self.runs.partition_point(|(_, first)| *first <= line);
        let (statement, first) = self.runs[run.checked_sub(1)?];
        let statement = statement + line - first;
        (statement < self.count && self.line(statement) == line).then_some(statement)
    }

    pub(super) fn bytes(&self) -> usize {
        size_of::<(usize, usize)>() * self.runs.capacity()
    }
}

/// A number of elements that aren't faces, with the noun.
pub(super) fn lines_or_points(count: usize) -> String {
    counted_as(count, "line or point", "lines or points")
}

/// A word for messages, shortened to fit on a line.
pub fn shortened(word: &str) -> String {
    const LENGTH: usize = 60;
    shortened_to(LENGTH, word)
}

/// At most `length` characters of a text, with control characters replaced.
pub(super) fn shortened_to(length: usize, text: &str) -> String {
    let rest = text.chars().nth(length).map(|_| '…');
    let start: String = text.chars().take(length).collect();
    printable(&start).chars().take(length).chain(rest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_keep_their_lines_across_gaps_and_parts() {
        let lines = [3, 4, 5, 9, 10, 20];
        for cut in 0..=lines.len() {
            let (mut first, mut second) = (LineRuns::default(), LineRuns::default());
            lines[..cut].iter().for_each(|&line| first.push(line));
            lines[cut..].iter().for_each(|&line| second.push(line));
            first.append(&second);
            let found: Vec<usize> = (0..lines.len())
                .map(|statement| first.line(statement))
                .collect();
            assert_eq!(found, lines);
            assert_eq!(first.runs.len(), 3, "{cut}");
            for line in 0..30 {
                let statement = lines.iter().position(|&at| at == line);
                assert_eq!(first.statement_on(line), statement, "{line}");
            }
        }
    }
}
