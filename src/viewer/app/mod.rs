//! The app: its parts and the order of work in a frame.
//!
//! | file | part |
//! |---|---|
//! | this file, `parts` | the app and its parts; the order of work in a frame |
//! | `state` | what others may read of the parts |
//! | `prepare` | preparing the document for the settings |
//! | `canvas`, `labels` | the picture with its overlay and marks; texts over it |
//! | `pointer`, `pick`, `copying` | clicks on the picture; the picked pixel; its inspection as text |
//! | `navigation`, `gizmo` | drags, scrolling, flying and animated changes of the view; the axis gizmo |
//! | `magnifier`, `pixel_values` | the magnified picture, and the values in its pixels |
//! | `pictures` | pictures of what is on the screen |
//! | `picture_dialog`, `picture_order` | pictures of any size: the dialog; rendering and saving |
//! | `work` | long-running background work |
//! | `feedback` | messages: the notice, toasts and the log |
//! | `inspecting` | the list of picks, measuring, the read-out under the pointer, going to elements |
//! | `path`, `flaws` | the path of a sample of the picked pixel; the marked flaws |
//! | `clipping`, `hiding` | the part of the scene that is shown |
//! | `comparing` | the comparison with another picture |
//! | `request` | requests to the tracers |
//! | `legend` | the legend in the picture, and its range |
//! | `light`, `scene_lights` | noise, exposure; the lights of a scene |
//! | `environment` | the environment in place of the scene's own |
//! | `reopening` | continuing in another window after the device was lost |
//! | `files` | loading, reloading and saving |
//! | `dialogs` | file dialogs |
//! | `sessions` | sessions; undo and redo |
//! | `first_view`, `view_text` | the view in which a document opens; the view as text |
//! | `framing` | framing of the picked primitive and of its part |
//! | `hints` | the message in the middle of an empty picture |
//! | `side_panel`, `status_line` | the side panel and the status line |
//! | `messages` | path fields, messages, sheets over the window |
//!
//! What keys, buttons and menus do is in [`command`](crate::command).

mod canvas;
mod clipping;
mod comparing;
mod copying;
mod dialogs;
mod environment;
mod feedback;
mod files;
mod first_view;
pub(crate) mod flaws;
mod framing;
mod gizmo;
mod hiding;
mod hints;
mod inspecting;
mod labels;
mod legend;
mod light;
mod magnifier;
mod messages;
mod navigation;
mod parts;
mod path;
mod pick;
mod picture_dialog;
mod picture_order;
mod pictures;
mod pixel_values;
mod pointer;
mod prepare;
mod reopening;
mod request;
mod scene_lights;
mod sessions;
mod side_panel;
mod state;
mod status_line;
mod view_text;
mod work;

pub(crate) use dialogs::Purpose;
pub(crate) use messages::Sheet;
pub(crate) use work::working_ui;

use crate::command::{Commands, Entry, keys, menu_bar, tool_bar};
use crate::document::Document;
use crate::gpu::faults::Faults;
use crate::history::History;
use crate::preferences::Preferences;
use crate::screenshot::Screenshot;
use crate::settings::Settings;
use crate::storage;
use crate::tracer::Tracer;
use comparing::Compared;
use feedback::Feedback;
use hitscope_core::obj::{FaultPolicy, LoadOptions};
use hitscope_core::render::STRIP_BYTES;
use hitscope_lab::commands::default_thread_count;
use navigation::Navigation;
use parts::{Open, Picked, Seen, Shown, Traced};
use pictures::Pictures;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Options for starting the window.
#[derive(Clone, Debug)]
pub struct StartOptions {
    /// The file to load; `None` for the built-in scene.
    pub file: Option<PathBuf>,
    /// How the scene is shown at the start.
    pub settings: Settings,
    /// The preferences of the window at the start.
    pub preferences: Preferences,
    /// How files are loaded.
    pub load_options: LoadOptions,
    /// If set, saves a screenshot and closes the window.
    pub screenshot: Option<crate::screenshot::ScreenshotOptions>,
    /// The start time of the program.
    pub began: Instant,
    /// Memory of the strips in which pictures of any size are rendered, in bytes. Pictures don't depend on it.
    pub strip_bytes: u64,
}

impl Default for StartOptions {
    fn default() -> Self {
        Self {
            file: None,
            settings: Settings::default(),
            preferences: Preferences::default(),
            // The viewer shows as much of a faulty mesh as it can.
            load_options: LoadOptions {
                faults: FaultPolicy::Lenient,
                ..LoadOptions::default()
            },
            screenshot: None,
            began: Instant::now(),
            strip_bytes: STRIP_BYTES,
        }
    }
}

/// The error if eframe runs without wgpu.
#[derive(Debug, thiserror::Error)]
#[error("the window needs wgpu, but eframe runs without it")]
pub struct NoWgpu;

/// The viewer.
pub struct App {
    pub(crate) open: Open,
    pub(crate) seen: Seen,
    pub(crate) picked: Picked,
    pub(crate) shown: Shown,
    pub(crate) traced: Traced,
    pub(crate) compared: Compared,
    pub(crate) preferences: Preferences,
    /// Steps of undo.
    history: History,
    navigation: Navigation,
    feedback: Feedback,
    pictures: Pictures,
    /// Faults of the graphics device.
    faults: Faults,
    /// The window's egui context.
    ctx: egui::Context,
    screenshot: Option<Screenshot>,
}

impl App {
    /// Starts the threads. Shows the built-in scene, or loads a file and shows nothing until it is loaded.
    ///
    /// # Errors
    /// [`NoWgpu`].
    pub fn new(cc: &eframe::CreationContext<'_>, start: StartOptions) -> Result<Self, NoWgpu> {
        let render_state = cc.wgpu_render_state.clone().ok_or(NoWgpu)?;
        let ctx = &cc.egui_ctx;
        crate::theme::apply(ctx);
        ctx.set_theme(start.preferences.theme);
        let kernel = start.settings.kernel();
        let document = match start.file {
            Some(_) => Document::blank(kernel),
            None => Document::embedded(kernel),
        };
        let seen = Seen::new(start.settings, &document.loaded.scene);
        let tracer = Tracer::new(default_thread_count(), ctx);
        let mut app = Self {
            open: Open::new(document, start.load_options),
            seen,
            picked: Picked::default(),
            shown: Shown::new(&render_state, start.began),
            traced: Traced::new(tracer, &render_state),
            compared: Compared::new(&render_state),
            preferences: start.preferences,
            history: History::default(),
            navigation: Navigation::default(),
            feedback: Feedback::default(),
            pictures: Pictures::new(start.strip_bytes),
            faults: Faults::watch(&render_state.device, ctx),
            ctx: ctx.clone(),
            screenshot: start.screenshot.map(Screenshot::new),
        };
        app.prepare(ctx);
        app.open.document.improve(ctx);
        if let Some(file) = start.file {
            app.load(file, ctx);
        }
        Ok(app)
    }

    /// Stops all background work, so that the window closes without delay.
    fn stop_work(&mut self) {
        if let Some(loading) = self.open.loading.take() {
            loading.cancel();
        }
        self.open.trade = None;
        self.open.document.stop_improving();
        self.traced.tracer.stop();
        self.compared.stop();
    }

    /// Shows the first of the new errors of the device.
    fn poll_faults(&mut self) {
        if let Some(message) = self.faults.take() {
            self.error(format!("graphics: {message}"));
        }
    }
}

impl eframe::App for App {
    /// Also called while the window is hidden, so that results are collected.
    fn logic(&mut self, ctx: &egui::Context, frame: &mut eframe::Frame) {
        if let Some(secs) = frame.info().cpu_usage {
            self.shown.ui_times.push(Duration::from_secs_f32(secs));
        }
        if self.leaves_window(ctx) {
            return;
        }
        self.shown.first_picture.begin_frame();
        if ctx.input(|input| input.viewport().close_requested()) {
            self.stop_work();
        }
        self.poll_dialogs(ctx);
        self.poll_neighbours(ctx);
        self.poll_session(ctx);
        self.poll_loading(ctx);
        self.poll_saving();
        self.poll_pictures(ctx);
        self.poll_rendering();
        self.poll_environment(ctx);
        self.poll_lights();
        self.poll_watch(ctx);
        self.poll_faults();
        self.poll_picking(ctx);
        self.poll_copying(ctx);
        self.poll_document(ctx);
        self.poll_flaw();
        self.poll_range_fit();
        self.poll_framing(ctx);
        self.refresh_pick(ctx);
        self.poll_inspecting(ctx);
        self.traced.tracer.set_limits(self.limits());
        if let Some(panic) = self.traced.tracer.collect(ctx).first() {
            self.error(panic);
        }
        self.check_view();
        self.poll_comparison(ctx);
        self.poll_path(ctx);
        self.preferences.zoom = ctx.zoom_factor();
        let is_settled = self.is_settled();
        if self.screenshot.is_none() {
            self.shown.fit_to_screen.step(ctx);
        }
        if let Some(screenshot) = &mut self.screenshot {
            screenshot.step(ctx, is_settled, self.shown.first_picture.after());
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        if self.leaves_window(&ctx) {
            return;
        }
        self.take_flight_keys(&ctx);
        for command in keys::pressed(&ctx) {
            Entry::of(command, self).run(self, &ctx, frame);
        }
        if let Some(text) = keys::pasted(&ctx) {
            self.paste_view(&text);
        }
        let commands = Commands::of(self);
        menu_bar::menu_bar_ui(ui, &commands);
        tool_bar::tool_bar_ui(ui, &commands);
        self.status_ui(ui);
        self.panel_ui(ui, &commands);
        self.canvas_ui(ui);
        self.windows_ui(&ctx, &commands);
        self.picture_dialog_ui(&ctx, frame);
        self.hints_ui(&ctx, &commands);
        for entry in commands.into_chosen() {
            entry.run(self, &ctx, frame);
        }
        self.prepare(&ctx);
        self.note_step(&ctx);
    }

    /// The panels' colour, which they don't fill themselves.
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        // A screenshot uses the defaults, which must not replace the user's settings.
        if self.screenshot.is_none() {
            storage::store(&self.seen.settings, &self.preferences, storage);
        }
    }

    /// No: egui's stored widget state could make it panic at the next start, and the settings hold all that should
    /// be kept.
    fn persist_egui_memory(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod panics;
#[cfg(test)]
mod shortage;
