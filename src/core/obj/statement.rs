//! Records each statement, and passes plain ones on to tobj.
//!
//! tobj gets only plain `v`, `vt`, `vn` and `f` lines with valid indices, so that it never sees input that
//! makes it panic or silently change the geometry. Everything else is recorded in [`Facts`].

use super::FaultPolicy;
use super::corner::{Corner, Corners, List, is_blank};
use super::error::Problem;
use super::facts::{Element, Facts, LineRuns, shortened};
use super::lines::Statement;
use super::words::{
    WordCount, Words, count_words, is_long_number, name, number, text, without_comment,
};
use crate::counts::{counted, grouped};
use crate::mesh::NO_INDEX;
use std::io::Write as _;

/// Routes statements to tobj or to [`Facts`].
pub(super) struct StatementRouter {
    pub facts: Facts,
    /// Text for tobj to read next; `out_lines` gives the file's line of each of its lines.
    pub out: Vec<u8>,
    pub out_lines: LineRuns,
    pub faults: FaultPolicy,
    /// Number of entries in each list, if an earlier read counted them.
    known_counts: Option<[usize; 3]>,
}

/// How a corner, or all corners of an element, were resolved.
enum Resolved {
    AsWritten,
    /// tobj must get other indices than those in the file.
    Changed,
    /// A vertex doesn't exist, or there are too few corners.
    Impossible,
}

impl StatementRouter {
    pub(super) fn new(faults: FaultPolicy, known_counts: Option<[usize; 3]>) -> Self {
        Self {
            facts: Facts::default(),
            out: Vec::new(),
            out_lines: LineRuns::default(),
            faults,
            known_counts,
        }
    }

    /// Records a statement, and appends tobj's line for it, if any.
    pub(super) fn take(&mut self, statement: Statement<'_>) -> Result<(), Problem> {
        let bytes = statement.bytes;
        let start = bytes.iter().position(|&b| !is_blank(b));
        let Some(start) = start else { return Ok(()) };
        let length = bytes[start..].iter().position(|&b| is_blank(b));
        let after = length.map_or(bytes.len(), |length| start + length);
        let plain = Statement {
            bytes: without_comment(bytes),
            ..statement
        };
        match &bytes[start..after] {
            b"v" => self.numbers(List::Vertex, plain, after)?,
            b"vt" => self.numbers(List::Texture, plain, after)?,
            b"vn" => self.numbers(List::Normal, plain, after)?,
            b"f" => self.element(Element::Face, plain, after)?,
            b"l" => self.element(Element::Line, plain, after)?,
            b"p" => self.element(Element::Points, plain, after)?,
            keyword => self.note(keyword, statement.line, &bytes[after..]),
        }
        Ok(())
    }

    /// Records a statement that tobj doesn't read.
    fn note(&mut self, keyword: &[u8], line: usize, rest: &[u8]) {
        let facts = &mut self.facts;
        match keyword {
            b"usemtl" => facts.materials.begin(name(rest)),
            b"o" | b"g" => facts.groups.begin(name(rest)),
            b"mtllib" => facts.libraries.add(line, name(rest)),
            b"s" => facts.begin_smoothing(smoothing_group(&name(without_comment(rest)))),
            _ if keyword[0] == b'#' => {}
            _ => facts.ignore(&shortened(&text(keyword)), line),
        }
    }

    /// Checks the numbers of a vertex (three, optionally a weight or a colour), of texture coordinates (one
    /// to three, of which two are used) or of a normal (three).
    fn numbers(
        &mut self,
        list: List,
        statement: Statement<'_>,
        after: usize,
    ) -> Result<(), Problem> {
        /// A word of at most this many bytes has at most 15 digits.
        const SHORT: usize = 15;
        let words = Words::of(statement.bytes, after);
        let WordCount {
            words: count,
            longest,
            is_plain,
        } = count_words(statement.bytes, after);
        let (least, used, keyword) = match list {
            List::Vertex => (3, 3, "v"),
            List::Texture => (1, 2, "vt"),
            List::Normal => (3, 3, "vn"),
        };
        if count < least {
            return Err(statement.problem(format!(
                "“{keyword}” needs {}, found {}",
                counted(least, "number"),
                grouped(count)
            )));
        }
        if is_plain && count == used {
            self.out.extend(statement.bytes);
        } else {
            self.out.extend(keyword.bytes());
            for (index, (offset, word)) in words.clone().enumerate() {
                number::<f64>(&statement, (offset, word))?;
                if index < used {
                    self.out.push(b' ');
                    self.out.extend(word);
                }
            }
            if count < used {
                self.out.extend(b" 0");
            }
        }
        if list == List::Vertex && longest > SHORT {
            let mut used = words.clone().take(3);
            self.facts.has_long_numbers |= used.any(|(_, word)| is_long_number(word));
        }
        self.end_line(statement.line);
        self.facts.counts[list as usize] += 1;
        // `x y z w` has a weight, which polygons don't use; `x y z r g b (a)` a colour.
        if list == List::Vertex && count >= 6 {
            let mut colour = [0.0; 3];
            for (channel, word) in colour.iter_mut().zip(words.skip(3)) {
                *channel = number(&statement, word)?;
            }
            self.facts.add_colour(colour);
        }
        Ok(())
    }

    /// Passes on a face, or a line or points as a face, so that tobj reads their vertices.
    fn element(
        &mut self,
        element: Element,
        statement: Statement<'_>,
        after: usize,
    ) -> Result<(), Problem> {
        let first = self.facts.corners[0].len();
        let is_plain = element == Element::Face && self.plain_face(statement.bytes, after);
        let corners = if is_plain {
            Resolved::AsWritten
        } else {
            self.corners(element, &statement, after)?
        };
        match corners {
            Resolved::AsWritten => self.out.extend(statement.bytes),
            Resolved::Changed => self.write_corners(first),
            Resolved::Impossible => return Ok(()),
        }
        self.end_line(statement.line);
        let corner_count = self.facts.corners[0].len() - first;
        self.facts.largest_face = self.facts.largest_face.max(corner_count);
        self.facts.add_element(element, statement.line);
        Ok(())
    }

    /// Checks an element's corners and adds them to the lists; adds none if the element is dropped.
    fn corners(
        &mut self,
        element: Element,
        statement: &Statement<'_>,
        after: usize,
    ) -> Result<Resolved, Problem> {
        let before = self.facts.corners.each_ref().map(Vec::len);
        let mut is_as_written = element == Element::Face;
        for corner in Corners::of(statement.bytes, after) {
            let corner = corner.map_err(|bad| statement.problem_at(bad.offset, bad.message))?;
            match self.corner(corner, statement)? {
                Resolved::AsWritten => {}
                Resolved::Changed => is_as_written = false,
                Resolved::Impossible => {
                    self.facts.drop_element(element, before, statement.line);
                    return Ok(Resolved::Impossible);
                }
            }
        }
        let count = self.facts.corners[0].len() - before[0];
        let (least, what) = element.least_corners();
        if count < least {
            if self.faults == FaultPolicy::Lenient {
                self.facts.drop_element(element, before, statement.line);
                return Ok(Resolved::Impossible);
            }
            return Err(statement.problem(format!("{what}, this one has {count}")));
        }
        Ok(if is_as_written {
            Resolved::AsWritten
        } else {
            Resolved::Changed
        })
    }

    /// Fast path for a face whose corners are plain numbers of vertices already read; returns `false` and
    /// adds nothing for any other face. Most lines of large files are such faces; without this path loading
    /// took 7 % longer (2026-11).
    fn plain_face(&mut self, line: &[u8], mut at: usize) -> bool {
        /// Number of digits that always fits u32.
        const MOST_DIGITS: usize = 9;
        let count = self.facts.counts[0];
        let [vertices, textures, normals] = &mut self.facts.corners;
        if !textures.is_empty() || !normals.is_empty() {
            return false;
        }
        let before = vertices.len();
        loop {
            while line.get(at).is_some_and(|&b| is_blank(b)) {
                at += 1;
            }
            if at == line.len() {
                break;
            }
            let (start, mut index) = (at, 0);
            while let Some(digit) = line.get(at).map(|b| b.wrapping_sub(b'0'))
                && digit < 10
                && at - start < MOST_DIGITS
            {
                index = 10 * index + usize::from(digit);
                at += 1;
            }
            let is_whole = line.get(at).is_none_or(|&b| is_blank(b));
            if !is_whole || index == 0 || index > count {
                vertices.truncate(before);
                return false;
            }
            vertices.push(index as u32 - 1);
        }
        let is_face = vertices.len() - before >= 3;
        if !is_face {
            vertices.truncate(before);
        }
        is_face
    }

    /// Checks a corner's indices and adds them to the lists.
    fn corner(&mut self, corner: Corner, statement: &Statement<'_>) -> Result<Resolved, Problem> {
        let mut resolved = Resolved::AsWritten;
        for list in List::ALL {
            let mut index = NO_INDEX;
            if let Some(written) = corner.indices[list as usize] {
                match self.index(list, written, statement.line) {
                    Some(found) => index = found,
                    None if self.faults == FaultPolicy::Strict && !self.facts.is_idle(list) => {
                        let count = self.known_counts.unwrap_or(self.facts.counts)[list as usize];
                        let message = list.out_of_range(written, count);
                        return Err(statement.problem_at(corner.offset, message));
                    }
                    None if list == List::Vertex => return Ok(Resolved::Impossible),
                    None => {
                        self.facts.bare.add(statement.line);
                        resolved = Resolved::Changed;
                    }
                }
            }
            let corner_index = self.facts.corners[0].len() - usize::from(list != List::Vertex);
            let indices = &mut self.facts.corners[list as usize];
            if index != NO_INDEX || !indices.is_empty() {
                indices.resize(corner_index, NO_INDEX);
                indices.push(index);
            }
        }
        Ok(resolved)
    }

    /// Converts an index to start at 0. An index that is too high may become valid later in the file, unless
    /// the final counts are known.
    fn index(&mut self, list: List, written: i64, line: usize) -> Option<u32> {
        let at = list as usize;
        let from_one = if written < 0 {
            self.facts.counts[at] as i64 + 1 + written
        } else {
            written
        };
        // The largest u32 marks a missing index; larger indices can't occur in any file.
        if from_one <= 0 || from_one >= i64::from(NO_INDEX) {
            return None;
        }
        if self
            .known_counts
            .is_some_and(|counts| from_one > counts[at] as i64)
        {
            return None;
        }
        let from_one = from_one as usize;
        if from_one > self.facts.highest[at].0 {
            self.facts.highest[at] = (from_one, line);
        }
        Some(from_one as u32 - 1)
    }

    /// Writes the corners from `first` on with their resolved indices.
    fn write_corners(&mut self, first: usize) {
        self.out.push(b'f');
        for corner in first..self.facts.corners[0].len() {
            let lists = self.facts.corners.each_ref();
            let [vertex, texture, normal] =
                lists.map(|list| list.get(corner).copied().unwrap_or(NO_INDEX));
            let of = |index: u32| match index {
                NO_INDEX => String::new(),
                index => (index + 1).to_string(),
            };
            let written = write!(self.out, " {}/{}/{}", vertex + 1, of(texture), of(normal));
            written.expect("a vector takes all bytes");
        }
    }

    /// Ends tobj's current list of faces. tobj copies the vertices that a list uses; small lists avoid long
    /// work at the end of the file that can't be cancelled.
    pub(super) fn cut(&mut self, line: usize) {
        self.out.push(b'g');
        self.end_line(line);
        self.facts.cut();
    }

    fn end_line(&mut self, line: usize) {
        self.out.push(b'\n');
        self.out_lines.push(line);
    }

    /// The error in a number on the line that tobj read last, which ends at `consumed`.
    pub(super) fn unexplained(&self, consumed: usize, error: &tobj::LoadError) -> Problem {
        let read = self.out[..consumed].strip_suffix(b"\n").unwrap_or_default();
        let start = read
            .iter()
            .rposition(|&b| b == b'\n')
            .map_or(0, |at| at + 1);
        let statement = Statement {
            line: self
                .out_lines
                .line(memchr::memchr_iter(b'\n', read).count()),
            bytes: &read[start..],
            is_joined: false,
        };
        let problem = Words::of(statement.bytes, 0)
            .skip(1)
            .find_map(|word| number::<f64>(&statement, word).err());
        problem.unwrap_or_else(|| statement.problem(error.to_string()))
    }
}

/// The number of a smoothing group: 1 for `on`; 0 (no group) for `off` and anything else that isn't a number.
fn smoothing_group(word: &str) -> u32 {
    match word {
        "on" => 1,
        _ => word.parse().unwrap_or(0),
    }
}
