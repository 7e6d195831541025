//! The log: all messages since the start.

use crate::log_links::{Link, Target, links};
use egui::{Modal, RichText, ScrollArea, vec2};
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The most messages that are kept.
const MOST: usize = 1000;

/// The kind of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Something failed.
    Error,
    /// Something can't be done, or a file has a flaw.
    Warning,
    /// A result.
    Result,
}

impl Kind {
    fn title(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Result => "result",
        }
    }
}

struct Entry {
    since_start: Duration,
    kind: Kind,
    text: String,
    links: Vec<Link>,
    /// The file that was open.
    document: Option<PathBuf>,
}

/// What the user does in the log.
pub enum LogAction {
    /// Close the log.
    Close,
    /// Follow a link.
    Follow(Target),
}

/// The messages since the start.
pub struct Log {
    start: Instant,
    entries: VecDeque<Entry>,
}

impl Default for Log {
    fn default() -> Self {
        Self {
            start: Instant::now(),
            entries: VecDeque::new(),
        }
    }
}

/// The greatest width of the messages, in points: long ones wrap.
const WIDEST: f32 = 720.0;

impl Log {
    /// Adds a message. The oldest of too many is dropped.
    /// `document` is the file that is open.
    pub fn add(&mut self, kind: Kind, text: impl Into<String>, document: Option<&Path>) {
        if self.entries.len() == MOST {
            self.entries.pop_front();
        }
        let text = text.into();
        self.entries.push_back(Entry {
            since_start: self.start.elapsed(),
            kind,
            links: links(&text, Path::is_file),
            text,
            document: document.map(Path::to_owned),
        });
    }

    /// All messages as lines with their times and kinds.
    pub fn text(&self) -> String {
        let line = |entry: &Entry| {
            let (time, kind) = (time_text(entry.since_start), entry.kind.title());
            format!("{time}  {kind}: {}\n", entry.text)
        };
        self.entries.iter().map(line).collect()
    }

    /// Shows the messages over the window. `document` is the file that is open.
    pub fn log_ui(&self, ctx: &egui::Context, document: Option<&Path>) -> Option<LogAction> {
        let mut followed = None;
        let response = Modal::new(egui::Id::unique("log")).show(ctx, |ui| {
            ui.heading("Messages");
            if self.entries.is_empty() {
                ui.label("No messages yet.");
            }
            let size = ui.ctx().content_rect().size() - vec2(60.0, 120.0);
            ui.set_width(size.x.clamp(1.0, WIDEST));
            ScrollArea::vertical()
                .auto_shrink([false, true])
                .max_height(size.y)
                .show(ui, |ui| followed = self.rows_ui(ui, document));
            ui.add_space(6.0);
            ui.horizontal(|ui| {
                let copy = ui.button("Copy all");
                if copy.on_hover_text("Copies all messages as text").clicked() {
                    ui.ctx().copy_text(self.text());
                }
                ui.button("Close").clicked()
            })
            .inner
        });
        let is_closed = response.inner || response.backdrop_response.clicked();
        let followed = followed.map(LogAction::Follow);
        followed.or(is_closed.then_some(LogAction::Close))
    }

    /// Shows the messages. Returns where a clicked link leads.
    fn rows_ui(&self, ui: &mut egui::Ui, document: Option<&Path>) -> Option<Target> {
        let mut followed = None;
        for entry in &self.entries {
            let visuals = ui.visuals();
            let colour = match entry.kind {
                Kind::Error => visuals.error_fg_color,
                Kind::Warning => visuals.warn_fg_color,
                Kind::Result => visuals.text_color(),
            };
            ui.horizontal_wrapped(|ui| {
                ui.label(RichText::new(time_text(entry.since_start)).weak());
                ui.label(RichText::new(entry.kind.title()).color(colour));
                let target = entry.text_ui(ui, document);
                followed = followed.take().or(target);
            });
        }
        followed
    }
}

impl Entry {
    /// Shows the text with its links. Returns where a clicked one leads.
    fn text_ui(&self, ui: &mut egui::Ui, document: Option<&Path>) -> Option<Target> {
        let is_of_document = self.document.as_deref() == document;
        let (mut followed, mut at) = (None, 0);
        ui.spacing_mut().item_spacing.x = 0.0;
        for Link { range, target } in &self.links {
            if at < range.start {
                ui.label(&self.text[at..range.start]);
            }
            at = range.end;
            let is_there = is_of_document || matches!(target, Target::File(..));
            let link = ui.add_enabled(is_there, egui::Link::new(&self.text[range.clone()]));
            let link = link.on_disabled_hover_text("The message is about another file");
            if link.clicked() {
                followed = Some(target.clone());
            }
        }
        if at < self.text.len() {
            ui.label(&self.text[at..]);
        }
        followed
    }
}

/// A time since the start, such as `1:02:03`.
fn time_text(time: Duration) -> String {
    let secs = time.as_secs();
    let (hours, minutes, secs) = (secs / 3600, secs / 60 % 60, secs % 60);
    format!("{hours}:{minutes:02}:{secs:02}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_log_keeps_the_newest_messages_in_order() {
        let mut log = Log::default();
        (0..MOST + 2).for_each(|k| log.add(Kind::Warning, format!("message {k}"), None));
        let text = log.text();
        assert_eq!(text.lines().count(), MOST);
        assert!(text.starts_with("0:00:0") && text.contains("warning: message 2\n"));
        assert!(text.ends_with(&format!("message {}\n", MOST + 1)));
    }

    #[test]
    fn times_have_hours_minutes_and_seconds() {
        assert_eq!(time_text(Duration::from_secs(3723)), "1:02:03");
    }
}
