//! Copies the inspection as text. A background task writes the text, because a ray may cross a million triangles of a
//! bad mesh.

use super::App;
use crate::task::{Pending, Task};
use std::sync::Arc;

impl App {
    /// Writes the inspection as JSON in the background, to be copied then. It contains the path of the selected sample
    /// if the view follows paths.
    pub(crate) fn copy_pick(&mut self, ctx: &egui::Context) {
        let Some(pick) = &self.picked.pick else {
            return;
        };
        let (shared, path) = (Arc::clone(&pick.inspection), self.current_path().cloned());
        let write = move || {
            let mut inspection = (*shared).clone();
            inspection.path = path;
            inspection.to_json()
        };
        self.picked.copying = Pending::Running(Task::spawn("copy", ctx, write));
    }

    /// Copies the text once it is written.
    pub(super) fn poll_copying(&mut self, ctx: &egui::Context) {
        match self.picked.copying.take() {
            Ok(None) => {}
            Ok(Some(text)) => ctx.copy_text(text),
            Err(panicked) => self.error(panicked),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::harness::{Window, app, click, in_picture, wait};
    use crate::task::sabotage;
    use egui::OutputCommand;

    /// The text that the last frame copied.
    fn copied(window: &Window) -> Option<String> {
        let commands = &window.output().platform_output.commands;
        commands.iter().find_map(|command| match command {
            OutputCommand::CopyText(text) => Some(text.clone()),
            _ => None,
        })
    }

    #[test]
    fn the_inspection_is_written_in_the_background() {
        let Some(mut window) = app(None) else { return };
        let at = in_picture(&window, 0.5, 0.5);
        click(&mut window, at);
        wait(&mut window, "the pick", |app| app.inspection().is_some());
        let expected = window.state().inspection().expect("a pick").to_json();
        let hold = sabotage::hold("copy");
        let ctx = window.ctx.clone();
        window.state_mut().copy_pick(&ctx);
        window.step();
        assert_eq!(copied(&window), None);
        drop(hold);
        let text = loop {
            window.step();
            if let Some(text) = copied(&window) {
                break text;
            }
            std::thread::sleep(std::time::Duration::from_millis(5));
        };
        assert_eq!(text, expected);
    }
}
