//! What the reader learns of a file besides what it passes on.

use super::error::{Problem, Warning};
use std::collections::BTreeMap;

/// What the reader learnt on the way.
#[derive(Debug, Default)]
pub(super) struct Facts {
    pub vertex_count: usize,
    pub face_count: usize,
    pub normal_count: usize,
    /// Whether a face has a normal at each corner.
    pub face_has_normals: Vec<bool>,
    /// Runs of faces: the first one, and what it and those after it use.
    pub face_materials: Vec<(usize, String)>,
    pub face_groups: Vec<(usize, String)>,
    /// Names of material libraries, with the line.
    pub libraries: Vec<(usize, String)>,
    pub face_lines: LineRuns,
    /// Line and text of the statement that was passed on last.
    pub current: (usize, String),
    /// The highest index of a vertex and a normal, and the line of the face that has it.
    pub highest: [(usize, usize); 2],
    /// Statements that were left out: first line and count, by keyword.
    pub ignored: BTreeMap<String, (usize, usize)>,
}

impl Facts {
    /// The line, counted from 1, of an `f` statement, counted from 0.
    pub(super) fn face_line(&self, face: usize) -> usize {
        self.face_lines.line(face)
    }

    /// What was left out, a warning a keyword.
    pub(super) fn ignored_statements(&self) -> impl Iterator<Item = Warning> {
        self.ignored.iter().map(|(keyword, (line, count))| Warning {
            line: Some(*line),
            message: format!("{count} “{keyword}” statement(s) ignored"),
        })
    }

    /// What tobj objected to: the numbers on the line that it read last.
    pub(super) fn unexplained(&self, error: &tobj::LoadError) -> Problem {
        let (line, text) = &self.current;
        let words: Vec<&str> = text.split_whitespace().skip(1).collect();
        let message = match words.iter().find(|word| word.parse::<f64>().is_err()) {
            Some(word) => format!("“{}” is not a number", shortened(word)),
            None if words.len() < 3 => {
                format!("three coordinates are needed, here are {}", words.len())
            }
            None => error.to_string(),
        };
        Problem::Line(*line, message)
    }
}

/// Line numbers of statements, kept as runs of statements on consecutive lines.
#[derive(Debug, Default)]
pub(super) struct LineRuns {
    runs: Vec<(usize, usize)>,
    count: usize,
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

    pub(super) fn line(&self, statement: usize) -> usize {
        let run = self.runs.partition_point(|(first, _)| *first <= statement);
        match run.checked_sub(1).map(|run| self.runs[run]) {
            Some((first, line)) => line + statement - first,
            None => 0,
        }
    }
}

/// A word fit for a message.
pub(super) fn shortened(word: &str) -> String {
    const LENGTH: usize = 40;
    if word.chars().count() <= LENGTH {
        word.to_owned()
    } else {
        word.chars().take(LENGTH).chain(['…']).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statements_keep_their_lines_across_gaps() {
        let mut runs = LineRuns::default();
        let lines = [3, 4, 5, 9, 10, 20];
        lines.into_iter().for_each(|line| runs.push(line));
        let found: Vec<usize> = (0..lines.len())
            .map(|statement| runs.line(statement))
            .collect();
        assert_eq!(found, lines);
        assert_eq!(runs.runs.len(), 3);
    }
}
