//! Preparing the open document for the settings: its part that is shown, its packing for kernels, its creases and its
//! tree.

use super::App;
use crate::settings::Settings;

impl App {
    /// Starts the work that the settings require of the document, unless it is done or under way. Called when the
    /// settings may have changed: after the widgets of a frame, and for a new document.
    pub(super) fn prepare(&mut self, ctx: &egui::Context) {
        self.use_offset(ctx);
        let (settings, document) = (&self.seen.settings, &mut self.open.document);
        // Not while a slider is dragged: each step would recompute all normals.
        if !ctx.egui_is_using_pointer() && document.use_crease(settings.crease()) {
            ctx.request_repaint();
        }
        if self.use_clip() | self.use_parts(ctx) {
            ctx.request_repaint();
        }
        let (settings, document) = (&self.seen.settings, &mut self.open.document);
        document.use_kernel(settings.kernel(), ctx);
        document.use_second(settings.second_kernel(), ctx);
        self.prepare_other(ctx);
    }

    /// Collects finished work on the document. If packing failed, the settings are those of what is packed again.
    pub(super) fn poll_document(&mut self, ctx: &egui::Context) {
        self.poll_parts(ctx);
        self.open.retired.poll(ctx);
        self.open.document.poll_retired(ctx);
        if let Err(broken) = self.open.document.poll_kernel() {
            self.error(broken);
            let packed = self.open.document.kernel().info.name;
            self.seen.settings.use_for_session(packed);
        }
        if let Err(broken) = self.open.document.poll_second() {
            self.error(broken);
            self.seen.settings.keep_view(&Settings::default().view);
        }
        if let Some(trade) = &mut self.open.trade {
            trade.poll();
        }
        if let Err(broken) = self.open.document.poll_tree() {
            self.error(broken);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::app::App;
    use crate::harness::{app, wait, write};
    use crate::task::sabotage;
    use std::sync::Arc;

    #[test]
    fn a_closed_document_is_freed_by_a_background_task() {
        let folder = tempfile::tempdir().expect("a folder");
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let [first, second] = ["first.obj", "second.obj"].map(|name| write(&folder, name, text));
        let Some(mut window) = app(Some(first)) else {
            return;
        };
        let is_open = |app: &App, name: &str| app.document().name() == name && app.is_settled();
        wait(&mut window, "the first file", |app| {
            is_open(app, "first.obj") && app.open.retired.is_empty()
        });
        let hold = sabotage::hold("free");
        let scene = Arc::downgrade(&window.state().document().loaded.scene);
        let ctx = window.ctx.clone();
        window.state_mut().load(second, &ctx);
        wait(&mut window, "the second file", |app| {
            is_open(app, "second.obj")
        });
        // Only the task has the first scene.
        wait(&mut window, "its users", |_| scene.strong_count() == 1);
        drop(hold);
        wait(&mut window, "the task", |_| scene.strong_count() == 0);
    }
}
