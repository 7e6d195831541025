//! Fields for a line of text. Their length is limited, because egui lays out the whole text in each frame.

use egui::TextEdit;
use egui::text::CCursorRange;

/// The maximum length in characters: Linux's `PATH_MAX`, the limit on paths that it opens.
const MOST: usize = 4096;

/// A field for a line of text.
#[expect(clippy::disallowed_methods, reason = "the only use")]
pub fn text_field(text: &mut String) -> TextEdit<'_> {
    TextEdit::singleline(text).char_limit(MOST)
}

/// Selects the text of a field, so that typing replaces it.
pub fn select_all(ctx: &egui::Context, field: egui::Id, text: &str) {
    let mut state = TextEdit::load_state(ctx, field).unwrap_or_default();
    let all = CCursorRange::select_all_str(text);
    state.cursor.set_char_range(Some(all));
    state.store(ctx, field);
}
