//! The README's table of accuracy is what the laboratory measures.
//!
//! To write it anew: `HITSCOPE_README=write cargo test -p hitscope-lab readme`, and look at the difference.

use hitscope_core::progress::Progress;
use hitscope_lab::measure::{self, Sizes};
use hitscope_lab::report::{accuracy_table, is_in_accuracy_table};

const README: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../README.md");
const START: &str = "<!-- accuracy: written by a test -->\n";
const END: &str = "<!-- end of accuracy -->";

#[test]
fn the_table_of_accuracy_is_up_to_date() {
    let sizes = Sizes {
        speed_rays: 0,
        ..Sizes::FULL
    };
    let all = measure::run(
        sizes,
        1,
        &is_in_accuracy_table,
        &Progress::default(),
        &|_| (),
    );
    let table = accuracy_table(&all.expect("nobody cancels"));
    let text = std::fs::read_to_string(README).expect("the README is there");
    let (before, rest) = text.split_once(START).expect("the table's start");
    let (shown, after) = rest.split_once(END).expect("the table's end");
    if std::env::var_os("HITSCOPE_README").is_some_and(|value| value == "write") {
        let text = format!("{before}{START}{table}{END}{after}");
        std::fs::write(README, text).expect("the README can be written");
    } else {
        assert_eq!(shown, table, "HITSCOPE_README=write writes it anew");
    }
}
