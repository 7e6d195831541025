//! Conversion of panics into errors, for dependencies that panic on user data.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Returns the result of `work`, or an error with the panic's message. `what` names the work in the error.
///
/// After a panic, values that `work` refers to may be inconsistent: only drop them.
pub(crate) fn fenced<T>(what: &str, work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work))
        .map_err(|panic| format!("{what} failed unexpectedly: {}", panic_message(&*panic)))
}

/// The message of a panic.
fn panic_message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or(panic.downcast_ref::<&str>().copied())
        .unwrap_or("no reason given")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error_with_its_reason() {
        let number = std::hint::black_box(7);
        let result = fenced("counting", || assert_eq!(number, 8, "too few"));
        let message = result.expect_err("it panics");
        assert!(message.starts_with("counting failed unexpectedly: "));
        assert!(message.contains("too few"), "{message}");
        assert_eq!(fenced("counting", || number).expect("no panic"), 7);
    }
}
