//! Fuzzes the reader and the writer of scene files: any bytes give a description or a clear error, without a panic, a
//! hang, or more memory than allowed; a description that is written reads back.
//!
//! `cargo test -p hitscope-core --test scene_file_fuzz` tries 20 000 inputs, or as many as `HITSCOPE_FUZZ` says;
//! `cargo test --release -p hitscope-core --test scene_file_fuzz -- 1000000 SEED` tries as many as given. It is a
//! program of its own because it counts the memory of all threads.

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

/// A scene with one element on each line, so that changes of lines keep many files well-formed.
const SCENE: &str = r#"<scene version="3.0.0">
<default name="q" value="2"/>
<default name="r" value="$q $q 1"/>
<integrator type="path"><integer name="max_depth" value="3"/></integrator>
<sensor type="perspective" id="s"><float name="fov" value="40"/><string name="fov_axis" value="y"/></sensor>
<sensor type="thinlens"><float name="aperture_radius" value="0.1"/><film type="hdrfilm"><integer name="width" value="9"/></film></sensor>
<sensor type="orthographic"><transform name="to_world"><scale value="$q"/></transform></sensor>
<emitter type="point" id="e"><point name="position" value="1 2 3"/><rgb name="intensity" value="1 2 3"/></emitter>
<emitter type="spot"><boolean name="b" value="true"/></emitter>
<emitter type="directional"><vector name="direction" value="0 0 -1"/></emitter>
<emitter type="constant"><spectrum name="radiance" value="0.5"/><texture type="bitmap"><ref id="t"/></texture></emitter>
<include filename="part.xml"/>
<bsdf type="twosided" id="m"><bsdf type="diffuse"><rgb name="reflectance" value="0.1,0.2,0.3"/></bsdf></bsdf>
<bsdf type="plastic" id="n"/>
<shape type="obj"><string name="filename" value="a &amp; b.obj"/><ref id="m"/></shape>
<shape type="sphere"><point name="center" x="1" y="$q" z="3"/><float name="radius" value="2"/></shape>
<shape type="cylinder"><bsdf type="diffuse"/><point name="p0" value="5"/></shape>
<shape type="rectangle"><transform name="to_world"><rotate y="1" angle="37"/><translate value="$r"/></transform></shape>
<shape type="disk"><transform name="to_world"><lookat origin="1,2,3" target="4,5,7" up="0,1,0"/></transform></shape>
<shape type="cube"><emitter type="area"><rgb name="radiance" value="3"/></emitter><boolean name="flip_normals" value="true"/></shape>
<shape type="cube"><transform name="to_world"><matrix value="1 2 3 4 5 6 7 8 9"/></transform><ref id="late"/></shape>
<shape type="plane"><vector name="normal" value="1 0 1"/></shape>
<shape type="box"><point name="max" value="2"/></shape>
<shape type="cone"><boolean name="capped" value="true"/></shape>
<shape type="torus"><float name="minor" value="0.1"/></shape>
<shape type="quadric"><float name="a" value="1"/><float name="j" value="-1"/></shape>
<shape type="csg"><string name="operation" value="difference"/>
<bsdf type="diffuse"/>
<shape type="sphere"/>
<shape type="cube"><bsdf type="diffuse"/></shape>
</shape>
<bsdf type="diffuse" id="late"><float name="reflectance" value="0.25"/></bsdf>
</scene>
"#;

const PART: &str = r#"<scene version="3.0.0">
<!-- A part. -->
<default name="p" value="1e3"/>
<shape type="sphere"><float name="radius" value="$p"/><ref id="m"/></shape>
<medium type="homogeneous"/>
</scene>
"#;

/// Pieces of scene files, valid and invalid.
const WORDS: [&str; 56] = [
    "<",
    ">",
    "/>",
    "</",
    "\"",
    "'",
    "=",
    "&",
    ";",
    "&amp;",
    "&#36;",
    "&#1;",
    "<!--",
    "-->",
    "<![CDATA[",
    "]]>",
    "<?",
    "?>",
    "<!DOCTYPE a [<!ENTITY b 'c'>]>",
    "&b;",
    "xmlns:a='b' ",
    "\0",
    "\u{FEFF}",
    "é",
    "\n",
    "$",
    "$q",
    "$r",
    "$$",
    "nan",
    "inf",
    "1e400",
    "1e308",
    "-1",
    "0",
    "1 2 3",
    "0.1",
    "1e-320",
    "99999999999999999999",
    "<include filename=\"part.xml\"/>\n",
    "<include filename=\"x.xml\"/>\n",
    "<default name=\"q\" value=\"$q$q\"/>\n",
    "<shape type=\"sphere\"/>\n",
    "<shape type=\"csg\">\n",
    "</shape>\n",
    "<bsdf type=\"twosided\">\n",
    "</bsdf>\n",
    "<ref id=\"m\"/>\n",
    "<transform name=\"to_world\">\n",
    "</transform>\n",
    "<rotate x=\"1\" angle=\"90\"/>\n",
    "id=\"m\" ",
    "name=\"radius\" ",
    "type=\"box\" ",
    "value=\"3\" ",
    "<scene version=\"3.0.0\">",
];

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
        let mut case = fuzzer.case(is_large);
        let place = format!("seed {seed}, input {input}");
        if is_large {
            // With a little less memory than it takes, the file must be refused in time.
            case.max_memory = 1 << 30;
            let peak = totals.try_one(&case, &place);
            case.max_memory = peak.saturating_sub(BYTES_ANYHOW + 1) as u64;
        }
        totals.try_one(&case, &place);
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
