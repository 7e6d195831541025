//! The app: its state and the order of work in a frame.
//!
//! | file | part |
//! |---|---|
//! | this file | state and the order of work in a frame |
//! | `state` | what others may read of the state |
//! | `canvas`, `labels` | the picture with its overlay and marks; texts over it |
//! | `pointer`, `pick` | drags, wheel and clicks on the picture; the picked pixel |
//! | `path`, `flaws` | the path of a sample of the picked pixel; the marked flaws |
//! | `light` | lights, environment, exposure |
//! | `files` | loading, reloading and saving |
//! | `first_view`, `view_text` | the view in which a document opens; the view as text |
//! | `hints` | the message in the middle of an empty picture |
//! | `side_panel`, `status_line` | the side panel and the status line |
//! | `messages` | path fields, messages, sheets over the window |
//!
//! What keys, buttons and menus do is in [`command`](crate::command).

mod canvas;
mod files;
mod first_view;
pub(crate) mod flaws;
mod hints;
mod labels;
mod light;
mod messages;
mod path;
mod pick;
mod pointer;
mod side_panel;
mod state;
mod status_line;
mod view_text;

pub(crate) use messages::Sheet;

use crate::about_sheet::AboutSheet;
use crate::command::palette::Palette;
use crate::command::{Commands, Entry, keys, menu_bar, tool_bar};
use crate::dialog::{FileDialog, Purpose};
use crate::document::Document;
use crate::face_lookup::FaceLookup;
use crate::flaw_place::FlawPlace;
use crate::gpu::picture::Picture;
use crate::look::Development;
use crate::opening::Loading;
use crate::overlay::OverlayLayer;
use crate::saving::Saving;
use crate::screenshot::Screenshot;
use crate::settings::Settings;
use crate::storage;
use crate::task::Task;
use crate::times::Times;
use crate::tracer::Tracer;
use crate::trade::Trade;
use crate::watch::Watch;
use crate::window::FitToScreen;
use eframe::egui_wgpu;
use egui_wgpu::RenderState;
use files::Neighbours;
use glam::UVec2;
use hitscope_core::camera::Turntable;
use hitscope_core::obj::{FaultPolicy, LoadOptions};
use hitscope_core::{Camera, Scene};
use hitscope_lab::commands::{default_thread_count, print_line};
use light::{EnvironmentFile, SceneLights};
use path::PickedPath;
use pick::Pick;
use pointer::Clicks;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Options for starting the window.
#[derive(Clone, Debug)]
pub struct StartOptions {
    /// The file to load; `None` for the built-in scene.
    pub file: Option<PathBuf>,
    /// The settings at the start.
    pub settings: Settings,
    /// How files are loaded.
    pub load_options: LoadOptions,
    /// If set, saves a screenshot and closes the window.
    pub screenshot: Option<crate::screenshot::ScreenshotOptions>,
}

impl Default for StartOptions {
    fn default() -> Self {
        Self {
            file: None,
            settings: Settings::default(),
            // The viewer shows as much of a faulty mesh as it can.
            load_options: LoadOptions {
                faults: FaultPolicy::Lenient,
                ..LoadOptions::default()
            },
            screenshot: None,
        }
    }
}

/// The error if eframe runs without wgpu.
#[derive(Debug, thiserror::Error)]
#[error("the window needs wgpu, but eframe runs without it")]
pub struct NoWgpu;

/// A message that stays until the user closes it.
struct Notice {
    text: String,
    kind: NoticeKind,
}

/// The kind of a message.
#[derive(Clone, Copy, PartialEq, Eq)]
enum NoticeKind {
    Error,
    Warning,
    /// A file was written.
    Saved,
}

/// The viewer.
pub struct App {
    pub(crate) settings: Settings,
    document: Document,
    loading: Option<Loading>,
    load_options: LoadOptions,
    watch: Option<Watch>,
    open_dialog: FileDialog,
    save_dialog: FileDialog,
    environment_dialog: FileDialog,
    /// The search for the next or the previous file of the folder.
    neighbours: Neighbours,
    saving: Option<Saving>,
    pub(crate) turntable: Turntable,
    /// Field of view and projection before a file's view replaced them; the next file gets them back.
    own_projection: Option<(f64, bool)>,
    pub(crate) tracer: Tracer,
    development: Development,
    picture: Picture,
    /// The lights of the last request that needs lights.
    lights: Option<SceneLights>,
    environment_file: EnvironmentFile,
    overlay: OverlayLayer,
    /// Scene and camera of the picture that is on the screen.
    on_screen: Option<(Arc<Scene>, Camera)>,
    clicks: Clicks,
    pick: Option<Pick>,
    /// The next pick, while it is being inspected.
    picking: Option<Task<Pick>>,
    path: PickedPath,
    /// The lookup of the pick's face in the file, while it runs.
    face_lookup: Option<FaceLookup>,
    /// The flaw that is shown; all of its kind are marked.
    flaw: Option<FlawPlace>,
    /// The measurement of this scene, if it was started.
    trade: Option<Trade>,
    /// Whether any scene has been measured since the start.
    has_measured: bool,
    notice: Option<Notice>,
    pub(crate) palette: Palette,
    /// The sheet over the window.
    sheet: Option<Sheet>,
    about: AboutSheet,
    /// Whether the camera rotates around the mesh.
    pub(crate) is_rotating: bool,
    /// The picture's place in points, at the last layout. `resolution` is its size in physical pixels.
    canvas_rect: egui::Rect,
    resolution: UVec2,
    /// Whether the camera has yet to frame the mesh, which requires the picture's size from the first layout.
    is_unframed: bool,
    /// Whether the last complete picture shows only background.
    shows_nothing: bool,
    fit_to_screen: FitToScreen,
    /// The side panel's width in the last frame.
    panel_width: f32,
    /// Uncaught errors of the GPU, from any thread.
    gpu_errors: Arc<Mutex<Vec<String>>>,
    /// UI thread times per frame.
    ui_times: Times,
    screenshot: Option<Screenshot>,
}

impl App {
    /// Starts the threads. Shows the built-in scene, or loads a file and shows nothing until it is loaded.
    ///
    /// # Errors
    /// [`NoWgpu`].
    pub fn new(cc: &eframe::CreationContext<'_>, start: StartOptions) -> Result<Self, NoWgpu> {
        let render_state = cc.wgpu_render_state.clone().ok_or(NoWgpu)?;
        let settings = start.settings;
        crate::theme::apply(&cc.egui_ctx);
        cc.egui_ctx.set_theme(settings.theme);
        let document = match start.file {
            Some(_) => Document::blank(settings.kernel()),
            None => Document::embedded(settings.kernel()),
        };
        let loading = start
            .file
            .map(|file| Loading::start(file, start.load_options, &settings, &cc.egui_ctx));
        Ok(Self {
            turntable: Turntable::framing(document.loaded.scene.bounds(), UVec2::new(16, 9)),
            own_projection: None,
            document,
            loading,
            load_options: start.load_options,
            watch: None,
            open_dialog: FileDialog::new(Purpose::Open),
            save_dialog: FileDialog::new(Purpose::Save),
            environment_dialog: FileDialog::new(Purpose::Environment),
            neighbours: Neighbours::default(),
            saving: None,
            tracer: Tracer::new(default_thread_count(), &cc.egui_ctx),
            gpu_errors: catch_gpu_errors(&render_state, &cc.egui_ctx),
            development: Development::default(),
            picture: Picture::new(&render_state),
            lights: None,
            environment_file: EnvironmentFile::default(),
            overlay: OverlayLayer::new(&render_state),
            on_screen: None,
            clicks: Clicks::default(),
            pick: None,
            picking: None,
            path: PickedPath::default(),
            face_lookup: None,
            flaw: None,
            trade: None,
            has_measured: false,
            notice: None,
            palette: Palette::default(),
            sheet: None,
            about: AboutSheet::new(&render_state),
            is_rotating: false,
            canvas_rect: egui::Rect::ZERO,
            resolution: UVec2::ZERO,
            is_unframed: true,
            shows_nothing: false,
            fit_to_screen: FitToScreen::default(),
            panel_width: 0.0,
            ui_times: Times::default(),
            screenshot: start.screenshot.map(Screenshot::new),
            settings,
        })
    }

    fn error(&mut self, text: impl ToString) {
        self.notice = Some(Notice {
            text: text.to_string(),
            kind: NoticeKind::Error,
        });
    }

    /// Shows why a command can't be run.
    pub(crate) fn refuse(&mut self, obstacle: &str) {
        self.notice = Some(Notice {
            text: obstacle.to_owned(),
            kind: NoticeKind::Warning,
        });
    }

    /// Stops all background work, so that the window closes without delay.
    fn stop_work(&mut self) {
        if let Some(loading) = self.loading.take() {
            loading.cancel();
        }
        self.trade = None;
        self.document.stop_improving();
        self.tracer.stop();
    }

    fn poll_gpu_errors(&mut self) {
        // A poisoned lock still holds the messages.
        let mut errors = self
            .gpu_errors
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        let message = errors.drain(..).next();
        drop(errors);
        if let Some(message) = message {
            self.error(format!("graphics: {message}"));
        }
    }
}

impl eframe::App for App {
    /// Also called while the window is hidden, so that results are collected.
    fn logic(&mut self, ctx: &egui::Context, frame: &mut eframe::Frame) {
        if let Some(secs) = frame.info().cpu_usage {
            self.ui_times.push(Duration::from_secs_f32(secs));
        }
        if ctx.input(|input| input.viewport().close_requested()) {
            self.stop_work();
        }
        self.poll_neighbours(ctx);
        self.poll_loading(ctx);
        self.poll_saving(ctx);
        self.poll_environment(ctx);
        self.poll_watch(ctx);
        self.poll_gpu_errors();
        self.poll_picking(ctx);
        if let Err(broken) = self.document.use_kernel(self.settings.kernel(), ctx) {
            self.error(broken);
            let packed = self.document.kernel().info.name;
            self.settings.use_for_session(packed);
        }
        // Not while a slider is dragged: each step would recompute all normals.
        if !ctx.egui_is_using_pointer() {
            self.document.use_crease(self.settings.crease());
        }
        let second = self.settings.second_kernel();
        if let Err(broken) = self.document.use_second(second, ctx) {
            self.error(broken);
            self.settings.keep_view(&Settings::default().view);
        }
        if let Err(broken) = self.document.improve(ctx) {
            self.error(broken);
        }
        self.refresh_pick(ctx);
        self.tracer.set_limits(self.limits());
        if let Some(panic) = self.tracer.collect(ctx).first() {
            self.error(panic);
        }
        self.check_view();
        self.poll_path(ctx);
        self.settings.zoom = ctx.zoom_factor();
        let is_settled = self.is_settled();
        if self.screenshot.is_none() {
            self.fit_to_screen.step(ctx);
        }
        if let Some(screenshot) = &mut self.screenshot {
            screenshot.step(ctx, is_settled);
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
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
        self.hints_ui(&ctx, &commands);
        for entry in commands.into_chosen() {
            entry.run(self, &ctx, frame);
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        // A screenshot uses the defaults, which must not replace the user's settings.
        if self.screenshot.is_none() {
            storage::store(&self.settings, storage);
        }
    }

    /// No: egui's stored widget state could make it panic at the next start, and the settings hold all that should
    /// be kept.
    fn persist_egui_memory(&self) -> bool {
        false
    }
}

/// Installs handlers that collect wgpu's errors, on which wgpu would otherwise panic.
fn catch_gpu_errors(render_state: &RenderState, ctx: &egui::Context) -> Arc<Mutex<Vec<String>>> {
    let errors: Arc<Mutex<Vec<String>>> = Arc::default();
    let (shared, ctx) = (Arc::clone(&errors), ctx.clone());
    let push = move |message: String| {
        print_line(format_args!("hitscope: graphics: {message}"));
        if let Ok(mut errors) = shared.lock() {
            errors.push(message);
        }
        ctx.request_repaint();
    };
    let lost = push.clone();
    let device = &render_state.device;
    device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| push(error.to_string())));
    device.set_device_lost_callback(move |reason, message| {
        // Closing the window also loses the device, with reason `Destroyed`.
        if reason != wgpu::DeviceLostReason::Destroyed {
            lost(format!("the device was lost: {message}"));
        }
    });
    errors
}

#[cfg(test)]
mod panics;
