//! `hitscope trace`: traces rays from a file or stream and prints their hits.

mod answers;
mod lines;

use super::args::MeshArgs;
use super::kernel::KernelArg;
use super::{ClipArgs, CommandError, ThreadsArg, file_error, is_stdin};
use crate::frames::Frames;
use crate::json;
use answers::{RayAnswerer, RayQuery, Request};
use clap::{Args, ValueEnum};
use hitscope_core::obj::Recentre;
use lines::{LineSplitter, Lines, Next, Pieces};
use serde::Serialize;
use std::fs::File;
use std::io::{self, Read, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::thread::{Builder, ScopedJoinHandle};
use std::time::{Duration, Instant};

/// Lines that are parsed, traced and printed together; a batch may exceed it by one piece of input.
const BATCH: usize = 1 << 16;
/// Minimum number of lines per thread; for fewer, a thread costs as much as it saves.
const LEAST_PER_THREAD: usize = 256;

const ABOUT: &str = "\
Trace rays through a scene and print one JSON object per ray

Input: one ray per line, as six or eight numbers in the file's coordinates.

  ox oy oz dx dy dz [tmin tmax]

A ray is the points o + t*d with tmin < t < tmax, by default 0 < t < infinity.
d needn't have unit length. # starts a comment. Lines end in LF, CR or CRLF
and have at most 65536 bytes. Whenever no more input is available, all lines
read so far are answered.

Output: one JSON object per ray, in the order of the input. Blank lines and
comments produce no output.

  {\"hit\":true,\"t\":2.0,\"barycentric\":[0.25,0.5,0.25],\"triangle\":10,\"face\":5,
   \"position\":[0.25,0.5,1.0],\"normal\":[0.0,0.0,1.0],\"line\":1,\"ray_rounding\":0.0}
  {\"hit\":false,\"line\":2,\"ray_rounding\":0.0}
  {\"error\":\"expected 6 or 8 numbers, found 5\",\"line\":3}

  t             distance from o, in lengths of d
  barycentric   barycentric coordinates for the triangle's corners A, B and C
  shape         the shape that is hit, if it isn't a triangle: sphere, plane,
                disk, ...; instead of barycentric, triangle and face
  primitive     index of that primitive, counted from 0: triangles come first
  operand       of a solid (csg): index and shape of the operand whose surface
                is hit
  triangle      index of the triangle, counted from 0, in the order of
                triangulation
  face          index of the face in the file, counted from 0
  position      in the file's coordinates; of a triangle from the barycentric
                coordinates, in large ones less accurate than o + t*d; of other
                shapes the point of the surface next to o + t*d, as accurate as
                an f32 t of the traced ray (see below)
  normal        geometric normal of unit length, the same for rays from either
                side: by the right-hand rule over A, B and C for a triangle,
                outwards for a closed shape, u x v for a disk or rectangle;
                the opposite if the scene file reverses it: by flip_normals,
                or by a transform that mirrors a sphere (inwards), a disk or a
                rectangle
  line          number of the line in the input, counted from 1
  ray_rounding  in units of the file, see below

--explain adds to each hit:

  parameters    of a shape other than a triangle, by name; points in the
                file's coordinates
  is_reversed   of a shape other than a triangle: whether the scene file
                reverses its normal
  solid         of a solid: the operand with its parameters, whether it is
                subtracted (the solid's normal is then the opposite of its
                own), and the tree of operations with the intervals of t
                inside each part, along the whole line; null is infinite
  formula       derivation of t in f64 for the traced ray, which may start
                elsewhere on the line

Numbers parse as doubles without loss.

--clip-plane and --clip-box end rays at the clip, as tmin and tmax do. A hit is
kept by the side of a plane that it is on; within the rounding of positions and
of t from the plane, it is kept by both sides.

Rounding: rays and scenes are traced as f32 numbers relative to an origin near
the scene (--recentre). A ray with more digits, or from far away, is rounded.
To lose as little as possible, the traced ray starts where the given ray comes
near the scene, or is traced in the file's coordinates if that is more
accurate. ray_rounding bounds the remaining error: the largest distance per
coordinate between the traced and the given ray at the same t, over the part
of the ray within the scene's bounding sphere. At an infinite plane farther
away, the distance may be larger. 0 means that the ray is traced exactly as
given. tmin and tmax are rounded outwards to f32. `hitscope info` shows how
far the vertices of meshes are rounded.";

const EXAMPLES: &str = "\
Examples:
  hitscope trace bunny.obj --rays rays.txt
  echo 0 0.1 1 0 0 -1 | hitscope trace bunny.obj --rays -
  hitscope trace bunny.obj --rays rays.txt --all --kernel exact
  hitscope trace bunny.obj --rays rays.txt --summary
  hitscope trace bunny.obj --rays rays.txt --all --clip-plane 0,1,0,0.1
  echo 0 0 9 0 0 -1 | hitscope trace scene.xml --rays - --explain

Exit status:
  0  success, even if some lines are not rays; their answers have the reason
  1  the scene or the file of rays can't be read; one line on stderr has the
     reason
  2  the command line is wrong";

/// Trace rays through a scene and print one JSON object per ray
#[derive(Args, Clone, Debug)]
#[command(long_about = ABOUT, after_help = EXAMPLES)]
pub struct TraceArgs {
    /// OBJ file, plain or gzipped, or scene file (.xml); - for an OBJ on standard input
    pub file: PathBuf,
    /// File of rays, one per line: ox oy oz dx dy dz [tmin tmax]; - for standard input
    #[arg(long, value_name = "RAYS")]
    pub rays: PathBuf,
    /// Kernel.
    #[command(flatten)]
    pub kernel: KernelArg,
    /// How the mesh is loaded.
    #[command(flatten)]
    pub mesh: MeshArgs,
    /// Clip.
    #[command(flatten)]
    pub clip: ClipArgs,
    /// Store positions relative to an origin near the scene, so that rounding to f32 loses fewer digits
    #[arg(long, default_value = "on")]
    pub recentre: RecentreArg,
    /// Print only whether anything is hit
    #[arg(long, conflicts_with = "all")]
    pub any: bool,
    /// Print all hits, sorted by t, as {"hits":[...]}; "also" lists other primitives at the same t
    #[arg(long)]
    pub all: bool,
    /// Add to each hit the derivation of t, and the tree of operations of a solid
    #[arg(long, conflicts_with_all = ["any", "summary"])]
    pub explain: bool,
    /// Print only counts, the tracing time and the largest ray_rounding
    #[arg(long)]
    pub summary: bool,
    /// Threads.
    #[command(flatten)]
    pub threads: ThreadsArg,
}

/// The origin relative to which positions are stored.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum RecentreArg {
    /// An origin near the scene, if the scene is far from (0, 0, 0) for its size
    On,
    /// (0, 0, 0)
    Off,
}

#[derive(Default)]
struct Totals {
    rays: u64,
    hits: u64,
    bad_lines: u64,
    tracing: Duration,
    max_ray_rounding: f64,
}

#[derive(Serialize)]
struct Summary {
    rays: u64,
    hits: u64,
    bad_lines: u64,
    seconds: f64,
    mrays_per_s: f64,
    max_ray_rounding: f64,
}

impl TraceArgs {
    /// Traces the rays and prints the answers in the same order.
    ///
    /// # Errors
    /// See [`CommandError`]. An invalid ray isn't an error; its answer has the reason.
    pub fn run(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        if is_stdin(&self.file) && is_stdin(&self.rays) {
            let message = "the mesh and the rays can't both come from standard input";
            return Err(CommandError::Usage(message.to_owned()));
        }
        let recentre = match self.recentre {
            RecentreArg::On => Recentre::Auto,
            RecentreArg::Off => Recentre::Off,
        };
        // Opened before the mesh is loaded, so that a missing file of rays is reported at once.
        let input = open(&self.rays)?;
        let scene = self.mesh.load(&self.file, recentre)?.scene;
        let scene = self.clip.apply(scene)?;
        let frames = Frames::new(&scene, self.kernel.choice, self.mesh.memory.bytes());
        let tracer = Tracing {
            answerer: RayAnswerer {
                scene: &scene,
                frames: &frames,
                query: match (self.any, self.all) {
                    (true, _) => RayQuery::Any,
                    (_, true) => RayQuery::All,
                    _ => RayQuery::Closest,
                },
                is_explaining: self.explain,
            },
            is_summary: self.summary,
            threads: self.threads.count(),
        };
        let totals = tracer.run(Pieces::of(input), &self.rays, out)?;
        if self.summary {
            writeln!(out, "{}", json::to_line(&Summary::of(&totals)))?;
        }
        Ok(out.flush()?)
    }
}

impl Summary {
    fn of(totals: &Totals) -> Self {
        let seconds = totals.tracing.as_secs_f64();
        Self {
            rays: totals.rays,
            hits: totals.hits,
            bad_lines: totals.bad_lines,
            seconds,
            mrays_per_s: totals.rays as f64 / seconds.max(f64::MIN_POSITIVE) / 1e6,
            max_ray_rounding: totals.max_ray_rounding,
        }
    }
}

fn open(path: &Path) -> Result<Box<dyn Read + Send>, CommandError> {
    if is_stdin(path) {
        return Ok(Box::new(io::stdin()));
    }
    let file = File::open(path).map_err(|source| file_error(path, source))?;
    Ok(Box::new(file))
}

struct Tracing<'a> {
    answerer: RayAnswerer<'a>,
    is_summary: bool,
    threads: usize,
}

impl Tracing<'_> {
    /// Answers all lines. Before a read that might block, answers the lines read so far.
    fn run(
        &self,
        mut pieces: Pieces,
        path: &Path,
        out: &mut dyn Write,
    ) -> Result<Totals, CommandError> {
        let unreadable = |source| file_error(path, source);
        let (mut totals, mut splitter) = (Totals::default(), LineSplitter::default());
        loop {
            let mut next = pieces.next_without_waiting().map_err(unreadable)?;
            if matches!(next, Next::Unknown) {
                self.batch(&splitter.take(), &mut totals, out)?;
                out.flush()?;
                next = pieces.wait().map_err(unreadable)?;
            }
            match next {
                Next::Piece(piece) => splitter.push(&piece),
                Next::End => break,
                Next::Unknown => {}
            }
            if splitter.len() >= BATCH {
                self.batch(&splitter.take(), &mut totals, out)?;
            }
        }
        splitter.finish();
        self.batch(&splitter.take(), &mut totals, out)?;
        Ok(totals)
    }

    fn batch(
        &self,
        lines: &Lines,
        totals: &mut Totals,
        out: &mut dyn Write,
    ) -> Result<(), CommandError> {
        if lines.is_empty() {
            return Ok(());
        }
        let parts = self.in_parallel(lines.len(), |part| {
            let of = |index| Request::of(lines.get(index), self.answerer.frames);
            part.filter_map(of).collect::<Vec<_>>()
        });
        let requests: Vec<Request> = parts.into_iter().flatten().collect();
        let start = Instant::now();
        let parts = self.in_parallel(requests.len(), |part| self.answer_all(&requests[part]));
        totals.tracing += start.elapsed();
        for request in &requests {
            match &request.ray {
                Ok(placed) => {
                    totals.rays += 1;
                    totals.max_ray_rounding = totals.max_ray_rounding.max(placed.rounding);
                }
                Err(_) => totals.bad_lines += 1,
            }
        }
        for (text, hits) in parts {
            totals.hits += hits;
            out.write_all(&text)?;
        }
        Ok(())
    }

    /// The answers as lines, empty for a summary, and the number of hits.
    fn answer_all(&self, requests: &[Request]) -> (Vec<u8>, u64) {
        let (mut text, mut hits) = (Vec::new(), 0);
        for request in requests {
            let is_hit = if self.is_summary {
                let placed = request.ray.as_ref();
                placed.is_ok_and(|placed| self.answerer.is_hit(placed))
            } else {
                self.answerer.answer(request, &mut text)
            };
            hits += u64::from(is_hit);
        }
        (text, hits)
    }

    /// Splits `0..count` into parts, processes each on its own thread, and returns the results in order.
    fn in_parallel<T: Send>(
        &self,
        count: usize,
        work: impl Fn(Range<usize>) -> T + Sync,
    ) -> Vec<T> {
        let work = &work;
        let size = count.div_ceil(self.threads).max(LEAST_PER_THREAD);
        let part = |start: usize| start..count.min(start + size);
        let mut parts = (0..count).step_by(size).map(part);
        // This thread processes the first part.
        let Some(first) = parts.next() else {
            return Vec::new();
        };
        std::thread::scope(|scope| {
            let start = |part: Range<usize>| {
                let (own, more) = (part.clone(), part);
                let thread = Builder::new().spawn_scoped(scope, move || work(own));
                (more, thread.ok())
            };
            let others: Vec<_> = parts.map(start).collect();
            let finish = |(part, thread): (Range<usize>, Option<ScopedJoinHandle<'_, T>>)| {
                match thread {
                    Some(thread) => thread.join().expect("tracing doesn't panic"),
                    // If the system grants no more threads, this one does the work.
                    None => work(part),
                }
            };
            let first = work(first);
            std::iter::once(first)
                .chain(others.into_iter().map(finish))
                .collect()
        })
    }
}
