//! Searching of commands by a part of their titles.

/// How well a text matches a query; less is better, and `None` is no match.
///
/// The best matches are titles, such as `Wireframe` in `View: Wireframe`, that begin with the query. Texts that contain
/// all words of the query come next, above all at the beginnings of words. Texts that contain only its letters in their
/// order come last. Case is ignored.
pub fn rank(query: &str, text: &str) -> Option<u32> {
    /// Any match by letters is worse than all matches by words.
    const BY_LETTERS: u32 = 1 << 20;
    let (query, text) = (query.to_lowercase(), text.to_lowercase());
    let title = text.split_once(": ").map_or(&*text, |(_, title)| title);
    if !query.trim().is_empty() && title.starts_with(query.trim()) {
        return Some(0);
    }
    let by_words = by_words(&query, &text).map(|rank| 1 + rank);
    by_words.or_else(|| Some(BY_LETTERS + by_letters(&query, &text)?))
}

/// The sum of the words' ranks if the text contains all of them.
fn by_words(query: &str, text: &str) -> Option<u32> {
    /// A word inside another word is worse than any place at the beginning of a word.
    const INSIDE: u32 = 1 << 10;
    let rank = |word: &str| {
        let is_start = |at: usize| !text[..at].ends_with(char::is_alphanumeric);
        let places = || text.match_indices(word).map(|(at, _)| at);
        let at_start = places().find(|&at| is_start(at));
        let place = |at: usize| (at as u32).min(INSIDE - 1);
        at_start
            .map(place)
            .or_else(|| Some(INSIDE + place(places().next()?)))
    };
    query.split_whitespace().map(rank).sum()
}

/// The number of letters that the first match by letters skips.
fn by_letters(query: &str, text: &str) -> Option<u32> {
    let mut rest = text.chars();
    let mut skipped = 0;
    for wanted in query.chars().filter(|c| !c.is_whitespace()) {
        let position = rest.position(|c| c == wanted)?;
        skipped += position as u32;
    }
    Some(skipped)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The texts that match, best first.
    fn found<'t>(query: &str, texts: &[&'t str]) -> Vec<&'t str> {
        let mut found: Vec<(u32, &str)> = texts
            .iter()
            .filter_map(|text| Some((rank(query, text)?, *text)))
            .collect();
        found.sort_by_key(|(rank, _)| *rank);
        found.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn a_query_finds_parts_of_words_in_any_case_and_order() {
        let texts = ["View: Wireframe", "View: Normals", "Camera: Frame"];
        assert_eq!(found("WIRE", &texts), ["View: Wireframe"]);
        assert_eq!(found("normal view", &texts), ["View: Normals"]);
        assert_eq!(found("", &texts), texts);
        assert_eq!(found("xyz", &texts), [""; 0]);
    }

    #[test]
    fn a_title_that_begins_with_the_query_is_best() {
        let texts = [
            "Compare with: Another file",
            "Compare: Compare with a file…",
            "File: Compare",
        ];
        let expected = [
            "Compare: Compare with a file…",
            "Compare with: Another file",
        ];
        assert_eq!(found("compare with a file", &texts), expected);
    }

    #[test]
    fn the_beginning_of_a_word_is_better_than_its_middle_and_that_is_better_than_single_letters() {
        let texts = ["File: Reload, a mesh", "View: Wireframe", "Camera: Frame"];
        let expected = ["Camera: Frame", "View: Wireframe", "File: Reload, a mesh"];
        assert_eq!(found("frame", &texts), expected);
    }
}
