//! Messages: a notice that stays until it is closed, toasts about results, and the log of all of them.

use super::App;
use crate::log::{Kind, Log};
use crate::toasts::Toasts;

/// A message that stays until the user closes it.
pub(super) struct Notice {
    pub text: String,
    pub kind: NoticeKind,
}

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

    /// Shows why a command can't be run.
    pub(crate) fn refuse(&mut self, obstacle: &str) {
        self.warn(obstacle);
    }

    /// Shows a warning.
    pub(super) fn warn(&mut self, text: &str) {
        self.notify(NoticeKind::Warning, text.to_owned());
    }

    /// Shows a result for some seconds.
    pub(crate) fn tell(&mut self, text: impl Into<String>) {
        let text = text.into();
        self.feedback.log.add(Kind::Result, text.as_str());
        self.feedback.toasts.add(text);
    }

    fn notify(&mut self, kind: NoticeKind, text: String) {
        let logged = match kind {
            NoticeKind::Error => Kind::Error,
            NoticeKind::Warning => Kind::Warning,
        };
        self.feedback.log.add(logged, text.as_str());
        self.feedback.notice = Some(Notice { text, kind });
    }
}
