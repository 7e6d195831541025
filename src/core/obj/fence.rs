//! Converts panics of dependencies on user data into errors.

use super::error::Problem;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Returns the result of `work`, or an error with the panic's message. `what` names the work in the message.
///
/// After a panic, anything passed to the work may only be dropped.
pub(super) fn fenced<T>(what: &str, work: impl FnOnce() -> T) -> Result<T, Problem> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        Problem::Content(format!("{what} failed unexpectedly: {}", reason(&*panic)))
    })
}

fn reason(panic: &(dyn Any + Send)) -> &str {
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
        let Err(Problem::Content(message)) = result else {
            panic!("passed through");
        };
        assert!(message.starts_with("counting failed unexpectedly: "));
        assert!(message.contains("too few"), "{message}");
        assert_eq!(fenced("counting", || number).expect("no panic"), 7);
    }
}
