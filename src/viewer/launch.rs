//! Opening the window, and reopening it if the graphics device is lost.
//!
//! eframe 0.37 creates the device with the window and keeps it in a private field of `egui_wgpu`'s painter, so that a
//! running window can't change its device. The app therefore outlives its window: if the device is lost, the window
//! closes, and the app goes on in a new one at the same place.

use crate::app::{App, StartOptions};
use crate::display::DisplayServer;
use crate::gpu::adapter::{BackendOrder, device_descriptor};
use crate::storage::APP_ID;
use crate::window;
use eframe::egui_wgpu::{SurfaceErrorAction, WgpuConfiguration, WgpuSetup, WgpuSetupCreateNew};
use hitscope_lab::commands::print_line;
use std::cell::RefCell;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};
use wgpu::CurrentSurfaceTexture;

/// An app that outlives its windows; `None` while no window is open.
type Survivor = Rc<RefCell<Option<App>>>;

/// The error if the device is lost again and again.
#[derive(Debug, thiserror::Error)]
#[error("the graphics device was lost {LOSSES} times in a row: {0}")]
struct LostTooOften(String);

/// Losses in a row after which no new window is opened.
const LOSSES: usize = 3;
/// A window that stays open for this long resets the count of losses.
const STABLE: Duration = Duration::from_secs(30);

/// Opens the window on the first usable display server and graphics backend, and runs it until it closes. If its
/// graphics device is lost, the app continues in a new window.
///
/// # Errors
/// eframe's, if no window can be opened or the device is lost several times in a row.
pub fn run_window(start: &StartOptions) -> Result<(), eframe::Error> {
    let display = DisplayServer::from_env();
    if let DisplayServer::X11 { warning } = &display {
        print_line(format_args!("hitscope: {warning}; using DISPLAY"));
    }
    let is_graphics = |error: &eframe::Error| matches!(error, eframe::Error::Wgpu(_));
    let survivor = Survivor::default();
    let mut losses = 0;
    loop {
        let opened = Instant::now();
        let run = |backends| run_once(start, &display, backends, &survivor);
        BackendOrder::from_env().first_that_opens(is_graphics, run)?;
        let Some(loss) = loss(&survivor) else {
            return Ok(());
        };
        print_line(format_args!(
            "hitscope: the graphics device was lost: {loss}"
        ));
        losses = if opened.elapsed() > STABLE {
            1
        } else {
            losses + 1
        };
        if losses == LOSSES {
            return Err(eframe::Error::AppCreation(Box::new(LostTooOften(loss))));
        }
    }
}

/// Why the app's device was lost; `None` if the window was closed for another reason.
fn loss(survivor: &Survivor) -> Option<String> {
    let app = survivor.borrow();
    app.as_ref()?.graphics_loss().map(str::to_owned)
}

/// Opens a window with one of these backends for the survivor, or for a new app, and runs it until it closes.
fn run_once(
    start: &StartOptions,
    display: &DisplayServer,
    backends: wgpu::Backends,
    survivor: &Survivor,
) -> Result<(), eframe::Error> {
    let is_screenshot = start.screenshot.is_some();
    let options = eframe::NativeOptions {
        viewport: window::viewport(),
        window_builder: Some(Box::new(window::checked)),
        wgpu_options: WgpuConfiguration {
            wgpu_setup: WgpuSetup::CreateNew(wgpu_setup(backends)),
            on_surface_status: Arc::new(after_failed_frame),
            ..WgpuConfiguration::default()
        },
        event_loop_builder: display.event_loop_builder(),
        // The picture's bytes must reach the screen unchanged.
        dithering: false,
        persist_window: !is_screenshot,
        // An empty path, so that a screenshot doesn't depend on stored state.
        persistence_path: is_screenshot.then(PathBuf::new),
        ..eframe::NativeOptions::default()
    };
    let zoom = start.preferences.zoom;
    let create: eframe::AppCreator<'_> = Box::new(|cc| {
        let app = match survivor.take() {
            Some(app) => app.reopened(cc)?,
            None => App::new(cc, start.clone())?,
        };
        survivor.replace(Some(app));
        Ok(Box::new(InWindow(Rc::clone(survivor))))
    });
    let run = || eframe::run_native_ext(APP_ID, options, Some(egui_context(zoom)), create);
    let is_expected = || loss(survivor).is_some();
    window::run_until_destroyed(run, is_expected).unwrap_or(Ok(()))
}

/// The action if the window has no texture to draw on. All actions except skipping draw the frame again.
fn after_failed_frame(status: &CurrentSurfaceTexture) -> SurfaceErrorAction {
    match status {
        CurrentSurfaceTexture::Lost => SurfaceErrorAction::RecreateSurface,
        CurrentSurfaceTexture::Outdated | CurrentSurfaceTexture::Timeout => {
            SurfaceErrorAction::Reconfigure
        }
        _ => SurfaceErrorAction::SkipFrame,
    }
}

/// The window's handle of the app.
struct InWindow(Survivor);

impl InWindow {
    fn with<T: Default>(&self, act: impl FnOnce(&mut App) -> T) -> T {
        self.0.borrow_mut().as_mut().map(act).unwrap_or_default()
    }
}

impl eframe::App for InWindow {
    fn logic(&mut self, ctx: &egui::Context, frame: &mut eframe::Frame) {
        self.with(|app| app.logic(ctx, frame));
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.with(|app| app.ui(ui, frame));
    }

    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        self.with(|app| app.clear_color(visuals))
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        self.with(|app| app.save(storage));
    }

    fn persist_egui_memory(&self) -> bool {
        self.with(|app| app.persist_egui_memory())
    }

    /// The app ends with its window unless the device is lost.
    fn on_exit(&mut self) {
        if loss(&self.0).is_none() {
            self.0.take();
        }
    }
}

/// The context as eframe creates it, but without egui's stored widget state: a bad number in it, such as a zoom
/// of 0, would make the program panic at each start.
fn egui_context(zoom: f32) -> egui::Context {
    let ctx = egui::Context::default();
    ctx.set_embed_viewports(false);
    ctx.options_mut(|options| {
        options.max_passes = NonZeroUsize::MIN.saturating_add(1);
        options.zoom_factor = zoom;
    });
    ctx
}

/// eframe's setup with these backends and the limits that a large mesh needs.
fn wgpu_setup(backends: wgpu::Backends) -> WgpuSetupCreateNew {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.instance_descriptor.backends = backends;
    setup.device_descriptor = Arc::new(device_descriptor);
    setup
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lost_surface_is_created_again_and_a_late_one_is_drawn_again() {
        use SurfaceErrorAction::{Reconfigure, RecreateSurface, SkipFrame};
        let after = |status| after_failed_frame(&status);
        assert!(matches!(
            after(CurrentSurfaceTexture::Lost),
            RecreateSurface
        ));
        assert!(matches!(
            after(CurrentSurfaceTexture::Outdated),
            Reconfigure
        ));
        assert!(matches!(after(CurrentSurfaceTexture::Timeout), Reconfigure));
        assert!(matches!(after(CurrentSurfaceTexture::Occluded), SkipFrame));
    }
}
