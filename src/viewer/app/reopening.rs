//! Continuing in a new window with a new graphics device after the old device was lost.

use super::comparing::Compared;
use super::{App, NoWgpu};
use crate::about_sheet::AboutSheet;
use crate::gpu::faults::Faults;
use crate::gpu::picture::Picture;
use crate::look::Development;
use crate::overlay::OverlayLayer;
use egui::ViewportCommand;

impl App {
    /// Why the graphics device was lost; `None` if it works.
    pub fn graphics_loss(&self) -> Option<&str> {
        self.faults.loss()
    }

    /// Whether the device is lost. The window then closes and draws nothing more: egui-wgpu 0.37 panics if it draws on a
    /// lost device.
    pub(super) fn leaves_window(&self, ctx: &egui::Context) -> bool {
        let is_lost = self.faults.loss().is_some();
        if is_lost {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
        is_lost
    }

    /// The app in a new window. Only GPU resources are created again.
    ///
    /// # Errors
    /// [`NoWgpu`].
    pub fn reopened(mut self, cc: &eframe::CreationContext<'_>) -> Result<Self, NoWgpu> {
        let render_state = cc.wgpu_render_state.clone().ok_or(NoWgpu)?;
        let loss = self.faults.loss().unwrap_or("no reason given").to_owned();
        let ctx = &cc.egui_ctx;
        crate::theme::apply(ctx);
        ctx.set_theme(self.preferences.theme);
        ctx.set_zoom_factor(self.preferences.zoom);
        // Threads that were started for the old window wake the new one.
        let new = ctx.clone();
        self.ctx
            .set_repaint_observer(Box::new(move |info: egui::RequestRepaintInfo| {
                new.request_repaint_after(info.delay);
            }));
        self.ctx = ctx.clone();
        self.faults = Faults::watch(&render_state.device, ctx);
        self.shown.about = AboutSheet::new(&render_state);
        self.traced.picture = Picture::new(&render_state);
        let adapter = render_state.adapter.get_info().device_type;
        // Side B is created again, but an earlier version of the file is lost.
        self.compared = Compared::new(&render_state);
        self.traced.overlay = OverlayLayer::new(&render_state, adapter);
        // The whole picture is uploaded again.
        self.traced.development = Development::default();
        self.traced.tracer.show_again();
        self.forget_times();
        self.show_title(ctx);
        self.warn(&format!(
            "The graphics device was lost, so the window was reopened: {loss}"
        ));
        Ok(self)
    }

    /// Ends what depends on the old window's clock.
    fn forget_times(&mut self) {
        self.navigation.end_transition(&mut self.seen.turntable);
        self.picked.clicks = super::pointer::Clicks::default();
        self.feedback.toasts.show_again();
    }
}
