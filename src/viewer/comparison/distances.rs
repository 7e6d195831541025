//! Distances between the surfaces of both sides, and the distance map.

use glam::Vec3;
use hitscope_core::colour::{COLOUR_MAPS, ColourScale};
use hitscope_core::loading::LoadedScene;
use hitscope_core::{Camera, Intersector, Scene};
use hitscope_lab::surface_comparison::{DistancePicture, OneSided, Surface, diagonal};
use std::sync::Arc;

/// Sample points on each surface, besides its vertices. Fewer than the command `compare`'s default, because distances
/// are measured whenever the scenes change.
const POINTS: usize = 20_000;

/// The scenes of both sides.
#[derive(Clone)]
pub struct SurfacePair {
    /// Side A.
    pub a: Arc<Scene>,
    /// Side B.
    pub b: Arc<Scene>,
}

/// Ignores clips and creases: distances are measured between the whole surfaces.
impl PartialEq for SurfacePair {
    fn eq(&self, other: &Self) -> bool {
        self.a.has_shapes_of(&other.a) && self.b.has_shapes_of(&other.b)
    }
}

/// The distances between two surfaces. Lengths are in the units of the files.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshDistances {
    /// From A to B.
    pub there: OneSided,
    /// From B to A.
    pub back: OneSided,
    /// The diagonal of the bounding box of both.
    pub diagonal: f64,
}

/// A scene as if loaded from a file, without a report, a view and lights.
fn bare(scene: &Arc<Scene>) -> LoadedScene {
    LoadedScene {
        scene: Arc::clone(scene),
        report: Arc::default(),
        view: None,
        description: None,
        lights: Vec::new(),
    }
}

impl MeshDistances {
    /// Measures the distances between two surfaces.
    ///
    /// # Errors
    /// Why they can't be measured.
    pub fn of(pair: &SurfacePair) -> Result<Self, String> {
        let (a, b) = (bare(&pair.a), bare(&pair.b));
        let surface = |loaded| Surface::new(loaded).map_err(|error| error.to_string());
        let surfaces = (surface(&a)?, surface(&b)?);
        Ok(Self {
            there: surfaces.0.distances_to(&surfaces.1, POINTS, &|_| ()),
            back: surfaces.1.distances_to(&surfaces.0, POINTS, &|_| ()),
            diagonal: diagonal(&a, &b),
        })
    }

    /// The colour scale of distances from A to B.
    pub fn scale(&self) -> Option<ColourScale> {
        // If all distances are 0, any limit gives the same picture.
        let largest = if self.there.max > 0.0 {
            self.there.max
        } else {
            1.0
        };
        ColourScale::new("Distance", "", [0.0, largest], COLOUR_MAPS[0], false).ok()
    }
}

/// What a map depends on.
#[derive(Clone)]
pub struct MapKey {
    /// The scenes.
    pub pair: SurfacePair,
    /// The intersector of side A.
    pub intersector: Arc<dyn Intersector>,
    /// The camera in the coordinates of side A.
    pub camera: Camera,
    /// The colour scale of distances.
    pub scale: ColourScale,
    /// The linear colour of the background.
    pub background: Vec3,
}

impl PartialEq for MapKey {
    fn eq(&self, other: &Self) -> bool {
        self.pair == other.pair
            && Arc::ptr_eq(&self.intersector, &other.intersector)
            && self.camera == other.camera
            && self.scale == other.scale
            && self.background == other.background
    }
}

/// A picture of side A, coloured by its distance to side B.
pub struct DistanceMap {
    /// What it shows.
    pub key: MapKey,
    /// sRGB with alpha 255, row by row from the top.
    pub pixels: Vec<[u8; 4]>,
}

impl DistanceMap {
    /// Traces the map with one sample per pixel.
    ///
    /// # Errors
    /// Why the distances can't be measured.
    pub fn trace(key: MapKey) -> Result<Self, String> {
        let (a, b) = (bare(&key.pair.a), bare(&key.pair.b));
        let surface = |loaded| Surface::new(loaded).map_err(|error| error.to_string());
        let (surface, other) = (&surface(&a)?, &surface(&b)?);
        let picture = DistancePicture {
            surface,
            other,
            camera: key.camera,
            intersector: &*key.intersector,
            samples: 1,
            scale: key.scale,
            background: key.background,
        };
        Ok(Self {
            pixels: picture.trace(&|_| ()),
            key,
        })
    }
}
