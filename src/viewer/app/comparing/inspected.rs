//! Inspection of side B: a click inspects its ray with its own kernel and mesh.

use crate::app::App;
use crate::app::canvas::Canvas;
use crate::comparison::{Mode, Side, Source};
use crate::document::Document;
use crate::tracer::Request;
use egui::Pos2;
use glam::{DVec2, DVec3};
use hitscope_core::colour::ColourScale;
use hitscope_core::film::ShownPixel;
use hitscope_core::scene::Shading;

impl App {
    /// The side that a click at a position on the screen inspects: side A also where a side B is shown that isn't
    /// traced.
    pub(in crate::app) fn side_at(&self, pos: Pos2, canvas: Canvas) -> Side {
        let is_b = match self.seen.comparison.mode {
            Mode::A | Mode::Difference | Mode::Distance => false,
            Mode::B => true,
            Mode::Wipe => pos.x >= self.divider_x(canvas),
        };
        if is_b && self.traced_document_of_b().is_some() {
            Side::B
        } else {
            Side::A
        }
    }

    /// Whether the traced picture of side A is shown at a position on the screen.
    pub(in crate::app) fn shows_a_at(&self, pos: Pos2, canvas: Canvas) -> bool {
        match self.seen.comparison.mode {
            _ if !self.is_comparing() => true,
            _ if self.rasterizes_a() => false,
            Mode::A => true,
            Mode::Wipe => pos.x < self.divider_x(canvas),
            Mode::B | Mode::Difference | Mode::Distance => false,
        }
    }

    /// What a side's pixel at a position on the screen shows, with its camera in the coordinates of side A.
    pub(in crate::app) fn shown_on(
        &self,
        side: Side,
        pos: Pos2,
        canvas: Canvas,
    ) -> Option<ShownPixel> {
        match side {
            Side::A => self.shown_at(pos, canvas),
            Side::B => {
                let document = self.traced_document_of_b()?;
                let ShownPixel { camera, pixel } = self.shown_by_b(pos, canvas)?;
                let camera = self.camera_from(document, camera);
                Some(ShownPixel { camera, pixel })
            }
        }
    }

    /// What the pixel of side B at a position on the screen shows, in the coordinates of its document.
    pub(in crate::app) fn shown_by_b(&self, pos: Pos2, canvas: Canvas) -> Option<ShownPixel> {
        let document = self.traced_document_of_b()?;
        let side = self.compared.traced.as_ref()?;
        let (scene, camera) = side.on_screen.as_ref()?;
        let is_current = std::ptr::eq(scene.mesh(), document.loaded.scene.mesh());
        let at = canvas.pixel_of(pos, camera).max(DVec2::ZERO).as_uvec2();
        let shown = side.shown.at(at.min(camera.resolution() - 1));
        shown.filter(|_| is_current)
    }

    /// The point of a side's surface that a pixel shows, in the coordinates of side A.
    pub(in crate::app) fn surface_on(&self, side: Side, shown: &ShownPixel) -> Option<DVec3> {
        let document = self.document_of(side);
        let camera = self.camera_in(document, shown.camera);
        let ray = ShownPixel { camera, ..*shown }.ray();
        let hit = document.intersector().closest_hit(&ray)?;
        let point = ray.origin.as_dvec3() + f64::from(hit.t) * ray.dir.as_dvec3();
        Some(point + document.origin() - self.open.document.origin())
    }

    /// The document of a side, if it is traced.
    pub(in crate::app) fn traced_document_of(&self, side: Side) -> Option<&Document> {
        match side {
            Side::A => Some(&self.open.document),
            Side::B => self.traced_document_of_b(),
        }
    }

    /// The document of side B, if it is traced.
    fn traced_document_of_b(&self) -> Option<&Document> {
        let is_traced = self.is_comparing() && self.compared.source.is_traced();
        self.compared.document().filter(|_| is_traced)
    }

    /// The side whose ray is inspected: the one last clicked, or side A if that one is gone.
    pub(in crate::app) fn inspected_side(&self) -> Side {
        match self.picked.side {
            Side::B if self.traced_document_of_b().is_some() => Side::B,
            _ => Side::A,
        }
    }

    /// The request of side B, with the camera of its picture on the screen, in its own coordinates.
    pub(in crate::app) fn request_on_b(&self) -> Option<Request> {
        let side = self.compared.traced.as_ref()?;
        let (scene, camera) = side.on_screen.as_ref()?;
        let mut request = side.tracer.posted()?.clone();
        request.context.camera = *camera;
        std::sync::Arc::ptr_eq(scene, &request.context.scene).then_some(request)
    }

    /// The colour scale of side B's view.
    pub(in crate::app) fn scale_of_b(&self) -> Option<ColourScale> {
        let request = match self.compared.source {
            Source::Rasterized => self.compared.rasterized.picture()?.request.clone(),
            _ => self.request_on_b()?,
        };
        request.integrator.scale(&request.context).ok()?
    }

    /// The document of a side.
    pub(in crate::app) fn document_of(&self, side: Side) -> &Document {
        let of_b = self.compared.document().filter(|_| side == Side::B);
        of_b.unwrap_or(&self.open.document)
    }

    /// The document whose file contains the mesh of a side; `None` if that file has changed.
    pub(in crate::app) fn file_of(&self, side: Side) -> Option<&Document> {
        match (side, self.compared.source) {
            (Side::B, Source::Earlier) => None,
            (Side::B, Source::Mesh) => Some(self.document_of(Side::B)),
            _ => Some(&self.open.document),
        }
    }

    /// Whether the inspected ray is traced in a scene other than the open one.
    pub(in crate::app) fn inspects_other_scene(&self) -> bool {
        self.inspected_side() == Side::B && self.compared.source.is_other_scene()
    }

    /// The shading of a side.
    pub(in crate::app) fn shading_of(&self, side: Side) -> Shading {
        match side {
            Side::A => self.seen.settings.shading(),
            Side::B => self.other_settings().shading(),
        }
    }

    /// Inspects a pick on side B again, whose scene has been replaced.
    pub(super) fn pick_again_on_b(&mut self, ctx: &egui::Context) {
        if self.picked.side == Side::B {
            self.pick_again(DVec3::ZERO, ctx);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::app::App;
    use crate::harness::{app, click, in_picture, settle, wait, write};

    /// A square at a depth.
    fn square(z: f64) -> String {
        format!("v -1 -1 {z}\nv 1 -1 {z}\nv 1 1 {z}\nv -1 1 {z}\nf 1 2 3 4\n")
    }

    fn hits_at(app: &App, z: f64) -> bool {
        let hit = app.inspection().and_then(|found| found.hit.as_ref());
        hit.is_some_and(|hit| (hit.position[2] - z).abs() < 1e-5)
    }

    #[test]
    fn a_pick_on_side_b_stays_when_its_file_is_loaded_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let first = write(&folder, "first.obj", &square(0.0));
        let second = write(&folder, "second.obj", &square(-0.25));
        let Some(mut window) = app(Some(first)) else {
            return;
        };
        settle(&mut window, "first.obj");
        window.state_mut().compare_with_mesh(second.clone());
        window.run_steps(3);
        wait(&mut window, "both sides", App::is_settled);
        window.run_steps(3);
        let at = in_picture(&window, 0.55, 0.5);
        click(&mut window, at);
        wait(&mut window, "side B", |app| hits_at(app, -0.25));
        write(&folder, "second.obj", &square(-0.5));
        window.state_mut().compare_with_mesh(second);
        wait(&mut window, "side B again", |app| hits_at(app, -0.5));
    }
}
