//! A reader that sees every line before tobj does.
//!
//! It joins continued lines, strips comments and a byte order mark, resolves and checks the indices
//! of faces, notes groups, materials and line numbers, and passes on plain `v x y z`, `vn x y z` and
//! `f a//n …` only. So tobj sees one model, keeps each vertex once, and never meets the input that
//! makes it panic or change geometry without a word.

use super::error::Problem;
use super::facts::{Facts, shortened};
use crate::progress::{Phase, Progress};
use std::io::{self, BufRead, Read, Write as _};

/// Read in pieces of this size, between which a cancel is noticed.
const CHUNK: usize = 1 << 18;
/// A longer line isn't read to its end: a polygon of ten million corners would fit.
const LONGEST_LINE: usize = 128 << 20;

/// See the [module](self). Give it to tobj as a `BufRead`, then ask [`finish`](Self::finish).
pub(super) struct NormalisingReader<'p, R> {
    source: R,
    progress: &'p Progress,
    /// Bytes read and not yet split into lines, from `start` on.
    buffer: Vec<u8>,
    start: usize,
    is_at_end: bool,
    line: usize,
    /// The statement to pass on, and how much of it is consumed.
    out: Vec<u8>,
    consumed: usize,
    facts: Facts,
    problem: Option<Problem>,
}

impl<'p, R: Read> NormalisingReader<'p, R> {
    pub(super) fn new(source: R, progress: &'p Progress) -> Self {
        Self {
            source,
            progress,
            buffer: Vec::new(),
            start: 0,
            is_at_end: false,
            line: 0,
            out: Vec::new(),
            consumed: 0,
            facts: Facts::default(),
            problem: None,
        }
    }

    /// What was learnt, or what was wrong with the file.
    pub(super) fn finish(mut self) -> Result<Facts, Problem> {
        if let Some(problem) = self.problem {
            return Err(problem);
        }
        let counts = [
            ("vertex", self.facts.vertex_count),
            ("normal", self.facts.normal_count),
        ];
        for ((what, count), (highest, line)) in counts.into_iter().zip(self.facts.highest) {
            // Only a whole file tells how many there are.
            if highest > count && self.is_at_end {
                return Err(Problem::Line(
                    line,
                    out_of_range(what, highest as i64, count),
                ));
            }
        }
        self.facts.current.1 = String::from_utf8_lossy(&self.out).into_owned();
        Ok(self.facts)
    }

    /// Reads until a statement is there to be passed on; `out` stays empty at the end.
    fn next_statement(&mut self) -> Result<(), Problem> {
        self.out.clear();
        self.consumed = 0;
        let mut text = String::new();
        while self.out.is_empty() && self.next_line(&mut text)? {
            let line = self.line;
            // A backslash at the end continues the statement on the next line.
            while text.ends_with('\\') {
                text.pop();
                let mut more = String::new();
                if !self.next_line(&mut more)? {
                    break;
                }
                text.push(' ');
                text.push_str(&more);
            }
            self.statement(&text, line)?;
            self.facts.current.0 = line;
        }
        Ok(())
    }

    /// The next line's statement, without a byte order mark. Lines end in LF, CR or CRLF.
    fn next_line(&mut self, text: &mut String) -> Result<bool, Problem> {
        let mut searched = 0;
        let (end, next) = loop {
            let rest = &self.buffer[self.start..];
            let found = rest[searched..]
                .iter()
                .position(|&b| b == b'\n' || b == b'\r');
            match found.map(|at| at + searched) {
                // A CR at the very end may be half of a CRLF: read on to know.
                Some(at) if rest[at] == b'\n' || at + 1 < rest.len() || self.is_at_end => {
                    let is_pair = rest[at] == b'\r' && rest.get(at + 1) == Some(&b'\n');
                    break (at, at + 1 + usize::from(is_pair));
                }
                _ if self.is_at_end && rest.is_empty() => return Ok(false),
                _ if self.is_at_end => break (rest.len(), rest.len()),
                found => searched = found.unwrap_or(rest.len()),
            }
            self.fill()?;
        };
        self.line += 1;
        let mut bytes = &self.buffer[self.start..self.start + end];
        if self.line == 1 {
            bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
            if let Some(message) = not_an_obj(bytes) {
                return Err(Problem::Content(message.to_owned()));
            }
        }
        *text = statement_of(bytes);
        self.start += next;
        Ok(true)
    }

    fn fill(&mut self) -> Result<(), Problem> {
        self.progress.check()?;
        self.buffer.drain(..self.start);
        self.start = 0;
        let before = self.buffer.len();
        if before > LONGEST_LINE {
            let message = format!("a line of more than {} MB", LONGEST_LINE >> 20);
            return Err(Problem::Line(self.line + 1, message));
        }
        self.buffer.resize(before + CHUNK, 0);
        let count = loop {
            match self.source.read(&mut self.buffer[before..]) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                other => break other.map_err(Problem::Read)?,
            }
        };
        self.buffer.truncate(before + count);
        self.is_at_end = count == 0;
        if self.is_at_end {
            // What is left to do is to number vertices and to triangulate.
            self.progress.enter(Phase::Checking);
        }
        self.progress.add_read(count as u64);
        if self.line == 0 && self.buffer.contains(&0) {
            return Err(Problem::Content(BINARY.to_owned()));
        }
        Ok(())
    }

    /// Notes a statement, and puts into `out` what tobj is to see of it.
    fn statement(&mut self, text: &str, line: usize) -> Result<(), Problem> {
        let (keyword, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        let rest = rest.trim();
        let facts = &mut self.facts;
        match keyword {
            "v" => {
                facts.vertex_count += 1;
                self.pass_on_three(keyword, rest);
            }
            "vn" => {
                facts.normal_count += 1;
                self.pass_on_three(keyword, rest);
            }
            "f" => self.face(rest, line)?,
            "usemtl" => facts
                .face_materials
                .push((facts.face_count, rest.to_owned())),
            "o" | "g" => facts.face_groups.push((facts.face_count, rest.to_owned())),
            "mtllib" => facts.libraries.push((line, rest.to_owned())),
            // Texture coordinates and smoothing groups: nothing asks for them yet.
            "" | "vt" | "s" => {}
            _ => {
                let keyword = shortened(keyword);
                facts.ignored.entry(keyword).or_insert((line, 0)).1 += 1;
            }
        }
        Ok(())
    }

    /// Three coordinates; a weight or a colour after them has no part in polygons.
    fn pass_on_three(&mut self, keyword: &str, rest: &str) {
        self.out.extend(keyword.bytes());
        for word in rest.split_whitespace().take(3) {
            self.out.push(b' ');
            self.out.extend(word.bytes());
        }
        self.out.push(b'\n');
    }

    fn face(&mut self, rest: &str, line: usize) -> Result<(), Problem> {
        let mut corners: Vec<(usize, Option<usize>)> = Vec::with_capacity(4);
        for word in rest.split_whitespace() {
            let corner = self.corner(word, line);
            corners.push(corner.map_err(|message| Problem::Line(line, message))?);
        }
        if corners.len() < 3 {
            let message = format!("a face needs three corners, this one has {}", corners.len());
            return Err(Problem::Line(line, message));
        }
        // A face with normals at some corners only is taken as one without.
        let has_normals = corners.iter().all(|(_, normal)| normal.is_some());
        self.out.extend(b"f");
        for (vertex, normal) in corners {
            let written = match normal {
                Some(normal) if has_normals => write!(self.out, " {vertex}//{normal}"),
                _ => write!(self.out, " {vertex}"),
            };
            written.map_err(Problem::Read)?;
        }
        self.out.push(b'\n');
        self.facts.face_count += 1;
        self.facts.face_lines.push(line);
        self.facts.face_has_normals.push(has_normals);
        Ok(())
    }

    /// The vertex and the normal of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1.
    fn corner(&mut self, word: &str, line: usize) -> Result<(usize, Option<usize>), String> {
        let mut parts = word.split('/');
        let vertex = parts.next().unwrap_or_default();
        let (texture, normal) = (
            parts.next().unwrap_or_default(),
            parts.next().unwrap_or_default(),
        );
        if parts.next().is_some() {
            return Err(format!(
                "“{}” has more than vertex/texture/normal",
                shortened(word)
            ));
        }
        if !texture.is_empty() && texture.parse::<i64>().is_err() {
            return Err(format!(
                "“{}” in “{}” is not an index",
                shortened(texture),
                shortened(word)
            ));
        }
        let vertex = self.index(0, vertex, word, line)?;
        if normal.is_empty() {
            return Ok((vertex, None));
        }
        Ok((vertex, Some(self.index(1, normal, word, line)?)))
    }

    /// An index as a positive number: −1 is the last one so far. One that is too high may still
    /// come true further down, so that is checked at the end.
    fn index(&mut self, kind: usize, part: &str, word: &str, line: usize) -> Result<usize, String> {
        let (what, count) = [
            ("vertex", self.facts.vertex_count),
            ("normal", self.facts.normal_count),
        ][kind];
        let index: i64 = part.parse().map_err(|_| {
            format!(
                "“{}” in “{}” is not an index",
                shortened(part),
                shortened(word)
            )
        })?;
        let resolved = if index < 0 {
            count as i64 + 1 + index
        } else {
            index
        };
        // More than u32 holds no file can have, and tobj multiplies them unchecked.
        if resolved <= 0 || resolved > i64::from(u32::MAX) {
            return Err(out_of_range(what, index, count));
        }
        let resolved = resolved as usize;
        if resolved > self.facts.highest[kind].0 {
            self.facts.highest[kind] = (resolved, line);
        }
        Ok(resolved)
    }
}

impl<R: Read> Read for NormalisingReader<'_, R> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let available = self.fill_buf()?;
        let count = available.len().min(out.len());
        out[..count].copy_from_slice(&available[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl<R: Read> BufRead for NormalisingReader<'_, R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.consumed == self.out.len()
            && self.problem.is_none()
            && let Err(problem) = self.next_statement()
        {
            self.problem = Some(problem);
            // tobj only has to stop; `finish` tells the reason.
            return Err(io::ErrorKind::InvalidData.into());
        }
        Ok(&self.out[self.consumed..])
    }

    fn consume(&mut self, count: usize) {
        self.consumed += count;
    }
}

fn out_of_range(what: &str, index: i64, count: usize) -> String {
    match index {
        0 => format!("{what} index 0; indices start at 1"),
        _ => format!("{what} index {index} is out of range: there are {count}"),
    }
}

/// A line without blanks around it and without a comment. Names keep their `#`, as exporters write
/// `usemtl Material #27`. Bytes that aren't UTF-8 are read as Latin-1.
pub(super) fn statement_of(line: &[u8]) -> String {
    let text = match str::from_utf8(line) {
        Ok(text) => text.to_owned(),
        Err(_) => line.iter().map(|&b| char::from(b)).collect(),
    };
    let keyword = text.split_whitespace().next().unwrap_or_default();
    let is_name = ["o", "g", "usemtl", "mtllib", "newmtl"].contains(&keyword);
    let statement = match text.split_once('#') {
        Some((before, _)) if !is_name => before,
        _ => &text,
    };
    statement.trim().to_owned()
}

const BINARY: &str = "this is a binary file, not an OBJ file";

/// What a file is, if its first line shows that it is no OBJ.
fn not_an_obj(first_line: &[u8]) -> Option<&'static str> {
    let start = first_line.trim_ascii_start();
    let begins =
        |with: &[u8]| start.len() >= with.len() && start[..with.len()].eq_ignore_ascii_case(with);
    if begins(b"<!doctype") || begins(b"<html") {
        Some("this is an HTML page, not an OBJ file")
    } else if begins(b"<?xml") {
        Some("this is an XML file, not an OBJ file")
    } else if first_line.contains(&0) {
        Some(BINARY)
    } else {
        None
    }
}
