//! Fuzzes the OBJ reader: any bytes give a mesh or a clear error, without a panic, a hang, or more memory
//! than the file's size allows.
//!
//! `cargo test -p hitscope-core --test fuzz` tries 30 000 inputs;
//! `cargo test --release -p hitscope-core --test fuzz -- 10000000 SEED` tries as many as given. It is a
//! program of its own because it counts the memory of all threads.

use cpu_time::ProcessTime;
use glam::Vec3;
use hitscope_core::mesh::{Attributes, Crease, Health, NO_INDEX, VertexNormals};
use hitscope_core::obj::{self, FaultPolicy, LoadOptions, Recentre};
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use peak_alloc::PeakAlloc;
use std::io;
use std::path::Path;
use std::time::Duration;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// Number of inputs unless the command line sets it.
const INPUTS: u64 = 30_000;
/// Memory that loading may use per byte of the file, and independent of its size (buffers and gzip's state).
/// Short faces use most: `f 1 1 1` and its line end are 8 bytes, and become three indices and a triangle with its face
/// number and outline, 29 bytes, each in a list of up to twice the size that is copied once when the chunks are put
/// together: 15 per byte. As many again for the tree of lists around them in small files.
const BYTES_PER_BYTE: usize = 32;
const BYTES_ANYHOW: usize = 2 << 20;
/// One input in this many is large.
const LARGE_EVERY: u64 = 1000;
const LARGE_BYTES: usize = 1 << 20;
/// CPU time; anything longer counts as a hang.
const LONGEST: Duration = Duration::from_secs(1);

/// Words found in OBJ and MTL files, valid and invalid.
const WORDS: [&[u8]; 64] = [
    b"v",
    b"vn",
    b"vt",
    b"f",
    b"o",
    b"g",
    b"usemtl",
    b"mtllib",
    b"s",
    b"l",
    b"p",
    b"#",
    b"\\",
    b"\\\n",
    b"\n",
    b"\n",
    b"\r\n",
    b"\r",
    b"0",
    b"1",
    b"2",
    b"3",
    b"-1",
    b"-3",
    b"1e400",
    b"nan",
    b"-inf",
    b"1.5",
    b"1e-45",
    b"3e38",
    b"1//1",
    b"2//1",
    b"3/1",
    b"1/1/1",
    b"-1/-1/-1",
    b"/",
    b"4294967295",
    b"4294967296",
    b"6148914691236517206",
    b"-9223372036854775808",
    b"x",
    b"1,5",
    b"\xEF\xBB\xBF",
    b"\0",
    b"\xE9",
    b"\xC2\xA0",
    b"off",
    b"m.mtl",
    b"newmtl",
    b"Kd",
    b"Ks",
    b"Ke",
    b"Ns",
    b"d",
    b"-halo",
    b"Tr",
    b"illum",
    b"map_Kd",
    b"-s",
    b"-o",
    b"-bm",
    b"t.png",
    b"a",
    b"\x1F\x8B",
];

const MESH: &[u8] = b"mtllib m.mtl\nv 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 1\nvn 0 0 1\n\
    g a\ns 1\nusemtl a\nf 1 2 3\nf 1/1/1 2/2/1 4/1/1\nf 1//1 3 2 4\nusemtl b\nl 1 2 3\np 4\nf -1 -2 -3\ns off\nf 1 2 3 4 2\n";
const LIBRARY: &[u8] =
    b"newmtl a\nKd 0.5 0.5 0.5\nmap_Kd -s 2 2 t.png\nd 0.5\nnewmtl b\nKs 1 1 1\nNs 20\nillum 2\n";
const TEXTURE: &[u8] = include_bytes!("obj/files/texel.png");

fn main() {
    let mut arguments = std::env::args()
        .skip(1)
        .filter_map(|word| word.parse().ok());
    let inputs: u64 = arguments.next().unwrap_or(INPUTS);
    let seed: u64 = arguments.next().unwrap_or(1);
    let mut totals = Totals::default();
    for (name, case) in hard_polygons() {
        totals.try_one(&case, name);
    }
    for input in 0..inputs {
        // Each input has its own seed, so that it can be repeated alone.
        let mut fuzzer = Fuzzer(Random::new(seed.wrapping_mul(1 << 32) + input));
        let mut case = fuzzer.case();
        if input % LARGE_EVERY == LARGE_EVERY - 1 {
            case.mesh = case.mesh.repeat(1 + LARGE_BYTES / case.mesh.len().max(1));
        }
        totals.try_one(&case, &format!("seed {seed}, input {input}"));
    }
    eprintln!("{inputs} inputs, seed {seed}: {totals:?}");
    let is_good = totals.failures == 0;
    std::process::exit(i32::from(!is_good));
}

/// Polygons for which ear clipping takes time cubic in the number of corners.
fn hard_polygons() -> [(&'static str, Case); 3] {
    const COUNT: usize = 30_000;
    let mut random = Random::new(9);
    let star = (0..COUNT).map(|i| {
        let step = 2.000_000_1 * std::f64::consts::PI * (COUNT as f64 / 2.0 - 1.0) / COUNT as f64;
        let (sin, cos) = (step * i as f64).sin_cos();
        [cos, sin]
    });
    let noise = (0..COUNT).map(|_| [(); 2].map(|()| random.index(1 << 20) as f64));
    // A comb whose teeth are sheared by half its width.
    let comb = (0..COUNT).map(|i| {
        let (tooth, is_tip) = ((i / 2) as f64, matches!(i % 4, 1 | 2));
        [
            tooth + if is_tip { COUNT as f64 / 4.0 } else { 0.0 },
            f64::from(u8::from(is_tip)),
        ]
    });
    let comb = comb.chain([[COUNT as f64, -9.0], [0.0, -9.0]]);
    [
        ("star", polygon(star)),
        ("noise", polygon(noise)),
        ("comb", polygon(comb)),
    ]
}

/// A file with a single polygon.
fn polygon(corners: impl Iterator<Item = [f64; 2]>) -> Case {
    let (mut mesh, mut face) = (String::new(), String::from("f"));
    for (k, [x, y]) in corners.enumerate() {
        mesh += &format!("v {x} {y} 0\n");
        face += &format!(" {}", k + 1);
    }
    Case {
        mesh: (mesh + &face + "\n").into_bytes(),
        library: Vec::new(),
        texture: TEXTURE.to_vec(),
        options: LoadOptions {
            max_memory: 64 << 20,
            ..LoadOptions::default()
        },
    }
}

/// A mesh file, its library and its texture.
#[derive(Clone)]
struct Case {
    mesh: Vec<u8>,
    library: Vec<u8>,
    texture: Vec<u8>,
    options: LoadOptions,
}

struct Fuzzer(Random);

impl Fuzzer {
    fn below(&mut self, count: usize) -> usize {
        self.0.index(count)
    }

    fn case(&mut self) -> Case {
        let mut case = Case {
            mesh: MESH.to_vec(),
            library: LIBRARY.to_vec(),
            texture: TEXTURE.to_vec(),
            options: LoadOptions {
                recentre: [Recentre::Auto, Recentre::Off][self.below(2)],
                faults: [FaultPolicy::Strict, FaultPolicy::Lenient][self.below(2)],
                max_memory: 64 << 20,
                keeps_coordinates: self.below(2) == 0,
            },
        };
        let victim = match self.below(10) {
            0 | 1 => &mut case.library,
            2 => &mut case.texture,
            _ => &mut case.mesh,
        };
        let mut bytes = std::mem::take(victim);
        for _ in 0..=self.below(8) {
            self.change(&mut bytes);
        }
        *victim = bytes;
        case
    }

    /// Makes one change: replaces a byte, flips a bit, deletes or copies a piece, inserts a word, or
    /// truncates.
    fn change(&mut self, bytes: &mut Vec<u8>) {
        if bytes.is_empty() {
            bytes.extend(MESH);
        }
        let at = self.below(bytes.len());
        let length = self.below(24).min(bytes.len() - at);
        match self.below(8) {
            0 => bytes[at] = self.below(256) as u8,
            1 => bytes[at] ^= 1 << self.below(8),
            2 => drop(bytes.drain(at..at + length)),
            3 => {
                let piece = bytes[at..at + length].to_vec();
                let to = self.below(bytes.len());
                bytes.splice(to..to, piece);
            }
            4 if self.below(4) == 0 => bytes.truncate(at),
            _ => {
                let word = WORDS[self.below(WORDS.len())];
                bytes.splice(at..at, [b" ", word, b" "].concat());
            }
        }
    }
}

#[derive(Debug, Default)]
struct Totals {
    meshes: u64,
    errors: u64,
    failures: u64,
    slowest: Duration,
    /// Largest memory beyond [`BYTES_ANYHOW`] per byte of the file.
    most_bytes_per_byte: usize,
}

impl Totals {
    fn try_one(&mut self, case: &Case, place: &str) {
        let files = |name: &str| match name {
            "m.mtl" => Ok(case.library.clone()),
            "t.png" => Ok(case.texture.clone()),
            _ => Err(io::ErrorKind::NotFound.into()),
        };
        let (path, bytes) = (Path::new("x.obj"), &case.mesh[..]);
        MEMORY.reset_peak_usage();
        let (before, start) = (MEMORY.current_usage(), ProcessTime::now());
        let result = obj::parse(bytes, path, case.options, &files, &Progress::default());
        let (took, peak) = (start.elapsed(), MEMORY.peak_usage() - before);
        self.slowest = self.slowest.max(took);
        let size = case.mesh.len() + case.library.len();
        let per_byte = peak.saturating_sub(BYTES_ANYHOW) / size.max(1);
        // A texture's memory is bounded by the memory limit alone.
        if case.texture == TEXTURE {
            self.most_bytes_per_byte = self.most_bytes_per_byte.max(per_byte);
            if per_byte > BYTES_PER_BYTE {
                self.fail(place, case, &format!("{peak} bytes for a file of {size}"));
            }
        }
        if took > LONGEST {
            self.fail(place, case, &format!("took {took:?}"));
        }
        match result {
            Ok(loaded) => {
                self.meshes += 1;
                if let Some(fault) = fault_of(&loaded) {
                    self.fail(place, case, &fault);
                }
            }
            Err(error) => {
                self.errors += 1;
                let message = error.to_string();
                if message.contains("unexpectedly") {
                    self.fail(place, case, &message);
                }
            }
        }
    }

    fn fail(&mut self, place: &str, case: &Case, what: &str) {
        self.failures += 1;
        if self.failures <= 5 {
            eprintln!("{place}: {what}");
            for bytes in [&case.mesh, &case.library] {
                let shown = &bytes[..bytes.len().min(600)];
                eprintln!("--- {}", shown.escape_ascii());
            }
        }
    }
}

/// Describes a defect of the mesh, or `None`.
fn fault_of(loaded: &obj::Loaded) -> Option<String> {
    let mesh = &loaded.mesh;
    if mesh.triangles().is_empty() {
        return Some("a mesh without triangles".to_owned());
    }
    for triangle in 0..mesh.triangles().len() as u32 {
        if !mesh.corners(triangle).iter().all(|p| p.is_finite()) {
            return Some(format!("triangle {triangle} isn't finite"));
        }
        // Zero is allowed: f64 finds no area in the thinnest triangles.
        let normal = mesh.geometric_normal(triangle);
        if !normal.is_normalized() && normal != Vec3::ZERO {
            return Some(format!("triangle {triangle} has the normal {normal}"));
        }
        if mesh.attributes().materials.of(triangle).is_none() {
            return Some(format!("triangle {triangle} has no material"));
        }
        let Attributes {
            normals,
            texture_coordinates,
            ..
        } = mesh.attributes();
        let exists = |index: u32, count: usize| index == NO_INDEX || (index as usize) < count;
        let of_normals = normals
            .indices(triangle)
            .map(|k| exists(k, normals.values().len()));
        let coordinates = texture_coordinates.values().len();
        let of_textures = texture_coordinates
            .indices(triangle)
            .map(|k| exists(k, coordinates));
        if [of_normals, of_textures].as_flattened().contains(&false) {
            return Some(format!(
                "triangle {triangle} refers to a value that doesn't exist"
            ));
        }
    }
    // Normals and health checks mustn't panic, either.
    for crease in [Crease::FromFile, Crease::Above(0.5)] {
        let normals = VertexNormals::of(mesh, crease);
        if !normals.of_triangle(mesh, 0).iter().all(|n| n.is_finite()) {
            return Some("a normal isn't finite".to_owned());
        }
    }
    _ = Health::of(mesh);
    None
}
