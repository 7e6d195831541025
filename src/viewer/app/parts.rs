//! The parts of the app's state, each with one owner.
//!
//! | part | contents |
//! |---|---|
//! | [`Open`] | what is open: the document, and work on files |
//! | [`Seen`] | how it is seen: the camera and the settings of the picture |
//! | [`Picked`] | what is picked: the pixel, its face and path, and the marked flaw |
//! | [`Shown`] | what the window shows over and beside the picture |
//! | [`Traced`] | what traces and draws the picture |
//! | [`Compared`](super::comparing::Compared) | side B of a comparison; the choices are in [`Seen`] |

use super::Sheet;
use super::dialogs::Dialogs;
use super::environment::EnvironmentFiles;
use super::files::Neighbours;
use super::framing::PartBounds;
use super::inspecting::Inspecting;
use super::legend::RangeFit;
use super::magnifier::Magnifier;
use super::path::PickedPath;
use super::pick::{Pick, Picking};
use super::pointer::Clicks;
use super::scene_lights::SceneLights;
use crate::about_sheet::AboutSheet;
use crate::command::palette::Palette;
use crate::comparison::{Comparison, Side};
use crate::document::Document;
use crate::face_lookup::FaceInFile;
use crate::first_picture::FirstPicture;
use crate::flaw_place::FlawPlace;
use crate::gpu::picture::Picture;
use crate::look::Development;
use crate::opening::Loading;
use crate::overlay::OverlayLayer;
use crate::parts::Parts;
use crate::retired::Retired;
use crate::saving::Saving;
use crate::session::Session;
use crate::settings::Settings;
use crate::task::{Pending, Task};
use crate::times::Times;
use crate::tracer::Tracer;
use crate::trade::Trade;
use crate::watch::Watch;
use crate::window::FitToScreen;
use eframe::egui_wgpu::RenderState;
use glam::UVec2;
use hitscope_core::camera::{Turntable, UpAxis};
use hitscope_core::film::ShownPixels;
use hitscope_core::obj::LoadOptions;
use hitscope_core::{Camera, Scene};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// The open document, and work on files.
pub(crate) struct Open {
    pub document: Document,
    /// Closed documents, which a background task frees.
    pub retired: Retired,
    pub loading: Option<Loading>,
    pub load_options: LoadOptions,
    pub watch: Option<Watch>,
    pub dialogs: Dialogs,
    /// The session file that is being read.
    pub session: Option<Task<Result<Session, String>>>,
    /// The session file that was read last.
    pub session_path: PathBuf,
    /// The session whose file is being loaded.
    pub loading_session: Option<Session>,
    /// The search for the next or the previous file of the folder.
    pub neighbours: Neighbours,
    pub saving: Option<Saving>,
    /// The measurement of this scene, if it was started.
    pub trade: Option<Trade>,
    /// Whether any scene has been measured since the start.
    pub has_measured: bool,
}

impl Open {
    pub fn new(document: Document, load_options: LoadOptions) -> Self {
        Self {
            document,
            retired: Retired::default(),
            loading: None,
            load_options,
            watch: None,
            dialogs: Dialogs::default(),
            session: None,
            session_path: PathBuf::new(),
            loading_session: None,
            neighbours: Neighbours::default(),
            saving: None,
            trade: None,
            has_measured: false,
        }
    }
}

/// How the document is seen.
pub(crate) struct Seen {
    pub settings: Settings,
    /// The parts of the scene, which can be hidden.
    pub parts: Parts,
    /// The choices about the comparison.
    pub comparison: Comparison,
    /// The camera.
    pub turntable: Turntable,
    /// Field of view and projection before a file's view replaced them; the next file gets them back.
    pub own_projection: Option<(f64, bool)>,
    /// Whether the camera has yet to frame the mesh, which requires the picture's size from the first layout.
    pub is_unframed: bool,
    /// Whether the camera rotates around the mesh.
    pub is_rotating: bool,
}

impl Seen {
    pub fn new(settings: Settings, scene: &Scene) -> Self {
        let mut turntable = Turntable::framing(scene.bounds(), UVec2::new(16, 9));
        turntable.up_axis = settings.up_axis();
        Self {
            settings,
            parts: Parts::default(),
            comparison: Comparison::default(),
            turntable,
            own_projection: None,
            is_unframed: true,
            is_rotating: false,
        }
    }

    /// Turns an axis of the file up and keeps it between runs.
    pub fn turn_up(&mut self, axis: UpAxis) {
        self.settings.keep_up_axis(axis);
        self.turntable.up_axis = axis;
    }
}

/// What is picked.
#[derive(Default)]
pub(crate) struct Picked {
    pub clicks: Clicks,
    /// The side of a comparison whose ray is inspected.
    pub side: Side,
    pub pick: Option<Pick>,
    /// The next pick, while it is being inspected.
    pub picking: Option<Picking>,
    /// The task that writes the text of the pick to be copied.
    pub copying: Pending<String>,
    pub inspecting: Inspecting,
    pub path: PickedPath,
    /// The lookup of the pick's face in the file, while it runs.
    pub face_lookup: Option<Task<FaceInFile>>,
    /// The flaw that is shown; all of its kind are marked.
    pub flaw: Option<FlawPlace>,
    /// The search for the flaw that will be shown.
    pub flaw_search: Pending<Option<FlawPlace>>,
    /// The search for the bounds of the part that will be framed.
    pub part_bounds: Option<PartBounds>,
}

impl Picked {
    /// Clears the inspected pick, and drops a click that may become one.
    pub fn clear_pick(&mut self) {
        (self.pick, self.picking, self.face_lookup) = (None, None, None);
        self.inspecting.picks.selected = None;
        self.clicks.pending = None;
    }

    /// Clears the mark of a flaw, and drops the search for one.
    pub fn forget_flaw(&mut self) {
        (self.flaw, self.flaw_search) = (None, Pending::Unasked);
    }
}

/// What the window shows over and beside the picture.
pub(crate) struct Shown {
    pub palette: Palette,
    /// The sheet over the window.
    pub sheet: Option<Sheet>,
    pub about: AboutSheet,
    /// The picture's place in points, at the last layout. `resolution` is its size in physical pixels.
    pub canvas_rect: egui::Rect,
    pub resolution: UVec2,
    /// Whether the last complete picture shows only background.
    pub shows_nothing: bool,
    pub fit_to_screen: FitToScreen,
    pub magnifier: Magnifier,
    /// The side panel's width in the last frame.
    pub panel_width: f32,
    /// Width of the window when the panel's width was reset, in points.
    pub panel_room: f32,
    /// Width of the panel since it last changed; `None` after a reset.
    pub settled_panel_width: Option<f32>,
    /// UI thread times per frame.
    pub ui_times: Times,
    pub first_picture: FirstPicture,
}

impl Shown {
    /// The state before the first frame of a program that began at this time.
    pub fn new(render_state: &RenderState, began: Instant) -> Self {
        Self {
            palette: Palette::default(),
            sheet: None,
            about: AboutSheet::new(render_state),
            canvas_rect: egui::Rect::ZERO,
            resolution: UVec2::ZERO,
            shows_nothing: false,
            fit_to_screen: FitToScreen::default(),
            magnifier: Magnifier::default(),
            panel_width: 0.0,
            panel_room: 0.0,
            settled_panel_width: None,
            ui_times: Times::default(),
            first_picture: FirstPicture::new(began),
        }
    }
}

/// What traces and draws the picture.
pub(crate) struct Traced {
    pub tracer: Tracer,
    pub development: Development,
    pub picture: Picture,
    /// The lights of the last request that needs lights.
    pub lights: SceneLights,
    pub environment_files: EnvironmentFiles,
    pub overlay: OverlayLayer,
    /// The search for the range of the numbers in the picture.
    pub range_fit: RangeFit,
    /// Scene and camera of the picture that is on the screen.
    pub on_screen: Option<(Arc<Scene>, Camera)>,
    /// What each pixel of that picture shows.
    pub shown: ShownPixels,
}

impl Traced {
    pub fn new(tracer: Tracer, render_state: &RenderState) -> Self {
        let adapter = render_state.adapter.get_info().device_type;
        Self {
            tracer,
            development: Development::default(),
            picture: Picture::new(render_state),
            lights: SceneLights::default(),
            environment_files: EnvironmentFiles::default(),
            overlay: OverlayLayer::new(render_state, adapter),
            range_fit: RangeFit::default(),
            on_screen: None,
            shown: ShownPixels::default(),
        }
    }
}
