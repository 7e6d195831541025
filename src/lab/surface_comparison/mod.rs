//! Distances between two surfaces, and what else differs between two files.
//!
//! Source: Cignoni, Rocchini, Scopigno, "Metro: Measuring Error on Simplified Surfaces", Computer Graphics Forum 17(2),
//!   1998: distances of points sampled on one surface from the other. Differs from it: vertices count in the largest
//!   distance, too, and the nearest points are those of the tree's exact search.

mod inventory;
mod picture;
mod samples;

pub use inventory::{Inventory, OnlyIn, only_in};
pub use picture::DistancePicture;

use glam::DVec3;
use hitscope_core::TriangleMesh;
use hitscope_core::closest_point::{ClosestPoint, ClosestPoints};
use hitscope_core::counts::counted_as;
use hitscope_core::loading::LoadedScene;
use rayon::prelude::*;
use samples::{AreaSamples, SurfaceSample, vertices};
use serde::Serialize;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// The distances from one surface to another, one-sided. Lengths are in the units of the files.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OneSided {
    /// Vertices that were measured.
    pub vertices: usize,
    /// Points that were measured; they are uniform by area.
    pub samples: usize,
    /// The mean over the samples.
    pub mean: f64,
    /// The root mean square over the samples.
    pub rms: f64,
    /// The distances that 50, 90 and 99 of 100 samples don't exceed.
    pub p50: f64,
    /// See `p50`.
    pub p90: f64,
    /// See `p50`.
    pub p99: f64,
    /// The largest distance of a vertex or a sample: a lower bound of the one-sided Hausdorff distance.
    pub max: f64,
    /// Where it is.
    pub worst: WorstPlace,
}

/// The place of the largest distance. Positions are in the files' coordinates; triangles and faces are counted from 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorstPlace {
    /// The point of the surface.
    pub position: [f64; 3],
    /// Its triangle.
    pub triangle: u32,
    /// Its face.
    pub face: u32,
    /// The face's line in the file, counted from 1, if it is known.
    pub line: Option<usize>,
    /// The nearest point of the other surface.
    pub nearest: [f64; 3],
    /// Its triangle.
    pub nearest_triangle: u32,
}

/// The figures of distances, one-sided or both ways.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DistanceFigures {
    /// The mean.
    pub mean: f64,
    /// The root mean square.
    pub rms: f64,
    /// The largest: a lower bound of the Hausdorff distance.
    pub max: f64,
}

impl DistanceFigures {
    /// Combines the distances from A to B and from B to A: the mean of both means, the root of the mean of both mean
    /// squares, and the larger of both.
    pub fn both_ways(there: Self, back: Self) -> Self {
        Self {
            mean: 0.5 * (there.mean + back.mean),
            rms: (0.5 * (there.rms * there.rms + back.rms * back.rms)).sqrt(),
            max: there.max.max(back.max),
        }
    }

    /// The figures as parts of a length.
    pub fn relative_to(self, length: f64) -> Self {
        Self {
            mean: self.mean / length,
            rms: self.rms / length,
            max: self.max / length,
        }
    }
}

impl OneSided {
    /// The figures.
    pub fn figures(&self) -> DistanceFigures {
        DistanceFigures {
            mean: self.mean,
            rms: self.rms,
            max: self.max,
        }
    }
}

/// Why surfaces can't be compared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SurfaceError {
    /// There is no triangle.
    #[error("there are no triangles to compare")]
    Empty,
    /// There are other shapes.
    #[error("only meshes are compared, but the file has {0}")]
    OtherShapes(String),
}

/// A surface of triangles.
pub struct Surface<'a> {
    loaded: &'a LoadedScene,
    closest: ClosestPoints<'a>,
}

impl<'a> Surface<'a> {
    /// The surface of a file.
    ///
    /// # Errors
    /// See [`SurfaceError`].
    pub fn new(loaded: &'a LoadedScene) -> Result<Self, SurfaceError> {
        let others = loaded.scene.other_groups().iter().map(|group| {
            let shape = group.shape();
            counted_as(group.count(), shape.name, shape.plural)
        });
        let others: Vec<String> = others.collect();
        if !others.is_empty() {
            return Err(SurfaceError::OtherShapes(others.join(", ")));
        }
        let closest = ClosestPoints::of(&loaded.scene).ok_or(SurfaceError::Empty)?;
        Ok(Self { loaded, closest })
    }

    fn mesh(&self) -> &'a TriangleMesh {
        self.loaded.scene.mesh()
    }

    /// The area.
    pub fn area(&self) -> f64 {
        AreaSamples::new(self.mesh(), 0).area()
    }

    /// The point nearest to a point of another mesh, which has this origin; `None` if that isn't finite.
    pub fn closest(&self, p: DVec3, origin: DVec3) -> Option<ClosestPoint> {
        self.closest.closest(p + (origin - self.mesh().origin()))
    }

    /// The distances from this surface to another: from its vertices, and from `sample_count` points, at least one. After
    /// each thousand or so, `advanced` receives the part that is done.
    pub fn distances_to(
        &self,
        other: &Surface<'_>,
        sample_count: usize,
        advanced: &(dyn Fn(f64) + Sync),
    ) -> OneSided {
        let mesh = self.mesh();
        let vertices = vertices(mesh);
        let samples = AreaSamples::new(mesh, sample_count.max(1));
        let all = vertices.len() + samples.count();
        let done = AtomicUsize::new(0);
        let measured = |sample: SurfaceSample| {
            let count = done.fetch_add(1, Relaxed) + 1;
            if count.is_multiple_of(1024) {
                advanced(count as f64 / all as f64);
            }
            let nearest = other.closest(sample.position, mesh.origin());
            Measured {
                sample,
                nearest: nearest.expect("corners of triangles are finite"),
            }
        };
        let of_vertices = vertices.par_iter().map(|&vertex| measured(vertex));
        let worst_vertex = of_vertices.reduce_with(Measured::farther);
        let of_samples = (0..samples.count()).into_par_iter();
        let of_samples = of_samples
            .map(|index| measured(samples.sample(index)))
            .fold(Distances::default, Distances::with)
            .reduce(Distances::default, Distances::joined);
        let worst = [worst_vertex, of_samples.worst].into_iter().flatten();
        let worst = worst.reduce(Measured::farther);
        let worst = worst.expect("there is at least one sample");
        let mut distances = of_samples.all;
        distances.sort_unstable_by(f64::total_cmp);
        let count = distances.len() as f64;
        let quantile = |part: f64| distances[(part * (count - 1.0)).round() as usize];
        OneSided {
            vertices: vertices.len(),
            samples: samples.count(),
            mean: distances.iter().sum::<f64>() / count,
            rms: (distances.iter().map(|d| d * d).sum::<f64>() / count).sqrt(),
            p50: quantile(0.5),
            p90: quantile(0.9),
            p99: quantile(0.99),
            max: worst.nearest.distance,
            worst: self.place(other, &worst),
        }
    }

    fn place(&self, other: &Surface<'_>, worst: &Measured) -> WorstPlace {
        let (mesh, triangle) = (self.mesh(), worst.sample.triangle);
        let face = mesh.face_of(triangle);
        let line = self.loaded.report.face_lines.line(face as usize);
        WorstPlace {
            position: mesh.in_file(worst.sample.position).to_array(),
            triangle,
            face,
            line: (line > 0).then_some(line),
            nearest: other.mesh().in_file(worst.nearest.position).to_array(),
            nearest_triangle: worst.nearest.triangle,
        }
    }
}

/// The length of the diagonal of the box around both surfaces.
pub fn diagonal(a: &LoadedScene, b: &LoadedScene) -> f64 {
    let of = |loaded: &LoadedScene| {
        let (bounds, origin) = (loaded.scene.bounds(), loaded.scene.mesh().origin());
        [bounds.min, bounds.max].map(|corner| corner.as_dvec3() + origin)
    };
    let ([a_min, a_max], [b_min, b_max]) = (of(a), of(b));
    (a_max.max(b_max) - a_min.min(b_min)).length()
}

/// A point and the nearest one of the other surface.
#[derive(Clone, Copy)]
struct Measured {
    sample: SurfaceSample,
    nearest: ClosestPoint,
}

impl Measured {
    /// The farther one; of two at the same distance, the first, so that threads don't matter.
    fn farther(a: Self, b: Self) -> Self {
        if b.nearest.distance > a.nearest.distance {
            b
        } else {
            a
        }
    }
}

/// The distances of some samples.
#[derive(Default)]
struct Distances {
    all: Vec<f64>,
    worst: Option<Measured>,
}

impl Distances {
    fn with(mut self, measured: Measured) -> Self {
        self.all.push(measured.nearest.distance);
        let worst = self.worst.into_iter().chain([measured]);
        self.worst = worst.reduce(Measured::farther);
        self
    }

    fn joined(mut self, mut later: Self) -> Self {
        self.all.append(&mut later.all);
        let worst = self.worst.into_iter().chain(later.worst);
        self.worst = worst.reduce(Measured::farther);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    use hitscope_core::mesh::shapes::{Placement, cube, flat_grid, sphere};
    use hitscope_core::obj::{LoadReport, Loaded};
    use hitscope_core::progress::Progress;
    use hitscope_core::scene::SceneOptions;

    fn loaded(mesh: TriangleMesh) -> LoadedScene {
        let report = LoadReport::default();
        let loaded = Loaded { mesh, report };
        let scene = LoadedScene::of(loaded, SceneOptions::default(), &Progress::default());
        scene.expect("never cancelled")
    }

    fn distances(a: &LoadedScene, b: &LoadedScene) -> [OneSided; 2] {
        let [a, b] = [a, b].map(|loaded| Surface::new(loaded).expect("a mesh"));
        [
            a.distances_to(&b, 5000, &|_| ()),
            b.distances_to(&a, 5000, &|_| ()),
        ]
    }

    #[test]
    fn parallel_squares_have_their_distance_everywhere() {
        let flat = flat_grid(4, Placement::UNIT);
        let lifted = flat.map_positions(|p| p + 0.25 * Vec3::Z);
        let [there, back] = distances(&loaded(flat), &loaded(lifted));
        for found in [&there, &back] {
            let figures = [found.mean, found.rms, found.p50, found.p99, found.max];
            // The mean adds 5000 rounded numbers.
            assert!(
                figures.iter().all(|x| (x - 0.25).abs() < 1e-12),
                "{found:?}"
            );
            assert_eq!((found.samples, found.vertices), (5000, 25));
        }
        let both = DistanceFigures::both_ways(there.figures(), back.figures());
        assert!((both.rms - 0.25).abs() < 1e-12 && both.max == 0.25);
        assert!((both.relative_to(5.0).max - 0.05).abs() < 1e-15);
    }

    #[test]
    fn a_part_that_only_one_surface_has_is_seen_from_that_side_only() {
        let whole = loaded(flat_grid(4, Placement::UNIT));
        let half = flat_grid(4, Placement::UNIT);
        let left = |triangle: &&[u32; 3]| {
            let corner = |v: u32| half.positions()[v as usize].x;
            triangle.iter().all(|&v| corner(v) <= 2.0)
        };
        let triangles = half.triangles().iter().filter(left).copied().collect();
        let half = loaded(TriangleMesh::new(half.positions().to_vec(), triangles));
        let [there, back] = distances(&whole, &half);
        assert_eq!((there.max, back.max), (2.0, 0.0));
        // Uniform from 0 to 2 on half of the area; 0.05 are five standard errors.
        assert!((there.mean - 0.5).abs() < 0.05, "{there:?}");
        assert_eq!(there.worst.position[0], 4.0);
        assert_eq!(there.worst.nearest[0], 2.0);
    }

    #[test]
    fn the_largest_distance_of_a_coarse_sphere_is_that_of_its_faces() {
        let [coarse, fine] = [4, 40].map(|cells| loaded(sphere(cells, Placement::UNIT)));
        let [there, back] = distances(&coarse, &fine);
        // Vertices of both lie on the unit sphere.
        assert!(there.max < 0.1 && back.max < 0.1);
        assert!(back.max > 0.02, "the coarse faces cut the sphere: {back:?}");
        let again = distances(&coarse, &fine);
        assert_eq!(again, [there, back], "threads don't matter");
    }

    #[test]
    fn files_with_other_origins_are_compared_in_common_coordinates() {
        let mesh = cube(2, Placement::UNIT);
        let origin = DVec3::new(4e6, -1e6, 512.0);
        let moved = mesh
            .map_positions(|p| p - Vec3::X)
            .with_origin(origin + DVec3::X);
        let [there, back] = distances(&loaded(mesh.with_origin(origin)), &loaded(moved));
        // Points are rounded by 2⁻⁵³ when they are moved.
        assert!(there.max < 1e-15 && back.max < 1e-15, "{there:?} {back:?}");
        assert!((there.worst.position[0] - 4e6).abs() < 10.0);
    }

    #[test]
    fn a_scene_without_triangles_is_refused() {
        let empty = loaded(TriangleMesh::default());
        assert_eq!(Surface::new(&empty).err(), Some(SurfaceError::Empty));
    }
}
