//! Passes a file's plain lines on to tobj.

use super::corner::List;
use super::error::Problem;
use super::facts::Facts;
use super::lines::Lines;
use super::statement::StatementRouter;
use super::{FaultPolicy, LoadOptions};
use crate::progress::Progress;
use std::io::{self, BufRead, Read};

/// Bytes passed to tobj at a time.
const PIECE: usize = 1 << 16;
/// Corners of triangles are numbered by u32, and the largest vertex number marks a missing one.
const MOST_TRIANGLES: usize = u32::MAX as usize / 3;
const MOST_ENTRIES: usize = u32::MAX as usize - 1;
/// Faces per list of tobj's. A list takes 104 bytes per face; shorter lists would copy more vertices twice.
const FACES_PER_CUT: usize = 1 << 14;
/// Statements between two checks of their memory, whether or not tobj gets them.
const STATEMENTS_PER_CHECK: usize = 1 << 12;

/// See the [module](self). Pass it to tobj as a `BufRead`, then call [`finish`](Self::finish).
pub(super) struct NormalisingReader<'p> {
    lines: Lines<'p>,
    router: StatementRouter,
    consumed: usize,
    max_memory: u64,
    problem: Option<Problem>,
}

/// Result of a read.
pub(super) enum Outcome {
    /// The whole file was read, and every index is in range.
    Read(Box<Facts>),
    /// Some indices are too high, as known only at the end of the file. The file must be read again with these
    /// counts.
    Again([usize; 3]),
}

impl<'p> NormalisingReader<'p> {
    /// # Errors
    /// The source can't be read, or isn't an OBJ.
    pub(super) fn new(
        bytes: impl Read + 'p,
        options: &LoadOptions,
        known_counts: Option<[usize; 3]>,
        progress: &'p Progress,
    ) -> Result<Self, Problem> {
        let mut lines = Lines::new(bytes, progress)?;
        lines.limit_lines(options.max_memory);
        lines.require_obj()?;
        Ok(Self {
            lines,
            router: StatementRouter::new(options.faults, known_counts),
            consumed: 0,
            max_memory: options.max_memory,
            problem: None,
        })
    }

    /// Returns the facts, or the error in the file. `parsed` is tobj's error, if any.
    pub(super) fn finish(mut self, parsed: Option<&tobj::LoadError>) -> Result<Outcome, Problem> {
        if let Some(problem) = self.problem {
            return Err(problem);
        }
        if self.lines.is_at_end() {
            self.router.facts.forget_idle_textures();
            self.router.facts.has_garbage = self.lines.has_garbage();
        }
        let facts = &self.router.facts;
        // The counts are known only at the end of the file.
        if !facts.is_complete() && self.lines.is_at_end() {
            if self.router.faults == FaultPolicy::Lenient {
                return Ok(Outcome::Again(facts.counts));
            }
            for list in List::ALL {
                let (highest, line) = facts.highest[list as usize];
                let count = facts.counts[list as usize];
                if highest > count {
                    let message = list.out_of_range(highest as i64, count);
                    return Err(Problem::line(line, message));
                }
            }
        }
        match parsed {
            Some(error) => Err(self.router.unexplained(self.consumed, error)),
            None => Ok(Outcome::Read(Box::new(self.router.facts))),
        }
    }

    /// Prepares the next lines for tobj; leaves none at the end of the file.
    fn next_piece(&mut self) -> Result<(), Problem> {
        self.router.out.clear();
        self.router.out_lines.clear();
        self.consumed = 0;
        let mut statements = 0;
        while self.router.out.len() < PIECE {
            let Some(statement) = self.lines.next()? else {
                return self.check_memory();
            };
            let line = statement.line;
            self.router.take(statement)?;
            statements += 1;
            if statements % STATEMENTS_PER_CHECK == 0 {
                self.check_memory()?;
            }
            let facts = &self.router.facts;
            if facts.elements_since_cut() >= FACES_PER_CUT && facts.is_complete() {
                self.router.cut(line);
            }
        }
        self.check_memory()
    }

    fn check_memory(&mut self) -> Result<(), Problem> {
        let facts = &mut self.router.facts;
        if facts.triangle_count() > MOST_TRIANGLES || facts.counts.iter().any(|&n| n > MOST_ENTRIES)
        {
            let message = "more vertices or triangles than 32-bit indices allow".to_owned();
            return Err(Problem::Content(message));
        }
        if facts.bytes() as u64 > self.max_memory {
            return Err(Problem::Content(format!(
                "loading needs more than the {} MB of memory allowed (--max-memory)",
                self.max_memory >> 20
            )));
        }
        Ok(())
    }
}

impl Read for NormalisingReader<'_> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let available = self.fill_buf()?;
        let count = available.len().min(out.len());
        out[..count].copy_from_slice(&available[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for NormalisingReader<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.consumed == self.router.out.len()
            && self.problem.is_none()
            && let Err(problem) = self.next_piece()
        {
            self.problem = Some(problem);
        }
        if self.problem.is_some() {
            // tobj only has to stop; `finish` returns the reason.
            return Err(io::ErrorKind::InvalidData.into());
        }
        Ok(&self.router.out[self.consumed..])
    }

    fn consume(&mut self, count: usize) {
        self.consumed += count;
    }
}
