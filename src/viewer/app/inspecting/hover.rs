//! The read-out under the pointer: t, element, part, and the number that the view shows.
//!
//! Each move of the pointer traces one ray, on the thread of the window.

use crate::app::App;
use crate::app::canvas::Canvas;
use crate::comparison::Side;
use crate::numbers::significant;
use crate::overlay::{Label, Place};
use crate::tracer::Request;
use egui::Response;
use glam::UVec2;
use hitscope_core::film::ShownPixel;
use hitscope_core::sampler::Sampler;
use hitscope_core::{Hit, Scene};

/// The read-out.
pub(crate) struct Hover {
    pub is_on: bool,
    /// What the last ray depended on, and its text.
    last: Option<(HoverKey, String)>,
}

impl Default for Hover {
    fn default() -> Self {
        Self {
            is_on: true,
            last: None,
        }
    }
}

/// What the text depends on.
struct HoverKey {
    /// The request, with the camera of the pixel on the screen.
    request: Request,
    pixel: UVec2,
    /// Whether the normals that the view needs are computed. This thread doesn't wait for them.
    has_normals: bool,
}

impl HoverKey {
    fn new(request: Request, pixel: UVec2) -> Self {
        let needs_normals = request.integrator.needs.vertex_normals;
        Self {
            has_normals: !needs_normals || request.context.scene.has_vertex_normals(),
            request,
            pixel,
        }
    }
}

impl Hover {
    /// The text, in the lower left corner of the picture.
    pub fn label(&self) -> Option<Label> {
        let (_, text) = self.last.as_ref()?;
        Some(Label {
            place: Place::Corner { bar_px: None },
            text: text.clone(),
        })
    }
}

impl App {
    /// Reads out what is under the pointer, unless it drags or a screenshot is being taken.
    pub(in crate::app) fn hover(&mut self, response: &Response, canvas: Canvas) {
        let pos = response.hover_pos().filter(|_| !response.dragged());
        let key = pos
            .filter(|_| self.picked.inspecting.hover.is_on && self.screenshot.is_none())
            .and_then(|pos| {
                if self.side_at(pos, canvas) == Side::B {
                    return self.hover_on_b(pos, canvas);
                }
                let ShownPixel { camera, pixel } = self.shown_at(pos, canvas)?;
                let mut request = self.traced.tracer.posted()?.clone();
                let scene = &self.open.document.loaded.scene;
                if self.open.document.is_blank
                    || !std::sync::Arc::ptr_eq(scene, &request.context.scene)
                {
                    return None;
                }
                request.context.camera = camera;
                Some(HoverKey::new(request, pixel))
            });
        let Some(key) = key else {
            self.picked.inspecting.hover.last = None;
            return;
        };
        let is_known = |(known, _): &(HoverKey, String)| {
            known.pixel == key.pixel
                && known.has_normals == key.has_normals
                && known.request == key.request
        };
        if !self
            .picked
            .inspecting
            .hover
            .last
            .as_ref()
            .is_some_and(is_known)
        {
            let text = read_out(&key);
            self.picked.inspecting.hover.last = Some((key, text));
        }
    }

    /// What is under the pointer on side B of a comparison.
    fn hover_on_b(&self, pos: egui::Pos2, canvas: Canvas) -> Option<HoverKey> {
        let ShownPixel { camera, pixel } = self.shown_by_b(pos, canvas)?;
        let mut request = self.request_on_b()?;
        request.context.camera = camera;
        Some(HoverKey::new(request, pixel))
    }

    /// Whether the read-out under the pointer is on.
    pub fn reads_out(&self) -> bool {
        self.picked.inspecting.hover.is_on
    }

    /// Turns the read-out under the pointer on or off.
    pub(crate) fn toggle_read_out(&mut self) {
        self.picked.inspecting.hover.is_on ^= true;
    }
}

/// The text for a pixel.
fn read_out(key: &HoverKey) -> String {
    let (context, view) = (&key.request.context, key.request.integrator);
    let ray = context.camera.ray_through(key.pixel.as_dvec2() + 0.5);
    let hit = context.intersector.closest_hit(&ray);
    let mut parts = vec![match hit {
        Some(hit) => format!("t {}", significant(hit.t.into(), 6)),
        None => "no hit".to_owned(),
    }];
    if let Some(hit) = hit {
        parts.extend(element(&context.scene, &hit));
    }
    let mut sampler = Sampler::new(key.pixel, 0);
    if key.has_normals
        && let Some(number) = view.number(context, &ray, hit, &mut sampler)
    {
        let unit = match view.scale(context) {
            Ok(Some(scale)) => scale.unit().to_owned(),
            _ => String::new(),
        };
        let text = format!("{} {} {unit}", view.title, significant(number, 6));
        parts.push(text.trim_end().to_owned());
    }
    parts.join("  ·  ")
}

/// The primitive that was hit, and the names of its group and its material.
fn element(scene: &Scene, hit: &Hit) -> Vec<String> {
    let (group, _) = scene.group_of(hit.primitive);
    let mut parts = vec![format!("{} {}", group.shape().name, hit.primitive)];
    let attributes = scene.mesh().attributes();
    if scene.is_triangle(hit.primitive) {
        parts.extend(attributes.groups.of(hit.primitive).cloned());
    }
    let material = attributes.materials.get(scene.material(hit.primitive));
    parts.extend(material.map(|material| material.name.clone()));
    parts.retain(|part| !part.is_empty());
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harness::{app_with, wait};
    use crate::settings::Settings;
    use glam::Vec3;
    use hitscope_core::TriangleMesh;
    use hitscope_core::mesh::Crease;
    use hitscope_core::mesh::{Assigned, Attributes, Runs};
    use std::sync::Arc;

    #[test]
    fn the_read_out_does_not_compute_normals() {
        let mut settings = Settings::default();
        settings.keep_view("interpolation");
        let Some(mut window) = app_with(settings) else {
            return;
        };
        wait(&mut window, "the picture", App::is_settled);
        let app = window.state();
        let mut request = app.traced.tracer.posted().expect("a picture").clone();
        let size = app.film().size();
        let all = (0..size.element_product()).map(|k| UVec2::new(k % size.x, k / size.x));
        let text = |request: &Request, pixel| read_out(&HoverKey::new(request.clone(), pixel));
        let shows = |text: &str| text.contains("Interpolation");
        let on_knot = all
            .into_iter()
            .step_by(97)
            .find(|pixel| shows(&text(&request, *pixel)));
        let on_knot = on_knot.expect("a pixel with an angle");
        let scene = Arc::new(request.context.scene.with_crease(Crease::Above(1.0)));
        request.context.scene = Arc::clone(&scene);
        assert!(!shows(&text(&request, on_knot)));
        assert!(!scene.has_vertex_normals());
        scene.vertex_normals();
        assert!(HoverKey::new(request, on_knot).has_normals);
    }

    #[test]
    fn a_group_without_a_name_leaves_no_empty_field() {
        for (name, expected) in [("", vec!["triangle 0"]), ("lid", vec!["triangle 0", "lid"])] {
            let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
            let attributes = Attributes {
                groups: Assigned::new(vec![name.to_owned()], Runs::default()),
                ..Attributes::default()
            };
            let mesh = TriangleMesh::new(corners, vec![[0, 1, 2]]).with_attributes(attributes);
            let hit = Hit {
                t: 1.0,
                u: 0.2,
                v: 0.2,
                primitive: 0,
            };
            assert_eq!(element(&hitscope_core::scene::scene(mesh), &hit), expected);
        }
    }
}
