//! `hitscope trace`: rays in, hits out.

use super::args::{KernelArg, MeshArgs};
use super::{CommandError, ThreadsArg, file_error, is_stdin};
use crate::inspection::position_in_file;
use clap::{Args, ValueEnum};
use glam::DVec3;
use hitscope_core::mesh::TriangleMesh;
use hitscope_core::obj::Recentre;
use hitscope_core::{Hit, Intersector, Ray, Scene};
use serde::Serialize;
use serde_json::json;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::thread::ScopedJoinHandle;
use std::time::{Duration, Instant};

/// Rays that are read, traced and printed at a time.
const BATCH: usize = 1 << 16;

/// Trace rays through a mesh and print a JSON object for each
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  hitscope trace bunny.obj --rays rays.txt
  echo '0 0.1 5 0 0 -1' | hitscope trace bunny.obj --rays - --all
  hitscope trace bunny.obj --rays rays.txt --kernel exact --summary")]
pub struct TraceArgs {
    /// OBJ file, plain or gzipped; - for standard input
    pub file: PathBuf,
    /// Rays, one a line: ox oy oz dx dy dz [tmin tmax] in the file's coordinates; - for stdin
    #[arg(long, value_name = "RAYS")]
    pub rays: PathBuf,
    /// Kernel
    #[command(flatten)]
    pub kernel: KernelArg,
    /// How the mesh is loaded.
    #[command(flatten)]
    pub mesh: MeshArgs,
    /// Whether positions are taken about an origin near the mesh before they are rounded to f32
    #[arg(long, default_value = "on")]
    pub recentre: RecentreArg,
    /// Tell only whether anything is hit
    #[arg(long, conflicts_with = "all")]
    pub any: bool,
    /// Tell every hit, not only the nearest
    #[arg(long)]
    pub all: bool,
    /// Print counts and speed only
    #[arg(long)]
    pub summary: bool,
    /// Threads.
    #[command(flatten)]
    pub threads: ThreadsArg,
}

/// Whether to recentre.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum RecentreArg {
    /// About an origin near the mesh, if it lies far from (0, 0, 0) for its size
    On,
    /// About (0, 0, 0)
    Off,
}

/// What is told of each ray.
#[derive(Clone, Copy)]
enum RayQuery {
    Closest,
    Any,
    All,
}

/// A line of input: nothing, a ray, or what is wrong with it.
type Line = Option<Result<Ray, String>>;

/// t in lengths of the direction as given, with no more digits than it has.
#[derive(Serialize)]
#[serde(untagged)]
enum Distance {
    InF32(f32),
    InF64(f64),
}

#[derive(Serialize)]
struct ClosestLine {
    hit: bool,
    #[serde(flatten)]
    line: HitLine,
}

#[derive(Serialize)]
struct HitLine {
    t: Distance,
    barycentric: [f32; 3],
    triangle: u32,
    face: u32,
    position: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    also: Option<Vec<u32>>,
}

#[derive(Default)]
struct Totals {
    rays: u64,
    hits: u64,
    tracing: Duration,
}

impl TraceArgs {
    /// Traces the rays and prints the answers in their order.
    ///
    /// # Errors
    /// See [`CommandError`]. A ray that can't be traced is no error: its line says why.
    pub fn run(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        if is_stdin(&self.file) && is_stdin(&self.rays) {
            let message = "the mesh and the rays can't both come from standard input";
            return Err(CommandError::Usage(message.to_owned()));
        }
        let recentre = match self.recentre {
            RecentreArg::On => Recentre::Auto,
            RecentreArg::Off => Recentre::Off,
        };
        let scene = self.mesh.load(&self.file, recentre)?.scene;
        let intersector = scene.intersector(self.kernel.kernel());
        let tracer = RayAnswerer {
            scene: &scene,
            intersector: &*intersector,
            query: match (self.any, self.all) {
                (true, _) => RayQuery::Any,
                (_, true) => RayQuery::All,
                _ => RayQuery::Closest,
            },
            is_summary: self.summary,
            threads: self.threads.count(),
        };
        let totals = tracer.run(&mut *open(&self.rays)?, &self.rays, out)?;
        if self.summary {
            let seconds = totals.tracing.as_secs_f64();
            let summary = json!({
                "rays": totals.rays,
                "hits": totals.hits,
                "seconds": seconds,
                "mrays_per_s": totals.rays as f64 / seconds.max(f64::MIN_POSITIVE) / 1e6,
            });
            writeln!(out, "{summary}")?;
        }
        Ok(out.flush()?)
    }
}

fn open(path: &Path) -> Result<Box<dyn BufRead>, CommandError> {
    if path == Path::new("-") {
        return Ok(Box::new(io::stdin().lock()));
    }
    let file = File::open(path).map_err(|source| file_error(path, source))?;
    Ok(Box::new(BufReader::new(file)))
}

struct RayAnswerer<'a> {
    scene: &'a Scene,
    intersector: &'a dyn Intersector,
    query: RayQuery,
    is_summary: bool,
    threads: usize,
}

impl RayAnswerer<'_> {
    fn run(
        &self,
        input: &mut dyn BufRead,
        path: &Path,
        out: &mut dyn Write,
    ) -> Result<Totals, CommandError> {
        let mut totals = Totals::default();
        let mut text = Vec::new();
        let mut is_at_end = false;
        while !is_at_end {
            let mut lines: Vec<Line> = Vec::new();
            while lines.len() < BATCH && !is_at_end {
                text.clear();
                let count = input.read_until(b'\n', &mut text);
                is_at_end = count.map_err(|source| file_error(path, source))? == 0;
                lines.push(self.parse(&String::from_utf8_lossy(&text)));
            }
            self.batch(&lines, &mut totals, out)?;
        }
        Ok(totals)
    }

    fn batch(
        &self,
        lines: &[Line],
        totals: &mut Totals,
        out: &mut dyn Write,
    ) -> Result<(), CommandError> {
        let start = Instant::now();
        let per_thread = lines.len().div_ceil(self.threads).max(1);
        let parts: Vec<(String, u64)> = std::thread::scope(|scope| {
            let start = |lines| {
                let answer = move || self.answer_all(lines);
                let thread = std::thread::Builder::new().spawn_scoped(scope, answer);
                (lines, thread.ok())
            };
            let parts: Vec<_> = lines.chunks(per_thread).map(start).collect();
            let finish = |(lines, thread): (&[Line], Option<ScopedJoinHandle<'_, _>>)| match thread
            {
                Some(thread) => thread.join().expect("tracing doesn't panic"),
                // Where the system grants no more threads, this one does the work.
                None => self.answer_all(lines),
            };
            parts.into_iter().map(finish).collect()
        });
        totals.tracing += start.elapsed();
        totals.rays += lines.iter().flatten().filter(|line| line.is_ok()).count() as u64;
        for (text, hits) in parts {
            totals.hits += hits;
            out.write_all(text.as_bytes())?;
        }
        Ok(())
    }

    /// The lines to be printed, and how many rays hit.
    fn answer_all(&self, lines: &[Line]) -> (String, u64) {
        let mut text = String::new();
        let mut hits = 0;
        for line in lines.iter().flatten() {
            let answer = match line {
                Ok(ray) if self.is_summary => {
                    hits += u64::from(self.is_hit(ray));
                    continue;
                }
                Ok(ray) => self.answer(ray, &mut hits),
                Err(_) if self.is_summary => continue,
                Err(error) => json!({ "error": error }).to_string(),
            };
            text += &answer;
            text.push('\n');
        }
        (text, hits)
    }

    /// For a summary: the same work, without the printing.
    fn is_hit(&self, ray: &Ray) -> bool {
        match self.query {
            RayQuery::Closest => self.intersector.closest_hit(ray).is_some(),
            RayQuery::Any => self.intersector.any_hit(ray),
            RayQuery::All => !self.intersector.all_hits(ray).is_empty(),
        }
    }

    fn answer(&self, ray: &Ray, hits: &mut u64) -> String {
        let mesh = self.scene.mesh();
        let miss = || json!({ "hit": false }).to_string();
        match self.query {
            RayQuery::Any => {
                let is_hit = self.intersector.any_hit(ray);
                *hits += u64::from(is_hit);
                json!({ "hit": is_hit }).to_string()
            }
            RayQuery::Closest => self.intersector.closest_hit(ray).map_or_else(miss, |hit| {
                *hits += 1;
                to_json(&ClosestLine {
                    hit: true,
                    line: HitLine::new(mesh, ray, &hit, None),
                })
            }),
            RayQuery::All => {
                let found = self.intersector.all_hits(ray);
                *hits += u64::from(!found.is_empty());
                let crossings: Vec<HitLine> = found
                    .into_iter()
                    .map(|crossing| HitLine::new(mesh, ray, &crossing.hit, Some(crossing.also)))
                    .collect();
                format!("{{\"hits\":{}}}", to_json(&crossings))
            }
        }
    }

    fn parse(&self, line: &str) -> Line {
        let line = line.trim_start_matches('\u{feff}');
        let statement = line.split('#').next().unwrap_or_default().trim();
        (!statement.is_empty()).then(|| self.ray(statement))
    }

    /// A ray in the mesh's coordinates, rounded to f32, from one in the file's.
    fn ray(&self, statement: &str) -> Result<Ray, String> {
        let mut numbers = Vec::with_capacity(8);
        for word in statement.split_whitespace() {
            let number: Result<f64, _> = word.parse();
            numbers.push(number.map_err(|_| format!("“{word}” is not a number"))?);
        }
        let (t_min, t_max) = match numbers.len() {
            6 => (0.0, f32::INFINITY),
            8 => (numbers[6] as f32, numbers[7] as f32),
            count => return Err(format!("a ray has 6 or 8 numbers, here are {count}")),
        };
        let origin = DVec3::from_slice(&numbers) - self.scene.mesh().origin;
        let dir = DVec3::from_slice(&numbers[3..]);
        Ray::with_interval(origin.as_vec3(), dir.as_vec3(), t_min, t_max).map_err(|e| e.to_string())
    }
}

impl HitLine {
    fn new(mesh: &TriangleMesh, ray: &Ray, hit: &Hit, also: Option<Vec<u32>>) -> Self {
        let t = ray.t_as_given(hit.t);
        Self {
            t: if f64::from(t as f32) == t {
                Distance::InF32(t as f32)
            } else {
                Distance::InF64(t)
            },
            barycentric: hit.barycentric(),
            triangle: hit.primitive,
            face: mesh.face_of(hit.primitive),
            position: position_in_file(mesh, hit),
            also,
        }
    }
}

fn to_json(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("a hit is plain data")
}
