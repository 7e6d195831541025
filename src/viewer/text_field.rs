//! Fields for a line of text. Their length is limited, because egui lays out the whole text in each frame.

use egui::TextEdit;

/// The maximum length in characters: Linux's `PATH_MAX`, the limit on paths that it opens.
const MOST: usize = 4096;

/// A field for a line of text.
#[expect(clippy::disallowed_methods, reason = "the only use")]
pub fn text_field(text: &mut String) -> TextEdit<'_> {
    TextEdit::singleline(text).char_limit(MOST)
}
