//! The documents of side B: loading, packing, tracing and rasterizing them.

use crate::app::App;
use crate::comparison::{Source, TracedSide};
use crate::document::Document;
use crate::opening::Loading;
use glam::DVec3;
use hitscope_core::obj::LoadError;
use hitscope_core::{Aabb, Camera};
use hitscope_lab::commands::default_thread_count;

impl App {
    /// Starts the work that side B requires, unless it is done or running.
    pub(in crate::app) fn prepare_other(&mut self, ctx: &egui::Context) {
        if !self.is_comparing() {
            return;
        }
        let source = self.seen.comparison.source;
        if source != self.compared.source {
            self.compared.clear();
            self.compared.source = source;
            ctx.request_repaint();
        }
        match source {
            Source::Traced | Source::Rasterized => {
                let original = &self.open.document;
                let sibling = &mut self.compared.sibling;
                sibling
                    .get_or_insert_with(|| original.sibling())
                    .follow(original);
            }
            Source::Mesh => self.want_mesh(ctx),
            Source::Picture => {
                if let Some(path) = &self.seen.comparison.picture_file {
                    let max_memory = self.open.load_options.max_memory;
                    self.compared.reference.want(path, max_memory, ctx);
                }
            }
            Source::Earlier => {}
        }
        let settings = self.other_settings();
        let Some(document) = self.compared.document_mut() else {
            return;
        };
        if source.is_other_scene() {
            // As for side A, not while a slider is dragged.
            if !ctx.egui_is_using_pointer() && document.use_crease(settings.crease()) {
                ctx.request_repaint();
            }
            // Preparing side A has turned an impossible clip off.
            let clip = settings.clip.clip().ok().flatten();
            if document.use_clip(clip.as_ref()) == Ok(true) {
                ctx.request_repaint();
            }
        }
        document.use_kernel(settings.kernel(), ctx);
        document.use_second(settings.second_kernel(), ctx);
    }

    /// Starts to load the other file, unless it is loaded or being loaded.
    fn want_mesh(&mut self, ctx: &egui::Context) {
        let Some(path) = &self.seen.comparison.mesh_file else {
            return;
        };
        let compared = &mut self.compared;
        let loaded = compared.mesh.as_ref().and_then(|mesh| mesh.path.as_ref());
        let loading = compared.loading.as_ref().map(|loading| &loading.path);
        if loaded == Some(path) || loading == Some(path) {
            return;
        }
        if let Some(loading) = compared.loading.take() {
            loading.cancel();
        }
        let kernel = self.seen.comparison.settings(&self.seen.settings).kernel();
        compared.loading = Some(Loading::start(
            path.clone(),
            self.open.load_options,
            kernel,
            self.preferences.scene_options(),
            0.0,
            ctx,
        ));
    }

    /// The bounds of side B's scene in the coordinates of side A; `None` unless side B shows another scene.
    pub(in crate::app) fn bounds_of_other_scene(&self) -> Option<Aabb> {
        let is_shown = self.is_comparing() && self.compared.source.is_other_scene();
        let document = self.compared.document().filter(|_| is_shown)?;
        let by = (document.origin() - self.open.document.origin()).as_vec3();
        let Aabb { min, max } = document.loaded.scene.bounds_with_elements();
        Some(Aabb {
            min: min + by,
            max: max + by,
        })
    }

    /// A camera of side A in the coordinates of another document.
    pub(in crate::app) fn camera_in(&self, document: &Document, camera: Camera) -> Camera {
        moved(camera, self.open.document.origin() - document.origin())
    }

    /// A camera of another document in the coordinates of side A.
    pub(super) fn camera_from(&self, document: &Document, camera: Camera) -> Camera {
        moved(camera, document.origin() - self.open.document.origin())
    }

    /// Traces or rasterizes side B for the camera that side A is being traced for.
    pub(in crate::app) fn request_other(&mut self, ctx: &egui::Context) {
        if !self.is_comparing() || self.seen.comparison.source != self.compared.source {
            return;
        }
        self.request_rasterized_a(ctx);
        let settings = self.other_settings();
        let mut lights = std::mem::take(&mut self.compared.lights);
        let posted = self.traced.tracer.posted();
        let Some((document, posted)) = self.compared.document().zip(posted) else {
            return;
        };
        let camera = self.camera_in(document, posted.context.camera);
        let lighting = self.lighting(&settings, &document.loaded, &mut lights, ctx);
        let request = self.request_of(document, &settings, camera, lighting, ctx.theme());
        let compared = &mut self.compared;
        compared.lights = lights;
        if compared.source == Source::Rasterized {
            compared.rasterized.request(request, ctx);
        } else {
            let start = || TracedSide::new(default_thread_count(), ctx);
            let side = compared.traced.get_or_insert_with(start);
            side.tracer
                .set_first_step(self.seen.settings.moving.block());
            side.tracer.request(request);
        }
    }

    /// Collects results of side B's threads.
    pub(super) fn poll_sides(&mut self, ctx: &egui::Context) {
        self.poll_mesh(ctx);
        let mut messages = Vec::new();
        if let Some(document) = self.compared.document_mut() {
            document.poll_retired(ctx);
            let broken = [
                document.poll_kernel(),
                document.poll_second(),
                document.poll_tree(),
            ];
            let broken = broken.into_iter().filter_map(Result::err);
            messages.extend(broken.map(|broken| broken.to_string()));
        }
        let lights = self.compared.lights.poll();
        messages.extend(lights.err().map(|panicked| panicked.to_string()));
        let (limits, is_paused) = (self.limits(), self.traced.tracer.is_paused());
        if let Some(side) = &mut self.compared.traced {
            side.tracer.set_limits(limits);
            if side.tracer.is_paused() != is_paused {
                side.tracer.toggle_pause();
            }
            let panics = side.tracer.collect(ctx);
            messages.extend(panics.first().map(ToString::to_string));
        }
        let rasterized = [
            &mut self.compared.rasterized_a,
            &mut self.compared.rasterized,
        ];
        messages.extend(
            rasterized
                .into_iter()
                .filter_map(|side| side.poll(ctx).err()),
        );
        let longest = self
            .compared
            .render_state
            .device
            .limits()
            .max_texture_dimension_2d;
        let compared = &mut self.compared;
        if let Err(message) = compared.reference.poll(longest, &mut compared.retired) {
            self.seen.comparison.picture_file = None;
            messages.push(message);
        }
        for message in messages {
            self.error(message);
        }
    }

    /// Uses the other file once it is loaded.
    fn poll_mesh(&mut self, ctx: &egui::Context) {
        let Some(loading) = &self.compared.loading else {
            return;
        };
        let loaded = match loading.poll() {
            Ok(None) => return,
            Ok(Some(Err(LoadError::Cancelled { .. }))) => Err(None),
            Ok(Some(result)) => result.map_err(|error| Some(error.to_string())),
            Err(broken) => Err(Some(format!("{}: {broken}", loading.path.display()))),
        };
        self.compared.loading = None;
        match loaded {
            Ok(mut document) => {
                document.improve(ctx);
                self.compared.drop_mesh();
                self.compared.mesh = Some(document);
                self.feedback.notice = None;
                self.pick_again_on_b(ctx);
            }
            Err(message) => {
                self.seen.comparison.mesh_file = None;
                if let Some(message) = message {
                    self.error(message);
                }
            }
        }
    }

    /// Whether side B is complete, or there is nothing to wait for.
    pub(super) fn are_sides_settled(&self) -> bool {
        let (compared, comparison) = (&self.compared, &self.seen.comparison);
        if compared.source != comparison.source
            || compared.loading.is_some()
            || compared.lights.is_pending()
            || (self.rasterizes_a() && !self.is_rasterized_a_finished())
        {
            return false;
        }
        match compared.source {
            Source::Rasterized => compared.rasterized.is_finished(),
            Source::Picture => !compared.reference.is_pending(),
            Source::Mesh if comparison.mesh_file.is_none() => true,
            Source::Earlier if compared.earlier.is_none() => true,
            Source::Traced | Source::Mesh | Source::Earlier => {
                let kernel = self.other_settings().kernel();
                let document = compared.document();
                let is_packed = document.is_some_and(|document| document.kernel() == kernel);
                let side = compared.traced.as_ref();
                is_packed && side.is_some_and(|side| side.tracer.is_finished())
            }
        }
    }
}

/// A camera that is moved by a vector. Moving by 0 changes no bit.
fn moved(camera: Camera, by: DVec3) -> Camera {
    if by == DVec3::ZERO {
        camera
    } else {
        camera.moved(by)
    }
}
