//! The log: all messages since the start.

use egui::{Grid, Modal, RichText, ScrollArea, vec2};
use std::collections::VecDeque;
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

impl Log {
    /// Adds a message. The oldest of too many is dropped.
    pub fn add(&mut self, kind: Kind, text: impl Into<String>) {
        if self.entries.len() == MOST {
            self.entries.pop_front();
        }
        self.entries.push_back(Entry {
            since_start: self.start.elapsed(),
            kind,
            text: text.into(),
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

    /// Shows the messages over the window. Returns whether the user closes them.
    pub fn log_ui(&self, ctx: &egui::Context) -> bool {
        let response = Modal::new(egui::Id::unique("log")).show(ctx, |ui| {
            ui.heading("Messages");
            if self.entries.is_empty() {
                ui.label("No messages yet.");
            }
            let size = ui.ctx().content_rect().size() - vec2(60.0, 120.0);
            ScrollArea::both()
                .max_width(size.x)
                .max_height(size.y)
                .show(ui, |ui| self.rows_ui(ui));
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
        response.inner || response.backdrop_response.clicked()
    }

    fn rows_ui(&self, ui: &mut egui::Ui) {
        Grid::new("messages").num_columns(3).show(ui, |ui| {
            for entry in &self.entries {
                let visuals = ui.visuals();
                let colour = match entry.kind {
                    Kind::Error => visuals.error_fg_color,
                    Kind::Warning => visuals.warn_fg_color,
                    Kind::Result => visuals.text_color(),
                };
                ui.label(RichText::new(time_text(entry.since_start)).weak());
                ui.label(RichText::new(entry.kind.title()).color(colour));
                ui.label(&entry.text);
                ui.end_row();
            }
        });
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
        (0..MOST + 2).for_each(|k| log.add(Kind::Warning, format!("message {k}")));
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
