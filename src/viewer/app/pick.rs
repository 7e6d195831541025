//! The picked pixel, which is inspected in the background, and again when kernel, shading or tree change.

use super::App;
use crate::comparison::Side;
use crate::document::Document;
use crate::face_lookup::{FaceInFile, look_up_face};
use crate::panels::{self, inspect::PickView};
use crate::tab::Tab;
use crate::task::Task;
use glam::{DVec3, UVec2, Vec3};
use hitscope_core::loading::is_scene_file;
use hitscope_core::mesh::Crease;
use hitscope_core::scene::Shading;
use hitscope_core::{Camera, Ray, TriangleMesh};
use hitscope_lab::inspection::{CrossingReport, Inspection, TriangleReport};
use std::sync::Arc;
use std::time::Duration;

/// A clicked pixel and its inspection.
pub(crate) struct Pick {
    pub inspection: Arc<Inspection>,
    /// The camera of the picture that was clicked.
    pub camera: Camera,
    /// The scene's origin in the file's coordinates.
    origin: DVec3,
    /// The crossing that is marked instead of the hit.
    crossing: Option<usize>,
    /// The face that was hit, once it has been read from the file.
    face: Option<FaceInFile>,
    /// Whether the ray was traced in the open scene, not in the scene of side B.
    is_of_open_scene: bool,
    basis: InspectionBasis,
}

/// A pixel that is being inspected.
pub(crate) struct Picking {
    pub camera: Camera,
    pub pixel: UVec2,
    /// The crossing to mark, unless the same pixel was already picked.
    crossing: Option<usize>,
    task: Task<Pick>,
}

impl Picking {
    /// The time since the inspection began.
    pub fn elapsed(&self) -> Duration {
        self.task.elapsed()
    }

    /// The crossing that will be marked. If the same ray is inspected again, that of the old pick.
    pub fn crossing(&self, old: Option<&Pick>) -> Option<usize> {
        let is_same = |old: &&Pick| {
            old.inspection.pixel == self.pixel.to_array() && old.camera == self.camera
        };
        old.filter(is_same)
            .map_or(self.crossing, |old| old.crossing)
    }
}

/// The settings and state that an inspection depends on, besides mesh and ray.
#[derive(Clone, Copy, PartialEq)]
struct InspectionBasis {
    side: Side,
    kernel: &'static str,
    shading: Shading,
    crease: Crease,
    /// The number of changes of the part of the scene that is shown.
    part_changes: u64,
    /// Whether the tree is final; the number of tests depends on the tree.
    has_last_tree: bool,
}

impl Pick {
    /// The triangle that was hit, if it is one.
    fn triangle(&self) -> Option<&TriangleReport> {
        let hit = self.inspection.hit.as_ref();
        hit.and_then(|hit| hit.triangle.as_ref())
    }

    /// The crossing that is marked, counted from 0: the hit unless another one was selected.
    pub fn selected(&self) -> Option<usize> {
        let crossings = &self.inspection.crossings;
        let last = crossings.len().checked_sub(1)?;
        let of_hit = || {
            let hit = self.inspection.hit.as_ref()?;
            crossings.iter().position(|crossing| {
                crossing.primitive == hit.primitive || crossing.also.contains(&hit.primitive)
            })
        };
        let selected = self.crossing.or_else(of_hit).unwrap_or(0);
        Some(selected.min(last))
    }

    /// The crossing that is marked instead of the hit.
    pub fn crossing(&self) -> Option<usize> {
        self.crossing
    }

    /// Marks a crossing.
    pub fn select(&mut self, crossing: usize) {
        self.crossing = Some(crossing);
    }

    /// Marks the crossing so many further along the ray, or the first or last one.
    pub fn step(&mut self, step: i8) {
        if let Some(selected) = self.selected() {
            let last = self.inspection.crossings.len() - 1;
            let next = selected.saturating_add_signed(step.into());
            self.select(next.min(last));
        }
    }

    fn marked(&self) -> Option<&CrossingReport> {
        self.inspection.crossings.get(self.selected()?)
    }

    /// The point that is marked, in the scene's coordinates.
    pub fn point(&self) -> Option<DVec3> {
        let of_hit = || Some(self.inspection.hit.as_ref()?.position);
        let position = match self.marked() {
            // The hit's position, unless another crossing was selected.
            Some(crossing) if self.crossing.is_some() => Some(crossing.position),
            _ => of_hit(),
        };
        position.map(|position| DVec3::from_array(position) - self.origin)
    }

    /// The primitive at the marked point, if it belongs to the open scene.
    pub fn marked_primitive(&self) -> Option<u32> {
        match self.marked() {
            _ if !self.is_of_open_scene => None,
            Some(crossing) if self.crossing.is_some() => Some(crossing.primitive),
            _ => self.inspection.hit.as_ref().map(|hit| hit.primitive),
        }
    }

    /// The picked ray.
    pub fn ray(&self) -> Ray {
        let pixel = UVec2::from_array(self.inspection.pixel);
        self.camera.ray_through(pixel.as_dvec2() + 0.5)
    }

    /// The contents of the Inspect tab.
    pub fn view(&self, document: &Document, is_reading_face: bool) -> PickView<'_> {
        let triangle = self.triangle();
        let mesh = document.loaded.scene.mesh();
        let coordinates = &mesh.attributes().texture_coordinates;
        PickView {
            inspection: &self.inspection,
            crossing: self.selected(),
            kernel: panels::kernel_name(self.basis.kernel),
            face: self.face.as_ref(),
            is_reading_face,
            has_uv: triangle.is_some_and(|triangle| coordinates.are_complete(triangle.index)),
            colour: triangle.and_then(|triangle| colour_at(mesh, triangle)),
        }
    }
}

/// The file's vertex colours, interpolated at a hit.
fn colour_at(mesh: &TriangleMesh, hit: &TriangleReport) -> Option<[f32; 3]> {
    let corners = mesh.triangles().get(hit.index as usize)?;
    let mut sum = Vec3::ZERO;
    for (&vertex, weight) in corners.iter().zip(hit.barycentric) {
        sum += *mesh.attributes().colours.get(vertex as usize)? * weight;
    }
    Some(sum.to_array())
}

impl App {
    /// Why nothing can be done with the pick; `None` if there is one.
    pub(crate) fn lacks_pick(&self) -> Option<&'static str> {
        self.picked
            .pick
            .is_none()
            .then_some("No pixel is picked: click one")
    }

    /// Why nothing can be done with the picked ray's crossings; `None` if there are some.
    pub(crate) fn lacks_crossing(&self) -> Option<&'static str> {
        let crosses = |pick: &Pick| !pick.inspection.crossings.is_empty();
        self.obstacle_unless(crosses)
    }

    /// Why nothing can be done with what the picked ray hits; `None` if it hits something.
    pub(crate) fn lacks_hit(&self) -> Option<&'static str> {
        let is_other = self
            .picked
            .pick
            .as_ref()
            .filter(|pick| !pick.is_of_open_scene);
        let obstacle = is_other.map(|_| "The picked ray belongs to the scene of side B");
        obstacle.or_else(|| self.obstacle_unless(|pick| pick.marked_primitive().is_some()))
    }

    fn obstacle_unless(&self, is_met: impl Fn(&Pick) -> bool) -> Option<&'static str> {
        let misses = |pick: &Pick| (!is_met(pick)).then_some("The picked ray hits nothing");
        self.lacks_pick()
            .or_else(|| misses(self.picked.pick.as_ref()?))
    }

    /// Marks the crossing so many further along the picked ray.
    pub(crate) fn step_crossing(&mut self, step: i8) {
        if let Some(pick) = &mut self.picked.pick {
            pick.step(step);
        }
    }

    /// Inspects a pixel of a side and opens the Inspect tab, unless the list of parts is shown.
    pub(super) fn inspect(
        &mut self,
        side: Side,
        camera: Camera,
        pixel: UVec2,
        ctx: &egui::Context,
    ) {
        self.picked.side = side;
        if let Some(pick) = &mut self.picked.pick {
            pick.crossing = None;
        }
        self.start_picking(camera, pixel, None, ctx);
        // The list of parts stays open, because it has commands for the picked part.
        if self.preferences.tab != Tab::Parts {
            self.preferences.tab = Tab::Inspect;
        }
    }

    /// Inspects the picked pixel again, or the one being inspected, in a scene whose origin has moved.
    pub(super) fn pick_again(&mut self, shift: DVec3, ctx: &egui::Context) {
        let (pick, picking) = (self.picked.pick.take(), self.picked.picking.take());
        let old = pick.as_ref();
        let next = picking.map(|next| (next.camera, next.pixel, next.crossing(old)));
        let of_old = |pick: &Pick| {
            let pixel = UVec2::from_array(pick.inspection.pixel);
            (pick.camera, pixel, pick.crossing)
        };
        if let Some((camera, pixel, crossing)) = next.or_else(|| old.map(of_old)) {
            self.start_picking(camera.moved(shift), pixel, crossing, ctx);
        }
    }

    /// Inspects the picked pixel again if the kernel, the shading or the tree has changed.
    pub(super) fn refresh_pick(&mut self, ctx: &egui::Context) {
        if self.picked.picking.is_some() {
            return;
        }
        let Some(pick) = &self.picked.pick else {
            return;
        };
        if pick.basis != self.inspection_basis() {
            let pixel = UVec2::from_array(pick.inspection.pixel);
            self.start_picking(pick.camera, pixel, pick.crossing, ctx);
        }
    }

    fn inspection_basis(&self) -> InspectionBasis {
        let side = self.inspected_side();
        let document = self.document_of(side);
        InspectionBasis {
            side,
            kernel: document.intersector().kernel().name,
            shading: self.shading_of(side),
            crease: document.loaded.scene.crease(),
            part_changes: document.part_changes(),
            has_last_tree: document.has_last_tree(),
        }
    }

    /// Inspects a pixel and marks a crossing of its ray.
    pub(super) fn start_picking(
        &mut self,
        camera: Camera,
        pixel: UVec2,
        crossing: Option<usize>,
        ctx: &egui::Context,
    ) {
        let basis = self.inspection_basis();
        let document = self.document_of(basis.side);
        let scene = Arc::clone(&document.loaded.scene);
        let intersector = Arc::clone(document.intersector());
        // Picks are kept in the coordinates of the open scene.
        let origin = self.open.document.origin();
        let traced_camera = self.camera_in(document, camera);
        let is_of_open_scene = !self.inspects_other_scene();
        // In the background: each kernel tests every triangle near the ray, which may be a million in a bad mesh.
        let inspect = move || {
            let shading = basis.shading;
            let inspection =
                Inspection::of_pixel(&scene, &*intersector, shading, &traced_camera, pixel);
            Pick {
                inspection: Arc::new(inspection),
                camera,
                origin,
                crossing: None,
                face: None,
                is_of_open_scene,
                basis,
            }
        };
        self.picked.picking = Some(Picking {
            camera,
            pixel,
            crossing,
            task: Task::spawn("inspect", ctx, inspect),
        });
    }

    fn start_face_lookup(&mut self, pick: &Pick, ctx: &egui::Context) {
        let Some(document) = self.file_of(self.inspected_side()) else {
            self.picked.face_lookup = None;
            return;
        };
        let triangle = pick.triangle();
        // The faces of a scene file's meshes aren't in that file.
        let is_mesh = !document.path.as_deref().is_some_and(is_scene_file);
        self.picked.face_lookup = triangle.filter(|_| is_mesh).map(|triangle| {
            let line = triangle.line.unwrap_or(0);
            let scene = &document.loaded.scene;
            look_up_face(document.path.clone(), scene, triangle.index, line, ctx)
        });
    }

    fn poll_face_lookup(&mut self) {
        let face = match self.picked.face_lookup.as_ref().map(Task::poll) {
            None | Some(Ok(None)) => return,
            Some(Ok(Some(face))) => face,
            Some(Err(panicked)) => FaceInFile::Unknown(panicked.to_string()),
        };
        self.picked.face_lookup = None;
        if let Some(pick) = &mut self.picked.pick {
            pick.face = Some(face);
        }
    }

    /// Shows the result of the last inspection once it is ready.
    pub(super) fn poll_picking(&mut self, ctx: &egui::Context) {
        self.poll_face_lookup();
        let Some(picking) = &self.picked.picking else {
            return;
        };
        let crossing = picking.crossing(self.picked.pick.as_ref());
        let result = match picking.task.poll() {
            Ok(None) => return,
            Ok(Some(pick)) => Ok(Pick { crossing, ..pick }),
            Err(panicked) => Err(panicked),
        };
        self.picked.picking = None;
        match result {
            Ok(mut pick) => {
                if let Some(document) = self.file_of(self.inspected_side()) {
                    let lines = &document.loaded.report.face_lines;
                    // Nothing else uses it yet, so `make_mut` doesn't copy it.
                    Arc::make_mut(&mut pick.inspection).find_line(lines);
                }
                let index = |pick: &Pick| pick.triangle().map(|triangle| triangle.index);
                let is_same = |old: &Pick| index(old) == index(&pick) && old.face.is_some();
                match self.picked.pick.take().filter(is_same) {
                    Some(old) => pick.face = old.face,
                    None => self.start_face_lookup(&pick, ctx),
                }
                self.picked.pick = Some(pick);
            }
            Err(panicked) => {
                // The old result is outdated.
                self.picked.pick = None;
                self.error(panicked);
            }
        }
    }
}
