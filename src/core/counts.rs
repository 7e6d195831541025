//! Counts with their nouns, as messages show them.

/// A number with its digits in groups of three, separated by narrow spaces: `1 234 567`.
pub fn grouped(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// A number and its noun, whose plural ends in “s”: `1 triangle`, `2 triangles`.
pub fn counted(number: usize, noun: &str) -> String {
    counted_as(number, noun, &format!("{noun}s"))
}

/// A number and its noun in the singular or the plural: `1 vertex`, `2 vertices`.
pub fn counted_as(number: usize, singular: &str, plural: &str) -> String {
    let noun = if number == 1 { singular } else { plural };
    format!("{} {noun}", grouped(number))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_grouped_by_three() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(69451), "69\u{202f}451");
        assert_eq!(grouped(1_111_216), "1\u{202f}111\u{202f}216");
    }

    #[test]
    fn one_is_singular_and_all_other_numbers_are_plural() {
        assert_eq!(counted(0, "face"), "0 faces");
        assert_eq!(counted(1, "face"), "1 face");
        assert_eq!(counted_as(1, "vertex", "vertices"), "1 vertex");
        assert_eq!(
            counted_as(1200, "vertex", "vertices"),
            "1\u{202f}200 vertices"
        );
    }
}
