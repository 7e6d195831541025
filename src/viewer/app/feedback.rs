//! Messages: a notice that stays until it is closed, toasts about results, and the log of all of them.

use super::App;
use crate::log::{Kind, Log};
use crate::log_links::Target;
use crate::session::is_session;
use crate::tab::Tab;
use crate::toasts::Toasts;
use egui::OpenUrl;
use hitscope_core::loading::is_scene_file;
use hitscope_lab::element::Element;
use std::path::Path;

/// A message that stays until the user closes it, or until its cause is gone.
pub(super) struct Notice {
    pub text: String,
    pub kind: NoticeKind,
    /// The obstacle that the message is about.
    cause: Option<Obstacle>,
}

/// Returns why something can't be done; `None` if it can.
type Obstacle = fn(&App) -> Option<&'static str>;

/// The maximum length of an error or a warning in characters, so that the picture stays visible.
const LONGEST: usize = 800;

/// The kind of a notice.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum NoticeKind {
    Error,
    Warning,
}

/// What the window tells the user.
#[derive(Default)]
pub(super) struct Feedback {
    pub notice: Option<Notice>,
    pub toasts: Toasts,
    pub log: Log,
}

impl App {
    /// Shows an error.
    pub(super) fn error(&mut self, text: impl ToString) {
        self.notify(NoticeKind::Error, text.to_string());
    }

    /// Shows why a command can't be run, until it can.
    pub(crate) fn refuse_command(&mut self, obstacle: Obstacle) {
        if let Some(reason) = obstacle(self) {
            self.warn(reason);
            if let Some(notice) = &mut self.feedback.notice {
                notice.cause = Some(obstacle);
            }
        }
    }

    /// Shows for some seconds why something can't be done.
    pub(super) fn refuse(&mut self, reason: &str) {
        self.note(Kind::Warning, reason);
        self.feedback.toasts.add(reason);
    }

    /// Closes the notice if its cause is gone.
    pub(super) fn check_notice(&mut self) {
        let notice = self.feedback.notice.as_ref();
        let cause = notice.and_then(|notice| notice.cause);
        if cause.is_some_and(|obstacle| obstacle(self).is_none()) {
            self.feedback.notice = None;
        }
    }

    /// Shows a warning.
    pub(super) fn warn(&mut self, text: &str) {
        self.notify(NoticeKind::Warning, text.to_owned());
    }

    /// Shows a result for some seconds.
    pub(crate) fn tell(&mut self, text: impl Into<String>) {
        let text = text.into();
        self.note(Kind::Result, text.as_str());
        self.feedback.toasts.add(text);
    }

    /// Adds a message to the log without showing it.
    pub(super) fn note(&mut self, kind: Kind, text: &str) {
        let document = self.open.document.path.as_deref();
        self.feedback.log.add(kind, text, document);
    }

    /// Follows a link of the log to an element, a part or a file. The system opens files that the viewer can't.
    pub(super) fn follow(&mut self, target: Target, ctx: &egui::Context) {
        match target {
            Target::Element(element) => self.go_to(element, ctx),
            Target::Part(name) => {
                self.seen.parts.filter = name;
                self.preferences.shows_panel = true;
                self.preferences.tab = Tab::Parts;
            }
            Target::File(path, line) => {
                let is_open = self.open.document.path.as_ref() == Some(&path);
                match line {
                    Some(line) if is_open => self.go_to(Element::Line(line), ctx),
                    _ if is_openable(&path) => self.load(path, ctx),
                    _ => ctx.open_url(OpenUrl::new_tab(file_url(&path))),
                }
            }
        }
    }

    fn notify(&mut self, kind: NoticeKind, text: String) {
        let text = match text.char_indices().nth(LONGEST) {
            Some((end, _)) => format!("{}…", &text[..end]),
            None => text,
        };
        let logged = match kind {
            NoticeKind::Error => Kind::Error,
            NoticeKind::Warning => Kind::Warning,
        };
        self.note(logged, text.as_str());
        self.feedback.notice = Some(Notice {
            text,
            kind,
            cause: None,
        });
    }
}

/// Whether the viewer opens files with this name.
fn is_openable(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default();
    let is_mesh = ["obj", "gz"]
        .iter()
        .any(|known| extension.eq_ignore_ascii_case(known));
    is_mesh || is_scene_file(path) || is_session(path)
}

/// The `file:` URL of a file.
fn file_url(path: &Path) -> String {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let path = path.to_string_lossy().replace('\\', "/");
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/-._~:".contains(&byte);
    let encoded = path.bytes().map(|byte| match is_plain(byte) {
        true => char::from(byte).to_string(),
        false => format!("%{byte:02X}"),
    });
    let root = if path.starts_with('/') { "" } else { "/" };
    format!("file://{root}{}", encoded.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn urls_of_files_have_no_spaces() {
        let url = file_url(Path::new("/a b/ü.png"));
        assert_eq!(url, "file:///a%20b/%C3%BC.png");
    }
}
