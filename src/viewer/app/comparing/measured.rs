//! Figures of the differences, distances between the surfaces, and the distance map, all computed in the background.

use crate::app::App;
use crate::comparison::{
    ComparedPictures, DistanceMap, Figures, MapKey, MeshDistances, Mode, Pixels, Source,
    SurfacePair,
};
use crate::tab::Tab;
use crate::task::{Task, TaskPanicked, in_own_pool};
use glam::UVec2;
use hitscope_core::colour::ColourScale;
use hitscope_core::picture::PictureEncoding;
use hitscope_core::srgb::from_texel;
use rayon::prelude::*;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time between updates of the figures while a side is being refined.
const INTERVAL: Duration = Duration::from_secs(1);

/// A task that may fail.
type Attempt<T> = Task<Result<T, String>>;
/// The number of changes of side A and of side B.
type Changes = [u64; 2];

/// Measurements between both sides, and their tasks.
#[derive(Default)]
pub(super) struct Measured {
    /// The figures, and the state of the sides that they belong to.
    pub figures: Option<(Changes, Figures)>,
    figures_task: Option<(Changes, Attempt<Figures>)>,
    figures_begun: Option<Instant>,
    /// The distances, or why there are none.
    pub distances: Option<(SurfacePair, Result<MeshDistances, String>)>,
    distances_task: Option<(SurfacePair, Attempt<MeshDistances>)>,
    map: Option<DistanceMap>,
    map_task: Option<(MapKey, Attempt<DistanceMap>)>,
    /// The map that couldn't be traced.
    failed_map: Option<MapKey>,
}

impl Measured {
    /// Time since measuring of distances began; `None` if none are being measured.
    pub fn elapsed(&self) -> Option<Duration> {
        let distances = self.distances_task.as_ref().map(|(_, task)| task.elapsed());
        let map = self.map_task.as_ref().map(|(_, task)| task.elapsed());
        distances.or(map)
    }

    /// The pixels of the latest distance map.
    pub fn map_pixels(&self) -> Option<&[[u8; 4]]> {
        self.map.as_ref().map(|map| map.pixels.as_slice())
    }
}

/// The result of a task that has ended.
fn ended<T: Send + 'static>(task: &Attempt<T>) -> Option<Result<T, String>> {
    match task.poll() {
        Ok(result) => result,
        Err(broken @ TaskPanicked) => Some(Err(broken.to_string())),
    }
}

impl App {
    fn shows_figures(&self) -> bool {
        self.is_comparing() && self.preferences.shows_panel && self.preferences.tab == Tab::Compare
    }

    /// Requests a frame that updates the figures, if they are shown.
    pub(super) fn ask_for_figures(&self, ctx: &egui::Context) {
        if self.shows_figures() {
            ctx.request_repaint();
        }
    }

    pub(super) fn poll_measured(&mut self, ctx: &egui::Context) {
        self.poll_figures(ctx);
        self.poll_distances(ctx);
        self.poll_map(ctx);
    }

    fn poll_figures(&mut self, ctx: &egui::Context) {
        let measured = &mut self.compared.measured;
        if let Some((changes, task)) = &measured.figures_task {
            let Some(result) = ended(task) else { return };
            let changes = *changes;
            measured.figures_task = None;
            match result {
                Ok(figures) => measured.figures = Some((changes, figures)),
                Err(message) => self.error(message),
            }
        }
        if !self.shows_figures() || self.has_figures() || self.traced.tracer.is_moving() {
            return;
        }
        let since = self.compared.measured.figures_begun;
        let left = since.map_or(Duration::ZERO, |since| {
            INTERVAL.saturating_sub(since.elapsed())
        });
        if !self.are_sides_final() && left > Duration::ZERO {
            ctx.request_repaint_after(left);
            return;
        }
        let Some(pictures) = self.compared_pictures() else {
            return;
        };
        let work = move || in_own_pool(|| pictures.figures());
        let changes = self.compared.screen.changes;
        let measured = &mut self.compared.measured;
        measured.figures_begun = Some(Instant::now());
        measured.figures_task = Some((changes, Task::spawn("figures", ctx, work)));
    }

    /// Whether the figures belong to the pictures on the screen.
    fn has_figures(&self) -> bool {
        let known = self.compared.measured.figures.as_ref();
        known.is_some_and(|(changes, _)| *changes == self.compared.screen.changes)
    }

    /// Whether the figures belong to the pictures on the screen, which have all their samples.
    pub fn are_figures_final(&self) -> bool {
        self.are_sides_final() && self.has_figures()
    }

    /// Whether both pictures have all their samples.
    fn are_sides_final(&self) -> bool {
        let is_a_final = self.rasterizes_a() || self.traced.tracer.is_finished();
        is_a_final && self.are_sides_settled()
    }

    /// Both pictures, if they have the same size.
    fn compared_pictures(&self) -> Option<ComparedPictures> {
        let film = self.traced.tracer.film();
        let (size, b) = self.compared.pixels()?;
        let (_, a) = self.pixels_of_a().filter(|(of_a, _)| *of_a == size)?;
        let reference = self.compared.reference.picture();
        let (a, b) = match reference.filter(|_| self.compared.source == Source::Picture) {
            Some(picture)
                if picture.encoding == PictureEncoding::Linear && !self.rasterizes_a() =>
            {
                let pixel = |(index, &[r, g, b, _]): (usize, &[u8; 4])| {
                    let at = UVec2::new(index as u32 % size.x, index as u32 / size.x);
                    film.radiance(at).unwrap_or_else(|| from_texel([r, g, b]))
                };
                let linear = film.pixels().par_iter().enumerate().map(pixel);
                (
                    Pixels::Linear(linear.collect()),
                    Pixels::File(Arc::clone(picture)),
                )
            }
            Some(picture) => (
                Pixels::Display(a.to_vec()),
                Pixels::File(Arc::clone(picture)),
            ),
            None => (Pixels::Display(a.to_vec()), Pixels::Display(b.to_vec())),
        };
        Some(ComparedPictures {
            size,
            a,
            b,
            visibility: self.visibility(),
        })
    }

    /// The scenes of both sides, if they differ.
    fn surface_pair(&self) -> Option<SurfacePair> {
        let other = self.compared.document();
        let other = other.filter(|_| self.compared.source.is_other_scene())?;
        Some(SurfacePair {
            a: Arc::clone(&self.open.document.loaded.scene),
            b: Arc::clone(&other.loaded.scene),
        })
    }

    fn poll_distances(&mut self, ctx: &egui::Context) {
        let pair = self.surface_pair();
        let wanted = pair.filter(|_| self.shows_figures() || self.shows(Mode::Distance));
        let measured = &mut self.compared.measured;
        if let Some((pair, task)) = &measured.distances_task {
            let Some(result) = ended(task) else { return };
            measured.distances = Some((pair.clone(), result));
            measured.distances_task = None;
        }
        let known = measured.distances.as_ref().map(|(pair, _)| pair);
        if let Some(pair) = wanted.filter(|pair| known != Some(pair)) {
            let surfaces = pair.clone();
            let measure = move || in_own_pool(|| MeshDistances::of(&surfaces));
            measured.distances_task = Some((pair, Task::spawn("distances", ctx, measure)));
        }
    }

    /// The distances between the surfaces of both sides, or why they can't be measured; `None` until then.
    pub fn mesh_distances(&self) -> Option<&Result<MeshDistances, String>> {
        let pair = self.surface_pair()?;
        let known = self.compared.measured.distances.as_ref();
        let known = known.filter(|(known, _)| *known == pair);
        known.map(|(_, distances)| distances)
    }

    /// The latest figures of the differences between both sides.
    pub fn figures(&self) -> Option<&Figures> {
        let known = self.compared.measured.figures.as_ref();
        known.map(|(_, figures)| figures)
    }

    /// The colour scale of the distance map.
    pub(in crate::app) fn distance_scale(&self) -> Option<ColourScale> {
        self.mesh_distances()?.as_ref().ok()?.scale()
    }

    /// The key of the map for side A's picture on the screen.
    fn wanted_map(&self) -> Option<MapKey> {
        let posted = self.traced.tracer.posted()?;
        let scale = self.distance_scale()?;
        Some(MapKey {
            pair: self.surface_pair()?,
            intersector: Arc::clone(&posted.context.intersector),
            camera: self.shown_camera()?,
            scale,
            background: posted.context.background,
        })
    }

    fn poll_map(&mut self, ctx: &egui::Context) {
        let measured = &mut self.compared.measured;
        if let Some((key, task)) = &measured.map_task {
            let Some(result) = ended(task) else { return };
            let key = key.clone();
            measured.map_task = None;
            match result {
                Ok(map) => {
                    let size = map.key.camera.resolution();
                    let compared = &mut self.compared;
                    let render_state = &compared.render_state;
                    let uploaded = compared.screen.upload_map(render_state, size, &map.pixels);
                    compared.measured.map = Some(map);
                    if let Err(error) = uploaded {
                        self.end_comparison(&error);
                    }
                }
                Err(message) => {
                    measured.failed_map = Some(key);
                    self.error(message);
                }
            }
            ctx.request_repaint();
        }
        if !self.shows(Mode::Distance) || self.traced.tracer.is_moving() {
            return;
        }
        let measured = &self.compared.measured;
        let known = [
            measured.map.as_ref().map(|map| &map.key),
            measured.failed_map.as_ref(),
        ];
        let is_known = |key: &MapKey| known.into_iter().flatten().any(|known| known == key);
        if let Some(key) = self.wanted_map().filter(|key| !is_known(key)) {
            let wanted = key.clone();
            let trace = move || in_own_pool(|| DistanceMap::trace(wanted));
            let task = Task::spawn("distance map", ctx, trace);
            self.compared.measured.map_task = Some((key, task));
        }
    }

    /// Whether the map belongs to side A's picture on the screen.
    pub(super) fn is_map_shown(&self) -> bool {
        let map = self.compared.measured.map.as_ref();
        map.zip(self.wanted_map())
            .is_some_and(|(map, wanted)| map.key == wanted)
    }

    /// Why the distance map isn't shown; `None` if it is.
    pub fn map_status(&self) -> Option<&'static str> {
        if self.surface_pair().is_none() {
            return Some("A distance map needs another file or an earlier version as side B");
        }
        match self.mesh_distances() {
            Some(Err(_)) => Some("The distances can't be measured"),
            _ if self.is_map_shown() => None,
            _ => Some("Measuring distances…"),
        }
    }

    /// Whether the figures and the map are up to date, if they are shown.
    pub(super) fn are_figures_settled(&self) -> bool {
        let has_map = || match self.map_status() {
            None => true,
            Some(_) => {
                let is_impossible = self.mesh_distances().is_some_and(Result::is_err);
                is_impossible || self.surface_pair().is_none()
            }
        };
        let has_figures = || self.has_figures() && self.compared.measured.figures_task.is_none();
        let is_compared = self.is_comparable();
        (!self.shows(Mode::Distance) || has_map())
            && (!self.shows_figures() || !is_compared || has_figures())
    }

    /// Whether both pictures exist and have the same size.
    fn is_comparable(&self) -> bool {
        let sides = self.pixels_of_a().zip(self.compared.pixels());
        sides.is_some_and(|((a, _), (b, _))| a == b)
    }
}
