//! The report of `hitscope bench`: its figures as JSON and as tables.

use super::super::CommandError;
use hitscope_core::counts::grouped;
use serde::Serialize;
use serde_json::{Map, Value};
use std::io::Write;
use std::time::Duration;

/// All figures. Times are in milliseconds of wall-clock time.
#[derive(Serialize)]
pub(super) struct Report {
    pub triangles: usize,
    /// Of all shapes.
    pub primitives: usize,
    /// The primitives in words.
    #[serde(skip)]
    pub contents: String,
    pub simd: &'static str,
    pub load_ms: f64,
    /// The time of each step; empty for a scene file.
    pub load_steps_ms: Map<String, Value>,
    /// The number of threads that load and build trees.
    pub load_threads: usize,
    /// Building the trees.
    pub build_ms: f64,
    /// Building the quick tree of triangles that the window starts with. No rays are traced through it here.
    pub quick_build_ms: f64,
    /// The trees and the packed primitives of the first kernel.
    #[serde(flatten)]
    pub bytes: BytesEach,
    /// `None` if the system doesn't report it.
    pub peak_rss_bytes: Option<u64>,
    pub kernels: Vec<PackedKernel>,
    pub workloads: Vec<Row>,
}

/// The packed primitives of a kernel.
#[derive(Serialize)]
pub(super) struct PackedKernel {
    pub kernel: &'static str,
    pub pack_ms: f64,
    #[serde(flatten)]
    pub bytes: BytesEach,
}

/// The memory of the trees and the packed primitives, per primitive.
#[derive(Clone, Copy, Serialize)]
pub(super) struct BytesEach {
    /// The same figure, under the name for scenes of triangles.
    pub bytes_per_triangle: f64,
    pub bytes_per_primitive: f64,
}

impl BytesEach {
    pub(super) fn new(bytes: usize, primitives: usize) -> Self {
        let each = bytes as f64 / primitives.max(1) as f64;
        Self {
            bytes_per_triangle: each,
            bytes_per_primitive: each,
        }
    }
}

/// The speed of a kernel in a workload, by CPU time and by wall-clock time.
#[derive(Serialize)]
pub(super) struct Row {
    pub name: &'static str,
    pub kernel: &'static str,
    /// Rays traced together if they are coherent.
    pub rays_together: usize,
    pub threads: usize,
    pub rays: usize,
    pub hits: u64,
    pub mrays_per_s: f64,
    pub mrays_per_s_wall: f64,
}

impl Report {
    pub(super) fn print(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        write!(
            out,
            "{}; {}; loaded in {:.0} ms, tree built in {:.0} ms",
            self.contents, self.simd, self.load_ms, self.build_ms
        )?;
        if self.triangles > 0 {
            write!(out, ", quick tree in {:.0} ms", self.quick_build_ms)?;
        }
        writeln!(out)?;
        if let Some(bytes) = self.peak_rss_bytes {
            writeln!(out, "peak memory {:.0} MB", bytes as f64 / 1e6)?;
        }
        writeln!(
            out,
            "\n{:<24}{:>12}{:>18}",
            "kernel", "packed, ms", "bytes/primitive"
        )?;
        for packed in &self.kernels {
            let (ms, bytes) = (packed.pack_ms, packed.bytes.bytes_per_primitive);
            writeln!(out, "{:<24}{ms:>12.1}{bytes:>18.1}", packed.kernel)?;
        }
        writeln!(
            out,
            "\n{:<10}{:<24}{:>9}{:>8}{:>10}{:>10}{:>10}{:>12}",
            "workload", "kernel", "together", "threads", "rays", "hits", "Mrays/s", "wall-clock"
        )?;
        for row in &self.workloads {
            // Without rays there is no rate.
            let rate = |rate: f64| match row.rays {
                0 => "–".to_owned(),
                _ => format!("{rate:.2}"),
            };
            writeln!(
                out,
                "{:<10}{:<24}{:>9}{:>8}{:>10}{:>10}{:>10}{:>12}",
                row.name,
                row.kernel,
                row.rays_together,
                row.threads,
                grouped(row.rays),
                grouped(row.hits as usize),
                rate(row.mrays_per_s),
                rate(row.mrays_per_s_wall)
            )?;
        }
        Ok(())
    }
}

pub(super) fn milliseconds(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}
