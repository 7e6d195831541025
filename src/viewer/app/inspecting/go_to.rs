//! Going to an element that the user names: the camera frames it, and it is picked.

use crate::app::App;
use crate::comparison::Side;
use crate::face_lookup::open_again;
use crate::task::{Task, TaskPanicked};
use glam::UVec2;
use hitscope_core::Camera;
use hitscope_core::film::ShownPixel;
use hitscope_core::mesh::ElementPlace;
use hitscope_lab::element::{Element, Rereadable};
use std::path::Path;

/// Distance of the camera, relative to the distance that frames the element: shows some of the surface around it.
const DISTANCE: f64 = 3.0;

/// The way to an element.
pub(crate) enum Journey {
    /// The element is looked up.
    Lookup(Element, Task<Result<ElementPlace, String>>),
    /// The pixel that shows it is inspected; then its crossing is marked.
    Picking(Element, Camera, UVec2),
}

impl App {
    /// Shows the box in which the user names an element.
    pub(crate) fn show_go_to(&mut self) {
        self.picked.inspecting.go_to.open();
    }

    /// Shows the box if it is open, and starts to look up the element.
    pub(in crate::app) fn go_to_ui(&mut self, ctx: &egui::Context) {
        if let Some(element) = self.picked.inspecting.go_to.go_to_ui(ctx) {
            self.go_to(element, ctx);
        }
    }

    /// Starts to look up an element. The camera then moves to it.
    pub(in crate::app) fn go_to(&mut self, element: Element, ctx: &egui::Context) {
        let (loaded, path) = (
            self.open.document.loaded.clone(),
            self.open.document.path.clone(),
        );
        // In the background: the file may have to be read again.
        let find = move || {
            let open = || open_again(path.as_deref());
            let file = Rereadable {
                path: path.as_deref().unwrap_or(Path::new("the built-in scene")),
                open: &open,
            };
            element.place(&loaded, file).map_err(|e| e.to_string())
        };
        let task = Task::spawn("go to", ctx, find);
        self.picked.inspecting.journey = Some(Journey::Lookup(element, task));
    }

    /// Frames and picks the element once it is found; marks it once it is picked.
    pub(super) fn poll_journey(&mut self, ctx: &egui::Context) {
        match &self.picked.inspecting.journey {
            None => {}
            Some(Journey::Lookup(element, task)) => {
                let element = *element;
                let result = match task.poll() {
                    Ok(None) => return,
                    Ok(Some(result)) => result,
                    Err(broken @ TaskPanicked) => Err(broken.to_string()),
                };
                self.picked.inspecting.journey = None;
                match result {
                    Ok(place) => self.arrive(element, &place, ctx),
                    Err(problem) => self.picked.inspecting.go_to.refuse(problem),
                }
            }
            Some(Journey::Picking(element, camera, pixel)) => {
                let is_there = |pick: &&mut crate::app::pick::Pick| {
                    pick.camera == *camera && pick.inspection.pixel == pixel.to_array()
                };
                if let Some(pick) = self.picked.pick.as_mut().filter(is_there) {
                    let crossings = &pick.inspection.crossings;
                    let mesh = self.open.document.loaded.scene.mesh();
                    let found = crossings.iter().position(|crossing| match *element {
                        Element::Triangle(index) => crossing.primitive as usize == index,
                        Element::Face(face) => mesh
                            .triangles_of_face(face as u32)
                            .contains(&crossing.primitive),
                        _ => false,
                    });
                    if let Some(crossing) = found {
                        pick.select(crossing);
                    }
                    self.picked.inspecting.journey = None;
                } else if self.picked.picking.is_none() {
                    // Another pixel was picked meanwhile.
                    self.picked.inspecting.journey = None;
                }
            }
        }
    }

    /// Frames an element and picks the pixel that shows its centre.
    fn arrive(&mut self, element: Element, place: &ElementPlace, ctx: &egui::Context) {
        let scene = self.open.document.loaded.scene.bounds_with_elements();
        self.seen
            .turntable
            .frame(place.bounds, self.shown.resolution);
        self.seen.turntable.centre_on(place.centre);
        self.seen.turntable.distance *= DISTANCE;
        self.seen.turntable.set_scene(scene);
        let camera = self.seen.turntable.camera(self.shown.resolution);
        let Some(pixel) = camera.pixel_of(place.centre) else {
            return;
        };
        let pixel = pixel.as_uvec2().min(self.shown.resolution - 1);
        self.pick_pixel(Side::A, ShownPixel { camera, pixel }, true, ctx);
        self.picked.inspecting.journey = Some(Journey::Picking(element, camera, pixel));
    }
}
