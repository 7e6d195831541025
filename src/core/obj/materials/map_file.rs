//! Parser of statements that name a picture, such as `map_Kd`.

use super::mtl::number;
use glam::Vec2;

/// The file name of a statement, and the picture's placement on the surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MapFile {
    pub name: String,
    pub scale: Vec2,
    pub offset: Vec2,
    /// What multiplies the values of a bump map (`-bm`).
    pub multiplier: f32,
    /// Whether the multiplier is given.
    pub has_multiplier: bool,
}

/// Parses `-option value… name with spaces`. Also returns the options that shading doesn't use, each once.
pub(super) fn parse(rest: &str) -> Option<(MapFile, Vec<&str>)> {
    let mut map = MapFile {
        name: String::new(),
        scale: Vec2::ONE,
        offset: Vec2::ZERO,
        multiplier: 1.0,
        has_multiplier: false,
    };
    let mut skipped = Vec::new();
    let mut rest = rest.trim();
    while rest.starts_with('-') {
        let (option, mut after) = word(rest);
        // The minimum and maximum number of values.
        let (min_values, max_values) = match option {
            "-s" | "-o" | "-t" => (1, 3),
            "-mm" => (2, 2),
            "-blendu" | "-blendv" | "-cc" | "-clamp" | "-boost" | "-bm" | "-texres"
            | "-imfchan" | "-type" => (1, 1),
            // Not an option: the file name starts with a dash.
            _ => break,
        };
        let mut values = Vec::new();
        for k in 0..max_values {
            let (value, next) = word(after);
            let is_number = number(value).is_some();
            if k >= min_values && !is_number {
                break;
            }
            values.push(number(value).unwrap_or(0.0));
            after = next;
        }
        let pair = Vec2::new(values[0], values.get(1).copied().unwrap_or(values[0]));
        match option {
            "-s" => map.scale = pair,
            "-o" => map.offset = Vec2::new(values[0], values.get(1).copied().unwrap_or(0.0)),
            "-bm" => (map.multiplier, map.has_multiplier) = (values[0], true),
            _ if skipped.contains(&option) => {}
            _ => skipped.push(option),
        }
        rest = after;
    }
    map.name = rest.trim_matches('"').replace('\\', "/");
    (!map.name.is_empty()).then_some((map, skipped))
}

/// Splits off the first word.
fn word(text: &str) -> (&str, &str) {
    let text = text.trim_start();
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (word, rest.trim_start())
}
