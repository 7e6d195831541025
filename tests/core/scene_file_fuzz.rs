//! Fuzzes the reader and the writer of scene files: any bytes give a description or a clear error, without a panic, a
//! hang, or more memory than allowed; a description that is written reads back.
//!
//! `cargo test -p hitscope-core --test scene_file_fuzz` tries 20 000 inputs, or as many as `HITSCOPE_FUZZ` says;
//! `cargo test --release -p hitscope-core --test scene_file_fuzz -- 1000000 SEED` tries as many as given. It is a
//! program of its own because it counts the memory of all threads.

#[path = "scene_file_fuzz/texts.rs"]
mod texts;

use cpu_time::ProcessTime;
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use hitscope_core::scene_file::{
    self, Emitter, EmitterKind, Place, Plugin, SceneFile, Shape, ShapeKind,
};
use peak_alloc::PeakAlloc;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::Duration;
use texts::{NUMBERED, PART, SCENE, WORDS};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Number of inputs unless the environment or the command line sets it.
const INPUTS: u64 = 20_000;
/// Memory beyond the limit: messages, short lists and warnings, of which at most 100 are kept.
const BYTES_ANYHOW: usize = 1 << 17;
/// One input in this many is large.
const LARGE_EVERY: u64 = 200;
const LARGE_BYTES: usize = 1 << 18;
/// CPU time; anything longer counts as a hang.
const LONGEST: Duration = Duration::from_secs(2);

fn main() {
    let from_environment = std::env::var("HITSCOPE_FUZZ").ok();
    let from_environment = from_environment.and_then(|count| count.parse().ok());
    let mut arguments = std::env::args()
        .skip(1)
        .filter_map(|word| word.parse().ok());
    let inputs: u64 = arguments.next().or(from_environment).unwrap_or(INPUTS);
    let seed: u64 = arguments.next().unwrap_or(1);
    let mut totals = Totals::default();
    totals.try_one(&Case::unchanged(), "unchanged");
    for input in 0..inputs {
        // Each input has its own seed, so that it can be repeated alone.
        let mut fuzzer = Fuzzer(Random::new(seed.wrapping_mul(1 << 32) + input));
        let is_large = input % LARGE_EVERY == LARGE_EVERY - 1;
        let case = fuzzer.case(is_large);
        let place = format!("seed {seed}, input {input}");
        if is_large {
            totals.try_with_too_little(case, &place);
        } else {
            totals.try_one(&case, &place);
        }
    }
    for line in NUMBERED {
        for copies in [10_000, 60_000] {
            let case = Case::numbered(line, copies);
            totals.try_with_too_little(case, &format!("{copies} times {line}"));
        }
    }
    eprintln!("{inputs} inputs, seed {seed}: {totals:?}");
    let is_good = totals.failures == 0 && totals.scenes > 0 && totals.errors > 0;
    std::process::exit(i32::from(!is_good));
}

/// A scene file, the file that it may include, and the memory limit.
struct Case {
    scene: Vec<u8>,
    part: Vec<u8>,
    max_memory: u64,
}

impl Case {
    fn unchanged() -> Self {
        Self {
            scene: SCENE.as_bytes().to_vec(),
            part: PART.as_bytes().to_vec(),
            max_memory: 1 << 20,
        }
    }

    /// A scene of copies of a line, with the copy's number in place of `ID`.
    fn numbered(line: &str, copies: usize) -> Self {
        let lines = (0..copies).map(|k| line.replace("ID", &k.to_string()) + "\n");
        let lines: String = lines.collect();
        Self {
            scene: format!("<scene version='3.0.0'>\n{lines}</scene>").into_bytes(),
            ..Self::unchanged()
        }
    }
}

struct Fuzzer(Random);

impl Fuzzer {
    fn below(&mut self, count: usize) -> usize {
        self.0.index(count)
    }

    fn case(&mut self, is_large: bool) -> Case {
        let mut case = Case::unchanged();
        case.max_memory = 1 << (14 + self.below(13));
        let victim = match self.below(4) {
            0 => &mut case.part,
            _ => &mut case.scene,
        };
        let mut bytes = std::mem::take(victim);
        if is_large {
            bytes = self.enlarged(&bytes);
        }
        for _ in 0..self.below(6) {
            self.change_lines(&mut bytes);
        }
        if self.below(2) == 0 {
            for _ in 0..=self.below(4) {
                self.change_bytes(&mut bytes);
            }
        }
        if self.below(50) == 0 {
            let text = String::from_utf8_lossy(&bytes);
            let units = text.encode_utf16().flat_map(u16::to_le_bytes);
            bytes = [0xFF, 0xFE].into_iter().chain(units).collect();
        }
        *victim = bytes;
        case
    }

    /// Repeats a line until the file is large.
    fn enlarged(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut lines: Vec<&[u8]> = bytes.split_inclusive(|&b| b == b'\n').collect();
        let at = self.below(lines.len());
        let line = lines[at];
        let copies = LARGE_BYTES / line.len().max(1);
        lines.splice(at..at, std::iter::repeat_n(line, copies));
        lines.concat()
    }

    /// Makes one change to whole lines: deletes, copies or swaps them, or inserts a word between them.
    fn change_lines(&mut self, bytes: &mut Vec<u8>) {
        let mut lines: Vec<&[u8]> = bytes.split_inclusive(|&b| b == b'\n').collect();
        if lines.is_empty() {
            return;
        }
        let (a, b) = (self.below(lines.len()), self.below(lines.len()));
        match self.below(4) {
            0 => drop(lines.remove(a)),
            1 => lines.insert(b, lines[a]),
            2 => lines.swap(a, b),
            _ => lines.insert(a, WORDS[self.below(WORDS.len())].as_bytes()),
        }
        *bytes = lines.concat();
    }

    /// Makes one change: replaces a byte, flips a bit, deletes or copies a piece, replaces a value, inserts a word, or
    /// truncates.
    fn change_bytes(&mut self, bytes: &mut Vec<u8>) {
        if bytes.is_empty() {
            bytes.extend(SCENE.as_bytes());
        }
        let at = self.below(bytes.len());
        let length = self.below(24).min(bytes.len() - at);
        let word = WORDS[self.below(WORDS.len())].as_bytes();
        match self.below(9) {
            0 => bytes[at] = self.below(256) as u8,
            1 => bytes[at] ^= 1 << self.below(8),
            2 => drop(bytes.drain(at..at + length)),
            3 => {
                let piece = bytes[at..at + length].to_vec();
                let to = self.below(bytes.len());
                bytes.splice(to..to, piece);
            }
            4 if self.below(8) == 0 => bytes.truncate(at),
            5 | 6 => {
                let quote = |&b: &u8| b == b'"';
                let start = bytes[at..]
                    .iter()
                    .position(quote)
                    .map_or(at, |k| at + k + 1);
                let end = bytes[start..]
                    .iter()
                    .position(quote)
                    .map_or(start, |k| start + k);
                bytes.splice(start..end, word.to_vec());
            }
            _ => drop(bytes.splice(at..at, word.to_vec())),
        }
    }
}

#[derive(Debug, Default)]
struct Totals {
    scenes: u64,
    errors: u64,
    failures: u64,
    slowest: Duration,
    /// Largest memory in percent of the limit, of limits above 1 MB.
    most_percent: usize,
}

impl Totals {
    /// Tries a case with enough memory, and with a little less than it took: then, it must be refused in time.
    fn try_with_too_little(&mut self, mut case: Case, place: &str) {
        case.max_memory = 1 << 30;
        let peak = self.try_one(&case, place);
        case.max_memory = peak.saturating_sub(BYTES_ANYHOW + 1) as u64;
        self.try_one(&case, place);
    }

    /// Tries a case, and returns the memory that it took.
    fn try_one(&mut self, case: &Case, place: &str) -> usize {
        MEMORY.reset_peak_usage();
        let (before, start) = (MEMORY.current_usage(), ProcessTime::now());
        let read = catch_unwind(AssertUnwindSafe(|| parse(&case.scene, case)));
        let (took, peak) = (start.elapsed(), MEMORY.peak_usage() - before);
        self.slowest = self.slowest.max(took);
        let limit = case.max_memory as usize;
        if limit > 1 << 20 {
            self.most_percent = self.most_percent.max(peak * 100 / limit);
        }
        if peak > limit + BYTES_ANYHOW {
            self.fail(
                place,
                case,
                &format!("{peak} bytes with a limit of {limit}"),
            );
        }
        if took > LONGEST {
            self.fail(place, case, &format!("took {took:?}"));
        }
        match read {
            Err(_) => self.fail(place, case, "panicked"),
            Ok(Ok(scene)) => {
                self.scenes += 1;
                if let Some(fault) = fault_of(scene, case) {
                    self.fail(place, case, &fault);
                }
            }
            Ok(Err(error)) => {
                self.errors += 1;
                let message = error.to_string();
                let is_clear = message.starts_with("x.xml:") || message.starts_with("part.xml:");
                if !is_clear || message.contains('\n') || message.len() > 2000 {
                    self.fail(place, case, &message);
                }
            }
        }
        peak
    }

    fn fail(&mut self, place: &str, case: &Case, what: &str) {
        self.failures += 1;
        if self.failures <= 5 {
            eprintln!("{place}: {what}");
            for bytes in [&case.scene, &case.part] {
                let shown = &bytes[..bytes.len().min(600)];
                eprintln!("--- {}", String::from_utf8_lossy(shown));
                // The line that makes a file large.
                let lines: Vec<&[u8]> = bytes.split(|&b| b == b'\n').collect();
                let runs = lines.chunk_by(|a, b| a == b);
                let longest = runs.max_by_key(|run| run.len());
                if let Some(run) = longest.filter(|run| run.len() > 100) {
                    let line = String::from_utf8_lossy(run[0]);
                    eprintln!("--- {} times {line}", run.len());
                }
            }
        }
    }
}

fn parse(bytes: &[u8], case: &Case) -> Result<SceneFile, hitscope_core::obj::LoadError> {
    let read = |path: &Path, max_bytes: u64| match path.to_str() {
        Some("part.xml") if case.part.len() as u64 > max_bytes => {
            Err(io::Error::other("too large"))
        }
        Some("part.xml") => Ok(case.part.clone()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let path = Path::new("x.xml");
    scene_file::parse(bytes, path, case.max_memory, &read, &Progress::default())
}

/// Describes a defect of a description, or `None`.
fn fault_of(scene: SceneFile, case: &Case) -> Option<String> {
    let text = match scene_file::to_xml(&scene, Path::new("")) {
        Ok(text) => text,
        Err(error) => return Some(error.to_string()),
    };
    let large = Case {
        max_memory: 1 << 30,
        part: case.part.clone(),
        scene: Vec::new(),
    };
    match parse(text.as_bytes(), &large) {
        Ok(again) if without_places(again.clone()) == without_places(scene) => None,
        Ok(_) => Some(format!("reads back differently: {text}")),
        Err(error) => Some(format!("reads back with the error {error}: {text}")),
    }
}

/// A description without places, files and warnings.
fn without_places(mut scene: SceneFile) -> SceneFile {
    fn of_plugin(plugin: &mut Plugin) {
        plugin.place = Place::default();
        let parameters = plugin.parameters.iter_mut();
        parameters.for_each(|parameter| parameter.place = Place::default());
        plugin.children.iter_mut().for_each(of_plugin);
    }
    fn of_emitter(emitter: &mut Emitter) {
        emitter.place = Place::default();
        if let EmitterKind::Other(plugin) = &mut emitter.kind {
            of_plugin(plugin);
        }
    }
    fn of_shape(shape: &mut Shape) {
        shape.place = Place::default();
        shape
            .emitter
            .iter_mut()
            .for_each(|emitter| of_emitter(emitter));
        if let ShapeKind::Csg(csg) = &mut shape.kind {
            csg.children.iter_mut().for_each(of_shape);
        }
    }
    scene.shapes.iter_mut().for_each(of_shape);
    let materials = scene.materials.iter_mut();
    materials.for_each(|material| material.place = Place::default());
    let sensors = scene.sensors.iter_mut();
    sensors.for_each(|sensor| sensor.place = Place::default());
    scene.emitters.iter_mut().for_each(of_emitter);
    let integrator = scene.integrator.iter_mut();
    integrator.for_each(|integrator| of_plugin(&mut integrator.plugin));
    scene.files.clear();
    scene.warnings.clear();
    scene
}
