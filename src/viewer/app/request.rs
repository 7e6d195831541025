//! Requests to the tracers: a scene as the settings show it.

use super::App;
use crate::document::Document;
use crate::settings::Settings;
use crate::theme;
use crate::tracer::Request;
use glam::UVec2;
use hitscope_core::Camera;
use hitscope_core::integrator::{Context, INTEGRATORS, Lighting, Setting};
use std::sync::Arc;

impl App {
    /// The request for the current camera and settings.
    pub(super) fn wanted(&mut self, ctx: &egui::Context, resolution: UVec2) -> Request {
        let mut lights = std::mem::take(&mut self.traced.lights);
        let (document, settings) = (&self.open.document, &self.seen.settings);
        let lighting = self.lighting(settings, &document.loaded, &mut lights, ctx);
        let camera = self.seen.turntable.camera(resolution);
        let request = self.request_of(document, settings, camera, lighting, ctx.theme());
        self.traced.lights = lights;
        request
    }

    /// The request for a document with these settings. While the view lacks the lighting that it needs, the request is
    /// for the first view of the table.
    pub(super) fn request_of(
        &self,
        document: &Document,
        settings: &Settings,
        camera: Camera,
        lighting: Option<Lighting>,
        theme: egui::Theme,
    ) -> Request {
        let view = match &lighting {
            Some(_) => settings.view(),
            None => INTEGRATORS[0],
        };
        let mut options = settings.colours.options(view);
        if view.needs.uses(Setting::PartColours) && is_mesh_of(document, &self.open.document) {
            options.surface_colours = self.seen.parts.colours().cloned();
        }
        Request {
            context: Context {
                scene: Arc::clone(&document.loaded.scene),
                intersector: Arc::clone(document.intersector()),
                second: Arc::clone(document.second()),
                camera,
                shading: settings.shading(),
                background: theme::background(view, settings.colours.background, theme),
                lighting: lighting.unwrap_or_default(),
                options,
            },
            integrator: view,
            samples: settings.samples,
            shows_last_tree: view.needs.final_tree && document.has_last_tree(),
        }
    }
}

/// Whether both documents show the same mesh.
fn is_mesh_of(document: &Document, other: &Document) -> bool {
    std::ptr::eq(document.loaded.scene.mesh(), other.loaded.scene.mesh())
}
