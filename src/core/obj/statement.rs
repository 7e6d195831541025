//! What does a statement say, and what is tobj to see of it?
//!
//! tobj is given plain `v`, `vt`, `vn` and `f` lines only, whose indices were checked: so it never meets
//! the input that makes it panic or change geometry without a word. All else is noted in [`Facts`].

use super::Faults;
use super::corner::{Corner, Corners, LISTS, is_blank};
use super::error::Problem;
use super::facts::{Element, Facts, LineRuns, NO_INDEX, shortened};
use super::lines::Statement;
use super::words::{Words, is_of_number, name, number, text, without_comment};
use std::io::Write as _;

/// Statements on their way to tobj.
pub(super) struct Sorter {
    pub facts: Facts,
    /// What tobj is to read next, and which line of the file each of its lines comes from.
    pub out: Vec<u8>,
    pub out_lines: LineRuns,
    faults: Faults,
    /// How many there are in each list, where an earlier reading found that out.
    known_counts: Option<[usize; 3]>,
}

impl Sorter {
    pub(super) fn new(faults: Faults, known_counts: Option<[usize; 3]>) -> Self {
        Self {
            facts: Facts::default(),
            out: Vec::new(),
            out_lines: LineRuns::default(),
            faults,
            known_counts,
        }
    }

    /// Notes a statement, and adds what tobj is to see of it.
    pub(super) fn take(&mut self, statement: Statement<'_>) -> Result<(), Problem> {
        let Statement { line, bytes } = statement;
        let start = bytes.iter().position(|&b| !is_blank(b));
        let Some(start) = start else { return Ok(()) };
        let length = bytes[start..].iter().position(|&b| is_blank(b));
        let after = length.map_or(bytes.len(), |length| start + length);
        match &bytes[start..after] {
            b"v" => self.numbers(0, line, without_comment(bytes), after)?,
            b"vt" => self.numbers(1, line, without_comment(bytes), after)?,
            b"vn" => self.numbers(2, line, without_comment(bytes), after)?,
            b"f" => self.element(None, line, without_comment(bytes), after)?,
            b"l" => self.element(Some(Element::Line), line, without_comment(bytes), after)?,
            b"p" => self.element(Some(Element::Points), line, without_comment(bytes), after)?,
            keyword => self.note(keyword, line, &bytes[after..]),
        }
        Ok(())
    }

    /// Statements that tobj needn't see.
    fn note(&mut self, keyword: &[u8], line: usize, rest: &[u8]) {
        let facts = &mut self.facts;
        match keyword {
            b"usemtl" => facts.materials.begin(facts.face_count, name(rest)),
            b"o" | b"g" => facts.groups.begin(facts.face_count, name(rest)),
            b"mtllib" => facts.add_library(line, name(rest)),
            b"s" => {
                let group = smoothing_group(&name(without_comment(rest)));
                if facts
                    .smoothing
                    .last()
                    .is_none_or(|&(_, last)| last != group)
                {
                    facts.smoothing.push((facts.face_count, group));
                }
            }
            _ if keyword[0] == b'#' => {}
            _ => {
                facts.ignore(&shortened(&text(keyword)), line);
            }
        }
    }

    /// The numbers of a vertex (three, perhaps a weight or a colour), of texture coordinates (one to
    /// three, of which two count) or of a normal (three).
    fn numbers(
        &mut self,
        list: usize,
        line: usize,
        bytes: &[u8],
        after: usize,
    ) -> Result<(), Problem> {
        let words = || Words {
            line: bytes,
            at: after,
        };
        let (word_count, is_plain) = words().fold((0, true), |(count, is_plain), (_, word)| {
            (count + 1, is_plain && word.iter().all(|&b| is_of_number(b)))
        });
        let least = if list == 1 { 1 } else { 3 };
        if word_count < least {
            let what = if list == 1 {
                "one number is"
            } else {
                "three numbers are"
            };
            let message = format!("{what} needed, here are {word_count}");
            return Err(Problem::line(line, message));
        }
        let wanted = if list == 1 { 2 } else { 3 };
        if is_plain && word_count == wanted {
            self.out.extend(bytes);
        } else {
            self.out.extend([&b"v"[..], b"vt", b"vn"][list]);
            for (offset, word) in words().take(wanted) {
                number::<f64>(line, bytes, (offset, word))?;
                self.out.push(b' ');
                self.out.extend(word);
            }
            if word_count < wanted {
                self.out.extend(b" 0");
            }
        }
        self.end_line(line);
        self.facts.counts[list] += 1;
        // x y z w has a weight, which polygons don't use; x y z r g b (a) a colour.
        if list == 0 && word_count >= 6 {
            let mut colour = [0.0; 3];
            for (channel, (offset, word)) in colour.iter_mut().zip(words().skip(3)) {
                *channel = number(line, bytes, (offset, word))?;
            }
            let facts = &mut self.facts;
            facts.colours.resize(facts.counts[0] - 1, [1.0; 3]);
            facts.colours.push(colour);
            facts.coloured += 1;
        }
        Ok(())
    }

    /// A face, or what tobj is to take for one so that it reads its vertices.
    fn element(
        &mut self,
        element: Option<Element>,
        line: usize,
        bytes: &[u8],
        after: usize,
    ) -> Result<(), Problem> {
        let before = self.facts.corners[0].len();
        let lists_before = self.facts.corners.each_ref().map(Vec::len);
        let mut is_as_written = element.is_none();
        for corner in (Corners {
            line: bytes,
            at: after,
        }) {
            let corner =
                corner.map_err(|bad| Problem::word(line, bytes, bad.offset, bad.message))?;
            match self.corner(corner, line, bytes)? {
                Resolved::AsWritten => {}
                Resolved::Changed => is_as_written = false,
                Resolved::Impossible => {
                    self.drop_element(lists_before, line);
                    return Ok(());
                }
            }
        }
        let count = self.facts.corners[0].len() - before;
        let least = match element {
            None => 3,
            Some(Element::Line) => 2,
            Some(Element::Points) => 1,
        };
        if count < least {
            if self.faults == Faults::Lenient {
                self.drop_element(lists_before, line);
                return Ok(());
            }
            let what = [
                "a point list needs one corner",
                "a line needs two corners",
                "a face needs three corners",
            ];
            let message = format!("{}, this one has {count}", what[least - 1]);
            return Err(Problem::line(line, message));
        }
        if is_as_written {
            self.out.extend(bytes);
        } else {
            self.write_corners(before);
        }
        self.end_line(line);
        let facts = &mut self.facts;
        if let Some(element) = element {
            facts.no_faces.push((facts.element_count, element));
        } else {
            facts.face_count += 1;
            facts.face_lines.push(line);
        }
        facts.element_count += 1;
        Ok(())
    }

    /// Checks a corner's indices and adds them to the lists.
    fn corner(&mut self, corner: Corner, line: usize, bytes: &[u8]) -> Result<Resolved, Problem> {
        let mut resolved = Resolved::AsWritten;
        for list in 0..3 {
            let mut index = NO_INDEX;
            if let Some(written) = corner.indices[list] {
                match self.index(list, written, line) {
                    Some(found) => index = found,
                    None if self.faults == Faults::Strict && !self.is_idle(list) => {
                        let count = self.known_counts.unwrap_or(self.facts.counts)[list];
                        let message = out_of_range(list, written, count);
                        return Err(Problem::word(line, bytes, corner.offset, message));
                    }
                    None if list == 0 => return Ok(Resolved::Impossible),
                    None => {
                        self.facts.bare.add(line);
                        resolved = Resolved::Changed;
                    }
                }
            }
            let corner_index = self.facts.corners[0].len() - usize::from(list > 0);
            let indices = &mut self.facts.corners[list];
            if index != NO_INDEX || !indices.is_empty() {
                indices.resize(corner_index, NO_INDEX);
                indices.push(index);
            }
        }
        Ok(resolved)
    }

    /// Whether nothing is in the list of texture coordinates: see [`Facts::forget_idle_textures`].
    fn is_idle(&self, list: usize) -> bool {
        list == 1 && self.facts.counts[1] == 0
    }

    /// An index counted from 0. One that is too high may still come true further down, unless it is known
    /// how many there are.
    fn index(&mut self, list: usize, written: i64, line: usize) -> Option<u32> {
        let count = self.facts.counts[list];
        let from_one = if written < 0 {
            count as i64 + 1 + written
        } else {
            written
        };
        // The last number of u32 marks a missing index, and more no file can have.
        if from_one <= 0 || from_one >= i64::from(NO_INDEX) {
            return None;
        }
        if self
            .known_counts
            .is_some_and(|counts| from_one > counts[list] as i64)
        {
            return None;
        }
        let from_one = from_one as usize;
        if from_one > self.facts.highest[list].0 {
            self.facts.highest[list] = (from_one, line);
        }
        Some(from_one as u32 - 1)
    }

    fn drop_element(&mut self, lists_before: [usize; 3], line: usize) {
        for (list, length) in self.facts.corners.iter_mut().zip(lists_before) {
            list.truncate(length);
        }
        self.facts.dropped.add(line);
    }

    /// The corners from `first` on, with what is known to be there.
    fn write_corners(&mut self, first: usize) {
        self.out.push(b'f');
        let [vertices, ..] = &self.facts.corners;
        for corner in first..vertices.len() {
            let [vertex, texture, normal] = self
                .facts
                .corners
                .each_ref()
                .map(|list| list.get(corner).copied().unwrap_or(NO_INDEX));
            let of = |index: u32| match index {
                NO_INDEX => String::new(),
                index => (index + 1).to_string(),
            };
            let written = write!(self.out, " {}/{}/{}", vertex + 1, of(texture), of(normal));
            written.expect("a vector takes all bytes");
        }
    }

    /// Ends the list of faces that tobj gathers before it copies what they use: small lists, and no long
    /// work that can't be stopped, at the end of a file.
    pub(super) fn cut(&mut self, line: usize) {
        self.out.push(b'g');
        self.end_line(line);
    }

    fn end_line(&mut self, line: usize) {
        self.out.push(b'\n');
        self.out_lines.push(line);
    }

    /// What is wrong with a number in the line that tobj read last, the end of which is at `consumed`.
    pub(super) fn unexplained(&self, consumed: usize, error: &tobj::LoadError) -> Problem {
        let read = self.out[..consumed].strip_suffix(b"\n").unwrap_or_default();
        let start = read
            .iter()
            .rposition(|&b| b == b'\n')
            .map_or(0, |at| at + 1);
        let line = self
            .out_lines
            .line(memchr::memchr_iter(b'\n', read).count());
        let bytes = &read[start..];
        let words = Words { line: bytes, at: 0 }.skip(1);
        for (offset, word) in words {
            if let Err(problem) = number::<f64>(line, bytes, (offset, word)) {
                return problem;
            }
        }
        Problem::line(line, error.to_string())
    }
}

/// What became of a corner.
enum Resolved {
    AsWritten,
    /// tobj must not see it as it is written.
    Changed,
    /// There is no such vertex.
    Impossible,
}

pub(super) fn out_of_range(list: usize, written: i64, count: usize) -> String {
    let what = LISTS[list];
    match written {
        0 => format!("{what} index 0; indices start at 1"),
        _ => format!("{what} index {written} is out of range: there are {count}"),
    }
}

/// `off` and 0 are no group; a number that is none, neither.
fn smoothing_group(word: &str) -> u32 {
    match word {
        "on" => 1,
        _ => word.parse().unwrap_or(0),
    }
}
