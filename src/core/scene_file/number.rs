//! Numbers in attributes.

use super::problem::quoted;
use glam::DVec3;

/// A finite number in decimal notation.
///
/// # Errors
/// The text isn't a number, isn't finite, or is too large for f64.
pub(super) fn float(text: &str) -> Result<f64, String> {
    let number: f64 = text.trim().parse().map_err(|_| not("a number", text))?;
    if number.is_finite() {
        Ok(number)
    } else if text.contains(|c: char| c.is_ascii_digit()) {
        let text = quoted(text);
        Err(format!("{text} is too large: numbers end at 1.8e308"))
    } else {
        Err(format!("{} isn't a finite number", quoted(text)))
    }
}

/// # Errors
/// The text isn't an integer of 64 bits.
pub(super) fn integer(text: &str) -> Result<i64, String> {
    text.trim().parse().map_err(|_| not("an integer", text))
}

/// `true` or `false`, in any case.
///
/// # Errors
/// The text is another word.
pub(super) fn boolean(text: &str) -> Result<bool, String> {
    if text.eq_ignore_ascii_case("true") {
        Ok(true)
    } else if text.eq_ignore_ascii_case("false") {
        Ok(false)
    } else {
        Err(not("“true” or “false”", text))
    }
}

/// The finite numbers in a list, separated by spaces or commas. Returns one more than `max_count` at most.
///
/// # Errors
/// A part isn't a finite number.
pub(super) fn floats(text: &str, max_count: usize) -> Result<Vec<f64>, String> {
    let parts = text.split(|c: char| c == ',' || c.is_whitespace());
    let parts = parts.filter(|part| !part.is_empty());
    parts.take(max_count + 1).map(float).collect()
}

/// Three numbers, or one number for all three.
///
/// # Errors
/// There are more or fewer numbers, or one isn't finite.
pub(super) fn three(text: &str) -> Result<DVec3, String> {
    match *floats(text, 3)? {
        [all] => Ok(DVec3::splat(all)),
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        _ => Err(not("one number or three", text)),
    }
}

fn not(expected: &str, text: &str) -> String {
    format!("{} isn't {expected}", quoted(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_decimal_and_finite() {
        for (text, expected) in [
            ("1", 1.0),
            (" +1.5e-3 ", 1.5e-3),
            ("-.5", -0.5),
            ("1.", 1.0),
        ] {
            assert_eq!(float(text), Ok(expected));
        }
        assert_eq!(float("0.1").map(f64::to_bits), Ok(0.1f64.to_bits()));
        for text in ["", "0x10", "1,5", "1e", "one", "1 2", "1f"] {
            assert_eq!(float(text), Err(format!("“{text}” isn't a number")));
        }
        for text in ["nan", "inf", "-Infinity"] {
            assert_eq!(float(text), Err(format!("“{text}” isn't a finite number")));
        }
        let too_large = "“-1e400” is too large: numbers end at 1.8e308";
        assert_eq!(float("-1e400"), Err(too_large.to_owned()));
        assert_eq!(integer(" -7"), Ok(-7));
        let large = "99999999999999999999";
        for text in ["1.5", "", large] {
            assert_eq!(integer(text), Err(format!("“{text}” isn't an integer")));
        }
        assert_eq!((boolean("True"), boolean("false")), (Ok(true), Ok(false)));
        assert_eq!(boolean("1"), Err("“1” isn't “true” or “false”".to_owned()));
    }

    #[test]
    fn lists_are_separated_by_commas_or_spaces() {
        assert_eq!(three("1,2 ,\t3"), Ok(DVec3::new(1.0, 2.0, 3.0)));
        assert_eq!(three("2"), Ok(DVec3::splat(2.0)));
        for text in ["", "1 2", "1 2 3 4"] {
            assert_eq!(
                three(text),
                Err(format!("“{text}” isn't one number or three"))
            );
        }
        assert_eq!(three("1;2;3"), Err("“1;2;3” isn't a number".to_owned()));
    }
}
