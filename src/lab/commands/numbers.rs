//! Lists of numbers as arguments.

/// So many finite numbers, separated by commas. `expected` is the message for another text.
///
/// # Errors
/// A message for the user.
pub(super) fn numbers<const N: usize>(text: &str, expected: &str) -> Result<[f64; N], String> {
    let words = text.split(',').map(|word| word.trim().parse());
    let all: Result<Vec<f64>, _> = words.collect();
    let all = all.map_err(|_| expected.to_owned())?;
    let all: [f64; N] = all.try_into().map_err(|_| expected.to_owned())?;
    if all.iter().all(|x| x.is_finite()) {
        Ok(all)
    } else {
        Err("the numbers must be finite".to_owned())
    }
}
